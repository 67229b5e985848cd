"""The scene that the stage plays: the user's, in which the ends of every wall can be dragged."""

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from operator import is_
from typing import TypeAlias

from bounce_env.scene import Element, Scene, Wall
from bounce_env.scene.fields import LARGEST

Corners: TypeAlias = tuple[tuple[float, float], tuple[float, float]]

FASTEST = 1e3
"""Of a ball, where the scene sets no limit: so many times its size in a second."""

DRAG_SPEED = 4.0
"""Of a dragged end, at most: so many times the scene's size in a second."""

_MARK = " ~"

_SHORTEST = 1e-2
"""Of a wall that is dragged: this share of the scene's size, or as long as it is where that is less."""


def size_of(scene: Scene) -> float:
    """Return the longer side of the box around a scene [m]; 1 for one without elements and a ball without a radius."""
    left, bottom, right, top = scene.bounds
    return max(right - left, top - bottom, scene.ball.radius) or 1.0


def is_draggable(element: Element) -> bool:
    """Return whether the ends of an element can be dragged while time passes."""
    return isinstance(element, Wall) and not element.one_way


def movable(scene: Scene, names: Sequence[str], revision: int = 0) -> Scene:
    """Return the scene with every wall draggable but for one-way ones.

    names: of the elements that have none. revision: becomes a part of the names of walls; a world that goes on in
    another revision of a scene puts them where the scene has them, and keeps the other parts where they are.
    """
    size, (left, bottom, right, top) = size_of(scene), scene.bounds
    reach = ((left - size, bottom - size), (right + size, top + size))
    elements = tuple(
        replace(_draggable(element, reach, size), name=_name(element, name, revision))
        for element, name in zip(scene.elements, names, strict=True)
    )
    return replace(scene, elements=elements, max_speed=scene.max_speed or min(FASTEST * size, LARGEST))


def _name(element: Element, name: str, revision: int) -> str:
    return f"{element.name or name}{_MARK}{revision}" if is_draggable(element) else element.name or name


def without_revision(text: str) -> str:
    """Return an error's text with the names of walls as their owner knows them."""
    return re.sub(_MARK + r"\d+(?=')", "", text)


def drag_speed(scene: Scene) -> float:
    """Return how fast a dragged end may move [m/s]: slower than a ball may be."""
    limit = math.inf if scene.max_speed is None else 0.5 * scene.max_speed
    return min(DRAG_SPEED * size_of(scene), limit)


def with_walls_at(scene: Scene, ends: dict[int, tuple[float, float, float, float]]) -> Scene:
    """Return the scene with walls where they have been dragged to. ends: by the index of the element, metres."""
    elements = [*scene.elements]
    for index, numbers in ends.items():
        wall = elements[index]
        if isinstance(wall, Wall) and (*wall.start, *wall.end) != numbers:
            elements[index] = replace(wall, start=numbers[:2], end=numbers[2:])
    return scene if all(map(is_, elements, scene.elements)) else replace(scene, elements=tuple(elements))


def _draggable(element: Element, reach: Corners, size: float) -> Element:
    if not isinstance(element, Wall) or element.one_way:
        return element
    length = min(math.dist(element.start, element.end), _SHORTEST * size)
    return replace(element, draggable=True, min_length=element.min_length or length, reach=element.reach or reach)
