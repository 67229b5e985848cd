"""Time of impact with a wall whose ends move apart or turn, by bounded-acceleration advancement.

The wall runs from P to P + D, and D changes at the constant rate E (the difference of its ends' velocities). It turns
at w = (D x E) / |D|^2, of which D x E does not change. In the frame that turns with it about P the ball's height h over
its line has h'' = g_h - 2 w u_a - w^2 h - w' a, with u the ball's velocity relative to P and a <= |D| where it is
beside the wall; and |w'| a <= 2 |w| |E|. About the ends the gap is convex but for gravity. So the gap f(t), whose rate
of change does not jump between the two, satisfies f'' >= -A with A = |g| + |w| (2 (|u| + |E|) + |w| h) at their
greatest, and a step to the first root of f + f' h - A h^2 / 2 cannot step over a hit.
"""

import math

from bounce_env.engine.compile.jit import function
from bounce_env.engine.impact.advancement import advancement_step, advancement_to_closing
from bounce_env.engine.motion.flight import Flight, acceleration_magnitude, flight_after
from bounce_env.engine.tolerances import SEARCH_STEPS, ULPS_OF_SPEED


@function
def stretching_wall_gap(
    flight: Flight, dx: float, dy: float, ex: float, ey: float, facing: float, tolerance: float
) -> tuple[float, float, float]:
    """Return the distance [m] from a wall along (dx, dy) to a flight's point, its rate of change [m/s], and the side.

    The flight is relative to the wall's start, and (ex, ey) is the velocity of the wall's end there. `facing` is the
    side, 1.0 or -1.0, that the ball is taken to be on while its height over the wall is no more than a few times the
    tolerance; the distance from the wall's line is negative on the other one. The side returned is the one that a
    larger height tells.
    """
    length = math.sqrt(dx * dx + dy * dy)
    ux, uy = dx / length, dy / length
    along, height = flight.x * ux + flight.y * uy, flight.y * ux - flight.x * uy
    if abs(height) > 4.0 * tolerance:  # a step along the surface may end a little deeper than it began
        facing = 1.0 if height > 0.0 else -1.0
    if -tolerance <= along <= length + tolerance:
        share = along / length
        rate = (flight.vy - share * ey) * ux - (flight.vx - share * ex) * uy
        return facing * height, facing * rate, facing
    share = 0.0 if along < 0.0 else 1.0
    x, y = flight.x - share * dx, flight.y - share * dy
    distance = math.sqrt(x * x + y * y)
    return distance, (x * (flight.vx - share * ex) + y * (flight.vy - share * ey)) / distance, facing


@function
def stretching_wall_bound(
    flight: Flight, pull: float, dx: float, dy: float, ex: float, ey: float, window: float
) -> float:
    """Return A of the module's text over the next `window` seconds [m/s^2]."""
    spread = math.sqrt(ex * ex + ey * ey)
    # When the wall is shortest: where its ends are nearest to each other.
    t = min(max(-(dx * ex + dy * ey) / (spread * spread), 0.0), window)
    sx, sy = dx + ex * t, dy + ey * t
    spin = abs(dx * ey - dy * ex) / (sx * sx + sy * sy)
    speed = math.sqrt(flight.vx * flight.vx + flight.vy * flight.vy)
    height = math.sqrt(flight.x * flight.x + flight.y * flight.y) + (speed + 0.5 * pull * window) * window
    return pull + spin * (2.0 * (speed + pull * window + spread) + spin * height)


@function
def stretching_wall_time(
    flight: Flight,
    dx: float,
    dy: float,
    ex: float,
    ey: float,
    offset_radius: float,
    side: int,
    tolerance: float,
    horizon: float,
) -> float:
    """Return the hit of a wall that runs from the origin along (dx, dy) [m] and changes by (ex, ey) [m/s], not both 0.

    All is relative to the wall's start, which moves uniformly. A duration [s] up to `horizon`, or inf. side: on which
    side a ball of no radius is while it touches, otherwise 0. Where the ball neither comes closer nor leaves for very
    long the search ends before a hit, at a time up to which there is none.
    """
    if not horizon >= 0.0:
        return math.inf
    pull, spread = acceleration_magnitude(flight.ax, flight.ay), math.sqrt(ex * ex + ey * ey)
    t, away, facing = 0.0, 0.0, 1.0 if side >= 0 else -1.0
    for step in range(16 * SEARCH_STEPS):
        now = flight_after(flight, t)
        rx, ry = dx + ex * t, dy + ey * t
        distance, rate, facing = stretching_wall_gap(now, rx, ry, ex, ey, facing, tolerance)
        if step == 0 and distance - offset_radius <= tolerance and rate > 0.0:
            away = distance - offset_radius  # what is left of a gap after a bounce is rounding
        gap = distance - offset_radius - away
        speed = math.sqrt(now.vx * now.vx + now.vy * now.vy)
        # A bound holds over a window only: first one in which something may happen, then one not much longer than the
        # step that this allows.
        size = math.sqrt(now.x * now.x + now.y * now.y) + math.sqrt(rx * rx + ry * ry)
        window = min(horizon - t, 2.0 * size / (speed + spread + math.sqrt(pull * size)))
        bound = stretching_wall_bound(now, pull, rx, ry, ex, ey, window)
        if gap <= tolerance:
            if rate < -ULPS_OF_SPEED * (speed + spread):
                after = t + advancement_to_closing(gap, rate, bound)
                return after if after <= horizon else math.inf
            rate, gap = max(rate, 0.0), max(gap, 0.0)
        before = t
        nearer = min(window, 3.0 * advancement_step(gap, rate, bound))
        bound = stretching_wall_bound(now, pull, rx, ry, ex, ey, nearer)
        t += min(advancement_step(gap, rate, bound), nearer)
        if rate >= 0.0:
            # Along the surface no step is shorter than that in which a gap changes by what counts as touching.
            t = max(t, before + math.sqrt(2.0 * tolerance / bound))
        if t > horizon or before == horizon:
            return math.inf
    return t
