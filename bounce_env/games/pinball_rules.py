"""What the kernels of the pinball game know and remember: rules, memory, counters, and the spans of its clock."""

from typing import Any, NamedTuple

from bounce_env.engine.compile.jit import function
from bounce_env.engine.memory.records import record
from bounce_env.games.episode import FPS
from bounce_env.games.pace import Pace
from bounce_env.games.table import Layout

LAUNCH_FRAMES = 3 * FPS  # after which a ball counts as in play wherever it is
SAVE_FRAMES = 5 * FPS  # a ball that is lost so soon is given back, once
HOLD_FRAMES = 2 * FPS  # in the flippers' zone, after which both are released until the ball leaves it
REST_FRAMES = 18  # after a button is let go: until then it does not act again
STUCK_FRAMES = 10 * FPS  # without a hit of a flipper, or one that gives points: the ball is shot again

# Buttons, as bits of the action's code.
LEFT, RIGHT, NUDGE_LEFT, NUDGE_RIGHT = 1, 2, 4, 8
NUDGE = (0.25, 0.15)  # m/s to the side and up
NUDGE_FRAMES = FPS // 4  # after which the next one may follow
NUDGE_COST = 1.0  # of the tilt meter, which shows 3 at a tilt
TILT, TILT_PER_FRAME = 3.0, 0.5 / FPS

# What is counted, in the order of `PinballGame.counters`.
BY_BUMPERS, BY_SLINGSHOTS, BY_TARGETS, BY_ROLLOVERS = 0, 1, 2, 3
BANKS, TOUCHES, FLIPS, SAVES, STUCK_FREED, HOLD_RELEASED, NUDGES, TILTS = 4, 5, 6, 7, 8, 9, 10, 11

MEMORY = record(
    lit="i8", passed="i8",  # bits: targets that are lit, rollovers that are not any more
    multiplier="i8",
    farmed="i8",  # hits of bumpers and slingshots since a flipper touched the ball
    launches="i8",  # of the ball that is played
    saved="i8",  # whether this ball has been given back
    serving="i8",  # whether it is on its way out of the lane, or about to be
    shot="i8", born="i8",  # frames in which it was shot and came into play
    zone="i8",  # frame in which it came into the flippers' zone; -1 outside
    scored="i8",  # frame of the last hit that gave points, or of a flipper
    pressed="i8",  # buttons in force
    left_ready="i8", right_ready="i8",  # frames from which the buttons act again
    tilt="f8", tilted="i8",  # the tilt meter, and whether the flippers are dead for this ball
    nudged="i8",  # frame of the last nudge
)  # fmt: skip

# `serving`: the ball is played, is to be shot, is in the lane.
NO, DUE, SHOT = 0, 1, 2


class Rules(NamedTuple):
    """What the kernel needs to know of the game beside the scene."""

    layout: Layout
    pace: Pace
    balls: int
    nudge: int  # 1 where the table can be nudged
    loss: float  # reward for a ball that is lost, 0 or less


@function
def save_left(memory: Any, frame: int) -> int:
    """Frames for which a ball that is lost is given back."""
    return 0 if memory.saved else max(SAVE_FRAMES - (frame - memory.born), 0)


@function
def rest_left(memory: Any, frame: int, side: int) -> int:
    """Frames until the button LEFT or RIGHT acts again."""
    ready = memory.left_ready if side == LEFT else memory.right_ready
    return max(ready - frame, 0)


@function
def hold_timer(memory: Any, frame: int) -> int:
    """Frames that the ball has been in the flippers' zone, at most those after which they are released."""
    return 0 if memory.zone < 0 else min(frame - memory.zone, HOLD_FRAMES)
