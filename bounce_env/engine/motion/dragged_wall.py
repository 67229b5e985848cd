"""The ends of a dragged wall: where they are, how fast they may move, and when one of them has to stop.

Each end moves uniformly between commands and stops. A coordinate that comes to the border of the wall's box stops there
by itself; where the ends come as near to each other as the wall is short at least, both stop.
"""

import math

from bounce_env.engine.compile.jit import Record, function
from bounce_env.engine.motion.instant import since
from bounce_env.engine.tolerances import ULPS_OF_LENGTH, ULPS_OF_SPEED

# Longer than anything lasts [s]: a sum with it is still a number.
NO_STOP = 1e300


@function
def dragged_wall_line_at(ends: Record, t: float) -> tuple[float, float, float, float, float]:
    """Return where the wall is after `t` seconds of its motion: start (x, y) [m], unit vector along it, length [m]."""
    x, y = ends.x0 + ends.vx0 * t, ends.y0 + ends.vy0 * t
    dx, dy = ends.x1 + ends.vx1 * t - x, ends.y1 + ends.vy1 * t - y
    length = math.sqrt(dx * dx + dy * dy)
    return x, y, dx / length, dy / length, length


@function
def velocity_on_dragged_wall(ends: Record, share: float) -> tuple[float, float]:
    """Return the velocity [m/s] of the point of the wall that lies `share` of the way from its start to its end."""
    return ends.vx0 + share * (ends.vx1 - ends.vx0), ends.vy0 + share * (ends.vy1 - ends.vy0)


@function
def height_over_dragged_wall(ends: Record, t: float, x: float, y: float, vx: float, vy: float) -> tuple[float, float]:
    """Return the height [m] of a point over the wall's line, on its left, after `t` seconds, and its rate [m/s]."""
    ox, oy, ux, uy, length = dragged_wall_line_at(ends, t)
    sx, sy = velocity_on_dragged_wall(ends, ((x - ox) * ux + (y - oy) * uy) / length)
    return (y - oy) * ux - (x - ox) * uy, (vy - sy) * ux - (vx - sx) * uy


@function
def _time_to_drag_border(place: float, velocity: float, low: float, high: float) -> float:
    """Return how long [s] a coordinate moves on before it comes to a border."""
    return NO_STOP if velocity == 0.0 else min((_drag_border_ahead(velocity, low, high) - place) / velocity, NO_STOP)


@function
def _drag_border_ahead(velocity: float, low: float, high: float) -> float:
    return high if velocity > 0.0 else low


@function
def _time_to_shortest_dragged_wall(ends: Record, shortest: float) -> float:
    """Return how long [s] the ends move on before they are as near to each other as they may come."""
    dx, dy, ex, ey = ends.x1 - ends.x0, ends.y1 - ends.y0, ends.vx1 - ends.vx0, ends.vy1 - ends.vy0
    closing, square = -(dx * ex + dy * ey), dx * dx + dy * dy - shortest * shortest
    if closing <= ULPS_OF_SPEED * (abs(dx * ex) + abs(dy * ey)):
        return NO_STOP
    if square <= ULPS_OF_LENGTH * shortest * shortest:
        return 0.0
    root = closing * closing - (ex * ex + ey * ey) * square
    return NO_STOP if root < 0.0 else min(square / (closing + math.sqrt(root)), NO_STOP)


@function
def _time_to_stop_of_dragged_ends(ends: Record, limits: Record) -> float:
    xs = min(
        _time_to_drag_border(ends.x0, ends.vx0, limits.x0, limits.x1),
        _time_to_drag_border(ends.x1, ends.vx1, limits.x0, limits.x1),
    )
    ys = min(
        _time_to_drag_border(ends.y0, ends.vy0, limits.y0, limits.y1),
        _time_to_drag_border(ends.y1, ends.vy1, limits.y0, limits.y1),
    )
    return min(xs, ys, _time_to_shortest_dragged_wall(ends, limits.shortest))


@function
def _velocity_at_drag_border(place: float, velocity: float, low: float, high: float) -> float:
    """Return a coordinate's velocity, 0 where a border holds it."""
    return 0.0 if (place <= low and velocity < 0.0) or (place >= high and velocity > 0.0) else velocity


