"""World against pymunk (Chipmunk), an engine of another kind: fixed steps, overlap and push-out.

Its state is set from World's during every flight, so that errors do not pile up: pymunk flies on through one bounce,
and its state half a flight later is compared with World's. Chipmunk's error is of first order in its step (the
bounce falls on a step's end, gravity is stepped), so it must fall in proportion to the step; where both meant
different physics, it would stay.
"""

import math

import numpy as np
import pytest

from bounce_env.engine.world import World
from bounce_env.report.methods.pymunk_space import PymunkScene
from bounce_env.scene import Ball, Bumper, Scene, Wall
from tests.conftest import soak_count
from tests.reference.random_scenes import box, direction, free_point

pytestmark = pytest.mark.slow

STEPS = 240 * 2 ** np.arange(5)  # per second: 240 to 3840
SHORTEST_FLIGHT = 0.05  # [s], 12 of the longest steps before the bounce and after it
RADIUS = 0.05


def scene_with(seed, gravity):
    """Walls and bumpers, b <= 1 (Chipmunk multiplies both bodies' elasticity as World does), no friction."""
    rng = np.random.default_rng(seed)
    elements = (
        *box(2.0, 2.0, surfaces=[{"b": rng.uniform(0.8, 1)} for _ in range(4)]),
        Wall((0.5, 0.4), (0.9, 0.6), b=0.9),
        Bumper((0.6, 1.3), 0.2, b=0.95),
        Bumper((1.4, 0.9), 0.3),
    )
    scene = Scene(gravity=gravity, ball=Ball(radius=RADIUS, b=0.95), elements=elements)
    return scene, free_point(rng, (0, 0), (2, 2), elements, 2 * RADIUS), direction(rng, 3.0)


def flights(scene, position, velocity, seconds):
    """State, duration up to the bounce, off which element, state after it, duration of the next flight."""
    world = World(scene)
    world.reset(position=position, velocity=velocity)
    rows = world.advance(seconds, ledger=True)
    state = np.stack([rows[name] for name in ("x", "y", "vx1", "vy1")], axis=1)
    flight = np.diff(rows["time"])
    for k in range(len(flight) - 1):
        if min(flight[k], flight[k + 1]) > SHORTEST_FLIGHT:
            yield state[k], flight[k], rows[k + 1]["element"], state[k + 1], flight[k + 1]


def flown(state, gravity, t):
    p, v, g = state[:2], state[2:], np.array(gravity)
    return np.concatenate([p + v * t + g * t * t / 2, v + g * t])


def stepped(scene, state, steps, dt):
    peer = PymunkScene(scene)
    peer.ball.position, peer.ball.velocity = tuple(state[:2]), tuple(state[2:])
    for _ in range(steps):
        peer.space.step(dt)
    return np.array([*peer.ball.position, *peer.ball.velocity])


def order_of(errors):
    """Exponent of the step in the median error; `errors` has one row a flight and one column a step length."""
    return -np.polyfit(np.log2(STEPS), np.log2(np.median(errors, axis=0)), 1)[0]


@pytest.mark.parametrize("gravity", [(0.0, 0.0), (0.3, -2.0)], ids=["straight", "falling"])
def test_error_of_pymunk_falls_in_proportion_to_its_step(gravity):
    """Position [m] and velocity [m/s] are compared half a flight after the bounce."""
    places, velocities = [], []
    for seed in range(soak_count(12, 100)):
        scene, position, velocity = scene_with(seed, gravity)
        for start, flight, element, after, following in flights(scene, position, velocity, 4.0):
            off = flight / 4  # is flown exactly: off the surface
            by_step = []
            for rate in STEPS:
                steps = math.ceil((flight - off + following / 2) * rate)
                found = stepped(scene, flown(start, gravity, off), steps, 1 / rate)
                by_step.append(found - flown(after, gravity, off + steps / rate - flight))
            places.append(np.hypot(*np.array(by_step).T[:2]))
            velocities.append((isinstance(scene.elements[element], Bumper), np.hypot(*np.array(by_step).T[2:])))
    assert len(places) > soak_count(60, 500)
    assert order_of(places) == pytest.approx(1.0, abs=0.2)
    off_bumpers = [v for bumper, v in velocities if bumper]
    off_walls = [v for bumper, v in velocities if not bumper]
    assert min(len(off_bumpers), len(off_walls)) > soak_count(20, 150)
    assert order_of(off_bumpers) == pytest.approx(1.0, abs=0.2)
    if gravity == (0.0, 0.0):  # then Chipmunk's velocity off a straight wall is the law's at any step
        assert np.median(off_walls, axis=0).max() < 1e-14
    else:
        assert order_of(off_walls) == pytest.approx(1.0, abs=0.2)
