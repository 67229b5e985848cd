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
    """What a kernel needs to know of it."""

    fps: float
    frame_skip: int
    limit: float  # frames after which an episode is truncated; inf for never
    repeat: float  # probability per frame that the last action is repeated
    max_events: int  # in one run of the event loop
    steps: int  # after which an episode is truncated


def pace_of(options: Options) -> Pace:
    """As the user chose it."""
    limit = math.inf if options.time_limit is None else float(round(options.time_limit * FPS))
    return Pace(float(FPS), options.frame_skip, limit, options.repeat_action_probability, MAX_EVENTS, NO_STEP_LIMIT)


@function
def out_of_time(episode: Record, pace: Pace) -> bool:
    """Return whether an episode has come to its time limit, or to that of its steps."""
    return episode.frames >= pace.limit or episode.steps >= pace.steps
