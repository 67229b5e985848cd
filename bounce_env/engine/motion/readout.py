"""Where things are now: the state of a world evaluated at its present time."""

import math

from bounce_env.engine.compile.jit import Record, Table, function, kernel
from bounce_env.engine.memory.lookup import ends_of, pull, turn_of
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import moved, sped
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.parts import core_at


@function
def ball_now(state: State, w: int, k: int) -> tuple[float, float, float, float]:
    """Where ball `k` is now and how fast: (x, y, vx, vy). A drained ball stays where it crossed."""
    ball, world = state.balls[w, k], state.worlds[w]
    if ball.status == OUT:
        return ball.x, ball.y, ball.vx, ball.vy
    gx, gy = pull(state.gravity, ball)
    t = since(world.time_hi, world.time_lo, ball.hi, ball.lo)
    return (
        moved(ball.x, ball.vx, gx, t),
        moved(ball.y, ball.vy, gy, t),
        sped(ball.vx, gx, t),
        sped(ball.vy, gy, t),
    )


@function
def core_now(
    motions: Table, parts: Table, turns: Table, ends: Table, w: int, world: Record, m: int
) -> tuple[float, float, float, float]:
    """Where the two ends of part `m`'s core are now: x, y, x, y [m]; NaN where there are no parts."""
    if motions is None or parts is None:
        return math.nan, math.nan, math.nan, math.nan
    part, turn = parts[world.scene, m], turn_of(turns, world.scene, m)
    x, y, ux, uy, back, front = core_at(part, motions[w, m], turn, ends_of(ends, w, m), world.time_hi, world.time_lo)
    return x + back * ux, y + back * uy, x + front * ux, y + front * uy


@kernel
def view(state: State, w: int, balls: Array, cores: Array) -> None:
    """Write the balls (k, 4): x, y [m], vx, vy [m/s], and the ends of the parts' cores (m, 4) [m] of world `w`."""
    for k in range(balls.shape[0]):
        balls[k, 0], balls[k, 1], balls[k, 2], balls[k, 3] = ball_now(state, w, k)
    for m in range(cores.shape[0]):
        cores[m, 0], cores[m, 1], cores[m, 2], cores[m, 3] = core_now(
            state.motions, state.parts, state.turns, state.ends, w, state.worlds[w], m
        )
