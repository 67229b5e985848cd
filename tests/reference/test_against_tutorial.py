"""World against the tutorial's own algorithm (`engine/tutorial.py`, every wall checked again)."""

import numpy as np
import pytest

from bounce_env.engine import tutorial
from bounce_env.engine.world import World
from tests.conftest import soak_count
from tests.reference.random_scenes import walls_only

pytestmark = pytest.mark.slow

TICKS = 60
DT = 0.25  # long enough for several bounces in one tick
SCENES = soak_count(40, 500)


def started(case):
    world = World(case.scene)
    world.reset(position=case.position, velocity=case.velocity)
    return world


def state_of(world):
    return np.concatenate([world.position[0], world.velocity[0]])


@pytest.mark.parametrize("lossy", [False, True])
def test_straight_flight_equals_the_tutorial(lossy):
    bounces = 0
    for seed in range(SCENES):
        case = walls_only(seed, lossy=lossy)
        world = started(case)
        state = tutorial.start(case.scene, case.position, case.velocity)
        for tick in range(TICKS):
            bounces += len(world.advance(DT, ledger=True))
            state = tutorial.step(case.scene, state, DT)
            assert state_of(world) == pytest.approx((*state.position, *state.velocity), rel=0, abs=1e-9), (
                seed,
                tick,
            )
    assert bounces > 15 * SCENES


def test_closest_wall_only_is_not_what_the_engine_does():
    """So the comparison above can tell the tutorial's two versions apart."""
    differ = 0
    for seed in range(SCENES):
        case = walls_only(seed)
        world = started(case)
        world.advance(TICKS * DT)
        state = tutorial.run(case.scene, case.position, case.velocity, DT, TICKS, recheck=False)
        differ += np.abs(world.position[0] - state.position).max() > 1e-3
    assert differ > SCENES / 2


def test_under_gravity_the_tutorial_converges_to_the_engine_with_its_tick():
    """Its error is of first order in the tick: it halves with it.

    In one scene the factor wanders with the share of the tick at which a bounce falls, and a long tick may
    pass the end of a wall on its other side; the median over scenes does neither.
    """
    seconds, halvings = 1.0, np.arange(5, soak_count(10, 12))
    scenes = soak_count(24, 200)
    errors, bounces = [], 0
    for seed in range(scenes):
        case = walls_only(seed, gravity=(0.5, -2.0))
        world = started(case)
        bounces += len(world.advance(seconds, ledger=True))
        ends = [tutorial.run(case.scene, case.position, case.velocity, seconds / 2**k, int(2**k)) for k in halvings]
        errors.append([np.linalg.norm((*end.position, *end.velocity) - state_of(world)) for end in ends])
    assert bounces > scenes
    order = -np.polyfit(halvings, np.log2(np.median(errors, axis=0)), 1)[0]
    assert order == pytest.approx(1.0, abs=0.15)
