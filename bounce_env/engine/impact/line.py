"""Time of impact of a flying ball with a face and with a circle: one pure scalar function per shape.

All coordinates are relative to the obstacle, in its frame: for a part that moves uniformly the caller subtracts the
part's position and velocity, and the same functions serve. `reach` is the obstacle's radius plus the ball's [m];
`slack` is the length [m] below which a gap is a touch. Each returns the duration [s] from now to the hit, or inf.
"""

import math

from bounce_env.engine.compile.jit import Feature, function
from bounce_env.engine.motion.flight import dot, moved
from bounce_env.engine.motion.roots import falling_time
from bounce_env.engine.tolerances import CORNER, ULPS_OF_SPEED


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
