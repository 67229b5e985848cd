"""Crossings by a ball's centre: sensors report it, drains take the ball out of play, fields change its acceleration."""

import math

from bounce_env.engine.arrive import end_flight
from bounce_env.engine.ends import is_dragged, line_at
from bounce_env.engine.flight import fly, moved, sped
from bounce_env.engine.instant import since
from bounce_env.engine.jit import Record, Table, function, routine
from bounce_env.engine.layout import CROSSING, FIELD_EDGE, LINE, OUT, State, Tables
from bounce_env.engine.pairs import plan_pairs
from bounce_env.engine.resolve import count_hit
from bounce_env.engine.search import plan_crossing, pull, resolve_next
from bounce_env.engine.tolerances import PRESSING, ULPS_OF_SPEED


@routine
def cross(state: State, tables: Tables, w: int, k: int, ledger: Table) -> None:
    """Process a crossing. The flight goes on as if there were nothing, unless it is a drain or changes the pull."""
    ball = state.balls[w, k]
    if ball.sensor_kind == FIELD_EDGE:
        _cross_edge(state, tables, w, k)
    elif ball.sensor_kind == LINE:
        _cross_line(state, tables, w, k, tables.sensors, state.sensor_sides, ledger)
    else:
        _enter_ring(state, tables, w, k, tables.rings, state.ring_sides, ledger)


@function
def _cross_line(state: State, tables: Tables, w: int, k: int, sensors: Table, sides: Table, ledger: Table) -> None:
    if sensors is None:
        return
    ball = state.balls[w, k]
    sensor = sensors[state.worlds[w].scene, ball.sensor_index]
    sides[w, k, ball.sensor_index] = -sides[w, k, ball.sensor_index]
    gx, gy = pull(tables.gravity, ball)
    vx, vy = sped(ball.vx, gx, ball.sensor_after), sped(ball.vy, gy, ball.sensor_after)
    facing = 1.0 if vy * sensor.ux - vx * sensor.uy < 0.0 else -1.0
    _report(state, tables, w, k, sensor.element, sensor.drain, -facing * sensor.uy, facing * sensor.ux, ledger)


@function
def _enter_ring(state: State, tables: Tables, w: int, k: int, rings: Table, sides: Table, ledger: Table) -> None:
    if rings is None:
        return
    ball = state.balls[w, k]
    ring = rings[state.worlds[w].scene, ball.sensor_index]
    sides[w, k, ball.sensor_index] = -1
    gx, gy = pull(tables.gravity, ball)
    dx = moved(ball.x, ball.vx, gx, ball.sensor_after) - ring.x
    dy = moved(ball.y, ball.vy, gy, ball.sensor_after) - ring.y
    distance = math.sqrt(dx * dx + dy * dy)
    _report(state, tables, w, k, ring.element, ring.drain, dx / distance, dy / distance, ledger)


@routine
def _report(
    state: State, tables: Tables, w: int, k: int, element: int, drain: int, nx: float, ny: float, ledger: Table
) -> None:
    """Count and log a crossing at which (nx, ny) points back to where the ball came from, and plan what follows it."""
    ball = state.balls[w, k]
    gx, gy = pull(tables.gravity, ball)
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
        plan_pairs(state, tables, state.pairs, w, k)
    else:
        plan_crossing(state, tables, w, k, after, ball.sensor_kind, ball.sensor_index)


@function
def _cross_edge(state: State, tables: Tables, w: int, k: int) -> None:
    ball = state.balls[w, k]
    after, index = ball.sensor_after, ball.sensor_index
    _flip(state.edge_sides, w, k, index)
    gx, gy = ball.gx, ball.gy
    accelerate(state, tables, w, k)
    if ball.gx == gx and ball.gy == gy:
        plan_crossing(state, tables, w, k, after, FIELD_EDGE, index)
        return
    new_gx, new_gy = ball.gx, ball.gy
    ax, ay = pull(tables.gravity, ball)
    end_flight(ball, tables, state.worlds[w].scene, ax, ay, after, ball.next_hi, ball.next_lo)
    ball.gx, ball.gy = new_gx, new_gy
    resolve_next(ball)


@function
def _flip(sides: Table, w: int, k: int, index: int) -> None:
    if sides is not None:
        sides[w, k, index] = -sides[w, k, index]


