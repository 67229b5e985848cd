"""Whether a ball may be put somewhere: plain Python, run once per reset."""

import math
from collections.abc import Mapping

from bounce_env.engine.pack import direction, extent
from bounce_env.engine.tolerances import START_OVERLAP
from bounce_env.scene import Bumper, Element, Paddle, Scene, Wall
from bounce_env.scene.checks import label

Point = tuple[float, float]


def cleared(scene: Scene, paddle_centres: Mapping[int, Point], x: float, y: float) -> Point:
    """The place (x, y) [m] for the ball's centre, moved to the surface where it overlaps by round-off only.

    `paddle_centres` gives the centre of each paddle by its index in `scene.elements`. Raises ValueError, naming the
    element, where the ball overlaps one by more than `START_OVERLAP` of the scene's extent.
    """
    allowed = START_OVERLAP * extent(scene)
    for index, element in enumerate(scene.elements):
        core = _core(element, paddle_centres.get(index))
        if core is None:
            continue
        start, end, radius = core
        dx, dy, distance = _from_segment(start, end, x, y)
        overlap = radius + scene.ball.radius - distance
        if overlap > allowed:
            raise ValueError(
                f"ball at ({x!r}, {y!r}) overlaps {describe(element, index)} by {overlap:.6g} m: "
                f"its centre must be at least {radius + scene.ball.radius:.6g} m away"
            )
        if overlap > 0.0 and distance > 0.0:
            x, y = x + dx / distance * overlap, y + dy / distance * overlap
    return x, y


def rail_middles(scene: Scene) -> dict[int, Point]:
    """Where the paddles are after a reset: the middle of each rail [m], by index in `scene.elements`."""
    middles = {}
    for index, element in enumerate(scene.elements):
        if isinstance(element, Paddle):
            ux, uy, span = direction(element.rail_start, element.rail_end)
            x, y = element.rail_start
            middles[index] = (x + 0.5 * span * ux, y + 0.5 * span * uy)
    return middles


def describe(element: Element, index: int) -> str:
    """How error messages name an element."""
    return label(index, type(element).__name__.lower(), element.name)


def _core(element: Element, centre: Point | None) -> tuple[Point, Point, float] | None:
    if isinstance(element, Wall):
        return element.start, element.end, 0.0
    if isinstance(element, Bumper):
        return element.center, element.center, element.radius
    if isinstance(element, Paddle) and centre is not None:
        ux, uy, _ = direction(element.rail_start, element.rail_end)
        ax, ay = ux * element.half_width, uy * element.half_width
        return (centre[0] - ax, centre[1] - ay), (centre[0] + ax, centre[1] + ay), element.radius
    return None


def _from_segment(start: Point, end: Point, x: float, y: float) -> tuple[float, float, float]:
    """Vector from the nearest point of a segment to (x, y), and its length."""
    wx, wy = end[0] - start[0], end[1] - start[1]
    dx, dy = x - start[0], y - start[1]
    square = wx * wx + wy * wy
    along = min(max((dx * wx + dy * wy) / square, 0.0), 1.0) if square > 0.0 else 0.0
    dx, dy = dx - along * wx, dy - along * wy
    return dx, dy, math.sqrt(dx * dx + dy * dy)
