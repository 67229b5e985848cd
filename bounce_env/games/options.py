"""What a user may choose of every game."""

from os import PathLike
from typing import Annotated, Literal, Self

from pydantic import ConfigDict, Field, InstanceOf, StrictInt, model_validator
from pydantic.dataclasses import dataclass

from bounce_env.games.episode import FPS
from bounce_env.games.levels import END_OF_LEVELS
from bounce_env.scene import Scene

CONFIG = ConfigDict(arbitrary_types_allowed=True)


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class Options:
    """What all games have in common; see the cards in `bounce_env.cards`. Raises ValueError for what is not allowed."""

    scene: str | PathLike[str] | InstanceOf[Scene] | None = None
    frame_skip: Annotated[StrictInt, Field(ge=1, le=FPS)] = 2
    repeat_action_probability: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] = 0.0
    time_limit: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class PaddleOptions(Options):
    """Of the paddle game."""

    action: Literal["continuous", "discrete"] = "continuous"
    reward: Literal["score", "dense"] = "score"
    gamma: Annotated[float, Field(strict=True, gt=0.0, le=1.0)] = 0.99
    time_limit: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None = 120.0
    num_levels: Annotated[StrictInt, Field(ge=0, le=END_OF_LEVELS)] | None = None
    start_level: Annotated[StrictInt, Field(ge=0, lt=END_OF_LEVELS)] = 0

    @model_validator(mode="after")
    def _check_levels(self) -> Self:
        if self.num_levels is None and self.start_level > 0:
            raise ValueError(f"start_level = {self.start_level}: must be 0 where num_levels is None")
        if self.start_level + (self.num_levels or 0) > END_OF_LEVELS:
            raise ValueError(
                f"num_levels = {self.num_levels}: with start_level = {self.start_level} it must be at most "
                f"{END_OF_LEVELS - self.start_level}"
            )
        return self


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class PinballOptions(Options):
    """Of the pinball game."""

    action: Literal["discrete", "buttons"] = "discrete"
    reward: Literal["dense", "score"] = "dense"
    nudge: Annotated[bool, Field(strict=True)] = False
    balls: Annotated[StrictInt, Field(ge=1, le=9)] = 3
    time_limit: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None = 120.0


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class WallsOptions(Options):
    """Of the game of walls."""

    reward: Literal["sparse", "dense"] = "sparse"
    gamma: Annotated[float, Field(strict=True, gt=0.0, le=1.0)] = 0.99
    balls: Annotated[StrictInt, Field(ge=1, le=9)] = 5
    time_limit: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None = 90.0
