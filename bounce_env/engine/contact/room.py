"""Whether a part that closes on a ball leaves it a way out, or crushes it."""

import math

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.contact.restitution import ahead_of_both, surface_speed
from bounce_env.engine.contact.touching import collect_touches
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.parts import moving_part, part_stop_instant
from bounce_env.engine.tolerances import CLEARANCE, FASTEST_ESCAPE, ULPS_OF_SPEED


@where("parts", otherwise=False, inline=False)
def is_crushed_by(state: State, w: int, k: int, i: int) -> bool:
    """Return whether touched part `i` crushes a ball that it has struck; if so it is noted in the ball.

    It does if no velocity that the ball may have closes on nothing within a clearance of it, and the part does not come
    to its stop before the room is gone. Nothing is counted.
    """
    ball, part, closing = state.balls[w, k], state.touches[w, i].part, surface_speed(state.touches[w, i])
    if part < 0 or closing <= 0.0:
        return False
    if not _leaves_no_room(state, w, k, i, part, closing):
        return False
    ball.struck = part
    return True


@function
def _leaves_no_room(state: State, w: int, k: int, i: int, m: int, closing: float) -> bool:
    """Return whether part `m`, that comes at `closing` [m/s], leaves the ball no room to get away."""
    ball, head = state.balls[w, k], state.scenes[state.worlds[w].scene]
    nx, ny, tolerance = state.touches[w, i].nx, state.touches[w, i].ny, ball.tolerance
    ball.tolerance = CLEARANCE * head.extent
    collect_touches(state, w, k)
    room = 0.0
    for j in range(ball.touched):
        touch = state.touches[w, j]
        if touch.nx * nx + touch.ny * ny < 0.0:
            room = max(room, touch.gap)
    crushed = not _gets_away(ball, state.touches, w, fastest_escape(ball, state.touches, w, head))
    ball.tolerance = tolerance
    collect_touches(state, w, k)
    part = moving_part(state, w, m)
    stop_hi, stop_lo = part_stop_instant(part.motion, part.shape)
    return crushed and closing * since(stop_hi, stop_lo, ball.hi, ball.lo) > room


@function
def fastest_escape(ball: Record, touches: Table, w: int, head: Record) -> float:
    """Return how fast [m/s] what a ball touches may squeeze it out."""
    fastest = 0.0
    for i in range(ball.touched):
        touch = touches[w, i]
        fastest = max(fastest, math.sqrt(touch.ux * touch.ux + touch.uy * touch.uy))
    return min(head.max_speed, FASTEST_ESCAPE * fastest)


@function
def _gets_away(ball: Record, touches: Table, w: int, fastest: float) -> bool:
    """Return whether a velocity up to `fastest` [m/s] closes on nothing that is listed.

    The slowest of them is 0, or along one normal, or such that the ball keeps ahead of two surfaces.
    """
    if _closes_on_none(ball, touches, w, 0.0, 0.0):
        return True
    for i in range(ball.touched):
        one, drive = touches[w, i], surface_speed(touches[w, i])
        if drive <= fastest and _closes_on_none(ball, touches, w, drive * one.nx, drive * one.ny):
            return True
        for j in range(i):
            other = touches[w, j]
            turn = one.nx * other.ny - one.ny * other.nx
            if turn == 0.0:
                continue
            vx, vy = ahead_of_both(one, other, turn)
            if vx * vx + vy * vy <= fastest * fastest and _closes_on_none(ball, touches, w, vx, vy):
                return True
    return False


@function
def _closes_on_none(ball: Record, touches: Table, w: int, vx: float, vy: float) -> bool:
    """Return whether a ball of velocity (vx, vy) [m/s] would close on nothing that is listed."""
    for i in range(ball.touched):
        touch = touches[w, i]
        noise = ULPS_OF_SPEED * (abs(vx) + abs(vy) + abs(touch.ux) + abs(touch.uy))
        if (vx - touch.ux) * touch.nx + (vy - touch.uy) * touch.ny < -noise:
            return False
    return True
