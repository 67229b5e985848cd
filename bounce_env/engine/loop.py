"""The event loop of one world: the earliest event of its balls and parts, one after the other, up to an instant.

A step in which nothing happens costs one comparison per ball and part. At one instant balls come before parts, and each
in its order.
"""

import math

from bounce_env.engine.flight import moved, pull, sped, touch_tolerance
from bounce_env.engine.instant import before, since
from bounce_env.engine.jit import Feature, Record, Table, function
from bounce_env.engine.layout import (
    BUDGET,
    CROSSING,
    NEXT_HIT,
    NEXT_SENSOR,
    NEXT_ZONE,
    OK,
    OUT,
    PART_STOPS,
    State,
    Tables,
)
from bounce_env.engine.resolve import arrive, bounce_from_all, count_hit, face_sensors, snap
from bounce_env.engine.search import (
    plan_flight,
    plan_parts,
    plan_sensor,
    plan_zones,
    rail_offset,
    stop_instant,
)
from bounce_env.engine.tolerances import BOUNCES_AT_ONE_INSTANT, UNSURE

# How a run of the loop ends.
DONE, OUT_OF_BUDGET, LEDGER_FULL = 0, 1, 2


@function
def run(state: State, tables: Tables, w: int, until_hi: float, until_lo: float, max_events: int, ledger: Table) -> int:
    """Process the events of world `w` up to and including an instant; DONE, OUT_OF_BUDGET or LEDGER_FULL.

    Unless DONE, the world's time is that of its last event, and the next call goes on from there.
    """
    world = state.worlds[w]
    events = 0
    while True:
        hi, lo, ball, paddle = _next(state, tables, w, until_hi, until_lo)
        if ball < 0 and paddle < 0:
            world.time_hi, world.time_lo = until_hi, until_lo
            return DONE
        if events >= max_events:
            _stop_for_budget(state, w)
            return OUT_OF_BUDGET
        if ledger is not None and world.rows + BOUNCES_AT_ONE_INSTANT > len(ledger):
            return LEDGER_FULL
        world.time_hi, world.time_lo = hi, lo
        if ball >= 0:
            events += _ball_event(state, tables, w, ball, ledger)
        else:
            _part_stops(state, tables, w, paddle, ledger)
            events += 1


@function
def _next(state: State, tables: Tables, w: int, until_hi: float, until_lo: float) -> tuple[float, float, int, int]:
    hi, lo, ball, paddle = math.inf, 0.0, -1, -1
    for k in range(state.balls.shape[1]):
        b = state.balls[w, k]
        if not before(until_hi, until_lo, b.next_hi, b.next_lo) and before(b.next_hi, b.next_lo, hi, lo):
            hi, lo, ball = b.next_hi, b.next_lo, k
    scene = state.worlds[w].scene
    m, stop_hi, stop_lo = _first_stop(state.paddles, tables.rails, w, scene, until_hi, until_lo)
    if before(stop_hi, stop_lo, hi, lo):
        return stop_hi, stop_lo, -1, m
    return hi, lo, ball, paddle


@function
def _first_stop(
    paddles: Table, rails: Table, w: int, scene: int, until_hi: float, until_lo: float
) -> tuple[int, float, float]:
    hi, lo, first = math.inf, 0.0, -1
    if paddles is None or rails is None:
        return first, hi, lo
    for m in range(paddles.shape[1]):
        paddle, rail = paddles[w, m], rails[scene, m]
        if _moves_until(paddle, rail, until_hi, until_lo):
            continue
        stop_hi, stop_lo = stop_instant(paddle, rail)
        if not before(until_hi, until_lo, stop_hi, stop_lo) and before(stop_hi, stop_lo, hi, lo):
            hi, lo, first = stop_hi, stop_lo, m
    return first, hi, lo


