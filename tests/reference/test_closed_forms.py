"""World against results that follow from pencil and paper."""

import math

import numpy as np
import pytest

from bounce_env.engine.world import World
from bounce_env.scene import Ball, Bumper, Paddle, Scene, Sensor, Wall
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

FLOOR = Wall((-100, 0), (100, 0), name="floor")


def started(scene, position, velocity):
    world = World(scene)
    world.reset(position=position, velocity=velocity)
    return world


def ledger_of(scene, position, velocity, seconds, **limits):
    return started(scene, position, velocity).advance(seconds, ledger=True, **limits)


@pytest.mark.parametrize("radius", [0.0, 0.1])
@pytest.mark.parametrize("e", [0.5, 0.9])
def test_drop_times_and_speeds(e, radius):
    """t_n = sqrt(2 h / g) (1 + 2 e + ... + 2 e^(n-1)), v_n = e^n sqrt(2 g h)."""
    h, g, n = 3.0, 9.81, 12
    scene = Scene(gravity=(0, -g), ball=Ball(radius=radius, b=e), elements=(FLOOR,))
    rows = ledger_of(scene, (0, h + radius), (0.3, 0), 100.0, max_events=n)
    k = np.arange(n)
    first = math.sqrt(2 * h / g)
    assert rows["time"] == pytest.approx(first * (1 + 2 * e * (1 - e**k) / (1 - e)), rel=1e-14)
    assert rows["vy1"] == pytest.approx(math.sqrt(2 * g * h) * e ** (k + 1), rel=1e-14)
    assert rows["x"] == pytest.approx(0.3 * rows["time"], rel=1e-14)
    assert rows["y"] == pytest.approx(radius, abs=1e-15)


def test_elastic_drop_returns_to_its_height_after_thousands_of_bounces():
    scene = Scene(gravity=(0, -2), ball=Ball(radius=0.25), elements=(FLOOR,))
    world = started(scene, (0, 1.25), (0, 0))  # hits at t = 1, 3, 5 ...
    world.advance(2.0 * soak_count(2_000, 10_000))
    assert world.position[0] == pytest.approx((0, 1.25), rel=1e-10)
    assert world.velocity[0] == pytest.approx((0, 0), abs=1e-10)


def test_speed_on_a_floor_with_b_2_doubles_up_to_the_cap():
    scene = Scene(gravity=(0, -1), max_speed=100, elements=(Wall((-1, 0), (1, 0), b=2),))
    rows = ledger_of(scene, (0, 0.5), (0, 0), 1e4, max_events=12)
    assert rows["vy1"] == pytest.approx([min(2.0**n, 100) for n in range(1, 13)], rel=1e-14)


