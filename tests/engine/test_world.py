"""World: what it does with a scene, with commands, with the budget, and with bad input."""

import math
from dataclasses import replace

import numpy as np
import pytest

from bounce_env import Ball, Bumper, Paddle, Scene, Sensor, Wall, World
from bounce_env.engine.memory.records import BOUNCE, BUDGET, CROSSING, OK, OUT, PART_STOPS
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

BOX = (
    Wall((0.0, 0.0), (1.0, 0.0), name="floor"),
    Wall((1.0, 0.0), (1.0, 1.0), name="right"),
    Wall((1.0, 1.0), (0.0, 1.0), name="top"),
    Wall((0.0, 1.0), (0.0, 0.0), name="left"),
)
FREE = Scene(gravity=(0.0, 0.0), elements=BOX)
RAIL = Paddle((0.3, 0.2), (0.7, 0.2), half_width=0.1, radius=0.02, max_speed=2.0, name="paddle")
PADDLE = Scene(gravity=(0.0, 0.0), ball=Ball(radius=0.02), max_speed=9.0, elements=(*BOX, RAIL))


def started(scene: Scene, position: tuple[float, float], velocity: tuple[float, float]) -> World:
    world = World(scene)
    world.reset(position=position, velocity=velocity)
    return world


def test_flight_and_bounces_of_a_point_in_a_box() -> None:
    """By unfolding: 3.25 s at (0.5, 0.25) m/s from the middle."""
    world = started(FREE, (0.5, 0.5), (0.5, 0.25))
    ledger = world.advance(3.25, ledger=True)
    assert ledger is not None
    assert ledger["time"].tolist() == [1.0, 2.0, 3.0]
    assert ledger["element"].tolist() == [1, 2, 3]
    assert ledger["kind"].tolist() == [BOUNCE] * 3
    assert world.position.tolist() == [[0.125, 1.0 - 0.3125]]
    assert world.velocity.tolist() == [[0.5, -0.25]]
    assert world.time == 3.25
    assert world.status.tolist() == [OK]


def test_ledger_rows_say_all_of_a_bounce() -> None:
    world = started(PADDLE, (0.5, 0.5), (0.0, -1.0))
    row = world.advance(0.5, ledger=True)[0]  # type: ignore[index]
    assert row["element"] == 4
    assert (row["x"], row["y"]) == pytest.approx((0.5, 0.24), rel=1e-15)
    assert (row["nx"], row["ny"]) == (0.0, 1.0)
    assert (row["vx0"], row["vy0"], row["vx1"], row["vy1"]) == (0.0, -1.0, 0.0, 1.0)
    assert (row["ux"], row["uy"]) == (0.0, 0.0)


def test_long_ledgers_are_whole() -> None:
    """More rows than a page of the ledger: none is lost at its border, and asking changes no bit."""
    with_ledger, without = (started(FREE, (0.5, 0.5), (300.0, 170.0)) for _ in range(2))
    seconds = float(soak_count(5, 20))
    rows = with_ledger.advance(seconds, ledger=True)
    without.advance(seconds)
    assert rows is not None
    assert len(rows) > soak_count(1250, 5000)
    assert (np.diff(rows["time"]) > 0.0).all()
    assert (rows[["vx1", "vy1"]][:-1] == rows[["vx0", "vy0"]][1:].astype(rows[["vx1", "vy1"]].dtype)).all()
    assert with_ledger.position.tobytes() == without.position.tobytes()


def test_budget_stops_at_an_event_and_goes_on() -> None:
    """`time` is that of the last event, and what follows is what would have followed."""
    whole, parts = (started(FREE, (0.5, 0.5), (0.7, 0.31)) for _ in range(2))
    whole.advance(30.0)
    ledger = parts.advance(30.0, ledger=True, max_events=7)
    assert ledger is not None
    assert len(ledger) == 7
    assert parts.status.tolist() == [BUDGET]
    assert parts.time == ledger["time"][-1]
    parts.advance(30.0 - parts.time)
    assert parts.status.tolist() == [OK]
    assert parts.velocity.tobytes() == whole.velocity.tobytes()
    assert parts.position == pytest.approx(whole.position, abs=1e-13)


