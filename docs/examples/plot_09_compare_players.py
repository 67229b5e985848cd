"""
Compare players
===============

Interquartile means with stratified bootstrap intervals, and performance profiles, by SciPy alone.
"""

import gymnasium as gym
import matplotlib.pyplot as plt
import numpy as np
from scipy import stats

import bounce_env

EPISODES = 60
GAMES = {
    "Bounce/Pinball-v0": (615.0, 57_332.0),
    "Bounce/Paddle-v0": (2.0, 361.0),
    "Bounce/Walls-v0": (0.0, 4.62),
}  # nothing, look-ahead

# %%
# Each player plays the same held-out episodes, each to its end. Scores are normalised: 0 does
# nothing, 1 looks ahead.


def scores_of(env_id, player):
    """Normalised scores of a game, (episodes,)."""
    envs = gym.make_vec(env_id, num_envs=EPISODES, vectorization_mode="vector_entry_point", info="ends")
    envs.action_space.seed(0)
    observations, _ = envs.reset(seed=10_000)
    scores, playing = np.zeros(EPISODES), np.ones(EPISODES, bool)
    while playing.any():
        observations, _, terminated, truncated, info = envs.step(player(envs, observations))
        over = playing & (terminated | truncated)
        if over.any():
            scores[over] = info["score"][over]
            playing &= ~over
    envs.close()
    low, high = GAMES[env_id]
    return (scores - low) / (high - low)


def at_random(envs, observations):
    """Any actions."""
    return envs.action_space.sample()


def trained(env_id):
    """The agent that comes with the package."""
    agent = bounce_env.load_agent(env_id)
    return lambda envs, observations: agent(observations)


players = {
    "random": [scores_of(env_id, at_random) for env_id in GAMES],
    "PPO, ships with the package": [scores_of(env_id, trained(env_id)) for env_id in GAMES],
}

# %%
# ``stats.bootstrap`` draws each of its samples by itself. With one sample a game that is the
# stratified bootstrap. (Here a run is an episode of one agent. For an *algorithm* a run is a
# training, with the mean score of its held-out episodes: at least three of them, better ten.)


def iqm(*games, axis=-1):
    """The mean of the middle half of all games' runs."""
    return stats.trim_mean(np.concatenate(games, axis=axis), 0.25, axis=axis)


rows = {}
for name, games in players.items():
    drawn = stats.bootstrap(games, iqm, n_resamples=2000, method="percentile", rng=np.random.default_rng(0))
    rows[name] = (iqm(*games), *drawn.confidence_interval)
    print(f"{name:28s} IQM {rows[name][0]:.3f}  ({rows[name][1]:.3f} to {rows[name][2]:.3f})")

# %%
# The performance profile: the share of runs that score more than x. Its band is the same bootstrap,
# at each x.

levels = np.linspace(-0.05, 1.2, 126)
figure, (left, right) = plt.subplots(1, 2, figsize=(8.5, 3.2), layout="constrained", width_ratios=(1, 2))
for k, (middle, low, high) in enumerate(rows.values()):
    left.errorbar(middle, k, xerr=[[middle - low], [high - middle]], fmt="o", capsize=4)


def profile(*games, axis=-1):
    """The share of runs above each level, (levels, ...)."""
    runs = np.concatenate(games, axis=axis)
    return (runs[..., None, :] > levels[:, None]).mean(axis=-1).T


for name, games in players.items():
    generator = np.random.default_rng(0)
    drawn = [profile(*(generator.choice(game, len(game)) for game in games)) for _ in range(500)]
    right.plot(levels, profile(*games), label=name)
    right.fill_between(levels, *np.percentile(drawn, [2.5, 97.5], axis=0), alpha=0.2)
left.set_yticks(range(len(rows)), list(rows))
left.set_ylim(-0.5, len(rows) - 0.5)
left.set_xlabel("interquartile mean")
right.set_xlabel("normalised score x")
right.set_ylabel("share of runs above x")
right.legend()
plt.show()
