"""What the centre of a ball that slides on a curve crosses without bouncing, and when it passes the zones of parts.

As `detect.sensors` and `detect.parts` for flights. A slide may go on for ever, and crosses a line in each period.
"""

import math

from bounce_env.engine.compile.jit import Record, function, routine, where
from bounce_env.engine.detect.along_curve import Search, curve_search
from bounce_env.engine.detect.sensors import Crossing, follows_crossing
from bounce_env.engine.impact.curve_path import (
    Crossings,
    circle_crossings,
    crossing_point,
    curve_time_after,
    is_next_to_start,
    line_crossings,
)
from bounce_env.engine.impact.line import Line, is_beside_line
from bounce_env.engine.memory.records import CIRCLE_ENTRY, FIELD_BORDER, LINE_SENSOR
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.curve_slide import curve_slide_period


@routine
def next_crossing_along(state: State, w: int, k: int, last: Crossing) -> Crossing:
    """Return the earliest crossing later than `last`, up to the slide's end; as `detect.sensors.next_crossing`."""
    search, best = curve_search(state, w, k), Crossing(math.inf, LINE_SENSOR, -1)
    best = _first_line_along(state, w, k, search, last, best)
    best = _first_entry_along(state, w, k, search, last, best)
    return _first_border_along(state, w, k, search, last, best)


def _no_earlier_along(state: State, w: int, k: int, search: Search, last: Crossing, best: Crossing) -> Crossing:
    return best


@where("sensors", otherwise=_no_earlier_along)
def _first_line_along(state: State, w: int, k: int, search: Search, last: Crossing, best: Crossing) -> Crossing:
    scene, end = state.worlds[w].scene, state.balls[w, k].end_after
    for i in range(state.scenes[scene].sensors):
        sensor, of = state.sensors[scene, i], Crossing(0.0, LINE_SENSOR, i)
        best = _line_along(search, sensor, sensor.length, state.sensor_sides[w, k, i], end, of, last, best)
    return best


@where("field_edges", otherwise=_no_earlier_along)
def _first_border_along(state: State, w: int, k: int, search: Search, last: Crossing, best: Crossing) -> Crossing:
    scene, end = state.worlds[w].scene, state.balls[w, k].end_after
    for i in range(state.scenes[scene].fields):
        of = Crossing(0.0, FIELD_BORDER, i)
        edge, side = state.field_edges[scene, i], state.field_edge_sides[w, k, i]
        best = _line_along(search, edge, math.inf, side, end, of, last, best)
    return best


@function
def _line_along(
    search: Search, row: Record, length: float, side: int, end: float, of: Crossing, last: Crossing, best: Crossing
) -> Crossing:
    """Look for the crossings of a line, a row of a table: from its (x, y) on, `length` [m] or endless."""
    line, x, y = Line(row.ux, row.uy, length, 0.0), row.x - search.slide.x, row.y - search.slide.y
    radius = search.slide.radius
    for facing in (1.0, -1.0):
        nx, ny = -facing * line.uy, facing * line.ux
        height = x * nx + y * ny
        crossings = line_crossings(radius, nx, ny, height, 0.0)
        if not crossings.any:
            continue
        touching = abs(search.x * nx + search.y * ny - height) <= search.tolerance
        for forth in (True, False):
            ex, ey = crossing_point(crossings, forth)
            beside = line.length == math.inf or is_beside_line(line, radius * ex - x, radius * ey - y, search.tolerance)
            if beside:
                best = _earlier_crossing(search, crossings, forth, touching, side * facing > 0.0, end, of, last, best)
    return best


@where("circle_sensors", otherwise=_no_earlier_along)
def _first_entry_along(state: State, w: int, k: int, search: Search, last: Crossing, best: Crossing) -> Crossing:
    scene, end = state.worlds[w].scene, state.balls[w, k].end_after
    for i in range(state.scenes[scene].circle_sensors):
        ring = state.circle_sensors[scene, i]
        x, y = ring.x - search.slide.x, ring.y - search.slide.y
        crossings = circle_crossings(search.slide.radius, x, y, ring.radius, -1.0, 0.0)
        if not crossings.any:
            continue
        dx, dy = search.x - x, search.y - y
        touching = abs(math.sqrt(dx * dx + dy * dy) - ring.radius) <= search.tolerance
        outside = state.circle_sensor_sides[w, k, i] > 0
        for forth in (True, False):
            of = Crossing(0.0, CIRCLE_ENTRY, i)
            best = _earlier_crossing(search, crossings, forth, touching, outside, end, of, last, best)
    return best


@routine
def _earlier_crossing(
    search: Search, crossings: Crossings, forth: bool, touching: bool, before_it: bool, end: float, of: Crossing,
    last: Crossing, best: Crossing,
) -> Crossing:  # fmt: skip
    """Return the earlier of `best` and the next crossing at a point; `of` tells of what (its time is not asked).

    touching: whether the slide begins at it; before_it: and on the side that the crossing leaves.
    """
    nx, ny = crossing_point(crossings, forth)
    passed = False
    if touching and forth == search.start.forth and is_next_to_start(search.start, crossings, forth):
        passed = not before_it
        if before_it:
            nx, ny = search.start.nx, search.start.ny
    slide = search.slide
    # The last crossing may have been at this very instant.
    t = curve_time_after(slide, search.start, nx, ny, forth, passed, last.after - 0.25 * curve_slide_period(slide))
    if not follows_crossing(t, of.kind, of.row, last):
        t = curve_time_after(slide, search.start, nx, ny, forth, passed, last.after)
    return Crossing(t, of.kind, of.row) if t <= end and t < best.after else best


@routine
def strip_change_along(
    search: Search, ux: float, uy: float, x: float, y: float, border: float, inside: bool, after: float
) -> float:
    """Return when a slide next passes the distance `border` from a line along (ux, uy), later than `after` [s].

    The line goes through (x, y) from the slide's centre. inside: whether the ball is nearer to it now.
    """
    best = math.inf
    for facing in (1.0, -1.0):
        nx, ny = (facing * uy, -facing * ux) if inside else (-facing * uy, facing * ux)
        height = x * nx + y * ny + (-border if inside else border)
        crossings = line_crossings(search.slide.radius, nx, ny, height, 0.0)
        if crossings.any:
            gap = search.x * nx + search.y * ny - height
            best = min(best, _time_at_either(search, crossings, gap, after))
    return best


@routine
def circle_change_along(search: Search, x: float, y: float, border: float, inside: bool, after: float) -> float:
    """Return when a slide next passes the circle of radius `border` about (x, y); as `strip_change_along`."""
    crossings = circle_crossings(search.slide.radius, x, y, border, 1.0 if inside else -1.0, 0.0)
    if not crossings.any:
        return math.inf
    dx, dy = search.x - x, search.y - y
    gap = math.sqrt(dx * dx + dy * dy) - border
    return _time_at_either(search, crossings, -gap if inside else gap, after)


@routine
def _time_at_either(search: Search, crossings: Crossings, gap: float, after: float) -> float:
    """Return when a slide next comes to either crossing later than `after` [s]; one that begins there crosses at 0."""
    best = math.inf
    for forth in (True, False):
        nx, ny = crossing_point(crossings, forth)
        begins = (
            abs(gap) <= search.tolerance
            and forth == search.start.forth
            and is_next_to_start(search.start, crossings, forth)
        )
        if begins:
            nx, ny = search.start.nx, search.start.ny
        best = min(best, curve_time_after(search.slide, search.start, nx, ny, forth, False, after))
    return best
