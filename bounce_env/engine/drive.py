"""What moves parts, and what their moving does to balls: commands, stops, crushed balls; what disturbs a flight.

A part's motion changes at an instant: first the flights of the balls that it carries end there, then it moves
otherwise, then these balls are resolved anew against what they touch, and every ball that it can reach searches it
anew.
"""

import math

from bounce_env.engine.arrive import arrive, end_flight, face_crossings
from bounce_env.engine.crossing import accelerate, take_sides
from bounce_env.engine.ends import (
    ends_of,
    is_dragged,
    move_ends,
    next_stop_of_ends,
    set_ends_off,
    stop_ends,
)
from bounce_env.engine.flight import touch_tolerance
from bounce_env.engine.instant import since
from bounce_env.engine.jit import Record, Table, function
from bounce_env.engine.layout import CRUSH, CRUSHED, FLYING, HELD, OK, OUT, PART_STOPS, RESOLVE, State, Tables
from bounce_env.engine.pairs import plan_pairs
from bounce_env.engine.parts import (
    core_at,
    kept_offset,
    plan_zones,
    side_of_part,
    stop_instant,
    surface_velocity,
    turn_of,
)
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
def drag(
    state: State, tables: Tables, motions: Table, parts: Table, all_ends: Table, guides: Table, w: int, m: int,
    vx0: float, vy0: float, vx1: float, vy1: float,
) -> None:  # fmt: skip
    """Let the ends of the dragged wall `m` move at these velocities [m/s] from now on, as far as they may."""
    if motions is None or parts is None or all_ends is None or guides is None:
        return
    motion, ends, world = motions[w, m], all_ends[w, m], state.worlds[w]
    slow_down(state, tables, tables.drags, w)
    if vx0 == ends.cx0 and vy0 == ends.cy0 and vx1 == ends.cx1 and vy1 == ends.cy1:
        return
    _end_rides(state, tables, w, m)
    ends.cx0, ends.cy0, ends.cx1, ends.cy1 = vx0, vy0, vx1, vy1
    set_ends_off(motion, ends, guides[world.scene, m], world.time_hi, world.time_lo)
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
    """End the flights of the balls that part `m` carries: they are resolved anew once it moves otherwise.

    Of a wall without thickness those of all balls of no radius: their side of it is told by its present motion.
    """
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].rides == m or side_of_part(state.part_sides, w, k, m) != 0:
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
    if is_dragged(ends_of(state.ends, w, m), part):
        _halt_wall(state, tables, state.ends, tables.guides, motion, part, world, w, m, False, hi, lo, ledger)
    else:
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
    x, y, ux, uy, _, front = core_at(part, motion, turn, None, hi, lo)
    # Of a part that turns the ledger tells of its tip, of one that slides of its middle.
    rx, ry = (front * ux, front * uy) if turn != 0 else (0.0, 0.0)
    vx, vy = surface_velocity(motion, part, turn, None, ux, uy, front, rx, ry)
    motion.velocity = -motion.velocity if part.shuttle > 0.0 else 0.0
    if part.shuttle > 0.0:
        motion.command = motion.velocity
    new_vx, new_vy = surface_velocity(motion, part, turn, None, ux, uy, front, rx, ry)
    _log_stop(ledger, world, part.element, hi, x + rx, y + ry, vx, vy, new_vx, new_vy)
    replan_part(state, tables, state.zones, w, m)


@function
def _halt_wall(
    state: State, tables: Tables, all_ends: Table, guides: Table, motion: Record, part: Record, world: Record, w: int,
    m: int, blocked: bool, hi: float, lo: float, ledger: Table,
) -> None:  # fmt: skip
    """Let the ends of the dragged wall `m` stop at an instant: both if they are `blocked`, or what comes to a stop.

    The ledger has a row for each of its two ends.
    """
    if all_ends is None or guides is None:
        return
    ends, guide = all_ends[w, m], guides[world.scene, m]
    _end_rides(state, tables, w, m)
    vx0, vy0, vx1, vy1 = ends.vx0, ends.vy0, ends.vx1, ends.vy1
    if blocked:
        move_ends(motion, ends, guide, hi, lo)
        stop_ends(motion, ends)
    else:
        next_stop_of_ends(motion, ends, guide, hi, lo)
    _log_stop(ledger, world, part.element, hi, ends.x0, ends.y0, vx0, vy0, ends.vx0, ends.vy0)
    _log_stop(ledger, world, part.element, hi, ends.x1, ends.y1, vx1, vy1, ends.vx1, ends.vy1)
    replan_part(state, tables, state.zones, w, m)


