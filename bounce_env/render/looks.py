"""What each element looks like: strokes in pixels, at rest and lit. Data only; `painter` draws it."""

import math
from dataclasses import dataclass
from typing import TypeAlias

from bounce_env.render.projection import Projection
from bounce_env.scene import Bumper, Paddle, Scene, Sensor, Wall

Color: TypeAlias = tuple[int, int, int, int]
"""Red, green, blue and opacity, 0 to 255."""

FIELD_TOP, FIELD_BOTTOM = (30, 35, 64), (12, 14, 28)
TEXT, TEXT_SHADOW = (228, 233, 252), (8, 9, 18)

_PASSIVE, _PASSIVE_CORE, _PASSIVE_LIT = (124, 138, 182, 255), (44, 51, 84, 255), (226, 232, 255, 255)
_LIVELY, _LIVELY_CORE = (255, 86, 122, 255), (96, 30, 62, 255)
_LIVELY_LIT, _LIVELY_CORE_LIT = (255, 236, 170, 255), (255, 132, 104, 255)
_PADDLE, _PADDLE_LIT = (56, 218, 206, 255), (206, 255, 248, 255)
_RAIL = (43, 50, 84, 255)
_DRAIN, _DRAIN_LIT = (196, 62, 74, 255), (255, 128, 128, 255)
_SENSOR, _SENSOR_LIT = (74, 148, 120, 255), (150, 255, 200, 255)
_BALL = (255, 252, 240, 255)

_SMALLEST_RADIUS = 1.5
"""Pixels: what is smaller in the scene is still drawn as a dot that one can see."""

_MOST_RINGS = 64
"""A glow has a ring a pixel, so that none can be told apart, but no more than this."""


@dataclass(frozen=True)
class Stroke:
    """A line with round ends; a disc where both ends are one point. Pixels.

    It replaces what earlier strokes of the same look left beneath it, opacity included.
    """

    start: tuple[float, float]
    end: tuple[float, float]
    radius: float
    color: Color


Look: TypeAlias = tuple[Stroke, ...]
"""Strokes in the order in which they are drawn."""


def ball_look(scene: Scene, projection: Projection) -> Look:
    """A ball whose centre is at the pixel coordinates (0, 0)."""
    radius = max(scene.ball.radius * projection.scale, _SMALLEST_RADIUS, _pen(projection))
    center = (0.0, 0.0)
    return (*_glow(center, center, radius, 0.8 * radius, _BALL, 70), Stroke(center, center, radius, _BALL))


def paddle_look(paddle: Paddle, projection: Projection, *, lit: bool) -> Look:
    """A paddle whose centre is at the pixel coordinates (0, 0)."""
    (x0, y0), (x1, y1) = paddle.rail_start, paddle.rail_end
    reach = paddle.half_width * projection.scale / math.dist(paddle.rail_start, paddle.rail_end)
    end = (reach * (x1 - x0), -reach * (y1 - y0))
    start = (-end[0], -end[1])
    radius = max(paddle.radius * projection.scale, _SMALLEST_RADIUS)
    if not lit:
        return (Stroke(start, end, radius, _PADDLE),)
    return (*_glow(start, end, radius, 0.8 * radius, _PADDLE, 110), Stroke(start, end, radius, _PADDLE_LIT))


def rail_look(paddle: Paddle, projection: Projection) -> Look:
    """The line on which a paddle's centre moves."""
    start, end = (_pixel(point, projection) for point in (paddle.rail_start, paddle.rail_end))
    return (Stroke(start, end, 0.6 * _pen(projection), _RAIL),)


def still_look(element: Wall | Bumper | Sensor, scene: Scene, projection: Projection, *, lit: bool) -> Look:
    """An element that does not move, where it stands in the picture."""
    match element:
        case Bumper():
            return _bumper(element, _adds_energy(element, scene), projection, lit=lit)
        case Wall():
            return _wall(element, _adds_energy(element, scene), projection, lit=lit)
        case Sensor():
            return _dashes(element, projection, lit=lit)


def _bumper(bumper: Bumper, lively: bool, projection: Projection, *, lit: bool) -> Look:
    center = _pixel(bumper.center, projection)
    radius = max(bumper.radius * projection.scale, _SMALLEST_RADIUS)
    match lively, lit:
        case True, True:
            rim, core, reach, peak = _LIVELY_LIT, _LIVELY_CORE_LIT, radius, 170
        case True, False:
            rim, core, reach, peak = _LIVELY, _LIVELY_CORE, 0.5 * radius, 70
        case False, True:
            rim, core, reach, peak = _PASSIVE_LIT, _PASSIVE, 0.5 * radius, 110
        case _:
            rim, core, reach, peak = _PASSIVE, _PASSIVE_CORE, 0.0, 0
    discs = [(radius, rim), (0.78 * radius, core), (0.3 * radius, rim)]
    return (
        *_glow(center, center, radius, reach, rim if lively else core, peak),
        *(Stroke(center, center, size, color) for size, color in discs),
    )


def _wall(wall: Wall, lively: bool, projection: Projection, *, lit: bool) -> Look:
    start, end = _pixel(wall.start, projection), _pixel(wall.end, projection)
    pen = _pen(projection)
    if not lit:
        return (Stroke(start, end, pen, _LIVELY if lively else _PASSIVE),)
    color = _LIVELY_LIT if lively else _PASSIVE_LIT
    return (*_glow(start, end, pen, 2 * pen, color, 90), Stroke(start, end, pen, color))


def _dashes(sensor: Sensor, projection: Projection, *, lit: bool) -> Look:
    """A sensor is no obstacle: a broken line."""
    color = (_DRAIN_LIT if lit else _DRAIN) if sensor.drain else (_SENSOR_LIT if lit else _SENSOR)
    (x0, y0), (x1, y1) = _pixel(sensor.start, projection), _pixel(sensor.end, projection)
    pen = _pen(projection)
    count = max(1, round(math.dist((x0, y0), (x1, y1)) / (10 * pen)))

    def along(share: float) -> tuple[float, float]:
        return x0 + share * (x1 - x0), y0 + share * (y1 - y0)

    return tuple(Stroke(along((i + 0.25) / count), along((i + 0.75) / count), 0.8 * pen, color) for i in range(count))


def _glow(
    start: tuple[float, float], end: tuple[float, float], radius: float, reach: float, color: Color, peak: int
) -> Look:
    """Ever smaller and more opaque strokes, from `radius + reach` inwards to `radius`, up to the opacity `peak`."""
    rings = min(max(4, math.ceil(reach)), _MOST_RINGS)
    return tuple(
        Stroke(start, end, radius + reach * (1 - i / rings), (*color[:3], round(peak * ((i + 1) / rings) ** 2)))
        for i in range(rings)
    )


def _adds_energy(element: Wall | Bumper, scene: Scene) -> bool:
    return element.kick > 0 or element.b * scene.ball.b > 1


def _pen(projection: Projection) -> float:
    """Half the thickness of a line, pixels."""
    return max(0.75, 0.004 * min(projection.width, projection.height))


def _pixel(point: tuple[float, float], projection: Projection) -> tuple[float, float]:
    x, y = projection.to_pixels(point)
    return float(x), float(y)
