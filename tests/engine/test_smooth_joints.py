"""Walls that go on smoothly as arcs: what is one surface to the eye is one to the ball, wherever the room is turned.

At such a joint a ball moves along both and closes on neither, so that nothing but rounding tells which one it meets.
"""

import math
import random

import numpy as np
import pytest

from bounce_env.engine.world import World
from bounce_env.scene import Arc, Ball, Scene, Wall
from tests.conftest import soak_count

HALF_WIDTH, HALF_HEIGHT, CORNER = 1.0, 0.75, 0.375


def turned(x, y, angle):
    c, s = math.cos(angle), math.sin(angle)
    return c * x - s * y, s * x + c * y


def rounded_rectangle(angle, b, f):
    """Four walls and four quarter arcs, counter-clockwise: the inside is on the left of each wall."""
    a, h = HALF_WIDTH - CORNER, HALF_HEIGHT - CORNER
    walls = (
        ((-a, -HALF_HEIGHT), (a, -HALF_HEIGHT)),
        ((HALF_WIDTH, -h), (HALF_WIDTH, h)),
        ((a, HALF_HEIGHT), (-a, HALF_HEIGHT)),
        ((-HALF_WIDTH, h), (-HALF_WIDTH, -h)),
    )
    corners = ((a, -h, 1.5), (a, h, 0.0), (-a, h, 0.5), (-a, -h, 1.0))
    for start, end in walls:
        yield Wall(turned(*start, angle), turned(*end, angle), b=b, f=f)
    for x, y, quarter in corners:
        start = angle + quarter * math.pi
        yield Arc(turned(x, y, angle), CORNER, start, start + 0.5 * math.pi, b=b, f=f)


def box(half, b, f):
    """A square room around it."""
    corners = ((-half, -half), (half, -half), (half, half), (-half, half))
    for i in range(4):
        yield Wall(corners[i], corners[(i + 1) % 4], b=b, f=f)


def gap(x, y, angle):
    """Distance [m] of a point from the rounded rectangle, negative inside."""
    x, y = turned(x, y, -angle)
    dx, dy = abs(x) - HALF_WIDTH + CORNER, abs(y) - HALF_HEIGHT + CORNER
    return math.hypot(max(dx, 0.0), max(dy, 0.0)) + min(max(dx, dy), 0.0) - CORNER


def start(rng, angle, radius, inside):
    """On a wall and along it, or for a ball of no radius, whose side that does not tell, near it and on to it."""
    sign = 1.0 if inside else -1.0
    off = radius or 0.01
    along, speed = rng.uniform(-0.6, 0.6), rng.choice((-1.0, 1.0)) * rng.uniform(0.3, 6.0)
    towards = 0.0 if radius else sign * 0.1
    if rng.random() < 0.5:
        place = (HALF_WIDTH - sign * off, 0.5 * along)
        motion = (towards, speed)
    else:
        place = (along, HALF_HEIGHT - sign * off)
        motion = (speed, towards)
    return turned(*place, angle), turned(*motion, angle)


def drawn(rng, radius, inside):
    angle = rng.choice((0.0, 0.5 * math.pi, rng.uniform(0.0, 2.0 * math.pi)))
    b, f = rng.choice((0.0, 0.0, 0.5, 0.9, 1.0)), rng.choice((0.0, 0.5, 1.0))
    strength = rng.uniform(0.5, 10.0)
    gravity = rng.choice(((0.0, 0.0), (0.0, -strength), turned(0.0, -strength, angle), turned(strength, 0.0, angle)))
    elements = tuple(rounded_rectangle(angle, b, f))
    if not inside:
        elements += tuple(box(2.5, b, f))
    return angle, Scene(gravity=gravity, ball=Ball(radius=radius), elements=elements)


@pytest.mark.parametrize("inside", [True, False])
@pytest.mark.parametrize("radius", [0.0, 0.0135, 0.125])
def test_no_ball_passes_a_smooth_joint(radius, inside):
    for seed in range(soak_count(250, 20_000)):
        rng = random.Random(seed)
        angle, scene = drawn(rng, radius, inside)
        position, velocity = start(rng, angle, radius, inside)
        world = World(scene)
        world.reset(position=position, velocity=velocity)
        for _ in range(16):
            world.advance(0.3, max_events=2000)
            (x, y), sign = world.position[0], (-1.0 if inside else 1.0)
            assert sign * gap(x, y, angle) > radius - 1e-9, seed
            assert max(abs(x), abs(y)) < 2.5 - radius + 1e-9
            assert np.isfinite(world.velocity).all()
