"""Pieces of a ball's path on which its acceleration is constant, and where such pieces come closest to a shape.

Of the ledger checker: plain Python and numpy, no code of the engine. Times within a piece count from its beginning.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Field

Floats = npt.NDArray[np.float64]
Point = tuple[float, float]
SAMPLES = np.linspace(0.0, 1.0, 17)  # shares of a piece looked at besides the exact candidates
HALVINGS = 52
HALVINGS_OF_EXTREMA = 30  # where a distance turns, its error goes with the square of the time's


class Piece(NamedTuple):
    begin: float  # [s] since reset
    seconds: float
    x: float
    y: float
    vx: float
    vy: float
    ax: float
    ay: float
    contact: int  # the element along which it slides or is held, -1 in flight
    row: int  # the ledger's row at which it ends

    def at(self, t: float) -> tuple[float, float, float, float]:
        """x, y, vx, vy after `t` seconds."""
        vx, vy = self.vx + self.ax * t, self.vy + self.ay * t
        return self.x + (self.vx + 0.5 * self.ax * t) * t, self.y + (self.vy + 0.5 * self.ay * t) * t, vx, vy


class Track(NamedTuple):
    """Many pieces as columns; positions and velocities may be relative to something that moves."""

    seconds: Floats
    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    ax: Floats
    ay: Floats
    begin: Floats  # [s] since reset

    def of(self, rows: npt.NDArray[np.int64]) -> Track:
        return Track(*(column[rows] for column in self))

    def relative_to(self, x: Floats | float, y: Floats | float, ux: Floats | float = 0.0, uy: Floats | float = 0.0):
        """The path as seen from points at (x, y) that move at (ux, uy)."""
        return self._replace(x=self.x - x, y=self.y - y, vx=self.vx - ux, vy=self.vy - uy)

    def along(self, ex: float | Floats, ey: float | Floats) -> tuple[Floats, Floats, Floats]:
        """Position, speed and half the acceleration along a direction: coefficients of a parabola in time."""
        return ex * self.x + ey * self.y, ex * self.vx + ey * self.vy, 0.5 * (ex * self.ax + ey * self.ay)

    def at(self, t: Floats) -> tuple[Floats, Floats]:
        """Positions at times of shape (pieces, k)."""
        x, y, vx, vy, ax, ay = (column[:, None] for column in self[1:7])
        return x + (vx + 0.5 * ax * t) * t, y + (vy + 0.5 * ay * t) * t

    def box(self) -> tuple[Floats, Floats, Floats, Floats]:
        """x_min, y_min, x_max, y_max of each piece."""
        low_high = []
        for p, v, a in ((self.x, self.vx, self.ax), (self.y, self.vy, self.ay)):
            turn = turning_time(v, 0.5 * a, self.seconds)
            ends = np.stack([p, p + (v + 0.5 * a * turn) * turn, p + (v + 0.5 * a * self.seconds) * self.seconds])
            low_high.append((ends.min(0), ends.max(0)))
        return low_high[0][0], low_high[1][0], low_high[0][1], low_high[1][1]


def track_of(pieces: Sequence[Piece]) -> Track:
    columns = np.array([(*piece[1:8], piece.begin) for piece in pieces], np.float64).reshape(-1, 8)
    return Track(*columns.T.copy())


def turning_time(speed: Floats, half: Floats, end: Floats) -> Floats:
    """When the parabola c + speed t + half t^2 turns, within [0, end]."""
    with np.errstate(divide="ignore", invalid="ignore"):
        t = -0.5 * speed / half
    return np.clip(np.where(np.isfinite(t), t, 0.0), 0.0, end)


def parabola_roots(c: Floats, b: Floats, a: Floats, end: Floats) -> Floats:
    """Times in [0, end] at which c + b t + a t^2 vanishes, shape (pieces, 2); a border where there is none."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        q = -0.5 * (b + np.copysign(np.sqrt(np.maximum(b * b - 4.0 * a * c, 0.0)), b))
        both = np.stack([c / q, q / a], 1)
    return np.clip(np.where(np.isfinite(both), both, 0.0), 0.0, end[:, None])


def turning_times(track: Track) -> Floats:
    """0, the times at which the distance from the origin has an extremum, and the end; shape (pieces, 5), ascending.

    The derivative of the squared distance is a cubic; between the extrema of that cubic its roots are bisected.
    """
    end, zero = track.seconds, np.zeros_like(track.seconds)
    c0 = track.x * track.vx + track.y * track.vy
    c1 = track.vx**2 + track.vy**2 + track.x * track.ax + track.y * track.ay
    c2 = 1.5 * (track.vx * track.ax + track.vy * track.ay)
    c3 = 0.5 * (track.ax**2 + track.ay**2)
    if not c3.any():
        with np.errstate(divide="ignore", invalid="ignore"):
            t = -c0 / c1
        t = np.clip(np.where(np.isfinite(t), t, 0.0), 0.0, end)
        return np.stack([zero, t, t, t, end], 1)
    cuts = np.sort(np.column_stack([zero, parabola_roots(c1, 2.0 * c2, 3.0 * c3, end), end]), 1)

    def rate(t: Floats) -> Floats:
        return ((c3[:, None] * t + c2[:, None]) * t + c1[:, None]) * t + c0[:, None]

    low, high = cuts[:, :-1].copy(), cuts[:, 1:].copy()
    rising = rate(low) < 0.0
    crossed = rising != (rate(high) < 0.0)
    for _ in range(HALVINGS_OF_EXTREMA):
        middle = 0.5 * (low + high)
        before = (rate(middle) < 0.0) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.column_stack([zero, np.sort(np.where(crossed, low, cuts[:, :-1]), 1), end])


