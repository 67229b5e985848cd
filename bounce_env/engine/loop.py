"""The event loop of one world: the earliest event of its balls and parts, one after the other, up to an instant.

A step in which nothing happens costs one comparison per ball and part. At one instant balls come before parts, and each
in its order.
"""

import math

from bounce_env.engine.arrive import arrive, end_flight, face_crossings, snap
from bounce_env.engine.contact import resolve
from bounce_env.engine.crossing import accelerate, cross, take_sides
from bounce_env.engine.flight import touch_tolerance
from bounce_env.engine.instant import before, since
from bounce_env.engine.jit import Record, Table, function
from bounce_env.engine.layout import (
    BUDGET,
    FLYING,
    NEXT_HIT,
    NEXT_SENSOR,
    NEXT_ZONE,
    OK,
    OUT,
    PART_STOPS,
    RESOLVE,
    State,
    Tables,
)
from bounce_env.engine.parts import plan_zones, rail_offset, stop_instant
from bounce_env.engine.search import plan_parts, pull, resolve_next
from bounce_env.engine.tolerances import BOUNCES_AT_ONE_INSTANT, UNSURE

# How a run of the loop ends.
DONE, OUT_OF_BUDGET, LEDGER_FULL = 0, 1, 2

# Bounces, the end of a contact and the beginning of another, a small hop and what is in its way.
ROWS_AT_ONE_EVENT = BOUNCES_AT_ONE_INSTANT + 4


@function
def run(state: State, tables: Tables, w: int, until_hi: float, until_lo: float, max_events: int, ledger: Table) -> int:
    """Process the events of world `w` up to and including an instant; DONE, OUT_OF_BUDGET or LEDGER_FULL.

    At most `max_events` of them since `resume`.
    Unless DONE, the world's time is that of its last event, and the next call goes on from there.
    """
    world = state.worlds[w]
    while True:
        hi, lo, ball, paddle = _next(state, tables, w, until_hi, until_lo)
        if ball < 0 and paddle < 0:
            world.time_hi, world.time_lo = until_hi, until_lo
            return DONE
        if world.events >= max_events:
            _stop_for_budget(state, w)
            return OUT_OF_BUDGET
        if ledger is not None and world.rows + ROWS_AT_ONE_EVENT > len(ledger):
            return LEDGER_FULL
        world.time_hi, world.time_lo = hi, lo
        if ball >= 0:
            world.events += _ball_event(state, tables, w, ball, ledger)
        else:
            _part_stops(state, tables, w, paddle, ledger)
            world.events += 1


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
        gx, gy = pull(tables.gravity, ball)
        count = tables.scenes[scene].paddles
        plan_zones(ball, state.zones, tables.rails, count, w, k, scene, gx, gy, ball.zone_after)
        plan_parts(state, tables, w, k)
        return 0
    if ball.next_kind == NEXT_SENSOR:
        cross(state, tables, w, k, ledger)
        return 1
    planning = ball.next_kind == NEXT_HIT and ball.hit_kind == RESOLVE
    bounces = state.worlds[w].bounces
    _hit(state, tables, w, k, ledger)
    # A ball that is only planned anew has met nothing.
    return 0 if planning and state.worlds[w].bounces == bounces and ball.contact == FLYING else 1


@function
def _hit(state: State, tables: Tables, w: int, k: int, ledger: Table) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    gx, gy = pull(tables.gravity, ball)
    # A kept hit is a duration from the flight's start, so that its own rounding is all there is.
    t = ball.hit_after if ball.next_kind == NEXT_HIT else since(ball.part_hi, ball.part_lo, ball.hi, ball.lo)
    x0, y0, vx0, vy0 = ball.x, ball.y, ball.vx, ball.vy
    end_flight(ball, tables, scene, gx, gy, t, ball.next_hi, ball.next_lo)
    snap(ball, tables, state.paddles, w, scene)
    arrive(state, tables, w, k, x0, y0, vx0, vy0, t)
    resolve(state, tables, w, k, ledger)


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
    slow_down(state, tables, tables.drags, w)
    if velocity == paddle.command:
        return
    set_off(paddle, rails[world.scene, m], world, velocity)
    replan_paddle(state, tables, state.zones, w, m)


