"""Where a ball touches what bounces it, for many places at once, and whether a path goes through anything.

Of the ledger checker: plain Python and numpy, no code of the engine. Every element is taken apart into features, as
seen by the ball's centre: lines at a distance `reach` from a segment, circles, and both sides of an arc.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Arc, Bumper, Scene, Wall
from tests.reference.ledger_motion import PartRun
from tests.reference.ledger_paths import Floats, Point

Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Line:
    """A straight face: of a wall (struck from the left only if one_way) or of a part's core.

    Of a part the place is told by its motion, see `Shapes.placed`: then x to length are arrays over times.
    """

    element: int
    x: float
    y: float
    ex: float
    ey: float
    length: float
    reach: float
    one_way: bool = False


@dataclass(frozen=True)
class Round:
    """A circle struck from outside: a bumper, or the end of a wall, arc or part."""

    element: int
    x: float
    y: float
    reach: float
    owner: int  # of several elements that end at one point the first, which is the one that counts as struck
    end: int = -1  # of a part: at which end of its core


@dataclass(frozen=True)
class Bow:
    """The circular line of an arc, struck from inside and outside."""

    element: int
    x: float
    y: float
    radius: float
    start: float
    span: float
    reach: float


Feature = Line | Round | Bow


class Touching(NamedTuple):
    """Of many places: gap [m] to a feature, unit normal from it, its curvature [1/m], depth inside its span [m]."""

    gap: Floats
    nx: Floats
    ny: Floats
    curvature: Floats
    margin: Floats


def direction(a: Point, b: Point) -> tuple[float, float, float]:
    dx, dy = b[0] - a[0], b[1] - a[1]
    length = math.hypot(dx, dy)
    return dx / length, dy / length, length


class Shapes:
    """What of a scene bounces a ball; features in the order of the elements."""

    def __init__(self, scene: Scene, runs: dict[int, PartRun]) -> None:
        self.ball = scene.ball.radius
        self.runs = runs
        self.features: list[Feature] = []
        self._owners: dict[Point, int] = {}
        for index, element in enumerate(scene.elements):
            self.features += self._features(index, element)

    def _features(self, index: int, element: object) -> Iterator[Feature]:
        if index in self.runs:
            run = self.runs[index]
            reach = run.radius + self.ball
            if run.length > 0.0:
                yield Line(index, 0.0, 0.0, 1.0, 0.0, run.length, reach)
            if reach > 0.0:
                yield from (Round(index, 0.0, 0.0, reach, index, end) for end in range(2 if run.length > 0.0 else 1))
        elif isinstance(element, Wall):
            yield Line(index, *element.start, *direction(element.start, element.end), self.ball, element.one_way)
            if self.ball > 0.0 and not element.one_way:
                yield self._end(index, *element.start)
                yield self._end(index, *element.end)
        elif isinstance(element, Bumper):
            yield Round(index, *element.center, element.radius + self.ball, index)
        elif isinstance(element, Arc):
            (x, y), radius, start = element.center, element.radius, element.start_angle
            span = 2.0 * math.pi if element.closed else element.end_angle - start
            yield Bow(index, x, y, radius, start, span, self.ball)
            if self.ball > 0.0 and not element.closed:
                for angle in (start, element.end_angle):
                    yield Round(index, x + radius * math.cos(angle), y + radius * math.sin(angle), self.ball, index)

    def _end(self, index: int, x: float, y: float) -> Round:
        return Round(index, x, y, self.ball, self._owners.setdefault((x, y), index))

    def placed(self, feature: Feature, t: Floats, x: Floats, y: Floats) -> tuple[Feature, Floats, Floats]:
        """A feature where it is at times t [s], and the velocity of its core next to (x, y) [m/s]."""
        if feature.element not in self.runs:
            return feature, np.zeros_like(t), np.zeros_like(t)
        core = self.runs[feature.element].core(t)
        if isinstance(feature, Round):
            ends = (core.x0, core.y0, core.vx0, core.vy0), (core.x1, core.y1, core.vx1, core.vy1)
            cx, cy, ux, uy = ends[feature.end]
            return replace(feature, x=cx, y=cy), ux, uy
        dx, dy = core.x1 - core.x0, core.y1 - core.y0
        length = np.hypot(dx, dy)
        along = ((x - core.x0) * dx + (y - core.y0) * dy) / length
        ux, uy = core.surface(core.x0 + along * dx / length, core.y0 + along * dy / length)
        return replace(feature, x=core.x0, y=core.y0, ex=dx / length, ey=dy / length, length=length), ux, uy

    def touching(self, feature: Feature, t: Floats, x: Floats, y: Floats, vx: Floats, vy: Floats) -> Touching:
        """Balls at (x, y) at times t [s] against a feature.

        (vx, vy) tells on which side a point is that lies on a line: the one from which it comes.
        """
        feature, ux, uy = self.placed(feature, t, x, y)
        vx, vy = vx - ux, vy - uy
        x, y = x - feature.x, y - feature.y
        if isinstance(feature, Line):
            return _touching_line(feature, x, y, vx, vy)
        with np.errstate(invalid="ignore", divide="ignore"):
            distance = np.hypot(x, y)
            nx, ny = x / distance, y / distance
        if isinstance(feature, Round):
            endless = np.full_like(distance, math.inf)
            return Touching(distance - feature.reach, nx, ny, np.full_like(distance, 1.0 / feature.reach), endless)
        outside = distance >= feature.radius
        if feature.reach == 0.0:
            outside = nx * vx + ny * vy <= 0.0
        side = np.where(outside, 1.0, -1.0)
        gap = side * (distance - feature.radius) - feature.reach
        with np.errstate(divide="ignore"):
            curvature = side / (feature.radius + side * feature.reach)
        return Touching(gap, side * nx, side * ny, curvature, _bow_margin(feature, x, y))


def _touching_line(line: Line, x: Floats, y: Floats, vx: Floats, vy: Floats) -> Touching:
    along, height = line.ex * x + line.ey * y, line.ex * y - line.ey * x
    if line.one_way:
        left = np.ones_like(height)
    elif line.reach == 0.0:
        left = np.where(line.ex * vy - line.ey * vx <= 0.0, 1.0, -1.0)
    else:
        left = np.where(height >= 0.0, 1.0, -1.0)
    margin = np.minimum(along, line.length - along)
    return Touching(left * height - line.reach, -left * line.ey, left * line.ex, np.zeros_like(along), margin)


def _bow_margin(bow: Bow, x: Floats, y: Floats) -> Floats:
    if bow.span >= 2.0 * math.pi:
        return np.full_like(x, math.inf)
    angle = np.mod(np.arctan2(y, x) - bow.start, 2.0 * math.pi)
    beyond = np.where(angle <= bow.span, angle, np.maximum(bow.span - angle, angle - 2.0 * math.pi))
    return bow.radius * np.minimum(beyond, bow.span - beyond)
