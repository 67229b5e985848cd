"""What is fixed before a game of walls begins: options, constants, and what its functions know of a scene."""

import math
from collections.abc import Iterator
from typing import Annotated, Literal, NamedTuple

import numpy as np
from pydantic.dataclasses import dataclass

from bounce_env.engine.memory.records import Array, record
from bounce_env.engine.placement import element_gaps, part_cores_at_start
from bounce_env.games.episode import FPS
from bounce_env.games.options import CONFIG, Balls, Gamma, Options, TimeLimit, options_class
from bounce_env.games.timing import Pace, pace_of
from bounce_env.scene import Arc, Element, Scene, Sensor, Wall
from bounce_env.scene.errors import describe_element
from bounce_env.scene.fields import one_of
from bounce_env.wording import at_least, at_most


@options_class
@dataclass(frozen=True, kw_only=True, config=CONFIG)
class WallsOptions(Options):
    """What a user may choose of the game of walls."""

    reward: Annotated[Literal["sparse", "dense"], one_of("sparse", "dense")] = "sparse"
    gamma: Gamma = 0.99
    balls: Balls = 5
    time_limit: TimeLimit = 90.0


# The launch: place as shares of the field, so that it fits the scenes of users, too.
LAUNCH_X = (0.2, 0.8)
LAUNCH_Y = 0.9
LAUNCH_SPEED = 0.5  # m/s, level: at most so much to either side
WALL_SPEED = 1.0  # m/s; of each end along x and along y
LONGEST = 4.0  # times the wall's least length
SLACK = 1.0 + 1e-9  # by which it may be longer at first, for the rounding of both
BALL_FRAMES = 8 * FPS  # that a ball is played
REFERENCE_SPEED = 2.0  # m/s; the speed that is observed as 1
TARGET_CLEAR = 0.25  # of the field's diagonal: a target is no nearer to where its ball is launched
TRIES = 128  # places drawn for a target, of which the last one stands whatever leads to it
OBSERVATION_SIZE = 12
CONTROLS = 4

COURT = record(
    x="f8", y="f8", width="f8", height="f8",  # [m] lower left corner and size of what is observed as [-1, 1]
    x_scale="f8", y_scale="f8",  # [1/m] from metres to the observation
    across="f8",  # [m] from corner to corner
    target="i8", ring="i8",  # its element, and which of the circular sensors it is
    wall="i8", part="i8",  # what is dragged: its element, and which of the parts it is
    longest="f8",  # [m] that it may be
)  # fmt: skip
MEMORY = record(born="i8")  # the frame in which the present ball was launched

# What is counted, in the order of `WallsGame.counters`.
TARGETS, DRAINED, TIMED_OUT, CRUSHED, TOUCHES, SUCCESS = 0, 1, 2, 3, 4, 5


class Rules(NamedTuple):
    """What the kernel needs to know of the game beside the scene."""

    courts: Array  # (scenes,) COURT
    pace: Pace
    balls: int
    shaping: float  # 1 where the reward is shaped by the distance to the target, otherwise 0
    gamma: float  # of the shaping


def new_rules(scene: Scene, options: WallsOptions) -> Rules:
    """The rules for one world that plays `scene`; raises ValueError, with all that is wrong, where it cannot be."""
    problems = list(problems_of(scene))
    if problems:
        raise ValueError("a scene for the game of walls: " + "; ".join(problems))
    x, y, width, height = field_of(scene)
    target = next(i for i, e in enumerate(scene.elements) if is_target(e))
    rings = [i for i, e in enumerate(scene.elements) if isinstance(e, Sensor) and e.circle is not None]
    wall = next(i for i, e in enumerate(scene.elements) if is_dragged(e))
    court = (
        x, y, width, height, 2.0 / width, 2.0 / height, math.sqrt(width * width + height * height),
        target, rings.index(target), wall, [i for i, _ in scene.parts].index(wall), longest(dragged_wall(scene)),
    )  # fmt: skip
    return Rules(
        np.array([court], COURT),
        pace_of(options),
        options.balls,
        float(options.reward == "dense"),
        options.gamma,
    )


def is_target(element: Element) -> bool:
    """Return whether an element is what balls are to be brought to."""
    return element.name == "target"


def is_dragged(element: Element) -> bool:
    """Return whether an element is the wall that the player drags."""
    return isinstance(element, Wall) and element.draggable


def dragged_wall(scene: Scene) -> Wall:
    """Return the wall that the player drags."""
    return next(e for e in scene.elements if isinstance(e, Wall) and is_dragged(e))


def longest(wall: Wall) -> float:
    """Return how long [m] the player's wall may be."""
    return LONGEST * wall.shortest


