"""Slides on what translates, and balls that a straight surface and a round one carry between them.

In the frame of a circle that moves uniformly gravity is the same: the slide is that on a circle that stands, which
`tests/reference/test_slides.py` compares with mpmath. So its place is known, and when it meets what stands.
"""

import math
from collections.abc import Callable

import numpy as np
import pytest

from bounce_env import Arc, Ball, Bumper, EventKind, Field, Paddle, Scene, Sensor, Status, Wall, World
from bounce_env.report.stability.case import new_world
from tests.engine.in_pieces import assert_same_in_pieces

R, RADIUS, G = 0.3, 0.05, 9.81
RHO = R + RADIUS
BEGINS, ENDS = EventKind.CONTACT_BEGINS, EventKind.CONTACT_ENDS


def sliding(
    rail: tuple[float, float] | None, *elements, angle: float = 1.0, rate: float = 0.0, b: float = 0.0
) -> World:
    """A ball on top of a bumper, `angle` degrees off, that slides at `rate` [m/s]; the bumper moves by `rail` [m/s]."""
    bumper = Bumper((0, 0), R, b=b, name="bumper")
    velocity = (0.0, 0.0) if rail is None else rail
    if rail is not None:
        speed = math.hypot(*rail)
        far = (50.0 * rail[0] / speed, 50.0 * rail[1] / speed)
        bumper = Bumper((0, 0), R, b=0.0, name="bumper", rail_end=far, speed=speed)
    world = new_world(Scene(gravity=(0.0, -G), ball=Ball(radius=RADIUS), elements=(bumper, *elements)))
    s, c = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    world.reset(position=(RHO * s, RHO * c), velocity=(velocity[0] + rate * c, velocity[1] - rate * s))
    return world


def place_of_slide(rail: tuple[float, float], **start: float) -> Callable[[float], np.ndarray]:
    """Return where that ball is at a time [s], from a slide on a bumper that stands."""

    def at(t: float) -> np.ndarray:
        world = sliding(None, **start)
        world.advance(t)
        return np.asarray(world.position[0] + t * np.asarray(rail))

    return at


