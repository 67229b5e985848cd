"""Where standing elements run through each other: hardly ever meant, and a ball finds corners that nobody drew.

Walls and arcs are lines, bumpers are discs. Lines that meet at an end of one of them form a corner, and touching is no
crossing; neither is a bumper about a line's end, which rounds it.
"""

import math
from collections.abc import Iterator
from itertools import combinations
from typing import NamedTuple

from bounce_env.scene import Arc, Bumper, Element, Scene, Wall, moves

Point = tuple[float, float]

TOLERANCE = 1e-6
"""As a share of the scene's longer side: what overlaps by less is a corner with the rounding of its digits."""

OF_BALL = 1e-3
"""As a share of the ball's radius: no ball can tell the difference."""


class Crossing(NamedTuple):
    """Two elements, by their indices, and a place [m] that is inside of both."""

    first: int
    second: int
    place: Point


def crossings(scene: Scene) -> list[Crossing]:
    """Return a crossing for every two standing elements whose interiors cross, in the order of the elements."""
    left, bottom, right, top = scene.bounds
    tolerance = max(TOLERANCE * max(right - left, top - bottom), OF_BALL * scene.ball.radius)
    standing = [(i, e) for i, e in enumerate(scene.elements) if isinstance(e, Wall | Arc | Bumper) and not moves(e)]
    found = []
    for (i, one), (j, other) in combinations(standing, 2):
        place = next(_shared(one, other, tolerance), None)
        if place is not None:
            found.append(Crossing(i, j, place))
    return found


def _shared(one: Element, other: Element, tolerance: float) -> Iterator[Point]:
    """Places where the interiors of two elements cross."""
    if isinstance(other, Bumper):
        one, other = other, one
    match one, other:
        case Bumper(), Bumper():
            if math.dist(one.center, other.center) < one.radius + other.radius - tolerance:
                yield _between(one.center, other.center, 0.5)
        case Bumper(), _:
            nearest = _nearest(other, one.center)
            is_round_end = any(math.dist(end, one.center) <= tolerance for end in _ends(other))
            if math.dist(nearest, one.center) < one.radius - tolerance and not is_round_end:
                yield nearest
        case _:
            for place in _meetings(one, other, tolerance):
                if all(math.dist(place, end) > tolerance for line in (one, other) for end in _ends(line)):
                    yield place


def _meetings(one: Element, other: Element, tolerance: float) -> Iterator[Point]:
    """Places where two lines cross, ends included; of lines that lie on each other one in the middle of that."""
    match one, other:
        case Wall(), Wall():
            yield from _of_walls(one, other, tolerance)
        case Wall(), Arc():
            yield from (p for p in _on_circle(one, other, tolerance) if _holds(other, p))
        case Arc(), Wall():
            yield from _meetings(other, one, tolerance)
        case Arc(), Arc():
            yield from _of_arcs(one, other, tolerance)


def _of_walls(one: Wall, other: Wall, tolerance: float) -> Iterator[Point]:
    (x0, y0), (x1, y1) = one.start, one.end
    length = math.dist(one.start, one.end)
    ux, uy = (x1 - x0) / length, (y1 - y0) / length
    # Along `one` and to its left.
    (a, h), (b, k) = [((x - x0) * ux + (y - y0) * uy, (y - y0) * ux - (x - x0) * uy) for x, y in _ends(other)]
    if max(abs(h), abs(k)) <= tolerance:
        low, high = max(min(a, b), 0.0), min(max(a, b), length)
        if high - low > 2.0 * tolerance:
            yield _between(one.start, one.end, 0.5 * (low + high) / length)
    elif min(h, k) < -tolerance and max(h, k) > tolerance and _is_crossed(one, other, tolerance):
        along = a + (b - a) * h / (h - k)
        if 0.0 < along < length:
            yield _between(one.start, one.end, along / length)


