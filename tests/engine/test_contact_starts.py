"""Whatever a ball touches when it starts, and however it moves: no overlap, no escape, no clock that stands still."""

import itertools
import math

import numpy as np
import pytest

from bounce_env import Arc, Ball, EventKind, Scene, Wall, World
from bounce_env.engine.placement import element_gaps
from bounce_env.report.stability.case import new_world
from tests.conftest import soak_count
from tests.engine.contact_starts import ROOM, G, Start, starts

PARTS = 4
PIECES = 32  # of one second
EVENTS = 3000  # in a piece


def fault(start: Start) -> str:
    """What goes wrong in the first second, or nothing."""
    world = new_world(start.scene)
    world.reset(position=start.position, velocity=start.velocity)
    side = 0
    before, b = energy(world), start.scene.elements[-1].b
    for piece in range(1, PIECES + 1):
        world.advance(piece / PIECES - world.time, max_events=EVENTS)
        x, y = world.position[0].tolist()
        if world.time < piece / PIECES:
            return f"its clock stands at {world.time}"
        if not max(abs(x), abs(y)) <= ROOM + 1e-9:
            return f"it is at ({x}, {y})"
        if min(gap for _, gap in element_gaps(start.scene, {}, x, y)) < -1e-9:
            return f"it overlaps something at ({x}, {y}), {world.time}"
        if b <= 1.0 and energy(world) > before + 1e-9:
            return f"its energy grows from {before} to {energy(world)}"
        off = math.hypot(x, y) - 1.0
        if start.closed and abs(off) > 1e-9:
            if side * off < 0.0:
                return f"it has passed the circle at {world.time}"
            side = 1 if off > 0.0 else -1
    return ""


def energy(world: World) -> float:
    return float(0.5 * (world.velocity[0] ** 2).sum() + G * world.position[0, 1])


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_starts_in_contact(part: int) -> None:
    """Soak: the whole grid at every fifth degree, 10^5 starts."""
    step = soak_count(15, 5)
    every = soak_count(23 * PARTS, PARTS)
    played = 0
    for start in itertools.islice(starts(step), part * every // PARTS, None, every):
        try:
            why = fault(start)
        except ValueError as error:
            assert "overlaps" in str(error)  # noqa: PT017 - a corner too narrow for a disc: there is no such start
            continue
        played += 1
        assert not why, (start.name, why)
    assert played > soak_count(200, 25_000)


@pytest.mark.parametrize("radius", [0.0, 0.05])
@pytest.mark.parametrize("beneath", ["ends", "split", "whole"])
@pytest.mark.parametrize("b", [0.0, 0.5, 1.0])
def test_a_ball_on_a_floor_rides_up_a_tangent_arc(radius: float, beneath: str, b: float) -> None:
    """v^2 / 2 g high, and back: also where the floor goes on beneath the arc."""
    spans = {"ends": ((-3, 0),), "split": ((-3, 0), (0, 2)), "whole": ((-3, 2),)}[beneath]
    floors = tuple(Wall((x0, 0), (x1, 0), b=b) for x0, x1 in spans)
    world = new_world(Scene(ball=Ball(radius=radius), elements=(*floors, Arc((0, 0.5), 0.5, -math.pi / 2, 0.0, b=b))))
    world.reset(position=(-0.5, radius), velocity=(1.0, 0.0))
    rows = world.advance(2.0, ledger=True)
    names = [("floor" if row["element"] < len(floors) else "arc", EventKind(row["kind"]).name) for row in rows]
    assert names == [
        ("floor", "CONTACT_BEGINS"), ("floor", "CONTACT_ENDS"), ("arc", "CONTACT_BEGINS"),
        ("arc", "CONTACT_ENDS"), ("floor", "CONTACT_BEGINS"),
    ]  # fmt: skip
    assert world.velocity[0] == pytest.approx([-1.0, 0.0], abs=1e-12)
    assert rows["time"][1] == pytest.approx(0.5, abs=1e-14)


def test_a_point_in_a_corner_in_which_an_arc_ends() -> None:
    """It slides along the floor, hits the wall, and slides back; the arc is tangent to the floor behind the wall."""
    elements = (Wall((0, 0), (2, 0), b=0.5), Wall((2, 0), (2, 2), b=0.5), Arc((2, 0.25), 0.25, -math.pi / 2, math.pi))
    world = new_world(Scene(elements=elements))
    world.reset(position=(0.625, 0.0), velocity=(0.5, 0.0))
    world.advance(4.0, max_events=1000)
    assert world.time == 4.0
    assert world.position[0] == pytest.approx([1.6875, 0.0], abs=1e-12)


@pytest.mark.parametrize("rest_speed", [0.0, 0.02])
@pytest.mark.parametrize(
    ("b", "f", "closing", "along"), [(0.5, 0.9, 0.017, 0.15), (0.5, 1.0, 0.012, 1.0), (0.3, 1.0, 1.4e3, 1e5)]
)
def test_without_gravity_every_row_obeys_the_law(
    rest_speed: float, b: float, f: float, closing: float, along: float
) -> None:
    """Inside a circle, too, where only its speed presses the ball: `rest_speed` and slides have no say in a hit."""
    scene = Scene(gravity=(0, 0), rest_speed=rest_speed, elements=(Arc((0, 0), 1.0, 0, 2 * math.pi, b=b, f=f),))
    world = new_world(scene)
    t = 0.01 / math.hypot(closing, along)
    world.reset(position=(1.0 - closing * t, -along * t), velocity=(closing, along))
    for row in world.advance(20 * t, ledger=True):
        n, before, after = ((row["nx"], row["ny"]), (row["vx0"], row["vy0"]), (row["vx1"], row["vy1"]))
        tangent = (-n[1], n[0])
        if row["kind"] == int(EventKind.CONTACT_BEGINS):  # its hops would rise above no tolerance
            assert abs(np.dot(before, n)) <= 1e-6 * along
            continue
        assert row["kind"] == int(EventKind.BOUNCE)
        assert np.dot(after, n) == pytest.approx(-b * np.dot(before, n), abs=1e-12 * along)
        assert np.dot(after, tangent) == pytest.approx(f * np.dot(before, tangent), rel=1e-11)
