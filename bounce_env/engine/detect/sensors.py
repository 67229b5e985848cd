"""What a ball's centre crosses next without bouncing: sensors of both shapes and the borders of fields."""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.impact.arc import arc_entry_time
from bounce_env.engine.impact.line import Line, facing_time, line_time
from bounce_env.engine.impact.swept_box import box_of, circle_box, misses_box, sweep_of
from bounce_env.engine.memory.records import CIRCLE_ENTRY, FIELD_BORDER, LINE_SENSOR
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import Flight, flight_seen_from
from bounce_env.engine.tolerances import ULP


class Crossing(NamedTuple):
    """A crossing: duration [s] from the flight's start, kind of what is crossed, its row in that kind's table."""

    after: float
    kind: int
    row: int


@function
def next_crossing(state: State, w: int, k: int, flight: Flight, last: Crossing) -> Crossing:
    """Return the earliest crossing later than `last`, up to the flight's end; inf if there is none.

    Crossings at one instant come in the order of kinds (lines, circles, borders of fields), and in that of elements.
    """
    best = Crossing(math.inf, LINE_SENSOR, -1)
    best = _first_line_crossing(state, w, k, flight, last, best)
    best = _first_circle_entry(state, w, k, flight, last, best)
    return _first_field_border(state, w, k, flight, last, best)


@function
def follows_crossing(t: float, kind: int, index: int, last: Crossing) -> bool:
    """Return whether a crossing at `t` comes after `last` in the order of crossings."""
    return t > last.after or (t == last.after and (kind > last.kind or (kind == last.kind and index > last.row)))


def _no_earlier_crossing(state: State, w: int, k: int, flight: Flight, last: Crossing, best: Crossing) -> Crossing:
    return best


@where("sensors", otherwise=_no_earlier_crossing)
def _first_line_crossing(state: State, w: int, k: int, flight: Flight, last: Crossing, best: Crossing) -> Crossing:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    sweep = sweep_of(flight, state.scenes[scene].extent, ball.end_after)
    for i in range(state.scenes[scene].sensors):
        sensor, side = state.sensors[scene, i], state.sensor_sides[w, k, i]
        if misses_box(flight, sweep, box_of(sensor)):
            continue
        seen, line = flight_seen_from(flight, sensor.x, sensor.y), Line(sensor.ux, sensor.uy, sensor.length, 0.0)
        for facing in (1.0, -1.0):
            t = facing_time(seen, line, facing, side, ball.tolerance, ball.end_after)
            if t < best.after and follows_crossing(t, LINE_SENSOR, i, last):
                best = Crossing(t, LINE_SENSOR, i)
    return best


@where("circle_sensors", otherwise=_no_earlier_crossing)
def _first_circle_entry(state: State, w: int, k: int, flight: Flight, last: Crossing, best: Crossing) -> Crossing:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    sweep = sweep_of(flight, state.scenes[scene].extent, ball.end_after)
    for i in range(state.scenes[scene].circle_sensors):
        ring, outside = state.circle_sensors[scene, i], state.circle_sensor_sides[w, k, i] > 0
        if misses_box(flight, sweep, circle_box(ring.x, ring.y, ring.radius)):
            continue
        # A ball may enter a circle twice in one flight: what came before is no answer.
        tie = follows_crossing(last.after, CIRCLE_ENTRY, i, last)
        after = last.after - abs(last.after) * ULP if tie else last.after
        t = arc_entry_time(
            flight_seen_from(flight, ring.x, ring.y), ring.radius, outside, ball.tolerance, after, ball.end_after
        )
        if t < best.after and follows_crossing(t, CIRCLE_ENTRY, i, last):
            best = Crossing(t, CIRCLE_ENTRY, i)
    return best


@where("field_edges", otherwise=_no_earlier_crossing)
def _first_field_border(state: State, w: int, k: int, flight: Flight, last: Crossing, best: Crossing) -> Crossing:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for i in range(state.scenes[scene].fields):
        edge, side = state.field_edges[scene, i], state.field_edge_sides[w, k, i]
        seen, line = flight_seen_from(flight, edge.x, edge.y), Line(edge.ux, edge.uy, math.inf, 0.0)
        for facing in (1.0, -1.0):
            t = line_time(seen, line, facing, side, ball.tolerance)
            if t <= ball.end_after and t < best.after and follows_crossing(t, FIELD_BORDER, i, last):
                best = Crossing(t, FIELD_BORDER, i)
    return best
