"""What only a whole scene can show: a name used twice, sizes out of proportion, speed without limit."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from pydantic import ValidationError
from pydantic_core import InitErrorDetails

from bounce_env.scene.base import union
from bounce_env.scene.elements import Arc, Ball, Bumper, Element, Flipper, Paddle, Wall
from bounce_env.scene.errors import Location, describe_element
from bounce_env.scene.fields import not_allowed, required
from bounce_env.scene.regions import Field, Sensor, flat_corner
from bounce_env.wording import at_least, at_most

SMALLEST_RADIUS = 1e-6
"""Smallest radius as a share of the scene's longer side. The time at which a disc is hit comes from squares
of distances; at 1e-8 of the distance the square of the radius drowns in their round-off and the disc is no
other than a point, at 1e-6 about four of its digits are left."""

SMALLEST_LENGTH = 1e-9
"""Smallest length of a wall, arc, rail or paddle core, and smallest height of a field's corner above the line
through its neighbours, as a share of the scene's longer side: a direction is then known to about seven digits
wherever in the scene it stands."""

LARGEST_ARC = 1e3
"""Largest radius of an arc as a multiple of the scene's longer side: the ball's distance from the arc is a
difference of two lengths of about the radius and has their round-off."""

SMALLEST_AT_OFFSET = 1e-12
"""Smallest length of any kind as a share of the largest coordinate: some thousand times what float64 can
tell apart there. Only scenes far away from the origin meet it."""

SLACK = 0.999
"""What a limit is multiplied by: a size of its round value passes, by which the scene itself may be longer."""


def check_scene(ball: Ball | None, elements: Mapping[int, Element], max_speed: float | None) -> None:
    """Raise one `pydantic.ValidationError` of all that is wrong between the parts of a scene.

    The parts are those that are right in themselves, so that a loader can report all at once: `ball` is None
    if it is not, `elements` are by their index, and `max_speed` is infinity if the one given was refused.
    """
    problems = [*_names(elements), *_sizes(ball, elements), *_speeds(ball, elements, max_speed)]
    if problems:
        raise ValidationError.from_exception_data("Scene", problems)


def _names(elements: Mapping[int, Element]) -> Iterator[InitErrorDetails]:
    first: dict[str, str] = {}
    for index, element in elements.items():
        if not element.name:
            continue
        if element.name in first:
            words = f"unique, but is also the name of {first[element.name]}"
            yield _not_allowed(words, element.name, "elements", index, "name")
        first.setdefault(element.name, describe_element(element, index))


@dataclass(frozen=True)
class _Limits:
    """What a scene of some size allows its parts to measure, in metres; `why` says so."""

    side: float
    radius: float
    length: float
    why: str


def _limits(elements: Iterable[Element]) -> _Limits:
    x_min, y_min, x_max, y_max = union(element.bounds for element in elements)
    side = max(x_max - x_min, y_max - y_min)
    largest = max(abs(x_min), abs(y_min), abs(x_max), abs(y_max))
    return _Limits(
        side=side,
        radius=SLACK * max(SMALLEST_RADIUS * side, SMALLEST_AT_OFFSET * largest),
        length=SLACK * max(SMALLEST_LENGTH * side, SMALLEST_AT_OFFSET * largest),
        why=f"in a scene whose longer side is {side:.3g} m and whose largest coordinate is {largest:.3g} m",
    )


def _sizes(ball: Ball | None, elements: Mapping[int, Element]) -> Iterator[InitErrorDetails]:
    limits = _limits(elements.values())
    ball_radius = 0.0 if ball is None else ball.radius
    if 0.0 < ball_radius < limits.radius:
        yield _not_allowed(f"0 or at least {at_least(limits.radius, 2)} m, {limits.why}", ball_radius, "ball", "radius")
    for index, element in elements.items():
        for field, words in _size_problems(element, ball_radius, limits):
            yield _not_allowed(f"{words}, {limits.why}", getattr(element, field), "elements", index, field)


def _size_problems(element: Element, ball_radius: float, limits: _Limits) -> Iterator[tuple[str, str]]:
    """Return the fields of an element that are out of proportion, and what they must be."""
    match element:
        case Wall():
            yield from _short(element, "start", "end", limits)
            if element.min_length is not None and element.min_length < limits.length:
                yield "min_length", f"at least {at_least(limits.length, 2)} m"
        case Bumper():
            yield from _thin(element.radius, limits)
            yield from _short(element, "center", "rail_end", limits)
        case Flipper():
            yield from _thin(element.radius, limits)
            if element.length < limits.length:
                yield "length", f"at least {at_least(limits.length, 2)} m"
        case Arc():
            yield from _thin(element.radius, limits)
            yield from _misshapen(element, ball_radius, limits)
        case Paddle():
            yield from _thin(element.radius, limits)
            yield from _short(element, "rail_start", "rail_end", limits)
            if 0.0 < element.half_width < limits.length:
                yield "half_width", f"0 or at least {at_least(limits.length, 2)} m"
        case Sensor():
            yield from _short(element, "start", "end", limits)
            yield from _thin(element.radius, limits)
        case Field():
            if flat := flat_corner(element.points, limits.length):
                yield "points", flat


def _thin(radius: float | None, limits: _Limits) -> Iterator[tuple[str, str]]:
    if radius is not None and radius < limits.radius:
        yield "radius", f"at least {at_least(limits.radius, 2)} m"


def _short(
    element: Wall | Bumper | Paddle | Sensor, first: str, last: str, limits: _Limits
) -> Iterator[tuple[str, str]]:
    start, end = getattr(element, first), getattr(element, last)
    if start is not None and end is not None and math.dist(start, end) < limits.length:
        yield last, f"at least {at_least(limits.length, 2)} m away from {first} = {list(start)}"


def _misshapen(arc: Arc, ball_radius: float, limits: _Limits) -> Iterator[tuple[str, str]]:
    if arc.radius > LARGEST_ARC * limits.side:
        yield "radius", f"at most {at_most(LARGEST_ARC * limits.side)} m"
    # inside of the arc the ball's centre keeps to a circle of the difference
    if ball_radius > 0.0 and abs(arc.radius - ball_radius) < limits.radius:
        yield "radius", f"at least {at_least(limits.radius, 2)} m more or less than ball.radius = {ball_radius}"
    if arc.radius * (arc.end_angle - arc.start_angle) < limits.length:
        yield "end_angle", f"such that the arc is at least {at_least(limits.length, 2)} m long"


def _speeds(ball: Ball | None, elements: Mapping[int, Element], max_speed: float | None) -> Iterator[InitErrorDetails]:
    speeds = [(_part_speed(element), index) for index, element in elements.items()]
    fastest, index = max(speeds, default=(0.0, 0))
    if max_speed is None:
        gains = (_gain(ball, index, element) for index, element in elements.items())
        if gain := next(filter(None, gains), None):
            why, cause = gain
            words = f"a number > {at_least(fastest)}, because {why}, so that bounces may add speed without limit"
            yield InitErrorDetails(type=required(words, cause), loc=("max_speed",), input=None)
    elif max_speed <= fastest:
        words = (
            f"greater than {fastest}, the fastest that the surface of {describe_element(elements[index], index)} moves"
        )
        yield _not_allowed(words, max_speed, "max_speed")


def _part_speed(element: Element) -> float:
    """Return the fastest that an element's surface moves, m/s."""
    match element:
        case Paddle():
            return element.max_speed
        case Flipper():
            return element.surface_speed
        case Bumper():
            return element.speed
    return 0.0


def _gain(ball: Ball | None, index: int, element: Element) -> tuple[str, Location] | None:
    """Return what lets a bounce off the element add energy, in words and by its location, or None."""
    if isinstance(element, Sensor | Field):
        return None
    if element.kick > 0.0:
        return f"{describe_element(element, index)} has kick = {element.kick}", ("elements", index, "kick")
    if ball is not None and ball.b * element.b > 1.0:
        words = f"{describe_element(element, index)} has b = {element.b}, times ball.b = {ball.b} is more than 1"
        return words, ("elements", index, "b") if element.b > 1.0 else ("ball", "b")
    return None


def _not_allowed(words: str, value: object, *loc: str | int) -> InitErrorDetails:
    return InitErrorDetails(type=not_allowed(words), loc=loc, input=value)
