"""Slides on circles and arcs against elliptic functions of 40 digits, and what begins and ends them."""

import math
import random

import mpmath as mp
import pytest

from bounce_env import Arc, Ball, Bumper, EventKind, Field, Flipper, Scene, Sensor, Wall, World
from bounce_env.report.reference.pendulum import DIGITS, pendulum_place, release_cosine

G = 9.81
BEGINS, ENDS = int(EventKind.CONTACT_BEGINS), int(EventKind.CONTACT_ENDS)


def started(rho, x, y, speed, *, inside=True, gravity=G, r=0.05, extra=(), **material):
    """A world with a ball on a circle of path radius `rho`, and the speed along it that it really has."""
    n = math.hypot(x, y)
    x, y = rho * x / n, rho * y / n
    element = Arc((0, 0), rho + r, 0.0, 2 * math.pi, **material) if inside else Bumper((0, 0), rho - r, **material)
    world = World(Scene(gravity=(0.0, -gravity), ball=Ball(radius=r), elements=(element, *extra)))
    velocity = (-speed * y / rho, speed * x / rho)
    world.reset(position=(x, y), velocity=velocity)
    with mp.workdps(DIGITS):
        n = mp.hypot(mp.mpf(x), mp.mpf(y))
        along = float((mp.mpf(velocity[1]) * x - mp.mpf(velocity[0]) * y) / n)
    return world, x, y, along


def energies(world):
    """The energy [J/kg] of all balls together."""
    return float((0.5 * (world.velocity**2).sum(axis=1) + G * world.position[:, 1]).sum())


@pytest.mark.parametrize("seed", range(40))
def test_a_ball_in_a_bowl_is_where_a_pendulum_would_be_after_a_minute(seed):
    rng = random.Random(seed)
    rho = rng.choice([0.1, 1.0, 3.0])
    angle = rng.uniform(-0.5, 0.5) * math.pi  # from the lowest point
    fastest = math.sqrt(2.0 * G * rho * math.cos(angle))  # with which it comes up to the centre's height
    speed = rng.choice([0.0, 1e-6, rng.random(), 1.0 - 1e-9]) * fastest * rng.choice([-1, 1])
    world, x, y, along = started(rho, math.sin(angle), -math.cos(angle), speed, b=rng.choice([0.0, 0.5, 1.0]))
    before, lowest_square = energies(world), along * along + 2.0 * G * (y + rho)
    rows = world.advance(60.0, ledger=True)
    assert rows["kind"].tolist() == [BEGINS]
    px, py = pendulum_place(rho, x, y, along, G, 60.0)
    assert math.dist(world.position[0], (px, py)) <= 1e-11 * rho
    # Beside what v_lowest^2 / 2 allows there is the rounding of the heights themselves.
    assert abs(energies(world) - before) <= 1e-13 * 0.5 * lowest_square + 4e-16 * G * rho


@pytest.mark.parametrize("seed", range(40))
def test_a_ball_that_loops_is_where_a_pendulum_would_be(seed):
    rng = random.Random(1000 + seed)
    rho, angle = rng.choice([0.1, 1.0, 3.0]), rng.uniform(-math.pi, math.pi)
    over = rng.choice([1e-9, 1e-3, 0.5, 10.0])  # over E = 3 G rho, at which it is pressed all round
    speed = math.sqrt(G * rho * (3.0 + over + 2.0 * math.cos(angle))) * rng.choice([-1, 1])
    world, x, y, along = started(rho, math.sin(angle), -math.cos(angle), speed)
    rows = world.advance(20.0, ledger=True)
    assert rows["kind"].tolist() == [BEGINS]
    assert math.dist(world.position[0], pendulum_place(rho, x, y, along, G, 20.0)) <= 1e-11 * rho


@pytest.mark.parametrize("seed", range(40))
def test_a_ball_without_gravity_goes_round_uniformly(seed):
    rng = random.Random(2000 + seed)
    angle, speed = rng.uniform(-math.pi, math.pi), rng.uniform(0.1, 10.0) * rng.choice([-1, 1])
    world, x, y, along = started(1.0, math.sin(angle), -math.cos(angle), speed, gravity=0.0)
    world.advance(10.0)
    assert math.dist(world.position[0], pendulum_place(1.0, x, y, along, 0.0, 10.0)) <= 1e-11