@function
def accelerate(state: State, tables: Tables, w: int, k: int) -> None:
    """Set a ball's acceleration from gravity and the fields that it is in; a flight that has begun is not changed."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    ball.gx, ball.gy = _gravity(tables.gravity, scene)
    _add_fields(ball, tables.edges, state.edge_sides, tables.scenes[scene].fields, w, k, scene)


@function
def _gravity(gravity: Table, scene: int) -> tuple[float, float]:
    if gravity is None:
        return 0.0, 0.0
    return gravity[scene, 0], gravity[scene, 1]


@function
def _add_fields(ball: Record, edges: Table, sides: Table, count: int, w: int, k: int, scene: int) -> None:
    if edges is None or sides is None:
        return
    inside = True
    for i in range(count):
        edge = edges[scene, i]
        inside = inside and sides[w, k, i] > 0
        if edge.last:
            if inside:
                ball.gx += edge.ax
                ball.gy += edge.ay
            inside = True


@function
def take_sides(state: State, tables: Tables, w: int, k: int) -> None:
    """The ball's sides at its start: on a line itself the one it moves to, at rest the one gravity presses it from."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = tables.scenes[scene]
    gx, gy = _gravity(tables.gravity, scene)
    _side_with_lines(ball, tables.faces, head.faces, state.face_sides, w, k, scene, gx, gy)
    _side_with_lines(ball, tables.sensors, head.sensors, state.sensor_sides, w, k, scene, gx, gy)
    _side_with_lines(ball, tables.edges, head.fields, state.edge_sides, w, k, scene, gx, gy)
    _side_with_arcs(ball, tables.arcs, head.arcs, state.arc_sides, w, k, scene, gx, gy)
    _side_with_parts(ball, tables.parts, head.parts, state.motions, state.ends, state.part_sides, w, k, scene, gx, gy)
    _side_with_rings(ball, tables.rings, head.rings, state.ring_sides, w, k, scene, gx, gy)


@function
def _side_with_lines(
    ball: Record, lines: Table, count: int, sides: Table, w: int, k: int, scene: int, gx: float, gy: float
) -> None:
    if lines is None or sides is None:
        return
    for i in range(count):
        line = lines[scene, i]
        nx, ny = -line.uy, line.ux
        lean = (ball.x - line.x) * nx + (ball.y - line.y) * ny
        if abs(lean) <= ball.slack:
            lean = _lean(ball, nx, ny, gx, gy)
        sides[w, k, i] = 1 if lean >= 0.0 else -1


@function
def _side_with_parts(
    ball: Record, parts: Table, count: int, motions: Table, all_ends: Table, sides: Table, w: int, k: int, scene: int,
    gx: float, gy: float,
) -> None:  # fmt: skip
    if parts is None or motions is None or all_ends is None or sides is None:
        return
    for m in range(count):
        motion, ends = motions[w, m], all_ends[w, m]
        sides[w, k, m] = 0
        if is_dragged(ends, parts[scene, m]):
            x, y, ux, uy, _ = line_at(ends, since(ball.hi, ball.lo, motion.hi, motion.lo))
            lean = (ball.y - y) * ux - (ball.x - x) * uy
            if abs(lean) <= ball.slack:
                lean = _lean(ball, -uy, ux, gx, gy)
            sides[w, k, m] = 1 if lean >= 0.0 else -1


@function
def _side_with_arcs(
    ball: Record, arcs: Table, count: int, sides: Table, w: int, k: int, scene: int, gx: float, gy: float
) -> None:
    if arcs is None or sides is None:
        return
    for i in range(count):
        arc = arcs[scene, i]
        sides[w, k, i] = _side_of_circle(ball, arc.x, arc.y, arc.outer, gx, gy)


@function
def _side_with_rings(
    ball: Record, rings: Table, count: int, sides: Table, w: int, k: int, scene: int, gx: float, gy: float
) -> None:
    if rings is None or sides is None:
        return
    for i in range(count):
        ring = rings[scene, i]
        sides[w, k, i] = _side_of_circle(ball, ring.x, ring.y, ring.radius, gx, gy)


@function
def _side_of_circle(ball: Record, x: float, y: float, radius: float, gx: float, gy: float) -> int:
    dx, dy = ball.x - x, ball.y - y
    distance = math.sqrt(dx * dx + dy * dy)
    lean = distance - radius
    if abs(lean) <= ball.slack:
        lean = _lean(ball, dx / distance, dy / distance, gx, gy)
    return 1 if lean >= 0.0 else -1


@function
def _lean(ball: Record, nx: float, ny: float, gx: float, gy: float) -> float:
    """To which side of a line that it is on the ball moves, or else is pulled from; 0 where it does neither.

    Less than rounding is nothing: a ball sent along a turned wall is on the left of it, as along any other.
    """
    lean = ball.vx * nx + ball.vy * ny
    if abs(lean) > ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy)):
        return lean
    press = -(gx * nx + gy * ny)
    return press if abs(press) > PRESSING * (abs(gx) + abs(gy)) else 0.0
