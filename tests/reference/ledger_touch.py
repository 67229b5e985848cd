"""What the ball touches at each row of a ledger: the row's own element, and others that should have come first or next.

Of the ledger checker: plain Python and numpy, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tests.reference.ledger_motion import PartRun
from tests.reference.ledger_paths import Floats
from tests.reference.ledger_row import BOUNCE, CONTACT_BEGINS, CONTACT_ENDS, CORNER_BOUNCE, CRUSH
from tests.reference.ledger_shapes import Feature, Line, Round, Shapes
from tests.reference.ledger_walk import State

ULP = 2.0**-52
SURELY = 4.0 * ULP  # a gap that is this share of the extent or less is a touch to the engine, too
TOUCHING = 1e-12  # share of the extent within which everything counts that may have been touched

Vector = tuple[float, float]
Normals = Mapping[int, Vector]
Ledger = npt.NDArray[np.void]


class Own(NamedTuple):
    """The nearest feature of a row's element."""

    gap: float
    nx: float
    ny: float
    curvatures: tuple[float, ...]  # two where a wall passes into its round end
    owner: int  # the element that counts as struck there


class Bearing(NamedTuple):
    """One of the surfaces that a ball touches."""

    element: int
    nx: float
    ny: float
    ux: float
    uy: float
    curvature: float
    straight: bool  # a wall's face
    moves: bool = False  # it turns or stretches


class Rival(NamedTuple):
    """What else is touched, by features that the engine must have seen too."""

    faster: float  # [m/s] by how much another element was closed on faster before
    which: int  # that element, -1 if none
    first: int  # the first element of those that are closed on as fast as the row's
    closing: float  # [m/s] the fastest closing on anything after


