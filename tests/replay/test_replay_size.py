"""A replay is small enough to be sent about."""

import gymnasium as gym
import pytest

import bounce_env

MOST = 300_000  # bytes of a page with a minute of pinball


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_minute_of_pinball_by_the_trained_agent_fits(seed):
    env = gym.make("Bounce/Pinball-v0", record_events=True, disable_env_checker=True).unwrapped
    agent = bounce_env.load_agent("Bounce/Pinball-v0")
    observation, _ = env.reset(seed=seed)
    over = False
    while not over and env._batch.episodes["frames"][0] < 60 * 60:
        observation, _, terminated, truncated, _ = env.step(agent(observation))
        over = terminated or truncated
    replay = env.replay()
    assert replay.document["end"] > 30.0
    assert replay.document["lost"] == 0
    assert len(replay.html.encode()) <= MOST
