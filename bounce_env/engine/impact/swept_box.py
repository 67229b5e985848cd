"""What a flight cannot meet: most obstacles are told so by the box around them, before anything is solved.

While a flight is uniform along x it is beside a box between two instants, and what it sweeps along y meanwhile tells
whether it comes to it. Boxes are wider than what they hold, by the rounding of all lengths in a search, many
times over: left out is what is missed for certain, so that no bit of any hit depends on it.
"""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import NumberOrNone, Record, function, where
from bounce_env.engine.motion.flight import Flight, coordinate_after, flight_path_bound, swept_interval
from bounce_env.engine.motion.roots import falling_root
from bounce_env.engine.tolerances import BOX_MARGIN, STANDING


class Box(NamedTuple):
    """Where the ball's centre is while it touches something [m]."""

    left: float
    right: float
    below: float
    above: float


class Sweep(NamedTuple):
    """How far a flight is searched: up to a horizon [s], the box that it sweeps until then; and 1 / vx [s/m]."""

    horizon: float
    box: Box
    margin: float  # [m] by which boxes are wider
    inverse: float


@function
def sweep_of(flight: Flight, extent: float, horizon: float) -> Sweep:
    """Return what boxes are asked by, of a flight up to a horizon [s] in a scene of this extent [m]."""
    margin = BOX_MARGIN * (extent + flight_path_bound(flight, horizon))
    left, right = swept_interval(flight.x, flight.vx, flight.ax, horizon)
    below, above = swept_interval(flight.y, flight.vy, flight.ay, horizon)
    box = Box(left - margin, right + margin, below - margin, above + margin)
    return Sweep(horizon, box, margin, 1.0 / flight.vx if abs(flight.vx) > STANDING else math.inf)


@function
def box_of(row: Record) -> Box:
    """Return the box of a row of a table that has one."""
    return Box(row.left, row.right, row.below, row.above)


@function
def circle_box(x: float, y: float, radius: float) -> Box:
    """Return the box of a circle."""
    return Box(x - radius, x + radius, y - radius, y + radius)


@function
def misses_box(flight: Flight, sweep: Sweep, box: Box) -> bool:
    """Return whether a flight surely does not come to a box before its horizon.

    Written so that infinite or undefined borders, of a flight without an end, leave out nothing.
    """
    return are_apart(sweep.box, box) or _passes_beside(flight, sweep, box)


@function
def are_apart(one: Box, other: Box) -> bool:
    """Return whether two boxes have no point in common; undefined borders have."""
    beside = (other.right < one.left) | (other.left > one.right)
    return beside | (other.above < one.below) | (other.below > one.above)


@function
def _passes_beside_uniformly(flight: Flight, sweep: Sweep, box: Box) -> bool:
    """Return the same by what a flight that is uniform along x sweeps along y while it is beside the box."""
    if sweep.inverse == math.inf or not sweep.margin < math.inf:
        return False
    one = (box.left - sweep.margin - flight.x) * sweep.inverse
    other = (box.right + sweep.margin - flight.x) * sweep.inverse
    start, end = max(min(one, other), 0.0), min(max(one, other), sweep.horizon)
    low, high = _swept_between(flight.y, flight.vy, flight.ay, start, end)
    return (start > end) | (high < box.below - sweep.margin) | (low > box.above + sweep.margin)


@where("ax", otherwise=_passes_beside_uniformly)
def _passes_beside(flight: Flight, sweep: Sweep, box: Box) -> bool:
    return flight.ax == 0.0 and _passes_beside_uniformly(flight, sweep, box)


@function
def _swept_between(x: float, v: float, a: NumberOrNone, start: float, end: float) -> tuple[float, float]:
    """Return the smallest and the largest value [m] that a coordinate takes on from `start` to `end` [s]."""
    one, other = coordinate_after(x, v, a, start), coordinate_after(x, v, a, end)
    low, high = min(one, other), max(one, other)
    if a is not None and (v + a * start) * (v + a * end) < 0.0:
        turn = x - 0.5 * v * v / a
        low, high = min(low, turn), max(high, turn)
    return low, high


@function
def is_in_box(box: Box, x: float, y: float) -> bool:
    """Return whether a point [m] is in a box."""
    return box.left <= x <= box.right and box.below <= y <= box.above


@function
def box_leaving_time(flight: Flight, box: Box, after: float) -> float:
    """Return when a flight that is in a box leaves it, no earlier than `after` [s]; inf if it does not."""
    x, y, vx, vy, ax, ay = flight
    right, left = _falls(box.right - x, -vx, ax, -1.0, after), _falls(x - box.left, vx, ax, 1.0, after)
    above, below = _falls(box.above - y, -vy, ay, -1.0, after), _falls(y - box.below, vy, ay, 1.0, after)
    return min(right, left, above, below)


@function
def box_entry_time(flight: Flight, box: Box, after: float) -> float:
    """Return when a flight that is not in a box comes into it, no earlier than `after` [s]; inf if it does not.

    What passes a corner by less than some millionths of the box counts as having come into it.
    """
    x, y, vx, vy, ax, ay = flight
    # Where it has left the box for next to no time, rounding may have it come back before.
    soon = after - BOX_MARGIN * after
    slack = 2.0**-20 * (box.right - box.left + box.above - box.below)
    wide = Box(box.left - slack, box.right + slack, box.below - slack, box.above + slack)
    best = math.inf
    left, right = _falls(box.left - x, -vx, ax, -1.0, soon), _falls(x - box.right, vx, ax, 1.0, soon)
    below, above = _falls(box.below - y, -vy, ay, -1.0, soon), _falls(y - box.above, vy, ay, 1.0, soon)
    for t in (left, right):
        if t < best and wide.below <= coordinate_after(y, vy, ay, t) <= wide.above:
            best = t
    for t in (below, above):
        if t < best and wide.left <= coordinate_after(x, vx, ax, t) <= wide.right:
            best = t
    return max(best, after)


@function
def _falls(gap: float, rate: float, a: NumberOrNone, sign: float, soonest: float) -> float:
    """Return when a gap [m] of this rate [m/s], of the acceleration sign * a, falls through 0; not before `soonest`."""
    t = falling_root(gap, gap < 0.0, rate, _signed(a, sign))
    return t if t >= soonest else math.inf


@function
def _signed(a: NumberOrNone, sign: float) -> NumberOrNone:
    return None if a is None else sign * a
