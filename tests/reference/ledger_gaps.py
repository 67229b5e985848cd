"""How near a path comes to what has a thickness: elements that stand or move, and other balls.

Of the ledger checker: plain Python and numpy, no code of the engine. Least distances from what stands or moves as one
are exact; from what turns or stretches they are bracketed, with a bound that no dip between two samples escapes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from bounce_env.scene import Arc, Bumper, Scene, Wall
from tests.reference.ledger_motion import Core, PartRun
from tests.reference.ledger_paths import Floats, Piece, Track, to_arc, to_point, to_segment, track_of
from tests.reference.ledger_shapes import Ints, Shapes, direction


class Gaps(NamedTuple):
    """Least gaps [m] of pieces of a path to elements, one entry a pair of them."""

    element: Ints
    piece: Ints
    gap: Floats


def least_gaps(shapes: Shapes, scene: Scene, track: Track, allowed: float) -> Iterator[Gaps]:
    """For every element with a thickness, the pieces of the path that come near it; to within `allowed` [m].

    Without those that only direction or side can tell: a point's walls and arcs, and one-way walls.
    """
    left, below, right, above = track.box()
    points: list[tuple[Ints, Ints, Track, float]] = []  # elements, pieces, paths seen from the centre, reach
    segments: list[tuple[Ints, Ints, Track, float, tuple[float, float, float]]] = []
    for index, element in enumerate(scene.elements):
        if index in shapes.runs:
            yield from _to_part(index, shapes.runs[index], shapes.ball, track, allowed)
            continue
        if not isinstance(element, Wall | Bumper | Arc):
            continue
        reach = shapes.ball + (element.radius if isinstance(element, Bumper) else 0.0)
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


# ---- parts; no piece outlasts a change of their velocities


def _to_part(index: int, run: PartRun, ball: float, track: Track, allowed: float) -> Iterator[Gaps]:
    reach = run.radius + ball
    if reach == 0.0:
        return
    middle = track.begin + 0.5 * track.seconds
    moves = run.moves(middle)
    uniform, turning = np.flatnonzero(~moves), np.flatnonzero(moves)
    if uniform.size:
        core, half = run.core(middle[uniform]), 0.5 * track.seconds[uniform]
        x, y = core.x0 - core.vx0 * half, core.y0 - core.vy0 * half
        seen = track.of(uniform).relative_to(x, y, core.vx0, core.vy0)
        dx, dy = core.x1 - core.x0, core.y1 - core.y0
        length = np.hypot(dx, dy)
        gaps = to_segment(seen, dx / length, dy / length, length) if run.length > 0.0 else to_point(seen)
        yield Gaps(np.full(uniform.shape, index), uniform, gaps - reach)
    if turning.size:
        gaps = _to_turning(track.of(turning), middle[turning], run, reach, allowed)
        yield Gaps(np.full(turning.shape, index), turning, gaps)


def _to_turning(track: Track, middle: Floats, run: PartRun, reach: float, allowed: float) -> Floats:
    """Least gaps to a part that turns or stretches.

    The gap f has f'' >= -A (see `_bound`), so that between two times it lies above both of the parabolas that leave
    them at its own slopes and bend down by A: it is no less than where these meet. Spans in which that may be a dip
    are halved.
    """

    def look(piece: Ints, t: Floats) -> tuple[Floats, Floats]:
        """The gap and its rate; velocities of a part are those in the middle of a piece."""
        here = track.of(piece)
        x, y = (column[:, 0] for column in here.at(t[:, None]))
        core = run.core(here.begin + t)
        meanwhile = run.core(middle[piece])
        gap, rate = _from_segment(core, meanwhile, x, y, here.vx + here.ax * t, here.vy + here.ay * t)
        return gap - reach, rate

    piece = np.arange(len(middle))
    low, high = np.zeros(len(middle)), track.seconds.copy()
    (low_gap, low_rate), (high_gap, high_rate) = look(piece, low), look(piece, high)
    least = np.minimum(low_gap, high_gap)
    while piece.size:
        bend, h = _bound(track.of(piece), middle[piece], low, high, run), high - low
        with np.errstate(divide="ignore", invalid="ignore"):
            meet = (high_gap - low_gap - high_rate * h - 0.5 * bend * h * h) / (low_rate - high_rate - bend * h)
        meet = np.clip(np.where(np.isfinite(meet), meet, 0.5 * h), 0.0, h)
        dip = low_gap + (low_rate - 0.5 * bend * meet) * meet
        # What is deep in already needs no further look.
        open_ = (np.minimum(dip, np.minimum(low_gap, high_gap)) < -1.5 * allowed) & (least[piece] >= -allowed)
        columns = (piece, low, high, low_gap, high_gap, low_rate, high_rate)
        piece, low, high, low_gap, high_gap, low_rate, high_rate = (column[open_] for column in columns)
        centre = 0.5 * (low + high)
        gap, rate = look(piece, centre)
        np.minimum.at(least, piece, gap)
        piece = np.concatenate([piece, piece])
        low, high = np.concatenate([low, centre]), np.concatenate([centre, high])
        low_gap, high_gap = np.concatenate([low_gap, gap]), np.concatenate([gap, high_gap])
        low_rate, high_rate = np.concatenate([low_rate, rate]), np.concatenate([rate, high_rate])
    return least


def _from_segment(core: Core, moving: Core, x: Floats, y: Floats, vx: Floats, vy: Floats) -> tuple[Floats, Floats]:
    """Distance from a core and its rate of change; `moving` tells how the core turns or how its ends move."""
    dx, dy = core.x1 - core.x0, core.y1 - core.y0
    share = np.clip(((x - core.x0) * dx + (y - core.y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
    ex, ey = moving.vx1 - moving.vx0, moving.vy1 - moving.vy0
    turns = moving.spin != 0.0  # then the tip's velocity has turned since
    ex, ey = np.where(turns, -moving.spin * dy, ex), np.where(turns, moving.spin * dx, ey)
    px, py = x - core.x0 - share * dx, y - core.y0 - share * dy
    distance = np.hypot(px, py)
    rate = px * (vx - moving.vx0 - share * ex) + py * (vy - moving.vy0 - share * ey)
    return distance, rate / np.maximum(distance, 1e-300)


def _bound(track: Track, middle: Floats, low: Floats, high: Floats, run: PartRun) -> Floats:
    """A with f'' >= -A for the gap f to a part that turns or stretches, between two times of each piece.

    About its start, in the frame that turns with it at w, a ball at p of velocity u has the acceleration
    g - 2 w x u - w^2 p - w' x p; of a wall whose ends spread at E, |w'| |p| <= 2 |w| |E| where the ball is beside it.
    About its ends the gap is that to a point, and bent less.
    """
    core, half, seconds = run.core(middle), 0.5 * track.seconds, high - low
    # At `low`, relative to the start of the core.
    since = low - half
    x0, y0 = core.x0 + core.vx0 * since, core.y0 + core.vy0 * since
    px, py = (column[:, 0] for column in track.at(low[:, None]))
    ux, uy = track.vx + track.ax * low - core.vx0, track.vy + track.ay * low - core.vy0
    pull = np.hypot(track.ax, track.ay)
    speed = np.hypot(ux, uy) + pull * seconds
    far = np.hypot(px - x0, py - y0) + speed * seconds
    ex, ey = core.vx1 - core.vx0, core.vy1 - core.vy0
    dx, dy = core.x1 - core.x0 + ex * since, core.y1 - core.y0 + ey * since
    square = ex * ex + ey * ey
    stretches = (core.spin == 0.0) & (square > 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        nearest = np.where(stretches, np.clip(-(dx * ex + dy * ey) / square, 0.0, seconds), 0.0)
        shortest = (dx + ex * nearest) ** 2 + (dy + ey * nearest) ** 2
        spin = np.where(stretches, np.abs(dx * ey - dy * ex) / shortest, np.abs(core.spin))
    spread = np.where(stretches, np.sqrt(square), 0.0)
    bound = pull + spin * (2.0 * (speed + spread) + spin * far)
    return 1.000001 * bound


# ---- other balls


def least_distances(one: Sequence[Piece], other: Sequence[Piece]) -> tuple[Floats, Ints, Floats]:
    """Least distances [m] of the centres of two balls, the first one's piece in each, and when each begins [s]."""
    begins = [np.array([piece.begin for piece in path]) for path in (one, other)]
    end = min(path[-1].begin + path[-1].seconds for path in (one, other))
    times = np.unique(np.concatenate(begins))
    times = times[times < end]
    which = [np.maximum(np.searchsorted(begin, times, side="right") - 1, 0) for begin in begins]
    tracks = [track_of(path).of(w) for path, w in zip((one, other), which, strict=True)]
    moved = []
    for track, begin, w in zip(tracks, begins, which, strict=True):
        since = times - begin[w]
        x, y = (column[:, 0] for column in track.at(since[:, None]))
        moved.append((x, y, track.vx + track.ax * since, track.vy + track.ay * since, track.ax, track.ay))
    seconds = np.diff(np.append(times, end))
    return to_point(Track(seconds, *(a - b for a, b in zip(*moved, strict=True)), times)), which[0], times
