"""What is fixed before a paddle game begins: options, constants, and what its functions know of a scene."""

import math
from typing import Annotated, Literal, NamedTuple, Self

import numpy as np
from pydantic import model_validator
from pydantic.dataclasses import dataclass

from bounce_env.engine.memory.records import Array, record
from bounce_env.engine.packing import segment_direction
from bounce_env.games.options import CONFIG, END_OF_LEVELS, Gamma, Options, TimeLimit, options_class, refuse
from bounce_env.games.paddle.levels import Levels, levels_of
from bounce_env.games.timing import Pace, pace_of
from bounce_env.scene import Arc, Bumper, Paddle, Scene, Sensor, Wall
from bounce_env.scene.fields import Allowed, one_of, whole_number


@options_class
@dataclass(frozen=True, kw_only=True, config=CONFIG)
class PaddleOptions(Options):
    """What a user may choose of the paddle game."""

    action: Annotated[Literal["continuous", "discrete"], one_of("continuous", "discrete")] = "continuous"
    reward: Annotated[Literal["score", "dense"], one_of("score", "dense")] = "score"
    gamma: Gamma = 0.99
    time_limit: TimeLimit = 120.0
    num_levels: Annotated[
        int | None,
        Allowed(f"None, or a whole number from 0 to {END_OF_LEVELS}", whole_number(0, END_OF_LEVELS, none=True)),
    ] = None
    start_level: Annotated[
        int, Allowed(f"a whole number from 0 to {END_OF_LEVELS - 1}", whole_number(0, END_OF_LEVELS - 1))
    ] = 0

    @model_validator(mode="after")
    def _check_levels(self) -> Self:
        if self.num_levels is None and self.start_level > 0:
            refuse("start_level", self.start_level, "0 where num_levels is None")
        if self.start_level + (self.num_levels or 0) > END_OF_LEVELS:
            most = END_OF_LEVELS - self.start_level
            refuse("num_levels", self.num_levels, f"at most {most} with start_level = {self.start_level}")
        return self


# The launch: place as shares of the field, so that it fits the scenes of users, too.
LAUNCH_X = (0.2, 0.8)
LAUNCH_Y = 0.4
LAUNCH_SPEED = 1.5  # m/s
LAUNCH_ANGLE = (math.radians(30.0), math.radians(150.0))
REFERENCE_SPEED = 2.0  # m/s; the speed that is observed as 1
POINTS = 1.0  # a bumper hit
OBSERVATION_SIZE = 5

FIELD = record(
    x="f8", width="f8", y="f8", height="f8",  # [m] lower left corner and size of what is observed as [-1, 1]
    x_scale="f8", y_scale="f8", rail_scale="f8",  # [1/m] from metres to the observation
    rail_ux="f8", rail_uy="f8",  # unit vector along the paddle's rail
    across="f8",  # [m] from corner to corner of the field
    paddle="i8", part="i8",  # its element, and which of the parts it is
)  # fmt: skip

# What is counted, in the order of `PaddleGame.counters`.
BUMPER_POINTS, TOUCHES = 0, 1


class Rules(NamedTuple):
    """What the kernel needs to know of the game beside the scene."""

    fields: Array  # (scenes,) FIELD
    levels: Levels
    points: Array  # (scenes, elements) float64: for a hit of each element
    pace: Pace
    shaping: float  # 1 where the reward is shaped by how far the paddle is from beneath the ball, otherwise 0
    gamma: float  # of the shaping


def field_of(scene: Scene) -> tuple[float, float, float, float]:
    """Lower left corner and size (x, y, width, height) [m] of the field: walls to the sides and above, drain below.

    Raises ValueError where the scene cannot be played: it must have exactly one paddle, a drain, a bumper, a ball with
    a radius and a `max_speed`.
    """
    walls = [e for e in scene.elements if isinstance(e, Wall | Arc)]
    drains = [e for e in scene.elements if isinstance(e, Sensor) and e.drain]
    paddles = sum(isinstance(e, Paddle) for e in scene.elements)
    needs = {
        f"paddles = {paddles}: must be exactly 1": paddles == 1,
        "drains = 0: must be at least 1 (a sensor with drain = true)": drains,
        "bumpers = 0: must be at least 1": any(isinstance(e, Bumper) for e in scene.elements),
        "walls = 0: must be at least 1": any(isinstance(e, Wall) for e in walls),
        "ball.radius = 0.0: must be > 0": scene.ball.radius > 0.0,
        "max_speed = None: must be given": scene.max_speed is not None,
    }
    problems = [words for words, met in needs.items() if not met]
    if problems:
        raise ValueError("a scene for the paddle game: " + "; ".join(problems))
    left, right = min(w.bounds[0] for w in walls), max(w.bounds[2] for w in walls)
    below, above = min(d.bounds[1] for d in drains), max(w.bounds[3] for w in walls)
    return left, below, right - left, above - below


def new_rules(scene: Scene, options: PaddleOptions) -> Rules:
    """Return the rules for one world that plays `scene`; see `field_of` for what it must have."""
    field = field_of(scene)
    x, y, width, height = field
    paddle = next(i for i, e in enumerate(scene.elements) if isinstance(e, Paddle))
    rail = scene.elements[paddle]
    assert isinstance(rail, Paddle)
    ux, uy, span = segment_direction(rail.rail_start, rail.rail_end)
    part = [i for i, _ in scene.parts].index(paddle)
    across = math.sqrt(width * width + height * height)
    seen = (x, width, y, height, 2.0 / width, 2.0 / height, 2.0 / span, ux, uy, across, paddle, part)
    return Rules(
        np.array([seen], FIELD),
        levels_of(scene, field, options.num_levels, options.start_level),
        np.array([[POINTS * isinstance(e, Bumper) for e in scene.elements]]),
        pace_of(options),
        float(options.reward == "dense"),
        options.gamma,
    )
