"""Curved paths as pieces of Chebyshev series: what a page can evaluate that has no elliptic functions."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

DEGREE = 15
"""Of each piece: a slide through an eighth of a circle at any speed needs less for 12 digits."""

_interpolated: Any = chebyshev.chebinterpolate  # takes functions of several columns, too, which its type does not say

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
    between = np.cos(np.pi * np.arange(DEGREE + 2) / (DEGREE + 1))  # also the two ends
    found: list[Piece] = []
    todo = [(begin, end)]
    while todo:
        a, b = todo.pop()
        middle, half = 0.5 * (a + b), 0.5 * (b - a)

        def places(shares: np.ndarray, middle: float = middle, half: float = half) -> np.ndarray:
            return np.array([place(middle + half * u) for u in shares])

        # What a series loses at its end is at most a hundredth of what it may be off, term by term.
        series = _interpolated(places, DEGREE)
        x, y = (chebyshev.chebtrim(column, 0.01 * within) for column in series.T)
        right = places(between)
        seen = np.stack([chebyshev.chebval(between, x), chebyshev.chebval(between, y)], axis=1)
        if np.abs(seen - right).max() > within and b - a > _SHORTEST * (end - begin):
            todo += [(middle, b), (a, middle)]
        else:
            found.append(Piece(a, b, tuple(x.tolist()), tuple(y.tolist())))
    return found
