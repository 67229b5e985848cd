"""Several balls: how they hit each other, and that nothing about it depends on what must not matter."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from bounce_env import Ball, Scene, Sensor, Wall, World
from bounce_env.engine.memory.records import OK, OUT
from bounce_env.engine.tolerances import MEETINGS_WITHOUT_ROOM

R = 0.125
FREE = Scene(gravity=(0.0, 0.0), ball=Ball(radius=R), elements=(Wall((-9, -2), (9, -2), name="floor"),))
CORNERS = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
BOX = tuple(Wall(p, q) for p, q in zip(CORNERS, CORNERS[1:] + CORNERS[:1], strict=True))
CROWD = Scene(gravity=(0.0, -1.0), ball=Ball(radius=R, b=0.9), elements=BOX)
PLACES = [(-0.5, 0.5), (0.5, 0.5), (0.0, 0.0), (-0.5, -0.5), (0.5, -0.625)]
SPEEDS = [(1.0, 0.5), (-0.75, 0.25), (0.5, -1.0), (0.25, 1.0), (-1.0, 0.125)]


def started(scene: Scene, places, speeds) -> World:
    world = World(scene, balls=len(places))
    world.reset(position=places, velocity=speeds)
    return world


def test_head_on_in_numbers() -> None:
    """v1' = v1 - (1 + b^2) / 2 w_n: 0.75 m at 1.5 m/s, b = 0.5."""
    world = started(replace(FREE, ball=Ball(radius=R, b=0.5)), [(0.0, 0.0), (1.0, 0.0)], [(1.0, 0.0), (-0.5, 0.0)])
    rows = world.advance(1.0, ledger=True)
    assert rows["time"].tolist() == [0.5, 0.5]
    assert rows["ball"].tolist() == [1, 0]
    assert rows["element"].tolist() == [1 + 0, 1 + 1]  # after the scene's one element
    assert rows["kind"].tolist() == [0, 0]
    assert rows["nx"].tolist() == [1.0, -1.0]
    share = 0.625 * 1.5
    assert world.velocity[:, 0] == pytest.approx([1.0 - share, -0.5 + share], rel=1e-15)
    assert rows["ux"].tolist() == [1.0, -0.5]  # the other's velocity before


def test_equal_balls_exchange_what_lies_along_the_line_between_them() -> None:
    """Elastic and oblique: the components along the line are exchanged, those across it stay, at the exact place."""
    world = started(FREE, [(0.0, 0.0), (1.0, 0.15)], [(1.0, 0.0), (0.0, 0.0)])
    rows = world.advance(1.0, ledger=True)
    across = 0.15
    along = math.sqrt(0.25**2 - across**2)
    assert rows["time"][0] == pytest.approx(1.0 - along, rel=1e-14)
    n = np.array([along, across]) / 0.25
    assert world.velocity[1] == pytest.approx(n * n[0], abs=1e-14)
    assert world.velocity[0] == pytest.approx(np.array([1.0, 0.0]) - n * n[0], abs=1e-14)


def test_cradle_passes_the_speed_on_to_the_last_ball() -> None:
    """Elastic balls in a touching row, struck on one end: only the last one leaves, with all of the speed."""
    places = [(-1.0, 0.0), *((0.25 * k, 0.0) for k in range(4))]
    world = started(FREE, places, [(1.0, 0.0)] + [(0.0, 0.0)] * 4)
    world.advance(2.0)
    assert world.velocity[:, 0] == pytest.approx([0.0, 0.0, 0.0, 0.0, 1.0], abs=1e-14)
    assert (world.velocity[:, 1] == 0.0).all()


