"""
A trajectory from its ledger
============================

Every event of a run is a row of the *ledger*. ``ledger_table`` puts words for numbers,
``plot_trajectory`` draws the exact paths between the events.
"""

import gymnasium as gym
import matplotlib.pyplot as plt

import bounce_env
from bounce_env import World, ledger_table, load_scene, plot_trajectory

world = World(load_scene("pegs"))
world.record()
world.reset(position=(0.06, 1.18), velocity=(0.35, 0.0))
world.advance(2.5)
run = world.recorded()

for row in ledger_table(run.scene, run.ledger)[:12]:
    print(f"{row['time']:8.5f} s  {row['kind']:15s} {row['element']:12s} at ({row['x']:.4f}, {row['y']:.4f})")

# %%
# The dots are the events, with the names of the elements beside them.
# ``pandas.DataFrame(ledger_table(...))`` is a table to work with.

figure, axes = plt.subplots(figsize=(6, 7), layout="constrained")
plot_trajectory(run, axes)
plt.show()

# %%
# An episode of an environment is a run, too.

env = gym.make("Bounce/Pinball-v0", record_events=True)
agent = bounce_env.load_agent("Bounce/Pinball-v0")
observation, info = env.reset(seed=3)
for _ in range(150):
    observation, reward, terminated, truncated, info = env.step(agent(observation))
run = env.unwrapped.recorded()
struck = {}
for row in ledger_table(run.scene, run.ledger):
    if row["kind"] == "bounce":
        struck[row["element"]] = struck.get(row["element"], 0) + 1
print(dict(sorted(struck.items(), key=lambda item: -item[1])[:8]))

figure, axes = plt.subplots(figsize=(4.5, 8), layout="constrained")
plot_trajectory(run, axes, names=False)
axes.set_title(f"the first {run.end:.1f} s: {info['score']:.0f} points", fontsize=9)
plt.show()
