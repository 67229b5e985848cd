"""Parts that move, leg by leg: where the core of each is, and how fast its surface moves.

Of the ledger checker: plain Python and numpy, no code of the engine. Every part is a capsule about a segment: a paddle
and a bumper on a rail slide along it, a flipper turns about its start, and both ends of a dragged wall move uniformly.
What makes a leg end is in `ledger_drive`.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Bumper, Element, Flipper, Paddle, Scene, Wall

Floats = npt.NDArray[np.float64]
Vector = tuple[float, float]
SAME = 1e-12  # share of what a part's place goes by within which it is at a stop


class Core(NamedTuple):
    """The two ends of cores [m], their velocities [m/s], and how fast they turn [rad/s], at several times."""

    x0: Floats
    y0: Floats
    x1: Floats
    y1: Floats
    vx0: Floats
    vy0: Floats
    vx1: Floats
    vy1: Floats
    spin: Floats

    def surface(self, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        """Velocity of the surface at a contact point (x, y)."""
        dx, dy = self.x1 - self.x0, self.y1 - self.y0
        square = dx * dx + dy * dy
        with np.errstate(invalid="ignore", divide="ignore"):
            share = ((x - self.x0) * dx + (y - self.y0) * dy) / square
        share = np.where(square > 0.0, np.clip(share, 0.0, 1.0), 0.0)
        ux, uy = self.vx0 + share * (self.vx1 - self.vx0), self.vy0 + share * (self.vy1 - self.vy0)
        # A flipper's surface lies off its core, and turns with it; a wall's does not.
        off_x, off_y = x - self.x0 - share * dx, y - self.y0 - share * dy
        return ux - self.spin * off_y, uy + self.spin * off_x


class Leg(NamedTuple):
    """From `begin` [s] on the part is at numbers `at` that change at `rates`."""

    begin: float
    at: tuple[float, ...]
    rates: tuple[float, ...]

    def now(self, t: float) -> tuple[float, ...]:
        return tuple(a + r * (t - self.begin) for a, r in zip(self.at, self.rates, strict=True))


class Halt(NamedTuple):
    """A leg's end: when, where, and the rates from then on."""

    time: float
    at: tuple[float, ...]
    rates: tuple[float, ...]


class PartRun:
    """One part from time 0 on; `go` and `asked` are for `ledger_drive`."""

    radius: float
    length: float  # [m] at most, of the core
    turns_back = False  # where others stand still at their stops

    def __init__(self, at: tuple[float, ...], rates: tuple[float, ...]) -> None:
        self.legs = [Leg(0.0, at, rates)]
        self.told_at = -math.inf  # [s]
        self.asked = rates if any(rates) else tuple(0.0 for _ in at)
        self._columns: tuple[Floats, Floats, Floats] | None = None

    def go(self, time: float, at: tuple[float, ...], rates: tuple[float, ...]) -> None:
        """From now on, at these rates."""
        self.legs.append(Leg(time, at, rates))
        self._columns = None

    def allowed(self, at: tuple[float, ...], rates: tuple[float, ...]) -> tuple[float, ...]:
        raise NotImplementedError

    def unsure(self, at: tuple[float, ...], rates: tuple[float, ...]) -> list[tuple[float, ...]]:
        """The rates that may be left where the part is at a stop within rounding, and so may set off or not."""
        return [rates, self.allowed(at, rates)]

    def halt(self) -> Halt:
        """The next stop, at time inf where there is none."""
        raise NotImplementedError

    def blocked_rates(self) -> tuple[float, ...]:
        """The rates after a ball stops the part."""
        return tuple(0.0 for _ in self.legs[-1].rates)

    def places(self, core: Core) -> Sequence[tuple[float, float, float, float]]:
        """x, y, vx, vy of what a stop's rows tell of, given the core at one time."""
        raise NotImplementedError

    def core(self, t: Floats) -> Core:
        """The core at times; at the change of a leg that of the later one."""
        return self.core_of(*self._numbers(t))

    def core_of(self, at: Floats, rates: Floats) -> Core:
        raise NotImplementedError

    def core_once(self, at: Sequence[float], rates: Sequence[float]) -> Core:
        """The core with numbers `at` that change at `rates`."""
        return self.core_of(np.array([at]), np.array([rates]))

    def _numbers(self, t: Floats) -> tuple[Floats, Floats]:
        if self._columns is None:
            self._columns = tuple(np.array(column) for column in zip(*self.legs, strict=True))  # type: ignore[assignment]
        begin, at, rates = self._columns
        leg = np.maximum(np.searchsorted(begin, t, side="right") - 1, 0)
        return at[leg] + rates[leg] * (t - begin[leg])[:, None], rates[leg]

    @property
    def changes(self) -> list[float]:
        """Times at which the velocity changes."""
        return [leg.begin for leg in self.legs[1:]]

    def around(self, t: float, same_instant: float) -> Core:
        """The core at a time, once for each of the ways in which it moves there: near a change it may be any."""
        begins = [leg.begin for leg in self.legs]
        first, last = bisect_left(begins, t - same_instant), bisect_right(begins, t + same_instant)
        legs = self.legs[max(first - 1, 0) : last]
        return self.core_of(np.array([leg.now(t) for leg in legs]), np.array([leg.rates for leg in legs]))

    def moves(self, t: Floats) -> npt.NDArray[np.bool_]:
        """Whether at times the surface does not move as one: the part turns or stretches."""
        core = self.core(t)
        return (core.spin != 0.0) | (core.vx0 != core.vx1) | (core.vy0 != core.vy1)