def test_energy_and_momentum_of_an_elastic_crowd() -> None:
    """10^4 hits of five balls in a box, b = f = 1, no gravity: energy to 1e-9, no overlap."""
    world = started(replace(CROWD, gravity=(0.0, 0.0), ball=Ball(radius=R)), PLACES, SPEEDS)
    energy = float((world.velocity**2).sum())
    hits = 0
    while hits < 10_000:
        hits += len(world.advance(50.0, ledger=True))
        assert float((world.velocity**2).sum()) == pytest.approx(energy, rel=1e-9)
        place = world.position
        apart = np.hypot(*(place[:, None] - place[None, :]).T) + np.eye(5)
        assert apart.min() >= 2 * R - 1e-12
        assert (np.abs(place) <= 1.0 - R + 1e-12).all()


def test_momentum_and_energy_of_every_hit_between_balls() -> None:
    world = started(CROWD, PLACES, SPEEDS)
    rows = world.advance(4.0, ledger=True)
    pairs = np.flatnonzero((rows["element"] >= len(BOX)) & (rows["kind"] == 0)).reshape(-1, 2)
    assert len(pairs) > 5
    for one, other in rows[pairs]:
        assert one["time"] == other["time"]
        assert (one["element"], other["element"]) == (len(BOX) + other["ball"], len(BOX) + one["ball"])
        for x in ("vx", "vy"):
            assert one[x + "0"] + other[x + "0"] == pytest.approx(one[x + "1"] + other[x + "1"], abs=1e-13)
        assert math.dist((one["x"], one["y"]), (other["x"], other["y"])) == pytest.approx(2 * R, rel=1e-14)
        n = np.array([one["nx"], one["ny"]])
        before = (np.array([one["vx0"], one["vy0"]]) - [other["vx0"], other["vy0"]]) @ n
        after = (np.array([one["vx1"], one["vy1"]]) - [other["vx1"], other["vy1"]]) @ n
        assert before < 0.0
        assert after == pytest.approx(-0.81 * before, rel=1e-9)


def test_free_fall_does_not_change_when_two_balls_meet() -> None:
    """Relative flight is straight under gravity: they meet when they would without, 0.75 m at 1.5 m/s."""
    world = started(replace(FREE, gravity=(0.0, -1.0)), [(0.0, 0.0), (1.0, 0.0)], [(1.0, 0.0), (-0.5, 0.0)])
    rows = world.advance(0.75, ledger=True)
    assert rows["time"].tolist() == [0.5, 0.5]
    assert world.position[:, 1] == pytest.approx([-0.28125] * 2, rel=1e-15)


def test_nothing_depends_on_the_steps_or_on_a_snapshot() -> None:
    whole = started(CROWD, PLACES, SPEEDS)
    expected = whole.advance(8.0, ledger=True)
    steps, restored = started(CROWD, PLACES, SPEEDS), started(CROWD, PLACES, SPEEDS)
    rows = [steps.advance(8.0 / 256, ledger=True) for _ in range(256)]
    assert np.concatenate(rows).tobytes() == expected.tobytes()
    for _ in range(16):
        other = World(CROWD, balls=5)
        other.restore(restored.snapshot())
        other.advance(0.5)
        restored = other
    for world in (steps, restored):
        assert world.position.tobytes() == whole.position.tobytes()
        assert world.velocity.tobytes() == whole.velocity.tobytes()


def test_mirror_image_is_the_same_to_the_bit() -> None:
    mirror = np.array([-1.0, 1.0])
    one = started(CROWD, PLACES, SPEEDS)
    other = started(CROWD, PLACES * mirror, SPEEDS * mirror)
    for _ in range(8):
        one.advance(0.5)
        other.advance(0.5)
        assert (other.position * mirror).tobytes() == one.position.tobytes()
        assert (other.velocity * mirror).tobytes() == one.velocity.tobytes()


def test_a_drained_ball_is_out_and_the_others_go_on() -> None:
    scene = replace(FREE, elements=(Sensor((-2, -1), (0.5, -1), drain=True, name="drain"), *FREE.elements))
    world = started(scene, [(0.0, 0.0), (1.0, 0.125)], [(0.0, -1.0), (0.0, -1.0)])
    world.advance(1.0)
    assert world.status.tolist() == [OUT, OK]
    assert world.position.tolist() == [[0.0, -1.0], [1.0, -0.875]]
    world.push((-1.0, 1.0))  # over where the other one went out, nearer than its radius: nothing is there
    world.advance(2.0)
    assert world.velocity[1].tolist() == [-1.0, 0.0]
    assert world.position[1].tolist() == [-1.0, -0.875]


