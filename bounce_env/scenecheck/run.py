"""A survey: random balls in a scene with nobody doing anything, and what became of them."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.binding import bind
from bounce_env.engine.packing import pack
from bounce_env.games.episode import FPS
from bounce_env.games.timing import MAX_EVENTS
from bounce_env.scene import Bumper, Scene
from bounce_env.scenecheck.follow import FATE, Fates, Watch, follow_balls
from bounce_env.scenecheck.inside import inside_of
from bounce_env.scenecheck.reach import reach_boxes, scores, with_borders
from bounce_env.scenecheck.starts import random_starts

BALLS_AT_ONCE = 500
"""How many balls are followed between two reports of progress."""

ENDLESS_AT = 10
"""A ball that has scored so many times more often than it may without coming within reach is followed no longer."""

STILL = 10.0
"""A ball that stays in its place for so long [s] rests, unless a bumper that moves may still come by."""

SMALLEST_PLACE = 0.002
"""How far a ball of no radius may move in its place, as a share of the scene's longer side."""


@dataclass(frozen=True, eq=False)
class Survey:
    """What became of the balls. Rows of `starts` and `fates` are by ball, `touched` and `freely` by element.

    starts: (balls, 4) x, y [m], vx, vy [m/s]. fates: (balls,) records of `follow.FATE`. touched: how many balls touched
    the element; freely: how many of those that also drained or came within reach of a part that an agent moves.
    seconds: for which a ball was followed at most. limit: how often a ball may score without coming within reach.
    is_table: whether the scene has an inside, in which all balls started.
    """

    scene: Scene
    seconds: float
    limit: int
    is_table: bool
    starts: npt.NDArray[np.float64]
    fates: Fates
    touched: npt.NDArray[np.int64]
    freely: npt.NDArray[np.int64]


def survey(
    scene: Scene,
    *,
    balls: int,
    seed: int,
    seconds: float,
    limit: int = 20,
    progress: Callable[[int], Any] = lambda done: None,
) -> Survey:
    """Follow `balls` >= 1 random balls, each alone in the scene for up to `seconds` > 0 in which nobody does anything.

    The same seed gives the same survey, and the motion is that of `World(scene)` to the bit. limit: how often a ball
    may score without coming within reach, 1 or more. `progress` is told after every few hundred balls how many they
    were. Raises `starts.NoRoomError`.
    """
    inside = inside_of(scene)
    starts = random_starts(scene, inside, balls, seed)
    watched = with_borders(scene)
    state = bind(pack([watched]))
    watch = bind(_watch(scene, len(watched.elements), seconds, limit))
    fates = np.zeros(balls, FATE)
    touched, freely = np.zeros((2, len(watched.elements)), np.int64)
    for first in range(0, balls, BALLS_AT_ONCE):
        rows = slice(first, first + BALLS_AT_ONCE)
        follow_balls(state, watch, 0, starts[rows], fates[rows], touched, freely)
        progress(len(fates[rows]))
    own = len(scene.elements)
    return Survey(scene, seconds, limit, inside is not None, starts, fates, touched[:own], freely[:own])


def place_size(scene: Scene) -> float:
    """Return a ball that moves no farther than this [m] stays in its place."""
    left, bottom, right, top = scene.bounds
    return max(scene.ball.radius, SMALLEST_PLACE * max(right - left, top - bottom))


def _watch(scene: Scene, elements: int, seconds: float, limit: int) -> Watch:
    own = len(scene.elements)
    scoring = np.zeros(elements, np.int8)
    scoring[:own] = [scores(element) for element in scene.elements]
    return Watch(
        scoring=scoring,
        borders=(np.arange(elements) >= own).astype(np.int8),
        boxes=np.array(reach_boxes(scene), np.float64).reshape(-1, 4),
        bounds=scene.bounds,
        seconds=float(seconds),
        limit=ENDLESS_AT * limit,
        near=place_size(scene),
        still=max([STILL, *(_period(e) for e in scene.elements if isinstance(e, Bumper))]),
        fps=float(FPS),
        budget=MAX_EVENTS,
    )


def _period(bumper: Bumper) -> float:
    """Seconds after which a bumper is where it was, moving the same way; 0 of one that stands."""
    if bumper.rail_end is None or bumper.speed == 0.0:
        return 0.0
    return 2.0 * math.dist(bumper.center, bumper.rail_end) / bumper.speed
