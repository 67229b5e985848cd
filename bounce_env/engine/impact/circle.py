"""Time of impact of a flying ball with a circle, from outside.

Coordinates are relative to the circle's centre, in its frame.
"""

import math

from bounce_env.engine.compile.jit import Feature, function, routine
from bounce_env.engine.impact.advancement import open_for
from bounce_env.engine.impact.arc import crossing_time
from bounce_env.engine.motion.flight import bending, grazes, moved, slow_on_circle, sped, swept
from bounce_env.engine.tolerances import SEARCH_STEPS, STANDING, WEIGHTLESS


@function
def straight_circle_time(x: float, y: float, vx: float, vy: float, reach: float, slack: float) -> float:
    """Hit of a circle about the origin on a straight flight: the smaller root in closed form, nothing cancels."""
    distance = math.sqrt(x * x + y * y)
    approach = -(x * vx + y * vy)
    if approach <= slow_on_circle(vx, vy, reach, slack) * distance:
        return math.inf
    cross = x * vy - y * vx
    speed_square = vx * vx + vy * vy
    square = speed_square * reach * reach - cross * cross
    if grazes(abs(square), speed_square * reach, slack):
        return approach / speed_square
    if square <= 0.0:
        return math.inf
    return max(distance - reach, 0.0) * (distance + reach) / (approach + math.sqrt(square))


@function
def passing(x: float, v: float, reach: float) -> tuple[float, float]:
    """The durations between which |x + v t| <= reach, as (from, to) with from >= 0; from > to if never."""
    if abs(v) < STANDING:
        return 0.0, math.inf if abs(x) <= reach else -1.0
    inverse = 1.0 / v
    middle, half = -x * inverse, reach * abs(inverse)
    return max(middle - half, 0.0), middle + half


@function
def curved_circle_time(
    x: float, y: float, vx: float, vy: float, gx: float, gy: float, reach: float, slack: float, horizon: float
) -> float:
    """Hit of a circle about the origin under gravity, by bounded-acceleration advancement.

    The gap f(t) to a convex obstacle satisfies f'' >= -|g|, so stepping to the first root of f + f' h - |g| h^2 / 2
    cannot step over a hit, and converges quadratically. Just after a bounce f = 0 and f' > 0, and the same step leaves
    the circle: no ball is pushed off, no circle is skipped. A touch in passing is told where the path is nearest (see
    `grazes`). Across gravity along an axis the flight is uniform: the search is confined to the time in which it passes
    the circle there, and to flights that come near it then.
    """
    t = 0.0
    if gx == 0.0:
        t, end = passing(x, vx, reach + slack)
        horizon = min(horizon, end)
        if not near(moved(y, vy, gy, t), sped(vy, gy, t), gy, horizon - t, reach + slack):
            return math.inf
    elif gy == 0.0:
        t, end = passing(y, vy, reach + slack)
        horizon = min(horizon, end)
        if not near(moved(x, vx, gx, t), sped(vx, gx, t), gx, horizon - t, reach + slack):
            return math.inf
    bound = math.sqrt(gx * gx + gy * gy)
    away = 0.0
    if x * x + y * y <= (reach + slack) * (reach + slack) and x * vx + y * vy > 0.0:
        # It has just bounced there: what is left of a gap is rounding, and would count for much in the last hops.
        away = math.sqrt(x * x + y * y) - reach
    for _ in range(SEARCH_STEPS):
        px, py = moved(x, vx, gx, t), moved(y, vy, gy, t)
        qx, qy = sped(vx, gx, t), sped(vy, gy, t)
        distance = math.sqrt(px * px + py * py)
        gap = distance - reach - away
        rate = (px * qx + py * qy) / distance
        if gap <= slack:
            bend = bending(px, py, qx, qy, gx, gy)
            slow = rate >= -slow_on_circle(qx, qy, reach, slack)
            told = slow and t == 0.0  # where the flight begins all that is touched has just been seen
            if rate < 0.0 and not told and grazes(rate * rate, bend, gap + slack):
                return t - rate / bend
            if not slow:
                # In a hop that hardly rises above the slack the speed still changes on the last bit of the way.
                root = math.sqrt(max(rate * rate + 2.0 * bound * gap, 0.0))
                return max(t + 2.0 * gap / (root - rate), 0.0)
            rate = max(rate, 0.0)
            gap = max(gap, 0.0)
        t += open_for(gap, rate, bound)
        if t > horizon:
            return math.inf
    # Along the circle's tangent from a touch the gap hardly opens, and each step is but a small one.
    return crossing_time(None, reach, -1.0, x, y, vx, vy, gx, gy, True, slack, -1.0, horizon)


@function
def near(x: float, v: float, g: float, t: float, reach: float) -> bool:
    """Whether x + v t + g t^2 / 2 comes within `reach` of 0 in the next `t` seconds; a `t` < 0 is never."""
    if t < 0.0:
        return False
    low, high = swept(x, v, g, t)
    return low <= reach and high >= -reach


@routine
def circle_time(
    x: float, y: float, vx: float, vy: float, gx: Feature, gy: Feature, reach: float, slack: float, horizon: float
) -> float:
    """Hit of a circle about the origin, from outside."""
    if gx is None:
        return straight_circle_time(x, y, vx, vy, reach, slack)
    if abs(gx) + abs(gy) < WEIGHTLESS:
        return straight_circle_time(x, y, vx, vy, reach, slack)
    return curved_circle_time(x, y, vx, vy, gx, gy, reach, slack, horizon)
