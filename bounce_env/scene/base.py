"""What all specs share: the base class with its errors, and boxes around points."""

import math
from collections.abc import Iterable
from typing import Any, Self, TypeAlias

from pydantic import ConfigDict, ModelWrapValidatorHandler, ValidationError, ValidationInfo, model_validator
from pydantic.dataclasses import dataclass

from bounce_env.scene.fields import SMALLEST, explain, not_allowed

Point: TypeAlias = tuple[float, float]
"""x, y in metres."""

Box: TypeAlias = tuple[float, float, float, float]
"""x_min, y_min, x_max, y_max in metres."""

CONFIG = ConfigDict(extra="forbid")


@dataclass(frozen=True, config=CONFIG)
class Spec:
    """Base of all specs: its errors say of a missing and an unknown field, too, what is allowed."""

    @model_validator(mode="wrap")
    @classmethod
    def _explain(cls, value: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        try:
            return handler(value)
        except ValidationError as error:
            raise explain(error, cls) from None


def union(boxes: Iterable[Box]) -> Box:
    """Return the box around all boxes, zeros if there are none."""
    sides = list(zip(*boxes, strict=True)) or [(0.0,)] * 4
    return min(sides[0]), min(sides[1]), max(sides[2]), max(sides[3])


def box_of(points: Iterable[Point], margin: float = 0.0) -> Box:
    """Return the box around points, wider by `margin` on every side."""
    xs, ys = zip(*points, strict=True)
    return min(xs) - margin, min(ys) - margin, max(xs) + margin, max(ys) + margin


def away_from(start: str) -> Any:
    """Validator of a segment's last field: its two ends are two points."""

    def check(end: Point | None, info: ValidationInfo) -> Point | None:
        other = info.data.get(start)  # absent if it was refused itself
        if end is not None and other is not None and math.dist(other, end) < SMALLEST:
            raise not_allowed(f"at least {SMALLEST:g} m away from {start} = {list(other)}")
        return end

    return check
