"""A ball between surfaces that leave it no room: time runs on, and it gets nowhere that it must not."""

import math

import numpy as np
import pytest

from bounce_env import Ball, Bumper, Scene, Wall
from bounce_env.engine.memory.records import CRUSHED, OK
from bounce_env.engine.world import World
from bounce_env.report.stability.case import new_world

R, CAP = 0.125, 50.0


def corridor(gap: float, g: tuple[float, float] = (0.0, 0.0), **material: float) -> World:
    """A ball between two walls that kick, which are as far apart as it is wide, and so much [m] more."""
    top, bottom = Wall((1, 2 * R + gap), (-1, 2 * R + gap), kick=1.0, **material), Wall((-1, 0), (1, 0), kick=1.0)
    scene = Scene(gravity=g, ball=Ball(radius=R), max_speed=CAP, elements=(bottom, top))
    world = new_world(scene)
    world.reset(position=(0.0, R), velocity=(0.25, 1.0))
    return world


@pytest.mark.parametrize("g", [(0.0, 0.0), (0.0, -1.0), (0.5, -1.0), (0.0, 1.0)])
@pytest.mark.parametrize("gap", [1e-15, 1e-14, 1e-13])
def test_time_runs_on_in_a_corridor_as_wide_as_the_ball(gap: float, g: tuple[float, float]) -> None:
    """Up to 5e16 bounces a second: after a thousand of them it slides along, as fast as that has left it."""
    world = corridor(gap, g)
    world.advance(1e-3)
    ((x0, _),), ((vx, vy),), before = world.position, world.velocity, world.time
    for _ in range(8):
        world.advance(0.125, max_events=20_000)
        assert world.status.tolist() == [OK]
        assert R - 1e-12 <= world.position[0, 1] <= R + gap + 1e-12
        assert np.isfinite(world.velocity).all()
    assert vy == pytest.approx(0.0, abs=1e-3)
    t = world.time - before
    assert world.position[0, 0] == pytest.approx(x0 + vx * t + g[0] * t * t / 2, abs=1e-6)
    assert world.velocity[0, 0] == pytest.approx(vx + g[0] * t, abs=1e-6)


def test_in_a_corridor_with_room_each_bounce_happens() -> None:
    """A micrometre: at the cap of speed 5e7 bounces a second, in which the walls take nothing from the way along."""
    world = corridor(1e-6)
    world.advance(1e-3)
    before, speed = world.time, abs(world.velocity[0, 1])
    rows = world.advance(1e-4, ledger=True)
    assert world.time == before + 1e-4
    assert speed > 0.9 * CAP
    assert math.hypot(*world.velocity[0]) == pytest.approx(CAP)
    assert len(rows) == pytest.approx(1e-4 * speed / 1e-6, abs=2)
    assert set(np.sign(rows["vy1"])) == {-1.0, 1.0}


@pytest.mark.parametrize("radius", [0.0, 1e-4])
@pytest.mark.parametrize("miss", [1e-9, 1e-8, 1e-7])
def test_a_narrow_wedge_gives_back_what_comes_in(radius: float, miss: float) -> None:
    """A thousandth of a radian, and a line that passes its apex that near: pi / angle bounces, and no speed is lost."""
    c, s = math.cos(5e-4), math.sin(5e-4)
    scene = Scene(gravity=(0, 0), ball=Ball(radius=radius), elements=(Wall((0, 0), (c, -s)), Wall((c, s), (0, 0))))
    world, apex, angle = new_world(scene), radius / s, math.asin(2.0 * miss)
    world.reset(position=(apex + 0.5, 0.0), velocity=(-math.cos(angle), math.sin(angle)))
    rows = world.advance(1.0, ledger=True)
    assert len(rows) == pytest.approx(math.pi / 1e-3, abs=1)
    assert math.hypot(*world.velocity[0]) == pytest.approx(1.0, abs=1e-11)
    assert world.position[0, 0] == pytest.approx(apex + 0.5, abs=1e-6)


def test_a_ball_that_hops_on_one_spot_has_room() -> None:
    """An eighth of a metre high, again and again, 1e-11 m beside a bumper that it never touches."""
    beside, above = 0.5 + 1e-11, 4e-6
    scene = Scene(
        gravity=(0.0, -1.0), ball=Ball(radius=0.1), elements=(Wall((-1, 0), (1, 0)), Bumper((beside, 0.1 + above), 0.4))
    )
    world = new_world(scene)
    world.reset(position=(0.0, 0.1), velocity=(0.0, 0.5))
    world.advance(1100.0)
    assert world.position[0, 0] == 0.0
    assert world.velocity[0, 0] == 0.0


def test_a_shuttle_without_room_to_turn_back_stands() -> None:
    """It sets off into a ball that lies against a wall, a nanometre away: it would turn back there for ever."""
    shuttle = Bumper((0.0, 0.0), 0.25, rail_end=(1.0, 0.0), speed=0.5, name="shuttle")
    side = Wall((0.25 + 2 * R + 1e-9, 1.0), (0.25 + 2 * R + 1e-9, -1.0))
    world = new_world(Scene(gravity=(0.0, 0.0), ball=Ball(radius=R), elements=(shuttle, side)))
    world.reset(position=(0.25 + R + 1e-9, 0.0), velocity=(0.0, 0.0))
    rows = world.advance(10.0, ledger=True)
    assert world.status.tolist() == [CRUSHED]
    assert len(rows) < 100
    assert world.cores[0, :2] == pytest.approx([0.0, 0.0], abs=1e-8)
    world.enable("shuttle", False)  # it lets go
    world.advance(1.0)
    assert world.status.tolist() == [OK]
