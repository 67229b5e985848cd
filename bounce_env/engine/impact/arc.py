"""Time of impact with an arc: from outside, where the distance falls to a radius, and from inside, where it rises.

Flights are relative to the arc's centre. A crossing of the full circle counts where its direction lies in the arc's
span; the others go through its opening.
"""

import math
from typing import Any, NamedTuple

from bounce_env.engine.compile.jit import Record, function, routine, where
from bounce_env.engine.impact.grazing import bending, grazes, slow_on_circle
from bounce_env.engine.impact.quartic import (
    distance_quartic,
    quartic_monotone_borders,
    quartic_root_between,
    quartic_value,
    quartic_without_root_at_zero,
)
from bounce_env.engine.memory.records import CLOSED, MINOR
from bounce_env.engine.motion.flight import Flight, flight_after, flight_place_after
from bounce_env.engine.tolerances import PRESSING, ULP, WEIGHTLESS


class Circle(NamedTuple):
    """A circle about the origin: the distance [m] at which it is crossed, rising if `sense` is 1.0, falling if -1.0."""

    offset_radius: float
    sense: float


@function
def is_in_arc_span(arc: Any, dx: float, dy: float, tolerance: float) -> bool:
    """Return whether the point at (dx, dy) [m] from the centre lies beside the arc, ends included within a tolerance.

    `arc` is an ARC, or None for a circle that is no arc.
    """
    if arc is None:
        return True
    if arc.span == CLOSED:
        return True
    from_start = arc.sx * dy - arc.sy * dx
    to_end = dx * arc.ey - dy * arc.ex
    if arc.span == MINOR:
        return from_start >= -tolerance and to_end >= -tolerance
    # Of a span of more than half a turn the opening is the smaller part.
    return not (to_end < -tolerance and from_start < -tolerance)


@function
def arc_time(flight: Flight, arc: Record, side: int, inside_only: bool, tolerance: float, horizon: float) -> float:
    """Return the earlier hit of the arc's two sides before `horizon` [s], or inf.

    `side` is where a ball of no radius is while it touches: 1 outside, -1 inside; 0 for a disc, whose centre tells.
    """
    t = math.inf
    if not inside_only:
        t = arc_crossing_time(flight, arc, Circle(arc.outer, -1.0), side != -1, tolerance, -1.0, horizon)
    if arc.inner > 0.0:
        end = min(t, horizon)
        t = min(t, arc_crossing_time(flight, arc, Circle(arc.inner, 1.0), side != 1, tolerance, -1.0, end))
    return t


@function
def arc_entry_time(
    flight: Flight, radius: float, outside: bool, tolerance: float, after: float, horizon: float
) -> float:
    """Return when a point next enters a circle about the origin, after `after` [s] and before `horizon`, or inf."""
    distance = math.sqrt(flight.x * flight.x + flight.y * flight.y)
    slow = slow_on_circle(flight, radius, tolerance) * distance
    touches = abs(distance - radius) <= tolerance and abs(flight.x * flight.vx + flight.y * flight.vy) <= slow
    if touches and after < 0.0 and outside and _sinks_into_circle(flight):
        return 0.0
    return arc_crossing_time(flight, None, Circle(radius, -1.0), outside, tolerance, after, horizon)


@routine
def arc_crossing_time(
    flight: Flight, arc: Any, circle: Circle, armed: bool, tolerance: float, after: float, horizon: float
) -> float:
    """Return when the distance from the centre next crosses that of the circle beside the arc.

    Later than `after` [s] and before `horizon`; inf if it does not. `armed` says that a ball that touches is on the
    side from which that is a hit.
    """
    distance = math.sqrt(flight.x * flight.x + flight.y * flight.y)
    gap = -circle.sense * (distance - circle.offset_radius)
    touching = abs(gap) <= tolerance
    approach = circle.sense * (flight.x * flight.vx + flight.y * flight.vy)
    slow = slow_on_circle(flight, circle.offset_radius, tolerance) * distance
    if touching and armed and approach > slow and after < 0.0 and is_in_arc_span(arc, flight.x, flight.y, tolerance):
        wait = _time_to_nearest_on_arc(flight, circle.sense, tolerance)
        return wait if wait > 0.0 else max(gap, 0.0) * distance / approach
    # Where a ball moves along the circle the contact rules have let it: the root at the start is none.
    still = touching and abs(approach) <= slow
    return _arc_crossing(flight, arc, circle, touching, still, tolerance, after, horizon)


@function
def _time_to_nearest_on_arc(flight: Flight, sense: float, tolerance: float) -> float:
    """Return how long [s] until a point that touches in passing (see `grazes`) is nearest; 0 if it does not."""
    distance = math.sqrt(flight.x * flight.x + flight.y * flight.y)
    closing = sense * (flight.x * flight.vx + flight.y * flight.vy) / distance
    opening = -sense * bending(flight)
    if closing > 0.0 and opening > 0.0 and grazes(closing * closing, opening, tolerance):
        return closing / opening
    return 0.0


