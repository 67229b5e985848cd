"""Packs validated scenes into the tables that kernels read. Uses sqrt only: the same bits on every machine."""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from bounce_env.engine.layout import CIRCLE, ELEMENT, FACE, RAIL, SCENE, SENSOR, Array, Tables
from bounce_env.scene import Bumper, Paddle, Scene, Sensor, Wall

Row = tuple[float, ...]
Point = tuple[float, float]


def pack(scenes: Sequence[Scene]) -> Tables:
    """Tables for a batch whose worlds play `scenes`; a feature that none of them has is left out.

    Raises ValueError when some scenes have point balls and others discs: those are different kernels.
    """
    if len({scene.ball.radius == 0.0 for scene in scenes}) > 1:
        raise ValueError("scenes of one batch must all have a ball of radius 0, or all of radius > 0")
    faces = _table(FACE, scenes, _faces)
    circles = _table(CIRCLE, scenes, _circles)
    sensors = _table(SENSOR, scenes, _sensors)
    rails = _table(RAIL, scenes, _rails)
    heads = [(len(_faces(s)), len(_circles(s)), len(_sensors(s)), len(_rails(s)), extent(s), _cap(s)) for s in scenes]
    elements = _table(ELEMENT, scenes, _materials)
    gravity = np.array([scene.gravity for scene in scenes], np.float64)
    return Tables(
        scenes=np.array(heads, SCENE),
        elements=np.zeros((len(scenes), 0), ELEMENT) if elements is None else elements,
        gravity=gravity if gravity.any() else None,
        faces=faces,
        circles=circles,
        sensors=sensors,
        rails=rails,
    )


def extent(scene: Scene) -> float:
    """The scale of round-off [m]: the largest coordinate that the elements occupy plus the ball's radius.

    Rounded up to a power of two, so that no digit of it depends on how a bounding box was computed.
    """
    largest = max((abs(c) for c in scene.bounds), default=0.0) + scene.ball.radius
    return math.ldexp(1.0, math.frexp(largest)[1])


def direction(start: Point, end: Point) -> tuple[float, float, float]:
    """Unit vector and length [m] of a segment. Scaled first, so that no square under- or overflows."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    scale = max(abs(dx), abs(dy))
    dx, dy = dx / scale, dy / scale
    length = math.sqrt(dx * dx + dy * dy)
    return dx / length, dy / length, length * scale


def _table(dtype: np.dtype[Any], scenes: Sequence[Scene], rows_of: Callable[[Scene], list[Row]]) -> Array | None:
    rows = [rows_of(scene) for scene in scenes]
    widest = max(len(r) for r in rows)
    if widest == 0:
        return None
    table = np.zeros((len(scenes), widest), dtype)
    for s, scene_rows in enumerate(rows):
        for i, row in enumerate(scene_rows):
            table[s, i] = row
    return table


def _cap(scene: Scene) -> float:
    return math.inf if scene.max_speed is None else scene.max_speed


def _materials(scene: Scene) -> list[Row]:
    ball = scene.ball
    return [
        (0.0, 0.0, 0.0, 0.0) if isinstance(e, Sensor) else (ball.b * e.b, ball.f * e.f, e.kick, e.kick_threshold)
        for e in scene.elements
    ]


def _walls(scene: Scene) -> Iterable[tuple[int, Wall]]:
    return ((i, e) for i, e in enumerate(scene.elements) if isinstance(e, Wall))


def _faces(scene: Scene) -> list[Row]:
    return [(*w.start, *direction(w.start, w.end), scene.ball.radius, i) for i, w in _walls(scene)]


def _circles(scene: Scene) -> list[Row]:
    radius = scene.ball.radius
    rows: list[Row] = [(*e.center, e.radius + radius, i) for i, e in enumerate(scene.elements) if isinstance(e, Bumper)]
    if radius > 0.0:
        rows += _ends(scene)
    return rows


def _ends(scene: Scene) -> list[Row]:
    """The round ends of walls. Of several at one point the first is kept: at a tie the first element is struck."""
    owner: dict[Point, int] = {}
    for i, wall in _walls(scene):
        for point in (wall.start, wall.end):
            owner.setdefault(point, i)
    return [(*point, scene.ball.radius, i) for point, i in owner.items()]


def _sensors(scene: Scene) -> list[Row]:
    return [
        (*e.start, *direction(e.start, e.end), int(e.drain), i)
        for i, e in enumerate(scene.elements)
        if isinstance(e, Sensor)
    ]


def _rails(scene: Scene) -> list[Row]:
    return [
        (
            *e.rail_start,
            *direction(e.rail_start, e.rail_end),
            e.half_width,
            e.radius + scene.ball.radius,
            e.max_speed,
            i,
        )
        for i, e in enumerate(scene.elements)
        if isinstance(e, Paddle)
    ]
