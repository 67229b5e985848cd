"""Where a ball touches what bounces it, for many places at once, and whether a path goes through anything.

Of the ledger checker: plain Python and numpy, no code of the engine. Every element is taken apart into features, as
seen by the ball's centre: lines at a distance `reach` from a segment, circles, and both sides of an arc.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from ledger_parts import PaddleRun
from ledger_paths import Floats, Point, Track, to_arc, to_point, to_segment

from bounce_env.scene import Arc, Bumper, Paddle, Scene, Wall

Ints = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Line:
    """A straight face: of a wall (struck from the left only if one_way) or of a paddle's core."""

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
    """A circle struck from outside: a bumper, or the end of a wall, arc or paddle."""

    element: int
    x: float
    y: float
    reach: float
    owner: int  # of several elements that end at one point the first, which is the one that counts as struck


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

    def __init__(self, scene: Scene, paddles: dict[int, PaddleRun]) -> None:
        self.ball = scene.ball.radius
        self.paddles = paddles
        self.features: list[Feature] = []
        self._owners: dict[Point, int] = {}
        for index, element in enumerate(scene.elements):
            self.features += self._features(index, element)

    def _features(self, index: int, element: object) -> Iterator[Feature]:
        if isinstance(element, Wall):
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
        elif isinstance(element, Paddle):
            ex, ey, _ = direction(element.rail_start, element.rail_end)
            half, reach = element.half_width, element.radius + self.ball
            # About the paddle's centre.
            yield Line(index, -half * ex, -half * ey, ex, ey, 2.0 * half, reach)
            yield Round(index, -half * ex, -half * ey, reach, index)
            yield Round(index, half * ex, half * ey, reach, index)

    def _end(self, index: int, x: float, y: float) -> Round:
        return Round(index, x, y, self.ball, self._owners.setdefault((x, y), index))

    def touching(self, feature: Feature, t: Floats, x: Floats, y: Floats, vx: Floats, vy: Floats) -> Touching:
        """Balls at (x, y) at times t [s] against a feature.

        (vx, vy) tells on which side a point is that lies on a line: the one from which it comes.
        """
        if feature.element in self.paddles:
            cx, cy, ux, uy = self.paddles[feature.element].states(t)
            x, y, vx, vy = x - cx, y - cy, vx - ux, vy - uy
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


class Gaps(NamedTuple):
    """Least gaps [m] of pieces of a path to elements, one entry a pair of them."""

    element: Ints
    piece: Ints
    gap: Floats


def least_gaps(shapes: Shapes, scene: Scene, track: Track, begin: Floats) -> Iterator[Gaps]:
    """For every element with a thickness, the pieces of the path that come near it.

    Without those that only direction or side can tell: a point's walls and arcs, and one-way walls.
    """
    left, below, right, above = track.box()
    points: list[tuple[Ints, Ints, Track, float]] = []  # elements, pieces, paths seen from the centre, reach
    segments: list[tuple[Ints, Ints, Track, float, tuple[float, float, float]]] = []
    for index, element in enumerate(scene.elements):
        if not isinstance(element, Wall | Bumper | Arc | Paddle):
            continue
        reach = shapes.ball + (element.radius if isinstance(element, Bumper | Paddle) else 0.0)
        if reach == 0.0 or (isinstance(element, Wall) and element.one_way):
            continue
        x0, y0, x1, y1 = element.bounds
        pad = 1.01 * reach
        near = np.flatnonzero((left < x1 + pad) & (right > x0 - pad) & (below < y1 + pad) & (above > y0 - pad))
        if not near.size:
            continue
        which, seen = np.full(near.shape, index), track.of(near)
        match element:
            case Bumper():
                points.append((which, near, seen.relative_to(*element.center), reach))
            case Arc():
                span = 2.0 * math.pi if element.closed else element.end_angle - element.start_angle
                seen = seen.relative_to(*element.center)
                yield Gaps(which, near, to_arc(seen, element.radius, element.start_angle, span) - reach)
            case Wall():
                way = direction(element.start, element.end)
                segments.append((which, near, seen.relative_to(*element.start), reach, way))
            case Paddle():
                seen = _seen_from_paddle(shapes.paddles[index], element, seen, begin[near])
                ex, ey, _ = direction(element.rail_start, element.rail_end)
                segments.append((which, near, seen, reach, (ex, ey, 2.0 * element.half_width)))
    if points:
        elements, pieces, seen_, reaches = zip(*points, strict=True)
        yield Gaps(*_joined(elements, pieces), to_point(_stacked(seen_)) - _spread(pieces, reaches))
    if segments:
        elements, pieces, seen_, reaches, ways = zip(*segments, strict=True)
        ex_, ey_, length = (_spread(pieces, column) for column in zip(*ways, strict=True))
        yield Gaps(*_joined(elements, pieces), to_segment(_stacked(seen_), ex_, ey_, length) - _spread(pieces, reaches))


def _joined(elements: Sequence[Ints], pieces: Sequence[Ints]) -> tuple[Ints, Ints]:
    return np.concatenate(elements), np.concatenate(pieces)


def _stacked(tracks: Sequence[Track]) -> Track:
    return Track(*(np.concatenate(columns) for columns in zip(*tracks, strict=True)))


def _spread(pieces: Sequence[Ints], values: Sequence[float]) -> Floats:
    return np.repeat(np.array(values), [len(each) for each in pieces])


def _seen_from_paddle(run: PaddleRun, paddle: Paddle, track: Track, begin: Floats) -> Track:
    """The path as seen from the start of the paddle's core; no piece outlasts a change of the paddle's velocity."""
    ex, ey, _ = direction(paddle.rail_start, paddle.rail_end)
    half = 0.5 * track.seconds
    cx, cy, ux, uy = run.states(begin + half)
    return track.relative_to(cx - ux * half - paddle.half_width * ex, cy - uy * half - paddle.half_width * ey, ux, uy)