def root(f: Callable[[float], float], low: float, high: float) -> float:
    """Return where f, > 0 at `low` and < 0 at `high`, changes its sign."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if f(middle) > 0.0 else (low, middle)
    return low


RAILS = [(0.1, 0.0), (5.0, 0.0), (-0.7, 0.4), (0.0, 1.0), (0.0, -0.25)]


@pytest.mark.parametrize("rail", RAILS)
@pytest.mark.parametrize("rate", [0.0, 0.5, -0.5])
def test_on_a_moving_bumper_a_ball_slides_as_on_one_that_stands(rail, rate):
    still, moving = sliding(None, rate=rate), sliding(rail, rate=rate)
    for t in (0.1, 0.3, 0.8):
        rows = still.advance(t - still.time, ledger=True), moving.advance(t - moving.time, ledger=True)
        np.testing.assert_allclose(rows[0]["time"], rows[1]["time"], rtol=0.0, atol=1e-13)
        assert rows[0]["kind"].tolist() == rows[1]["kind"].tolist()
        np.testing.assert_allclose(moving.position - still.position, [np.multiply(t, rail)], rtol=0.0, atol=1e-13)
        np.testing.assert_allclose(moving.velocity - still.velocity, [rail], rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("rail", RAILS)
def test_a_slide_is_two_rows_and_lets_go_where_it_does_on_what_stands(rail):
    rows = sliding(rail).advance(1.0, ledger=True)
    assert rows["kind"].tolist() == [BEGINS, ENDS]
    off = np.array([rows["x"][1], rows["y"][1]]) - rows["time"][1] * np.asarray(rail)
    # From rest at 1 degree: cos = 2/3 cos(1 degree).
    assert off[1] / RHO == pytest.approx(2.0 / 3.0 * math.cos(math.radians(1.0)), abs=1e-13)


def test_pieces_and_snapshots_change_no_bit():
    assert_same_in_pieces(lambda: sliding((1.0, 0.25), Wall((1.2, -1), (1.2, 2), b=0.5)), 2.0)


PASSED = {
    "wall": (Wall((0.6, -1), (0.6, 2), b=0.5), lambda p: 0.6 - RADIUS - p[0]),
    "end of a wall": (Wall((0.6, 0.35), (2.0, 0.35), b=0.5), lambda p: math.hypot(p[0] - 0.6, p[1] - 0.35) - RADIUS),
    "bumper": (Bumper((0.9, 0.3), 0.2, b=0.5), lambda p: math.hypot(p[0] - 0.9, p[1] - 0.3) - 0.2 - RADIUS),
    "inside of an arc": (
        Arc((0.0, 0.0), 0.75, -0.5, 2.0, b=0.5),
        lambda p: 0.75 - RADIUS - math.hypot(*p),
    ),
    "outside of an arc": (
        Arc((0.9, 0.3), 0.2, 2.0, 4.0, b=0.5),
        lambda p: math.hypot(p[0] - 0.9, p[1] - 0.3) - 0.2 - RADIUS,
    ),
    "sensor": (Sensor((0.6, -1), (0.6, 2)), lambda p: 0.6 - p[0]),
    "circular sensor": (Sensor(center=(0.9, 0.3), radius=0.2), lambda p: math.hypot(p[0] - 0.9, p[1] - 0.3) - 0.2),
}


@pytest.mark.parametrize("element", PASSED)
@pytest.mark.parametrize("rail", [(0.9, 0.0), (1.0, 0.05), (1.1, -0.05)])
def test_what_it_meets_on_its_way_it_meets_in_time(element, rail):
    what, gap = PASSED[element]
    place = place_of_slide(rail)
    times = np.linspace(0.0, 0.85, 86)
    first = next(t for t in times if gap(place(t)) < 0.0)
    rows = sliding(rail, what).advance(0.86, ledger=True)
    met = rows[rows["element"] == 1]
    assert len(met)
    assert met["time"][0] == pytest.approx(root(lambda t: gap(place(t)), first - 0.01, first), abs=1e-12)


def test_past_the_end_of_a_sensor_it_crosses_nothing():
    rows = sliding((1.0, 0.0), Sensor((0.6, 0.5), (0.6, 2.0)), Sensor((0.6, -1.0), (0.6, 0.2))).advance(
        0.8, ledger=True
    )
    assert rows["kind"].tolist() == [BEGINS]


def test_a_field_changes_the_slide_without_a_row():
    """Twice the gravity right of x = 0.5: from there the ball slides as one that begins there."""
    rail = (1.0, 0.0)
    world = sliding(rail, Field(((0.5, -9.0), (9.0, -9.0), (9.0, 9.0), (0.5, 9.0)), acceleration=(0.0, -G)))
    rows = world.advance(0.6, ledger=True)
    t = root(lambda t: 0.5 - place_of_slide(rail)(t)[0], 0.0, 0.6)
    before = sliding(None)
    before.advance(t)
    after = new_world(Scene(gravity=(0, -2.0 * G), ball=Ball(radius=RADIUS), elements=(Bumper((0, 0), R, b=0.0),)))
    after.reset(position=before.position, velocity=before.velocity)
    after.advance(0.6 - t)
    assert rows["kind"].tolist() == [BEGINS]
    np.testing.assert_allclose(world.position - [np.multiply(0.6, rail)], after.position, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(("faster", "kinds"), [(0.5, [ENDS, EventKind.BOUNCE]), (-0.5, [ENDS])])
def test_a_command_is_a_hit_where_it_closes_and_a_leave_where_it_opens(faster, kinds):
    """A ball slides on the upper end of a paddle that rises."""
    paddle = Paddle(rail_start=(0, 0), rail_end=(0, 5), half_width=0.1, radius=R, max_speed=2.0, b=0.5, name="paddle")
    world = new_world(Scene(gravity=(0, -G), ball=Ball(radius=RADIUS), elements=(paddle,)))
    world.reset(position=(3.0, 0.0), velocity=(0.0, 0.0))
    s, c, top = math.sin(0.3), math.cos(0.3), world.cores[0][[1, 3]].max()
    world.reset(position=(RHO * s, top + RHO * c), velocity=(0.0, 0.0))
    world.command("paddle", 1.0)
    world.push((0.0, 1.0))
    world.advance(0.1)
    before, (x, y) = world.velocity[0].copy(), world.position[0]
    n = np.array([x, y - top - 0.1]) / RHO
    assert np.linalg.norm(n) == pytest.approx(1.0, abs=1e-14)
    world.command("paddle", 1.0 + faster)
    rows = world.advance(1e-6, ledger=True)
    assert sorted(rows["kind"].tolist()) == sorted(kinds)
    gained = (world.velocity[0] - before) @ n
    # It closes at 0.5 n_y, and rebounds from what rises at 1.5 n_y with half of that.
    assert gained == pytest.approx(0.75 * n[1] if faster > 0.0 else 0.0, abs=1e-4)


@pytest.mark.parametrize("speed", [0.0, 0.05, -0.5])
def test_off_the_side_of_a_paddle_it_goes_on_round_its_end(speed):
    """At w relative to it: 0.05 m along the side, then round the end until w^2 + 2 g r (1 - c) = g r c."""
    w, r = 0.2, 0.15
    shape = {"half_width": 0.3, "radius": 0.1}
    paddle = Paddle(rail_start=(-3, 0), rail_end=(3, 0), **shape, max_speed=2.0, b=0.0, name="paddle")
    world = new_world(Scene(gravity=(0, -G), ball=Ball(radius=RADIUS), elements=(paddle,)))
    world.reset(position=(0.25, r), velocity=(speed + w, 0.0))
    world.command("paddle", speed)
    rows = world.advance(1.0, ledger=True)
    assert rows["kind"].tolist() == [BEGINS, ENDS, BEGINS, ENDS]
    assert rows["time"][1] == rows["time"][2] == pytest.approx(0.05 / w, abs=1e-14)
    c = (rows["y"][3]) / r
    assert 3.0 * c == pytest.approx(2.0 + w * w / (G * r), abs=1e-12)
    assert math.hypot(rows["x"][3] - 0.3 - speed * rows["time"][3], rows["y"][3]) == pytest.approx(r, abs=1e-14)


def between(approach: float, b: float = 0.0, f: float = 1.0) -> World:
    """A ball that lies on a bumper and against an upright wall, to which the bumper comes at `approach` [m/s]."""
    bumper = Bumper((0, 0), R, b=b, rail_end=(40, 0), speed=abs(approach), name="bumper")
    x = 0.28
    wall = Wall((x + RADIUS, -2.0), (x + RADIUS, 2.0), b=b, f=f)
    world = new_world(Scene(gravity=(0, -G), ball=Ball(radius=RADIUS), elements=(bumper, wall)))
    y = math.sqrt(RHO**2 - x**2)
    world.reset(position=(x, y), velocity=(0.0, approach * x / y))
    return world


@pytest.mark.parametrize("approach", [0.01, 0.1, 0.3])
def test_a_bumper_lifts_a_ball_along_a_wall(approach):
    """Its place is where the two meet, whatever the forces; on top of the bumper the wall no longer presses it."""
    world = between(approach)
    rows = world.advance(0.5 * 0.28 / approach, ledger=True)
    assert rows["kind"].tolist() == [BEGINS]
    x = 0.28 - approach * world.time
    np.testing.assert_allclose(world.position[0], (0.28, math.sqrt(RHO**2 - x**2)), rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(world.velocity[0], (0.0, approach * x / world.position[0, 1]), rtol=0.0, atol=1e-13)
    rows = world.advance(0.55 * 0.28 / approach, ledger=True)
    assert rows["kind"].tolist()[:2] == [ENDS, BEGINS]
    assert rows["time"][0] == pytest.approx(0.28 / approach, rel=1e-9)


def test_a_ball_that_is_lifted_too_fast_flies_up_the_wall():
    """It takes a pull of U^2 / (rho c^3) to keep it on the bumper: more than gravity where that comes fast."""
    c = math.sqrt(1.0 - (0.28 / RHO) ** 2)
    fastest = math.sqrt(G * RHO * c**3)
    slow, fast = between(0.99 * fastest), between(1.2 * fastest)
    assert len(slow.advance(0.01, ledger=True)) == 1
    fast.advance(0.01)
    assert math.dist(slow.position[0], (0.99 * fastest * 0.01, 0.0)) == pytest.approx(RHO, abs=1e-14)
    assert math.dist(fast.position[0], (1.2 * fastest * 0.01, 0.0)) > RHO + 1e-6


def test_a_wall_sweeps_a_ball_round_a_bumper():
    """A dragged wall comes from the left; the ball lies on the far side of the top of a bumper that stands."""
    bumper = Bumper((0, 0), R, b=0.0)
    wall = Wall((-0.4, 2.0), (-0.4, -2.0), draggable=True, b=0.0, name="wall", reach=((-9, -9), (9, 9)))
    world = new_world(Scene(gravity=(0, -G), ball=Ball(radius=RADIUS), elements=(bumper, wall)))
    x = -0.3
    world.reset(position=(x, math.sqrt(RHO**2 - x**2)), velocity=(0.0, 0.0))
    world.command("wall", ((0.1, 0.0), (0.1, 0.0)))
    rows = world.advance(2.5, ledger=True)
    assert len(rows) < 100
    settled = world.advance(0.25, ledger=True)
    assert len(settled) == 0
    x = -0.35 + 0.1 * world.time
    np.testing.assert_allclose(world.position[0], (x, math.sqrt(RHO**2 - x**2)), rtol=0.0, atol=1e-12)
    assert world.status.tolist() == [Status.OK]


def test_a_carried_ball_in_pieces_and_from_snapshots_is_the_same():
    assert_same_in_pieces(lambda: between(0.1), 3.5)
