"""How a part's motion changes: it sets off, comes to a stop, or is blocked.

First the flights of the balls that it carries end there, then it moves otherwise, then these balls are resolved anew
against what they touch, and every ball that it can reach searches it anew.
"""

from bounce_env.engine.compile.jit import Record, Table, function, routine
from bounce_env.engine.detect.schedule import plan_parts
from bounce_env.engine.events.flights import disturb
from bounce_env.engine.memory.lookup import ends_of, is_dragged, side_of_part, turn_of
from bounce_env.engine.memory.records import CRUSHED, OUT, PART_STOPS
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.dragged_wall import move_ends, next_stop_of_ends, set_ends_off, stop_ends
from bounce_env.engine.motion.parts import core_at, kept_offset, stop_instant, surface_velocity
from bounce_env.engine.tolerances import CLEARANCE


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
def resume_part(state: State, motions: Table, parts: Table, w: int, m: int) -> None:
    """Let part `m` move, from now on, as it was last commanded to."""
    if motions is None or parts is None:
        return
    motion, world = motions[w, m], state.worlds[w]
    part = parts[world.scene, m]
    if is_dragged(ends_of(state.ends, w, m), part):
        _set_wall_off(motion, state.ends, state.guides, world, w, m)
    else:
        set_off(motion, part, world, motion.command)


@function
def _set_wall_off(motion: Record, all_ends: Table, guides: Table, world: Record, w: int, m: int) -> None:
    if all_ends is not None and guides is not None:
        set_ends_off(motion, all_ends[w, m], guides[world.scene, m], world.time_hi, world.time_lo)


@function
def hold_still(motion: Record, ends: Record, part: Record) -> None:
    motion.velocity = 0.0
    if ends is not None and is_dragged(ends, part):
        stop_ends(motion, ends)


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


@routine
def replan_part(state: State, zones: Table, w: int, m: int) -> None:
    """Search anew for every ball that part `m` can reach: it has changed its speed."""
    if zones is None:
        return
    for k in range(state.balls.shape[1]):
        if zones[w, k, m].inside and state.balls[w, k].status != OUT:
            plan_parts(state, w, k)


@function
def end_rides(state: State, w: int, m: int) -> None:
    """End the flights of the balls that part `m` carries: they are resolved anew once it moves otherwise.

    Of a wall without thickness those of all balls of no radius: their side of it is told by its present motion.
    """
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].rides == m or side_of_part(state.part_sides, w, k, m) != 0:
            disturb(state, w, k, 1.0, 0.0, 0.0)


@routine
def part_stops(state: State, motions: Table, parts: Table, world: Record, w: int, m: int, ledger: Table) -> None:
    """Let part `m` come to a stop now: it stands there, or turns back if it is a shuttle."""
    if motions is None or parts is None:
        return
    motion, part = motions[w, m], parts[world.scene, m]
    hi, lo = stop_instant(motion, part)
    offset = part.span if motion.velocity > 0.0 else 0.0
    _halt(state, motion, part, world, w, m, offset, False, hi, lo, ledger)


@routine
def block(state: State, motions: Table, parts: Table, w: int, m: int, ledger: Table) -> None:
    """Let part `m` stop now, against a ball that is crushed."""
    if motions is None or parts is None:
        return
    world = state.worlds[w]
    motion, part, hi, lo = motions[w, m], parts[world.scene, m], world.time_hi, world.time_lo
    offset = kept_offset(motion, part, hi, lo)
    _halt(state, motion, part, world, w, m, offset, True, hi, lo, ledger)


@function
def _halt(
    state: State, motion: Record, part: Record, world: Record, w: int, m: int,
    offset: float, blocked: bool, hi: float, lo: float, ledger: Table,
) -> None:  # fmt: skip
    """Let part `m` stop at the instant (hi, lo): where it is if it is `blocked`, or as it comes to a stop."""
    end_rides(state, w, m)
    _let_caught_go(state, w, m)
    if is_dragged(ends_of(state.ends, w, m), part):
        _halt_wall(motion, part, world, state.ends, state.guides, w, m, blocked, hi, lo, ledger)
    else:
        _halt_capsule(motion, part, world, turn_of(state.turns, world.scene, m), offset, hi, lo, ledger)
    replan_part(state, state.zones, w, m)


@function
def _let_caught_go(state: State, w: int, m: int) -> None:
    """Part `m` no longer closes on the balls that it has caught, of which none is crushed yet."""
    for k in range(state.balls.shape[1]):
        ball = state.balls[w, k]
        if ball.struck == m and ball.status != CRUSHED:
            ball.struck, ball.squeezes = -1, 0


@function
def turns_back(motion: Record, part: Record, offset: float) -> bool:
    """Whether a part that stops at `offset` [m] turns back: a shuttle, but not between a ball and its other stop."""
    room = offset if motion.velocity > 0.0 else part.span - offset
    return part.shuttle > 0.0 and room > CLEARANCE * part.span


@function
def _halt_capsule(
    motion: Record, part: Record, world: Record, turn: int, offset: float, hi: float, lo: float, ledger: Table
) -> None:
    """Let a part stop at `offset`: it stands there, or turns back if it is a shuttle that has room for it."""
    motion.hi, motion.lo, motion.offset = hi, lo, offset
    x, y, ux, uy, _, front = core_at(part, motion, turn, None, hi, lo)
    # Of a part that turns the ledger tells of its tip, of one that slides of its middle.
    rx, ry = (front * ux, front * uy) if turn != 0 else (0.0, 0.0)
    vx, vy = surface_velocity(motion, part, turn, None, ux, uy, front, rx, ry)
    turns = turns_back(motion, part, offset)
    motion.velocity = -motion.velocity if turns else 0.0
    if turns:
        motion.command = motion.velocity
    new_vx, new_vy = surface_velocity(motion, part, turn, None, ux, uy, front, rx, ry)
    _log_stop(ledger, world, part.element, hi, x + rx, y + ry, vx, vy, new_vx, new_vy)


@function
def _halt_wall(
    motion: Record, part: Record, world: Record, all_ends: Table, guides: Table, w: int, m: int, blocked: bool,
    hi: float, lo: float, ledger: Table,
) -> None:  # fmt: skip
    """Let the ends of a dragged wall stop: both if they are `blocked`, or what comes to a stop.

    The ledger has a row for each of its two ends.
    """
    if all_ends is None or guides is None:
        return
    ends, guide = all_ends[w, m], guides[world.scene, m]
    vx0, vy0, vx1, vy1 = ends.vx0, ends.vy0, ends.vx1, ends.vy1
    if blocked:
        move_ends(motion, ends, guide, hi, lo)
        stop_ends(motion, ends)
    else:
        next_stop_of_ends(motion, ends, guide, hi, lo)
    _log_stop(ledger, world, part.element, hi, ends.x0, ends.y0, vx0, vy0, ends.vx0, ends.vy0)
    _log_stop(ledger, world, part.element, hi, ends.x1, ends.y1, vx1, vy1, ends.vx1, ends.vy1)


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
