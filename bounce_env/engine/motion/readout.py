"""Where things are now: the state of a world evaluated at its present time."""

import math

from bounce_env.engine.compile.jit import function, kernel, where
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.parts import moving_part, part_core_at, part_offset_at
from bounce_env.engine.motion.path import motion_after


@function
def ball_now(state: State, w: int, k: int) -> tuple[float, float, float, float]:
    """Return where ball `k` is now and how fast: x, y [m], vx, vy [m/s].

    A drained ball stays where it crossed the drain.
    """
    ball, world = state.balls[w, k], state.worlds[w]
    if ball.status == OUT:
        return ball.x, ball.y, ball.vx, ball.vy
    return motion_after(state, w, k, since(world.time_hi, world.time_lo, ball.hi, ball.lo))


@where("parts", otherwise=(math.nan, math.nan, math.nan, math.nan))
def core_now(state: State, w: int, m: int) -> tuple[float, float, float, float]:
    """Return where the two ends of part `m`'s core are now: x, y, x, y [m]; NaN where there are no parts."""
    world = state.worlds[w]
    core = part_core_at(moving_part(state, w, m), world.time_hi, world.time_lo)
    return (
        core.x + core.back * core.ux,
        core.y + core.back * core.uy,
        core.x + core.front * core.ux,
        core.y + core.front * core.uy,
    )


@where("parts", otherwise=0.0)
def offset_now(state: State, w: int, m: int) -> float:
    """Return where part `m` is on its way now, from its first stop: [m], or [rad] of a flipper."""
    return part_offset_at(state.motions[w, m], state.worlds[w].time_hi, state.worlds[w].time_lo)


@where("parts", otherwise=0.0)
def stroke_now(state: State, w: int, m: int) -> float:
    """Return how far part `m` is on its way now, as a share of that from stop to stop.

    Rounding may leave it just beyond 0 or 1.
    """
    return offset_now(state, w, m) / state.parts[state.worlds[w].scene, m].span


@function
def view_world(state: State, w: int, balls: Array, cores: Array) -> None:
    """Write the balls (k, 4): x, y [m], vx, vy [m/s], and the ends of the parts' cores (m, 4) [m] of world `w`.

    Of a scene that has fewer parts than `cores` has rows, only those.
    """
    for k in range(balls.shape[0]):
        balls[k, 0], balls[k, 1], balls[k, 2], balls[k, 3] = ball_now(state, w, k)
    for m in range(min(cores.shape[0], state.scenes[state.worlds[w].scene].parts)):
        cores[m, 0], cores[m, 1], cores[m, 2], cores[m, 3] = core_now(state, w, m)


@kernel
def view(state: State, w: int, balls: Array, cores: Array) -> None:
    """As `view_world`, from Python."""
    view_world(state, w, balls, cores)


@kernel
def view_worlds(state: State, worlds: Array, balls: Array, cores: Array) -> None:
    """Write the same of several worlds, (n,): into balls (n, k, 4) and cores (n, m, 4)."""
    for i in range(worlds.shape[0]):
        view_world(state, worlds[i], balls[i], cores[i])
