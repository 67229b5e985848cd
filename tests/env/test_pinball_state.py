"""What matters in pinball is observed: a state made anew from an observation goes on as the one that was observed."""

import math

import gymnasium as gym
import numpy as np

from bounce_env.games.episode import FPS
from bounce_env.games.pinball.setup import HOLD_FRAMES, NO, REST_FRAMES, SAVE_FRAMES, STUCK_FRAMES
from bounce_env.scene import Flipper
from tests.conftest import soak_count
from tests.env.rollouts import PINBALL
from tests.env.test_pinball import (
    BALLS,
    COOLING,
    FARMED,
    HELD,
    IDLE,
    LANES,
    LEFT_REST,
    LEFT_UP,
    MULTIPLIER,
    RIGHT_REST,
    RIGHT_UP,
    SAVE,
    TABLE,
    TARGETS,
    begun,
    index,
)

BOUNCES = 3  # after so many rounding may have grown to something
NOW = 600  # the frame that a state made anew is in


def bits(lamps):
    return int(sum(1 << k for k, lit in enumerate(lamps) if lit))


def made_anew(env, seen):
    """Another environment in the state that `seen` of `env` tells; of ball and flippers in more digits than float32.

    Raises ValueError where a flipper that is not up would be in the ball's place.
    """
    batch = env.unwrapped._batch
    ((x, y, vx, vy),), cores = batch.view(0)
    other = begun((x, y), (vx, vy), seed=999)
    twin = other.unwrapped._batch
    twin.episodes["frames"] = NOW
    for rows, name in ((twin.state.worlds, "time_hi"), (twin.state.balls, "hi"), (twin.state.balls, "next_hi")):
        assert (rows[name] == 0.0).all()
        rows[name] = NOW / FPS
    twin.episodes["ball"] = 3 - round(3 * seen[BALLS])
    memory, table = twin.memory[0], twin.rules.layout.tables[0]
    memory.saved, memory.born = seen[SAVE] == 0.0, NOW + round(SAVE_FRAMES * seen[SAVE]) - SAVE_FRAMES
    inside = table.zone_left <= x <= table.zone_right and y <= table.zone_top
    memory.zone = NOW - round(HOLD_FRAMES * seen[HELD]) if inside else -1
    memory.multiplier, memory.farmed = round(5 * seen[MULTIPLIER]), round(20 * seen[FARMED])
    memory.scored = NOW - round(STUCK_FRAMES * seen[IDLE])
    memory.left_ready, memory.right_ready = (NOW + round(REST_FRAMES * seen[k]) for k in (LEFT_REST, RIGHT_REST))
    # A button that was let go rests for longer than a flipper takes to fall.
    memory.pressed = bits(seen[up] > 0.0 and seen[k] == 0.0 for up, k in ((LEFT_UP, LEFT_REST), (RIGHT_UP, RIGHT_REST)))
    memory.lit, memory.passed = bits(seen[TARGETS]), bits(seen[LANES])
    for k, left in enumerate(seen[COOLING]):
        twin.state.cooling[0, index(f"bumper_{k + 1}")].hi = NOW / FPS + 0.1 * left
    flippers = [part for _, part in TABLE.parts if isinstance(part, Flipper)]
    for m, (flipper, (px, py, tx, ty)) in enumerate(zip(flippers, cores.tolist(), strict=True)):
        turned = math.remainder(math.atan2(ty - py, tx - px) - flipper.rest_angle, math.tau)
        motion = twin.state.motions[0, m]
        motion.offset, motion.hi = abs(turned), NOW / FPS
        motion.velocity, motion.command = 0.0, 0.0  # the next action's buttons tell more
    return other


def test_a_state_made_from_what_is_observed_goes_on_alike():
    compared = rewarded = strokes = 0
    for seed in range(soak_count(40, 1000)):
        env = gym.make(PINBALL)
        seen, _ = env.reset(seed=seed)
        script = np.repeat(np.random.default_rng(seed).integers(0, 4, 80), 5).tolist()
        before = 20 + 7 * seed % 300
        ended = False
        for action in script[:before]:
            seen, _, terminated, truncated, _ = env.step(action)
            ended = terminated or truncated
            if ended:
                break
        batch = env.unwrapped._batch
        if ended or batch.memory["serving"][0] != NO:
            continue
        try:
            other = made_anew(env, seen)
        except ValueError:
            continue
        shot, bounced = batch.memory["shot"][0], batch.state.worlds["bounces"][0]
        strokes += 0.0 < seen[LEFT_UP] < 1.0 or 0.0 < seen[RIGHT_UP] < 1.0
        for action in script[before : before + 30]:
            one, twin = env.step(action), other.step(action)
            if one[2] or batch.memory["shot"][0] != shot or batch.memory["serving"][0] != NO:
                break  # what comes next is another launch
            if batch.state.worlds["bounces"][0] - bounced > BOUNCES:
                break
            np.testing.assert_allclose(twin[0], one[0], atol=1e-5, err_msg=str(seed))
            assert twin[1:4] == one[1:4], seed
            compared, rewarded = compared + 1, rewarded + (one[1] > 0.0)
    assert compared > 300
    assert rewarded > 3
    assert strokes > 0
