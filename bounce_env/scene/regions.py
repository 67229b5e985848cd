"""What the ball passes through: sensors, which report it, and fields, which accelerate it."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import KW_ONLY
from typing import Self, TypeVar

from pydantic import ValidationError, field_validator, model_validator
from pydantic.dataclasses import dataclass
from pydantic_core import InitErrorDetails

from bounce_env.scene.base import CONFIG, Box, Point, Spec, away_from, box_of
from bounce_env.scene.errors import own_words_of_scenes
from bounce_env.scene.fields import (
    POINT_WORDS,
    POSITIVE_WORDS,
    SMALLEST,
    Flag,
    Name,
    Points,
    PositiveOrNone,
    Vector,
    VectorOrNone,
    not_allowed,
    required,
)
from bounce_env.wording import at_least

_T = TypeVar("_T")

_FORMS = "a sensor is a segment (start and end) or a circle (center and radius)"


@own_words_of_scenes
@dataclass(frozen=True, config=CONFIG)
class Sensor(Spec):
    """A segment or a circle that reports the ball's centre, and never bounces.

    When: docs/physics.md, "Sensors, fields, drag".

    start, end: the ends (x, y) of a segment in metres, two different points; it reports each crossing.
    center, radius: instead of them, a circle, (x, y) and > 0 in metres; it reports when the centre comes in.
    drain: True takes the ball out of play there. name: unique in the scene, or "" for none.
    """

    start: VectorOrNone = None
    end: VectorOrNone = None
    _: KW_ONLY
    center: VectorOrNone = None
    radius: PositiveOrNone = None
    drain: Flag = False
    name: Name = ""

    _check_end = field_validator("end")(away_from("start"))

    @model_validator(mode="after")
    def _check_form(self) -> Self:
        if problems := list(self._form_problems()):
            raise ValidationError.from_exception_data("Sensor", problems)
        return self

    def _form_problems(self) -> Iterator[InitErrorDetails]:
        segment = {"start": self.start, "end": self.end}
        circle = {"center": self.center, "radius": self.radius}
        if any(value is not None for value in segment.values()):
            for field, value in circle.items():
                if value is not None:
                    yield InitErrorDetails(type=not_allowed(f"left out: {_FORMS}"), loc=(field,), input=value)
            absent = [field for field, value in segment.items() if value is None]
        else:
            absent = [field for field, value in circle.items() if value is None]
        if len(absent) == 2:
            yield InitErrorDetails(type=required(f"{POINT_WORDS}; {_FORMS}"), loc=("start",), input=None)
        elif absent:
            words = POSITIVE_WORDS if absent == ["radius"] else POINT_WORDS
            yield InitErrorDetails(type=required(f"{words}; {_FORMS}"), loc=(absent[0],), input=None)

    @property
    def segment(self) -> tuple[Point, Point] | None:
        """Start and end, or None if it is a circle."""
        return None if self.start is None or self.end is None else (self.start, self.end)

    @property
    def circle(self) -> tuple[Point, float] | None:
        """Centre and radius, or None if it is a segment."""
        return None if self.center is None or self.radius is None else (self.center, self.radius)

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres."""
        if self.circle is not None:
            center, radius = self.circle
            return box_of((center,), radius)
        return box_of(self.segment or ())


@own_words_of_scenes
@dataclass(frozen=True, config=CONFIG)
class Field(Spec):
    """A region in which a constant acceleration is added to gravity; docs/physics.md, "Sensors, fields, drag".

    points: the corners (x, y) of a strictly convex polygon in metres, three or more, in either sense of
    rotation. acceleration: (x, y) in m/s^2, acts while the ball's centre is inside. name: unique in the scene,
    or "" for none.
    """

    points: Points
    acceleration: Vector
    _: KW_ONLY
    name: Name = ""

    @field_validator("points")
    @classmethod
    def _check_points(cls, points: tuple[Point, ...]) -> tuple[Point, ...]:
        if bent := _not_convex(points):
            raise not_allowed(f"the corners of a strictly convex polygon, in order around it: {bent}")
        if flat := flat_corner(points, SMALLEST):
            raise not_allowed(flat)
        return points

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres."""
        return box_of(self.points)


def _not_convex(points: tuple[Point, ...]) -> str | None:
    """Return what keeps a polygon from being strictly convex, or None.

    It is convex if every corner turns the same way and all of them together turn once around. A corner
    whose sign is round-off's is so flat that a scene refuses it.
    """
    edges = [(x1 - x0, y1 - y0) for (x0, y0), (x1, y1) in zip(points, _next(points), strict=True)]
    reaches = [(x - points[0][0], y - points[0][1]) for x, y in points]
    left = sum(map(_cross, reaches, edges)) > 0  # twice the area, > 0 if counter-clockwise
    for point, before, after in zip(_next(points), edges, _next(edges), strict=True):
        turn = _cross(before, after)
        if turn == 0 or (turn > 0) != left:
            return f"not so at {list(point)}"
    upward = [y > 0 or (y == 0 and x > 0) for x, y in edges]
    if sum(one != other for one, other in zip(upward, _next(upward), strict=True)) != 2:
        return "these go around more than once"
    return None


def flat_corner(points: tuple[Point, ...], height: float) -> str | None:
    """Return how far the flattest corner of a convex polygon must be off the line through its neighbours, if it is not.

    height: metres.
    """
    heights = []
    for before, corner, after in zip(points, _next(points), _next(_next(points)), strict=True):
        (x0, y0), (x1, y1), (x2, y2) = before, corner, after
        area = abs(_cross((x1 - x0, y1 - y0), (x2 - x0, y2 - y0)))
        heights.append((area / math.dist(before, after), corner))
    lowest, corner = min(heights)
    if lowest >= height:
        return None
    return f"such that {list(corner)} is at least {at_least(height, 2)} m off the line through the corners beside it"


def _cross(a: Point, b: Point) -> float:
    return a[0] * b[1] - a[1] * b[0]


def _next(items: Sequence[_T]) -> Sequence[_T]:
    """Return the items, each in the place of the one before it."""
    return (*items[1:], items[0])
