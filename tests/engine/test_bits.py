"""What must not change a single bit: how time is cut, what is asked for, which kernel runs, which way is left."""

from dataclasses import replace

import numpy as np
import pytest

from bounce_env import Ball, Bumper, Paddle, Scene, Sensor, Wall, World, load_scene
from bounce_env.engine.world_batch import WorldBatch
from bounce_env.scene import Element
from tests.conftest import soak_count
from tests.engine.closed_scenes import closed_scene

PIECES = 256
SECONDS = 4.0


def play(scene: Scene, start: tuple[float, ...], pieces: int, commands: list[float]) -> tuple[bytes, bytes]:
    """Ledger and end of a run of 4 s in equal pieces; the paddle gets its commands at dyadic instants."""
    world = World(scene)
    world.reset(position=start[:2], velocity=start[2:])
    rows = []
    for k in range(pieces):
        if k * len(commands) % pieces == 0 and commands:
            world.command("paddle", commands[k * len(commands) // pieces])
        ledger = world.advance(SECONDS / pieces, ledger=True)
        assert ledger is not None
        rows.append(ledger.tobytes())
    return b"".join(rows), world.position.tobytes() + world.velocity.tobytes()


@pytest.mark.parametrize(("name", "place"), [("paddle", (0.55, 0.58)), ("pegs", (0.5, 0.3)), ("box", (1.0, 5.0))])
def test_any_partition_of_the_time_gives_the_same_ledger(name: str, place: tuple[float, float]) -> None:
    scene = load_scene(name)
    rng = np.random.default_rng(1)
    for _ in range(soak_count(5, 2000)):
        start = (*place, *(rng.uniform(-3.0, 3.0, 2) * scene.bounds[2]).tolist())
        commands = rng.uniform(-1.5, 1.5, 16).tolist() if name == "paddle" else []
        whole = play(scene, start, 16, commands)
        assert len(whole[0]) > 0
        assert whole == play(scene, start, PIECES, commands) == play(scene, start, 2048, commands)


@pytest.mark.parametrize("radius", [0.0, 0.02])
def test_the_lean_kernel_and_the_general_one_agree(radius: float) -> None:
    """A scene without gravity, bumpers, sensors and paddle, alone and in a batch whose other scenes have them all."""
    rng = np.random.default_rng(2)
    paddle = Paddle((-0.1, 0.0), (0.1, 0.0), half_width=0.02, radius=0.02, max_speed=1.0, name="paddle")
    extras: tuple[Element, ...] = (Bumper((0.2, 0.2), 0.05), Sensor((-1.0, 0.0), (1.0, 0.0)), paddle)
    count = 20
    for _ in range(soak_count(3, 500)):
        starts = None
        while starts is None:
            closed = closed_scene(rng, radius, (0.0, 0.0))
            lean = replace(closed.scene, elements=tuple(e for e in closed.scene.elements if isinstance(e, Wall)))
            starts = closed.starts(rng, count)
        full = Scene(gravity=(0.0, -1.0), ball=Ball(radius=radius), elements=(*lean.elements, *extras))
        alone, mixed = WorldBatch([lean], np.zeros(count, int)), WorldBatch([lean, full], np.zeros(count, int))
        for worlds in (alone, mixed):
            worlds.reset(position=starts[0], velocity=starts[1])
            worlds.advance(10.0)
        assert alone.counts.bounces.sum() > count
        assert alone.position.tobytes() == mixed.position.tobytes()
        assert alone.velocity.tobytes() == mixed.velocity.tobytes()


def mirrored(element: Element) -> Element:
    """The element seen in a mirror along x = 0."""

    def flip(point: tuple[float, float]) -> tuple[float, float]:
        return -point[0], point[1]

    if isinstance(element, Bumper):
        return replace(element, center=flip(element.center))
    if isinstance(element, Paddle):
        return replace(element, rail_start=flip(element.rail_start), rail_end=flip(element.rail_end))
    return replace(element, start=flip(element.start), end=flip(element.end))


def test_mirror_images_stay_mirror_images() -> None:
    rng = np.random.default_rng(3)
    scene = load_scene("paddle")
    shifted = replace(scene, elements=tuple(shift(e, -0.5) for e in scene.elements))
    image = replace(shifted, elements=tuple(mirrored(e) for e in shifted.elements))
    for _ in range(soak_count(20, 5000)):
        x, speed = rng.uniform(-0.3, 0.3), rng.uniform(-2.0, 2.0, 2)
        here, there = World(shifted), World(image)
        here.reset(position=(x, 0.5), velocity=speed.tolist())
        there.reset(position=(-x, 0.5), velocity=(-speed[0], speed[1]))
        for command in rng.uniform(-1.5, 1.5, 8).tolist():
            here.command("paddle", command)
            there.command("paddle", command)  # its rail is mirrored, too
            here.advance(0.5)
            there.advance(0.5)
        assert np.array_equal(here.position * [-1.0, 1.0], there.position)
        assert np.array_equal(here.velocity * [-1.0, 1.0], there.velocity)


def shift(element: Element, dx: float) -> Element:
    """The element moved along x by a number of halves, so that nothing is rounded that was not."""

    def move(point: tuple[float, float]) -> tuple[float, float]:
        return point[0] + dx, point[1]

    if isinstance(element, Bumper):
        return replace(element, center=move(element.center))
    if isinstance(element, Paddle):
        return replace(element, rail_start=move(element.rail_start), rail_end=move(element.rail_end))
    return replace(element, start=move(element.start), end=move(element.end))


def test_corner_on_the_diagonal_from_either_side_of_it() -> None:
    """A disc into a right corner is sent back the way it came, on the diagonal and next to it."""
    scene = Scene(
        gravity=(0.0, 0.0),
        ball=Ball(radius=0.1),
        elements=(Wall((0.0, 0.0), (1.0, 0.0)), Wall((0.0, 1.0), (0.0, 0.0))),
    )
    for off in (0.0, 1e-15, -1e-15, 1e-12, -1e-12):
        world = World(scene)
        world.reset(position=(0.5 + off, 0.5), velocity=(-1.0, -1.0))
        ledger = world.advance(1.0, ledger=True)
        assert ledger is not None
        assert sorted(ledger["element"].tolist()) == [0, 1]
        assert world.velocity.tolist() == [[1.0, 1.0]]


def test_different_bounciness_at_one_instant_has_a_fixed_order() -> None:
    """Wall and mirror-image wall closed on equally fast: the first element first, then what is still closed on."""
    walls = (Wall((0.0, 0.0), (1.0, 0.0), b=0.5), Wall((0.0, 1.0), (0.0, 0.0), b=2.0))
    scene = Scene(gravity=(0.0, 0.0), ball=Ball(radius=0.125), max_speed=50.0, elements=walls)
    world = World(scene)
    world.reset(position=(0.5, 0.5), velocity=(-1.0, -1.0))
    ledger = world.advance(0.5, ledger=True)
    assert ledger is not None
    assert ledger["element"].tolist() == [0, 1]
    assert world.velocity.tolist() == [[2.0, 0.5]]
