"""What a user may choose of every game."""

import math
import os
from collections.abc import Mapping
from typing import Annotated, Any, TypeVar

from pydantic import ConfigDict, ValidationError
from pydantic.dataclasses import dataclass
from pydantic_core import InitErrorDetails

from bounce_env.games.episode import FPS
from bounce_env.scene import Scene
from bounce_env.scene.base import Spec
from bounce_env.scene.errors import own_words
from bounce_env.scene.fields import Allowed, instance_of, not_allowed, real_number, true_or_false, whole_number

_Spec = TypeVar("_Spec")

CONFIG = ConfigDict(arbitrary_types_allowed=True, extra="forbid")
"""Pydantic's configuration of all options: `@dataclass(frozen=True, kw_only=True, config=CONFIG)`."""

LONGEST_TIME = 1e9
"""Seconds of play that may be asked for: about thirty years."""

END_OF_LEVELS = 2**31
"""The first number that is no level."""

_in_own_words = own_words(lambda text, problems: ValueError(text), named=False)


def options_class(spec: type[_Spec]) -> type[_Spec]:
    """Decorate the class `spec` of a game's options, a pydantic dataclass: it raises ValueError in our own words.

    docs/own_game.md shows one.
    """
    return _in_own_words(spec)


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
"""The type of the option `time_limit`: seconds of play, > 0, or None for no limit."""

Gamma = Annotated[float, Allowed("a number > 0 and <= 1", _gamma)]
Balls = Annotated[int, Allowed("a whole number from 1 to 9", whole_number(1, 9))]
FrameSkip = Annotated[int, Allowed(f"a whole number from 1 to {FPS}", whole_number(1, FPS))]
Flag = Annotated[bool, Allowed("True or False", true_or_false)]


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class Options(Spec):
    """What all games have in common; see their cards, and docs/own_game.md.

    Raises ValueError for what is not allowed.
    """

    scene: Annotated[Any, Allowed(_SOURCE, instance_of(str | os.PathLike | Scene | Mapping | None))] = None
    frame_skip: FrameSkip = 2
    repeat_action_probability: Annotated[float, Allowed(_PROBABILITY, _probability)] = 0.0
    time_limit: TimeLimit


def refuse(field: str, value: object, words: str) -> None:
    """Raise, in a validator of options, that a field must be what `words` say."""
    details = InitErrorDetails(type=not_allowed(words), loc=(field,), input=value)
    raise ValidationError.from_exception_data("Options", [details])
