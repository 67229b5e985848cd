"""A ball that a wall pushes along a floor: one uniform motion, not a row of bounces."""

import math

import numpy as np
import pytest

from bounce_env import Ball, EventKind, Paddle, Scene, Status, Wall, World
from tests.engine.in_pieces import assert_same_in_pieces

RADIUS, G = 0.02, 9.81
PUSH = (0.3, 0.0)


def world_with_wall(lean: float, slope: float, f: float, b: float = 0.0, speed: float = PUSH[0]) -> World:
    """A floor at `slope` [rad], and a wall that leans over it by `lean` [rad] and comes along it at `speed` [m/s]."""
    top, bottom = along(slope, 0.6 * math.sin(lean), 0.6), along(slope, -0.06 * math.sin(lean), -0.06)
    floor = Wall(along(slope, -3.0, 0.0), along(slope, 3.0, 0.0), b=0.5, f=f, name="floor")
    wall = Wall(top, bottom, b=b, f=f, draggable=True, name="wall", reach=((-5, -5), (5, 5)))
    world = World(Scene(ball=Ball(radius=RADIUS), gravity=(0, -G), elements=(floor, wall)))
    world.reset(position=along(slope, 0.25, RADIUS), velocity=(0.0, 0.0))
    command(world, slope, speed)
    return world


def command(world: World, slope: float, speed: float) -> None:
    velocity = along(slope, speed, 0.0)
    world.command("wall", (velocity, velocity))


def along(slope: float, x: float, y: float) -> tuple[float, float]:
    c, s = math.cos(slope), math.sin(slope)
    return x * c - y * s, x * s + y * c