def test_a_pile_stays_where_it_is() -> None:
    """Three balls one above the other on a floor."""
    scene = Scene(gravity=(0.0, -1.0), ball=Ball(radius=R, b=0.5), rest_speed=0.002, elements=FREE.elements)
    places = [(0.0, -2.0 + R + 2 * R * k) for k in range(3)]
    world = started(scene, places, [(0.0, 0.0)] * 3)
    for _ in range(20):
        world.advance(0.1)
        assert np.abs(world.position - places).max() < 1e-9
        assert world.status.tolist() == [OK] * 3


@pytest.mark.parametrize("speed", [2.0, 5.0])
def test_a_ball_that_flies_over_another_one_is_not_held_back(speed: float) -> None:
    """Level, from the top of one that lies on the floor: v^2 / 2R > g, so that it never presses on it."""
    world = started(replace(FREE, gravity=(0.0, -9.81)), [(0.0, -2 + R), (0.0, -2 + 3 * R)], [(0.0, 0.0), (speed, 0.0)])
    rows = world.advance(0.05, ledger=True)
    assert (rows["element"] == 0).all()  # the one on the floor
    assert world.position[1] == pytest.approx([0.05 * speed, -2 + 3 * R - 9.81 * 0.05**2 / 2], abs=1e-14)


@pytest.mark.parametrize("g", [0.0, -1.0])
@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_balls_without_room_keep_the_way_along(g: float, speed: float) -> None:
    """Two in a gap of 1e-10 m, to and fro at 0.1 m/s, and both along it: there nothing stops them."""
    sides = Wall((0, -9), (0, 9)), Wall((4 * R + 1e-10, 9), (4 * R + 1e-10, -9))
    scene = Scene(gravity=(0.0, g), ball=Ball(radius=R), elements=sides)
    world = started(scene, [(R, 0.0), (3 * R, 0.0)], [(0.1, speed), (-0.1, speed)])
    world.advance(1e-5)
    t = world.time
    assert world.velocity[:, 1] == pytest.approx(speed + g * t, abs=1e-9)
    assert world.position[:, 1] == pytest.approx(speed * t + g * t * t / 2, abs=1e-9)


def test_a_row_that_collapses_in_free_flight_keeps_its_momentum() -> None:
    """Six inelastic balls run into each other: ever more hits in ever less time, and nothing that could stop them."""
    speeds = [(0.3 - 0.1 * k, 0.0) for k in range(6)]
    world = started(replace(FREE, ball=Ball(radius=R, b=0.5)), [(0.3 * k - 1.0, 0.0) for k in range(6)], speeds)
    for _ in range(8):
        world.advance(0.5, max_events=20_000)
        assert world.status.tolist() == [OK] * 6
        assert world.velocity[:, 0].sum() == pytest.approx(0.3, abs=1e-14)
    assert world.velocity[:, 0] == pytest.approx([0.05] * 6, abs=1e-6)
    assert (np.diff(world.position[:, 0]) >= 2 * R - 1e-11).all()


def squeezed(gap: float, g: float) -> World:
    """Two balls between walls that kick, with so much room [m] more than they need: soon as fast as max_speed."""
    sides = Wall((0, -1), (0, 1), kick=1.0), Wall((4 * R + gap, 1), (4 * R + gap, -1), kick=1.0)
    scene = Scene(gravity=(g, 0.0), ball=Ball(radius=R), max_speed=50.0, elements=sides)
    return started(scene, [(R, 0.0), (3 * R + gap / 2, 0.0)], [(0.0, 0.0), (-1.0, 0.0)])


