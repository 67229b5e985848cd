"""Balls that lie on each other: momentum, piles that come to rest; nothing overlaps, escapes or gains energy."""

import math
from collections import Counter

import numpy as np
import pytest

from bounce_env import Arc, Ball, Paddle, Scene, Wall, World
from bounce_env.engine.memory.records import ABSORBED, BOUNCE, OK
from tests.conftest import soak_count
from tests.engine.pile_scenes import energy, faults, pile_scene, pile_start

R = 0.05
FLOOR = Scene(ball=Ball(radius=R), elements=(Wall((-9, 0), (99, 0)),))


def box_of(balls: int, b: float = 0.5) -> World:
    """Balls that fall from random places into a box in which ten of them lie side by side exactly."""
    rng, places = np.random.default_rng(balls), []
    while len(places) < balls:
        place = rng.uniform((R, R), (1.0 - R, 2.0 - R))
        if all(math.dist(place, other) > 2.0 * R for other in places):
            places.append(place)
    corners = [(0, 0), (1, 0), (1, 2), (0, 2)]
    walls = tuple(Wall(p, q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True))
    world = World(Scene(ball=Ball(radius=R, b=b), elements=walls), balls=balls)
    world.reset(position=places, velocity=rng.uniform(-1.0, 1.0, (balls, 2)))
    return world