@function
def _log_stop(
    ledger: Table, world: Record, element: int, time: float, x: float, y: float, vx0: float, vy0: float,
    vx1: float, vy1: float,
) -> None:  # fmt: skip
    if ledger is not None:
        row = ledger[world.rows]
        row.time, row.ball, row.element, row.kind = time, -1, element, PART_STOPS
        row.x, row.y, row.nx, row.ny, row.ux, row.uy = x, y, 0.0, 0.0, 0.0, 0.0
        row.vx0, row.vy0, row.vx1, row.vy1 = vx0, vy0, vx1, vy1
        world.rows += 1


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
    motion, part, hi, lo = motions[w, m], parts[world.scene, m], world.time_hi, world.time_lo
    if is_dragged(ends_of(state.ends, w, m), part):
        _halt_wall(state, tables, state.ends, tables.guides, motion, part, world, w, m, True, hi, lo, ledger)
    else:
        offset = kept_offset(motion, part, hi, lo)
        _halt(state, tables, motion, part, world, w, m, offset, hi, lo, ledger)


@function
def _mind_crushed(state: State, tables: Tables, motions: Table, parts: Table, w: int, m: int) -> None:
    """Part `m` has set off: it may not close on a crushed ball, and frees those that it moves away from."""
    if motions is None or parts is None:
        return
    world = state.worlds[w]
    motion, part, turn = motions[w, m], parts[world.scene, m], turn_of(tables.turns, world.scene, m)
    ends = ends_of(state.ends, w, m)
    for k in range(state.balls.shape[1]):
        ball = state.balls[w, k]
        if ball.status != CRUSHED:
            continue
        x, y, ux, uy, back, front = core_at(part, motion, turn, ends, world.time_hi, world.time_lo)
        side = side_of_part(state.part_sides, w, k, m)
        nx, ny, distance, nearest = on_capsule(ball.x - x, ball.y - y, ux, uy, back, front, side)
        if distance - part.reach > 2.0 * CLEARANCE * tables.scenes[world.scene].extent:
            continue
        if side != 0 and not back <= nearest <= front:
            continue
        vx, vy = surface_velocity(motion, part, turn, ends, ux, uy, front, nearest * ux, nearest * uy)
        closing = vx * nx + vy * ny
        if closing > 0.0:
            _hold_still(motion, ends, part)
        elif closing < 0.0:
            _free(state, tables, motions, parts, w, k, m)


@function
def _hold_still(motion: Record, ends: Record, part: Record) -> None:
    motion.velocity = 0.0
    if ends is not None and is_dragged(ends, part):
        stop_ends(motion, ends)


@function
def _free(state: State, tables: Tables, motions: Table, parts: Table, w: int, k: int, m: int) -> None:
    """Let a crushed ball go on, and what crushed it, unless that is part `m`, which has been told where to."""
    ball, world = state.balls[w, k], state.worlds[w]
    crusher = ball.struck
    ball.status, ball.struck, ball.squeezes = OK, -1, 0
    disturb(state, tables, w, k, 1.0, 0.0, 0.0)
    if crusher != m and crusher >= 0:
        _end_rides(state, tables, w, crusher)
        _resume(state.ends, tables.guides, motions[w, crusher], parts[world.scene, crusher], world, w, crusher)
        replan_part(state, tables, state.zones, w, crusher)


@function
def _resume(all_ends: Table, guides: Table, motion: Record, part: Record, world: Record, w: int, m: int) -> None:
    """Let a part that was blocked move as it was last commanded to."""
    if all_ends is not None and guides is not None and is_dragged(all_ends[w, m], part):
        set_ends_off(motion, all_ends[w, m], guides[world.scene, m], world.time_hi, world.time_lo)
        return
    set_off(motion, part, world, motion.command)


@function
def free_all(state: State, tables: Tables, motions: Table, parts: Table, w: int) -> None:
    """Let all crushed balls go on: something else than a command may have opened their gaps."""
    if motions is None or parts is None:
        return
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == CRUSHED:
            _free(state, tables, motions, parts, w, k, -1)


@function
def rest_parts(motions: Table, parts: Table, all_ends: Table, guides: Table, w: int, scene: int, count: int) -> None:
    """Put the parts where they are after a reset, at rest but for those that shuttle."""
    if motions is None or parts is None:
        return
    for m in range(motions.shape[1]):
        _rest_ends(all_ends, guides, w, m, scene)
        motion = motions[w, m]
        motion.offset, motion.velocity, motion.command, motion.hi, motion.lo = 0.0, 0.0, 0.0, 0.0, 0.0
        if m < count:
            motion.offset = parts[scene, m].start
            motion.velocity = motion.command = parts[scene, m].shuttle


@function
def _rest_ends(all_ends: Table, guides: Table, w: int, m: int, scene: int) -> None:
    if all_ends is None or guides is None:
        return
    ends, guide = all_ends[w, m], guides[scene, m]
    ends.x0, ends.y0, ends.x1, ends.y1 = guide.sx, guide.sy, guide.ex, guide.ey
    ends.vx0, ends.vy0, ends.vx1, ends.vy1 = 0.0, 0.0, 0.0, 0.0
    ends.cx0, ends.cy0, ends.cx1, ends.cy1 = 0.0, 0.0, 0.0, 0.0
