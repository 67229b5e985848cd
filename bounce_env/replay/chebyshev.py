"""Curved paths as pieces of Chebyshev series: what a page can evaluate that has no elliptic functions."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

DEGREE = 15
"""Of each piece: a slide through an eighth of a circle at any speed needs less for 12 digits."""

_SHORTEST = 2.0**-30
"""A piece this share of the whole path is not halved any more."""


class Piece(NamedTuple):
    """Two series in 2 (t - begin) / (end - begin) - 1, for `begin` <= t <= `end` [s]; x, y [m]."""

    begin: float
    end: float
    x: tuple[float, ...]
    y: tuple[float, ...]

    def at(self, time: float) -> tuple[float, float]:
        """Return the place at an instant of the piece."""
        u = 2.0 * (time - self.begin) / (self.end - self.begin) - 1.0
        return float(chebyshev.chebval(u, self.x)), float(chebyshev.chebval(u, self.y))


def pieces_of(place: Callable[[float], tuple[float, float]], begin: float, end: float, within: float) -> list[Piece]:
    """Return the pieces of a path between two instants, each `within` so many metres of it."""
    nodes = chebyshev.chebpts1(DEGREE + 1)
    between = np.cos(np.pi * np.arange(DEGREE + 2) / (DEGREE + 1))  # also the two ends
    found: list[Piece] = []
    todo = [(begin, end)]
    while todo:
        a, b = todo.pop()
        middle, half = 0.5 * (a + b), 0.5 * (b - a)
        wanted = np.array([place(middle + half * u) for u in nodes])
        x, y = (_series(nodes, column, within) for column in wanted.T)
        right = np.array([place(middle + half * u) for u in between])
        seen = np.stack([chebyshev.chebval(between, x), chebyshev.chebval(between, y)], axis=1)
        if np.abs(seen - right).max() > within and b - a > _SHORTEST * (end - begin):
            todo += [(middle, b), (a, middle)]
        else:
            found.append(Piece(a, b, tuple(x.tolist()), tuple(y.tolist())))
    return found


def _series(nodes: np.ndarray, values: np.ndarray, within: float) -> np.ndarray:
    """Return the series through values at the nodes, without what its tail adds less than a tenth of `within`."""
    series = chebyshev.chebfit(nodes, values, DEGREE)
    return chebyshev.chebtrim(series, 0.01 * within)
