"""PPO by Stable-Baselines3 with observations and rewards brought to unit variance by VecNormalize."""

import time

import torch
from held_out import held_out_score
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecNormalize

from bounce_env.sb3 import BounceVecEnv

torch.set_num_threads(1)
envs = VecNormalize(BounceVecEnv("Bounce/Paddle-v0", n_envs=256, seed=2**32, info="ends"), gamma=0.99)
model = PPO(
    "MlpPolicy", envs, n_steps=128, batch_size=2048, n_epochs=4, learning_rate=lambda left: 2e-3 * left, seed=0,
    policy_kwargs={"net_arch": [64, 64], "activation_fn": torch.nn.ReLU}, device="cpu",
)  # fmt: skip
began = time.perf_counter()
model.learn(1_300_000)
print(f"{model.num_timesteps:,} steps in {time.perf_counter() - began:.0f} s")

envs.training = False  # the means and variances of training are used, and no longer changed
mean, half = held_out_score(lambda seen: model.predict(envs.normalize_obs(seen), deterministic=True)[0])
print(f"held-out score {mean:.1f} +- {half:.1f}")
assert mean - half > 23.6, "worse than the best scripted player"
