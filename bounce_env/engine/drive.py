"""What moves parts, and what their moving does to balls: commands, stops, crushed balls; what disturbs a flight.

A part's motion changes at an instant: first the flights of the balls that it carries end there, then it moves
otherwise, then these balls are resolved anew against what they touch, and every ball that it can reach searches it
anew.
"""

import math

from bounce_env.engine.arrive import arrive, end_flight, face_crossings
from bounce_env.engine.crossing import accelerate, take_sides
from bounce_env.engine.flight import touch_tolerance
from bounce_env.engine.instant import since
from bounce_env.engine.jit import Record, Table, function
from bounce_env.engine.layout import CRUSH, CRUSHED, FLYING, HELD, OK, OUT, PART_STOPS, RESOLVE, State, Tables
from bounce_env.engine.pairs import plan_pairs
from bounce_env.engine.parts import core_at, kept_offset, plan_zones, stop_instant, surface_velocity, turn_of
from bounce_env.engine.resolve import log
from bounce_env.engine.search import plan_parts, pull, resolve_next
from bounce_env.engine.tolerances import CLEARANCE
from bounce_env.engine.touch import on_capsule


@function
def place(state: State, tables: Tables, w: int, k: int, x: float, y: float, vx: float, vy: float) -> None:
    """Put ball `k` into flight at (x, y) [m] with velocity (vx, vy) [m/s] at the world's present time."""
    ball, world = state.balls[w, k], state.worlds[w]
    head = tables.scenes[world.scene]
    ball.x, ball.y, ball.vx, ball.vy = x, y, vx, vy
    ball.hi, ball.lo = world.time_hi, world.time_lo
    ball.status = OK
    ball.contact, ball.rides, ball.support, ball.settling, ball.rolling = FLYING, -1, -1, 0, -1
    ball.struck, ball.squeezes, ball.vague = -1, 0, 0.0
    ball.slack = touch_tolerance(head.extent, 0.0, 0.0, None, None, 0.0)
    take_sides(state, tables, w, k)
    accelerate(state, tables, w, k)
    ball.ax, ball.ay = ball.gx, ball.gy
    _enter_zones(state.zones, w, k)
    resolve_next(ball)
    plan_pairs(state, tables, state.pairs, w, k)


@function
def _enter_zones(zones: Table, w: int, k: int) -> None:
    """Until its first flight is planned a ball may be anywhere."""
    if zones is not None:
        for m in range(zones.shape[2]):
            zones[w, k, m].inside = 1


@function
def disturb(state: State, tables: Tables, w: int, k: int, drag: float, dvx: float, dvy: float) -> None:
    """Let a new flight of ball `k` begin now, at `drag` times its velocity plus (dvx, dvy) [m/s].

    It first bounces from what it touches, or comes into contact with it, or goes on as it was.
    """
    ball, world = state.balls[w, k], state.worlds[w]
    if ball.status in (OUT, CRUSHED):
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
def command(state: State, tables: Tables, motions: Table, parts: Table, w: int, m: int, velocity: float) -> None:
    """Let part `m` of world `w` move at `velocity` [m/s or rad/s] from now on. The command it has changes no bit."""
    if motions is None or parts is None:
        return
    motion, world = motions[w, m], state.worlds[w]
    slow_down(state, tables, tables.drags, w)
    if velocity == motion.command:
        return
    _end_rides(state, tables, w, m)
    set_off(motion, parts[world.scene, m], world, velocity)
    _mind_crushed(state, tables, motions, parts, w, m)
    replan_part(state, tables, state.zones, w, m)


@function
def command_unwatched(
    world: Record, motions: Table, parts: Table, zones: Table, drags: Table, w: int, m: int, velocity: float
) -> bool:
    """As `command`, where no ball is concerned; otherwise it does nothing and returns False."""
    if motions is None or parts is None or zones is None:
        return True
    if drags is not None:
        return False
    motion = motions[w, m]
    if velocity == motion.command:
        return True
    for k in range(zones.shape[1]):
        if zones[w, k, m].inside:
            return False
    set_off(motion, parts[world.scene, m], world, velocity)
    return True