def test_dropped_ball_comes_to_rest() -> None:
    """Its infinitely many bounces take sqrt(2 h / g) (1 + b) / (1 - b)."""
    scene = Scene(elements=(Wall((-1.0, 0.0), (1.0, 0.0), b=0.5),))
    world = started(scene, (0.0, 1.0), (0.0, 0.0))
    ledger = world.advance(5.0, ledger=True, max_events=5000)
    assert ledger is not None
    assert world.status.tolist() == [OK]
    assert ledger["kind"].tolist() == [0] * (len(ledger) - 1) + [1]
    assert ledger["time"][-1] == pytest.approx(math.sqrt(2.0 / 9.81) * 3.0, rel=1e-15)
    assert world.position.tolist() == [[0.0, 0.0]]
    assert world.velocity.tolist() == [[0.0, 0.0]]


def test_sensors_report_both_ways_and_do_not_touch_the_motion() -> None:
    plain = Scene(elements=(Wall((-1.0, 0.0), (1.0, 0.0)),))
    sensed = replace(plain, elements=(*plain.elements, Sensor((-1.0, 0.5), (1.0, 0.5)), Sensor((5.0, 0.5), (6.0, 0.5))))
    a, b = started(plain, (0.0, 1.0), (0.1, 0.0)), started(sensed, (0.0, 1.0), (0.1, 0.0))
    a.advance(3.0)
    ledger = b.advance(3.0, ledger=True)
    assert a.position.tobytes() == b.position.tobytes()
    assert ledger is not None
    crossings = ledger[ledger["kind"] == CROSSING]
    assert crossings["element"].tolist() == [1] * len(crossings)
    fall = math.sqrt(2.0 / 9.81)
    expected = [fall * k + s * fall * math.sqrt(0.5) for k in (0, 2, 4, 6, 8) for s in (-1.0, 1.0)]
    assert crossings["time"] == pytest.approx([t for t in expected if 0.0 < t < 3.0], rel=1e-12)
    assert (crossings["ny"] * crossings["vy0"] < 0.0).all()


def test_sensor_at_a_bounce_comes_after_it_and_touching_is_no_crossing() -> None:
    """Across the wall at the point of the bounce: one crossing there. Along the wall itself: none."""
    wall = Wall((-2.0, 0.0), (2.0, 0.0))
    scene = Scene(gravity=(0.0, 0.0), elements=(wall, Sensor((0.5, -1.0), (0.5, 1.0)), Sensor((-2.0, 0.0), (2.0, 0.0))))
    ledger = started(scene, (0.0, 0.5), (1.0, -1.0)).advance(1.0, ledger=True)
    assert ledger is not None
    assert ledger["kind"].tolist() == [BOUNCE, CROSSING]
    assert ledger["element"].tolist() == [0, 1]


def test_drain_takes_the_ball_out() -> None:
    scene = Scene(gravity=(0.0, -1.0), elements=(Sensor((-1.0, 0.0), (1.0, 0.0), drain=True),))
    world = started(scene, (0.0, 0.5), (0.0, 0.0))
    world.advance(4.0)
    assert world.status.tolist() == [OUT]
    assert world.position[0] == pytest.approx([0.0, 0.0], abs=1e-15)
    assert world.time == 4.0


def test_paddle_runs_to_its_stop_and_stands() -> None:
    world = started(PADDLE, (0.5, 0.9), (0.0, 0.0))
    assert world.cores.tolist() == [[0.4, 0.2, 0.6, 0.2]]
    world.command("paddle", 0.5)
    ledger = world.advance(1.0, ledger=True)
    assert ledger is not None
    assert ledger["kind"].tolist() == [PART_STOPS]
    assert ledger["ball"].tolist() == [-1]
    assert ledger["time"][0] == pytest.approx(0.4, rel=1e-15)
    assert world.cores[0] == pytest.approx([0.6, 0.2, 0.8, 0.2], rel=1e-15)
    world.command("paddle", 2.0)  # against the stop: nothing moves
    world.advance(1.0)
    assert world.cores[0] == pytest.approx([0.6, 0.2, 0.8, 0.2], rel=1e-15)
    world.command("paddle", -2.0)
    world.advance(0.1)
    assert world.cores[0] == pytest.approx([0.4, 0.2, 0.6, 0.2], rel=1e-14)


def test_a_moving_paddle_drags_the_ball_along() -> None:
    """f = 0 takes the surface's tangential speed over whole."""
    sticky = replace(PADDLE, elements=(*BOX, replace(RAIL, f=0.0)))
    world = started(sticky, (0.6, 0.5), (0.0, -1.0))
    world.command("paddle", 0.5)
    world.advance(0.3)
    assert world.velocity[0] == pytest.approx([0.5, 1.0], rel=1e-15)