class Sliding(PartRun):
    """A paddle, or a bumper that goes to and fro; its number is how far it is from the start of its rail [m]."""

    def __init__(self, part: Paddle | Bumper) -> None:
        if isinstance(part, Paddle):
            (x0, y0), (x1, y1), self._half = part.rail_start, part.rail_end, part.half_width
        else:
            assert part.rail_end is not None
            (x0, y0), (x1, y1), self._half = part.center, part.rail_end, 0.0
        self.radius, self.length = part.radius, 2.0 * self._half
        self._x, self._y, self._span = x0, y0, math.hypot(x1 - x0, y1 - y0)
        self._ex, self._ey = (x1 - x0) / self._span, (y1 - y0) / self._span
        self.turns_back = isinstance(part, Bumper)
        super().__init__((0.0,) if self.turns_back else (0.5 * self._span,), (getattr(part, "speed", 0.0),))

    def allowed(self, at: tuple[float, ...], rates: tuple[float, ...]) -> tuple[float, ...]:
        (offset,), (rate,) = at, rates
        held = (rate < 0.0 and offset <= SAME * self._span) or (rate > 0.0 and offset >= (1.0 - SAME) * self._span)
        return self._stopped(rate) if held else rates

    def _stopped(self, rate: float) -> tuple[float, ...]:
        return (-rate,) if self.turns_back else (0.0,)

    def halt(self) -> Halt:
        (begin, (offset,), (rate,)) = self.legs[-1]
        if rate == 0.0:
            return Halt(math.inf, (), ())
        end = self._span if rate > 0.0 else 0.0
        return Halt(begin + (end - offset) / rate, (end,), self._stopped(rate))

    def blocked_rates(self) -> tuple[float, ...]:
        return self._stopped(self.legs[-1].rates[0])

    def core_of(self, at: Floats, rates: Floats) -> Core:
        x, y = self._x + at[:, 0] * self._ex, self._y + at[:, 0] * self._ey
        vx, vy, dx, dy = rates[:, 0] * self._ex, rates[:, 0] * self._ey, self._half * self._ex, self._half * self._ey
        return Core(x - dx, y - dy, x + dx, y + dy, vx, vy, vx, vy, np.zeros_like(x))

    def places(self, core: Core) -> Sequence[tuple[float, float, float, float]]:
        x, y = 0.5 * (core.x0 + core.x1), 0.5 * (core.y0 + core.y1)
        return [(float(x[0]), float(y[0]), float(core.vx0[0]), float(core.vy0[0]))]


class Turning(PartRun):
    """A flipper; its number is the angle from its rest, either way [rad]."""

    def __init__(self, part: Flipper) -> None:
        self.radius, self.length = part.radius, part.length
        self._pivot, self._rest = part.pivot, part.rest_angle
        self._sign, self._stroke = math.copysign(1.0, part.active_angle - part.rest_angle), 0.0
        self._stroke = abs(part.active_angle - part.rest_angle)
        super().__init__((0.0,), (0.0,))

    def allowed(self, at: tuple[float, ...], rates: tuple[float, ...]) -> tuple[float, ...]:
        (angle,), (rate,) = at, rates
        held = (rate < 0.0 and angle <= SAME * self._stroke) or (rate > 0.0 and angle >= (1.0 - SAME) * self._stroke)
        return (0.0,) if held else rates

    def halt(self) -> Halt:
        (begin, (angle,), (rate,)) = self.legs[-1]
        if rate == 0.0:
            return Halt(math.inf, (), ())
        end = self._stroke if rate > 0.0 else 0.0
        return Halt(begin + (end - angle) / rate, (end,), (0.0,))

    def core_of(self, at: Floats, rates: Floats) -> Core:
        angle, spin = self._rest + self._sign * at[:, 0], self._sign * rates[:, 0]
        dx, dy = self.length * np.cos(angle), self.length * np.sin(angle)
        (x, y), still = self._pivot, np.zeros_like(dx)
        return Core(x + still, y + still, x + dx, y + dy, still, still, -spin * dy, spin * dx, spin)

    def places(self, core: Core) -> Sequence[tuple[float, float, float, float]]:
        return [(float(core.x1[0]), float(core.y1[0]), float(core.vx1[0]), float(core.vy1[0]))]