@function
def set_off(motion: Record, part: Record, world: Record, velocity: float) -> None:
    """Start a commanded motion from the part's place: against a stop it stands, or turns back if it is a shuttle."""
    motion.offset = kept_offset(motion, part, world.time_hi, world.time_lo)
    motion.hi, motion.lo = world.time_hi, world.time_lo
    motion.command = velocity
    back = -velocity if part.shuttle > 0.0 else 0.0
    # Written without asking for the sign of the velocity, which the processor could only guess.
    if motion.offset == 0.0:
        velocity = max(velocity, back)
    if motion.offset == part.span:
        velocity = min(velocity, back)
    motion.velocity = velocity


@function
def replan_part(state: State, tables: Tables, zones: Table, w: int, m: int) -> None:
    """Search anew for every ball that part `m` can reach: it has changed its speed."""
    if zones is None:
        return
    for k in range(state.balls.shape[1]):
        if zones[w, k, m].inside and state.balls[w, k].status != OUT:
            plan_parts(state, tables, w, k)


@function
def _end_rides(state: State, tables: Tables, w: int, m: int) -> None:
    """End the flights of the balls that part `m` carries: they are resolved anew once it moves otherwise."""
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].rides == m:
            disturb(state, tables, w, k, 1.0, 0.0, 0.0)


@function
def part_stops(
    state: State, tables: Tables, motions: Table, parts: Table, world: Record, w: int, m: int, ledger: Table
) -> None:
    """Let part `m` come to a stop now: it stands there, or turns back if it is a shuttle."""
    if motions is None or parts is None:
        return
    motion, part = motions[w, m], parts[world.scene, m]
    hi, lo = stop_instant(motion, part)
    offset = part.span if motion.velocity > 0.0 else 0.0
    _halt(state, tables, motion, part, world, w, m, offset, hi, lo, ledger)


@function
def _halt(
    state: State, tables: Tables, motion: Record, part: Record, world: Record, w: int, m: int,
    offset: float, hi: float, lo: float, ledger: Table,
) -> None:  # fmt: skip
    """Let part `m` stop at `offset` at the instant (hi, lo): it stands there, or turns back if it is a shuttle."""
    _end_rides(state, tables, w, m)
    motion.hi, motion.lo, motion.offset = hi, lo, offset
    turn = turn_of(tables.turns, world.scene, m)
    x, y, ux, uy = core_at(part, motion, turn, hi, lo)
    # Of a part that turns the ledger tells of its tip, of one that slides of its middle.
    rx, ry = (part.front * ux, part.front * uy) if turn != 0 else (0.0, 0.0)
    vx, vy = surface_velocity(motion, turn, ux, uy, rx, ry)
    motion.velocity = -motion.velocity if part.shuttle > 0.0 else 0.0
    if part.shuttle > 0.0:
        motion.command = motion.velocity
    if ledger is not None:
        row = ledger[world.rows]
        row.time, row.ball, row.element, row.kind = hi, -1, part.element, PART_STOPS
        row.x, row.y, row.nx, row.ny, row.ux, row.uy = x + rx, y + ry, 0.0, 0.0, 0.0, 0.0
        row.vx0, row.vy0 = vx, vy
        row.vx1, row.vy1 = surface_velocity(motion, turn, ux, uy, rx, ry)
        world.rows += 1
    replan_part(state, tables, state.zones, w, m)