@function
def _moves_until(paddle: Record, rail: Record, hi: float, lo: float) -> bool:
    """Whether the paddle surely comes to no stop up to an instant: most are told so without a division.

    The margin covers the rounding of the two ways; within it the stop's instant decides. Asked of both stops alike,
    since which one lies ahead is a coin's toss to the processor.
    """
    margin = UNSURE * rail.span
    return paddle.velocity == 0.0 or margin < rail_offset(paddle, hi, lo) < rail.span - margin


@function
def _stop_for_budget(state: State, w: int) -> None:
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == OK:
            state.balls[w, k].status = BUDGET


@function
def _ball_event(state: State, tables: Tables, w: int, k: int, ledger: Table) -> int:
    """Process the ball's next event; returns how many events it counts for in the budget."""
    ball = state.balls[w, k]
    if ball.next_kind == NEXT_ZONE:
        scene = state.worlds[w].scene
        gx, gy = pull(tables.gravity, scene)
        count = tables.scenes[scene].paddles
        plan_zones(ball, state.zones, tables.rails, count, w, k, scene, gx, gy, ball.zone_after)
        plan_parts(state, tables, w, k)
        return 0
    if ball.next_kind == NEXT_SENSOR:
        _cross(state, tables, w, k, tables.sensors, state.sensor_sides, ledger)
        return 1
    _hit(state, tables, w, k, ledger)
    return 1


@function
def _fly(ball: Record, gx: Feature, gy: Feature, t: float, hi: float, lo: float) -> None:
    """Move the ball along its flight by `t` seconds and let that be where, at (hi, lo), a new one starts."""
    ball.x, ball.y = moved(ball.x, ball.vx, gx, t), moved(ball.y, ball.vy, gy, t)
    ball.vx, ball.vy = sped(ball.vx, gx, t), sped(ball.vy, gy, t)
    ball.hi, ball.lo = hi, lo


@function
def _hit(state: State, tables: Tables, w: int, k: int, ledger: Table) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = tables.scenes[scene]
    gx, gy = pull(tables.gravity, scene)
    # A kept hit is a duration from the flight's start, so that its own rounding is all there is.
    t = ball.hit_after if ball.next_kind == NEXT_HIT else since(ball.part_hi, ball.part_lo, ball.hi, ball.lo)
    x0, y0 = ball.x, ball.y
    ball.slack = touch_tolerance(head.extent, ball.vx, ball.vy, gx, gy, t)
    _fly(ball, gx, gy, t, ball.next_hi, ball.next_lo)
    travelled = abs(ball.x - x0) + abs(ball.y - y0)
    snap(ball, tables, state.paddles, w, scene)
    arrive(ball, tables.faces, head.faces, state.face_sides, w, k, scene, travelled)
    bounce_from_all(state, tables, w, k, ledger)
    face_sensors(ball, tables.sensors, head.sensors, state.sensor_sides, w, k, scene)
    plan_flight(state, tables, w, k)


@function
def _cross(state: State, tables: Tables, w: int, k: int, sensors: Table, sides: Table, ledger: Table) -> None:
    """Report a crossing. The flight goes on as if there were no sensor, unless it is a drain."""
    if sensors is None:
        return
    ball, world = state.balls[w, k], state.worlds[w]
    gx, gy = pull(tables.gravity, world.scene)
    index, after = ball.sensor_index, ball.sensor_after
    sensor = sensors[world.scene, index]
    sides[w, k, index] = -sides[w, k, index]
    count_hit(state, w, sensor.element)
    if ledger is not None:
        _log_crossing(ledger, world, ball, k, sensor, gx, gy, after)
    if sensor.drain:
        _fly(ball, gx, gy, after, ball.next_hi, ball.next_lo)
        ball.status = OUT
        ball.next_hi, ball.next_lo = math.inf, 0.0
    else:
        plan_sensor(state, tables, w, k, after, index)