@pytest.mark.parametrize("inside", [True, False])
@pytest.mark.parametrize("seed", range(60))
def test_a_ball_leaves_a_curve_where_it_no_longer_presses(seed, inside):
    rng = random.Random(seed)
    rho = rng.choice([0.1, 1.0, 3.0])
    if inside:
        angle, share = rng.uniform(-1.0, 1.0), rng.uniform(0.001, 2.997)  # of E over G rho
        speed = math.sqrt(G * rho * (share + 2.0 * math.cos(angle))) * rng.choice([-1, 1])
    else:
        angle = math.pi + rng.choice([-1, 1]) * rng.uniform(1e-3, 1.5)
        speed = rng.choice([0.0, rng.uniform(-0.99, 0.99)]) * math.sqrt(-G * rho * math.cos(angle))
    world, x, y, along = started(rho, math.sin(angle), -math.cos(angle), speed, inside=inside)
    rows = world.advance(30.0, ledger=True)
    assert rows["kind"].tolist()[:2] == [BEGINS, ENDS]
    left, cosine = rows[1], release_cosine(rho, x, y, along, G)
    assert abs(math.hypot(left["x"], left["y"]) - rho) <= 1e-14 * rho
    place = (math.copysign(math.sqrt(1.0 - cosine * cosine), left["x"]) * rho, cosine * rho)
    assert math.dist(place, (left["x"], left["y"])) <= (1e-12 if abs(cosine) < 0.999 else 1e-8) * rho
    assert (left["vy0"] > 0.0) == inside  # on the way up, or down


def test_at_rest_on_top_it_stays_and_beside_it_leaves_at_two_thirds():
    world, *_ = started(1.0, 0.0, 1.0, 0.0, inside=False)
    assert world.advance(100.0, ledger=True)["kind"].tolist() == [BEGINS]
    assert world.position[0].tolist() == [0.0, 1.0]
    world, *_ = started(1.0, 1e-5, 1.0, 0.0, inside=False)
    rows = world.advance(100.0, ledger=True)
    assert rows["kind"].tolist() == [BEGINS, ENDS]
    assert rows["y"][1] == pytest.approx(2.0 / 3.0, abs=1e-10)


@pytest.mark.parametrize("share", [-1e-9, -1e-13, 0.0, 1e-13, 1e-9])
@pytest.mark.parametrize("sign", [-1, 1])
def test_a_release_at_the_rim_swings(share, sign):
    """From the height of the centre, or next to it: the press is nothing there, and from below it holds at once."""
    world, x, y, along = started(0.95, sign, share, 0.0)
    rows = world.advance(5.0, ledger=True, max_events=1000)
    assert world.time == 5.0
    assert math.hypot(*world.position[0]) <= 0.95 * (1.0 + 1e-12)
    if share <= 0.0:
        assert rows["kind"].tolist() == [BEGINS]
        assert math.dist(world.position[0], pendulum_place(0.95, x, y, along, G, 5.0)) <= 1e-11


def test_the_separatrix_needs_no_patience():
    """With just the speed to the top: the ball creeps there, and no search goes on for ever."""
    for ulps in range(-3, 4):
        top = math.sqrt(4.0 * G)
        world, *_ = started(1.0, 0.0, -1.0, top * (1.0 + ulps * 2.0**-52), inside=True)
        world.advance(60.0, max_events=10_000)
        assert world.time == 60.0


@pytest.mark.parametrize("b", [0.0, 0.5, 0.9])
def test_bounces_that_die_out_on_a_curve_end_in_a_slide(b):
    world, *_ = started(1.0, 0.6, -0.8, 0.0, b=b)
    world.reset(position=(0.1, -0.5), velocity=(0.0, 0.0))
    rows = world.advance(60.0, ledger=True)
    assert rows["kind"].tolist().count(BEGINS) == 1
    assert rows["kind"][-1] == BEGINS
    assert len(rows) < 400
    begun = energies(world)
    world.advance(600.0)
    assert energies(world) == pytest.approx(begun, abs=1e-12)


