"""How a game goes through time: what the rules of all games have in common."""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import Record, function
from bounce_env.games.episode import FPS
from bounce_env.games.options import Options

MAX_EVENTS = 10_000
"""In one step or frame; more end the episode. A ball that all but stands on the end of a wall leaves it in more than a
thousand tiny hops."""

NO_STEP_LIMIT = 2**62
"""More steps than any episode has."""


class Pace(NamedTuple):
    """What a kernel needs to know of how a game goes through time; docs/own_game.md.

    fps: frames a second. frame_skip: frames of a step. limit: frames after which an episode is truncated, inf for
    never. repeat: probability per frame that the last action is repeated. max_events: in one run of the event loop.
    steps: after which an episode is truncated.
    """

    fps: float
    frame_skip: int
    limit: float
    repeat: float
    max_events: int
    steps: int


def pace_of(options: Options) -> Pace:
    """Return the pace that a user chose by `options`; docs/own_game.md. Raises nothing."""
    limit = math.inf if options.time_limit is None else float(round(options.time_limit * FPS))
    return Pace(float(FPS), options.frame_skip, limit, options.repeat_action_probability, MAX_EVENTS, NO_STEP_LIMIT)


@function
def out_of_time(episode: Record, pace: Pace) -> bool:
    """Return whether an episode has come to the time limit of its pace, or to that of its steps."""
    return episode.frames >= pace.limit or episode.steps >= pace.steps