class Dragged(PartRun):
    """A wall; its numbers are the coordinates of its start and its end [m]."""

    def __init__(self, part: Wall, extent: float) -> None:
        self.radius, self._shortest = 0.0, part.shortest
        (x0, y0), (x1, y1) = part.reach or ((-extent, -extent), (extent, extent))
        self._low, self._high = (x0, y0, x0, y0), (x1, y1, x1, y1)
        self.length = math.hypot(x1 - x0, y1 - y0)
        self._slack = SAME * extent
        super().__init__((*part.start, *part.end), (0.0,) * 4)

    def allowed(self, at: tuple[float, ...], rates: tuple[float, ...]) -> tuple[float, ...]:
        rates = self._inside(at, rates)
        return (0.0,) * 4 if self._narrows_in(at, rates) == 0.0 else rates

    def _inside(self, at: tuple[float, ...], rates: tuple[float, ...]) -> tuple[float, ...]:
        """The rates without those of coordinates that are at the border of the box."""
        return tuple(
            0.0 if (a - low <= self._slack and r < 0.0) or (high - a <= self._slack and r > 0.0) else r
            for a, r, low, high in zip(at, rates, self._low, self._high, strict=True)
        )

    def unsure(self, at: tuple[float, ...], rates: tuple[float, ...]) -> list[tuple[float, ...]]:
        held = self._inside(at, rates)
        choices = [(rate,) if rate == kept else (rate, kept) for rate, kept in zip(rates, held, strict=True)]
        return [*product(*choices), self.allowed(at, rates)]

    def _narrows_in(self, at: tuple[float, ...], rates: tuple[float, ...]) -> float:
        """For how long [s] the ends come closer to each other, until they may not."""
        dx, dy, ex, ey = at[2] - at[0], at[3] - at[1], rates[2] - rates[0], rates[3] - rates[1]
        closing, square = -(dx * ex + dy * ey), dx * dx + dy * dy - self._shortest**2
        if closing <= SAME * math.hypot(dx, dy) * math.hypot(ex, ey):  # the direction is known no better
            return math.inf
        if square <= SAME * self._shortest**2:
            return 0.0
        root = closing * closing - (ex * ex + ey * ey) * square
        return math.inf if root < 0.0 else square / (closing + math.sqrt(root))

    def halt(self) -> Halt:
        begin, at, rates = self.legs[-1]
        rooms = [
            math.inf if r == 0.0 else ((high if r > 0.0 else low) - a) / r
            for a, r, low, high in zip(at, rates, self._low, self._high, strict=True)
        ]
        narrow = self._narrows_in(at, rates)
        seconds = min(*rooms, narrow)
        if seconds == math.inf:
            return Halt(math.inf, (), ())
        there = self.legs[-1].now(begin + seconds)
        if narrow <= seconds:
            return Halt(begin + seconds, there, (0.0,) * 4)
        there = tuple(min(max(a, low), high) for a, low, high in zip(there, self._low, self._high, strict=True))
        return Halt(begin + seconds, there, self.allowed(there, rates))

    def core_of(self, at: Floats, rates: Floats) -> Core:
        return Core(*at.T, *rates.T, np.zeros(len(at)))

    def places(self, core: Core) -> Sequence[tuple[float, float, float, float]]:
        ends = [(core.x0, core.y0, core.vx0, core.vy0), (core.x1, core.y1, core.vx1, core.vy1)]
        return [(float(x[0]), float(y[0]), float(vx[0]), float(vy[0])) for x, y, vx, vy in ends]


def run_of(element: Element, extent: float) -> PartRun | None:
    """The part at rest where a reset puts it; None for what stands for ever."""
    match element:
        case Flipper():
            return Turning(element)
        case Wall(draggable=True):
            return Dragged(element, extent)
        case Paddle():
            return Sliding(element)
        case Bumper() if element.rail_end is not None:
            return Sliding(element)
    return None


def runs_of(scene: Scene, extent: float) -> dict[int, PartRun]:
    found = ((index, run_of(element, extent)) for index, element in enumerate(scene.elements))
    return {index: run for index, run in found if run is not None}
