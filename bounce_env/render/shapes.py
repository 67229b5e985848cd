"""What each element looks like: strokes and patches in pixels, at rest and lit. Data only; `painter` draws it."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

from bounce_env.render.outline import clipped, islands, view_box
from bounce_env.render.projection import Projection
from bounce_env.scene import Arc, Bumper, Element, Field, Paddle, Part, Scene, Sensor, Wall

Point: TypeAlias = tuple[float, float]
"""x to the right and y down, pixels."""

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
_TARGET, _TARGET_FACE = (126, 232, 96, 255), (126, 232, 96, 60)
_WIND, _WIND_ARROW = (96, 104, 232, 34), (116, 126, 236, 120)
_WIND_LIT, _WIND_ARROW_LIT = (120, 140, 255, 90), (190, 200, 255, 220)
_BALL = (255, 252, 240, 255)
_TRAIL = (255, 214, 150)
_TRAIL_PEAK = 190  # opacity where it is freshest

_SMALLEST_RADIUS = 1.5
"""Pixels: what is smaller in the scene is still drawn as a dot that one can see."""

_MOST_RINGS = 64
"""A glow has a ring a pixel, so that none can be told apart, but no more than this."""

_SAGITTA = 0.04
"""A curve is drawn as chords that miss it by no more pixels than this, less than one can see."""


@dataclass(frozen=True)
class Stroke:
    """A line with round ends; a disc where both ends are one point. Pixels.

    It replaces what earlier strokes of the same look left beneath it, opacity included.
    """

    start: Point
    end: Point
    radius: float
    color: Color


@dataclass(frozen=True)
class Patch:
    """A filled polygon, pixels. It replaces what lies beneath it as a `Stroke` does."""

    corners: tuple[Point, ...]
    color: Color


Look: TypeAlias = tuple[Stroke | Patch, ...]
"""Strokes and patches in the order in which they are drawn."""


def ball_look(scene: Scene, projection: Projection) -> Look:
    """Return a ball whose centre is at the pixel coordinates (0, 0)."""
    radius = max(scene.ball.radius * projection.scale, _SMALLEST_RADIUS, _pen(projection))
    center = (0.0, 0.0)
    return (*_glow(center, center, radius, 0.8 * radius, _BALL, 70), Stroke(center, center, radius, _BALL))


def trail_look(scene: Scene, projection: Projection, freshness: float) -> Look:
    """A spot at the pixel coordinates (0, 0) of the way that a ball has come: fainter and smaller, the older it is."""
    spot = 0.6 * max(scene.ball.radius * projection.scale, _SMALLEST_RADIUS, _pen(projection))
    radius = max(spot * (0.35 + 0.65 * freshness), 0.5)
    center = (0.0, 0.0)
    return (Stroke(center, center, radius, (*_TRAIL, round(_TRAIL_PEAK * freshness))),)


def target_look(target: Element, projection: Projection) -> Look:
    """Return a circle to be entered, with its centre at the pixel coordinates (0, 0): a shining disc with rings."""
    if not isinstance(target, Sensor) or target.circle is None:
        raise TypeError(f"{target!r}: must be a circular sensor")
    center = (0.0, 0.0)
    radius = max(target.circle[1] * projection.scale, _SMALLEST_RADIUS)
    pen = min(1.2 * _pen(projection), 0.12 * radius)
    discs = []
    for share in (1.0, 0.55):
        discs += [(share * radius, _TARGET), (share * radius - 2.0 * pen, _TARGET_FACE)]
    return (
        *_glow(center, center, radius, 0.5 * radius, _TARGET, 60),
        *(Stroke(center, center, size, color) for size, color in (*discs, (0.16 * radius, _TARGET))),
    )


def part_look(part: Part, way: Point, scene: Scene, projection: Projection, *, lit: bool) -> Look:
    """Return a moving part whose core runs from the pixel coordinates (0, 0) by `way`."""
    start = (0.0, 0.0)
    if isinstance(part, Bumper):
        return _bumper(start, part.radius, _adds_energy(part, scene), projection, lit=lit)
    thickness = _pen(projection) if isinstance(part, Wall) else part.radius * projection.scale
    radius = max(thickness, _SMALLEST_RADIUS)
    if not lit:
        return (Stroke(start, way, radius, _PADDLE),)
    return (*_glow(start, way, radius, 0.8 * radius, _PADDLE, 110), Stroke(start, way, radius, _PADDLE_LIT))


def rail_look(part: Part, projection: Projection) -> Look:
    """Return the line on which the centre of a part moves; nothing for one that turns."""
    match part:
        case Paddle():
            ends = (part.rail_start, part.rail_end)
        case Bumper(rail_end=tuple(end)):
            ends = (part.center, end)
        case _:
            return ()
    start, end = (_pixel(point, projection) for point in ends)
    return (Stroke(start, end, 0.6 * _pen(projection), _RAIL),)


def still_look(element: Element, scene: Scene, projection: Projection, *, lit: bool) -> Look:
    """Return an element that does not move, where it stands in the picture."""
    match element:
        case Bumper():
            lively = _adds_energy(element, scene)
            return _bumper(_pixel(element.center, projection), element.radius, lively, projection, lit=lit)
        case Wall() if element.one_way:
            return _gate(element, _adds_energy(element, scene), projection, lit=lit)
        case Wall():
            path = [_pixel(point, projection) for point in (element.start, element.end)]
            return _line(path, _pen(projection), _adds_energy(element, scene), lit=lit)
        case Arc():
            path = _curve(element.center, element.radius, element.start_angle, element.end_angle, projection)
            return _line(path, _pen(projection), _adds_energy(element, scene), lit=lit)
        case Sensor():
            return _dashes(element, scene, projection, lit=lit)
        case Field():
            return _wind(element, projection, lit=lit)
        case _:
            raise TypeError(f"{element!r}: moves, see part_look")


def _bumper(center: Point, size: float, lively: bool, projection: Projection, *, lit: bool) -> Look:
    radius = max(size * projection.scale, _SMALLEST_RADIUS)
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


def _line(path: Sequence[Point], pen: float, lively: bool, *, lit: bool) -> Look:
    """Return what bounces along a line: a wall, or the chords of an arc."""
    if not lit:
        return _along(path, pen, _LIVELY if lively else _PASSIVE)
    color = _LIVELY_LIT if lively else _PASSIVE_LIT
    glow = (_along(path, ring.radius, ring.color) for ring in _glow(path[0], path[0], pen, 2 * pen, color, 90))
    return (*(stroke for ring in glow for stroke in ring), *_along(path, pen, color))


def _gate(wall: Wall, lively: bool, projection: Projection, *, lit: bool) -> Look:
    """A one-way wall: a thinner line, and arrow heads on the side from which the ball may pass, pointing its way."""
    start, end = _pixel(wall.start, projection), _pixel(wall.end, projection)
    pen = _pen(projection)
    length = math.dist(start, end)
    ux, uy = (end[0] - start[0]) / length, (end[1] - start[1]) / length
    heads = max(1, math.floor(length / (14 * pen)) - 1)  # none so near to an end that it meets what stands there

    def place(along: float, right: float) -> Point:
        return start[0] + along * ux - right * uy, start[1] + along * uy + right * ux  # y points down

    color = (_LIVELY_LIT if lively else _PASSIVE_LIT) if lit else (_LIVELY if lively else _PASSIVE)
    wing = min(2.6 * pen, 0.25 * length)
    chevrons = [
        [place(middle - wing, 2.2 * pen + wing), place(middle, 2.2 * pen), place(middle + wing, 2.2 * pen + wing)]
        for middle in ((i + 0.5) * length / heads for i in range(heads))
    ]
    line = _line((start, end), 0.6 * pen, lively, lit=lit)
    return (*line, *(stroke for chevron in chevrons for stroke in _along(chevron, 0.6 * pen, color)))


def _dashes(sensor: Sensor, scene: Scene, projection: Projection, *, lit: bool) -> Look:
    """Return a sensor is no obstacle: a broken line, as far as it lies in the field."""
    color = (_DRAIN_LIT if lit else _DRAIN) if sensor.drain else (_SENSOR_LIT if lit else _SENSOR)
    pen = _pen(projection)
    if sensor.segment is not None:
        inside = clipped(sensor.segment, view_box(scene)) or sensor.segment
        (x0, y0), (x1, y1) = (_pixel(point, projection) for point in inside)
        count = max(1, round(math.dist((x0, y0), (x1, y1)) / (10 * pen)))
        shares = [((i + 0.25) / count, (i + 0.75) / count) for i in range(count)]
        ends = [[(x0 + share * (x1 - x0), y0 + share * (y1 - y0)) for share in dash] for dash in shares]
        return tuple(Stroke(start, end, 0.8 * pen, color) for start, end in ends)
    assert sensor.circle is not None
    center, radius = sensor.circle
    turn = 2 * math.pi
    count = max(3, round(turn * radius * projection.scale / (10 * pen)))
    dashes = [
        _curve(center, radius, turn * (i - 0.25) / count, turn * (i + 0.25) / count, projection) for i in range(count)
    ]
    return tuple(stroke for dash in dashes for stroke in _along(dash, 0.8 * pen, color))


def _wind(field: Field, projection: Projection, *, lit: bool) -> Look:
    """Return a field: a faint patch, and in its middle an arrow that points where it drives the ball."""
    patch, color = (_WIND_LIT, _WIND_ARROW_LIT) if lit else (_WIND, _WIND_ARROW)
    corners = tuple(_pixel(point, projection) for point in field.points)
    x, y = (sum(side) / len(corners) for side in zip(*corners, strict=True))
    ax, ay = field.acceleration
    size = math.hypot(ax, ay)
    if size == 0.0:
        return (Patch(corners, patch),)
    ux, uy = ax / size, -ay / size
    reach = 0.3 * min(math.dist((x, y), corner) for corner in corners)
    tail, tip = (x - reach * ux, y - reach * uy), (x + reach * ux, y + reach * uy)
    wings = [(x + 0.4 * reach * (ux + side * uy), y + 0.4 * reach * (uy - side * ux)) for side in (-1, 1)]
    pen = 0.6 * _pen(projection)
    shaft, head = _along((tail, tip), pen, color), _along((wings[0], tip, wings[1]), pen, color)
    return (Patch(corners, patch), *shaft, *head)


def solid_looks(scene: Scene, projection: Projection, hidden: Collection[int]) -> Sequence[Look]:
    """What standing walls enclose without room for a ball to start in: slingshots, posts and ledges are solid."""
    return [
        (Patch(tuple(_pixel(point, projection) for point in corners), _PASSIVE_CORE),)
        for corners in islands(scene, hidden)
    ]


def _along(path: Sequence[Point], radius: float, color: Color) -> tuple[Stroke, ...]:
    return tuple(Stroke(start, end, radius, color) for start, end in pairwise(path))


def _curve(center: Point, radius: float, start: float, end: float, projection: Projection) -> list[Point]:
    """Points on a circle from one angle to another, so near to each other that their chords look round."""
    sagitta = min(_SAGITTA / (radius * projection.scale), 0.5)
    chords = max(1, math.ceil((end - start) / (2 * math.acos(1 - sagitta))))
    angles = [start + (end - start) * i / chords for i in range(chords + 1)]
    x, y = center
    return [_pixel((x + radius * math.cos(angle), y + radius * math.sin(angle)), projection) for angle in angles]


def _glow(start: Point, end: Point, radius: float, reach: float, color: Color, peak: int) -> tuple[Stroke, ...]:
    """Ever smaller and more opaque strokes, from `radius + reach` inwards to `radius`, up to the opacity `peak`."""
    rings = min(max(4, math.ceil(reach)), _MOST_RINGS)
    return tuple(
        Stroke(start, end, radius + reach * (1 - i / rings), (*color[:3], round(peak * ((i + 1) / rings) ** 2)))
        for i in range(rings)
    )


def _adds_energy(element: Wall | Bumper | Arc, scene: Scene) -> bool:
    return element.kick > 0 or element.b * scene.ball.b > 1


def _pen(projection: Projection) -> float:
    """Half the thickness of a line, pixels."""
    return max(0.75, 0.004 * min(projection.width, projection.height))


def _pixel(point: tuple[float, float], projection: Projection) -> Point:
    x, y = projection.to_pixels(point)
    return float(x), float(y)