def test_a_slide_is_the_same_in_pieces_and_from_a_snapshot():
    extra = (
        Wall((-0.3, -2.0), (-0.3, -0.5), b=0.5),
        Sensor((0.2, -1.1), (0.2, -0.1)),
        Sensor(center=(0.5, -0.8), radius=0.1),
        Field(((0.3, -2.0), (2.0, -2.0), (2.0, 0.0), (0.3, 0.0)), (1.0, 0.5)),
    )

    def played(pieces, snapshot):
        world, *_ = started(1.0, 1.0, 0.3, 2.0, extra=extra)
        rows = []
        for _ in range(pieces):
            rows += world.advance(8.0 / pieces, ledger=True).tolist()
            if snapshot:
                data = world.snapshot()
                world, *_ = started(1.0, 1.0, 0.3, 2.0, extra=extra)
                world.restore(data)
        return rows, world.position.tolist(), world.velocity.tolist()

    whole = played(1, False)
    assert len(whole[0]) > 10
    assert played(1024, False) == whole
    assert played(64, True) == whole


@pytest.mark.parametrize("speed", [1.0, 2.5, 4.0])
def test_sensors_see_a_slide_when_a_pendulum_passes(speed):
    extra = (Sensor((0.2, -1.1), (0.2, 1.1)), Sensor(center=(0.0, -1.0), radius=0.3))
    world, x, y, along = started(1.0, 0.0, -1.0, speed, extra=extra)
    bare, *_ = started(1.0, 0.0, -1.0, speed)
    rows = world.advance(10.0, ledger=True)
    bare.advance(10.0)
    assert world.position.tolist() == bare.position.tolist()
    crossings = rows[rows["kind"] == int(EventKind.SENSOR)]
    assert len(crossings) > 8
    for row in crossings:
        px, py = pendulum_place(1.0, x, y, along, G, float(row["time"]))
        assert math.dist((px, py), (row["x"], row["y"])) <= 1e-11
        off = row["x"] - 0.2 if row["element"] == 1 else math.hypot(row["x"], row["y"] + 1.0) - 0.3
        assert abs(off) <= 1e-12


@pytest.mark.parametrize("b", [0.5, 1.0])
def test_a_half_pipe_keeps_its_energy_for_a_hundred_periods(b):
    rho, r, h = 0.95, 0.05, 0.5
    elements = (
        Arc((0, 0), 1.0, math.pi, 2 * math.pi, b=b), Wall((-1, 0), (-1, 3), b=b), Wall((1, 0), (1, 3), b=b),
    )  # fmt: skip
    world = World(Scene(ball=Ball(radius=r), elements=elements))
    world.reset(position=(rho, h), velocity=(0, 0))
    with mp.workdps(DIGITS):  # falls h, slides half round, rises h, and back
        lowest_square = 2 * mp.mpf(G) * (h + rho)
        m = 4 * mp.mpf(G) * rho / lowest_square
        slide = 2 * mp.ellipf(mp.pi / 4, m) * 2 * rho / mp.sqrt(lowest_square)
        period = float(4 * mp.sqrt(2 * mp.mpf(h) / mp.mpf(G)) + 2 * slide)
    before = energies(world)
    for _ in range(100):
        world.advance(period)
    assert energies(world) == pytest.approx(before, rel=1e-12)
    assert math.dist(world.position[0], (rho, h)) <= 1e-9


def test_a_moving_part_hits_a_ball_that_slides():
    """A flipper swings up into a bowl in which a ball slides to and fro: it strikes it, and they never overlap."""
    flipper = Flipper(
        (-0.2, -0.6), 0.25, radius=0.02, rest_angle=-1.0, active_angle=0.3, up_speed=20.0, down_speed=10.0, name="f"
    )
    world, *_ = started(1.0, 0.8, -0.6, 0.0, extra=(flipper,), b=0.5)
    hits = 0
    for i in range(200):
        world.command("f", i % 3 == 0)
        rows = world.advance(0.05, ledger=True, max_events=5000)
        hits += int((rows["element"] == 1).sum())
        assert math.hypot(*world.position[0]) <= 1.0 + 1e-9
    assert world.time == pytest.approx(10.0)
    assert hits > 0


def test_balls_meet_on_a_curve():
    """Two balls swing in one bowl and hit each other: they never overlap, and lose no energy with b = 1."""
    world = World(Scene(ball=Ball(radius=0.05), elements=(Arc((0, 0), 1.05, 0.0, 2 * math.pi),)), balls=2)
    world.reset(position=((0.8, -0.6), (-0.6, -0.8)), velocity=((0, 0), (0, 0)))
    before = energies(world)
    for _ in range(100):
        world.advance(0.1, max_events=20_000)
        assert math.dist(*world.position) >= 0.1 - 1e-9
        assert max(math.hypot(*p) for p in world.position) <= 1.0 + 1e-9
    assert world.time == pytest.approx(10.0)
    assert energies(world) <= before + 1e-9
