"""Balls that are crushed: the part that does it is blocked, and a command that opens the gap sets both free."""

import math

from bounce_env.engine.compile.jit import Record, function, where
from bounce_env.engine.detect.pairs import plan_pairs
from bounce_env.engine.detect.parts import plan_part_zones
from bounce_env.engine.detect.schedule import schedule_parts, schedule_resolve
from bounce_env.engine.events.flights import disturb, let_go
from bounce_env.engine.events.part_stops import (
    block_part,
    end_rides,
    hold_part_still,
    replan_part,
    resume_part,
    turns_back,
)
from bounce_env.engine.memory.ledger import Surface, append_contact
from bounce_env.engine.memory.lookup import let_off, side_of_part
from bounce_env.engine.memory.records import CRUSH, CRUSHED, HELD, OK
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.parts import (
    MovingPart,
    kept_part_offset,
    moving_part,
    nearest_on_core,
    part_core_at,
    part_surface_velocity,
)
from bounce_env.engine.tolerances import CLEARANCE, ULPS_OF_SPEED


@where("parts", inline=False)
def crush(state: State, w: int, k: int) -> None:
    """Stop the part that crushes ball `k`, and hold the ball until a command opens the gap.

    A part that shuttles turns back instead, where it has room for it.
    """
    ball, world = state.balls[w, k], state.worlds[w]
    m = ball.struck
    side = side_of_part(state, w, k, m)
    nx, ny, _, ux, uy = _surface_at_ball(ball, moving_part(state, w, m), side, world.time_hi, world.time_lo)
    motion, shape = state.motions[w, m], state.parts[world.scene, m]
    if turns_back(motion, shape, kept_part_offset(motion, shape, world.time_hi, world.time_lo)):
        ball.status = OK
        let_off(state, w, k)
        schedule_resolve(ball)
    else:
        vx, vy = ball.vx, ball.vy
        ball.vx, ball.vy, ball.ax, ball.ay = 0.0, 0.0, 0.0, 0.0
        ball.contact, ball.rides, ball.support, ball.settling = HELD, -1, shape.element, 0
        ball.nx, ball.ny = nx, ny
        surface = Surface(shape.element, nx, ny, ux, uy)
        append_contact(state, w, k, CRUSH, surface, vx, vy)
        ball.hit_after, ball.end_after, ball.sensor_after = math.inf, math.inf, math.inf
        plan_part_zones(state, w, k, 0.0)
        schedule_parts(state, w, k)
        let_go(state, w, k)
    plan_pairs(state, w, k)
    block_part(state, w, m)


@where("parts", inline=False)
def hold_or_free_crushed(state: State, w: int, m: int) -> None:
    """Part `m` has set off: it may not close on a crushed ball, and frees those that it moves away from."""
    world, part = state.worlds[w], moving_part(state, w, m)
    for k in range(state.balls.shape[1]):
        ball = state.balls[w, k]
        if ball.status != CRUSHED:
            continue
        gap, closing = _approach_to_crushed(ball, part, side_of_part(state, w, k, m), world.time_hi, world.time_lo)
        if gap > 2.0 * CLEARANCE * state.scenes[world.scene].extent:
            continue
        if closing > 0.0:
            hold_part_still(part)
        elif closing < 0.0:
            _free_crushed(state, w, k, m)


@where("parts", inline=False)
def meet_crushed(state: State, w: int, k: int, m: int) -> None:
    """Part `m` comes to ball `k`, which is crushed: it may not close on it, but slide past it.

    What is told at once to have come to it again is about to close on it.
    """
    ball, world = state.balls[w, k], state.worlds[w]
    side = side_of_part(state, w, k, m)
    _, closing = _approach_to_crushed(ball, moving_part(state, w, m), side, world.time_hi, world.time_lo)
    if closing > 0.0 or (ball.hi == world.time_hi and ball.lo == world.time_lo):
        block_part(state, w, m)
    else:
        ball.hi, ball.lo = world.time_hi, world.time_lo
        schedule_parts(state, w, k)


@function
def _approach_to_crushed(ball: Record, part: MovingPart, side: int, hi: float, lo: float) -> tuple[float, float]:
    """Return how far [m] a part is from a crushed ball, and how fast [m/s] it closes; 0 within rounding."""
    nx, ny, gap, ux, uy = _surface_at_ball(ball, part, side, hi, lo)
    closing = ux * nx + uy * ny
    return gap, closing if abs(closing) > ULPS_OF_SPEED * (abs(ux) + abs(uy)) else 0.0


@function
def _surface_at_ball(
    ball: Record, part: MovingPart, side: int, hi: float, lo: float
) -> tuple[float, float, float, float, float]:
    """Return a part's normal to a ball, the gap [m], and how its surface moves there [m/s]: (nx, ny, gap, ux, uy)."""
    core, radius = part_core_at(part, hi, lo), part.shape.radius
    nx, ny, distance, nearest = nearest_on_core(core, ball.x, ball.y, side, ball.tolerance)
    ux, uy = part_surface_velocity(part, core, nearest * core.ux + radius * nx, nearest * core.uy + radius * ny)
    return nx, ny, distance - part.shape.offset_radius, ux, uy


@where("parts")
def _free_crushed(state: State, w: int, k: int, m: int) -> None:
    """Let a crushed ball go on, and what crushed it, unless that is part `m`, which has been told where to."""
    ball = state.balls[w, k]
    crusher = ball.struck
    ball.status = OK
    let_off(state, w, k)
    disturb(state, w, k, 1.0, 0.0, 0.0)
    if crusher != m and crusher >= 0:
        end_rides(state, w, crusher)
        resume_part(state, w, crusher)
        replan_part(state, w, crusher)


@where("parts")
def free_all_crushed(state: State, w: int) -> None:
    """Let all crushed balls go on: something else than a command may have opened their gaps."""
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == CRUSHED:
            _free_crushed(state, w, k, -1)
