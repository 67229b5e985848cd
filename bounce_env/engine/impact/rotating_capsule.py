"""Time of impact with a rotating capsule, by bounded-acceleration advancement.

In the frame that turns with the capsule at w the ball's acceleration is g - 2 w x v - w^2 p, with p from the pivot and
v the ball's velocity in the world. So the gap f(t) to the capsule, which is convex, satisfies f'' >= -A with
A = |g| + 2 |w| |v| + w^2 |p| at their greatest, and a step to the first root of f + f' h - A h^2 / 2 cannot step over
a hit.
"""

import math

from bounce_env.engine.compile.jit import function
from bounce_env.engine.impact.advancement import advancement_step, advancement_to_closing
from bounce_env.engine.motion.flight import Flight, acceleration_magnitude, flight_after
from bounce_env.engine.motion.parts import Core
from bounce_env.engine.motion.sincos import sin_cos
from bounce_env.engine.tolerances import SEARCH_STEPS, ULPS_OF_SPEED


@function
def rotating_gap(flight: Flight, ux: float, uy: float, front: float, spin: float) -> tuple[float, float]:
    """Return the distance [m] from a rotating core to a flight's point about its pivot, and its rate of change [m/s].

    The core runs `front` metres along the unit vector (ux, uy) and turns at `spin` [rad/s].
    """
    nearest = min(max(flight.x * ux + flight.y * uy, 0.0), front)
    dx, dy = flight.x - nearest * ux, flight.y - nearest * uy
    distance = math.sqrt(dx * dx + dy * dy)
    # The nearest point of the core moves across it; how it moves along the core changes no distance.
    vx, vy = flight.vx + spin * nearest * uy, flight.vy - spin * nearest * ux
    return distance, (dx * vx + dy * vy) / distance


@function
def rotating_capsule_time(
    flight: Flight, core: Core, offset_radius: float, spin: float, tolerance: float, horizon: float
) -> float:
    """Return the hit of a capsule that turns at `spin` [rad/s] about the origin, up to `horizon` [s]; inf: none.

    Its core runs to `core.front` along (core.ux, core.uy) now. offset_radius: its radius plus the ball's [m].
    Where the ball neither comes closer nor leaves for very long the search ends before a hit, at a time up to which
    there is none.
    """
    if not horizon >= 0.0:
        return math.inf
    pull = acceleration_magnitude(flight.ax, flight.ay)
    speed = math.sqrt(flight.vx * flight.vx + flight.vy * flight.vy)
    reached = math.sqrt(flight.x * flight.x + flight.y * flight.y) + (speed + 0.5 * pull * horizon) * horizon
    bound = pull + abs(spin) * (2.0 * (speed + pull * horizon) + abs(spin) * reached)
    t, away, front = 0.0, 0.0, core.front
    distance, rate = rotating_gap(flight, core.ux, core.uy, front, spin)
    if distance - offset_radius <= tolerance and rate > 0.0:
        away = distance - offset_radius  # what is left of a gap after a bounce is rounding
    # Along the surface no step is shorter than that in which a gap changes by what counts as touching.
    least = math.sqrt(2.0 * tolerance / bound)
    for _ in range(16 * SEARCH_STEPS):
        s, c = sin_cos(spin * t)
        now = flight_after(flight, t)
        distance, rate = rotating_gap(now, core.ux * c - core.uy * s, core.ux * s + core.uy * c, front, spin)
        gap = distance - offset_radius - away
        if gap <= tolerance:
            if rate < -ULPS_OF_SPEED * (abs(now.vx) + abs(now.vy) + abs(spin) * (front + offset_radius)):
                after = t + advancement_to_closing(gap, rate, bound)
                return after if after <= horizon else math.inf
            rate, gap = max(rate, 0.0), max(gap, 0.0)
        t += advancement_step(gap, rate, bound) if rate < 0.0 else max(advancement_step(gap, rate, bound), least)
        if t > horizon:
            return math.inf
    return t
