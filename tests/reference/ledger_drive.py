"""How parts move under commands, stops and crushed balls, and whether the ledger tells of all their stops.

Of the ledger checker: plain Python and numpy, no code of the engine. Commands, and the rows of stops (kind 4) and of
crushed balls (kind 5), are gone through in order of time. A stop must be reported when the motion comes to it; a part
that stops elsewhere must have been blocked by a ball that is crushed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from bounce_env.scene import Flipper, Scene, Wall
from tests.reference.ledger_motion import Halt, PartRun, Vector, runs_of
from tests.reference.ledger_row import CRUSH, PART_STOPS, Row, apart

Value = float | bool | tuple[float, float] | tuple[Vector, Vector]
Command = tuple[float, str, Value]
"""(time since reset [s], name, value): as `World.command` has it for a part, but that of a paddle or a bumper is a
float; True or False for `enable` of what is no flipper; (dvx, dvy) and any name for a push."""

EXACT = 1e-12  # what one formula may lose
CLEARANCE = 2.0**-14  # of the extent: as far from a part that sets off a crushed ball is held or freed, twice


class Crushed(NamedTuple):
    """A ball that is held between a part and something else, and the normal from the part."""

    x: float
    y: float
    nx: float
    ny: float
    part: int


def is_command(scene: Scene, name: str, value: Value) -> bool:
    """Whether a command is one to a part, and not a push or a switch."""
    element = next((e for e in scene.elements if name and e.name == name), None)
    if isinstance(value, bool):
        return isinstance(element, Flipper)
    return isinstance(value, float) or (isinstance(element, Wall) and isinstance(value[0], tuple))


class Drive:
    """The runs of all parts by element, what is wrong with the ledger about them, and when crushed balls are freed."""

    def __init__(
        self, scene: Scene, rows: Sequence[Row], commands: Sequence[Command], end: float, extent: float, size: float
    ) -> None:
        self.runs = runs_of(scene, extent)
        self.problems: list[str] = []
        self.freed: dict[int, list[tuple[float, int]]] = {}  # by ball: when [s], and before which row of these kinds
        self._next = len(rows)
        self.crushed: dict[int, Crushed] = {}
        self._scene, self._rows, self._extent, self._allowed = scene, rows, extent, 1e-9 * size
        self._reach, self._is_point = scene.ball.radius, scene.ball.radius == 0.0
        self._names = {element.name: index for index, element in enumerate(scene.elements) if element.name}
        self._waiting = sorted(commands, key=lambda command: command[0])
        numbers = [k for k, row in enumerate(rows) if row.kind in (PART_STOPS, CRUSH)]
        while numbers:
            self._next = numbers[0]
            time = rows[numbers[0]].time
            while self._waiting and self._waiting[0][0] < time:
                self._tell()
            self._come_to(time * (1.0 - EXACT))
            if not self._is_before_commands(numbers[0]):
                while self._waiting and self._waiting[0][0] == time:
                    self._tell()
            del numbers[: self._take(numbers)]
        self._next = len(rows)
        while self._waiting and self._waiting[0][0] <= end:
            self._tell()
        self._come_to(end * (1.0 - EXACT))

    def _say(self, number: int, words: str) -> None:
        self.problems.append(f"row {number}: {words}")

    # ---- commands

    def _tell(self) -> None:
        """Let the next command act."""
        time, name, value = self._waiting.pop(0)
        self._come_to(time * (1.0 - EXACT))
        index = self._names.get(name, -1)
        if not is_command(self._scene, name, value):
            if isinstance(value, bool):  # switching may open any gap
                for ball in list(self.crushed):
                    self._free(time, ball, -1)
            return
        run, rates = self.runs[index], self._rates_of(index, value)
        if rates != run.asked:
            run.asked, run.told_at = rates, time
            self._set_off(time, run)
            self._mind_crushed(time, index, run)

    def _rates_of(self, index: int, value: Value) -> tuple[float, ...]:
        element = self._scene.elements[index]
        if isinstance(element, Flipper):
            return (element.up_speed if value else -element.down_speed,)
        if isinstance(value, tuple):
            (vx0, vy0), (vx1, vy1) = value  # type: ignore[misc]
            return vx0, vy0, vx1, vy1
        return (float(value),)

    def _set_off(self, time: float, run: PartRun) -> None:
        halt, at = run.halt(), run.legs[-1].now(time)
        if halt.time <= time * (1.0 + EXACT):  # within rounding it is there, whether or not that has been reported
            at = halt.at
        run.go(time, at, run.allowed(at, run.asked))

    def _mind_crushed(self, time: float, index: int, run: PartRun) -> None:
        """A part may not close on a crushed ball, and frees those that it moves away from."""
        for ball, place in list(self.crushed.items()):
            speed = sum(map(abs, run.legs[-1].rates)) * max(run.length, 1.0)
            gap, closing = self._towards(time, index, place)
            if gap > 2.0 * CLEARANCE * self._extent:
                continue
            # A part that slides past the ball does neither.
            if closing > EXACT * speed:
                run.go(time, run.legs[-1].at, tuple(0.0 for _ in run.asked))
            elif closing < -EXACT * speed:
                self._free(time, ball, index)

    def _towards(self, time: float, index: int, ball: Crushed) -> tuple[float, float]:
        """The gap [m] between a part and a ball, and how fast the part closes it [m/s], as far as that can be told."""
        run = self.runs[index]
        core = run.core(np.array([time]))
        ax, ay, dx, dy = core.x0[0], core.y0[0], core.x1[0] - core.x0[0], core.y1[0] - core.y0[0]
        square = dx * dx + dy * dy
        share = min(max(((ball.x - ax) * dx + (ball.y - ay) * dy) / square, 0.0), 1.0) if square else 0.0
        nx, ny = ball.x - ax - share * dx, ball.y - ay - share * dy
        away = math.hypot(nx, ny)
        if away <= self._allowed:  # a point lies on a wall: on the side that it was crushed on, from another on its own
            side = math.copysign(1.0, ball.nx * dy - ball.ny * dx) * (1.0 if index == ball.part else -1.0)
            nx, ny = side * dy, -side * dx
        norm = math.hypot(nx, ny) or 1.0
        vx = core.vx0[0] + share * (core.vx1[0] - core.vx0[0])
        vy = core.vy0[0] + share * (core.vy1[0] - core.vy0[0])
        return float(away - run.radius - self._reach), float((vx * nx + vy * ny) / norm)

    def _free(self, time: float, ball: int, by: int) -> None:
        part = self.crushed.pop(ball).part
        self.freed.setdefault(ball, []).append((time, self._next))
        if part not in (by, -1):
            self._set_off(time, self.runs[part])

    # ---- stops

    def _come_to(self, time: float) -> None:
        """Let the stops before a time happen that the ledger says nothing of."""
        for index, run in self.runs.items():
            while (halt := run.halt()).time < time:
                self.problems.append(f"elements[{index}] stops at {halt.time!r}, which is not reported")
                self._halt(run, halt)

    def _halt(self, run: PartRun, halt: Halt) -> None:
        time, at, rates = halt
        run.go(time, at, rates)
        if run.turns_back:  # it goes on as if it had been told so
            run.asked = rates

    def _is_before_commands(self, number: int) -> bool:
        """Whether what a row tells came before the commands of its instant."""
        row = self._rows[number]
        if row.kind == CRUSH:
            row = next((r for r in self._rows[number + 1 :] if r.kind == PART_STOPS), row)
        run = self.runs.get(row.element)
        if run is None or self._is_due(run, row.time):
            return True
        _, _, vx, vy = run.places(run.core(np.array([row.time])))[0]
        return apart((vx, vy), row.before) <= EXACT * math.hypot(vx, vy)

    def _is_due(self, run: PartRun, time: float) -> bool:
        return abs(run.halt().time - time) <= EXACT * time

    def _take(self, numbers: Sequence[int]) -> int:
        """Let happen what the next of these rows tells; returns how many of them that took."""
        number = numbers[0]
        row = self._rows[number]
        if row.kind == CRUSH:
            self._crush(number, row, self._rows[numbers[1]] if len(numbers) > 1 else None)
            return 1
        run = self.runs.get(row.element)
        if run is None:
            self._say(number, f"elements[{row.element}] is no part")
            return 1
        ends = len(run.places(run.core(np.array([row.time]))))
        rows = [self._rows[k] for k in numbers[:ends]]
        leg, halt = run.legs[-1], run.halt()
        rates = leg.rates
        if row.time - run.told_at <= EXACT * row.time:  # it has just been told to run into the stop where it is
            rates = _nearest(run, leg.at, [rates, *run.unsure(leg.at, run.asked)], [r.before for r in rows])
            halt = Halt(row.time, leg.at, leg.rates) if rates != leg.rates else halt
        if rates == leg.rates and not self._is_due(run, row.time):
            halt = Halt(row.time, leg.now(row.time), run.blocked_rates())
            if not self._is_blocked(number, row, run):
                self._say(number, f"nothing stops elements[{row.element}] before {run.halt().time!r}")
        else:
            left = [halt.rates, *run.unsure(halt.at, rates)]
            halt = halt._replace(rates=_nearest(run, halt.at, left, [r.after for r in rows]))
        before = run.places(run.core_once(halt.at, rates))
        # To the bit when the ledger says, so that rows of this instant see the part move as it does from then on.
        self._halt(run, halt._replace(time=row.time))
        after = run.places(run.core_once(halt.at, run.legs[-1].rates))
        for k, (old, new) in enumerate(zip(before, after, strict=True)):
            if k >= len(numbers):
                self._say(number, f"elements[{row.element}] has two ends, of which but one stops")
                break
            self._compare(numbers[k], row.element, halt.time, old, new)
        return len(before)

    def _compare(self, number: int, element: int, time: float, old: tuple[float, ...], new: tuple[float, ...]) -> None:
        """All of a stop's row against what follows from the motion."""
        row = self._rows[number]
        if (row.kind, row.element) != (PART_STOPS, element):
            self._say(number, f"here the other end of elements[{element}] stops")
        derived = (time, *old, *new[2:], 0.0, 0.0, 0.0, 0.0)
        seen = (row.time, row.x, row.y, *row.before, *row.after, row.nx, row.ny, row.ux, row.uy)
        speed = max(math.hypot(*old[2:]), math.hypot(*new[2:]))
        far = self._extent + speed * time  # the instant's rounding, over the part's speed, moves its place
        scales = (time, far, far, *[speed] * 4, 0.0, 0.0, 0.0, 0.0)
        if any(abs(a - b) > EXACT * scale for a, b, scale in zip(derived, seen, scales, strict=True)):
            self._say(number, f"elements[{element}] stops so: {derived}")

    # ---- balls that are crushed

    def _crush(self, number: int, row: Row, stop: Row | None) -> None:
        run = self.runs.get(row.element)
        if run is None:
            self._say(number, f"elements[{row.element}] is no part that could crush a ball")
            return
        self.crushed[row.ball] = Crushed(row.x, row.y, row.nx, row.ny, row.element)
        if stop is None or (stop.kind, stop.element, stop.time) != (PART_STOPS, row.element, row.time):
            self._say(number, f"elements[{row.element}] does not stop when it crushes a ball")
        if not row.ux * row.nx + row.uy * row.ny > EXACT * math.hypot(row.ux, row.uy):
            self._say(number, f"elements[{row.element}] does not close on the ball that it is to crush")

    def _is_blocked(self, number: int, row: Row, run: PartRun) -> bool:
        """Whether a ball blocks a part: one that is crushed, or that a bumper on a rail turns back from."""
        return any(
            abs(gap) <= self._allowed and (closing > 0.0 or self._is_point)  # whose side of a second wall is not told
            for gap, closing in (
                self._towards(row.time, row.element, ball) for ball in self._balls_at(number, row, run)
            )
        )

    def _balls_at(self, number: int, row: Row, run: PartRun) -> Iterator[Crushed]:
        yield from self.crushed.values()
        if run.turns_back:
            for other in reversed(self._rows[:number]):
                if other.time < row.time:
                    return
                yield Crushed(other.x, other.y, other.nx, other.ny, other.element)


def _nearest(
    run: PartRun, at: tuple[float, ...], choices: Sequence[tuple[float, ...]], velocities: Sequence[Vector]
) -> tuple[float, ...]:
    """Of several rates those at which what a stop's rows tell of moves most nearly as was seen."""

    def off(rates: tuple[float, ...]) -> float:
        places = run.places(run.core_once(at, rates))
        return sum(apart((vx, vy), v) for (_, _, vx, vy), v in zip(places, velocities, strict=False))

    return min(choices, key=off)
