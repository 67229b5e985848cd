"""
Beside pymunk
=============

The same ball in the same box: pymunk's end point depends on the time step, this engine has none.
"""

import matplotlib.pyplot as plt
import numpy as np
import pymunk

from bounce_env import Ball, Scene, Wall, World

CORNERS = [(0.0, 0.0), (1.6, 0.0), (1.6, 1.0), (0.0, 1.0)]
WALLS = [*zip(CORNERS, [*CORNERS[1:], CORNERS[0]], strict=True), ((0.5, 0.35), (0.9, 0.5))]
GRAVITY, RADIUS, START, VELOCITY, SECONDS = (0.0, -1.5), 0.03, (0.3, 0.8), (0.9, 0.2), 6.0


def by_pymunk(dt):
    """The places of a ball of pymunk, at its best: no slop, no damping, nothing lost in a bounce."""
    space = pymunk.Space()
    space.gravity, space.collision_slop, space.collision_bias = GRAVITY, 0.0, 0.0
    for start, end in WALLS:
        wall = pymunk.Segment(space.static_body, start, end, 0.0)
        wall.elasticity, wall.friction = 1.0, 0.0
        space.add(wall)
    body = pymunk.Body(1.0, float("inf"))  # a ball that does not turn
    body.position, body.velocity = START, VELOCITY
    ball = pymunk.Circle(body, RADIUS)
    ball.elasticity, ball.friction = 1.0, 0.0
    space.add(body, ball)
    places = [tuple(body.position)]
    for _ in range(round(SECONDS / dt)):
        space.step(dt)
        places.append(tuple(body.position))
    return np.array(places)


def by_bounce_env(calls):
    """The places of this engine's ball, asked for at the ends of so many calls."""
    world = World(Scene(gravity=GRAVITY, ball=Ball(radius=RADIUS), elements=tuple(Wall(a, b) for a, b in WALLS)))
    world.reset(position=START, velocity=VELOCITY)
    places = [world.position[0]]
    for _ in range(calls):
        world.advance(SECONDS / calls)
        places.append(world.position[0])
    return np.array(places)


# %%
# Three steps, three end points; three ways to cut the time, one.

STEPS = (1 / 60, 1 / 240, 1 / 960)
theirs = {f"pymunk, steps of 1/{round(1 / dt)} s": by_pymunk(dt) for dt in STEPS}
ours = {f"bounce_env, calls of 1/{round(1 / dt)} s": by_bounce_env(round(SECONDS / dt)) for dt in STEPS}
for name, places in (theirs | ours).items():
    print(f"{name:32s} ends at ({places[-1][0]:.12f}, {places[-1][1]:.12f})")

ends = np.array([places[-1] for places in ours.values()])
assert np.abs(ends - ends[0]).max() < 1e-12  # only the sum of the calls' durations is rounded

# %%

figure, axes = plt.subplots(figsize=(7, 4.6), layout="constrained")
for start, end in WALLS:
    axes.plot(*zip(start, end, strict=True), color="#3c4668")
for (name, places), colour in zip(theirs.items(), ("#d1495b", "#b3791f", "#7a5195"), strict=True):
    axes.plot(*places.T, color=colour, linewidth=0.8, alpha=0.7, label=name)
    axes.plot(*places[-1], "o", color=colour)
exact = ours[f"bounce_env, calls of 1/{round(1 / STEPS[-1])} s"]
axes.plot(*exact.T, color="#0b6e4f", linewidth=1.4, label="bounce_env, whatever the calls")
axes.plot(*exact[-1], "*", color="#0b6e4f", markersize=14)
axes.set_aspect("equal")
axes.legend(loc="upper left", bbox_to_anchor=(0.0, -0.08), ncols=2, fontsize=8)
plt.show()

# %%
# Which end point is right? A solver with 50 digits, which shares no code with the engine, agrees
# with it in the first 14: ``python -m bounce_env report error`` measures that in thirteen scenes,
# beside the time that each takes.
