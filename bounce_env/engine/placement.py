"""Whether a ball may be put somewhere: plain Python, run once per reset."""

import math
from collections.abc import Collection, Iterator, Mapping

import numpy as np
import numpy.typing as npt

from bounce_env.engine.packing import scene_extent, segment_direction, sin_cos
from bounce_env.engine.tolerances import START_OVERLAP
from bounce_env.scene import Arc, Bumper, Element, Flipper, Paddle, Part, Scene, Wall
from bounce_env.scene.errors import describe_element
from bounce_env.wording import at_least

Point = tuple[float, float]
Core = tuple[Point, Point]


def place_clear(scene: Scene, cores: Mapping[int, Core], x: float, y: float, disabled: Collection[int] = ()) -> Point:
    """Return the place (x, y) [m] for the ball's centre, moved to the surface where it overlaps by round-off only.

    `cores` gives the ends of the core of each part by its index in `scene.elements`, `disabled` the elements that are
    switched off. A ball may be half-way through a one-way wall. Raises ValueError, naming the
    element, where the ball overlaps one by more than `START_OVERLAP` of the scene's extent.
    """
    allowed = START_OVERLAP * scene_extent(scene)
    for index, element in enumerate(scene.elements):
        nearest = _distance_from_element(element, cores.get(index), x, y)
        if nearest is None or index in disabled:
            continue
        dx, dy, distance, radius = nearest
        overlap = radius + scene.ball.radius - distance
        if overlap > allowed:
            raise ValueError(
                f"ball at ({x!r}, {y!r}) overlaps {describe_element(element, index)} by {overlap:.6g} m: "
                f"its centre must be at least {at_least(radius + scene.ball.radius, 6)} m away"
            )
        if overlap > 0.0 and distance > 0.0:
            x, y = x + dx / distance * overlap, y + dy / distance * overlap
    return x, y


def element_gaps(scene: Scene, cores: Mapping[int, Core], x: float, y: float) -> Iterator[tuple[int, float]]:
    """For each element that bounces, but for one-way walls: its index and the gap [m] to a ball at (x, y)."""
    for index, element in enumerate(scene.elements):
        nearest = _distance_from_element(element, cores.get(index), x, y)
        if nearest is not None:
            yield index, nearest[2] - nearest[3] - scene.ball.radius


def separate_placed_balls(scene: Scene, positions: npt.NDArray[np.float64]) -> None:
    """Raise ValueError where two balls at `positions` (balls, 2) [m] overlap by more than is lost by rounding.

    Less than that is undone along the line between them.
    """
    radius = scene.ball.radius
    for k in range(len(positions) if radius > 0.0 else 0):
        for j in range(k):
            dx, dy = (positions[k] - positions[j]).tolist()
            distance = math.sqrt(dx * dx + dy * dy)
            overlap = 2.0 * radius - distance
            if overlap > START_OVERLAP * scene_extent(scene):
                raise ValueError(
                    f"ball {k} at {tuple(positions[k].tolist())} overlaps ball {j} by {overlap:.6g} m: "
                    f"their centres must be at least {at_least(2.0 * radius, 6)} m apart"
                )
            if overlap > 0.0:
                positions[k] += np.array((dx, dy)) * (overlap / distance)


def part_cores_at_start(scene: Scene) -> dict[int, Core]:
    """Return the ends of the parts' cores after a reset [m], by index in `scene.elements`."""
    return {index: _part_core_at_start(element) for index, element in scene.parts}


def _part_core_at_start(part: Part) -> Core:
    if isinstance(part, Flipper):
        (x, y), (s, c) = part.pivot, sin_cos(part.rest_angle)
        return part.pivot, (x + part.length * c, y + part.length * s)
    if isinstance(part, Bumper):
        return part.center, part.center
    if isinstance(part, Wall):
        return part.start, part.end
    ux, uy, span = segment_direction(part.rail_start, part.rail_end)
    x, y = part.rail_start
    x, y = x + 0.5 * span * ux, y + 0.5 * span * uy
    ax, ay = part.half_width * ux, part.half_width * uy
    return (x - ax, y - ay), (x + ax, y + ay)


def _distance_from_element(
    element: Element, core: Core | None, x: float, y: float
) -> tuple[float, float, float, float] | None:
    """Vector from the nearest point of an element's core to (x, y), its length, and the radius about the core [m]."""
    if isinstance(element, Paddle | Flipper | Bumper) and core is not None:
        return *_distance_from_segment(*core, x, y), element.radius
    if isinstance(element, Wall) and core is not None:
        return *_distance_from_segment(*core, x, y), 0.0
    if isinstance(element, Wall) and not element.one_way:
        return *_distance_from_segment(element.start, element.end, x, y), 0.0
    if isinstance(element, Bumper):
        return *_distance_from_segment(element.center, element.center, x, y), element.radius
    if isinstance(element, Arc):
        return *_distance_from_arc(element, x, y), 0.0
    return None


def _distance_from_arc(arc: Arc, x: float, y: float) -> tuple[float, float, float]:
    """Vector from the nearest point of an arc's line to (x, y), and its length."""
    dx, dy = x - arc.center[0], y - arc.center[1]
    distance = math.hypot(dx, dy)
    turn = (math.atan2(dy, dx) - arc.start_angle) % (2.0 * math.pi)
    if distance > 0.0 and (arc.closed or turn <= arc.end_angle - arc.start_angle):
        height = distance - arc.radius
        return dx / distance * height, dy / distance * height, abs(height)
    ends = (
        (arc.center[0] + arc.radius * math.cos(a), arc.center[1] + arc.radius * math.sin(a))
        for a in (arc.start_angle, arc.end_angle)
    )
    return min((_distance_from_segment(end, end, x, y) for end in ends), key=lambda vector: vector[2])


def _distance_from_segment(start: Point, end: Point, x: float, y: float) -> tuple[float, float, float]:
    """Vector from the nearest point of a segment to (x, y), and its length."""
    wx, wy = end[0] - start[0], end[1] - start[1]
    dx, dy = x - start[0], y - start[1]
    square = wx * wx + wy * wy
    along = min(max((dx * wx + dy * wy) / square, 0.0), 1.0) if square > 0.0 else 0.0
    dx, dy = dx - along * wx, dy - along * wy
    return dx, dy, math.sqrt(dx * dx + dy * dy)
