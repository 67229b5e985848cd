"""Where a path passes from one side of a curve to the other: sensors, a point's walls and arcs, one-way walls.

Of the ledger checker: plain Python and numpy, no code of the engine. Each piece of the path is cut where its height
over the curve turns, so that between two cuts the height is monotonic: a passage is a change of its sign from cut to
cut, at whatever event it may happen.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.scene.base import Box
from tests.reference.ledger_motion import PartRun
from tests.reference.ledger_paths import (
    HALVINGS,
    Floats,
    Piece,
    Point,
    Track,
    parabola_roots,
    turning_time,
    turning_times,
)


class Straight(NamedTuple):
    """A segment from (x, y), or its parallel at `offset` to the left."""

    x: float
    y: float
    ex: float
    ey: float
    length: float
    offset: float = 0.0

    def heights(self, track: Track) -> tuple[Floats, Floats]:
        """Cuts (pieces, k) and heights over the curve there [m]."""
        c, b, a = track.relative_to(self.x, self.y).along(-self.ey, self.ex)
        end = track.seconds
        t = np.stack([np.zeros_like(end), turning_time(b, a, end), end], 1)
        return t, c[:, None] + (b[:, None] + a[:, None] * t) * t - self.offset

    def height(self, x: float, y: float, t: float = 0.0) -> float:
        return self.ex * (y - self.y) - self.ey * (x - self.x) - self.offset

    def margin(self, x: float, y: float, t: float = 0.0) -> float:
        """How far inside its span a point of the curve is [m]."""
        along = self.ex * (x - self.x) + self.ey * (y - self.y)
        return min(along, self.length - along)

    def normal(self, x: float, y: float, t: float = 0.0) -> Point:
        """Towards positive heights."""
        return -self.ey, self.ex

    def box(self) -> Box:
        x0, y0 = self.x - self.offset * self.ey, self.y + self.offset * self.ex
        x1, y1 = x0 + self.length * self.ex, y0 + self.length * self.ey
        return min(x0, x1), min(y0, y1), max(x0, x1), max(y0, y1)


class Circular(NamedTuple):
    """A circle, or the part of it from angle `start` on; outside is above."""

    x: float
    y: float
    radius: float
    start: float = 0.0
    span: float = 2.0 * math.pi

    def heights(self, track: Track) -> tuple[Floats, Floats]:
        seen = track.relative_to(self.x, self.y)
        t = turning_times(seen)
        return t, np.hypot(*seen.at(t)) - self.radius

    def height(self, x: float, y: float, t: float = 0.0) -> float:
        return math.hypot(x - self.x, y - self.y) - self.radius

    def margin(self, x: float, y: float, t: float = 0.0) -> float:
        if self.span >= 2.0 * math.pi:
            return math.inf
        angle = math.fmod(math.atan2(y - self.y, x - self.x) - self.start, 2.0 * math.pi)
        angle += 2.0 * math.pi if angle < 0.0 else 0.0
        inside = min(angle, self.span - angle)
        return self.radius * (max(inside, angle - 2.0 * math.pi) if inside < 0.0 else inside)

    def normal(self, x: float, y: float, t: float = 0.0) -> Point:
        distance = math.hypot(x - self.x, y - self.y)
        return (x - self.x) / distance, (y - self.y) / distance

    def box(self) -> Box:
        return self.x - self.radius, self.y - self.radius, self.x + self.radius, self.y + self.radius


class Swept(NamedTuple):
    """A dragged wall; places are seen at a time `t` [s]. No piece of a path outlasts a change of its velocities."""

    run: PartRun

    def heights(self, track: Track) -> tuple[Floats, Floats]:
        """As of a `Straight`: times the wall's length the height is a cubic in time."""
        end, half = track.seconds, 0.5 * track.seconds
        core = self.run.core(track.begin + half)
        seen = track.relative_to(core.x0 - core.vx0 * half, core.y0 - core.vy0 * half, core.vx0, core.vy0)
        ex, ey = core.vx1 - core.vx0, core.vy1 - core.vy0
        dx, dy = core.x1 - core.x0 - ex * half, core.y1 - core.y0 - ey * half
        d, e = seen.along(-dy, dx), seen.along(-ey, ex)
        c0, c1, c2, c3 = d[0], d[1] + e[0], d[2] + e[1], e[2]
        turns = parabola_roots(c1, 2.0 * c2, 3.0 * c3, end)
        t = np.sort(np.column_stack([np.zeros_like(end), turns, end]), 1)
        area = c0[:, None] + (c1[:, None] + (c2[:, None] + c3[:, None] * t) * t) * t
        return t, area / np.hypot(dx[:, None] + ex[:, None] * t, dy[:, None] + ey[:, None] * t)

    def _at(self, t: float) -> Straight:
        x0, y0, x1, y1 = (float(column[0]) for column in self.run.core(np.array([t]))[:4])
        length = math.hypot(x1 - x0, y1 - y0)
        return Straight(x0, y0, (x1 - x0) / length, (y1 - y0) / length, length)

    def height(self, x: float, y: float, t: float) -> float:
        return self._at(t).height(x, y)

    def margin(self, x: float, y: float, t: float) -> float:
        return self._at(t).margin(x, y)

    def normal(self, x: float, y: float, t: float) -> Point:
        return self._at(t).normal(x, y)

    def box(self) -> Box:
        return -math.inf, -math.inf, math.inf, math.inf


