"""
Bounce laws
===========

What bounciness ``b`` and friction ``f`` do: the same throw onto the same floor, under different
laws. Of the velocity the part along the normal is reversed and multiplied by ``b``, the part along
the floor is multiplied by ``f``.
"""

import matplotlib.pyplot as plt

from bounce_env import Ball, Scene, Wall, World, plot_trajectory

LAWS = {
    "nothing is lost (b = 1, f = 1)": {"b": 1.0, "f": 1.0},
    "a rubber ball (b = 0.8, f = 1)": {"b": 0.8, "f": 1.0},
    "a rough floor (b = 0.8, f = 0.7)": {"b": 0.8, "f": 0.7},
    "a bumper (b = 1.25, up to 6 m/s)": {"b": 1.25, "f": 1.0},
    "tar (b = 0, f = 1: slides on)": {"b": 0.0, "f": 1.0},
    "glue (b = 0, f = 0: stays)": {"b": 0.0, "f": 0.0},
}

figure, panels = plt.subplots(3, 2, figsize=(8, 7), layout="constrained", sharex=True, sharey=True)
for axes, (name, law) in zip(panels.flat, LAWS.items(), strict=True):
    floor = Wall((-0.2, 0.0), (4.2, 0.0), name="floor", **law)
    world = World(Scene(ball=Ball(radius=0.05), max_speed=6.0, elements=(floor,)))
    world.record()
    world.reset(position=(0.0, 1.0), velocity=(1.2, 0.0))
    world.advance(2.5)
    plot_trajectory(world.recorded(), axes, names=False)
    axes.set_title(name, fontsize=9)
    axes.set_xlim(-0.3, 4.3)
    axes.set_ylim(-0.1, 1.9)
    place, speed = world.position[0].round(3), world.velocity[0].round(3)
    print(f"{name}: at {place} m with {speed} m/s, {world.counts.bounces} bounces")
plt.show()

# %%
# Where ``b`` is less than 1 the bounces accumulate: infinitely many in a finite time. The engine
# takes them one by one while they can be told apart, then sums the rest, and the ball slides or
# rests: the ledger says ``contact begins``. See `Infinitely many bounces
# <../physics.html#infinitely-many-bounces>`_.
