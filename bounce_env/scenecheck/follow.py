"""The kernel that follows balls, one after the other and each alone in its world, from their starts to their ends.

All that is compiled here is in this file: the binary that is kept on disk is checked against it.
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import function, kernel
from bounce_env.engine.events.flights import place
from bounce_env.engine.events.loop import BUDGET_SPENT, DONE, clear_hits, restart, resume, run
from bounce_env.engine.memory.records import CRUSHED, HELD, OUT, Array, record
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.readout import ball_now

# How a ball ends.
DRAINED, RESTS, ENDLESS, LEFT, STUCK, CRUSHES, RATTLES, PLAYING = 0, 1, 2, 3, 4, 5, 6, 7

FATE = record(
    end="i8",
    time="f8", x="f8", y="f8", vx="f8", vy="f8",  # [s], [m], [m/s] at its end
    run="i8",  # how often it scored at most without coming within reach of the agent
    reached="f8",  # [s] when it was last within reach; -1 for never
    scored="i8",  # how often it scored in all
    events="i8",
)  # fmt: skip

# A ball is where it was while it is no farther away, for at least so many events.
EVENTS_IN_PLACE = 8


class Watch(NamedTuple):
    """What is looked for. Arrays are by element, those of `reach.with_borders`; `boxes` are `reach.reach_boxes`."""

    scoring: Array  # (elements,) int8
    borders: Array  # (elements,) int8: the sides of boxes
    boxes: Array  # (parts, 4) [m]
    bounds: tuple[float, float, float, float]  # [m] of the scene
    seconds: float  # that a ball is followed
    limit: int  # scores without coming within reach after which a ball is followed no longer
    near: float  # [m] a ball that moves no farther stays in its place
    still: float  # [s] for which it does so before it rests
    fps: float  # frames of a game a second
    budget: int  # events in a frame, of which more end a game


@function
def _is_inside(boxes: Array, x: float, y: float) -> bool:
    inside = False
    for i in range(boxes.shape[0]):
        inside = inside or (boxes[i, 0] <= x <= boxes[i, 2] and boxes[i, 1] <= y <= boxes[i, 3])
    return inside


@function
def _look(state: State, watch: Watch, w: int, fate: Any, seen: Array, streak: int) -> int:
    """Note what the last event touched; returns the scores since it was within reach, -1 where it came so."""
    came = False
    if state.worlds[w].dirty:
        for element in range(state.hits.shape[1]):
            hits = state.hits[w, element]
            if hits > 0:
                seen[element] = 1
                came = came or watch.borders[element] > 0
                if watch.scoring[element] > 0:
                    streak += hits
                    fate.scored += hits
        clear_hits(state, w)
    return -1 if came else streak


@function
def _follow(state: State, watch: Watch, w: int, start: Array, fate: Any, seen: Array) -> None:
    """Follow one ball from `start` (x, y, vx, vy) and write down its fate and the elements that it has touched."""
    world, ball = state.worlds[w], state.balls[w, 0]
    restart(state, w)
    place(state, w, 0, start[0], start[1], start[2], start[3])
    streak, step, in_step = 0, 0, 0
    x, y, since, in_place = start[0], start[1], 0.0, 0  # where it is, from when on and for how many events
    fate.end, fate.run, fate.scored, fate.events = PLAYING, 0, 0, 0
    fate.reached = 0.0 if _is_inside(watch.boxes, x, y) else -1.0
    code = BUDGET_SPENT
    while code != DONE and fate.end == PLAYING:
        resume(state, w)
        code = run(state, w, watch.seconds, 0.0, 1)
        fate.events += 1
        fate.x, fate.y, fate.vx, fate.vy = ball_now(state, w, 0)
        fate.time = world.time_hi
        streak = _look(state, watch, w, fate, seen, streak)
        if streak < 0 or _is_inside(watch.boxes, fate.x, fate.y):
            streak, fate.reached = 0, fate.time
        fate.run = max(fate.run, streak)
        if (fate.x - x) ** 2 + (fate.y - y) ** 2 > watch.near**2:
            x, y, since, in_place = fate.x, fate.y, fate.time, 0
        if int(fate.time * watch.fps) != step:
            step, in_step = int(fate.time * watch.fps), 0
        in_place, in_step = in_place + 1, in_step + 1
        stays = fate.time - since >= watch.still and (in_place > EVENTS_IN_PLACE or ball.contact == HELD)
        fate.end = _end(watch, ball, streak, stays, in_step)
    if fate.end == PLAYING:
        fate.end = _end_in_time(watch, ball, fate)


@function
def _end(watch: Watch, ball: Any, streak: int, stays: bool, in_step: int) -> int:
    """Return how the ball ended with its last event; PLAYING where it goes on."""
    if ball.status == OUT:
        return DRAINED
    if ball.status == CRUSHED:
        return CRUSHES
    if streak > watch.limit:
        return ENDLESS
    if stays:
        return RESTS
    return RATTLES if in_step > watch.budget else PLAYING


@function
def _end_in_time(watch: Watch, ball: Any, fate: Any) -> int:
    """Return what a ball comes to that goes on for as long as it is followed."""
    left, bottom, right, top = watch.bounds
    if ball.contact == HELD:
        return RESTS
    if not (left <= fate.x <= right and bottom <= fate.y <= top):
        return LEFT
    return STUCK if fate.reached < 0.5 * watch.seconds else PLAYING


@kernel
def follow_balls(
    state: State, watch: Watch, w: int, starts: Array, fates: Array, touched: Array, freely: Array
) -> None:
    """Follow the balls of `starts` (balls, 4) in world `w`, into `fates` (balls,) FATE.

    touched: (elements,) by how many balls; freely: by how many of those that also drained or came within reach. Both
    are added to.
    """
    seen = np.zeros(touched.shape[0], np.int8)
    for i in range(starts.shape[0]):
        seen[:] = 0
        _follow(state, watch, w, starts[i], fates[i], seen)
        free = fates[i].end == DRAINED or fates[i].reached >= 0.0
        for element in range(seen.shape[0]):
            touched[element] += seen[element]
            freely[element] += seen[element] if free else 0


Fates = npt.NDArray[Any]
"""Records of FATE, (balls,)."""
