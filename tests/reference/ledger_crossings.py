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
from ledger_paths import HALVINGS, Floats, Piece, Point, Track, turning_time, turning_times

from bounce_env.scene.base import Box


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

    def height(self, x: float, y: float) -> float:
        return self.ex * (y - self.y) - self.ey * (x - self.x) - self.offset

    def margin(self, x: float, y: float) -> float:
        """How far inside its span a point of the curve is [m]."""
        along = self.ex * (x - self.x) + self.ey * (y - self.y)
        return min(along, self.length - along)

    def normal(self, x: float, y: float) -> Point:
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

    def height(self, x: float, y: float) -> float:
        return math.hypot(x - self.x, y - self.y) - self.radius

    def margin(self, x: float, y: float) -> float:
        if self.span >= 2.0 * math.pi:
            return math.inf
        angle = math.fmod(math.atan2(y - self.y, x - self.x) - self.start, 2.0 * math.pi)
        angle += 2.0 * math.pi if angle < 0.0 else 0.0
        inside = min(angle, self.span - angle)
        return self.radius * (max(inside, angle - 2.0 * math.pi) if inside < 0.0 else inside)

    def normal(self, x: float, y: float) -> Point:
        distance = math.hypot(x - self.x, y - self.y)
        return (x - self.x) / distance, (y - self.y) / distance

    def box(self) -> Box:
        return self.x - self.radius, self.y - self.radius, self.x + self.radius, self.y + self.radius


class Passage(NamedTuple):
    """From before `earliest` to after `latest` [s since reset] the path came from one side of a curve to the other."""

    earliest: float
    latest: float
    upward: bool
    margin: float  # [m] how far inside the curve's span
    depth: float  # [m] how far away from the curve it was on the side where it was less far
    row: int  # that ends the piece


def passages(
    curve: Straight | Circular,
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
            x, y = _place_between(curve, before, t[i], t[j])
        else:
            x, y, _, _ = pieces[near[(j - 1) // cuts]].at(t[j - 1])
        yield Passage(
            before.begin + t[i],
            after.begin + t[j],
            bool(up[at + 1]),
            curve.margin(x, y),
            float(min(depth[run - 1], depth[run])),
            after.row,
        )


def last_sides(
    curve: Straight | Circular, pieces: Sequence[Piece], track: Track, rows: Sequence[int], noise: float
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
        x, y, _, _ = pieces[at // cuts].at(t[at])
        yield last, math.copysign(1.0, h[at]) if curve.margin(x, y) > 0.0 else 0.0


def _place_between(curve: Straight | Circular, piece: Piece, low: float, high: float) -> Point:
    first = curve.height(*piece.at(low)[:2]) > 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if (curve.height(*piece.at(middle)[:2]) > 0.0) == first:
            low = middle
        else:
            high = middle
    x, y, _, _ = piece.at(high)
    return x, y