class Touches:
    """Geometry of all bounce and contact rows at once."""

    def __init__(
        self,
        shapes: Shapes,
        ledger: Ledger,
        enabled: dict[int, list[tuple[float, bool]]],
        started: Collection[float],
        extent: float,
    ):
        """`started`: times at which the ball is given a velocity, so that this does not tell from where it came."""
        self._slack = TOUCHING * extent
        self._rows = np.flatnonzero(
            np.isin(ledger["kind"], (BOUNCE, CONTACT_BEGINS, CONTACT_ENDS, CRUSH, CORNER_BOUNCE))
        )
        table = ledger[self._rows]
        count = len(table)
        self._place = {int(row): k for k, row in enumerate(self._rows)}
        self._gap, self._nx, self._ny = np.full(count, math.inf), np.zeros(count), np.zeros(count)
        self._first, self._second = np.zeros(count), np.full(count, math.nan)
        self._fastest, self._which = np.full(count, -math.inf), np.full(count, -1)
        self._after = np.full(count, -math.inf)
        self._score, self._normals = np.full(count, math.inf), (table["nx"], table["ny"])
        self._owner, self._tied = table["element"].copy(), table["element"].copy()
        self._own = _closing(table, table["nx"], table["ny"], table["ux"], table["uy"], "vx0", "vy0")
        if count:
            self._arrived = _arrivals(table)
            self._came = ~np.isin(table["time"], list(started))
            for feature in shapes.features:
                self._add(shapes, feature, table, enabled.get(feature.element, []), extent)

    def own(self, row: int) -> Own:
        k = self._place[row]
        second = float(self._second[k])
        curvatures = (float(self._first[k]), *([] if math.isnan(second) else [second]))
        return Own(float(self._gap[k]), float(self._nx[k]), float(self._ny[k]), curvatures, int(self._owner[k]))

    def rival(self, row: int) -> Rival:
        k = self._place[row]
        fastest, closing = float(self._fastest[k] - self._own[k]), float(self._after[k])
        return Rival(fastest, int(self._which[k]), int(self._tied[k]), closing)

    def all_at(
        self, shapes: Shapes, state: State, on: Sequence[bool], pull: Vector, known: Normals, room: float = 0.0
    ) -> list[Bearing]:
        """Everything that a ball touches, or has no more than `room` [m] to.

        `known`: elements of which the side is known, with their normals.

        Of other lines that a point lies on, its side is the one from which it comes, or from which it is pressed on.
        """
        found = []
        place = [np.array([value]) for value in state]
        for feature in shapes.features:
            touch = shapes.touching(feature, *place)
            slack = self._slack + room
            if not on[feature.element] or abs(touch.gap[0]) > slack or touch.margin[0] < -slack:
                continue
            nx, ny, curvature = float(touch.nx[0]), float(touch.ny[0]), float(touch.curvature[0])
            if feature.reach == 0.0 and not (isinstance(feature, Line) and feature.one_way):
                slow = 1e-9 * math.hypot(state.vx, state.vy)
                way = pull if abs(state.vx * nx + state.vy * ny) <= slow else (state.vx, state.vy)
                out = known.get(feature.element, (-way[0], -way[1]))
                if out[0] * nx + out[1] * ny < 0.0:
                    nx, ny, curvature = -nx, -ny, -curvature
            run, ux, uy, moves = shapes.runs.get(feature.element), 0.0, 0.0, False
            if run is not None:
                at = (state.x - shapes.ball * nx, state.y - shapes.ball * ny)
                ux, uy = (float(u[0]) for u in run.core(place[0]).surface(*map(np.array, at)))
                moves = bool(run.moves(place[0])[0])
            found.append(Bearing(feature.element, nx, ny, ux, uy, curvature, isinstance(feature, Line), moves))
        return found

    def _add(
        self, shapes: Shapes, feature: Feature, table: Ledger, switched: list[tuple[float, bool]], extent: float
    ) -> None:
        t = table["time"]
        touch = shapes.touching(feature, t, table["x"], table["y"], *self._arrived)
        nx, ny, curvature = touch.nx, touch.ny, touch.curvature
        mine = table["element"] == feature.element
        if feature.reach == 0.0:  # a point lies on both sides; which one is told by the row, and by what closes
            flip = np.where(mine & (nx * table["nx"] + ny * table["ny"] < 0.0), -1.0, 1.0)
            nx, ny, curvature = flip * nx, flip * ny, flip * curvature
        owner = feature.owner if isinstance(feature, Round) else feature.element
        self._take_own(mine & (touch.margin >= -1e-9 * extent), touch.gap, nx, ny, curvature, owner, extent)
        sure = (np.abs(touch.gap) <= SURELY * extent) & (touch.margin >= 0.0) & ~_unsure(t, switched)
        ux, uy = np.zeros_like(t), np.zeros_like(t)
        if feature.element in shapes.runs:
            run = shapes.runs[feature.element]
            ux, uy = run.core(t).surface(table["x"] - shapes.ball * nx, table["y"] - shapes.ball * ny)
            # Where it is by then is known as well as the instant.
            sure &= ~_at_change(run, t) & (np.hypot(ux, uy) * t * ULP <= SURELY * extent)
        vx, vy = self._arrived
        if feature.reach == 0.0 or (isinstance(feature, Line) and feature.one_way):
            speed = np.hypot(vx, vy)
            sure &= self._came & (touch.margin > 1e-9 * extent)  # past an end is beside it
            came = nx * (vx - ux) + ny * (vy - uy)
            sure &= came < -1e-9 * (speed + np.hypot(ux, uy))  # along the surface nothing tells its side
        before = np.where(sure, _closing(table, nx, ny, ux, uy, "vx0", "vy0"), -math.inf)
        after = np.where(sure, _closing(table, nx, ny, ux, uy, "vx1", "vy1"), -math.inf)
        better = before > self._fastest
        self._fastest, self._which = (
            np.where(better, before, self._fastest),
            np.where(better, feature.element, self._which),
        )
        self._after = np.maximum(self._after, after)
        alike = np.abs(before - self._own) <= ULP * np.hypot(table["vx0"], table["vy0"])
        self._tied = np.where(alike, np.minimum(self._tied, feature.element), self._tied)

    def _take_own(
        self,
        mine: npt.NDArray[np.bool_],
        gap: Floats,
        nx: Floats,
        ny: Floats,
        curvature: Floats,
        owner: int,
        extent: float,
    ) -> None:
        # Where two features meet, both are touched: the row tells by its normal which of them it means.
        off = np.hypot(nx - self._normals[0], ny - self._normals[1])
        score = np.where(np.abs(gap) <= 1e-9 * extent, off, 10.0 + np.abs(gap))
        better = mine & (score < self._score - 1e-9)  # of a face that passes into its end the face is meant
        also = mine & ~better & (score < 1e-6) & (self._score < 1e-6) & (curvature != self._first)
        self._second = np.where(also, curvature, self._second)
        passed_on = better & (self._score < 1e-6) & (score < 1e-6) & (curvature != self._first)
        self._second = np.where(passed_on, self._first, np.where(better, math.nan, self._second))
        values = {"_gap": gap, "_nx": nx, "_ny": ny, "_first": curvature, "_owner": owner, "_score": score}
        for name, value in values.items():
            setattr(self, name, np.where(better, value, getattr(self, name)))


def _closing(table: Ledger, nx: Floats, ny: Floats, ux: Floats, uy: Floats, vx: str, vy: str) -> Floats:
    return -((table[vx] - ux) * nx + (table[vy] - uy) * ny)


def _arrivals(table: Ledger) -> tuple[Floats, Floats]:
    """The velocity with which the ball came to the instant of each row."""
    new = np.concatenate([[True], np.diff(table["time"]) != 0.0])
    first = np.maximum.accumulate(np.where(new, np.arange(len(table)), 0))
    return table["vx0"][first], table["vy0"][first]


def _unsure(t: Floats, switched: list[tuple[float, bool]]) -> npt.NDArray[np.bool_]:
    """Where an element is off, or may be: at the very time of the switch."""
    off = np.zeros(t.shape, bool)
    for time, on in switched:
        off = np.where(t > time, not on, off) | (t == time)
    return off


def _at_change(run: PartRun, t: Floats) -> npt.NDArray[np.bool_]:
    near = np.zeros(t.shape, bool)
    for time in run.changes:
        near |= np.abs(t - time) <= 1e-9 * (1.0 + time)
    return near
