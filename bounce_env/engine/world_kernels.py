"""The entry points of `World` into compiled code; each works on world 0 of its state."""

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import kernel
from bounce_env.engine.events.commands import command, command_ends
from bounce_env.engine.events.crushing import free_all_crushed
from bounce_env.engine.events.flights import disturb, place
from bounce_env.engine.events.loop import begin_call, restart, run
from bounce_env.engine.events.part_stops import resume_part
from bounce_env.engine.memory.state import State

Floats = npt.NDArray[np.float64]

GO_ON = -1.0
"""In place of seconds: go on with the call before."""


@kernel
def world_reset(state: State, position: Floats, velocity: Floats) -> None:
    restart(state, 0)
    for k in range(position.shape[0]):
        place(state, 0, k, position[k, 0], position[k, 1], velocity[k, 0], velocity[k, 1])


@kernel
def world_advance(
    state: State, seconds: float, hi: float, lo: float, max_events: int, bounces: int
) -> tuple[int, float, float]:
    """Advance by `seconds`, or until there have been `bounces` since reset; with GO_ON to the instant (hi, lo).

    Returns how that ended, see `events.loop.run`, and the instant to go on to: (code, hi, lo).
    """
    if seconds != GO_ON:
        hi, lo = begin_call(state, 0, seconds)
    code: int = run(state, 0, hi, lo, max_events, bounces, True)
    return code, hi, lo


@kernel
def world_push_balls(state: State, dvx: float, dvy: float) -> None:
    for k in range(state.balls.shape[1]):
        disturb(state, 0, k, 1.0, dvx, dvy)


@kernel
def world_resolve_all(state: State) -> None:
    """Resolve every ball anew: an element has been switched on or off."""
    free_all_crushed(state, 0)
    for k in range(state.balls.shape[1]):
        disturb(state, 0, k, 1.0, 0.0, 0.0)


@kernel
def world_place_ball(state: State, k: int, x: float, y: float, vx: float, vy: float) -> None:
    place(state, 0, k, x, y, vx, vy)


@kernel
def world_command_part(state: State, part: int, velocity: float) -> None:
    command(state, 0, part, velocity)


@kernel
def world_command_wall(state: State, part: int, velocities: Floats) -> None:
    command_ends(state, 0, part, (velocities[0, 0], velocities[0, 1]), (velocities[1, 0], velocities[1, 1]))


@kernel
def world_resume_part(state: State, part: int) -> None:
    """Let a part move on as it was commanded to, before any flight is planned: no ball has to mind it yet."""
    resume_part(state, 0, part)
