"""The motion of paddles under their commands, and the stops that the ledger must report.

Of the ledger checker: plain Python and numpy, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Paddle

Floats = npt.NDArray[np.float64]


class Stop(NamedTuple):
    time: float
    x: float
    y: float
    vx: float  # before
    vy: float


class PaddleRun:
    """Where a paddle is at any time: from the middle of its rail on, at piecewise constant velocity."""

    def __init__(self, paddle: Paddle, commands: Iterable[tuple[float, float]], end: float) -> None:
        """`commands`: (time, speed along the rail), in order of time. `end`: the time up to which stops count."""
        (x0, y0), (x1, y1) = paddle.rail_start, paddle.rail_end
        self._x, self._y = x0, y0
        self._span = math.hypot(x1 - x0, y1 - y0)
        self._ex, self._ey = (x1 - x0) / self._span, (y1 - y0) / self._span
        self.stops: list[Stop] = []
        legs = [(0.0, 0.5 * self._span, 0.0)]  # from when, where, how fast
        asked = 0.0
        for time, speed in [*commands, (end, math.nan)]:
            self._run_into_stop(legs, time)
            if speed == asked or math.isnan(speed):
                continue
            asked = speed
            begin, offset, velocity = legs[-1]
            at = min(max(offset + velocity * (time - begin), 0.0), self._span)
            held = (speed < 0.0 and at <= 0.0) or (speed > 0.0 and at >= self._span)
            legs.append((time, at, 0.0 if held else speed))
        self._begin, self._offset, self._velocity = (np.array(column) for column in zip(*legs, strict=True))

    def _run_into_stop(self, legs: list[tuple[float, float, float]], until: float) -> None:
        begin, offset, velocity = legs[-1]
        if velocity == 0.0:
            return
        end = self._span if velocity > 0.0 else 0.0
        time = begin + (end - offset) / velocity
        if time <= until:
            legs.append((time, end, 0.0))
            x, y = self._x + end * self._ex, self._y + end * self._ey
            self.stops.append(Stop(time, x, y, velocity * self._ex, velocity * self._ey))

    @property
    def changes(self) -> list[float]:
        """Times at which the velocity changes."""
        return [float(t) for t in self._begin[1:]]

    def states(self, t: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """The centre (x, y) and its velocity at times; at a change the later velocity."""
        leg = np.maximum(np.searchsorted(self._begin, t, side="right") - 1, 0)
        velocity = self._velocity[leg]
        offset = self._offset[leg] + velocity * (t - self._begin[leg])
        x, y = self._x + offset * self._ex, self._y + offset * self._ey
        return x, y, velocity * self._ex, velocity * self._ey

    def velocities(self, t: float, same_instant: float) -> list[tuple[float, float]]:
        """The surface's velocity at a time; at a change, within `same_instant`, also the one before or after."""
        times = np.array([t - same_instant, t, t + same_instant])
        _, _, ux, uy = self.states(times)
        return sorted(set(zip(ux.tolist(), uy.tolist(), strict=True)))
