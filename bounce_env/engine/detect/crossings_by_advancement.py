"""What the centre of a ball crosses without bouncing on a path that is no flight, and lies on what moves.

As `detect.sensors` for flights, by bounded-acceleration advancement.
"""

import math

from bounce_env.engine.compile.jit import Record, function, routine, where
from bounce_env.engine.detect.by_advancement import least_step, line_ahead, moving_after, outside_ahead
from bounce_env.engine.detect.sensors import Crossing, follows_crossing
from bounce_env.engine.impact.line import Line
from bounce_env.engine.memory.records import CIRCLE_ENTRY, FIELD_BORDER, LINE_SENSOR
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import SEARCH_STEPS, ULP


@routine
def next_crossing_by_advancement(state: State, w: int, k: int, last: Crossing) -> Crossing:
    """Return the earliest crossing later than `last`, up to the end of the search for what ends the slide."""
    best = Crossing(math.inf, LINE_SENSOR, -1)
    best = _first_line(state, w, k, last, best)
    best = _first_entry(state, w, k, last, best)
    return _first_border(state, w, k, last, best)


def _no_earlier(state: State, w: int, k: int, last: Crossing, best: Crossing) -> Crossing:
    return best


@where("sensors", otherwise=_no_earlier)
def _first_line(state: State, w: int, k: int, last: Crossing, best: Crossing) -> Crossing:
    scene = state.worlds[w].scene
    for i in range(state.scenes[scene].sensors):
        sensor, side = state.sensors[scene, i], state.sensor_sides[w, k, i]
        best = _earlier_line(state, w, k, sensor, sensor.length, side, LINE_SENSOR, i, last, best)
    return best


@where("field_edges", otherwise=_no_earlier)
def _first_border(state: State, w: int, k: int, last: Crossing, best: Crossing) -> Crossing:
    scene = state.worlds[w].scene
    for i in range(state.scenes[scene].fields):
        edge, side = state.field_edges[scene, i], state.field_edge_sides[w, k, i]
        best = _earlier_line(state, w, k, edge, math.inf, side, FIELD_BORDER, i, last, best)
    return best


@where("circle_sensors", otherwise=_no_earlier)
def _first_entry(state: State, w: int, k: int, last: Crossing, best: Crossing) -> Crossing:
    scene = state.worlds[w].scene
    for i in range(state.scenes[scene].circle_sensors):
        ring, side = state.circle_sensors[scene, i], state.circle_sensor_sides[w, k, i]
        t = _circle_entry(state, w, k, ring, side > 0, _begin(last, CIRCLE_ENTRY, i))
        best = _earlier(t, CIRCLE_ENTRY, i, last, best)
    return best


@function
def _begin(last: Crossing, kind: int, row: int) -> float:
    """Return from when on [s] a crossing is searched: a tie with the last one counts where it comes after that."""
    tie = follows_crossing(last.after, kind, row, last)
    return max(last.after - abs(last.after) * ULP if tie else last.after, 0.0)


@function
def _earlier(t: float, kind: int, row: int, last: Crossing, best: Crossing) -> Crossing:
    return Crossing(t, kind, row) if t < best.after and follows_crossing(t, kind, row, last) else best


@function
def _earlier_line(
    state: State, w: int, k: int, row: Record, length: float, side: int, kind: int, i: int, last: Crossing,
    best: Crossing,
) -> Crossing:  # fmt: skip
    """Return the earlier of `best` and the next crossing of a line, row `i` of the table of a kind."""
    line = Line(row.ux, row.uy, length, 0.0)
    return _earlier(_line_crossing(state, w, k, line, row.x, row.y, side, _begin(last, kind, i)), kind, i, last, best)


@routine
def _line_crossing(state: State, w: int, k: int, line: Line, x: float, y: float, side: int, begin: float) -> float:
    """Return when a ball next crosses a line that begins at (x, y), from `begin` [s] on; inf if it does not."""
    end, t = state.balls[w, k].end_after, begin
    for _ in range(16 * SEARCH_STEPS):
        seconds, crosses, _ = line_ahead(moving_after(state, w, k, t), line, x, y, side)
        t += seconds
        if not t <= end:
            return math.inf
        if crosses:
            return t
    return math.inf


@routine
def _circle_entry(state: State, w: int, k: int, ring: Record, outside: bool, begin: float) -> float:
    """Return when a ball next enters a circle, a row of a table, from `begin` [s] on; inf if it does not."""
    end, t = state.balls[w, k].end_after, begin
    for _ in range(16 * SEARCH_STEPS):
        ball = moving_after(state, w, k, t)
        dx, dy = ball.x - ring.x, ball.y - ring.y
        gap = math.sqrt(dx * dx + dy * dy) - ring.radius
        if abs(gap) > ball.tolerance:
            outside = gap > 0.0
        if outside:
            seconds, enters = outside_ahead(ball, dx, dy, ring.radius, True)
        else:
            seconds, enters = max(-gap / ball.top_speed, least_step(ball)), False
        t += seconds
        if not t <= end:
            return math.inf
        if enters:
            return t
    return math.inf
