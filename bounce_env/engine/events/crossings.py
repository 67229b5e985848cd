"""Crossings by a ball's centre: sensors report it, drains take the ball out of play, fields change its acceleration."""

import math

from bounce_env.engine.compile.jit import routine, where
from bounce_env.engine.contact.arrival import end_flight
from bounce_env.engine.detect.pairs import plan_pairs
from bounce_env.engine.detect.schedule import schedule_crossing, schedule_resolve
from bounce_env.engine.events.flights import let_go
from bounce_env.engine.memory.ledger import Surface, append_crossing, count_hit
from bounce_env.engine.memory.records import FIELD_BORDER, LINE_SENSOR, OUT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.fields import accelerate
from bounce_env.engine.motion.path import motion_after


@routine
def cross_next(state: State, w: int, k: int) -> None:
    """Process a crossing. The flight goes on as if there were nothing, unless it is a drain or changes the pull."""
    kind = state.balls[w, k].sensor_kind
    if kind == FIELD_BORDER:
        _cross_field_edge(state, w, k)
    elif kind == LINE_SENSOR:
        _cross_line(state, w, k)
    else:
        _enter_circle_sensor(state, w, k)


@where("sensors")
def _cross_line(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    sensor = state.sensors[state.worlds[w].scene, ball.sensor_index]
    state.sensor_sides[w, k, ball.sensor_index] = -state.sensor_sides[w, k, ball.sensor_index]
    _, _, vx, vy = motion_after(state, w, k, ball.sensor_after)
    facing = 1.0 if vy * sensor.ux - vx * sensor.uy < 0.0 else -1.0
    surface = Surface(sensor.element, -facing * sensor.uy, facing * sensor.ux, 0.0, 0.0)
    _report_crossing(state, w, k, sensor.drain, surface)


@where("circle_sensors")
def _enter_circle_sensor(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    ring = state.circle_sensors[state.worlds[w].scene, ball.sensor_index]
    state.circle_sensor_sides[w, k, ball.sensor_index] = -1
    x, y, _, _ = motion_after(state, w, k, ball.sensor_after)
    dx, dy = x - ring.x, y - ring.y
    distance = math.sqrt(dx * dx + dy * dy)
    _report_crossing(state, w, k, ring.drain, Surface(ring.element, dx / distance, dy / distance, 0.0, 0.0))


@routine
def _report_crossing(state: State, w: int, k: int, drain: int, surface: Surface) -> None:
    """Count and log a crossing, the surface's normal towards where the ball came from, and plan what follows it."""
    ball = state.balls[w, k]
    count_hit(state, w, surface.element)
    x, y, vx, vy = motion_after(state, w, k, ball.sensor_after)
    append_crossing(state, w, k, surface, x, y, vx, vy)
    if drain:
        ball.x, ball.y, ball.vx, ball.vy, ball.hi, ball.lo = x, y, vx, vy, ball.next_hi, ball.next_lo
        ball.status = OUT
        ball.next_hi, ball.next_lo = math.inf, 0.0
        let_go(state, w, k)
        plan_pairs(state, w, k)
    else:
        schedule_crossing(state, w, k, ball.sensor_after, ball.sensor_kind, ball.sensor_index)


@where("field_edges")
def _cross_field_edge(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    after, index = ball.sensor_after, ball.sensor_index
    state.field_edge_sides[w, k, index] = -state.field_edge_sides[w, k, index]
    gx, gy = ball.gx, ball.gy
    accelerate(state, w, k)
    if ball.gx == gx and ball.gy == gy:
        schedule_crossing(state, w, k, after, FIELD_BORDER, index)
        return
    new_gx, new_gy = ball.gx, ball.gy
    end_flight(state, w, k, after, ball.next_hi, ball.next_lo)
    ball.gx, ball.gy = new_gx, new_gy
    schedule_resolve(ball)