@function
def _touches_arc_at(flight: Flight, arc: Any, offset_radius: float, t: float, tolerance: float) -> bool:
    """Return whether a ball touches after `t` seconds, beside the arc."""
    x, y = flight_place_after(flight, t)
    return abs(math.sqrt(x * x + y * y) - offset_radius) <= tolerance and is_in_arc_span(arc, x, y, tolerance)


@function
def _sinks_into_circle_coasting(flight: Flight) -> bool:
    return False


@where("ax", otherwise=_sinks_into_circle_coasting)
def _sinks_into_circle(flight: Flight) -> bool:
    """Return whether a point that moves along the circle is about to cross it, by its second derivative."""
    square = flight.vx * flight.vx + flight.vy * flight.vy
    dx, dy = flight.x * flight.ax, flight.y * flight.ay
    return -(square + dx + dy) > PRESSING * (square + abs(dx) + abs(dy))


@function
def _straight_arc_crossing(
    flight: Flight,
    arc: Any,
    circle: Circle,
    touching: bool,
    still: bool,
    tolerance: float,
    after: float,
    horizon: float,
) -> float:
    """On a straight flight: the smaller root is where the distance falls, the larger where it rises."""
    x, y, vx, vy, _, _ = flight
    offset_radius = circle.offset_radius
    square = vx * vx + vy * vy
    half = x * vx + y * vy
    if still:
        return math.inf
    if touching:
        # The root at the start has been told of; the other one, however near, is found without a difference of squares.
        if circle.sense < 0.0 or half >= 0.0:
            return math.inf
        t = -2.0 * half / square
    else:
        cross = x * vy - y * vx
        inner = square * offset_radius * offset_radius - cross * cross
        if inner <= 0.0:
            return math.inf
        root = math.sqrt(inner)
        distance = math.sqrt(x * x + y * y)
        rest = (distance - offset_radius) * (distance + offset_radius)
        # Each root is taken from the form that adds two terms of one sign.
        if circle.sense > 0.0:
            t = (root - half) / square if half < 0.0 else -rest / (root + half)
        else:
            t = rest / (root - half) if half < 0.0 else -(root + half) / square
    t += _time_to_nearest_on_arc(Flight(x + vx * t, y + vy * t, vx, vy, None, None), circle.sense, tolerance)
    if t < 0.0 or t <= after or t > horizon or not is_in_arc_span(arc, x + vx * t, y + vy * t, tolerance):
        return math.inf
    return t


@where("ax", otherwise=_straight_arc_crossing)
def _arc_crossing(
    flight: Flight,
    arc: Any,
    circle: Circle,
    touching: bool,
    still: bool,
    tolerance: float,
    after: float,
    horizon: float,
) -> float:
    if abs(flight.ax) + abs(flight.ay) < WEIGHTLESS:
        return _straight_arc_crossing(flight, arc, circle, touching, still, tolerance, after, horizon)
    return _curved_arc_crossing(flight, arc, circle, touching, still, tolerance, after, horizon)


@function
def _curved_arc_crossing(
    flight: Flight,
    arc: Any,
    circle: Circle,
    touching: bool,
    still: bool,
    tolerance: float,
    after: float,
    horizon: float,
) -> float:
    """On a parabola: all crossings in order, up to the first beside the arc."""
    offset_radius, sense = circle
    c = distance_quartic(flight, offset_radius)
    if touching:
        # What is left of a gap is no way to go: the hit is where the ball is as near again.
        c, offset_radius = quartic_without_root_at_zero(c), math.sqrt(flight.x * flight.x + flight.y * flight.y)
    if still:
        c = quartic_without_root_at_zero(c)
        # Let go by the circle, or about to be held again: what is left of the second derivative is rounding.
        pull, square = abs(flight.ax) + abs(flight.ay), flight.vx * flight.vx + flight.vy * flight.vy
        if abs(c[0]) <= pull * (tolerance + 4.0 * ULP * offset_radius) + 8.0 * ULP * square:
            c = quartic_without_root_at_zero(c)
    borders = quartic_monotone_borders(c, horizon)
    for i in range(4):
        start, end = borders[i], borders[i + 1]
        if not (sense * quartic_value(c, start) < 0.0 <= sense * quartic_value(c, end)):
            turns = sense < 0.0 and not touching and start < end < horizon and end > after
            if turns and _touches_arc_at(flight, arc, offset_radius, end, tolerance):
                return end
            continue
        t = quartic_root_between(c, start, end)
        now = flight_after(flight, t)
        distance = math.sqrt(now.x * now.x + now.y * now.y)
        rate = (now.x * now.vx + now.y * now.vy) / distance
        wait = _time_to_nearest_on_arc(now, sense, tolerance)
        if wait > 0.0:
            t += wait
        elif sense * rate > 0.0:
            # The polynomial knows the gap through its square only; a step on the distance itself mends the last digits.
            # Where the distance bends within the step there are none to mend: the gap is rounding, the rate next to it.
            step = (distance - offset_radius) / rate
            if abs(step * bending(now)) <= abs(rate):
                t = min(max(t - step, start), end)
        x, y = flight_place_after(flight, t)
        if t > after and is_in_arc_span(arc, x, y, tolerance):
            return t
    return math.inf