@function
def crush(
    state: State, tables: Tables, motions: Table, parts: Table, w: int, k: int, vx: float, vy: float, ledger: Table
) -> None:
    """Stop the part that crushes ball `k`, and hold the ball until a command opens the gap.

    A part that shuttles turns back instead. (vx, vy): the ball's velocity [m/s] before.
    """
    if motions is None or parts is None:
        return
    ball, world = state.balls[w, k], state.worlds[w]
    m = ball.struck
    part = parts[world.scene, m]
    if part.shuttle > 0.0:
        ball.status, ball.struck, ball.squeezes = OK, -1, 0
        resolve_next(ball)
    else:
        ball.vx, ball.vy, ball.ax, ball.ay = 0.0, 0.0, 0.0, 0.0
        ball.contact, ball.rides, ball.support, ball.settling = HELD, -1, part.element, 0
        ball.nx, ball.ny = ball.snx, ball.sny
        log(ledger, world, ball, k, part.element, CRUSH, ball.nx, ball.ny, vx, vy, ball.sux, ball.suy)
        ball.hit_after, ball.end_after, ball.sensor_after = math.inf, math.inf, math.inf
        gx, gy = pull(tables.gravity, ball)
        plan_zones(ball, state, tables, state.zones, tables.parts, w, k, world.scene, gx, gy, 0.0)
        plan_parts(state, tables, w, k)
    plan_pairs(state, tables, state.pairs, w, k)
    block(state, tables, motions, parts, w, m, ledger)


@function
def block(state: State, tables: Tables, motions: Table, parts: Table, w: int, m: int, ledger: Table) -> None:
    """Let part `m` stop now, against a ball that is crushed."""
    if motions is None or parts is None:
        return
    world = state.worlds[w]
    motion, part = motions[w, m], parts[world.scene, m]
    offset = kept_offset(motion, part, world.time_hi, world.time_lo)
    _halt(state, tables, motion, part, world, w, m, offset, world.time_hi, world.time_lo, ledger)


@function
def _mind_crushed(state: State, tables: Tables, motions: Table, parts: Table, w: int, m: int) -> None:
    """Part `m` has set off: it may not close on a crushed ball, and frees those that it moves away from."""
    if motions is None or parts is None:
        return
    world = state.worlds[w]
    motion, part, turn = motions[w, m], parts[world.scene, m], turn_of(tables.turns, world.scene, m)
    for k in range(state.balls.shape[1]):
        ball = state.balls[w, k]
        if ball.status != CRUSHED:
            continue
        x, y, ux, uy = core_at(part, motion, turn, world.time_hi, world.time_lo)
        nx, ny, distance, nearest = on_capsule(ball.x - x, ball.y - y, ux, uy, part.back, part.front)
        if distance - part.reach > 2.0 * CLEARANCE * tables.scenes[world.scene].extent:
            continue
        vx, vy = surface_velocity(motion, turn, ux, uy, nearest * ux, nearest * uy)
        closing = vx * nx + vy * ny
        if closing > 0.0:
            motion.velocity = 0.0
        elif closing < 0.0:
            _free(state, tables, motions, parts, w, k, m)


@function
def _free(state: State, tables: Tables, motions: Table, parts: Table, w: int, k: int, m: int) -> None:
    """Let a crushed ball go on, and what crushed it, unless that is part `m`, which has been told where to."""
    ball, world = state.balls[w, k], state.worlds[w]
    crusher = ball.struck
    ball.status, ball.struck, ball.squeezes = OK, -1, 0
    disturb(state, tables, w, k, 1.0, 0.0, 0.0)
    if crusher != m and crusher >= 0:
        _end_rides(state, tables, w, crusher)
        set_off(motions[w, crusher], parts[world.scene, crusher], world, motions[w, crusher].command)
        replan_part(state, tables, state.zones, w, crusher)


@function
def free_all(state: State, tables: Tables, motions: Table, parts: Table, w: int) -> None:
    """Let all crushed balls go on: something else than a command may have opened their gaps."""
    if motions is None or parts is None:
        return
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == CRUSHED:
            _free(state, tables, motions, parts, w, k, -1)


@function
def rest_parts(motions: Table, parts: Table, w: int, scene: int, count: int) -> None:
    """Put the parts where they are after a reset, at rest but for those that shuttle."""
    if motions is None or parts is None:
        return
    for m in range(motions.shape[1]):
        motion = motions[w, m]
        motion.offset, motion.velocity, motion.command, motion.hi, motion.lo = 0.0, 0.0, 0.0, 0.0, 0.0
        if m < count:
            motion.offset = parts[scene, m].start
            motion.velocity = motion.command = parts[scene, m].shuttle
