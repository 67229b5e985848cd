"""
Stacked pixels
==============

Agents that see frames: ``obs="pixels"``, drawn by compiled code over the whole batch. One frame
does not tell how fast the ball is, so some are stacked.
"""

import gymnasium as gym
import matplotlib.pyplot as plt
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecFrameStack

from bounce_env.sb3 import BounceVecEnv

torch.set_num_threads(1)

# %%
# Of a single environment, Gymnasium's wrapper stacks them.

env = gym.make("Bounce/Pinball-v0", obs="pixels", obs_height=84, obs_width=84, grayscale=True)
env = gym.wrappers.FrameStackObservation(env, 4)
observation, info = env.reset(seed=0)
for _ in range(60):
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
print(observation.shape, observation.dtype)

figure, panels = plt.subplots(1, 4, figsize=(8, 2.4), layout="constrained")
for panel, frame, ago in zip(panels, observation, (3, 2, 1, 0), strict=True):
    panel.imshow(frame[..., 0], cmap="gray", vmin=0, vmax=255)
    panel.set_title(f"{ago} steps ago" if ago else "now", fontsize=9)
    panel.axis("off")
plt.show()

# %%
# Of many, Stable-Baselines3's does, for its convolutional policies. Here a few updates show that
# all fits together; a training from pixels takes some millions of steps, most of its time in the
# network.

envs = VecFrameStack(BounceVecEnv("Bounce/Paddle-v0", n_envs=32, obs="pixels", grayscale=True), 4)
print(envs.observation_space)
model = PPO("CnnPolicy", envs, n_steps=32, batch_size=256, n_epochs=1, seed=0, device="cpu")
model.learn(2048)

# %%
# In place of a stack, a frame can show where the ball has come from: ``trail=0.3`` draws the way of
# the last 0.3 s, fading. Such frames are drawn by pygame, one by one.

env = gym.make("Bounce/Pinball-v0", obs="pixels", obs_height=168, obs_width=168, trail=0.3)
observation, info = env.reset(seed=0)
for _ in range(60):
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
assert observation.dtype == np.uint8

figure, axes = plt.subplots(figsize=(3, 3), layout="constrained")
axes.imshow(observation)
axes.axis("off")
plt.show()
