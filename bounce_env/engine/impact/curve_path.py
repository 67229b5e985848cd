"""What a slide on a circle meets: where its path crosses lines and other circles, and which of that comes first.

Geometry alone tells where, and in which order; the time is asked of one point only, by its phase. A path that dips into
something by no more than the tolerance of lengths only touches it in passing.
"""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import function, routine
from bounce_env.engine.motion.curve_slide import (
    CurveSlide,
    curve_slide_period,
    curve_slide_time_to,
    half_angle_from_lowest,
    largest_half_angle_sine,
)

# Where the legs of a way begin: on ahead, back after a turning point, on again behind the start.
_BACK, _AGAIN = 8.0, 16.0


class CurveStart(NamedTuple):
    """Where a slide begins: unit vector from the centre, how far along (see `_course`), whether counter-clockwise."""

    nx: float
    ny: float
    course: float
    forth: bool


class Waypoint(NamedTuple):
    """A point of a slide's path: its place in the order along the way, S and C of it, whether passed forth."""

    order: float  # inf: the slide does not come there
    s: float
    c: float
    forth: bool


class Crossings(NamedTuple):
    """Where a path enters something: counter-clockwise at (fx, fy), clockwise at (bx, by) from its centre; or never."""

    fx: float
    fy: float
    bx: float
    by: float
    any: bool


@function
def crossing_point(crossings: Crossings, forth: bool) -> tuple[float, float]:
    """Return the direction from the centre of the one that is come to counter-clockwise, or of the other."""
    return (crossings.fx, crossings.fy) if forth else (crossings.bx, crossings.by)


@function
def curve_start(slide: CurveSlide, nx: float, ny: float) -> CurveStart:
    """Return where a slide begins, in the direction (nx, ny) from its centre."""
    s, c = half_angle_from_lowest(slide, nx, ny)
    return CurveStart(nx, ny, _course(s, c), slide.sense > 0.0)


@function
def _course(s: float, c: float) -> float:
    """Return what grows with the angle from the lowest point, without losing digits anywhere."""
    if abs(s) <= abs(c):
        return s
    return math.copysign(math.sqrt(2.0) - abs(c), s)


@routine
def waypoint(slide: CurveSlide, start: CurveStart, nx: float, ny: float, forth: bool, passed: bool) -> Waypoint:
    """Return the point in the direction (nx, ny) from the centre of a slide, come to counter-clockwise or clockwise.

    passed: of a point next to the start, that the slide has it behind.
    """
    s, c = half_angle_from_lowest(slide, nx, ny)
    if abs(s) > largest_half_angle_sine(slide) if slide.swings else forth != start.forth:
        return Waypoint(math.inf, s, c, forth)
    sign = 1.0 if start.forth else -1.0
    way = sign * (_course(s, c) - start.course)
    if forth != start.forth:
        return Waypoint(_BACK - way, s, c, forth)
    return Waypoint(way if way >= 0.0 and not passed else _AGAIN + way, s, c, forth)


@routine
def waypoint_time(slide: CurveSlide, point: Waypoint) -> float:
    """Return how long [s] after its beginning a slide first comes to a point."""
    if point.order == math.inf:
        return math.inf
    t = curve_slide_time_to(slide, point.s, point.c, point.forth)
    if point.order < 0.5 * _BACK:
        return max(t, 0.0)
    if point.order > 0.5 * (_BACK + _AGAIN) or t < 0.0:
        t += curve_slide_period(slide)
    return t


@function
def line_crossings(radius: float, nx: float, ny: float, height: float, tolerance: float) -> Crossings:
    """Return where a path of this radius falls below `height` [m] along the unit vector (nx, ny), from its centre."""
    if not -radius + tolerance < height < radius:
        return Crossings(0.0, 0.0, 0.0, 0.0, False)
    a = height / radius
    b = math.sqrt((1.0 - a) * (1.0 + a))
    return Crossings(a * nx - b * ny, a * ny + b * nx, a * nx + b * ny, a * ny - b * nx, True)


@function
def circle_crossings(radius: float, x: float, y: float, border: float, sense: float, tolerance: float) -> Crossings:
    """Return where a path of this radius crosses a circle of the radius `border` about (x, y) from the path's centre.

    sense: -1.0 where the distance from (x, y) falls, 1.0 where it rises.
    """
    distance = math.sqrt(x * x + y * y)
    depth = border - abs(distance - radius) if sense < 0.0 else distance + radius - border
    if distance == 0.0 or depth <= tolerance:
        return Crossings(0.0, 0.0, 0.0, 0.0, False)
    a = ((radius - border) * (radius + border) + distance * distance) / (2.0 * radius * distance)
    if not -1.0 < a < 1.0:
        return Crossings(0.0, 0.0, 0.0, 0.0, False)
    b = sense * math.sqrt((1.0 - a) * (1.0 + a))
    nx, ny = x / distance, y / distance
    return Crossings(a * nx - b * ny, a * ny + b * nx, a * nx + b * ny, a * ny - b * nx, True)


@function
def is_next_to_start(start: CurveStart, crossings: Crossings, forth: bool) -> bool:
    """Return whether one of two crossings is the one next to where a path begins: no farther from it than the other."""
    (x, y), (ox, oy) = crossing_point(crossings, forth), crossing_point(crossings, not forth)
    return x * start.nx + y * start.ny >= ox * start.nx + oy * start.ny


@routine
def curve_time_after(
    slide: CurveSlide, start: CurveStart, nx: float, ny: float, forth: bool, passed: bool, after: float
) -> float:
    """Return when a slide next comes to a point later than `after` [s], or inf; arguments as for `waypoint`."""
    t = waypoint_time(slide, waypoint(slide, start, nx, ny, forth, passed))
    if t > after or t == math.inf:
        return t
    period = curve_slide_period(slide)
    t += period * math.floor((after - t) / period)
    t = t if t > after else t + period
    return t if t > after else math.inf  # the clock of a slide no longer tells its turns apart
