"""A Minari data set of a shipped agent's episodes; reloaded, and checked to the bit against a replay of its actions."""

import os
import tempfile
import time

os.environ.setdefault("MINARI_DATASETS_PATH", tempfile.mkdtemp())  # yours: leave it out, or name a folder

import gymnasium as gym
import minari
import numpy as np

import bounce_env

NAME, GAMES, EPISODES = "bounce/{game}-trained-v0", ("Pinball", "Paddle", "Walls"), 3

for game in GAMES:
    env_id = f"Bounce/{game}-v0"
    agent = bounce_env.load_agent(env_id)
    plain = gym.make(env_id, time_limit=20.0)
    plain.reset(seed=0)
    plain.step(plain.action_space.sample())  # compiles, the first time on a machine
    env = minari.DataCollector(plain, data_format="hdf5")
    began, steps, scores = time.perf_counter(), 0, []
    for seed in range(EPISODES):
        observation, _ = env.reset(seed=seed)
        over = False
        while not over:
            action = agent(observation)
            observation, _, terminated, truncated, info = env.step(action)
            over, steps = terminated or truncated, steps + 1
        scores.append(info["score"])
    recording = time.perf_counter() - began
    made = env.create_dataset(
        NAME.format(game=game.lower()), algorithm_name="PPO, shipped with bounce_env", author="you",
        author_email="you@example.org", code_permalink="https://example.org", eval_env=plain.spec,
        description=f"{env_id}, best action",
    )  # fmt: skip
    env.close()

    dataset = minari.load_dataset(made.id)
    again = dataset.recover_environment()  # the environment that made it, from the spec in the data set
    for seed, (episode, score) in enumerate(zip(dataset.iterate_episodes(), scores, strict=True)):
        observation, _ = again.reset(seed=seed)
        assert np.array_equal(observation, episode.observations[0])
        for k, action in enumerate(episode.actions):
            observation, reward, terminated, truncated, info = again.step(action)
            assert np.array_equal(observation, episode.observations[k + 1])
            assert (reward, terminated, truncated) == (
                episode.rewards[k], episode.terminations[k], episode.truncations[k],
            )  # fmt: skip
        assert info["score"] == score
    cost = 1e6 * recording / steps
    print(
        f"{made.id}: {dataset.total_episodes} episodes, {dataset.total_steps} steps, recorded at {cost:.0f} us a step"
    )
