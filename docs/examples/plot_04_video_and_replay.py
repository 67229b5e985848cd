"""
A video and a replay
====================

Two ways to see what an agent did: frames as a video, by Gymnasium's ``RecordVideo``, and a
*replay*, a page that has the flights themselves.
"""

import tempfile
from pathlib import Path

import gymnasium as gym
import matplotlib.pyplot as plt

import bounce_env

folder = Path(tempfile.mkdtemp())
agent = bounce_env.load_agent("Bounce/Walls-v0")

env = gym.make("Bounce/Walls-v0", render_mode="rgb_array", width=360, height=360, trail=0.4, record_events=True)
env = gym.wrappers.RecordVideo(env, str(folder / "video"), episode_trigger=lambda episode: True)
observation, info = env.reset(seed=4)
over = False
while not over:
    observation, reward, terminated, truncated, info = env.step(agent(observation))
    over = terminated or truncated
print(f"{info['score']:.0f} of 5 targets, {info['bounces']} bounces in {info['game_seconds']:.1f} s of play")
replay = env.unwrapped.replay()
last_frame = env.render()
env.close()

films = sorted(folder.glob("video/*.mp4"))  # the gallery shows what is in this list
print([film.name for film in films])

# %%
# The last frame, as an array:

figure, axes = plt.subplots(figsize=(3, 3), layout="constrained")
axes.imshow(last_frame)
axes.axis("off")
plt.show()

# %%
# The same episode as a replay. It plays at any speed down to 1/1000, goes from event to event, and
# lists them. ``save`` writes a page that loads nothing from elsewhere; in a notebook, and here, it
# shows itself.

replay.save(folder / "walls.html")
replay
