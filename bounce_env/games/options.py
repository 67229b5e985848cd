"""What a user may choose of every game."""

from os import PathLike
from typing import Annotated, Literal

from pydantic import ConfigDict, Field, InstanceOf, StrictInt
from pydantic.dataclasses import dataclass

from bounce_env.games.episode import FPS
from bounce_env.scene import Scene

CONFIG = ConfigDict(arbitrary_types_allowed=True)


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class Options:
    """What all games have in common; see the cards in `bounce_env.env`. Raises ValueError for what is not allowed."""

    scene: str | PathLike[str] | InstanceOf[Scene]
    frame_skip: Annotated[StrictInt, Field(ge=1, le=FPS)] = 2
    repeat_action_probability: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] = 0.0
    time_limit: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class PaddleOptions(Options):
    """Of the paddle game."""

    scene: str | PathLike[str] | InstanceOf[Scene] = "paddle"
    action: Literal["continuous", "discrete"] = "continuous"
    time_limit: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None = 60.0


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class PinballOptions(Options):
    """Of the pinball game."""

    scene: str | PathLike[str] | InstanceOf[Scene] = "pinball"
    action: Literal["discrete", "buttons"] = "discrete"
    nudge: Annotated[bool, Field(strict=True)] = False
    balls: Annotated[StrictInt, Field(ge=1, le=9)] = 3
    time_limit: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None = 120.0
