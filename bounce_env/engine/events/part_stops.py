"""How a part's motion changes: it sets off, comes to a stop, or is blocked.

First the flights of the balls that it carries end there, then it moves otherwise, then these balls are resolved anew
against what they touch, and every ball that it can reach searches it anew.
"""

from bounce_env.engine.compile.jit import Record, function, where
from bounce_env.engine.detect.schedule import schedule_parts
from bounce_env.engine.events.flights import disturb
from bounce_env.engine.memory.ledger import append_stop
from bounce_env.engine.memory.lookup import let_off, side_of_part
from bounce_env.engine.memory.records import CRUSHED, OUT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.dragged_wall import (
    move_dragged_ends,
    set_dragged_ends_off,
    stop_dragged_ends,
    take_next_stop_of_dragged_ends,
)
from bounce_env.engine.motion.parts import (
    MovingPart,
    is_dragged_part,
    kept_part_offset,
    moving_part,
    part_core_at,
    part_stop_instant,
    part_surface_velocity,
)
from bounce_env.engine.tolerances import CLEARANCE


@function
def set_part_off(motion: Record, shape: Record, world: Record, velocity: float) -> None:
    """Start a commanded motion from the part's place: against a stop it stands, or turns back if it is a shuttle."""
    motion.offset = kept_part_offset(motion, shape, world.time_hi, world.time_lo)
    motion.hi, motion.lo = world.time_hi, world.time_lo
    motion.command = velocity
    back = -velocity if shape.shuttle > 0.0 else 0.0
    # Written without asking for the sign of the velocity, which the processor could only guess.
    if motion.offset == 0.0:
        velocity = max(velocity, back)
    if motion.offset == shape.span:
        velocity = min(velocity, back)
    motion.velocity = velocity


@where("parts")
def resume_part(state: State, w: int, m: int) -> None:
    """Let part `m` move, from now on, as it was last commanded to."""
    part, world = moving_part(state, w, m), state.worlds[w]
    if is_dragged_part(part):
        _set_wall_off(state, w, m)
    else:
        set_part_off(part.motion, part.shape, world, part.motion.command)


@where("ends")
def _set_wall_off(state: State, w: int, m: int) -> None:
    world = state.worlds[w]
    set_dragged_ends_off(
        state.motions[w, m], state.ends[w, m], state.drag_limits[world.scene, m], world.time_hi, world.time_lo
    )


@function
def hold_part_still(part: MovingPart) -> None:
    """Stop a part where it is."""
    part.motion.velocity = 0.0
    _hold_ends(part)


@where("ends")
def _hold_ends(part: MovingPart) -> None:
    if is_dragged_part(part):
        stop_dragged_ends(part.motion, part.ends)


@where("parts")
def reset_parts(state: State, w: int) -> None:
    """Put the parts where they are after a reset, at rest but for those that shuttle."""
    scene = state.worlds[w].scene
    for m in range(state.motions.shape[1]):
        _reset_ends(state, w, m)
        motion = state.motions[w, m]
        motion.offset, motion.velocity, motion.command, motion.hi, motion.lo = 0.0, 0.0, 0.0, 0.0, 0.0
        if m < state.scenes[scene].parts:
            motion.offset = state.parts[scene, m].start
            motion.velocity = motion.command = state.parts[scene, m].shuttle


@where("ends")
def _reset_ends(state: State, w: int, m: int) -> None:
    ends, limits = state.ends[w, m], state.drag_limits[state.worlds[w].scene, m]
    ends.x0, ends.y0, ends.x1, ends.y1 = limits.sx, limits.sy, limits.ex, limits.ey
    ends.vx0, ends.vy0, ends.vx1, ends.vy1 = 0.0, 0.0, 0.0, 0.0
    ends.cx0, ends.cy0, ends.cx1, ends.cy1 = 0.0, 0.0, 0.0, 0.0


@where("zones", inline=False)
def replan_part(state: State, w: int, m: int) -> None:
    """Search part `m` anew for every ball that it can reach: it has changed its speed."""
    for k in range(state.balls.shape[1]):
        if state.zones[w, k, m].inside and state.balls[w, k].status != OUT:
            schedule_parts(state, w, k)