@function
def move_dragged_ends(motion: Record, ends: Record, limits: Record, hi: float, lo: float) -> None:
    """Bring the ends to an instant of their motion; one that has come to a border is on it."""
    t = since(hi, lo, motion.hi, motion.lo)
    ends.x0, ends.y0 = ends.x0 + ends.vx0 * t, ends.y0 + ends.vy0 * t
    ends.x1, ends.y1 = ends.x1 + ends.vx1 * t, ends.y1 + ends.vy1 * t
    ends.x0, ends.x1 = min(max(ends.x0, limits.x0), limits.x1), min(max(ends.x1, limits.x0), limits.x1)
    ends.y0, ends.y1 = min(max(ends.y0, limits.y0), limits.y1), min(max(ends.y1, limits.y0), limits.y1)
    motion.hi, motion.lo = hi, lo


@function
def stop_dragged_ends_at_borders(motion: Record, ends: Record, limits: Record) -> None:
    """Let what is held by a border stop, and both ends where they are as near to each other as they may come.

    Then set how long the wall moves on.
    """
    ends.vx0, ends.vx1 = (
        _velocity_at_drag_border(ends.x0, ends.vx0, limits.x0, limits.x1),
        _velocity_at_drag_border(ends.x1, ends.vx1, limits.x0, limits.x1),
    )
    ends.vy0, ends.vy1 = (
        _velocity_at_drag_border(ends.y0, ends.vy0, limits.y0, limits.y1),
        _velocity_at_drag_border(ends.y1, ends.vy1, limits.y0, limits.y1),
    )
    if _time_to_shortest_dragged_wall(ends, limits.shortest) == 0.0:
        stop_dragged_ends(motion, ends)
        return
    moves = ends.vx0 != 0.0 or ends.vy0 != 0.0 or ends.vx1 != 0.0 or ends.vy1 != 0.0
    motion.velocity = 1.0 if moves else 0.0
    motion.offset = -_time_to_stop_of_dragged_ends(ends, limits)


@function
def stop_dragged_ends(motion: Record, ends: Record) -> None:
    """Let both ends stand."""
    ends.vx0, ends.vy0, ends.vx1, ends.vy1 = 0.0, 0.0, 0.0, 0.0
    motion.velocity, motion.offset = 0.0, 0.0


@function
def set_dragged_ends_off(motion: Record, ends: Record, limits: Record, hi: float, lo: float) -> None:
    """Let the ends move, from the instant (hi, lo) on, as they were last commanded to."""
    move_dragged_ends(motion, ends, limits, hi, lo)
    ends.vx0, ends.vy0, ends.vx1, ends.vy1 = ends.cx0, ends.cy0, ends.cx1, ends.cy1
    stop_dragged_ends_at_borders(motion, ends, limits)


@function
def take_next_stop_of_dragged_ends(motion: Record, ends: Record, limits: Record, hi: float, lo: float) -> None:
    """Let one or both ends stop at the instant (hi, lo) of their next stop."""
    duration = -motion.offset
    for_x0 = _time_to_drag_border(ends.x0, ends.vx0, limits.x0, limits.x1) <= duration
    for_y0 = _time_to_drag_border(ends.y0, ends.vy0, limits.y0, limits.y1) <= duration
    for_x1 = _time_to_drag_border(ends.x1, ends.vx1, limits.x0, limits.x1) <= duration
    for_y1 = _time_to_drag_border(ends.y1, ends.vy1, limits.y0, limits.y1) <= duration
    narrow = _time_to_shortest_dragged_wall(ends, limits.shortest) <= duration
    move_dragged_ends(motion, ends, limits, hi, lo)
    if narrow:
        stop_dragged_ends(motion, ends)
        return
    # On the border to the bit, whatever the rounding of the way there.
    ends.x0 = _drag_border_ahead(ends.vx0, limits.x0, limits.x1) if for_x0 else ends.x0
    ends.y0 = _drag_border_ahead(ends.vy0, limits.y0, limits.y1) if for_y0 else ends.y0
    ends.x1 = _drag_border_ahead(ends.vx1, limits.x0, limits.x1) if for_x1 else ends.x1
    ends.y1 = _drag_border_ahead(ends.vy1, limits.y0, limits.y1) if for_y1 else ends.y1
    stop_dragged_ends_at_borders(motion, ends, limits)
