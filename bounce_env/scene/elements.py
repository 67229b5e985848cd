"""What a scene is made of: frozen, validated specs in SI units (metres, seconds, radians; y points up).

Every spec checks its own fields when it is made; what is wrong raises SceneError (a ValueError) that
names class, field, value and what is allowed. Numbers may be Python's or NumPy's, points a
tuple, list or array of two; they are kept as float and tuple[float, float]. Text and bools are not numbers.

The law of a bounce is the tutorial's (chapter "Bounce", section "Real bounce and friction"): of the velocity
relative to the surface, the part along the normal is reversed and multiplied by ball.b * element.b, the part
along the surface is multiplied by ball.f * element.f. A kick is then added along the normal.
"""

import math
from collections.abc import Iterator
from dataclasses import KW_ONLY
from typing import Self, TypeAlias

from pydantic import ValidationError, ValidationInfo, field_validator, model_validator
from pydantic.dataclasses import dataclass
from pydantic_core import InitErrorDetails

from bounce_env.scene.base import CONFIG, Box, Spec, away_from, box_of, union
from bounce_env.scene.errors import own_words_of_scenes
from bounce_env.scene.fields import (
    SMALLEST,
    Angle,
    BoxOrNone,
    Flag,
    Name,
    Positive,
    PositiveOrNone,
    Vector,
    VectorOrNone,
    ZeroOrMore,
    ZeroOrPositive,
    ZeroToOne,
    not_allowed,
)
from bounce_env.scene.regions import Field, Sensor
from bounce_env.wording import at_most

CLOSED = 1e-12
"""An arc is a closed circle when what it lacks of 2 pi is no more than this [rad]: round-off of the angles."""

SMALLEST_SPAN = 1e-6
"""Smallest angle of an arc, and smallest gap of one that is not closed [rad]: about ten digits of it are known.
A narrower gap is a 2 pi written with too few digits."""


@own_words_of_scenes
@dataclass(frozen=True, config=CONFIG)
class Ball(Spec):
    """The ball: a disc, or with radius 0 the tutorial's point. What it does: docs/physics.md, "Flight".

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
    cooldown: ZeroOrMore = 0.0
    name: Name = ""


@own_words_of_scenes
@dataclass(frozen=True, config=CONFIG)
class Wall(_Surface):
    """A segment that bounces the ball on both sides and at its ends; docs/physics.md, "Bounce law".

    start, end: its ends (x, y) in metres, two different points. b: bounciness, 0 or more. f: friction, 0 (all
    lost) to 1 (none). kick: speed in m/s added along the normal. kick_threshold: m/s, the kick is
    given where the approach is faster. cooldown: seconds after a kick in which the wall gives no other. one_way: True
    bounces a ball that comes from the left of start -> end only; from the right it passes freely, and the ends
    never bounce. name: unique in the scene, or "" for none.

    draggable: True lets commands move the two ends, each at its own velocity; not with one_way. min_length: metres, > 0
    and no more than it is long at first; where the ends come so near to each other both stop; None for a tenth of the
    first length. reach: two corners of the box in which the ends stay, each coordinate stopping by itself at the box's
    border; None for the square about the origin that holds the scene (`engine.packing.extent`). The last two of a
    draggable wall only.
    """

    start: Vector
    end: Vector
    _: KW_ONLY
    one_way: Flag = False
    draggable: Flag = False
    min_length: PositiveOrNone = None
    reach: BoxOrNone = None

    _check_end = field_validator("end")(away_from("start"))

    @model_validator(mode="after")
    def _check_drag(self) -> Self:
        problems = list(self._drag_problems())
        if problems:
            details = [
                InitErrorDetails(type=not_allowed(words), loc=(field,), input=getattr(self, field))
                for field, words in problems
            ]
            raise ValidationError.from_exception_data("Wall", details)
        return self

    def _drag_problems(self) -> Iterator[tuple[str, str]]:
        if not self.draggable:
            for field in ("min_length", "reach"):
                if getattr(self, field) is not None:
                    yield field, "left out, or None, where draggable is false"
            return
        if self.one_way:
            yield "one_way", "false where draggable is true"
        length = math.dist(self.start, self.end)
        if self.min_length is not None and self.min_length > length:
            yield "min_length", f"at most {at_most(length)}, the length at first"
        if self.reach is not None:
            (x0, y0), (x1, y1) = self.reach
            if not all(x0 <= x <= x1 and y0 <= y <= y1 for x, y in (self.start, self.end)):
                yield "reach", f"a box that holds start = {list(self.start)} and end = {list(self.end)}"

    @property
    def shortest(self) -> float:
        """The length at which the ends of a draggable wall stop, metres."""
        return 0.1 * math.dist(self.start, self.end) if self.min_length is None else self.min_length

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres; of a draggable wall with a `reach` all of it."""
        return box_of((self.start, self.end) if self.reach is None else self.reach)


