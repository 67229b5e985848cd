"""Whether a ball may be put somewhere: plain Python, run once per reset."""

import math
from collections.abc import Collection, Iterator, Mapping

from bounce_env.engine.pack import direction, extent
from bounce_env.engine.tolerances import START_OVERLAP
from bounce_env.scene import Arc, Bumper, Element, Paddle, Scene, Wall
from bounce_env.scene.checks import label

Point = tuple[float, float]


def cleared(
    scene: Scene, paddle_centres: Mapping[int, Point], x: float, y: float, disabled: Collection[int] = ()
) -> Point:
    """The place (x, y) [m] for the ball's centre, moved to the surface where it overlaps by round-off only.

    `paddle_centres` gives the centre of each paddle by its index in `scene.elements`, `disabled` the elements that are
    switched off. A ball may be half-way through a one-way wall. Raises ValueError, naming the
    element, where the ball overlaps one by more than `START_OVERLAP` of the scene's extent.
    """
    allowed = START_OVERLAP * extent(scene)
    for index, element in enumerate(scene.elements):
        nearest = _from_element(element, paddle_centres.get(index), x, y)
        if nearest is None or index in disabled:
            continue
        dx, dy, distance, radius = nearest
        overlap = radius + scene.ball.radius - distance
        if overlap > allowed:
            raise ValueError(
                f"ball at ({x!r}, {y!r}) overlaps {describe(element, index)} by {overlap:.6g} m: "
                f"its centre must be at least {radius + scene.ball.radius:.6g} m away"
            )
        if overlap > 0.0 and distance > 0.0:
            x, y = x + dx / distance * overlap, y + dy / distance * overlap
    return x, y


def gaps(scene: Scene, paddle_centres: Mapping[int, Point], x: float, y: float) -> Iterator[tuple[int, float]]:
    """For each element that bounces, but for one-way walls: its index and the gap [m] to a ball at (x, y)."""
    for index, element in enumerate(scene.elements):
        nearest = _from_element(element, paddle_centres.get(index), x, y)
        if nearest is not None:
            yield index, nearest[2] - nearest[3] - scene.ball.radius


def rail_middles(scene: Scene) -> dict[int, Point]:
    """Where the paddles are after a reset: the middle of each rail [m], by index in `scene.elements`."""
    return rail_points(scene, {})


def rail_points(scene: Scene, offsets: Mapping[int, float]) -> dict[int, Point]:
    """The centres of the paddles [m] at `offsets` along their rails [m], in the middle where none is given."""
    points = {}
    for index, element in enumerate(scene.elements):
        if isinstance(element, Paddle):
            ux, uy, span = direction(element.rail_start, element.rail_end)
            offset = offsets.get(index, 0.5 * span)
            x, y = element.rail_start
            points[index] = (x + offset * ux, y + offset * uy)
    return points


def describe(element: Element, index: int) -> str:
    """How error messages name an element."""
    return label(index, type(element).__name__.lower(), element.name)


def _from_element(
    element: Element, centre: Point | None, x: float, y: float
) -> tuple[float, float, float, float] | None:
    """Vector from the nearest point of an element's core to (x, y), its length, and the radius about the core [m]."""
    if isinstance(element, Wall) and not element.one_way:
        return *_from_segment(element.start, element.end, x, y), 0.0
    if isinstance(element, Bumper):
        return *_from_segment(element.center, element.center, x, y), element.radius
    if isinstance(element, Arc):
        return *_from_arc(element, x, y), 0.0
    if isinstance(element, Paddle) and centre is not None:
        ux, uy, _ = direction(element.rail_start, element.rail_end)
        ax, ay = ux * element.half_width, uy * element.half_width
        start, end = (centre[0] - ax, centre[1] - ay), (centre[0] + ax, centre[1] + ay)
        return *_from_segment(start, end, x, y), element.radius
    return None


def _from_arc(arc: Arc, x: float, y: float) -> tuple[float, float, float]:
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
    return min((_from_segment(end, end, x, y) for end in ends), key=lambda vector: vector[2])


def _from_segment(start: Point, end: Point, x: float, y: float) -> tuple[float, float, float]:
    """Vector from the nearest point of a segment to (x, y), and its length."""
    wx, wy = end[0] - start[0], end[1] - start[1]
    dx, dy = x - start[0], y - start[1]
    square = wx * wx + wy * wy
    along = min(max((dx * wx + dy * wy) / square, 0.0), 1.0) if square > 0.0 else 0.0
    dx, dy = dx - along * wx, dy - along * wy
    return dx, dy, math.sqrt(dx * dx + dy * dy)
