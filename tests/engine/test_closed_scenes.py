"""No ball escapes from a closed scene, at any speed, point or disc, with or without gravity."""

import math

import numpy as np
import pytest

from bounce_env import Arc, Ball, Scene
from bounce_env.engine.memory.records import OK
from bounce_env.engine.world_batch import WorldBatch
from tests.conftest import soak_count
from tests.engine.closed_scenes import closed_scene, rows_of

pytestmark = pytest.mark.slow

BALLS_PER_SCENE = soak_count(100, 1000)
SECONDS = 10.0


@pytest.mark.parametrize("radius", [0.0, 0.01, 0.03])
@pytest.mark.parametrize("gravity", [(0.0, 0.0), (0.0, -1.0), (6.0, -8.0), (0.0, -100.0)])
def test_balls_stay_inside_and_keep_their_energy(radius: float, gravity: tuple[float, float]) -> None:
    """Soak: 12 kinds x 84 scenes x 1000 balls > 10^6 balls, 10 s each."""
    rng = np.random.default_rng([int(1000 * radius), int(gravity[0]), int(-gravity[1])])
    balls = bounces = 0
    for _ in range(soak_count(4, 84)):
        starts = None
        while starts is None:
            closed = closed_scene(rng, radius, gravity)
            starts = closed.starts(rng, BALLS_PER_SCENE)
        worlds = WorldBatch([closed.scene], np.zeros(BALLS_PER_SCENE, int))
        worlds.reset(position=starts[0], velocity=starts[1])
        before = energy(rows_of(worlds), gravity)
        assert worlds.advance(SECONDS) == 0, closed.scene
        now = rows_of(worlds)
        assert np.isfinite(now).all(), closed.scene
        assert (worlds.status == OK).all(), closed.scene
        assert all(closed.holds(x, y) for x, y in now[:, :2].tolist()), closed.scene
        # Each bounce rounds the energy by a few units in the last place of its largest part.
        scale = np.abs(before) + np.hypot(*gravity) * 1.5 + np.square(now[:, 2:]).sum(1)
        hits = worlds.counts.bounces
        assert (np.abs(energy(now, gravity) - before) <= 4e-15 * scale * (hits + 10)).all(), closed.scene
        balls, bounces = balls + BALLS_PER_SCENE, bounces + int(hits.sum())
    print(f"radius {radius}, gravity {gravity}: {balls} balls, {bounces} bounces, none escaped")  # noqa: T201
    assert bounces > balls


@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_elastic_bounces_inside_a_circle_add_up_to_no_gain_and_no_loss(gravity: float) -> None:
    """A normal is rounded alike each time that a ball comes to it: 10^4 bounces would add that up to 10^-13."""
    rng = np.random.default_rng(1)
    scene = Scene(gravity=(0.0, -gravity), ball=Ball(radius=0.05), elements=(Arc((0, 0), 1.0, 0, 2 * math.pi, b=1.0),))
    worlds = WorldBatch([scene], np.zeros(32, int))
    worlds.reset(position=rng.uniform(-0.5, 0.5, (32, 2)), velocity=rng.uniform(-3.0, 3.0, (32, 2)))
    before, drift = energy(rows_of(worlds), (0.0, -gravity)), []
    scale = np.abs(before) + 2.0 * gravity
    for _ in range(300):
        worlds.advance(10.0)
        drift.append((energy(rows_of(worlds), (0.0, -gravity)) - before) / scale)
    assert np.median(worlds.counts.bounces) > 2_000
    assert np.median(np.abs(drift[-1])) < 2e-14
    assert np.abs(drift).max() < 2e-13


def energy(balls: np.ndarray, gravity: tuple[float, float]) -> np.ndarray:
    """Energy per mass [J/kg] of rows x, y, vx, vy."""
    return 0.5 * np.square(balls[:, 2:]).sum(1) - balls[:, :2] @ np.array(gravity)
