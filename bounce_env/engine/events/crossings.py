"""Crossings by a ball's centre: sensors report it, drains take the ball out of play, fields change its acceleration."""

import math

from bounce_env.engine.compile.jit import Table, function, routine
from bounce_env.engine.contact.arrival import end_flight
from bounce_env.engine.detect.pairs import plan_pairs
from bounce_env.engine.detect.schedule import plan_crossing, resolve_next
from bounce_env.engine.memory.ledger import count_hit
from bounce_env.engine.memory.lookup import pull
from bounce_env.engine.memory.records import CROSSING, FIELD_EDGE, LINE, OUT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.fields import accelerate
from bounce_env.engine.motion.flight import fly, moved, sped


@routine
def cross(state: State, w: int, k: int, ledger: Table) -> None:
    """Process a crossing. The flight goes on as if there were nothing, unless it is a drain or changes the pull."""
    ball = state.balls[w, k]
    if ball.sensor_kind == FIELD_EDGE:
        _cross_edge(state, w, k)
    elif ball.sensor_kind == LINE:
        _cross_line(state, w, k, state.sensors, state.sensor_sides, ledger)
    else:
        _enter_ring(state, w, k, state.rings, state.ring_sides, ledger)


@function
def _cross_line(state: State, w: int, k: int, sensors: Table, sides: Table, ledger: Table) -> None:
    if sensors is None:
        return
    ball = state.balls[w, k]
    sensor = sensors[state.worlds[w].scene, ball.sensor_index]
    sides[w, k, ball.sensor_index] = -sides[w, k, ball.sensor_index]
    gx, gy = pull(state.gravity, ball)
    vx, vy = sped(ball.vx, gx, ball.sensor_after), sped(ball.vy, gy, ball.sensor_after)
    facing = 1.0 if vy * sensor.ux - vx * sensor.uy < 0.0 else -1.0
    _report(state, w, k, sensor.element, sensor.drain, -facing * sensor.uy, facing * sensor.ux, ledger)


@function
def _enter_ring(state: State, w: int, k: int, rings: Table, sides: Table, ledger: Table) -> None:
    if rings is None:
        return
    ball = state.balls[w, k]
    ring = rings[state.worlds[w].scene, ball.sensor_index]
    sides[w, k, ball.sensor_index] = -1
    gx, gy = pull(state.gravity, ball)
    dx = moved(ball.x, ball.vx, gx, ball.sensor_after) - ring.x
    dy = moved(ball.y, ball.vy, gy, ball.sensor_after) - ring.y
    distance = math.sqrt(dx * dx + dy * dy)
    _report(state, w, k, ring.element, ring.drain, dx / distance, dy / distance, ledger)


@routine
def _report(state: State, w: int, k: int, element: int, drain: int, nx: float, ny: float, ledger: Table) -> None:
    """Count and log a crossing at which (nx, ny) points back to where the ball came from, and plan what follows it."""
    ball = state.balls[w, k]
    gx, gy = pull(state.gravity, ball)
    after = ball.sensor_after
    count_hit(state, w, element)
    if ledger is not None:
        world = state.worlds[w]
        vx, vy = sped(ball.vx, gx, after), sped(ball.vy, gy, after)
        row = ledger[world.rows]
        row.time, row.ball, row.element, row.kind = ball.next_hi, k, element, CROSSING
        row.x, row.y = moved(ball.x, ball.vx, gx, after), moved(ball.y, ball.vy, gy, after)
        row.nx, row.ny, row.ux, row.uy = nx, ny, 0.0, 0.0
        row.vx0, row.vy0, row.vx1, row.vy1 = vx, vy, vx, vy
        world.rows += 1
    if drain:
        fly(ball, gx, gy, after, ball.next_hi, ball.next_lo)
        ball.status = OUT
        ball.next_hi, ball.next_lo = math.inf, 0.0
        plan_pairs(state, state.pairs, w, k)
    else:
        plan_crossing(state, w, k, after, ball.sensor_kind, ball.sensor_index)


@function
def _cross_edge(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    after, index = ball.sensor_after, ball.sensor_index
    _flip(state.edge_sides, w, k, index)
    gx, gy = ball.gx, ball.gy
    accelerate(state, w, k)
    if ball.gx == gx and ball.gy == gy:
        plan_crossing(state, w, k, after, FIELD_EDGE, index)
        return
    new_gx, new_gy = ball.gx, ball.gy
    ax, ay = pull(state.gravity, ball)
    end_flight(ball, state, state.worlds[w].scene, ax, ay, after, ball.next_hi, ball.next_lo)
    ball.gx, ball.gy = new_gx, new_gy
    resolve_next(ball)


@function
def _flip(sides: Table, w: int, k: int, index: int) -> None:
    if sides is not None:
        sides[w, k, index] = -sides[w, k, index]
