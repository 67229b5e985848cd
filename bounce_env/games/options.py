"""What a user may choose of every game."""

import math
import os
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import ConfigDict, ValidationError, model_validator
from pydantic.dataclasses import dataclass
from pydantic_core import InitErrorDetails

from bounce_env.games.episode import FPS
from bounce_env.games.levels import END_OF_LEVELS
from bounce_env.scene import Scene
from bounce_env.scene.base import Spec
from bounce_env.scene.errors import own_words
from bounce_env.scene.fields import Allowed, instance_of, not_allowed, one_of, real_number, true_or_false, whole_number

CONFIG = ConfigDict(arbitrary_types_allowed=True, extra="forbid")

LONGEST_TIME = 1e9
"""Seconds of play that may be asked for: about thirty years."""

options = own_words(lambda text, problems: ValueError(text), named=False)
"""The decorator of all options."""

_SOURCE = "None, the name of a built-in scene, the path of a .toml file, a Scene, or a dict of one"
_PROBABILITY = "a number >= 0 and < 1"
_SECONDS = f"None, or a number > 0 and <= {LONGEST_TIME:g} (seconds)"


def _time_limit(value: object) -> float | None:
    return None if value is None else real_number(value, math.ulp(0.0), LONGEST_TIME)


def _probability(value: object) -> float:
    return real_number(value, 0.0, math.nextafter(1.0, 0.0))


def _gamma(value: object) -> float:
    return real_number(value, math.ulp(0.0), 1.0)


TimeLimit = Annotated[float | None, Allowed(_SECONDS, _time_limit)]
Gamma = Annotated[float, Allowed("a number > 0 and <= 1", _gamma)]
Balls = Annotated[int, Allowed("a whole number from 1 to 9", whole_number(1, 9))]
Flag = Annotated[bool, Allowed("True or False", true_or_false)]


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class Options(Spec):
    """What all games have in common; see the cards in `bounce_env.cards`. Raises ValueError for what is not allowed."""

    scene: Annotated[Any, Allowed(_SOURCE, instance_of(str | os.PathLike | Scene | Mapping | None))] = None
    frame_skip: Annotated[int, Allowed(f"a whole number from 1 to {FPS}", whole_number(1, FPS))] = 2
    repeat_action_probability: Annotated[float, Allowed(_PROBABILITY, _probability)] = 0.0
    time_limit: TimeLimit


@options
@dataclass(frozen=True, kw_only=True, config=CONFIG)
class PaddleOptions(Options):
    """Of the paddle game."""

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


@options
@dataclass(frozen=True, kw_only=True, config=CONFIG)
class PinballOptions(Options):
    """Of the pinball game."""

    action: Annotated[Literal["discrete", "buttons"], one_of("discrete", "buttons")] = "discrete"
    reward: Annotated[Literal["dense", "score"], one_of("dense", "score")] = "dense"
    nudge: Flag = False
    balls: Balls = 3
    time_limit: TimeLimit = 120.0


@options
@dataclass(frozen=True, kw_only=True, config=CONFIG)
class WallsOptions(Options):
    """Of the game of walls."""

    reward: Annotated[Literal["sparse", "dense"], one_of("sparse", "dense")] = "sparse"
    gamma: Gamma = 0.99
    balls: Balls = 5
    time_limit: TimeLimit = 90.0


def refuse(field: str, value: object, words: str) -> None:
    """Raise, in a validator of options, that a field must be what `words` say."""
    details = InitErrorDetails(type=not_allowed(words), loc=(field,), input=value)
    raise ValidationError.from_exception_data("Options", [details])
