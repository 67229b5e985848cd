"""For the ledger checker: runs of scenes in which parts move and balls meet, at random and made by hand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.engine.memory.records import ABSORBED, BOUNCE, LEDGER
from bounce_env.engine.world import World
from bounce_env.report.stability.case import new_world
from bounce_env.scene import Ball, Bumper, Element, Flipper, Paddle, Scene, Wall
from tests.engine.moving_scenes import command_at_random, moving_scene
from tests.engine.moving_scenes import start as place_at_random
from tests.reference.ledger_checker import BUDGET, End, Start, find_problems_of_all
from tests.reference.ledger_drive import Command, Value

Point = tuple[float, float]


class Played(NamedTuple):
    scene: Scene
    starts: list[Start]
    ledger: npt.NDArray[Any]
    ends: list[End]
    commands: tuple[Command, ...]

    def problems(self) -> list[str]:
        return find_problems_of_all(self.scene, self.starts, self.ledger, self.ends, self.commands)


def run(
    scene: Scene, places: Sequence[Point], speeds: Sequence[Point], seconds: float, commands: Sequence[Command] = ()
) -> Played:
    """A run with commands in order of time, before `seconds`; it ends where a budget of events is used up."""
    world = new_world(scene, balls=len(places))
    world.reset(position=places, velocity=speeds)
    starts, pages, given = starts_of(world), [], []
    for time, name, value in (*commands, (seconds, "", None)):
        pages.append(world.advance(time - world.time, ledger=True))
        if name:
            world.command(name, value)
            given.append((time, name, value))
    return Played(scene, starts, np.concatenate(pages), ends_of(world, seconds), tuple(given))


def at_random(seed: int, *, point: bool, seconds: float, max_events: int) -> Played | None:
    """A random scene with a command before each piece of its time; None where there is no room for the balls.

    One point, or one to five discs. What takes more events than that in a piece ends there, and a run ends before the
    piece in which balls come to lie on each other: of forces between balls the checker knows nothing.
    """
    rng = np.random.default_rng(seed)
    scene = moving_scene(rng, point=point)
    balls = 1 if point else int(rng.integers(1, 6))
    world = new_world(scene, balls=balls)
    if not place_at_random(rng, world, balls):
        return None
    told = list[Command]()
    recorder = Recorder(world, told)
    starts, pages, time = starts_of(world), [], 0.0
    while time < seconds and BUDGET not in world.status:
        recorder.time, before, count = time, world.snapshot(), len(told)
        command_at_random(rng, recorder)  # type: ignore[arg-type]
        piece = float(rng.choice([0.0078125, 0.125, 0.5]))
        page = world.advance(piece, ledger=True, max_events=max_events)
        if has_clusters(scene, page):
            world.restore(before)
            del told[count:]
            break
        pages.append(page)
        time += piece
    ledger = np.concatenate([np.zeros(0, LEDGER), *pages])
    return Played(scene, starts, ledger, ends_of(world, time), tuple(told))


def has_clusters(scene: Scene, ledger: npt.NDArray[Any]) -> bool:
    """Whether balls lie on each other somewhere in a ledger."""
    on_balls = (ledger["element"] >= len(scene.elements)) & (ledger["kind"] != BOUNCE)
    return bool((on_balls | (ledger["kind"] == ABSORBED)).any())


class Recorder:
    """A world's commands, written down as well."""

    def __init__(self, world: World, told: list[Command]) -> None:
        self.scene, self.time = world.scene, 0.0
        self._world, self._told = world, told

    def command(self, name: str, value: Any) -> None:
        self._world.command(name, value)
        kept: Value = tuple(map(tuple, value.tolist())) if isinstance(value, np.ndarray) else value
        self._told.append((self.time, name, kept))


def starts_of(world: World) -> list[Start]:
    rows = zip(world.position.tolist(), world.velocity.tolist(), strict=True)
    return [Start(tuple(place), tuple(speed)) for place, speed in rows]


def ends_of(world: World, asked: float) -> list[End]:
    rows = zip(world.position.tolist(), world.velocity.tolist(), world.status.tolist(), strict=True)
    return [End(world.time, tuple(place), tuple(speed), status, asked) for place, speed, status in rows]


# ---- made by hand: between them they have rows of every kind that moving parts and several balls bring


def box(width: float = 1.0, height: float = 1.0, **material: float) -> tuple[Wall, ...]:
    corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
    return tuple(Wall(p, q, **material) for p, q in zip(corners, corners[1:] + corners[:1], strict=True))


def scene_of(*elements: Element, radius: float = 0.02, g: float = 1.0, **more: Any) -> Scene:
    return Scene(gravity=(0.0, -g), ball=Ball(radius=radius, b=0.95), max_speed=50.0, elements=elements, **more)


