"""The fading way that a ball has come, as spots so near to each other that they look like a line.

Import it after `load_pygame` only.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
import numpy.typing as npt
import pygame

from bounce_env.render.looks import Look
from bounce_env.render.painter import Sprite

Floats = npt.NDArray[np.float64]

_SHADES = 48
"""How many degrees of freshness are told apart."""

_SCALLOP = 0.08
"""Spots lie so close that the border of the line is wavy by no more pixels than this."""

_ROOM = 1e5
"""Spots farther outside of the picture than this, in pixels, are left out: pygame takes places modulo 2^32."""


class Trail:
    """A line of spots.

    look_of: from a freshness, 0 to 1, to what a spot looks like about (0, 0). radius: of a spot, pixels.
    """

    def __init__(self, look_of: Callable[[float], Look], radius: float) -> None:
        self._spacing = max(1.0, (8 * radius * _SCALLOP) ** 0.5)
        self._spot = lru_cache(None)(lambda shade: Sprite(look_of(shade / _SHADES)))

    def draw(self, target: pygame.Surface, path: Floats, freshness: Floats) -> None:
        """Draw it along `path` (n, 2), pixel coordinates, n >= 1, each point as fresh as `freshness` (n,) says.

        Spots do not add up: where they overlap the brighter one is seen.
        """
        spots, fresh = _spots(path, freshness, self._spacing)
        near = (np.abs(spots) < _ROOM).all(axis=1)
        shades = np.rint(fresh * _SHADES).astype(int)
        seen = near & (shades > 0)
        stamps = [
            self._spot(shade).image_at(x, y)
            for (x, y), shade in zip(spots[seen].tolist(), shades[seen].tolist(), strict=True)
        ]
        target.fblits(stamps, pygame.BLEND_RGB_MAX)


def _spots(path: Floats, freshness: Floats, spacing: float) -> tuple[Floats, Floats]:
    """Points every `spacing` pixels along a path, back from its end, and how fresh each is."""
    steps = np.hypot(*np.diff(path, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    places = np.arange(along[-1], -1e-9, -spacing)
    x, y, fresh = (np.interp(places, along, values) for values in (*path.T, freshness))
    return np.stack([x, y], axis=1), fresh
