"""Balls that come straight into a wedge, or nearly so: how they leave it."""

import math

import numpy as np
import pytest

from bounce_env import Ball, Bumper, EventKind, Scene, Wall, World

SPEED = 1.0


def wedge(degrees: float, turned: float, radius: float, gravity: float, b: float = 1.0, f: float = 1.0) -> World:
    """Two walls from the origin, opening along the y-axis turned by `turned` [rad]."""
    half, length = math.radians(degrees) / 2.0, 8.0
    ends = [at(turned, sign * length * math.sin(half), length * math.cos(half)) for sign in (-1.0, 1.0)]
    walls = (Wall(ends[0], (0.0, 0.0), b=b, f=f), Wall((0.0, 0.0), ends[1], b=b, f=f))
    pull = at(turned, 0.0, -gravity)
    return World(Scene(ball=Ball(radius=radius), gravity=pull, elements=walls))


def at(turned: float, x: float, y: float) -> tuple[float, float]:
    c, s = math.cos(turned), math.sin(turned)
    return x * c - y * s, x * s + y * c


@pytest.mark.parametrize("radius", [0.0, 0.01])
@pytest.mark.parametrize("degrees", [1.0, 3.0, 37.0, 60.0, 90.0, 120.0, 175.0])
@pytest.mark.parametrize("lean", [0.0, 1e-12, 1e-6, 1e-3, 0.3, 0.9])
def test_a_wedge_that_takes_nothing_gives_all_speed_back(radius, degrees, lean):
    """lean: by what share of the wedge's half angle the ball's path leans over, into its very corner."""
    half = math.radians(degrees) / 2.0
    apex = radius / math.sin(half)
    for turned in (0.0, 0.4, 2.9):
        world = wedge(degrees, turned, radius, gravity=0.0)
        angle, way = lean * half, 3.0
        start = at(turned, way * math.sin(angle), apex + way * math.cos(angle))
        world.reset(position=start, velocity=at(turned, -SPEED * math.sin(angle), -SPEED * math.cos(angle)))
        rows = world.advance(4.0, ledger=True)
        assert world.status[0] == 0
        assert abs(math.hypot(*world.velocity[0]) - SPEED) < 1e-12
        assert len(rows) <= 4 * 180.0 / degrees + 4


@pytest.mark.parametrize("radius", [0.0, 0.01])
@pytest.mark.parametrize("degrees", [1.0, 37.0, 60.0, 90.0, 120.0])
@pytest.mark.parametrize(("b", "f"), [(1.0, 1.0), (0.9, 1.0), (0.5, 0.5), (1.0, 0.5)])
def test_a_ball_straight_down_into_a_wedge_comes_straight_back_up(radius, degrees, b, f):
    half = math.radians(degrees) / 2.0
    world = wedge(degrees, 0.0, radius, gravity=9.81, b=b, f=f)
    height = radius / math.sin(half) + 0.2
    world.reset(position=(0.0, height), velocity=(0.0, 0.0))
    rows = world.advance(0.25, ledger=True)
    assert rows["kind"].tolist() == [EventKind.CORNER_BOUNCE] * 2
    assert set(rows["element"].tolist()) == {0, 1}
    fall = math.sqrt(2.0 * 9.81 * 0.2)
    np.testing.assert_allclose([rows["vx1"][1], rows["vy1"][1]], [0.0, b * fall], rtol=0.0, atol=1e-12)
    pushes = (rows["vx1"] - rows["vx0"]) * rows["nx"] + (rows["vy1"] - rows["vy0"]) * rows["ny"]
    assert abs(pushes[0] - pushes[1]) < 1e-11


def test_walls_that_rebound_differently_or_kick_are_struck_one_after_the_other():
    for walls in (
        (Wall((-1, 1), (0, 0), b=1.0), Wall((0, 0), (1, 1), b=0.5)),
        (Wall((-1, 1), (0, 0), kick=0.5), Wall((0, 0), (1, 1))),
    ):
        world = World(Scene(ball=Ball(radius=0.01), gravity=(0, 0), max_speed=50.0, elements=walls))
        world.reset(position=(0.0, 0.5), velocity=(0.0, -1.0))
        rows = world.advance(1.0, ledger=True)
        assert rows["kind"].tolist() == [EventKind.BOUNCE] * 2


def test_a_ball_between_two_bumpers_is_thrown_back_as_by_a_wedge():
    pins = (Bumper((-0.1, 0.0), 0.05, b=0.8), Bumper((0.1, 0.0), 0.05, b=0.8))
    world = World(Scene(ball=Ball(radius=0.06), gravity=(0, 0), elements=pins))
    world.reset(position=(0.0, 0.5), velocity=(0.0, -1.0))
    world.advance(1.0)
    np.testing.assert_allclose(world.velocity[0], [0.0, 0.8], rtol=0.0, atol=1e-12)
