"""What a scene is made of: frozen, validated specs in SI units (metres, seconds; y points up).

Every spec checks its own fields when it is made; what is wrong raises `pydantic.ValidationError` (a
ValueError) that names class, field, value and what is allowed. Numbers may be Python's or NumPy's, points a
tuple, list or array of two; they are kept as float and tuple[float, float]. Text and bools are not numbers.

The law of a bounce is the tutorial's (chapter "Bounce", section "Real bounce and friction"): of the velocity
relative to the surface, the part along the normal is reversed and multiplied by ball.b * element.b, the part
along the surface is multiplied by ball.f * element.f.
"""

import math
from collections.abc import Iterable
from dataclasses import KW_ONLY
from typing import Any, Self, TypeAlias

from pydantic import (
    ConfigDict,
    ModelWrapValidatorHandler,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic.dataclasses import dataclass

from bounce_env.scene.fields import (
    SMALLEST,
    Flag,
    Name,
    Positive,
    Vector,
    ZeroOrMore,
    ZeroOrPositive,
    ZeroToOne,
    explain,
    not_allowed,
)

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


@dataclass(frozen=True, config=CONFIG)
class Ball(Spec):
    """The ball: a disc, or with radius 0 the tutorial's point.

    radius: metres, 0 or more. b: bounciness, 0 or more. f: friction, 0 (all lost) to 1 (none).
    """

    radius: ZeroOrPositive = 0.0
    b: ZeroOrMore = 1.0
    f: ZeroToOne = 1.0


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class _Surface(Spec):
    """What all bouncing elements have in common."""

    b: ZeroOrMore = 1.0
    f: ZeroToOne = 1.0
    kick: ZeroOrMore = 0.0
    kick_threshold: ZeroOrMore = 0.0
    name: Name = ""


def union(boxes: Iterable[Box]) -> Box:
    """The box around all boxes, zeros if there are none."""
    sides = list(zip(*boxes, strict=True)) or [(0.0,)] * 4
    return min(sides[0]), min(sides[1]), max(sides[2]), max(sides[3])


def _away_from(start: str) -> Any:
    """Validator of a segment's last field: its two ends are two points."""

    def check(end: tuple[float, float], info: ValidationInfo) -> tuple[float, float]:
        other = info.data.get(start)  # absent if it was refused itself
        if other is not None and math.dist(other, end) < SMALLEST:
            raise not_allowed(f"at least {SMALLEST:g} m away from {start} = {list(other)}")
        return end

    return check


def box_of(points: tuple[tuple[float, float], ...], margin: float = 0.0) -> Box:
    xs, ys = zip(*points, strict=True)
    return min(xs) - margin, min(ys) - margin, max(xs) + margin, max(ys) + margin


@dataclass(frozen=True, config=CONFIG)
class Wall(_Surface):
    """A segment that bounces the ball on both sides and at its ends.

    start, end: its ends (x, y) in metres, two different points. b: bounciness, 0 or more. f: friction, 0 (all
    lost) to 1 (none). kick: speed in m/s added along the normal when the approach is faster than
    kick_threshold (m/s). name: unique in the scene, or "" for none.
    """

    start: Vector
    end: Vector

    _check_end = field_validator("end")(_away_from("start"))

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres."""
        return box_of((self.start, self.end))


@dataclass(frozen=True, config=CONFIG)
class Bumper(_Surface):
    """A circle that bounces the ball outside of it.

    center: (x, y) in metres. radius: metres, > 0. b, f, kick, kick_threshold, name: as for a `Wall`.
    """

    center: Vector
    radius: Positive

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres."""
        return box_of((self.center,), self.radius)


@dataclass(frozen=True, config=CONFIG)
class Paddle(_Surface):
    """A capsule that moves on a straight rail between two stops.

    rail_start, rail_end: where its centre stops, (x, y) in metres, two different points; it starts between
    them. half_width: how far its core, a segment parallel to the rail, reaches to each side of the centre,
    metres, 0 or more. radius: thickness around the core, metres, > 0; so it is 2 (half_width + radius) long.
    max_speed: of its centre along the rail, m/s, > 0. b, f, kick, kick_threshold, name: as for a `Wall`.
    """

    rail_start: Vector
    rail_end: Vector
    _: KW_ONLY
    half_width: ZeroOrPositive
    radius: Positive
    max_speed: Positive

    _check_rail_end = field_validator("rail_end")(_away_from("rail_start"))

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres of all that it can reach between its stops."""
        (x0, y0), (x1, y1) = self.rail_start, self.rail_end
        share = self.half_width / math.dist(self.rail_start, self.rail_end)
        dx, dy = share * (x1 - x0), share * (y1 - y0)
        return box_of(((x0 - dx, y0 - dy), (x1 + dx, y1 + dy)), self.radius)


@dataclass(frozen=True, config=CONFIG)
class Sensor(Spec):
    """A segment that reports when the ball's centre crosses it, and never bounces.

    start, end: its ends (x, y) in metres, two different points. drain: True takes the ball out of play there.
    name: unique in the scene, or "" for none.
    """

    start: Vector
    end: Vector
    _: KW_ONLY
    drain: Flag = False
    name: Name = ""

    _check_end = field_validator("end")(_away_from("start"))

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres."""
        return box_of((self.start, self.end))


Element: TypeAlias = Wall | Bumper | Paddle | Sensor
