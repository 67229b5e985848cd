"""Where things are now: the state of a world evaluated at its present time."""

import math

from bounce_env.engine.flight import moved, sped
from bounce_env.engine.instant import since
from bounce_env.engine.jit import Table, function, kernel
from bounce_env.engine.layout import OUT, Array, State, Tables
from bounce_env.engine.parts import rail_offset
from bounce_env.engine.search import pull


@function
def ball_now(state: State, tables: Tables, w: int, k: int) -> tuple[float, float, float, float]:
    """Where ball `k` is now and how fast: (x, y, vx, vy). A drained ball stays where it crossed."""
    ball, world = state.balls[w, k], state.worlds[w]
    if ball.status == OUT:
        return ball.x, ball.y, ball.vx, ball.vy
    gx, gy = pull(tables.gravity, ball)
    t = since(world.time_hi, world.time_lo, ball.hi, ball.lo)
    return (
        moved(ball.x, ball.vx, gx, t),
        moved(ball.y, ball.vy, gy, t),
        sped(ball.vx, gx, t),
        sped(ball.vy, gy, t),
    )


@function
def paddle_now(state: State, tables: Tables, paddles: Table, rails: Table, w: int, m: int) -> tuple[float, float]:
    """Where the centre of paddle `m` is now: (x, y) [m]; (nan, nan) where there are no paddles."""
    if paddles is None or rails is None:
        return math.nan, math.nan
    world = state.worlds[w]
    rail = rails[world.scene, m]
    offset = rail_offset(paddles[w, m], world.time_hi, world.time_lo)
    return rail.x + offset * rail.ux, rail.y + offset * rail.uy


@kernel
def view(state: State, tables: Tables, w: int, balls: Array, paddles: Array) -> None:
    """Write the balls (k, 4): x, y [m], vx, vy [m/s], and the centres of the paddles (m, 2) [m] of world `w`."""
    for k in range(balls.shape[0]):
        balls[k, 0], balls[k, 1], balls[k, 2], balls[k, 3] = ball_now(state, tables, w, k)
    for m in range(paddles.shape[0]):
        paddles[m, 0], paddles[m, 1] = paddle_now(state, tables, state.paddles, tables.rails, w, m)
