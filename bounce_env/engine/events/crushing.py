"""Balls that are crushed: the part that does it is blocked, and a command that opens the gap sets both free."""

import math

from bounce_env.engine.compile.jit import Record, Table, function, routine
from bounce_env.engine.contact.touching import on_capsule
from bounce_env.engine.detect.pairs import plan_pairs
from bounce_env.engine.detect.parts import plan_zones
from bounce_env.engine.detect.schedule import plan_parts, resolve_next
from bounce_env.engine.events.flights import disturb
from bounce_env.engine.events.part_stops import block, end_rides, hold_still, replan_part, resume_part, turns_back
from bounce_env.engine.memory.ledger import log
from bounce_env.engine.memory.lookup import ends_of, pull, side_of_part, turn_of
from bounce_env.engine.memory.records import CRUSH, CRUSHED, HELD, OK
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.parts import core_at, kept_offset, surface_velocity
from bounce_env.engine.tolerances import CLEARANCE, ULPS_OF_SPEED


@routine
def crush(state: State, motions: Table, parts: Table, w: int, k: int, ledger: Table) -> None:
    """Stop the part that crushes ball `k`, and hold the ball until a command opens the gap.

    A part that shuttles turns back instead, where it has room for it.
    """
    if motions is None or parts is None:
        return
    ball, world = state.balls[w, k], state.worlds[w]
    m = ball.struck
    motion, part = motions[w, m], parts[world.scene, m]
    if turns_back(motion, part, kept_offset(motion, part, world.time_hi, world.time_lo)):
        ball.status, ball.struck, ball.squeezes = OK, -1, 0
        resolve_next(ball)
    else:
        vx, vy = ball.vx, ball.vy
        ball.vx, ball.vy, ball.ax, ball.ay = 0.0, 0.0, 0.0, 0.0
        ball.contact, ball.rides, ball.support, ball.settling = HELD, -1, part.element, 0
        ball.nx, ball.ny = ball.snx, ball.sny
        log(ledger, world, ball, k, part.element, CRUSH, ball.nx, ball.ny, vx, vy, ball.sux, ball.suy)
        ball.hit_after, ball.end_after, ball.sensor_after = math.inf, math.inf, math.inf
        gx, gy = pull(state.gravity, ball)
        plan_zones(ball, state, state.zones, state.parts, w, k, world.scene, gx, gy, 0.0)
        plan_parts(state, w, k)
    plan_pairs(state, state.pairs, w, k)
    block(state, motions, parts, w, m, ledger)


@routine
def mind_crushed(state: State, motions: Table, parts: Table, w: int, m: int) -> None:
    """Part `m` has set off: it may not close on a crushed ball, and frees those that it moves away from."""
    if motions is None or parts is None:
        return
    world = state.worlds[w]
    motion, part, turn = motions[w, m], parts[world.scene, m], turn_of(state.turns, world.scene, m)
    ends = ends_of(state.ends, w, m)
    for k in range(state.balls.shape[1]):
        ball = state.balls[w, k]
        if ball.status != CRUSHED:
            continue
        side = side_of_part(state.part_sides, w, k, m)
        gap, closing = _approach(ball, motion, part, turn, ends, side, world.time_hi, world.time_lo)
        if gap > 2.0 * CLEARANCE * state.scenes[world.scene].extent:
            continue
        if closing > 0.0:
            hold_still(motion, ends, part)
        elif closing < 0.0:
            _free(state, motions, parts, w, k, m)


@routine
def meet_crushed(state: State, motions: Table, parts: Table, w: int, k: int, m: int, ledger: Table) -> None:
    """Part `m` comes to ball `k`, which is crushed: it may not close on it, but slide past it.

    What is told at once to have come to it again is about to close on it.
    """
    if motions is None or parts is None:
        return
    ball, world = state.balls[w, k], state.worlds[w]
    turn, ends = turn_of(state.turns, world.scene, m), ends_of(state.ends, w, m)
    side = side_of_part(state.part_sides, w, k, m)
    _, closing = _approach(ball, motions[w, m], parts[world.scene, m], turn, ends, side, world.time_hi, world.time_lo)
    if closing > 0.0 or (ball.hi == world.time_hi and ball.lo == world.time_lo):
        block(state, motions, parts, w, m, ledger)
    else:
        ball.hi, ball.lo = world.time_hi, world.time_lo
        plan_parts(state, w, k)


@function
def _approach(
    ball: Record, motion: Record, part: Record, turn: int, ends: Record, side: int, hi: float, lo: float
) -> tuple[float, float]:
    """How far [m] a part is from a crushed ball at an instant, and how fast [m/s] it closes; 0 within rounding."""
    x, y, ux, uy, back, front = core_at(part, motion, turn, ends, hi, lo)
    nx, ny, distance, nearest = on_capsule(ball.x - x, ball.y - y, ux, uy, back, front, side, ball.slack)
    vx, vy = surface_velocity(motion, part, turn, ends, ux, uy, front, nearest * ux, nearest * uy)
    closing = vx * nx + vy * ny
    return distance - part.reach, closing if abs(closing) > ULPS_OF_SPEED * (abs(vx) + abs(vy)) else 0.0


@function
def _free(state: State, motions: Table, parts: Table, w: int, k: int, m: int) -> None:
    """Let a crushed ball go on, and what crushed it, unless that is part `m`, which has been told where to."""
    ball = state.balls[w, k]
    crusher = ball.struck
    ball.status, ball.struck, ball.squeezes = OK, -1, 0
    disturb(state, w, k, 1.0, 0.0, 0.0)
    if crusher != m and crusher >= 0:
        end_rides(state, w, crusher)
        resume_part(state, motions, parts, w, crusher)
        replan_part(state, state.zones, w, crusher)


@function
def free_all(state: State, motions: Table, parts: Table, w: int) -> None:
    """Let all crushed balls go on: something else than a command may have opened their gaps."""
    if motions is None or parts is None:
        return
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == CRUSHED:
            _free(state, motions, parts, w, k, -1)
