"""For the ledger checker: seeded random scenes of standing elements of every kind, and the run of a script."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.engine.world import World
from bounce_env.scene import Arc, Ball, Bumper, Element, Field, Paddle, Scene, Sensor, Wall
from tests.reference.ledger_checker import BUDGET, End, Start
from tests.reference.ledger_walk import Command
from tests.reference.random_scenes import Point, box, direction, free_point


class Script(NamedTuple):
    """A scene, a start and commands in order of time."""

    scene: Scene
    position: Point
    velocity: Point
    commands: tuple[Command, ...]


def played(
    scene: Scene,
    position: Point,
    velocity: Point,
    seconds: float,
    commands: Sequence[Command] = (),
    max_events: int = 900,
) -> tuple[Start, npt.NDArray[Any], End]:
    """Start, whole ledger and end of a run; `commands` in order of time, before `seconds`.

    Where the event budget of one call of `advance` is used up, the run ends.
    """
    world = World(scene)
    world.reset(position=position, velocity=velocity)
    start = Start(*map(tuple, (world.position[0].tolist(), world.velocity[0].tolist())))
    pages = []
    for time, name, value in (*commands, (seconds, "", None)):
        pages.append(world.advance(time - world.time, ledger=True, max_events=max_events))
        if world.status[0] == BUDGET:
            break
        match value:
            case bool():
                world.enable(name, value)
            case tuple():
                world.push(value)
            case float():
                world.command(name, value)
    place, speed = (tuple(rows[0].tolist()) for rows in (world.position, world.velocity))
    return start, np.concatenate(pages), End(world.time, place, speed, int(world.status[0]), seconds)


def with_all_kinds(elements: Sequence[Element], radius: float) -> tuple[Element, ...]:
    """The elements and, aside, one of every kind, so that two kernels, for points and discs, play all scenes."""
    x = max(e.bounds[2] for e in elements) + 4.0 * radius + 0.2
    y = min(e.bounds[1] for e in elements)
    return (
        *elements,
        Wall((x, y), (x + 0.1, y), one_way=True, cooldown=1.0),
        Bumper((x, y), 0.1),
        Arc((x, y), 0.1 + 2.0 * radius, 0.0, 1.0),
        Sensor((x, y), (x + 0.1, y)),
        Sensor(center=(x, y), radius=0.1),
        Field(((x, y), (x + 0.1, y), (x, y + 0.1)), (0.0, 0.0)),
        Paddle((x, y), (x + 0.1, y), half_width=0.0, radius=0.1, max_speed=1.0, name="aside"),
    )


def material(rng: np.random.Generator, kick: bool) -> dict[str, float]:
    """b and f, each of them often at the ends of its range, and now and then a kick."""
    more = {}
    if kick and rng.random() < 0.3:
        more = {"kick": rng.uniform(0.1, 2), "kick_threshold": rng.uniform(0, 0.5)}
    b = rng.choice([0.0, 1.0, 0.5, rng.uniform(0, 1), rng.uniform(0.8, 1.3)])
    f = rng.choice([0.0, 1.0, 1.0, rng.uniform(0, 1), rng.uniform(0.9, 1)])
    return {"b": float(b), "f": float(f), **{name: float(value) for name, value in more.items()}}


def standing(seed: int) -> Script:
    """A box, turned or upright, with one to three of each kind of element in it, some of which may overlap.

    On the way the ball is pushed, slowed down, and one of the elements is switched off.
    """
    rng = np.random.default_rng([seed, 20])
    radius = float(rng.choice([0.0, 0.02, rng.uniform(0.005, 0.1)]))
    kick = bool(rng.random() < 0.5)
    angle = float(rng.choice([0.0, rng.uniform(0, 2 * math.pi)]))
    width, height = float(rng.uniform(0.8, 2)), float(rng.uniform(0.8, 2))
    c, s = math.cos(angle), math.sin(angle)

    def inside(margin: float = 0.1) -> Point:
        x, y = rng.uniform(margin, 1 - margin) * width, rng.uniform(margin, 1 - margin) * height
        return float(x * c - y * s), float(x * s + y * c)

    def segment(longest: float = 0.4) -> tuple[Point, Point]:
        (x, y), (dx, dy) = inside(0.2), direction(rng, rng.uniform(0.05, longest))
        return (x, y), (x + dx, y + dy)

    elements: list[Element] = list(box(width, height, angle, [material(rng, kick) for _ in range(4)]))
    for k in range(rng.integers(1, 4)):
        one_way, cooldown = bool(k == 0 or rng.random() < 0.3), float(rng.uniform(0.01, 0.3))
        elements.append(Wall(*segment(), one_way=one_way, cooldown=cooldown, **material(rng, kick)))
    for k in range(rng.integers(1, 4)):
        elements.append(Bumper(inside(), float(rng.uniform(0.03, 0.12)), name=f"bumper {k}", **material(rng, kick)))
    for _ in range(rng.integers(1, 3)):
        start = float(rng.uniform(-4, 4))
        span = float(rng.choice([math.pi, 2 * math.pi, rng.uniform(0.3, 6)]))
        elements.append(Arc(inside(0.3), float(rng.uniform(0.12, 0.3)), start, start + span, **material(rng, kick)))
    for _ in range(rng.integers(1, 3)):
        elements.append(Sensor(*segment(1.0)))
    for _ in range(rng.integers(1, 3)):
        elements.append(Sensor(center=inside(), radius=float(rng.uniform(0.03, 0.3)), drain=bool(rng.random() < 0.05)))
    (x, y), r = inside(0.3), rng.uniform(0.1, 0.4)
    turns = np.sort(rng.uniform(0, 1, 4)) * 0.8 + np.arange(4) * 1.6
    corners = tuple((float(x + r * math.cos(t)), float(y + r * math.sin(t))) for t in turns)
    elements.append(Field(corners, direction(rng, float(rng.choice([0.0, rng.uniform(0, 15)])))))
    pull = float(rng.choice([0.0, 1.0, 9.81, 10 ** rng.uniform(-1, 3)]))
    scene = Scene(
        gravity=(0.0, -pull) if rng.random() < 0.7 else direction(rng, pull),
        ball=Ball(radius=radius, b=float(rng.choice([1.0, 0.9])), f=float(rng.choice([1.0, 0.95]))),
        rest_speed=float(rng.choice([0.0, rng.uniform(0.01, 0.2)])),
        max_speed=float(rng.uniform(3, 30)),
        drag=0.75,
        elements=with_all_kinds(elements, radius),
    )
    solid = tuple(e for e in elements if not isinstance(e, Sensor | Field))
    starts = [w.start for w in elements[:4]]
    low, high = tuple(np.min(starts, 0)), tuple(np.max(starts, 0))
    while True:
        p = free_point(rng, low, high, (), 0.0)
        x, y = p[0] * c + p[1] * s, p[1] * c - p[0] * s
        if 0 < x < width and 0 < y < height and all(gap(p, e) > 1.01 * radius + 1e-3 for e in solid):
            return Script(scene, p, direction(rng, float(rng.choice([0.0, rng.uniform(0.1, 3)]))), commands(rng, scene))


def commands(rng: np.random.Generator, scene: Scene) -> tuple[Command, ...]:
    """At up to three times of 64ths of a second, one command each."""
    found: list[Command] = []
    for time in np.sort(rng.choice(256, size=rng.integers(0, 4), replace=False)) / 64:
        bouncing = [e.name for e in scene.elements if isinstance(e, Wall | Bumper | Arc) and e.name]
        options = [("aside", 0.0), ("", direction(rng, rng.uniform(0.1, 2.0))), (str(rng.choice(bouncing)), False)]
        found.append((float(time), *options[rng.integers(0, 3)]))
    return tuple(found)


def gap(p: Point, element: Element) -> float:
    """Distance of a point from a standing element [m]."""
    if isinstance(element, Bumper):
        return math.dist(p, element.center) - element.radius
    if isinstance(element, Arc):
        return abs(math.dist(p, element.center) - element.radius)  # at least
    along = np.subtract(element.end, element.start)
    share = np.clip(np.dot(np.subtract(p, element.start), along) / np.dot(along, along), 0, 1)
    return float(np.linalg.norm(np.subtract(p, element.start) - share * along))
