"""The baselines know where a ball lands, and are worth beating in the order of what they know."""

from dataclasses import replace

import numpy as np
import pytest

from agents.baselines import BASELINES
from agents.command import Refused
from agents.evaluate import play
from agents.paddle_players import Mover, Table, landing
from agents.results import estimate
from agents.task import Task
from bounce_env import Ball, Bumper, Paddle, Scene, Sensor, Wall, World, load_scene
from tests.conftest import soak_count

TASK = Task("Bounce/Paddle-v0")
PLAYERS = BASELINES[TASK.env_id]
KNOWING = ("random", "follow", "predictor")


def empty_field(*, b: float, f: float, gravity: float, width: float = 1.0) -> Scene:
    """A field in which a ball bounces off all walls before it lands."""
    paddle = Paddle((0.2, 0.08), (width - 0.2, 0.08), half_width=0.05, radius=0.01, max_speed=1.0)
    sides = [Wall((x, -0.1), (x, 1.4), b=b, f=f) for x in (0.0, width)]
    top = Wall((0.0, 1.4), (width, 1.4), b=0.7, f=0.8)
    bumper, drain = Bumper((width / 2.0, 0.9), 0.05), Sensor((0.0, -0.05), (width, -0.05), drain=True)
    return Scene(
        gravity=(0.0, -gravity), ball=Ball(0.02, b=0.95), max_speed=9.0, elements=(*sides, top, bumper, drain, paddle)
    )


@pytest.mark.parametrize(
    ("b", "f", "gravity", "width"), [(0.9, 1.0, 1.5, 1.0), (0.6, 0.7, 3.0, 1.6), (1.0, 1.0, 0.0, 1)]
)
def test_landing_is_where_the_engine_says(b: float, f: float, gravity: float, width: float) -> None:
    scene = empty_field(b=b, f=f, gravity=gravity, width=width)
    table = Table.of(scene)
    sensor = Sensor((-1.0, table.contact), (3.0, table.contact))
    keep = tuple(e for e in scene.elements if isinstance(e, Wall))
    world = World(replace(scene, elements=(*keep, sensor)))
    generator = np.random.default_rng(1)
    n = soak_count(200, 20_000)
    x, y = generator.uniform(table.left, table.right, n), generator.uniform(table.contact + 0.01, table.top, n)
    vx, vy = generator.uniform(-6.0, 6.0, n), generator.uniform(-2.5, 2.5, n)
    predicted = landing(table, x, y, vx, vy)
    landed, bounces = 0, 0
    for k in range(n):
        world.reset(position=(x[k], y[k]), velocity=(vx[k], vy[k]))
        ledger = world.advance(20.0, ledger=True)
        assert ledger is not None
        crossings = ledger[ledger["kind"] == 3]
        if len(crossings):  # without gravity a level flight never lands
            bounces += int((ledger["time"] < crossings["time"][0]).sum())
            landed += 1
            assert abs(crossings["x"][0] - predicted[k]) < 1e-12
    assert landed > 0.95 * n
    assert bounces > n  # walls are met, not only open air


def test_a_ball_that_cannot_land_is_where_it_is() -> None:
    table = Table.of(empty_field(b=0.9, f=1.0, gravity=1.5))
    below = landing(table, np.array([0.3]), np.array([0.0]), np.array([1.0]), np.array([-1.0]))
    assert below.tolist() == [0.3]


def observation(table: Table, ball: tuple[float, float, float, float], paddle: float) -> np.ndarray:
    """The inverse of what the baselines read, from the card of the environment."""
    x, y, vx, vy = ball
    low, high = table.rail
    seen = [2 * (x - table.x) / table.width - 1, 2 * (y - table.y) / table.height - 1, vx / 2, vy / 2]
    return np.array([[*seen, 2 * (paddle - low) / (high - low) - 1]], np.float32)


def test_observations_are_read_as_the_environment_writes_them() -> None:
    env = TASK.single()
    seen, _ = env.reset(seed=3, options={"position": (0.31, 0.62), "velocity": (0.4, -0.3)})
    table = Table.of(load_scene("paddle"))
    np.testing.assert_allclose(seen, observation(table, (0.31, 0.62, 0.4, -0.3), 0.5)[0], atol=1e-6)
    read = [float(value[0]) for value in table.ball(seen[None])]
    np.testing.assert_allclose(read, (0.31, 0.62, 0.4, -0.3), atol=1e-6)
    np.testing.assert_allclose(table.paddle(seen[None]), 0.5, atol=1e-6)


@pytest.mark.parametrize("kwargs", [{}, {"frame_skip": 4}, {"action": "discrete"}])
def test_a_mover_goes_at_full_speed_and_stops_where_it_wants_to_be(kwargs: dict[str, object]) -> None:
    task = Task(TASK.env_id, kwargs)
    env = task.single()
    mover = Mover(task, lambda table, seen: np.full(len(seen), 0.3))
    seen, _ = env.reset(seed=0, options={"position": (0.5, 1.3), "velocity": (0.0, 0.0)})
    steps_needed = int(np.ceil(0.2 / mover.reach - 1e-9))
    places = [0.5]
    for _ in range(steps_needed + 1):
        seen, *_ = env.step(mover(seen[None])[0])
        places.append(float(mover.table.paddle(seen[None])[0]))
    np.testing.assert_allclose(-np.diff(places)[: steps_needed - 1], mover.reach, rtol=1e-5)
    # A discrete paddle can only stop at whole steps: the nearest one.
    tolerance = mover.reach / 2.0 if kwargs.get("action") == "discrete" else 1e-5
    assert abs(places[-1] - 0.3) <= tolerance + 1e-6
    assert abs(places[-1] - places[-2]) < 1e-5


def test_the_more_a_baseline_knows_the_higher_it_scores() -> None:
    for kwargs in ({}, {"action": "discrete"}):
        task = Task(TASK.env_id, kwargs)
        levels = [estimate(play(task, PLAYERS[name](task), soak_count(300, 3000)).scores) for name in KNOWING]
        random, follow, predictor = levels
        assert random.hi < follow.lo
        assert follow.hi < predictor.lo


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"gravity": (0.5, -1.5)}, "gravity that points down"),
        ({"gravity": (0.0, 1.5)}, "gravity that points down"),
    ],
)
def test_a_field_that_a_baseline_cannot_read_is_refused(change: dict[str, object], words: str) -> None:
    with pytest.raises(Refused, match=words):
        Table.of(replace(load_scene("paddle"), **change))


def test_a_slanted_wall_or_rail_is_refused() -> None:
    scene = load_scene("paddle")
    slanted = tuple(
        replace(e, rail_end=(e.rail_end[0], e.rail_end[1] + 0.1)) if isinstance(e, Paddle) else e
        for e in scene.elements
    )
    with pytest.raises(Refused, match="a level rail"):
        Table.of(replace(scene, elements=slanted))
    slanted = tuple(
        replace(e, end=(e.end[0] - 0.05, e.end[1])) if getattr(e, "name", "") == "left" else e for e in scene.elements
    )
    with pytest.raises(Refused, match="vertical side walls"):
        Table.of(replace(scene, elements=slanted))