@own_words_of_scenes
@dataclass(frozen=True, config=CONFIG)
class Bumper(_Surface):
    """A circle that bounces the ball outside of it, and may move to and fro on a rail; docs/physics.md, "Elements".

    center: (x, y) in metres. radius: metres, > 0. rail_end: where its centre turns back, (x, y) in metres, if it moves
    to there and back from `center`; None for a bumper that stands. speed: at which it does so, m/s, 0 (it stands at
    `center`) or more, 0 without a `rail_end`. b, f, kick, kick_threshold, cooldown, name: as for a `Wall`.
    """

    center: Vector
    radius: Positive
    _: KW_ONLY
    rail_end: VectorOrNone = None
    speed: ZeroOrPositive = 0.0

    _check_rail_end = field_validator("rail_end")(away_from("center"))

    @model_validator(mode="after")
    def _check_speed(self) -> Self:
        if self.speed > 0.0 and self.rail_end is None:
            problem = not_allowed("0 without a rail_end")
            details = [InitErrorDetails(type=problem, loc=("speed",), input=self.speed)]
            raise ValidationError.from_exception_data("Bumper", details)
        return self

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres of all that it can reach."""
        return box_of([point for point in (self.center, self.rail_end) if point is not None], self.radius)


@own_words_of_scenes
@dataclass(frozen=True, config=CONFIG)
class Arc(_Surface):
    """A part of a circle's line that bounces the ball from inside, from outside and at its ends.

    How a ball slides along it: docs/physics.md, "Slides on curves".

    center: (x, y) in metres. radius: metres, > 0. start_angle, end_angle: radians from the x axis; the arc goes
    counter-clockwise from start to end, by more than 0 and at most 2 pi; by 2 pi (to 1e-12) it is a closed
    circle and has no ends. b, f, kick, kick_threshold, cooldown, name: as for a `Wall`.
    """

    center: Vector
    radius: Positive
    start_angle: Angle
    end_angle: Angle

    @field_validator("end_angle")
    @classmethod
    def _check_span(cls, end: float, info: ValidationInfo) -> float:
        if "start_angle" not in info.data:  # it was refused itself
            return end
        start = info.data["start_angle"]
        span, turn = end - start, 2 * math.pi
        if not SMALLEST_SPAN - CLOSED <= span <= turn + CLOSED:
            raise not_allowed(
                f"more than start_angle = {start}, by {SMALLEST_SPAN:g} to 2 pi radians (to {start + turn!r})"
            )
        if turn - SMALLEST_SPAN + CLOSED < span < turn - CLOSED:
            raise not_allowed(
                f"start_angle + 2 pi = {start + turn!r} for a closed circle, or less by {SMALLEST_SPAN:g} or more"
            )
        radius = info.data.get("radius", math.inf)
        if radius * span < SMALLEST:
            raise not_allowed(f"such that the arc is at least {SMALLEST:g} m long")
        return end

    @property
    def closed(self) -> bool:
        """Whether it is a whole circle, without ends."""
        return self.end_angle - self.start_angle >= 2 * math.pi - CLOSED

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres.

        Of the ends and of the directions of the axes that the arc passes, so that it holds no more than the arc.
        Sine and cosine are libm's and may differ in the last bit from machine to machine; they are rounded to
        2^-40, and of the physics only the power of two above the scene's largest coordinate depends on them.
        """
        first = math.ceil(self.start_angle / (math.pi / 2))
        last = math.floor(self.end_angle / (math.pi / 2))
        ways = [((1, 0), (0, 1), (-1, 0), (0, -1))[quarter % 4] for quarter in range(first, last + 1)]
        ends = [(_rounded(math.cos(angle)), _rounded(math.sin(angle))) for angle in (self.start_angle, self.end_angle)]
        x, y = self.center
        return box_of([(x + self.radius * dx, y + self.radius * dy) for dx, dy in (*ways, *ends)])


