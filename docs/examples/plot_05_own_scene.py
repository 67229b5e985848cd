"""
A scene of your own
===================

A table drawn in TOML, checked, played by the game it has what it needs for, and by the engine
alone.
"""

import tempfile
from pathlib import Path

import gymnasium as gym
import matplotlib.pyplot as plt

import bounce_env
from bounce_env import World, load_scene, plot_trajectory

TABLE = """
gravity = [0.0, -1.5]
max_speed = 3.0

[ball]
radius = 0.02

[[elements]]
type = "wall"
name = "left"
start = [0.0, 0.0]
end = [0.0, 1.0]

[[elements]]
type = "arc"           # a round ceiling
name = "dome"
center = [0.5, 1.0]
radius = 0.5
start_angle = 0.0
end_angle = 3.14159265358979

[[elements]]
type = "wall"
name = "right"
start = [1.0, 0.0]
end = [1.0, 1.0]

[[elements]]
type = "bumper"
name = "left eye"
center = [0.3, 0.9]
radius = 0.08
b = 1.3

[[elements]]
type = "bumper"        # this one goes to and fro
name = "rider"
center = [0.3, 0.6]
rail_end = [0.7, 0.6]
speed = 0.3
radius = 0.06
b = 1.2

[[elements]]
type = "wall"          # from below the ball passes, from above it bounces
name = "gate"
start = [0.62, 0.85]
end = [0.92, 0.8]
one_way = true

[[elements]]
type = "paddle"
name = "paddle"
rail_start = [0.1, 0.08]
rail_end = [0.9, 0.08]
half_width = 0.08
radius = 0.02
max_speed = 1.5
b = 1.1
kick = 0.4

[[elements]]
type = "sensor"
name = "drain"
start = [-0.1, 0.0]
end = [1.1, 0.0]
drain = true
"""

path = Path(tempfile.mkdtemp()) / "dome.toml"
path.write_text(TABLE)

# %%
# It has a paddle, bumpers and a drain: all that ``Bounce/Paddle-v0`` needs. What a scene lacks
# would be said here, all at once.

env = gym.make("Bounce/Paddle-v0", scene=str(path), render_mode="rgb_array")
observation, info = env.reset(seed=3)
for _ in range(40):
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

figure, axes = plt.subplots(figsize=(3, 4), layout="constrained")
axes.imshow(env.render())
axes.axis("off")
plt.show()

# %%
# What an agent sees of it: a bumper on a rail has eight numbers.

for index, number in enumerate(env.unwrapped.observed):
    print(f"{index:2d}  {number.what:42s} {number.unit}")

# %%
# The engine alone: three seconds from one start. With all features it plays on the general kernel,
# so that nothing is compiled for a new scene; the bits are the same.

world = World(load_scene(path), features=bounce_env.ALL_FEATURES)
world.record()
world.reset(position=(0.5, 0.4), velocity=(-0.95, 1.8))
world.advance(3.0)
figure, axes = plt.subplots(figsize=(5, 5.5), layout="constrained")
plot_trajectory(world.recorded(), axes)
plt.show()

# %%
# ``bounce-env scenes check dome.toml`` lets 100 000 random balls look for traps, endless scoring,
# and targets that nothing reaches; ``bounce-env lab stage dome.toml`` opens it in a browser, where
# its walls can be dragged.

bounce_env.builtin_scenes()
