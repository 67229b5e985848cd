"""What of a scene a picture shows, and what in it is solid."""

from collections import defaultdict
from collections.abc import Collection

from bounce_env.scene import Box, Field, Scene, Sensor, Wall
from bounce_env.scene.base import Point, union

LARGEST_ISLAND = 0.1
"""As a share of the box around all that bounces: what walls enclose is solid, unless balls may play inside."""


def view_box(scene: Scene) -> Box:
    """Return the box that pictures show: x_min, y_min, x_max, y_max in metres.

    Of all that bounces the ball. A sensor that reaches beyond, as a drain may, counts only where nothing of it lies
    within; so does a field.
    """
    solid = [e.bounds for e in scene.elements if not isinstance(e, Sensor | Field)]
    if not solid:
        return scene.bounds
    box = union(solid)
    others = (e for e in scene.elements if isinstance(e, Sensor | Field))
    return union([box, *(other.bounds for other in others if not _is_seen(other, box))])


def _is_seen(region: Sensor | Field, box: Box) -> bool:
    """Return whether some of a region lies in a box; of one that is no segment its own box is asked."""
    if isinstance(region, Sensor) and region.segment is not None:
        return clipped(region.segment, box) is not None
    one = region.bounds
    return one[0] <= box[2] and box[0] <= one[2] and one[1] <= box[3] and box[1] <= one[3]


def clipped(segment: tuple[Point, Point], box: Box) -> tuple[Point, Point] | None:
    """Return the part of a segment that lies in a box; None where there is none. Liang and Barsky, 1984."""
    (x0, y0), (x1, y1) = segment
    first, last = 0.0, 1.0
    for start, way, low, high in ((x0, x1 - x0, box[0], box[2]), (y0, y1 - y0, box[1], box[3])):
        if way == 0.0:
            if not low <= start <= high:
                return None
            continue
        enter, leave = sorted(((low - start) / way, (high - start) / way))
        first, last = max(first, enter), min(last, leave)
    if first >= last:
        return None
    return (x0 + first * (x1 - x0), y0 + first * (y1 - y0)), (x0 + last * (x1 - x0), y0 + last * (y1 - y0))


def islands(scene: Scene, hidden: Collection[int] = ()) -> list[tuple[Point, ...]]:
    """Return the corners of each closed chain of standing walls, of which no three meet at a corner, that is small.

    hidden: elements that are not looked at.
    """
    walls = [
        e
        for i, e in enumerate(scene.elements)
        if isinstance(e, Wall) and not (e.draggable or e.one_way) and i not in hidden
    ]
    neighbours: dict[Point, list[Point]] = defaultdict(list)
    for wall in walls:
        neighbours[wall.start].append(wall.end)
        neighbours[wall.end].append(wall.start)
    left, bottom, right, top = union(e.bounds for e in scene.elements if not isinstance(e, Sensor | Field))
    largest = LARGEST_ISLAND * (right - left) * (top - bottom)
    found, seen = [], set[Point]()
    for first in neighbours:
        chain = _chain(first, neighbours) if first not in seen else ()
        seen.update(chain)
        if len(chain) > 2 and _area(chain) < largest:
            found.append(chain)
    return found


def _chain(first: Point, neighbours: dict[Point, list[Point]]) -> tuple[Point, ...]:
    """Return the corners from one on until it comes back to the first; () where the chain ends or branches."""
    chain = [first]
    before, corner = first, neighbours[first][0]
    while corner != first and len(neighbours[corner]) == 2 and len(chain) <= len(neighbours):
        chain.append(corner)
        one, other = neighbours[corner]
        before, corner = corner, other if one == before else one
    return tuple(chain) if corner == first and len(neighbours[first]) == 2 else ()


def _area(corners: tuple[Point, ...]) -> float:
    pairs = zip(corners, (*corners[1:], corners[0]), strict=True)
    return abs(sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in pairs)) / 2.0
