"""Held-out episodes, the same for all clients: the first ones of the seeds 10 000, 10 001 ..., each to its end."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np

import bounce_env  # noqa: F401 (registers Bounce/*)

BASELINES = {"Bounce/Paddle-v0": {"random": 2.0, "follow": 7.4, "predictor": 23.6}}
"""Mean scores of players that learn nothing, of `python -m agents.evaluate`."""


def held_out_score(act: Callable[[Any], Any], env_id: str = "Bounce/Paddle-v0") -> tuple[float, float]:
    """Return the mean score of a player in 200 episodes, and the half-width of its 95 % interval.

    act: from observations (episodes, size), float32, to actions.
    """
    episodes = 200
    envs = gym.make_vec(env_id, num_envs=episodes, vectorization_mode="vector_entry_point")
    observations, _ = envs.reset(seed=10_000)
    scores, playing = np.zeros(episodes), np.ones(episodes, bool)
    while playing.any():
        observations, _, terminated, truncated, info = envs.step(np.asarray(act(observations)))
        over = playing & (terminated | truncated)
        scores[over] = info["score"][over]
        playing &= ~over
    envs.close()
    return float(scores.mean()), float(1.96 * scores.std(ddof=1) / np.sqrt(episodes))