@function
def end_rides(state: State, w: int, m: int) -> None:
    """End the flights of the balls that part `m` carries: they are resolved anew once it moves otherwise.

    Of a wall without thickness those of all balls of no radius: their side of it is told by its present motion.
    """
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].rides == m or side_of_part(state, w, k, m) != 0:
            disturb(state, w, k, 1.0, 0.0, 0.0)


@where("parts", inline=False)
def stop_part(state: State, w: int, m: int) -> None:
    """Let part `m` come to a stop now: it stands there, or turns back if it is a shuttle."""
    motion, shape = state.motions[w, m], state.parts[state.worlds[w].scene, m]
    hi, lo = part_stop_instant(motion, shape)
    _halt_part(state, w, m, shape.span if motion.velocity > 0.0 else 0.0, False, hi, lo)


@where("parts", inline=False)
def block_part(state: State, w: int, m: int) -> None:
    """Let part `m` stop now, against a ball that is crushed."""
    world = state.worlds[w]
    hi, lo = world.time_hi, world.time_lo
    _halt_part(state, w, m, kept_part_offset(state.motions[w, m], state.parts[world.scene, m], hi, lo), True, hi, lo)


@function
def _halt_part(state: State, w: int, m: int, offset: float, blocked: bool, hi: float, lo: float) -> None:
    """Let part `m` stop at the instant (hi, lo): where it is if it is `blocked`, or as it comes to a stop."""
    end_rides(state, w, m)
    _release_caught(state, w, m)
    part = moving_part(state, w, m)
    if is_dragged_part(part):
        _halt_wall(state, w, m, blocked, hi, lo)
    else:
        _halt_capsule(state, w, part, offset, hi, lo)
    replan_part(state, w, m)


@function
def _release_caught(state: State, w: int, m: int) -> None:
    """Part `m` no longer closes on the balls that it has caught, of which none is crushed yet."""
    for k in range(state.balls.shape[1]):
        ball = state.balls[w, k]
        if ball.struck == m and ball.status != CRUSHED:
            let_off(state, w, k)


@function
def turns_back(motion: Record, shape: Record, offset: float) -> bool:
    """Return whether a part that stops at `offset` [m] turns back: a shuttle, but not between a ball and its stop."""
    room = offset if motion.velocity > 0.0 else shape.span - offset
    return shape.shuttle > 0.0 and room > CLEARANCE * shape.span


@function
def _halt_capsule(state: State, w: int, part: MovingPart, offset: float, hi: float, lo: float) -> None:
    """Let a part stop at `offset`: it stands there, or turns back if it is a shuttle that has room for it."""
    motion, shape = part.motion, part.shape
    motion.hi, motion.lo, motion.offset = hi, lo, offset
    core = part_core_at(part, hi, lo)
    # Of a part that turns the ledger tells of its tip, of one that slides of its middle.
    rx, ry = (core.front * core.ux, core.front * core.uy) if part.turn != 0 else (0.0, 0.0)
    before = part_surface_velocity(part, core, rx, ry)
    turns = turns_back(motion, shape, offset)
    motion.velocity = -motion.velocity if turns else 0.0
    if turns:
        motion.command = motion.velocity
    after = part_surface_velocity(part, core, rx, ry)
    append_stop(state, w, shape.element, hi, (core.x + rx, core.y + ry), before, after)


@where("ends")
def _halt_wall(state: State, w: int, m: int, blocked: bool, hi: float, lo: float) -> None:
    """Let the ends of a dragged wall stop: both if they are `blocked`, or what comes to a stop.

    The ledger has a row for each of its two ends.
    """
    world, motion, ends = state.worlds[w], state.motions[w, m], state.ends[w, m]
    limits, element = state.drag_limits[world.scene, m], state.parts[world.scene, m].element
    start, end = (ends.vx0, ends.vy0), (ends.vx1, ends.vy1)
    if blocked:
        move_dragged_ends(motion, ends, limits, hi, lo)
        stop_dragged_ends(motion, ends)
    else:
        take_next_stop_of_dragged_ends(motion, ends, limits, hi, lo)
    append_stop(state, w, element, hi, (ends.x0, ends.y0), start, (ends.vx0, ends.vy0))
    append_stop(state, w, element, hi, (ends.x1, ends.y1), end, (ends.vx1, ends.vy1))