def sampled(track: Track, *candidates: Floats) -> Floats:
    """The candidate times together with evenly spaced ones."""
    return np.column_stack([*candidates, track.seconds[:, None] * SAMPLES])


def to_point(track: Track) -> Floats:
    """Each piece's least distance from the origin."""
    x, y = track.at(sampled(track, turning_times(track)))
    return np.sqrt(x * x + y * y).min(1)


def to_segment(track: Track, ex: Floats, ey: Floats, length: Floats) -> Floats:
    """Each piece's least distance from a segment that runs `length` from the origin along (ex, ey)."""
    end, s, h = track.seconds, track.along(ex, ey), track.along(-ey, ex)
    times = sampled(
        track,
        parabola_roots(*s, end),
        parabola_roots(s[0] - length, *s[1:], end),
        parabola_roots(*h, end),
        turning_time(*h[1:], end),
        turning_times(track),
        turning_times(track.relative_to(length * ex, length * ey)),
    )
    x, y = track.at(times)
    ex, ey = ex[:, None], ey[:, None]
    beyond = ex * x + ey * y
    beyond -= np.clip(beyond, 0.0, length[:, None])
    return np.hypot(beyond, ex * y - ey * x).min(1)


def to_arc(track: Track, radius: float, start: float, span: float) -> Floats:
    """Each piece's least distance from an arc about the origin, from angle `start` on counter-clockwise."""
    end, knots = track.seconds, turning_times(track)
    tips = [(math.cos(angle), math.sin(angle)) for angle in (start, start + span)]
    times = sampled(
        track,
        knots,
        circle_roots(track, knots, radius),
        *(parabola_roots(*track.along(-ty, tx), end) for tx, ty in tips),
        *(turning_times(track.relative_to(radius * tx, radius * ty)) for tx, ty in tips),
    )
    x, y = track.at(times)
    facing = np.mod(np.arctan2(y, x) - start, 2.0 * math.pi) <= span
    (ax, ay), (bx, by) = tips
    nearest_tip = np.minimum(np.hypot(x - radius * ax, y - radius * ay), np.hypot(x - radius * bx, y - radius * by))
    return np.where(facing, np.abs(np.hypot(x, y) - radius), nearest_tip).min(1)


def circle_roots(track: Track, knots: Floats, radius: float) -> Floats:
    """Times at which the distance from the origin is `radius`, one for each interval between knots (or its end)."""

    def outside(t: Floats) -> npt.NDArray[np.bool_]:
        x, y = track.at(t)
        return np.hypot(x, y) > radius

    low, high = knots[:, :-1].copy(), knots[:, 1:].copy()
    first = outside(low)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = outside(middle) == first
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return high


class Pull:
    """Gravity and the fields that are switched on."""

    def __init__(self, gravity: Point, fields: Sequence[Field]) -> None:
        self.gravity = gravity
        self.fields = [(self._edges(field), field.acceleration) for field in fields]

    @staticmethod
    def _edges(field: Field) -> list[tuple[float, float, float, float]]:
        """A corner and the inward direction across the side that begins there, for each side."""
        corners = field.points
        sides = [(p, (q[0] - p[0], q[1] - p[1])) for p, q in zip(corners, (*corners[1:], corners[0]), strict=True)]
        (ax, ay), (bx, by) = sides[0][1], sides[1][1]
        turn = math.copysign(1.0, ax * by - ay * bx)
        return [(x, y, -turn * dy / math.hypot(dx, dy), turn * dx / math.hypot(dx, dy)) for (x, y), (dx, dy) in sides]

    def at(self, x: float, y: float) -> Point:
        """The acceleration [m/s^2] at a place."""
        ax, ay = self.gravity
        for edges, (fx, fy) in self.fields:
            if all((x - px) * nx + (y - py) * ny > 0.0 for px, py, nx, ny in edges):
                ax, ay = ax + fx, ay + fy
        return ax, ay

    def borders(self, piece: Piece) -> list[float]:
        """Times, ascending and within the piece, at which the line of a field's side is passed."""
        found = set()
        for edges, _ in self.fields:
            for px, py, nx, ny in edges:
                c, b = (piece.x - px) * nx + (piece.y - py) * ny, piece.vx * nx + piece.vy * ny
                a = 0.5 * (piece.ax * nx + piece.ay * ny)
                root = b * b - 4.0 * a * c
                if root >= 0.0:
                    q = -0.5 * (b + math.copysign(math.sqrt(root), b))
                    found |= {c / q if q else 0.0, q / a if a else 0.0}
        return sorted(t for t in found if 0.0 < t < piece.seconds)