@pytest.mark.parametrize("g", [0.0, 1.0])
@pytest.mark.parametrize("gap", [1e-12, 1e-11, 1e-10])
def test_balls_in_a_gap_of_next_to_nothing_stand(gap: float, g: float) -> None:
    """A hundred times in a nanosecond or more they would hit each other. Time runs on instead."""
    world = squeezed(gap, g)
    events = 0
    for _ in range(8):
        events += len(world.advance(0.125, ledger=True, max_events=20_000))
        assert world.status.tolist() == [OK, OK]
        assert world.position[:, 0] == pytest.approx([R, 3 * R], abs=2.0 * gap)
    assert world.velocity.tolist() == [[0.0, 0.0], [0.0, 0.0]]
    if g == 0.0:
        most = MEETINGS_WITHOUT_ROOM
        assert 2 * most < events < 4 * most  # once: then nothing moves them


def test_balls_in_a_narrow_gap_do_not_stand() -> None:
    """A hundredth of a millimetre: each hit at its instant, 5 million a second."""
    world = squeezed(1e-5, 0.0)
    world.advance(0.01)
    before = world.time
    rows = world.advance(0.002, ledger=True)
    pairs = rows[(rows["element"] > 1) & (rows["ball"] == 0)]
    speeds = set(np.abs(np.append(pairs["vx0"], pairs["vx1"])).tolist())
    assert world.time == before + 0.002
    assert speeds == {0.0, 50.0}
    assert len(pairs) == pytest.approx(0.002 * 50.0 / 1e-5, abs=1)


def test_two_hits_at_one_instant_are_told_in_order() -> None:
    """A ball that two others hit at once from both sides stays where it is."""
    world = started(FREE, [(0.0, 0.0), (-1.0, 0.0), (1.0, 0.0)], [(0.0, 0.0), (1.0, 0.0), (-1.0, 0.0)])
    world.advance(1.0)
    assert world.velocity[:, 0] == pytest.approx([0.0, -1.0, 1.0], abs=1e-15)


def test_one_dimensional_run_against_exact_fractions() -> None:
    """Three equal elastic balls on a line between two walls: speeds are passed on, so that they fly through each other
    as points in a box shorter by the three diameters; exact in fractions.
    """
    world = started(
        replace(FREE, elements=BOX), [(-0.5, 0.0), (0.0, 0.0), (0.5, 0.0)], [(0.75, 0.0), (-0.5, 0.0), (0.25, 0.0)]
    )
    world.advance(16.0)
    width = Fraction(2) - 6 * Fraction(R)
    ghosts = []
    for k, (x, v) in enumerate([(-0.5, 0.75), (0.0, -0.5), (0.5, 0.25)]):
        start = Fraction(x) + 1 - Fraction(R) - 2 * Fraction(R) * k
        way = (start + 16 * Fraction(v)) % (2 * width)
        ghosts.append(min(way, 2 * width - way))
    expected = [float(g - 1 + Fraction(R) + 2 * Fraction(R) * k) for k, g in enumerate(sorted(ghosts))]
    assert world.position[:, 0] == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(
    ("places", "words"),
    [
        ([(0.0, 0.0), (0.2, 0.0)], r"ball 1 at .* overlaps ball 0 by 0.05 m: their centres must be at least 0.25 m"),
        ([(0.0, 0.0)], "must be .* one row of it for each of 2 balls"),
    ],
)
def test_balls_must_have_room(places, words: str) -> None:
    world = World(FREE, balls=2)
    with pytest.raises(ValueError, match=words):
        world.reset(position=places, velocity=[(0.0, 0.0), (0.0, 0.0)])


def test_points_do_not_meet_each_other() -> None:
    world = started(replace(FREE, ball=Ball()), [(0.0, 0.0), (1.0, 0.0)], [(1.0, 0.0), (-1.0, 0.0)])
    assert len(world.advance(1.0, ledger=True)) == 0