def problems_of(scene: Scene) -> Iterator[str]:
    """Return why a scene cannot be played."""
    walls = [e for e in scene.elements if isinstance(e, Wall) and not e.draggable]
    dragged = [e for e in scene.elements if isinstance(e, Wall) and e.draggable]
    target = next(filter(is_target, scene.elements), None)
    needs = {
        f"draggable walls = {len(dragged)}: must be exactly 1": len(dragged) == 1,
        '"target": must name a circular sensor with drain = true': (
            isinstance(target, Sensor) and target.drain and target.circle is not None
        ),
        'drains = 0: must be at least 1 (a sensor with drain = true) beside the "target"': any(
            isinstance(e, Sensor) and e.drain and not is_target(e) for e in scene.elements
        ),
        "walls = 0: must be at least 1 that is not draggable": bool(walls),
        "ball.radius = 0.0: must be > 0": scene.ball.radius > 0.0,
        "max_speed = None: must be given": scene.max_speed is not None,
        f"gravity = {scene.gravity!r}: must not be zero": scene.gravity != (0.0, 0.0),
    }
    wrong = [words for words, met in needs.items() if not met]
    yield from wrong
    for wall in dragged:
        yield from _problems_of_wall(scene, wall)
    if not wrong:
        yield from _problems_of_field(scene)


def _problems_of_wall(scene: Scene, wall: Wall) -> Iterator[str]:
    speed = math.sqrt(2.0) * 2.0 * WALL_SPEED
    if scene.max_speed is not None and scene.max_speed < speed:
        least = at_least(speed, 6)
        yield f"max_speed = {scene.max_speed!r}: must be at least {least}, faster than the ends of the wall"
    if wall.reach is None:
        yield "reach = None: the draggable wall must have one"
    length = math.dist(wall.start, wall.end)
    if length > SLACK * longest(wall):
        least = at_least(length / (SLACK * LONGEST), 6)
        yield f"min_length = {wall.min_length!r}: must be at least {least}, a quarter of the wall's length"


def _problems_of_field(scene: Scene) -> Iterator[str]:
    x, y, width, height = field_of(scene)
    if not (width > 0.0 and height > 0.0):
        yield "drains: must be below the upper ends of the walls"
        return
    radius = target_radius(scene)
    if 2.0 * radius > min(width, height):
        yield f"radius = {radius!r} of the target: must be at most half of the field's width and height"
    for wall in filter(is_dragged, scene.elements):
        assert isinstance(wall, Wall)
        (x0, y0), (x1, y1) = wall.reach or ((x, y), (x, y))
        if min(x0, x1) < x or max(x0, x1) > x + width or min(y0, y1) < y or max(y0, y1) > y + height:
            where = f"x {at_least(x, 6)} to {at_most(x + width, 6)} and y {at_least(y, 6)} to {at_most(y + height, 6)}"
            yield f"reach = {wall.reach!r}: must be on the field, {where}"
    yield from sorted(set(_in_the_way(scene)))


def _in_the_way(scene: Scene) -> Iterator[str]:
    """Return what overlaps a ball somewhere where it may be launched.

    A gap changes by no more than the ball moves: it is looked at every half of the ball's radius, and has to be half
    of that there.
    """
    x, y, width, height = field_of(scene)
    step = 0.5 * scene.ball.radius
    first, last = x + LAUNCH_X[0] * width, x + LAUNCH_X[1] * width
    cores = part_cores_at_start(scene)
    for place in np.linspace(first, last, math.ceil((last - first) / step) + 1).tolist():
        for index, gap in element_gaps(scene, cores, place, y + LAUNCH_Y * height):
            if gap < 0.5 * step:
                yield (
                    f"{describe_element(scene.elements[index], index)}: must keep clear of where balls are launched, "
                    f"x {first:g} to {last:g} at y {y + LAUNCH_Y * height:g}"
                )


def target_radius(scene: Scene) -> float:
    """Return of the circle [m] that the ball's centre has to enter."""
    target = next(filter(is_target, scene.elements))
    assert isinstance(target, Sensor)
    assert target.circle is not None
    return target.circle[1]


def field_of(scene: Scene) -> tuple[float, float, float, float]:
    """Lower left corner and size (x, y, width, height) [m] of the field: standing walls around it, a drain below."""
    walls = [e for e in scene.elements if isinstance(e, Wall | Arc) and not is_dragged(e)]
    drains = [e for e in scene.elements if isinstance(e, Sensor) and e.drain and not is_target(e)]
    left, right = min(w.bounds[0] for w in walls), max(w.bounds[2] for w in walls)
    below, above = min(d.bounds[1] for d in drains), max(w.bounds[3] for w in walls)
    return left, below, right - left, above - below
