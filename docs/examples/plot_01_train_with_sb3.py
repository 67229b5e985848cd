"""
Train with Stable-Baselines3
============================

PPO on 256 worlds of ``Bounce/Paddle-v0`` at once, and how well it plays on episodes that it has
never met.
"""

import matplotlib.pyplot as plt
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback

from bounce_env.sb3 import BounceVecEnv

torch.set_num_threads(1)  # small networks are faster so

# %%
# ``BounceVecEnv`` is one batch of 256 worlds with SB3's face: there is no wrapper, and no Python
# object per world. Training takes its seeds from 2^32 on, so that it never meets an episode of the
# evaluation below.

envs = BounceVecEnv("Bounce/Paddle-v0", n_envs=256, seed=2**32, info="ends")
model = PPO(
    "MlpPolicy",
    envs,
    n_steps=128,
    batch_size=2048,
    n_epochs=4,
    learning_rate=lambda left: 2e-3 * left,
    policy_kwargs={"net_arch": [64, 64], "activation_fn": torch.nn.ReLU},
    seed=0,
    device="cpu",
)


class Curve(BaseCallback):
    """Keeps the mean score of the episodes that ended in each rollout."""

    def __init__(self):
        super().__init__()
        self.steps, self.scores = [], []

    def _on_step(self):
        return True

    def _on_rollout_end(self):
        if self.model.ep_info_buffer:
            self.steps.append(self.num_timesteps)
            self.scores.append(np.mean([episode["r"] for episode in self.model.ep_info_buffer]))


curve = Curve()
model.learn(1_300_000, callback=curve)

# %%
# Held-out episodes: the first ones of the seeds 10 000, 10 001 ..., each played to its end.

EPISODES = 200
test = BounceVecEnv("Bounce/Paddle-v0", n_envs=EPISODES, seed=10_000, info="ends")
observations = test.reset()
scores = np.full(EPISODES, np.nan)
while np.isnan(scores).any():
    actions, _ = model.predict(observations, deterministic=True)
    observations, _, dones, infos = test.step(actions)
    for world in np.flatnonzero(dones & np.isnan(scores)):
        scores[world] = infos[world]["episode"]["r"]
half = 1.96 * scores.std(ddof=1) / np.sqrt(EPISODES)
print(f"mean score {scores.mean():.1f} +- {half:.1f}; the best scripted player has 23.6, one that does nothing 2.0")
assert scores.mean() - half > 23.6

# %%

figure, axes = plt.subplots(figsize=(6, 3.2), layout="constrained")
axes.plot(curve.steps, curve.scores)
axes.axhline(23.6, linestyle="--", color="gray", label="best scripted player")
axes.set_xlabel("steps")
axes.set_ylabel("bumpers hit in an episode")
axes.legend()
plt.show()
