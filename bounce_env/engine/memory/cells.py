"""Sort what stands into the cells of a grid: of ten thousand walls a flight passes by a few (broad phase).

A cell lists the walls and circles that a ball may touch while its centre is in it: first the walls by their rows, then
the circles by theirs plus the number of walls, each in order.
"""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.engine.memory.records import CELL_ENTRY, GRID, Array
from bounce_env.engine.tolerances import CELL_MARGIN

Integers = npt.NDArray[np.int64]

FEWEST = 128
"""Shapes for which cells pay: fewer all lie in one."""

MOST_COLUMNS = 4096

STRIDE = 1.6
"""So many cells are gone through at a time: measured, the fastest of 1 to 3."""


Grid = tuple[float, float, float, float, int, int]
"""Left and lower border, size of a cell [m], 1 / size, columns, rows."""


class Cells(NamedTuple):
    """Of one scene: the GRID; where in `entries` the list of each cell begins, and where the last one ends."""

    grid: Grid
    starts: Integers
    circles: Integers  # where the circles of each cell begin
    entries: Array  # CELL_ENTRY; with the boxes, so that a search goes through what lies together in memory


def cells_of(faces: Array, circles: Array, extent: float, grid: Grid | None = None) -> Cells:
    """Sort faces (FACE) and circles (CIRCLE) of a scene of this extent [m] into cells.

    grid: of what is sorted anew, with some of it gone; None: one that suits it.
    """
    boxes = np.concatenate([_boxes(faces), _circle_boxes(circles)]) + _widened(CELL_MARGIN * extent)
    grid = _grid_over(boxes, extent) if grid is None else grid
    x, y, _, inverse, columns, rows = grid
    lists: list[list[int]] = [[] for _ in range(columns * rows)]
    for shape, (left, right, below, above) in enumerate(boxes.tolist()):
        i0, i1 = _between(left - x, right - x, inverse, columns)
        j0, j1 = _between(below - y, above - y, inverse, rows)
        face = faces[shape] if shape < len(faces) else None
        for i, j in _near_line(face, i0, i1, j0, j1, grid, CELL_MARGIN * extent):
            lists[j * columns + i].append(shape)
    lengths = [len(cell) for cell in lists]
    starts = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
    walls = np.array([sum(shape < len(faces) for shape in cell) for cell in lists], np.int64)
    shapes = np.array([shape for cell in lists for shape in cell], np.int64)
    entries = np.zeros(len(shapes), CELL_ENTRY)
    entries["number"] = shapes
    for name, border in zip(("left", "right", "below", "above"), boxes[shapes].T, strict=True):
        entries[name] = border
    return Cells(grid, starts, starts[:-1] + walls, entries)


def padded_cells(cells: list[Cells]) -> dict[str, Array]:
    """Return the tables of some scenes by their names in `State`, a row each."""
    tables = {"grids": np.array([c.grid for c in cells], GRID)}
    for name in ("starts", "circles", "entries"):
        rows = [getattr(c, name) for c in cells]
        table = tables[f"cell_{name}"] = np.zeros((len(cells), max([1, *map(len, rows)])), rows[0].dtype)
        for i, row in enumerate(rows):
            table[i, : len(row)] = row
    return tables


def _boxes(table: Array) -> npt.NDArray[np.float64]:
    return np.stack([table[name] for name in ("left", "right", "below", "above")], axis=1).reshape(-1, 4)


def _circle_boxes(circles: Array) -> npt.NDArray[np.float64]:
    x, y, r = circles["x"], circles["y"], circles["offset_radius"]
    return np.stack([x - r, x + r, y - r, y + r], axis=1).reshape(-1, 4)


def _widened(margin: float) -> npt.NDArray[np.float64]:
    return np.array([-margin, margin, -margin, margin])


def _grid_over(boxes: npt.NDArray[np.float64], extent: float) -> Grid:
    """Return a grid with about as many cells as there are shapes."""
    if len(boxes) == 0:
        return 0.0, 0.0, extent, 1.0 / extent, 1, 1
    (left, below), (right, above) = boxes[:, [0, 2]].min(axis=0).tolist(), boxes[:, [1, 3]].max(axis=0).tolist()
    width, height = right - left, above - below
    if len(boxes) <= FEWEST:
        size = 1.0001 * max(width, height)
        return left, below, size, 1.0 / size, 1, 1
    size = max(math.sqrt(width * height / len(boxes)), max(width, height) / MOST_COLUMNS)
    return left, below, size, 1.0 / size, int(width / size) + 1, int(height / size) + 1


def _between(low: float, high: float, inverse: float, count: int) -> tuple[int, int]:
    return max(int(low * inverse), 0), min(int(high * inverse), count - 1)


def _near_line(face: Any, i0: int, i1: int, j0: int, j1: int, grid: Grid, margin: float) -> Iterator[tuple[int, int]]:
    """Give those of some cells that a wall's two faces come to; all of them where it is no wall."""
    x, y, size, *_ = grid
    for j in range(j0, j1 + 1):
        for i in range(i0, i1 + 1):
            if face is None or i0 == i1 or j0 == j1:
                yield i, j
                continue
            dx, dy = x + (i + 0.5) * size - face["x"], y + (j + 0.5) * size - face["y"]
            ux, uy = face["ux"], face["uy"]
            if abs(dy * ux - dx * uy) <= face["offset_radius"] + 0.5 * size * (abs(ux) + abs(uy)) + margin:
                yield i, j