@function
def _log_crossing(
    ledger: Table, world: Record, ball: Record, k: int, sensor: Record, gx: Feature, gy: Feature, after: float
) -> None:
    x, y = moved(ball.x, ball.vx, gx, after), moved(ball.y, ball.vy, gy, after)
    vx, vy = sped(ball.vx, gx, after), sped(ball.vy, gy, after)
    facing = 1.0 if vy * sensor.ux - vx * sensor.uy < 0.0 else -1.0
    row = ledger[world.rows]
    row.time, row.ball, row.element, row.kind = ball.next_hi, k, sensor.element, CROSSING
    row.x, row.y, row.nx, row.ny = x, y, -facing * sensor.uy, facing * sensor.ux
    row.vx0, row.vy0, row.vx1, row.vy1 = vx, vy, vx, vy
    row.ux, row.uy = 0.0, 0.0
    world.rows += 1


@function
def _part_stops(state: State, tables: Tables, w: int, m: int, ledger: Table) -> None:
    _paddle_stops(state.paddles, tables.rails, state.worlds[w], w, m, ledger)
    replan_paddle(state, tables, state.zones, w, m)


@function
def _paddle_stops(paddles: Table, rails: Table, world: Record, w: int, m: int, ledger: Table) -> None:
    if paddles is None or rails is None:
        return
    paddle, rail = paddles[w, m], rails[world.scene, m]
    velocity = paddle.velocity
    paddle.hi, paddle.lo = stop_instant(paddle, rail)
    paddle.offset = rail.span if velocity > 0.0 else 0.0
    paddle.velocity = 0.0
    if ledger is not None:
        row = ledger[world.rows]
        row.time, row.ball, row.element, row.kind = paddle.hi, -1, rail.element, PART_STOPS
        row.x, row.y = rail.x + paddle.offset * rail.ux, rail.y + paddle.offset * rail.uy
        row.nx, row.ny = 0.0, 0.0
        row.vx0, row.vy0, row.vx1, row.vy1 = velocity * rail.ux, velocity * rail.uy, 0.0, 0.0
        row.ux, row.uy = 0.0, 0.0
        world.rows += 1


@function
def replan_paddle(state: State, tables: Tables, zones: Table, w: int, m: int) -> None:
    """Search anew for every ball that paddle `m` can reach: it has changed its speed."""
    if zones is None:
        return
    for k in range(state.balls.shape[1]):
        if zones[w, k, m].inside and state.balls[w, k].status != OUT:
            plan_parts(state, tables, w, k)


@function
def command(state: State, tables: Tables, paddles: Table, rails: Table, w: int, m: int, velocity: float) -> None:
    """Let paddle `m` of world `w` move at `velocity` [m/s] from now on. The command it already has changes no bit."""
    if paddles is None or rails is None:
        return
    paddle, world = paddles[w, m], state.worlds[w]
    if velocity == paddle.command:
        return
    set_off(paddle, rails[world.scene, m], world, velocity)
    replan_paddle(state, tables, state.zones, w, m)


@function
def command_unwatched(
    world: Record, paddles: Table, rails: Table, zones: Table, w: int, m: int, velocity: float
) -> bool:
    """As `command`, where no ball is in the paddle's zone; otherwise it does nothing and returns False."""
    if paddles is None or rails is None or zones is None:
        return True
    paddle = paddles[w, m]
    if velocity == paddle.command:
        return True
    for k in range(zones.shape[1]):
        if zones[w, k, m].inside:
            return False
    set_off(paddle, rails[world.scene, m], world, velocity)
    return True


@function
def is_calm(balls: Table, paddles: Table, rails: Table, w: int, scene: int, until_hi: float, until_lo: float) -> bool:
    """Whether surely nothing happens in world `w` up to and including an instant."""
    for k in range(balls.shape[1]):
        if not before(until_hi, until_lo, balls[w, k].next_hi, balls[w, k].next_lo):
            return False
    if paddles is not None and rails is not None:
        for m in range(paddles.shape[1]):
            if not _moves_until(paddles[w, m], rails[scene, m], until_hi, until_lo):
                return False
    return True