@function
def command_unwatched(
    world: Record, paddles: Table, rails: Table, zones: Table, drags: Table, w: int, m: int, velocity: float
) -> bool:
    """As `command`, where no ball is concerned; otherwise it does nothing and returns False."""
    if paddles is None or rails is None or zones is None:
        return True
    if drags is not None:
        return False
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
    ball.x, ball.y, ball.vx, ball.vy = x, y, vx, vy
    ball.hi, ball.lo = world.time_hi, world.time_lo
    ball.status = OK
    ball.contact, ball.support, ball.settling, ball.rolling = FLYING, -1, 0, -1
    ball.slack = touch_tolerance(head.extent, 0.0, 0.0, None, None, 0.0)
    take_sides(state, tables, w, k)
    accelerate(state, tables, w, k)
    ball.ax, ball.ay = ball.gx, ball.gy
    _leave_zones(state.zones, w, k)
    resolve_next(ball)


@function
def _leave_zones(zones: Table, w: int, k: int) -> None:
    if zones is not None:
        for m in range(zones.shape[2]):
            zones[w, k, m].inside = 0


@function
def disturb(state: State, tables: Tables, w: int, k: int, drag: float, dvx: float, dvy: float) -> None:
    """Let a new flight of ball `k` begin now, at `drag` times its velocity plus (dvx, dvy) [m/s].

    It first bounces from what it touches, or comes into contact with it, or goes on as it was.
    """
    ball, world = state.balls[w, k], state.worlds[w]
    if ball.status == OUT:
        return
    gx, gy = pull(tables.gravity, ball)
    t = since(world.time_hi, world.time_lo, ball.hi, ball.lo)
    x0, y0, vx0, vy0 = ball.x, ball.y, ball.vx, ball.vy
    end_flight(ball, tables, world.scene, gx, gy, t, world.time_hi, world.time_lo)
    ball.hit_kind = RESOLVE
    arrive(state, tables, w, k, x0, y0, vx0, vy0, t)
    face_crossings(state, tables, w, k)
    ball.vx, ball.vy = drag * ball.vx + dvx, drag * ball.vy + dvy
    resolve_next(ball)


@function
def slow_down(state: State, tables: Tables, drags: Table, w: int) -> None:
    """Let drag act on every ball: once at each instant at which a command is given, however many are."""
    if drags is None:
        return
    world = state.worlds[w]
    if world.drag_hi == world.time_hi and world.drag_lo == world.time_lo:
        return
    world.drag_hi, world.drag_lo = world.time_hi, world.time_lo
    for k in range(state.balls.shape[1]):
        disturb(state, tables, w, k, drags[world.scene], 0.0, 0.0)


@function
def restart(state: State, tables: Tables, w: int) -> None:
    """Set world `w` back to time 0 with its parts at rest in the middle of their rails; balls are placed after this."""
    world = state.worlds[w]
    world.time_hi, world.time_lo = 0.0, 0.0
    world.bounces, world.speed_capped, world.rows = 0, 0, 0
    world.drag_hi, world.drag_lo = -1.0, 0.0
    clear_hits(state, w)
    _cool_down(state.cooling, w)
    _switch_on(state.disabled, w)
    _rest_paddles(state.paddles, tables.rails, w, world.scene, tables.scenes[world.scene].paddles)


@function
def _cool_down(cooling: Table, w: int) -> None:
    if cooling is not None:
        for element in range(cooling.shape[1]):
            cooling[w, element].hi, cooling[w, element].lo = 0.0, 0.0


@function
def _switch_on(disabled: Table, w: int) -> None:
    if disabled is not None:
        for element in range(disabled.shape[1]):
            disabled[w, element] = 0


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
    """Let balls that the event budget stopped go on, with a new budget."""
    state.worlds[w].events = 0
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == BUDGET:
            state.balls[w, k].status = OK
