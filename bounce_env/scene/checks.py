"""What only a whole scene can show: a name used twice, sizes out of proportion, speed without limit."""

import math
from collections.abc import Iterator, Mapping

from pydantic import ValidationError
from pydantic_core import InitErrorDetails

from bounce_env.scene.elements import Ball, Bumper, Element, Paddle, Sensor, Wall, union
from bounce_env.scene.fields import not_allowed, required

SMALLEST_RADIUS = 1e-6
"""Smallest radius as a share of the scene's longer side. The time at which a disc is hit comes from squares
of distances; at 1e-8 of the distance the square of the radius drowns in their round-off and the disc is no
other than a point, at 1e-6 about four of its digits are left."""

SMALLEST_LENGTH = 1e-9
"""Smallest length of a wall, rail or paddle core as a share of the scene's longer side: its direction is then
known to about seven digits wherever in the scene it stands."""

SMALLEST_AT_OFFSET = 1e-12
"""Smallest length of any kind as a share of the largest coordinate: some thousand times what float64 can
tell apart there. Only scenes far away from the origin meet it."""


def label(index: int, kind: str, name: object) -> str:
    """How messages call an element: `elements[3] (wall 'floor')`, or `elements[3] (wall)` without a name."""
    return f"elements[{index}] ({kind} {name!r})" if name else f"elements[{index}] ({kind})"


def check_scene(ball: Ball | None, elements: Mapping[int, Element], max_speed: float | None) -> None:
    """Raise one `pydantic.ValidationError` of all that is wrong between the parts of a scene.

    The parts are those that are right in themselves, so that a loader can report all at once: `ball` is None
    if it is not, `elements` are by their index, and `max_speed` is infinity if the one given was refused.
    """
    problems = [*_names(elements), *_sizes(ball, elements), *_speeds(ball, elements, max_speed)]
    if problems:
        raise ValidationError.from_exception_data("Scene", problems)


def _label(index: int, element: Element) -> str:
    return label(index, type(element).__name__.lower(), element.name)


def _names(elements: Mapping[int, Element]) -> Iterator[InitErrorDetails]:
    first: dict[str, str] = {}
    for index, element in elements.items():
        if not element.name:
            continue
        if element.name in first:
            words = f"unique, but is also the name of {first[element.name]}"
            yield _not_allowed(words, element.name, "elements", index, "name")
        first.setdefault(element.name, _label(index, element))


def _sizes(ball: Ball | None, elements: Mapping[int, Element]) -> Iterator[InitErrorDetails]:
    x_min, y_min, x_max, y_max = union(element.bounds for element in elements.values())
    side = max(x_max - x_min, y_max - y_min)
    largest = max(abs(x_min), abs(y_min), abs(x_max), abs(y_max))
    radius = max(SMALLEST_RADIUS * side, SMALLEST_AT_OFFSET * largest)
    length = max(SMALLEST_LENGTH * side, SMALLEST_AT_OFFSET * largest)
    why = f"in a scene whose longer side is {side:.3g} m and whose largest coordinate is {largest:.3g} m"

    if ball is not None and 0.0 < ball.radius < radius:
        yield _not_allowed(f"0 or at least {radius:.3g} m, {why}", ball.radius, "ball", "radius")
    for index, element in elements.items():
        at = ("elements", index)
        if isinstance(element, Bumper | Paddle) and element.radius < radius:
            yield _not_allowed(f"at least {radius:.3g} m, {why}", element.radius, *at, "radius")
        if isinstance(element, Wall | Sensor) and math.dist(element.start, element.end) < length:
            words = f"at least {length:.3g} m away from start = {list(element.start)}, {why}"
            yield _not_allowed(words, list(element.end), *at, "end")
        if isinstance(element, Paddle) and math.dist(element.rail_start, element.rail_end) < length:
            words = f"at least {length:.3g} m away from rail_start = {list(element.rail_start)}, {why}"
            yield _not_allowed(words, list(element.rail_end), *at, "rail_end")
        if isinstance(element, Paddle) and 0.0 < element.half_width < length:
            yield _not_allowed(f"0 or at least {length:.3g} m, {why}", element.half_width, *at, "half_width")


def _speeds(ball: Ball | None, elements: Mapping[int, Element], max_speed: float | None) -> Iterator[InitErrorDetails]:
    speeds = [(part.max_speed, index) for index, part in elements.items() if isinstance(part, Paddle)]
    fastest, index = max(speeds, default=(0.0, 0))
    if max_speed is None:
        gains = (_gain(ball, index, element) for index, element in elements.items())
        if gain := next(filter(None, gains), None):
            words = f"a number > {fastest:g}, because {gain}, so that bounces may add speed without limit"
            yield InitErrorDetails(type=required(words), loc=("max_speed",), input=None)
    elif max_speed <= fastest:
        words = f"greater than {fastest}, the max_speed of {_label(index, elements[index])}"
        yield _not_allowed(words, max_speed, "max_speed")


def _gain(ball: Ball | None, index: int, element: Element) -> str | None:
    """What lets a bounce off the element add energy, in words, or None."""
    if isinstance(element, Sensor):
        return None
    if element.kick > 0.0:
        return f"{_label(index, element)} has kick = {element.kick}"
    if ball is not None and ball.b * element.b > 1.0:
        return f"{_label(index, element)} has b = {element.b}, times ball.b = {ball.b} is more than 1"
    return None


def _not_allowed(words: str, value: object, *loc: str | int) -> InitErrorDetails:
    return InitErrorDetails(type=not_allowed(words), loc=loc, input=value)
