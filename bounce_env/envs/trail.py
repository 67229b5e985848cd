"""The way that a ball has come in the last moments, from its flights as they are in the state."""

import math
from operator import itemgetter
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import from_python
from bounce_env.engine.memory.records import CARRIED_ALONG, ON_CURVE, OUT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.carried import Carried, carried_after
from bounce_env.engine.motion.curve_slide import CurveSlide, curve_slide_after

_slide_after, _carried_after = from_python(curve_slide_after), from_python(carried_after)

SPACING = 1 / 60
"""Seconds between two points of a flight: closer than one can tell from the curve."""

SAME_PLACE = 1e-6
"""Metres: a flight that leads this near to where the next one begins was not interrupted."""


class Flight(NamedTuple):
    """Where and how fast a ball was at an instant [s], and how its velocity has changed since [m/s^2].

    path: what its way is instead, where it slides on a curve, or where two surfaces carry it.
    """

    x: float
    y: float
    vx: float
    vy: float
    ax: float
    ay: float
    begun: float
    path: CurveSlide | Carried | None = None

    @classmethod
    def of(cls, state: State, w: int) -> "Flight":
        """Return the present flight of the first ball of world `w`; a drained one stays where it is."""
        b = _row(state.balls[w, 0])
        begun = b["hi"] + b["lo"]
        if b["status"] == OUT:
            return cls(b["x"], b["y"], 0.0, 0.0, 0.0, 0.0, begun)
        path: CurveSlide | Carried | None = None
        if b["contact"] == ON_CURVE:
            path = CurveSlide(*itemgetter(*CurveSlide._fields)(_row(state.curve_slides[w, 0])))
        elif b["contact"] == CARRIED_ALONG:
            path = Carried(*itemgetter(*Carried._fields)(_row(state.carried[w, 0])))
        return cls(b["x"], b["y"], b["vx"], b["vy"], b["ax"], b["ay"], begun, path)

    def at(self, time: float) -> tuple[float, float]:
        """Return where the ball is at an instant."""
        t = time - self.begun
        if isinstance(self.path, CurveSlide):
            return _slide_after(self.path, t)[:2]
        if self.path is not None:
            return _carried_after(self.path, t)[:2]
        return self.x + (self.vx + 0.5 * self.ax * t) * t, self.y + (self.vy + 0.5 * self.ay * t) * t


def _row(record: Any) -> dict[str, Any]:
    return dict(zip(record.dtype.names, record.item(), strict=True))


class Trail:
    """Where the ball of one world has been for the last `seconds`, as far as it was told by `go_on`.

    Between two calls it knows the flight before the first bounce and the one after the last: with one bounce it is
    exact; with more, a straight line leads to the last of them.
    """

    def __init__(self, seconds: float) -> None:
        self._seconds = seconds
        self._ball: object = None
        self._points: list[tuple[float, float, float]] = []
        self._flight: Flight | None = None

    def go_on(self, ball: object, flight: Flight, now: float, longest: float) -> None:
        """A ball is in `flight` at the instant `now` [s].

        The way begins anew where `ball`, which tells balls apart, is another one than in the last call, and where that
        was not earlier, or more than `longest` seconds ago.
        """
        last = self._points[-1][0] if self._points else math.inf
        if self._flight is None or ball != self._ball or not last < now <= last + longest:
            self._points = []
        else:
            if last < flight.begun:
                x, y = self._flight.at(flight.begun)
                if math.hypot(x - flight.x, y - flight.y) < SAME_PLACE:
                    self._fly(self._flight, last, flight.begun)
                self._points.append((flight.begun, flight.x, flight.y))
            self._fly(flight, max(last, flight.begun), now)
        self._points.append((now, *flight.at(now)))
        self._ball, self._flight = ball, flight
        while len(self._points) > 1 and self._points[1][0] <= now - self._seconds:
            self._points.pop(0)

    def _fly(self, flight: Flight, first: float, last: float) -> None:
        """Add points between two instants, without these."""
        count = math.ceil((last - first) / SPACING)
        times = (first + (last - first) * i / count for i in range(1, count))
        self._points += [(time, *flight.at(time)) for time in times]

    def until(self, now: float) -> npt.NDArray[np.float64]:
        """Return the way of the last seconds up to an instant: x, y [m] and freshness, 0 to 1, oldest first; (n, 3)."""
        if not self._points or now < self._points[0][0]:
            return np.zeros((0, 3))
        times, x, y = np.array(self._points).T
        since = max(now - self._seconds, times[0])
        kept = np.concatenate([[since], times[(times > since) & (times < now)], [now]])
        fresh = np.clip(1.0 - (now - kept) / self._seconds, 0.0, 1.0)
        return np.stack([np.interp(kept, times, x), np.interp(kept, times, y), fresh], axis=1)
