"""What a ball does on the built-in table `guides`: it is what the file's comments say."""

import math

import numpy as np
import pytest

from bounce_env import World, load_scene
from bounce_env.engine.memory.records import OUT
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

BOUNCE, BEGINS, ENDS, SENSOR = range(4)

TABLE = load_scene("guides")
NAMES = [element.name for element in TABLE.elements]
LANE = 0.4775
"""The middle of the lane [m]."""

ON_GUIDE = np.array([0.03125, 0.421875]) + TABLE.ball.radius * np.array([1.0, 2.0]) / math.sqrt(5)
"""Where the ball's centre is when it touches the middle of guide_1 [m]."""


@pytest.fixture(scope="module")
def world() -> World:
    return World(TABLE)


def events(world: World, position, velocity=(0.0, 0.0)) -> list[tuple[float, int, str]]:
    """Time, kind and element of all that happens to a ball until it has drained."""
    return [(row["time"], int(row["kind"]), NAMES[row["element"]]) for row in ledger(world, position, velocity)]


def ledger(world: World, position, velocity):
    world.reset(position=position, velocity=velocity)
    rows = world.advance(60.0, ledger=True)
    assert world.status.tolist() == [OUT]
    assert NAMES[rows[-1]["element"]] == "drain"
    return rows


def test_a_ball_rolls_down_the_guide_over_its_joints(world):
    """No bounce where one wall goes on in the other's line; the times are those of a block on a slope of 1 in 2."""
    first, *_ = seen = events(world, ON_GUIDE)
    assert first == (0.0, BEGINS, "guide_1")
    joints = [(ENDS, "guide_1"), (BEGINS, "guide_2"), (ENDS, "guide_2"), (BEGINS, "guide_3")]
    assert [event[1:] for event in seen[1:5]] == joints
    along = -TABLE.gravity[1] / math.sqrt(5)
    for (time, *_), x in zip(seen[1:5], (0.0625, 0.0625, 0.125, 0.125), strict=True):
        distance = (x - 0.03125) * math.sqrt(5) / 2
        assert time == pytest.approx(math.sqrt(2 * distance / along), rel=1e-12)
    assert seen[5][1:] == (BOUNCE, "guide_4")  # less steep: it runs into it


def test_a_ball_that_drops_on_the_guide_hops_and_then_rolls(world):
    kinds = [event[1:] for event in events(world, ON_GUIDE + np.array([0.0, 0.01]))]
    assert kinds[0] == (BOUNCE, "guide_1")
    rolling = next(i for i, event in enumerate(kinds) if event[0] == BEGINS)
    assert kinds[rolling - 1] == (BOUNCE, kinds[rolling][1])
    assert kinds[rolling][1] in {"guide_1", "guide_2", "guide_3"}


def test_a_launched_ball_passes_the_gate_and_does_not_return_to_the_lane(world):
    rng = np.random.default_rng(7)
    struck = set()
    for _ in range(soak_count(40, 4000)):
        start = (rng.uniform(0.4695, 0.4855), 0.05)
        rows = ledger(world, start, (rng.uniform(-0.02, 0.02), rng.uniform(1.5, 2.5)))
        names = [NAMES[element] for element in rows["element"]]
        assert names.index("arch") < min([names.index("gate")] if "gate" in names else [len(names)])
        assert rows["x"][-1] < 0.455  # drained in the open, not in the lane
        struck.update(names)
    assert struck == set(NAMES)


def test_a_ball_launched_too_weakly_comes_back_through_the_lane(world):
    assert [event[1:] for event in events(world, (LANE, 0.05), (0.0, 1.1))] == [(SENSOR, "drain")]


def test_a_ball_that_falls_on_the_gate_bounces_off_to_the_left(world):
    rows = ledger(world, (0.48, 0.76), (0.0, 0.0))
    assert (rows["kind"][0], NAMES[rows["element"][0]]) == (BOUNCE, "gate")
    assert rows["x"][-1] < 0.455


def test_a_bumper_kicks_once_within_its_cooldown(world):
    """It leaves faster by the kick than the law says; while the bumper cools it leaves by the law."""
    rows = ledger(world, (0.2001, 0.66), (0.0, -0.5))
    bumper = NAMES.index("bumper_left")
    hits = [row for row in rows if row["element"] == bumper]
    assert len(hits) > 0
    last = -math.inf
    for row in hits:
        closing = -(row["vx0"] * row["nx"] + row["vy0"] * row["ny"])
        leaving = row["vx1"] * row["nx"] + row["vy1"] * row["ny"]
        kicked = closing > 0.05 and row["time"] >= last + 0.1
        assert leaving == pytest.approx(0.6 * closing + (0.8 if kicked else 0.0), rel=1e-9)
        last = row["time"] if kicked else last
