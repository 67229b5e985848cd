"""Where a table has its inside: what walls and drains shut off from the outside."""

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from bounce_env.engine.placement import element_gaps, part_cores_at_start
from bounce_env.scene import Element, Scene, Sensor, Wall

MOST_CELLS = 160
"""Cells of the raster along the scene's longer side."""

ENCLOSED = 0.5
"""Share of a scene's free room that must be inside for the scene to count as a table."""


@dataclass(frozen=True, eq=False)
class Inside:
    """A raster of cells: True where a ball's centre is inside, `cell` [m] wide, from the corner (left, bottom) [m]."""

    left: float
    bottom: float
    cell: float
    cells: npt.NDArray[np.bool_]

    def holds(self, x: float, y: float) -> bool:
        """Return whether (x, y) [m] is inside."""
        return bool(self.cells[math.floor((x - self.left) / self.cell), math.floor((y - self.bottom) / self.cell)])


def inside_of(scene: Scene) -> Inside | None:
    """Return the inside of a table: from where no ball comes out but through a drain or a one-way wall.

    None where a scene shuts off less than half of its free room.
    """
    left, bottom, right, top = scene.bounds
    side = max(right - left, top - bottom)
    if side == 0.0:
        return None
    cell = max(0.5 * scene.ball.radius, side / MOST_CELLS)
    # Around the bounds a border of cells that nothing in them reaches, so that the outside is one.
    border = math.ceil(max(scene.ball.radius, cell) / cell) + 1
    left, bottom = left - border * cell, bottom - border * cell
    columns, lines = (math.ceil((last - first) / cell) + border for first, last in ((left, right), (bottom, top)))
    room = _free(scene, left, bottom, cell, columns, lines)
    outside = _flooded(room)
    # Nothing keeps a ball off a drain: beyond it the outside goes as far as to the line itself.
    for _ in range(border):
        outside = _grown(outside)
    cells = ~outside
    within = room[border:-border, border:-border]
    if (cells & room).sum() < ENCLOSED * within.sum():
        return None
    return Inside(left, bottom, cell, cells)


def _free(scene: Scene, left: float, bottom: float, cell: float, columns: int, lines: int) -> npt.NDArray[np.bool_]:
    """Cells in whose middle a ball, made so large that no line is finer than the raster, overlaps nothing."""
    closed = replace(scene, elements=tuple(map(_shut, scene.elements)))
    cores = part_cores_at_start(closed)
    margin = max(0.0, cell - scene.ball.radius)
    room = np.empty((columns, lines), np.bool_)
    for i in range(columns):
        for j in range(lines):
            x, y = left + (i + 0.5) * cell, bottom + (j + 0.5) * cell
            room[i, j] = all(gap >= margin for _, gap in element_gaps(closed, cores, x, y))
    return room


def _shut(element: Element) -> Element:
    """Return what keeps a ball inside or ends its play is a wall to all that look for the outside."""
    if isinstance(element, Wall):
        return replace(element, one_way=False)
    if isinstance(element, Sensor) and element.drain and element.segment is not None:
        return Wall(*element.segment)
    return element


def _flooded(room: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return the cells that are free all the way to the raster's corner; ways go along columns and lines."""
    wet = np.zeros_like(room)
    edge = [(0, 0)]
    while edge:
        i, j = edge.pop()
        if 0 <= i < room.shape[0] and 0 <= j < room.shape[1] and room[i, j] and not wet[i, j]:
            wet[i, j] = True
            edge += [(i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)]
    return wet


def _grown(cells: npt.NDArray[np.bool_]) -> npt.NDArray[np.bool_]:
    """Return the cells and all beside them, across corners, too."""
    grown = cells.copy()
    for axis in (0, 1):
        grown = grown | _moved(grown, axis, 1) | _moved(grown, axis, -1)
    return grown


def _moved(cells: npt.NDArray[np.bool_], axis: int, by: int) -> npt.NDArray[np.bool_]:
    moved = np.roll(cells, by, axis)
    np.moveaxis(moved, axis, 0)[0 if by > 0 else -1] = False
    return moved
