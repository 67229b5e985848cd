"""Time of impact of a flying ball with a circle, from outside.

Flights are relative to the circle's centre, in its frame. `offset_radius` is the circle's radius plus the ball's [m];
`tolerance` is the length [m] below which a gap is a touch. Each function returns the duration [s] from now to the hit,
or inf.
"""

import math

from bounce_env.engine.compile.jit import function, routine, where
from bounce_env.engine.impact.advancement import advancement_step
from bounce_env.engine.impact.arc import Circle, arc_crossing_time
from bounce_env.engine.impact.grazing import bending, grazes, slow_on_circle
from bounce_env.engine.motion.flight import Flight, coordinate_after, flight_after, speed_after, swept_interval
from bounce_env.engine.tolerances import SEARCH_STEPS, STANDING, WEIGHTLESS


@routine
def circle_time(flight: Flight, offset_radius: float, tolerance: float, horizon: float) -> float:
    """Return the hit of a circle about the origin, from outside."""
    return _circle_time(flight, offset_radius, tolerance, horizon)


@function
def straight_circle_time(flight: Flight, offset_radius: float, tolerance: float, horizon: float) -> float:
    """Return the hit on a straight flight: the smaller root in closed form, nothing cancels; `horizon` is not asked."""
    distance = math.sqrt(flight.x * flight.x + flight.y * flight.y)
    approach = -(flight.x * flight.vx + flight.y * flight.vy)
    if approach <= slow_on_circle(flight, offset_radius, tolerance) * distance:
        return math.inf
    cross = flight.x * flight.vy - flight.y * flight.vx
    speed_square = flight.vx * flight.vx + flight.vy * flight.vy
    square = speed_square * offset_radius * offset_radius - cross * cross
    if grazes(abs(square), speed_square * offset_radius, tolerance):
        return approach / speed_square
    if square <= 0.0:
        return math.inf
    return max(distance - offset_radius, 0.0) * (distance + offset_radius) / (approach + math.sqrt(square))


@where("ax", otherwise=straight_circle_time)
def _circle_time(flight: Flight, offset_radius: float, tolerance: float, horizon: float) -> float:
    if abs(flight.ax) + abs(flight.ay) < WEIGHTLESS:
        return straight_circle_time(flight, offset_radius, tolerance, horizon)
    return curved_circle_time(flight, offset_radius, tolerance, horizon)


@function
def curved_circle_time(flight: Flight, offset_radius: float, tolerance: float, horizon: float) -> float:
    """Return the hit of a circle about the origin under gravity, by bounded-acceleration advancement.

    The gap f(t) to a convex obstacle satisfies f'' >= -|a|, so stepping to the first root of f + f' h - |a| h^2 / 2
    cannot step over a hit, and converges quadratically. Just after a bounce f = 0 and f' > 0, and the same step leaves
    the circle: no ball is pushed off, no circle is skipped. A touch in passing is told where the path is nearest (see
    `grazes`). Across gravity along an axis the flight is uniform: the search is confined to the time in which it passes
    the circle there, and to flights that come near it then.
    """
    x, y, vx, vy, ax, ay = flight
    t = 0.0
    if ax == 0.0:
        t, end = times_near_circle(x, vx, offset_radius + tolerance)
        horizon = min(horizon, end)
        if not comes_near_circle(
            coordinate_after(y, vy, ay, t), speed_after(vy, ay, t), ay, horizon - t, offset_radius + tolerance
        ):
            return math.inf
    elif ay == 0.0:
        t, end = times_near_circle(y, vy, offset_radius + tolerance)
        horizon = min(horizon, end)
        if not comes_near_circle(
            coordinate_after(x, vx, ax, t), speed_after(vx, ax, t), ax, horizon - t, offset_radius + tolerance
        ):
            return math.inf
    bound = math.sqrt(ax * ax + ay * ay)
    away = 0.0
    if x * x + y * y <= (offset_radius + tolerance) * (offset_radius + tolerance) and x * vx + y * vy > 0.0:
        # It has just bounced there: what is left of a gap is rounding, and would count for much in the last hops.
        away = math.sqrt(x * x + y * y) - offset_radius
    for _ in range(SEARCH_STEPS):
        now = flight_after(flight, t)
        distance = math.sqrt(now.x * now.x + now.y * now.y)
        gap = distance - offset_radius - away
        rate = (now.x * now.vx + now.y * now.vy) / distance
        if gap <= tolerance:
            curvature = bending(now)
            slow = rate >= -slow_on_circle(now, offset_radius, tolerance)
            told = slow and t == 0.0  # where the flight begins all that is touched has just been seen
            if rate < 0.0 and not told and grazes(rate * rate, curvature, gap + tolerance):
                return t - rate / curvature
            if not slow:
                # In a hop that hardly rises above the tolerance the speed still changes on the last bit of the way.
                root = math.sqrt(max(rate * rate + 2.0 * bound * gap, 0.0))
                return max(t + 2.0 * gap / (root - rate), 0.0)
            rate = max(rate, 0.0)
            gap = max(gap, 0.0)
        t += advancement_step(gap, rate, bound)
        if t > horizon:
            return math.inf
    # Along the circle's tangent from a touch the gap hardly opens, and each step is but a small one.
    return arc_crossing_time(flight, None, Circle(offset_radius, -1.0), True, tolerance, -1.0, horizon)


@function
def times_near_circle(x: float, v: float, offset_radius: float) -> tuple[float, float]:
    """Return the durations between which |x + v t| <= offset_radius, as (from, to) with from >= 0; from > to: never."""
    if abs(v) < STANDING:
        return 0.0, math.inf if abs(x) <= offset_radius else -1.0
    inverse = 1.0 / v
    middle, half = -x * inverse, offset_radius * abs(inverse)
    return max(middle - half, 0.0), middle + half


@function
def comes_near_circle(x: float, v: float, a: float, t: float, offset_radius: float) -> bool:
    """Return whether x + v t + a t^2 / 2 comes within `offset_radius` of 0 in `t` seconds; a `t` < 0 is never."""
    if t < 0.0:
        return False
    low, high = swept_interval(x, v, a, t)
    return low <= offset_radius and high >= -offset_radius
