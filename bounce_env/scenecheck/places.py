"""Many places in a few words: those near to each other are one."""

from dataclasses import dataclass
from itertools import product

import numpy as np
import numpy.typing as npt


@dataclass(frozen=True)
class Cluster:
    """Places that lie together: the box around them [m], and their rows."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float
    rows: tuple[int, ...]


def clusters(places: npt.NDArray[np.float64], near: float) -> list[Cluster]:
    """Places (n, 2) [m] in groups whose members have others within about `near` > 0 [m], the largest first."""
    cells: dict[tuple[int, int], list[int]] = {}
    for row, (column, line) in enumerate(np.floor(places / near).astype(np.int64).tolist()):
        cells.setdefault((column, line), []).append(row)
    groups = []
    while cells:
        edge = [next(iter(cells))]
        rows = cells.pop(edge[0])
        while edge:
            column, line = edge.pop()
            for dx, dy in product((-1, 0, 1), repeat=2):
                cell = (column + dx, line + dy)
                if cell in cells:
                    rows += cells.pop(cell)
                    edge.append(cell)
        groups.append(_cluster(places, sorted(rows)))
    return sorted(groups, key=lambda group: (-len(group.rows), group.rows))


def _cluster(places: npt.NDArray[np.float64], rows: list[int]) -> Cluster:
    (x_min, y_min), (x_max, y_max) = places[rows].min(axis=0).tolist(), places[rows].max(axis=0).tolist()
    return Cluster(x_min, y_min, x_max, y_max, tuple(rows))