@pytest.mark.parametrize("apart", [0.0, 1e-3])
@pytest.mark.parametrize("b", [0.0, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("balls", [2, 3, 10, 30, 50])
def test_a_row_on_a_floor_keeps_its_momentum(balls: int, b: float, apart: float) -> None:
    scene = Scene(ball=Ball(radius=R, b=b), elements=FLOOR.elements)
    world = World(scene, balls=balls)
    xs = [-1.0, *((2.0 * R + apart) * k for k in range(balls - 1))]
    world.reset(position=[(x, R) for x in xs], velocity=[(1.0, 0.0)] + [(0.0, 0.0)] * (balls - 1))
    for _ in range(4):
        world.advance(1.0, max_events=50_000)
        assert world.status.tolist() == [OK] * balls
        assert world.velocity[:, 0].sum() == pytest.approx(1.0, abs=1e-12)
        assert not list(faults_of_row(world))


def faults_of_row(world: World) -> list[str]:
    gaps = np.diff(np.sort(world.position[:, 0])) - 2.0 * R
    return ["overlap"] if gaps.min() < -1e-9 * 128 or np.abs(world.position[:, 1] - R).max() > 1e-9 else []


@pytest.mark.parametrize(("balls", "seconds"), [(5, 10.0), (10, 10.0), (20, 10.0), (50, 60.0)])
def test_a_pile_in_a_box_sleeps(balls: int, seconds: float) -> None:
    """Asleep, or alone and sliding freely, within that time; before at most 50 000 events in any second, then 20."""
    world, begin = box_of(balls), 0.0
    before = energy(world)
    while begin < seconds:
        world.advance(1.0)
        assert world._state.worlds[0]["events"] <= 50_000
        assert not list(faults(world))
        assert energy(world) <= before + 1e-6
        before, begin = energy(world), begin + 1.0
    assert np.abs(world.velocity[:, 1]).max() == 0.0
    world.advance(1.0)
    assert world._state.worlds[0]["events"] <= 20


def test_a_hit_wakes_a_pile_and_it_sleeps_again() -> None:
    """A slow one is absorbed: what sleeps goes on sleeping, but for what it moves."""
    world = World(Scene(ball=Ball(radius=R, b=0.5), elements=FLOOR.elements), balls=3)
    world.reset(position=[(0.0, R), (0.0, 3 * R), (-1.0, R)], velocity=[(0.0, 0.0), (0.0, 0.0), (0.0, 0.0)])
    rows = world.advance(1.0, ledger=True)
    assert world.velocity.tolist() == [[0.0, 0.0]] * 3
    assert len(rows) < 20
    world.push((0.0, 0.5))
    world.advance(0.01)
    assert (world.velocity[:, 1] > 0.3).all()
    for _ in range(20):
        world.advance(0.5)
    assert np.abs(world.velocity[:, 1]).max() == 0.0
    assert world.position[:, 1] == pytest.approx([R, 3 * R, R], abs=1e-9)


def test_a_shelf_that_is_switched_off_wakes_what_lies_on_it() -> None:
    shelf = Wall((-1, 0), (1, 0), name="shelf")
    world = World(Scene(ball=Ball(radius=R, b=0.5), elements=(shelf,)), balls=2)
    world.reset(position=[(0.0, R), (0.0, 3 * R)], velocity=[(0.0, 0.0), (0.0, 0.0)])
    world.advance(1.0)
    assert world.velocity.tolist() == [[0.0, 0.0]] * 2
    world.enable("shelf", False)
    world.advance(0.05)
    assert world.velocity[:, 1] == pytest.approx(-9.81 * 0.05, rel=1e-12)


def test_a_pile_stands_on_a_paddle_that_slides() -> None:
    """Nothing pushes it sideways, and it has no hops."""
    paddle = Paddle((0.5, 0.0), (2.0, 0.0), half_width=1.0, radius=0.05, max_speed=1.0, name="p")
    world = World(Scene(ball=Ball(radius=R, b=0.5), elements=(paddle,)), balls=2)
    world.reset(position=[(1.0, 0.1), (1.0, 0.1 + 2 * R)], velocity=[(0.0, 0.0), (0.0, 0.0)])
    world.advance(0.1)
    world.command("p", 0.5)
    world.advance(0.5)
    assert np.abs(world.velocity).max() < 1e-9
    assert world._state.worlds[0]["events"] < 100


def test_a_ball_rolls_off_another_one_as_off_a_bumper() -> None:
    """The lower one is held by friction; the upper one leaves it at cos = 2/3 of that of its start, on a parabola."""
    world = World(Scene(ball=Ball(radius=R), elements=(Wall((-9, 0), (99, 0), f=0.0),)), balls=2)
    tilt, d, g = 1e-2, 2.0 * R, 9.81
    start = (d * math.sin(tilt), R + d * math.cos(tilt))
    world.reset(position=[(0.0, R), start], velocity=[(0.0, 0.0), (0.0, 0.0)])
    rows = world.advance(1.0, ledger=True)
    cosine = 2.0 / 3.0 * math.cos(tilt)
    sine, speed = math.sqrt(1.0 - cosine**2), math.sqrt(g * d * cosine)
    down = speed * sine
    seconds = (math.sqrt(down**2 + 2.0 * g * d * cosine) - down) / g
    land = rows[(rows["ball"] == 1) & (rows["element"] == 0)][0]
    assert land["x"] == pytest.approx(d * sine + speed * cosine * seconds, rel=1e-4)
    assert land["vx0"] == pytest.approx(speed * cosine, rel=1e-4)
    assert world.velocity[0].tolist() == [0.0, 0.0]


def test_rows_of_a_cluster_keep_momentum_and_say_what_they_are() -> None:
    world = box_of(10)
    count = len(world.scene.elements)
    rows = world.advance(3.0, ledger=True)
    pairs = rows[(rows["element"] >= count) & np.isin(rows["kind"], [BOUNCE, ABSORBED])].reshape(-1, 2)
    assert (pairs["kind"][:, 0] == pairs["kind"][:, 1]).all()
    assert {BOUNCE, ABSORBED} == set(pairs["kind"][:, 0].tolist())
    for v in ("vx", "vy"):
        change = pairs[v + "1"] - pairs[v + "0"]
        assert change.sum(axis=1) == pytest.approx(0.0, abs=1e-13)


def test_a_cluster_is_the_same_in_pieces_and_from_snapshots() -> None:
    whole, pieces = box_of(10), box_of(10)
    whole.advance(1.5)
    for _ in range(96):
        pieces.advance(1.5 / 96)
        other = box_of(10)
        other.restore(pieces.snapshot())
        pieces = other
    assert pieces.position.tobytes() == whole.position.tobytes()
    assert pieces.velocity.tobytes() == whole.velocity.tobytes()


@pytest.mark.parametrize("change", ["push", "hit"])
def test_a_ball_on_a_curve_goes_on_from_where_it_is_changed(change: str) -> None:
    """Not from where its slide began: a push finds it half-way down a bowl, another ball at the bottom."""
    bowl = Arc((0.0, 0.0), 1.0, math.pi, 2.0 * math.pi)
    world = World(Scene(ball=Ball(radius=R), elements=(bowl,)), balls=2)
    world.reset(position=[(-0.95, 0.0), (0.0, -0.95)], velocity=[(0.0, 0.0), (0.0, 0.0)])
    if change == "push":
        world.advance(0.3)
        place, speed = world.position[0], world.velocity[0]
        world.push((0.0, 0.0))
    else:
        rows = world.advance(0.5, ledger=True)
        while not (rows["element"] > 0).any():
            rows = world.advance(1e-3, ledger=True)
        hit = rows[(rows["element"] > 0) & (rows["ball"] == 0)][0]
        place, speed = np.array([hit["x"], hit["y"]]), np.array([hit["vx1"], hit["vy1"]])
    assert math.dist(place, (-0.95, 0.0)) > 0.2
    world.advance(1e-3)
    assert world.position[0] == pytest.approx(place + speed * 1e-3, abs=5e-3)


@pytest.mark.slow
def test_random_piles() -> None:
    """Soak: 10^5 balls and more, in 20 000 scenes."""
    met: Counter[str] = Counter()
    for seed in range(soak_count(150, 20_000)):
        rng = np.random.default_rng([2026, seed])
        scene, balls = pile_scene(rng), int(rng.choice([2, 3, 4, 6, 10]))
        start = pile_start(rng, scene, balls)
        if start is None:
            continue
        world = World(scene, balls=balls)
        world.reset(position=start[0], velocity=start[1])
        before = energy(world)
        for _ in range(16):
            world.advance(0.25, max_events=60_000)
            assert not list(faults(world)), (seed, world.time, list(faults(world)))
            # Forces that are constant for a while do a little work.
            assert energy(world) <= before + 5e-6 * (1.0 + abs(before)), (seed, world.time)
            before = energy(world)
            out = OK not in world.status
            met["budget" if out else "ok"] += 1
            if out:
                assert scene.gravity == (0.0, 0.0) or scene.ball.b == 1.0, (seed, world.time)
                break
    print(dict(met))  # noqa: T201
    assert met["budget"] <= 0.001 * met["ok"]