@function
def set_off(paddle: Record, rail: Record, world: Record, velocity: float) -> None:
    """Start a commanded motion from the paddle's place: against a stop it stands."""
    paddle.offset = min(max(rail_offset(paddle, world.time_hi, world.time_lo), 0.0), rail.span)
    paddle.hi, paddle.lo = world.time_hi, world.time_lo
    paddle.command = velocity
    # Written without asking for the sign of the velocity, which the processor could only guess.
    if paddle.offset == 0.0:
        velocity = max(velocity, 0.0)
    if paddle.offset == rail.span:
        velocity = min(velocity, 0.0)
    paddle.velocity = velocity


@function
def place(state: State, tables: Tables, w: int, k: int, x: float, y: float, vx: float, vy: float) -> None:
    """Put ball `k` into flight at (x, y) [m] with velocity (vx, vy) [m/s] at the world's present time."""
    ball, world = state.balls[w, k], state.worlds[w]
    head = tables.scenes[world.scene]
    gx, gy = pull(tables.gravity, world.scene)
    ball.x, ball.y, ball.vx, ball.vy = x, y, vx, vy
    ball.hi, ball.lo = world.time_hi, world.time_lo
    ball.status = OK
    ball.slack = touch_tolerance(head.extent, 0.0, 0.0, gx, gy, 0.0)
    _take_sides(ball, tables.faces, head.faces, state.face_sides, w, k, world.scene, gx, gy)
    _take_sides(ball, tables.sensors, head.sensors, state.sensor_sides, w, k, world.scene, gx, gy)
    plan_flight(state, tables, w, k)


@function
def _take_sides(
    ball: Record, lines: Table, count: int, sides: Table, w: int, k: int, scene: int, gx: Feature, gy: Feature
) -> None:
    """Sides at the start: on a line itself, the one the ball moves to; at rest, the one gravity presses it from."""
    if lines is None or sides is None:
        return
    for i in range(count):
        line = lines[scene, i]
        nx, ny = -line.uy, line.ux
        lean = (ball.x - line.x) * nx + (ball.y - line.y) * ny
        if abs(lean) <= ball.slack:
            lean = ball.vx * nx + ball.vy * ny
            if lean == 0.0 and gx is not None:
                lean = -(gx * nx + gy * ny)
        sides[w, k, i] = 1 if lean >= 0.0 else -1


@function
def restart(state: State, tables: Tables, w: int) -> None:
    """Set world `w` back to time 0 with its parts at rest in the middle of their rails; balls are placed after this."""
    world = state.worlds[w]
    world.time_hi, world.time_lo = 0.0, 0.0
    world.bounces, world.speed_capped, world.rows = 0, 0, 0
    clear_hits(state, w)
    _rest_paddles(state.paddles, tables.rails, w, world.scene, tables.scenes[world.scene].paddles)


@function
def _rest_paddles(paddles: Table, rails: Table, w: int, scene: int, count: int) -> None:
    if paddles is None or rails is None:
        return
    for m in range(paddles.shape[1]):
        paddle = paddles[w, m]
        paddle.offset = 0.5 * rails[scene, m].span if m < count else 0.0
        paddle.velocity, paddle.command, paddle.hi, paddle.lo = 0.0, 0.0, 0.0, 0.0


@function
def clear_hits(state: State, w: int) -> None:
    """Forget which elements were struck in the last step; a step without hits pays a comparison."""
    if state.worlds[w].dirty:
        state.worlds[w].dirty = 0
        for element in range(state.hits.shape[1]):
            state.hits[w, element] = 0


@function
def resume(state: State, w: int) -> None:
    """Let balls that the event budget stopped go on."""
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == BUDGET:
            state.balls[w, k].status = OK
