"""Random play of every game, for long: each episode ends as its card says, no ball is stuck, none escapes.

With full counts 10 million steps a game; how long episodes last is printed.
"""

import sys
from collections import Counter

import numpy as np
import pytest

from bounce_env.registration import ENTRIES
from tests.conftest import soak_count
from tests.env.rollouts import PADDLE, make_vec

pytestmark = pytest.mark.slow

WORLDS = 128
STEPS = 10_000_000
# What a card says of how episodes end; "budget" is there, too, and is never to be seen.
BALL = {"drained", "time_limit"}
ENDS = {PADDLE: BALL, "Bounce/Pinball-v0": BALL, "Bounce/Walls-v0": {"all_played"}}
GAMES = [(entry.id, {}) for entry in ENTRIES] + [(PADDLE, {"num_levels": 0})]


@pytest.mark.parametrize(("env_id", "kwargs"), GAMES, ids=lambda value: value if isinstance(value, str) else str(value))
def test_random_play(env_id, kwargs):
    envs = make_vec(WORLDS, "SAME_STEP", env_id, copy=False, **kwargs)
    low, high = envs.single_observation_space.low, envs.single_observation_space.high
    generator = np.random.default_rng(1)
    envs.action_space.seed(1)
    actions = np.stack([envs.action_space.sample() for _ in range(64)])
    observations, _ = envs.reset(seed=1)
    seconds, reasons, totals = [], Counter(), Counter()
    least, most = observations.min(axis=0), observations.max(axis=0)
    for _ in range(soak_count(STEPS // 50, STEPS) // WORLDS):
        observations, rewards, terminated, truncated, info = envs.step(actions[generator.integers(64)])
        np.minimum(least, observations.min(axis=0), out=least)
        np.maximum(most, observations.max(axis=0), out=most)
        assert np.isfinite(rewards).all()
        ended = terminated | truncated
        if ended.any():
            told = info["final_info"]
            seconds += told["game_seconds"][ended].tolist()
            reasons.update(told["end_reason"][ended].tolist())
            for name in ("stuck_freed", "hold_released", "crushed", "timed_out"):
                if name in told:
                    totals[name] += int(told[name][ended].sum())
    assert (least >= low).all()
    assert (most <= high).all()
    assert set(reasons) <= ENDS[env_id], reasons
    assert len(seconds) > 100
    tail = ", ".join(f"{share:g} %: {np.percentile(seconds, share):.1f} s" for share in (50, 90, 99, 99.9, 100))
    sys.stdout.write(
        f"{env_id} {kwargs}: {len(seconds)} episodes of {np.mean(seconds):.1f} s in the mean; {tail}; "
        f"{dict(reasons)} {dict(totals)}\n"
    )