def _rounded(share: float) -> float:
    return math.ldexp(round(math.ldexp(share, 40)), -40)


@own_words_of_scenes
@dataclass(frozen=True, config=CONFIG)
class Paddle(_Surface):
    """A capsule that moves on a straight rail between two stops; docs/physics.md, "Parts".

    rail_start, rail_end: where its centre stops, (x, y) in metres, two different points; it starts between
    them. half_width: how far its core, a segment parallel to the rail, reaches to each side of the centre,
    metres, 0 or more. radius: thickness around the core, metres, > 0; so it is 2 (half_width + radius) long.
    max_speed: of its centre along the rail, m/s, > 0. b, f, kick, kick_threshold, cooldown, name: as for a `Wall`.
    """

    rail_start: Vector
    rail_end: Vector
    _: KW_ONLY
    half_width: ZeroOrPositive
    radius: Positive
    max_speed: Positive

    _check_rail_end = field_validator("rail_end")(away_from("rail_start"))

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres of all that it can reach between its stops."""
        (x0, y0), (x1, y1) = self.rail_start, self.rail_end
        share = self.half_width / math.dist(self.rail_start, self.rail_end)
        dx, dy = share * (x1 - x0), share * (y1 - y0)
        return box_of(((x0 - dx, y0 - dy), (x1 + dx, y1 + dy)), self.radius)


@own_words_of_scenes
@dataclass(frozen=True, config=CONFIG)
class Flipper(_Surface):
    """A capsule that turns about a pivot between two angles: pressed towards the one, released back to the other.

    How it meets balls: docs/physics.md, "Parts" and "Time of impact".

    pivot: (x, y) in metres, the middle of its round end. length: metres, > 0, from there to the middle of the other
    end. radius: thickness around that line, metres, > 0. rest_angle, active_angle: of the line, radians from the x
    axis, different by at most 2 pi; it starts at rest_angle. up_speed, down_speed: at which it turns to active_angle
    and back, rad/s, > 0. b, f, kick, kick_threshold, cooldown, name: as for a `Wall`.
    """

    pivot: Vector
    length: Positive
    _: KW_ONLY
    radius: Positive
    rest_angle: Angle
    active_angle: Angle
    up_speed: Positive
    down_speed: Positive

    @field_validator("active_angle")
    @classmethod
    def _check_stroke(cls, active: float, info: ValidationInfo) -> float:
        if "rest_angle" not in info.data:  # it was refused itself
            return active
        rest = info.data["rest_angle"]
        if not SMALLEST_SPAN - CLOSED <= abs(active - rest) <= 2 * math.pi + CLOSED:
            raise not_allowed(f"{SMALLEST_SPAN:g} to 2 pi radians more or less than rest_angle = {rest}")
        return active

    @property
    def surface_speed(self) -> float:
        """The fastest that any point of its surface moves, m/s."""
        return max(self.up_speed, self.down_speed) * (self.length + self.radius)

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres of all that it can reach between its stops."""
        start, end = sorted((self.rest_angle, self.active_angle))
        boxes = (Arc(self.pivot, self.length, start, end).bounds, box_of((self.pivot,)))
        x_min, y_min, x_max, y_max = union(boxes)
        return box_of(((x_min, y_min), (x_max, y_max)), self.radius)


Element: TypeAlias = Wall | Bumper | Arc | Paddle | Flipper | Sensor | Field
"""What a scene is made of."""

Part: TypeAlias = Paddle | Flipper | Bumper | Wall
"""What may move."""


def moves(element: Element) -> bool:
    """Return whether an element is a part (docs/physics.md, "Parts"): it moves as commanded, or a bumper by itself.

    element: any; raises nothing.
    """
    match element:
        case Paddle() | Flipper():
            return True
        case Bumper():
            return element.rail_end is not None
        case Wall():
            return element.draggable
    return False