Curve = Straight | Circular | Swept


class Passage(NamedTuple):
    """From before `earliest` to after `latest` [s since reset] the path came from one side of a curve to the other."""

    earliest: float
    latest: float
    upward: bool
    margin: float  # [m] how far inside the curve's span
    depth: float  # [m] how far away from the curve it was on the side where it was less far
    row: int  # that ends the piece


def passages(
    curve: Curve,
    pieces: Sequence[Piece],
    track: Track,
    boxes: tuple[Floats, Floats, Floats, Floats],
    usable: npt.NDArray[np.bool_],
    noise: float,
) -> Iterator[Passage]:
    """All passages, in order of time. Heights below `noise` [m] have no sign; pieces not `usable` are not looked at."""
    x0, y0, x1, y1 = curve.box()
    left, below, right, above = boxes
    pad = 4.0 * noise
    meets = (left <= x1 + pad) & (right >= x0 - pad) & (below <= y1 + pad) & (above >= y0 - pad)
    near = np.flatnonzero(meets & usable)
    if not near.size:
        return
    times, heights = curve.heights(track.of(near))
    cuts = times.shape[1]
    t, h = times.ravel(), heights.ravel()
    signed = np.flatnonzero(np.abs(h) > noise)
    if not signed.size:
        return
    rank = signed // cuts
    unbroken = near[rank[1:]] - near[rank[:-1]] == rank[1:] - rank[:-1]
    up = h[signed] > 0.0
    turned = up[1:] != up[:-1]
    begins = np.concatenate([[0], np.flatnonzero(turned | ~unbroken) + 1])
    depth = np.maximum.reduceat(np.abs(h[signed]), begins)
    for run in range(1, len(begins)):
        at = begins[run] - 1
        if not (turned[at] and unbroken[at]):
            continue
        i, j = int(signed[at]), int(signed[at + 1])
        before, after = pieces[near[i // cuts]], pieces[near[j // cuts]]
        if j == i + 1 and before is after:
            x, y, when = _place_between(curve, before, t[i], t[j])
        else:
            piece = pieces[near[(j - 1) // cuts]]
            x, y, _, _ = piece.at(t[j - 1])
            when = piece.begin + t[j - 1]
        yield Passage(
            before.begin + t[i],
            after.begin + t[j],
            bool(up[at + 1]),
            curve.margin(x, y, when),
            float(min(depth[run - 1], depth[run])),
            after.row,
        )


def last_sides(
    curve: Curve, pieces: Sequence[Piece], track: Track, rows: Sequence[int], noise: float
) -> Iterator[tuple[int, float]]:
    """On which side of a curve a ball was last seen before each of some rows, and which sight (a number) that was.

    1 above, -1 below, 0 if that was not beside the curve, or the ball has not been seen off it.
    """
    times, heights = curve.heights(track)
    cuts = times.shape[1]
    t, h = times.ravel(), heights.ravel()
    signed = np.flatnonzero(np.abs(h) > noise)
    ends = np.array([piece.row for piece in pieces])
    for row in rows:
        last = int(np.searchsorted(signed, cuts * np.searchsorted(ends, row, side="right"))) - 1
        if last < 0:
            yield last, 0.0
            continue
        at = int(signed[last])
        piece = pieces[at // cuts]
        x, y, _, _ = piece.at(t[at])
        yield last, math.copysign(1.0, h[at]) if curve.margin(x, y, piece.begin + t[at]) > 0.0 else 0.0


def _place_between(curve: Curve, piece: Piece, low: float, high: float) -> tuple[float, float, float]:
    """Where, and when, a piece passes the curve between two of its times."""

    def is_above(t: float) -> bool:
        return curve.height(*piece.at(t)[:2], piece.begin + t) > 0.0

    first = is_above(low)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if is_above(middle) == first:
            low = middle
        else:
            high = middle
    x, y, _, _ = piece.at(high)
    return x, y, piece.begin + high
