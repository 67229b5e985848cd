"""Time of impact of a flying ball with a straight wall, and with each of its two faces.

Flights are relative to the wall's start, in its frame: for a part that moves uniformly the caller subtracts the part's
position and velocity, and the same functions serve. `tolerance` is the length [m] below which a gap is a touch. Each
function returns the duration [s] from now to the hit, or inf.
"""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import function
from bounce_env.engine.motion.flight import Flight, flight_acceleration_along, flight_place_after
from bounce_env.engine.motion.roots import falling_root
from bounce_env.engine.tolerances import CORNER, ULPS_OF_SPEED


class Line(NamedTuple):
    """A wall from the origin: unit vector along it, its length [m], and how near [m] the ball's centre comes to it."""

    ux: float
    uy: float
    length: float
    offset_radius: float


@function
def line_time(flight: Flight, line: Line, facing: float, side: float, tolerance: float) -> float:
    """Return the hit of one side of a line, taken to have no ends; arguments as for `facing_time`."""
    nx, ny = -facing * line.uy, facing * line.ux
    gap = flight.x * nx + flight.y * ny - line.offset_radius
    rate = flight.vx * nx + flight.vy * ny
    if side == 0.0 and gap >= -CORNER * tolerance:
        # A disc that touches several surfaces is put on one of them, and may be that deep in another.
        gap = max(gap, 0.0)
    behind = gap < -tolerance or (gap <= tolerance and side == -facing)
    if abs(gap) <= tolerance:
        if abs(rate) <= ULPS_OF_SPEED * (abs(flight.vx) + abs(flight.vy)):
            rate = 0.0
        # It has just bounced there: what is left of a gap is rounding, and would count for much in the last hops.
        if behind:
            gap = min(gap, 0.0)
        elif rate > 0.0:
            gap = 0.0
    return falling_root(gap, behind, rate, flight_acceleration_along(flight, nx, ny))


@function
def is_beside_line(line: Line, x: float, y: float, tolerance: float) -> bool:
    """Return whether a point lies beside a wall, however far: neither before its start nor beyond its end."""
    along = x * line.ux + y * line.uy
    return -tolerance <= along <= line.length + tolerance


@function
def leaves_line_end(flight: Flight, line: Line, tolerance: float) -> bool:
    """Return whether a ball slides off the end of a wall now: it still touches, but will be beside it when it falls."""
    slow = ULPS_OF_SPEED * (abs(flight.vx) + abs(flight.vy))
    if not is_beside_line(line, flight.x, flight.y, tolerance):
        return False
    if abs(abs(flight.y * line.ux - flight.x * line.uy) - line.offset_radius) > tolerance:
        return False
    # As generous as what counts as level on a wall: at the end there is no later hit that would set it right.
    if abs(flight.vy * line.ux - flight.vx * line.uy) > 4.0 * slow:
        return False
    along = flight.x * line.ux + flight.y * line.uy
    lean = flight.vx * line.ux + flight.vy * line.uy
    if abs(lean) <= slow:
        lean = _pull_or(flight_acceleration_along(flight, line.ux, line.uy), lean)
    return (along >= line.length - tolerance and lean > 0.0) or (along <= tolerance and lean < 0.0)


@function
def _pull_or(value: float | None, other: float) -> float:
    return other if value is None else value


@function
def facing_time(flight: Flight, line: Line, facing: float, side: float, tolerance: float, horizon: float) -> float:
    """Return the hit of one face of a wall, before `horizon` [s].

    `facing` 1.0 is the face on the left of the wall's direction, -1.0 the one on the right. `side` is the side, 1 or
    -1, on which a ball of no radius is while it touches the wall; 0 for a disc, whose centre keeps its distance.
    """
    t = line_time(flight, line, facing, side, tolerance)
    if t > horizon or t == math.inf or leaves_line_end(flight, line, tolerance):
        return math.inf
    # The tolerance closes the joint between two walls for a ball of no radius; for a disc the end's circle takes over.
    x, y = flight_place_after(flight, t)
    return t if is_beside_line(line, x, y, tolerance) else math.inf


@function
def face_time(flight: Flight, line: Line, side: float, tolerance: float, horizon: float) -> float:
    """Return the earlier hit of the two faces of a wall; arguments as for `facing_time`."""
    left = facing_time(flight, line, 1.0, side, tolerance, horizon)
    right = facing_time(flight, line, -1.0, side, tolerance, horizon)
    return min(left, right)