def test_blow_up_between_two_walls_that_speed_up():
    """From one wall to the other at distance d: hit n at (d/v) (1 - b^-n) b/(b - 1), up to (d/v) b/(b - 1)."""
    d, v, b, n = 0.7, 3.0, 1.5, 40
    walls = (Wall((0, -1), (0, 1), b=b), Wall((d, -1), (d, 1), b=b))
    scene = Scene(gravity=(0, 0), max_speed=1e9, elements=walls)
    rows = ledger_of(scene, (0, 0), (v, 0), 100.0, max_events=n)
    k = np.arange(1, n + 1)
    assert list(rows["element"]) == [1, 0] * (n // 2)
    assert rows["time"] == pytest.approx(d / v * b / (b - 1) * (1 - b ** -k.astype(float)), rel=1e-13)
    assert np.abs(rows["vx1"]) == pytest.approx(v * b**k, rel=1e-13)


@pytest.mark.parametrize("off", [0.0, 1e-15, -1e-15, 1e-3])
@pytest.mark.parametrize("radius", [0.0, 0.125])
@pytest.mark.parametrize("order", [1, -1])
def test_right_corner_reverses_exactly(order, radius, off):
    """Off two perpendicular walls with b = f = 1 a path leaves antiparallel."""
    walls = (Wall((2, -2), (2, 2)), Wall((-2, 2), (2, 2)))[::order]
    scene = Scene(gravity=(0, 0), ball=Ball(radius=radius), elements=walls)
    world = started(scene, (1, 1 + off), (0.75, 0.75))
    rows = world.advance(4.0, ledger=True)
    assert set(rows["element"]) == {0, 1}
    assert len(rows) == 2
    assert tuple(world.velocity[0]) == (-0.75, -0.75)
    assert world.position[0] == pytest.approx((-2 * radius, -2 * radius - off), abs=1e-14)


@pytest.mark.parametrize("second", [Wall((2, -9), (2, 9)), Bumper((2.25, 0.25), 0.25)])
@pytest.mark.parametrize("velocity", [(1.0, -1.0), (1.0, -0.75), (0.75, -1.0)])
@pytest.mark.parametrize("order", [1, -1])
def test_two_hits_at_one_instant_come_fastest_first_and_ties_in_scene_order(order, velocity, second):
    """A disc reaches the floor and, on its right, a wall or the side of a bumper at t = 1."""
    elements = (Wall((-9, 0), (9, 0)), second)[::order]
    scene = Scene(gravity=(0, 0), ball=Ball(radius=0.25), elements=elements)
    vx, vy = velocity
    rows = ledger_of(scene, (1.75 - vx, 0.25 - vy), velocity, 2.0)
    floor = 0 if order == 1 else 1
    fastest = floor if -vy > vx else 1 - floor
    assert list(rows["element"]) == ([0, 1] if vx == -vy else [fastest, 1 - fastest])
    assert list(rows["time"]) == [1.0, 1.0]
    assert (rows["vx1"][-1], rows["vy1"][-1]) == (-vx, -vy)


def test_sensor_on_which_the_ball_bounces():
    """The centre touches the first line and turns back: no crossing. It passes the second at that instant."""
    touched, passed = Sensor((-9, 0.25), (9, 0.25)), Sensor((0, -9), (0, 9))
    scene = Scene(gravity=(0, 0), ball=Ball(radius=0.25), elements=(touched, passed, Wall((-9, 0), (9, 0))))
    rows = ledger_of(scene, (-1, 1.25), (1, -1), 3.0)
    assert list(rows["element"]) == [2, 1]
    assert list(rows["kind"]) == [0, 3]
    assert list(rows["time"]) == [1.0, 1.0]


@pytest.mark.parametrize("n", [2, 4, 6])
def test_corner_of_pi_over_n_reverses_exactly(n):
    """Unfolding: n reflections in a corner of pi/n, n even, are a turn by pi."""
    angle = math.pi / n
    walls = (Wall((0, 0), (10, 0)), Wall((0, 0), (10 * math.cos(angle), 10 * math.sin(angle))))
    scene = Scene(gravity=(0, 0), elements=walls)
    c, s = math.cos(0.4 * angle), math.sin(0.4 * angle)
    rows = ledger_of(scene, (4 * c, 4 * s), (-c - 0.01 * s, -s + 0.01 * c), 20.0)
    assert len(rows) == n
    assert (rows["vx1"][-1], rows["vy1"][-1]) == pytest.approx((c + 0.01 * s, s - 0.01 * c), rel=1e-13)


@pytest.mark.parametrize("degrees", [1.0, 7.0])
def test_narrow_wedge_has_at_most_pi_over_its_angle_bounces(degrees):
    angle = math.radians(degrees)
    walls = (Wall((0, 0), (10, 0)), Wall((0, 0), (10 * math.cos(angle), 10 * math.sin(angle))))
    rows = ledger_of(Scene(gravity=(0, 0), elements=walls), (5, 0.04), (-1.0, 0.0), 30.0)
    assert len(rows) == math.ceil(180 / degrees) - 1  # lines of the unfolded wedge


def folded(q, p, pull, t):
    """One coordinate at time t of a point pulled to an elastic wall at 0: (distance, speed)."""
    top = math.sqrt(p * p + 2 * pull * q)  # speed at the wall
    period = 2 * top / pull
    since = math.fmod(t + (top - p) / pull, period)
    return top * since - pull * since * since / 2, top - pull * since


def test_gravity_wedge_at_45_degrees_is_separable():
    """Along each wall a ball of its own, pulled with g / sqrt 2: the exact state at any time."""
    g, half = 2.0, math.sqrt(0.5)
    walls = (Wall((0, 0), (50, 50)), Wall((0, 0), (-50, 50)))
    world = started(Scene(gravity=(0, -g), elements=walls), (0.2, 1.5), (0.4, -0.3))
    q = (
        (0.2 + 1.5) * half,
        (1.5 - 0.2) * half,
    )  # along the right and the left wall = off the left and the right one
    p = ((0.4 - 0.3) * half, (-0.3 - 0.4) * half)
    bounces = 0
    for tick in range(1, 41):
        bounces += len(world.advance(0.75, ledger=True))
        (a, va), (b, vb) = (folded(q[k], p[k], g * half, 0.75 * tick) for k in (0, 1))
        assert world.position[0] == pytest.approx(((a - b) * half, (a + b) * half), rel=1e-11)
        assert world.velocity[0] == pytest.approx(((va - vb) * half, (va + vb) * half), rel=1e-11, abs=1e-11)
    assert bounces >= 20


def test_reflection_off_a_bumper_at_an_offset():
    """A straight path at offset s from the centre of a circle of radius R turns by pi - 2 asin(s / R)."""
    for s in (0.0, 0.1, 0.45, -0.3):
        scene = Scene(gravity=(0, 0), ball=Ball(radius=0.1), elements=(Bumper((5, 0), 0.4),))
        (row,) = ledger_of(scene, (0, s), (1.0, 0), 10.0)
        alpha = math.asin(s / 0.5)
        assert row["time"] == pytest.approx(5 - math.sqrt(0.25 - s * s), rel=1e-15)
        assert (row["vx1"], row["vy1"]) == pytest.approx((-math.cos(2 * alpha), math.sin(2 * alpha)), abs=1e-14)


def paddle_scene(*elements, **ball):
    paddle = Paddle((-10, 0), (10, 0), half_width=0.5, radius=0.25, max_speed=5, name="paddle")
    return Scene(gravity=(0, 0), ball=Ball(**ball), max_speed=1e3, elements=(paddle, *elements))


@pytest.mark.parametrize("radius", [0.0, 0.25])
def test_paddle_that_overtakes_the_ball_from_behind(radius):
    """v' = 2 u - v; the ball has a lead of 1 m and the paddle is 1.5 m/s faster."""
    world = started(paddle_scene(radius=radius), (1.75 + radius, 0), (0.5, 0))
    world.command("paddle", 2.0)
    (row,) = world.advance(3.0, ledger=True)
    assert (row["kind"], row["element"]) == (0, 0)
    assert row["time"] == pytest.approx(2 / 3, rel=1e-15)
    assert (row["vx1"], row["vy1"]) == pytest.approx((3.5, 0), abs=1e-15)
    assert (row["nx"], row["ny"], row["ux"], row["uy"]) == (1.0, 0.0, 2.0, 0.0)


@pytest.mark.parametrize("gap", [0.0, 1e-9, 1.0])
def test_paddle_at_the_speed_of_the_ball_does_not_hit(gap):
    world = started(paddle_scene(radius=0.25), (1.0 + gap, 0), (2.0, 0))
    world.command("paddle", 2.0)
    assert len(world.advance(3.0, ledger=True)) == 0
    assert world.position[0] == pytest.approx((7.0 + gap, 0))


def test_cap_never_leaves_the_ball_closing():
    """v' = (100, 2.1) is capped to 3 m/s: shrunk as a whole it would fall behind the paddle's 2 m/s."""
    paddle = Paddle((0, -50), (0, 50), half_width=0, radius=0.5, max_speed=2, b=0.05, name="paddle")
    scene = Scene(gravity=(0, 0), ball=Ball(radius=0.5), max_speed=3, elements=(paddle,))
    world = started(scene, (-100, 3), (100, 0))  # above the paddle after 1 s, when that has come up by 2 m
    world.command("paddle", 2.0)
    (row,) = world.advance(5.0, ledger=True)
    assert (row["time"], row["nx"], row["ny"]) == pytest.approx((1.0, 0.0, 1.0), abs=1e-13)
    assert (row["vx1"], row["vy1"]) == pytest.approx((math.sqrt(9 - 2.1**2), 2.1), rel=1e-12)


def test_paddle_closing_on_a_wall():
    """v -> v + 2 u at every hit of the paddle, and L (v + u) stays the same from one to the next."""
    u, v = 0.25, 1.5
    world = started(paddle_scene(Wall((8, -1), (8, 1))), (1.0, 0), (v, 0))
    world.command("paddle", u)
    rows = world.advance(26.0, ledger=True)
    hits = rows[(rows["element"] == 0) & (rows["kind"] == 0)]
    n = np.arange(1, len(hits) + 1)
    assert len(hits) >= 6
    assert hits["vx1"] == pytest.approx(v + 2 * u * n, rel=1e-13)
    length = 8 - 0.75 - u * hits["time"]  # between the paddle's front and the wall
    invariant = length * (u - hits["vx0"])  # vx0 < 0: the ball comes back from the wall
    assert invariant == pytest.approx(np.full(len(hits), invariant[0]), rel=1e-12)


def test_ball_on_a_moving_paddle_keeps_its_tangential_speed_or_loses_it_to_friction():
    """Law in the frame of the surface: f pulls the ball along with the paddle, v_t' = u + f (v_t - u)."""
    paddle = Paddle((-10, 0), (10, 0), half_width=5, radius=0.25, max_speed=5, f=0.25, b=0.5, name="paddle")
    scene = Scene(gravity=(0, 0), ball=Ball(radius=0.25), max_speed=1e3, elements=(paddle,))
    world = started(scene, (0, 1.5), (1.0, -2.0))
    world.command("paddle", 3.0)
    (row,) = world.advance(1.0, ledger=True)
    assert (row["time"], row["vx1"], row["vy1"]) == (0.5, 3 + 0.25 * (1 - 3), 1.0)
