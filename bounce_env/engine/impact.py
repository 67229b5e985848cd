"""Time of impact of a flying ball with a face and with a circle: one pure scalar function per shape.

All coordinates are relative to the obstacle, in its frame: for a part that moves uniformly the caller subtracts the
part's position and velocity, and the same functions serve. `reach` is the obstacle's radius plus the ball's [m];
`slack` is the length [m] below which a gap is a touch. Each returns the duration [s] from now to the hit, or inf.
"""

import math

from bounce_env.engine.arc import crossing_time
from bounce_env.engine.baa import open_for
from bounce_env.engine.flight import bending, dot, grazes, moved, slow_on_circle, sped, swept
from bounce_env.engine.jit import Feature, function, routine
from bounce_env.engine.tolerances import CORNER, SEARCH_STEPS, STANDING, ULPS_OF_SPEED, WEIGHTLESS


@function
def falling_time(gap: float, behind: bool, rate: float, pull: Feature) -> float:
    """First t >= 0 at which gap + rate t + pull t^2 / 2 falls through zero (a parabola falls through at most once).

    `behind` says that the ball is on the far side already, where the gap must rise above zero before it can fall.
    Written so that nothing cancels (Citardauq): each root is taken from the form that adds two terms of one sign.
    """
    if pull is None or pull == 0.0:
        if behind or rate >= 0.0:
            return math.inf
        return max(gap, 0.0) / -rate
    if rate < 0.0:
        if behind:
            return math.inf
        gap = max(gap, 0.0)
        square = rate * rate - 2.0 * pull * gap
        if square <= 0.0:
            return math.inf
        return 2.0 * gap / (math.sqrt(square) - rate)
    if pull > 0.0:
        return math.inf
    if not behind:
        gap = max(gap, 0.0)
    square = rate * rate - 2.0 * pull * gap
    if square <= 0.0 and behind:
        return math.inf
    return (rate + math.sqrt(square)) / -pull


@function
def line_time(
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Feature,
    gy: Feature,
    ux: float,
    uy: float,
    reach: float,
    facing: float,
    side: float,
    slack: float,
) -> float:
    """As `facing_time`, for a line that has no ends."""
    nx, ny = -facing * uy, facing * ux
    gap = x * nx + y * ny - reach
    rate = vx * nx + vy * ny
    if side == 0.0 and gap >= -CORNER * slack:
        # A disc that touches several surfaces is put on one of them, and may be that deep in another.
        gap = max(gap, 0.0)
    behind = gap < -slack or (gap <= slack and side == -facing)
    if abs(gap) <= slack:
        if abs(rate) <= ULPS_OF_SPEED * (abs(vx) + abs(vy)):
            rate = 0.0
        # It has just bounced there: what is left of a gap is rounding, and would count for much in the last hops.
        if behind:
            gap = min(gap, 0.0)
        elif rate > 0.0:
            gap = 0.0
    return falling_time(gap, behind, rate, dot(gx, gy, nx, ny))


@function
def beside(x: float, y: float, ux: float, uy: float, length: float, slack: float) -> bool:
    """Whether a point lies beside a wall, however far: neither before its start nor beyond its end."""
    along = x * ux + y * uy
    return -slack <= along <= length + slack


@function
def leaves_end(
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Feature,
    gy: Feature,
    ux: float,
    uy: float,
    length: float,
    reach: float,
    slack: float,
) -> bool:
    """Whether a ball slides off the end of a wall just now: it touches still, but will be beside it when it falls."""
    slow = ULPS_OF_SPEED * (abs(vx) + abs(vy))
    if not beside(x, y, ux, uy, length, slack):
        return False
    if abs(abs(y * ux - x * uy) - reach) > slack or abs(vy * ux - vx * uy) > slow:
        return False
    along = x * ux + y * uy
    lean = vx * ux + vy * uy
    if abs(lean) <= slow and gx is not None:
        lean = gx * ux + gy * uy
    return (along >= length - slack and lean > 0.0) or (along <= slack and lean < 0.0)


@function
def facing_time(
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Feature,
    gy: Feature,
    ux: float,
    uy: float,
    length: float,
    reach: float,
    facing: float,
    side: float,
    slack: float,
    horizon: float,
) -> float:
    """Hit of one face of a wall that starts at the origin and runs `length` along the unit vector (ux, uy).

    `facing` 1.0 is the face on the left of that direction, -1.0 the one on the right. `side` is the side, 1 or -1, on
    which a ball of no radius is while it touches the wall; 0 for a disc, whose centre keeps its distance.
    """
    t = line_time(x, y, vx, vy, gx, gy, ux, uy, reach, facing, side, slack)
    if t > horizon or t == math.inf or leaves_end(x, y, vx, vy, gx, gy, ux, uy, length, reach, slack):
        return math.inf
    # The slack closes the joint between two walls for a ball of no radius; for a disc the end's circle takes over.
    return t if beside(moved(x, vx, gx, t), moved(y, vy, gy, t), ux, uy, length, slack) else math.inf


@function
def face_time(
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Feature,
    gy: Feature,
    ux: float,
    uy: float,
    length: float,
    reach: float,
    side: float,
    slack: float,
    horizon: float,
) -> float:
    """The earlier hit of the two faces of a wall; arguments as for `facing_time`."""
    left = facing_time(x, y, vx, vy, gx, gy, ux, uy, length, reach, 1.0, side, slack, horizon)
    right = facing_time(x, y, vx, vy, gx, gy, ux, uy, length, reach, -1.0, side, slack, horizon)
    return min(left, right)


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


@routine
def capsule_time(
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Feature,
    gy: Feature,
    ux: float,
    uy: float,
    back: float,
    front: float,
    reach: float,
    slack: float,
    horizon: float,
) -> float:
    """Hit of a capsule whose core runs from `back` to `front` [m] along the unit (ux, uy) through the origin."""
    bx, by, fx, fy = back * ux, back * uy, front * ux, front * uy
    t = face_time(x - bx, y - by, vx, vy, gx, gy, ux, uy, front - back, reach, 0, slack, horizon)
    t = min(t, circle_time(x - bx, y - by, vx, vy, gx, gy, reach, slack, min(t, horizon)))
    t = min(t, circle_time(x - fx, y - fy, vx, vy, gx, gy, reach, slack, min(t, horizon)))
    return t if t <= horizon else math.inf