@pytest.mark.parametrize("f", [0.0, 0.9, 1.0])
@pytest.mark.parametrize(("lean", "slope"), [(0.12, 0.1), (0.0, 0.1), (-0.12, 0.1), (0.5, 0.0), (0.0, 0.0)])
def test_a_pushed_ball_moves_as_fast_as_the_wall_comes(lean, slope, f):
    world = world_with_wall(lean, slope, f)
    world.advance(2.0)
    if f == 1.0 and slope == 0.0 and lean != 0.0:  # thrown ahead at the first hit, on a floor that takes nothing
        assert math.hypot(*world.velocity[0]) > PUSH[0]
        return
    before, later = world.position[0].copy(), world.advance(1.0, ledger=True)
    np.testing.assert_allclose(world.velocity[0], along(slope, *PUSH), rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(world.position[0] - before, along(slope, *PUSH), rtol=0.0, atol=1e-14)
    assert len(later) == 0


def test_time_in_pieces_and_snapshots_change_no_bit():
    assert_same_in_pieces(lambda: world_with_wall(0.12, 0.1, 1.0, b=0.5), 4.0)


@pytest.mark.parametrize("f", [0.9, 1.0])
def test_when_the_push_ends_the_ball_slides_on_or_the_floor_holds_it(f):
    world = world_with_wall(0.12, 0.1, f)
    world.advance(2.0)
    place = world.position[0].copy()
    command(world, 0.1, 0.0)
    rows = world.advance(0.1, ledger=True)
    way = 0.0 if f < 1.0 else PUSH[0] * 0.1 - 0.5 * G * math.sin(0.1) * 0.1**2
    np.testing.assert_allclose(world.position[0], place + along(0.1, way, 0.0), rtol=0.0, atol=1e-14)
    assert len(rows) <= 4


def test_a_ball_is_pushed_off_the_end_of_the_floor():
    world = world_with_wall(0.0, 0.0, 0.9)
    world.advance(12.0)
    assert world.position[0][0] > 3.0 + RADIUS
    assert world.position[0][1] < -1.0


@pytest.mark.parametrize("half", [0.0, 0.1])
def test_the_round_end_of_a_paddle_pushes_a_ball_along_the_floor(half):
    """It stays at one point of the end, which comes along the floor."""
    floor = Wall((-3, 0), (3, 0), f=0.9, b=0.5, name="floor")
    paddle = Paddle(
        rail_start=(-1, 0.05), rail_end=(1, 0.05), half_width=half, radius=0.03, max_speed=0.5, b=0.0, name="paddle"
    )
    world = World(Scene(ball=Ball(radius=RADIUS), gravity=(0, -G), max_speed=20.0, elements=(floor, paddle)))
    world.reset(position=(half + 0.3, RADIUS), velocity=(0.0, 0.0))
    world.command("paddle", 0.5)
    world.advance(1.2)
    rows = world.advance(0.5, ledger=True)
    assert len(rows) == 0
    np.testing.assert_allclose(world.velocity[0], (0.5, 0.0), rtol=0.0, atol=1e-12)
    core = world.cores[0][2:]
    assert abs(math.hypot(*(world.position[0] - core)) - 0.05) < 1e-13


def test_nothing_is_absorbed_before_the_wall_has_come():
    rows = world_with_wall(0.0, 0.0, 0.9, b=0.5).advance(3.0, ledger=True)
    kinds = [EventKind(row["kind"]).name for row in rows if row["time"] > 0.0]
    assert kinds == ["BOUNCE", "CONTACT_ENDS", "CONTACT_BEGINS"]


def press(degrees: float, gap: float, b: float = 0.5) -> World:
    """A wall over a floor, `degrees` off lying level with it, that comes down on a ball with `gap` [m] to spare."""
    rise = math.tan(math.radians(degrees))
    middle = 2.0 * RADIUS + gap
    lid = Wall((-1.0, middle - rise), (1.0, middle + rise), b=b, draggable=True, name="wall", reach=((-9, -9), (9, 9)))
    world = World(Scene(ball=Ball(radius=RADIUS), gravity=(0, -G), elements=(Wall((-9, 0), (9, 0), b=b), lid)))
    world.reset(position=(0.0, RADIUS), velocity=(0.0, 0.0))
    world.command("wall", ((0.0, -0.1), (0.0, -0.1)))
    return world


@pytest.mark.parametrize("degrees", [2.0, 5.0, 20.0])
def test_a_wedge_that_closes_squeezes_a_ball_out(degrees):
    """The wedge is open by more than the degree or so at which a ball would have to be 64 times as fast as the wall."""
    world = press(degrees, gap=0.01)
    rows = world.advance(0.3, ledger=True)
    assert world.status[0] == Status.OK
    assert EventKind.CRUSHED not in rows["kind"]
    assert world.velocity[0][0] > 0.099 / math.tan(math.radians(degrees))
    assert world.position[0][1] > RADIUS - 1e-12


@pytest.mark.parametrize("degrees", [0.0, 1e-9, 0.5])
def test_a_press_that_leaves_no_way_out_crushes_the_ball(degrees):
    world = press(degrees, gap=0.01)
    rows = world.advance(0.3, ledger=True)
    assert world.status[0] == Status.CRUSHED
    assert rows["kind"].tolist().count(EventKind.CRUSHED) == 1
    room = 2.0**-14 * world._state.scenes[0].extent
    last = rows[rows["kind"] == EventKind.CRUSHED][0]
    assert -1e-12 <= 0.01 - 0.1 * last["time"] <= room  # where a clearance is left, and not before
    world.command("wall", ((0.0, 0.1), (0.0, 0.1)))
    world.advance(0.5)
    assert world.status[0] == Status.OK


def test_a_part_that_stops_in_time_crushes_nothing():
    floor, room = Wall((-1, 0), (1, 0), b=0.5), 1e-5
    ram = Paddle(
        rail_start=(0, 0.2),
        rail_end=(0, 2 * RADIUS + 0.01 + room),
        half_width=0.0,
        radius=0.01,
        max_speed=0.1,
        b=0.5,
        name="ram",
    )
    world = World(Scene(ball=Ball(radius=RADIUS), gravity=(0, -G), max_speed=20.0, elements=(floor, ram)))
    world.reset(position=(0.0, RADIUS), velocity=(0.0, 0.0))
    world.command("ram", 0.1)
    world.advance(3.0)
    assert world.status[0] == Status.OK
    assert abs(world.position[0][1] - RADIUS) < 1e-12


@pytest.mark.parametrize("f", [0.5, 1.0])
def test_a_ball_that_bounces_off_the_floor_beside_a_wall_that_comes_is_not_held(f):
    """It comes down along an upright wall, which it touches and which moves with it: the floor throws it up again.

    With f < 1 the floor slows it, so that the wall strikes it, and takes its share of the speed up.
    """
    world = world_with_wall(0.0, 0.0, f)
    world.reset(position=(world.cores[0][0] + RADIUS, 0.1), velocity=(PUSH[0], 0.0))
    command(world, 0.0, PUSH[0])
    world.advance(math.sqrt(2.0 * 0.08 / G) + 1e-3)
    assert world.velocity[0, 1] == pytest.approx(f * 0.5 * math.sqrt(2.0 * G * 0.08), abs=0.02)