def flippers() -> Played:
    """A ball comes to rest on a flipper, is thrown up, and hits another one on its side and its round end."""
    left = Flipper(
        (0.3, 0.3), 0.2, radius=0.02, rest_angle=0.0, active_angle=0.8, up_speed=9.0, down_speed=4.0, b=0.3, f=0.9,
        name="left",
    )  # fmt: skip
    right = Flipper(
        (0.8, 0.6), 0.25, radius=0.03, rest_angle=math.pi, active_angle=math.pi - 1.5, up_speed=5.0, down_speed=7.0,
        kick=0.2, name="right",
    )  # fmt: skip
    script = [(1.0, "left", True), (1.25, "right", True), (1.5, "left", False), (1.75, "right", False)]
    return run(scene_of(*box(b=0.8), left, right), [(0.45, 0.4)], [(0.0, 0.0)], 2.5, script)


def walls() -> Played:
    """Dragged walls that turn, stop at the box of one end or both, and where they are short; a bumper on its rail."""
    first = Wall(
        (0.3, 0.3), (0.7, 0.35), draggable=True, min_length=0.1, reach=((0.1, 0.2), (0.9, 0.8)), name="first"
    )  # fmt: skip
    second = Wall((0.2, 0.1), (0.4, 0.1), draggable=True, min_length=0.05, b=0.6, name="second")
    shuttle = Bumper((0.2, 0.85), 0.05, rail_end=(0.8, 0.8), speed=0.6, f=0.8, name="shuttle")
    script = [
        (0.25, "first", ((0.0, 0.4), (0.1, -0.3))),
        (0.5, "second", ((0.3, 0.0), (0.1, 0.3))),
        (1.0, "first", ((0.5, 0.1), (-0.6, 0.2))),
        (1.5, "shuttle", -0.3),
        (1.75, "second", ((-0.3, 0.2), (-0.3, 0.2))),
    ]
    return run(scene_of(*box(b=0.9), first, second, shuttle), [(0.5, 0.6)], [(0.7, 0.9)], 2.5, script)


def crushed() -> Played:
    """A ball between a paddle and a wall, crushed, set free, and crushed by the end of another part."""
    paddle = Paddle((0.5, 0.1), (0.9, 0.1), half_width=0.05, radius=0.02, max_speed=1.0, b=0.5, name="paddle")
    ram = Wall((0.2, 0.5), (0.5, 0.6), draggable=True, b=0.4, name="ram")
    script = [
        (0.5, "paddle", 0.5), (1.0, "paddle", -0.25), (1.5, "ram", ((0.6, -0.6), (0.6, -0.6))),
        (2.5, "ram", ((0.0, 0.3), (0.0, 0.3))),
    ]  # fmt: skip
    return run(scene_of(*box(b=0.5), paddle, ram, g=5.0), [(0.9, 0.1)], [(0.0, 0.0)], 3.0, script)


def balls() -> Played:
    """Four balls in a box: they hit each other, and one is taken along by a paddle."""
    paddle = Paddle((0.2, 0.1), (0.8, 0.1), half_width=0.1, radius=0.02, max_speed=1.0, b=0.0, f=0.5, name="paddle")
    script = [(0.5, "paddle", 0.4), (1.0, "paddle", -0.2)]
    places, speeds = [(0.5, 0.3), (0.2, 0.8), (0.8, 0.8), (0.5, 0.9)], [(0.0, 0.0), (1.0, 0.2), (-0.9, 0.1), (0.1, 0.5)]
    return run(scene_of(*box(b=0.9), paddle, radius=0.06), places, speeds, 1.25, script)


def pile() -> Played:
    """Two balls on a slope, one of which comes to roll against the other that stands on the floor."""
    slope = Wall((0.1, 0.5), (0.6, 0.2), b=0.2, name="slope")
    return run(
        scene_of(*box(b=0.3, f=0.9), slope, radius=0.04, g=3.0, rest_speed=0.05),
        [(0.3, 0.6), (0.7, 0.1)], [(0.0, 0.0), (0.0, 0.0)], 1.5,
    )  # fmt: skip


def piston() -> Played:
    """A point above a wall that is dragged up and tilted."""
    wall = Wall((-0.5, 0.2), (1.5, 0.2), draggable=True, b=0.7, f=0.9, name="piston")
    script = [(0.25, "piston", ((0.0, 0.3), (0.0, 0.1))), (1.0, "piston", ((0.0, -0.2), (0.0, 0.2)))]
    return run(scene_of(*box(b=0.8), wall, radius=0.0), [(0.4, 0.5)], [(0.5, 0.1)], 2.0, script)


BY_HAND = {f.__name__: f for f in (flippers, walls, crushed, balls, pile, piston)}
