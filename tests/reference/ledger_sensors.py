"""Which sensor crossings a path makes, against those that the ledger reports; and what the path went through.

Of the ledger checker: plain Python and numpy, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Scene, Sensor
from tests.reference.ledger_crossings import Circular, Curve, Straight, Swept, last_sides, passages
from tests.reference.ledger_gaps import least_gaps
from tests.reference.ledger_paths import Piece, Point, track_of
from tests.reference.ledger_shapes import Bow, Line, Shapes, direction

ULP = 2.0**-52
Switches = dict[int, list[tuple[float, bool]]]


class Touched(Protocol):
    """What of a row tells on which side of its element the ball is."""

    time: float
    element: int
    kind: int
    x: float
    y: float
    nx: float
    ny: float


class Report(NamedTuple):
    """A crossing that the ledger reports."""

    row: int
    time: float
    normal: Point


def curve_of(sensor: Sensor) -> Straight | Circular:
    if sensor.segment is not None:
        start, end = sensor.segment
        return Straight(*start, *direction(start, end))
    assert sensor.circle is not None
    return Circular(*sensor.circle[0], sensor.circle[1])


class Whole:
    """The whole path of a ball. `numbers`: those in the ledger of the rows at which pieces end."""

    def __init__(
        self,
        scene: Scene,
        pieces: Sequence[Piece],
        switches: Switches,
        size: float,
        extent: float,
        numbers: Sequence[int],
    ):
        self._numbers = numbers
        self._scene, self._pieces, self._switches = scene, pieces, switches
        self._track = track_of(pieces)
        self._begin = np.array([piece.begin for piece in pieces])
        self._contact = np.array([piece.contact for piece in pieces])
        self._boxes = self._track.box()
        self._allowed = 1e-9 * size
        farthest = max([extent, *(float(np.abs(side).max()) for side in self._boxes)])
        self._noise = 1e-12 * size + 64.0 * ULP * farthest

    def _on(self, element: int) -> npt.NDArray[np.bool_]:
        """The pieces during which an element is switched on."""
        on = np.ones(len(self._begin), bool)
        for time, value in self._switches.get(element, []):
            on[self._begin >= time] = value
        return on

    def sensors(self, reports: dict[int, list[Report]]) -> Iterator[str]:
        """Crossings that the ledger misses, and reports of none."""
        for index, element in enumerate(self._scene.elements):
            if isinstance(element, Sensor):
                yield from self._sensor(index, curve_of(element), reports.get(index, []))

    def _sensor(self, index: int, curve: Straight | Circular, reports: list[Report]) -> Iterator[str]:
        found = [
            p
            for p in passages(curve, self._pieces, self._track, self._boxes, self._on(index), self._noise)
            if p.margin >= -self._allowed and not (isinstance(curve, Circular) and p.upward)
        ]
        left = list(reports)
        for p in found:
            near = 4.0 * ULP * p.latest
            fits = [r for r in left if p.earliest - near <= r.time <= p.latest + near]
            if fits:
                left.remove(fits[0])
            elif min(p.margin, p.depth) > self._allowed:
                way = f"from {p.earliest:.9g} s to {p.latest:.9g} s"
                yield f"before row {self._numbers[p.row]}: the crossing of elements[{index}] {way} is not reported"
        last = self._pieces[-1]
        for r in left:
            if r.time < (last.begin + last.seconds) * (1.0 - 4.0 * ULP):  # at the path's end no side follows
                yield f"row {self._numbers[r.row]}: no crossing of elements[{index}] at {r.time:.9g} s"

    def penetration(self, shapes: Shapes) -> Iterator[str]:
        """Places where the path goes deeper into an element than a billionth of the scene's size."""
        yield from self._into_solids(shapes)
        for feature in shapes.features:
            match feature:
                case Line(one_way=True) | Line(reach=0.0):
                    yield from self._through(feature.element, _curve_of(feature, shapes), feature.one_way)
                case Bow(reach=0.0):
                    yield from self._through(feature.element, _curve_of(feature, shapes), False)

    def sides(self, shapes: Shapes, rows: Sequence[Touched]) -> Iterator[str]:
        """Rows in which a point is on another side of a wall or an arc than the one where it was last seen."""
        for feature in shapes.features:
            if feature.reach > 0.0 or (isinstance(feature, Line) and feature.one_way):
                continue
            curve = _curve_of(feature, shapes)
            touched = [k for k, row in enumerate(rows) if row.element == feature.element and _has_side(row)]
            before = (-2, 0.0)
            seen = last_sides(curve, self._pieces, self._track, touched, self._noise)
            for k, (sight, side) in zip(touched, seen, strict=True):
                nx, ny = curve.normal(rows[k].x, rows[k].y, rows[k].time)
                here = math.copysign(1.0, nx * rows[k].nx + ny * rows[k].ny)
                if side == -here or before == (sight, -here):
                    yield f"row {self._numbers[k]}: the ball is on the other side of elements[{feature.element}]"
                before = (sight, here)

    def _into_solids(self, shapes: Shapes) -> Iterator[str]:
        for elements, pieces, gaps in least_gaps(shapes, self._scene, self._track, self._allowed):
            for k in np.flatnonzero(gaps < -self._allowed):
                piece = self._pieces[pieces[k]]
                if self._on(elements[k])[pieces[k]]:
                    place = f"in elements[{elements[k]}] after {piece.begin:.9g} s"
                    yield f"before row {self._numbers[piece.row]}: {-gaps[k]:.3g} m deep {place}"

    def _through(self, index: int, curve: Curve, one_way: bool) -> Iterator[str]:
        for p in passages(curve, self._pieces, self._track, self._boxes, self._on(index), self._noise):
            if min(p.margin, p.depth) > self._allowed and not (one_way and p.upward):
                way = f"from {p.earliest:.9g} s to {p.latest:.9g} s"
                yield f"before row {self._numbers[p.row]}: through elements[{index}] {way}"


def _has_side(row: Touched) -> bool:
    return row.kind <= 2 and row.nx**2 + row.ny**2 > 0.5


def _curve_of(feature: Line | Bow, shapes: Shapes) -> Curve:
    if feature.element in shapes.runs:
        return Swept(shapes.runs[feature.element])
    if isinstance(feature, Bow):
        return Circular(feature.x, feature.y, feature.radius, feature.start, feature.span)
    return Straight(feature.x, feature.y, feature.ex, feature.ey, feature.length, feature.reach)