def _is_crossed(one: Wall, other: Wall, tolerance: float) -> bool:
    """Return whether the ends of `one` lie on both sides of the line through `other`, by more than the tolerance."""
    (x0, y0), (x1, y1) = other.start, other.end
    length = math.dist(other.start, other.end)
    sides = [((y - y0) * (x1 - x0) - (x - x0) * (y1 - y0)) / length for x, y in (one.start, one.end)]
    return min(sides) < -tolerance and max(sides) > tolerance


def _on_circle(wall: Wall, arc: Arc, tolerance: float) -> Iterator[Point]:
    """Return where a wall crosses the circle of an arc: a wall that only touches it does not."""
    (x0, y0), (x1, y1) = wall.start, wall.end
    length = math.dist(wall.start, wall.end)
    ux, uy = (x1 - x0) / length, (y1 - y0) / length
    cx, cy = arc.center[0] - x0, arc.center[1] - y0
    middle, away = cx * ux + cy * uy, abs(cy * ux - cx * uy)
    if away >= arc.radius - tolerance:
        return
    half = math.sqrt(arc.radius**2 - away**2)
    for along in (middle - half, middle + half):
        if 0.0 < along < length:
            yield _between(wall.start, wall.end, along / length)


def _of_arcs(one: Arc, other: Arc, tolerance: float) -> Iterator[Point]:
    apart = math.dist(one.center, other.center)
    if apart <= tolerance:
        if abs(one.radius - other.radius) <= tolerance:
            yield from _on_one_circle(one, other, tolerance)
        return
    reach = (apart**2 + one.radius**2 - other.radius**2) / (2.0 * apart)
    if not abs(one.radius - other.radius) + tolerance < apart < one.radius + other.radius - tolerance:
        return
    half = math.sqrt(max(one.radius**2 - reach**2, 0.0))
    ux, uy = (other.center[0] - one.center[0]) / apart, (other.center[1] - one.center[1]) / apart
    for side in (-half, half):
        place = (one.center[0] + reach * ux - side * uy, one.center[1] + reach * uy + side * ux)
        if _holds(one, place) and _holds(other, place):
            yield place


def _on_one_circle(one: Arc, other: Arc, tolerance: float) -> Iterator[Point]:
    """Return a place in the middle of what two arcs of one circle share."""
    turns = round((one.start_angle - other.start_angle) / (2.0 * math.pi))
    for turn in (2.0 * math.pi * (turns + k) for k in (-1, 0, 1)):
        low = max(one.start_angle, other.start_angle + turn)
        high = min(one.end_angle, other.end_angle + turn)
        if (high - low) * one.radius > 2.0 * tolerance:
            yield _at(one, 0.5 * (low + high))


def _nearest(line: Element, point: Point) -> Point:
    """Return the point of a wall or an arc that is nearest to another one."""
    if isinstance(line, Wall):
        (x0, y0), (x1, y1) = line.start, line.end
        dx, dy = x1 - x0, y1 - y0
        share = ((point[0] - x0) * dx + (point[1] - y0) * dy) / (dx * dx + dy * dy)
        return _between(line.start, line.end, min(max(share, 0.0), 1.0))
    assert isinstance(line, Arc)
    angle = math.atan2(point[1] - line.center[1], point[0] - line.center[0])
    onto = _at(line, angle)
    return onto if _holds(line, onto) else min(_ends(line), key=lambda end: math.dist(end, point))


def _ends(line: Element) -> tuple[Point, ...]:
    if isinstance(line, Wall):
        return (line.start, line.end)
    assert isinstance(line, Arc)
    return () if line.closed else (_at(line, line.start_angle), _at(line, line.end_angle))


def _holds(arc: Arc, place: Point) -> bool:
    """Return whether a place on the circle of an arc is on the arc."""
    angle = math.atan2(place[1] - arc.center[1], place[0] - arc.center[0])
    return arc.closed or (angle - arc.start_angle) % (2.0 * math.pi) <= arc.end_angle - arc.start_angle


def _at(arc: Arc, angle: float) -> Point:
    return arc.center[0] + arc.radius * math.cos(angle), arc.center[1] + arc.radius * math.sin(angle)


def _between(start: Point, end: Point, share: float) -> Point:
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])
