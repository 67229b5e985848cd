"""Time of impact with a turning capsule, by bounded-acceleration advancement (anchors/numerics.md, "Time of impact").

In the frame that turns with the capsule at w the ball's acceleration is g - 2 w x v - w^2 p, with p from the pivot and
v the ball's velocity in the world. So the gap f(t) to the capsule, which is convex, satisfies f'' >= -A with
A = |g| + 2 |w| |v| + w^2 |p| at their greatest, and a step to the first root of f + f' h - A h^2 / 2 cannot step over
a hit.
"""

import math

from bounce_env.engine.compile.jit import Feature, function
from bounce_env.engine.impact.advancement import closed_after, open_for
from bounce_env.engine.motion.flight import magnitude, moved, sped
from bounce_env.engine.motion.sincos import sin_cos
from bounce_env.engine.tolerances import SEARCH_STEPS, ULPS_OF_SPEED


@function
def turning_gap(
    px: float, py: float, qx: float, qy: float, ux: float, uy: float, front: float, spin: float
) -> tuple[float, float]:
    """Distance [m] from a turning capsule's core to (px, py) about its pivot, and its rate of change [m/s].

    The core runs `front` metres along the unit vector (ux, uy) and turns at `spin` [rad/s]; (qx, qy) is the velocity.
    """
    nearest = min(max(px * ux + py * uy, 0.0), front)
    dx, dy = px - nearest * ux, py - nearest * uy
    distance = math.sqrt(dx * dx + dy * dy)
    # The nearest point of the core moves across it; how it moves along the core changes no distance.
    return distance, (dx * (qx + spin * nearest * uy) + dy * (qy - spin * nearest * ux)) / distance


@function
def turning_time(
    x: float, y: float, vx: float, vy: float, gx: Feature, gy: Feature, ux: float, uy: float, front: float,
    reach: float, spin: float, slack: float, horizon: float,
) -> float:  # fmt: skip
    """Hit of a capsule that turns at `spin` [rad/s] about the origin, before `horizon`: a duration [s], or inf.

    Its core runs `front` [m] along the unit vector (ux, uy) now. Where the ball neither comes closer nor leaves for
    very long the search ends before a hit, at a time up to which there is none.
    """
    if not horizon >= 0.0:
        return math.inf
    pull = magnitude(gx, gy)
    speed = math.sqrt(vx * vx + vy * vy)
    reached = math.sqrt(x * x + y * y) + (speed + 0.5 * pull * horizon) * horizon
    bound = pull + abs(spin) * (2.0 * (speed + pull * horizon) + abs(spin) * reached)
    t, away = 0.0, 0.0
    distance, rate = turning_gap(x, y, vx, vy, ux, uy, front, spin)
    if distance - reach <= slack and rate > 0.0:
        away = distance - reach  # what is left of a gap after a bounce is rounding
    # Along the surface no step is shorter than that in which a gap changes by what counts as touching.
    least = math.sqrt(2.0 * slack / bound)
    for _ in range(16 * SEARCH_STEPS):
        s, c = sin_cos(spin * t)
        qx, qy = sped(vx, gx, t), sped(vy, gy, t)
        distance, rate = turning_gap(
            moved(x, vx, gx, t), moved(y, vy, gy, t), qx, qy, ux * c - uy * s, ux * s + uy * c, front, spin
        )
        gap = distance - reach - away
        if gap <= slack:
            if rate < -ULPS_OF_SPEED * (abs(qx) + abs(qy) + abs(spin) * (front + reach)):
                after = t + closed_after(gap, rate, bound)
                return after if after <= horizon else math.inf
            rate, gap = max(rate, 0.0), max(gap, 0.0)
        t += open_for(gap, rate, bound) if rate < 0.0 else max(open_for(gap, rate, bound), least)
        if t > horizon:
            return math.inf
    return t