def test_a_paddle_from_the_side_strikes_a_resting_ball() -> None:
    """v' = 2 u: the round end overtakes a ball that stands in its way."""
    world = started(PADDLE, (0.7, 0.2), (0.0, 0.0))
    world.command("paddle", 1.0)
    ledger = world.advance(0.15, ledger=True)
    assert ledger is not None
    assert ledger["time"][0] == pytest.approx(0.06, rel=1e-12)
    assert world.velocity[0] == pytest.approx([2.0, 0.0], rel=1e-12)


def test_the_same_command_again_changes_no_bit() -> None:
    once, often = (started(PADDLE, (0.4, 0.8), (0.3, -1.1)) for _ in range(2))
    once.command("paddle", 0.125)
    once.advance(2.0)
    for _ in range(64):
        often.command("paddle", 0.125)
        often.advance(2.0 / 64)
    assert once.position.tobytes() == often.position.tobytes()


def test_speed_cap() -> None:
    scene = replace(FREE, max_speed=3.0, elements=tuple(replace(wall, b=2.0) for wall in BOX))
    world = started(scene, (0.5, 0.5), (0.0, 1.0))
    world.advance(5.0)
    assert abs(world.velocity[0, 1]) == pytest.approx(3.0, rel=1e-15)


@pytest.mark.parametrize(
    ("action", "words"),
    [
        (
            lambda w: w.reset(position=(0.5, 0.01), velocity=(0, 0)),
            r"overlaps elements\[0\] \(wall 'floor'\) by 0\.01 m",
        ),
        (lambda w: w.reset(position=(0.5, 0.2), velocity=(0, 0)), r"overlaps elements\[4\] \(paddle 'paddle'\)"),
        (lambda w: w.reset(position=(0.5, math.nan), velocity=(0, 0)), "position = .*must be finite"),
        (lambda w: w.reset(position=(0.5, 0.5), velocity=(math.inf, 0)), "velocity = .*must be finite"),
        (lambda w: w.reset(position=(0.5,), velocity=(0, 0)), r"position = .*must be \(x, y\)"),
        (lambda w: w.advance(-1.0), "seconds = -1.0: must be finite and >= 0"),
        (lambda w: w.advance(math.nan), "seconds = nan: must be finite and >= 0"),
        (lambda w: w.advance(1.0, max_events=0), "max_events = 0: must be >= 1"),
        (lambda w: w.command("flipper", 1.0), r"'flipper' must be one of the scene's parts: \['paddle'\]"),
        (lambda w: w.command("", 1.0), "'' must be one of"),
        (lambda w: w.command("paddle", math.nan), "'paddle' = nan: must be finite and at most 2.0"),
        (lambda w: w.command("paddle", 2.5), "'paddle' = 2.5: must be finite and at most 2.0"),
    ],
)
def test_bad_input_names_what_is_wrong_and_changes_nothing(action, words: str) -> None:  # type: ignore[no-untyped-def]
    world = started(PADDLE, (0.5, 0.5), (0.3, 0.4))
    world.advance(1.0)
    before = (world.position.tobytes(), world.velocity.tobytes(), world.cores.tobytes(), world.time)
    with pytest.raises(ValueError, match=words):
        action(world)
    assert (world.position.tobytes(), world.velocity.tobytes(), world.cores.tobytes(), world.time) == before


def test_nothing_before_reset() -> None:
    with pytest.raises(RuntimeError, match="reset the world"):
        World(FREE).advance(1.0)
    with pytest.raises(ValueError, match="balls = 0: must be a whole number from 1 to"):
        World(FREE, balls=0)
    with pytest.raises(TypeError, match="must be a Scene"):
        World("paddle")  # type: ignore[arg-type]


def test_start_exactly_touching_and_overlapping_by_round_off() -> None:
    scene = replace(FREE, ball=Ball(radius=0.25), elements=(*BOX, Bumper((0.5, 0.5), 0.125)))
    for y in (0.25 - 1e-15, 0.25, 0.25 + 1e-15):
        world = started(replace(scene, elements=BOX), (0.5, y), (0.0, 1.0))
        world.advance(0.25)
        assert world.position[0] == pytest.approx([0.5, 0.5], abs=1e-14)
