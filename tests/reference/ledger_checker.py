"""Re-derives a whole run of one ball from its ledger, and says what is not as it must be.

`find_problems(scene, start, ledger, end, commands)` goes from row to row: every flight must lead to the next row, every
bounce obey the law on the true surface, every contact begin and end with a reason. Then the whole path is searched for
sensor crossings that were missed and for elements that it went through. No code of the engine takes part; what it must
do is in design.md, "Physics contract".
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from ledger_known import (
    BOUNCE,
    CONTACT_BEGINS,
    CONTACT_ENDS,
    CROSSING,
    EXACT,
    PART_STOPS,
    STANDING,
    TOLERANCE,
    Row,
    apart,
)
from ledger_rows import RowChecks
from ledger_sensors import Whole
from ledger_touch import ULP, Ledger
from ledger_walk import Command, State

from bounce_env.scene import Scene

OK, BUDGET, CRUSHED, OUT = range(4)


class Start(NamedTuple):
    """The ball at time 0 [m, m/s]."""

    position: tuple[float, float]
    velocity: tuple[float, float]


class End(NamedTuple):
    """The world after the run; `asked` is the time that it was to reach, where that is known [s]."""

    time: float
    position: tuple[float, float]
    velocity: tuple[float, float]
    status: int
    asked: float | None = None


def find_problems(scene: Scene, start: Start, ledger: Ledger, end: End, commands: Sequence[Command] = ()) -> list[str]:
    """What is wrong with a run, in words; an empty list if nothing is.

    ledger: all rows from time 0 to `end.time`. commands: what was given meanwhile, see `ledger_walk.Command`.
    """
    return _malformed(scene, ledger, end) or _Check(scene, start, ledger, end, commands).run()


def _malformed(scene: Scene, ledger: Ledger, end: End) -> list[str]:
    """What makes it useless to look further."""
    if ledger.dtype.names != Row._fields:
        return [f"the fields are {ledger.dtype.names}"]
    problems = [
        f"{name} is not finite in rows {np.flatnonzero(~np.isfinite(ledger[name])).tolist()}"
        for name in Row._fields
        if not np.isfinite(ledger[name]).all()
    ]
    if not np.isfinite([end.time, *end.position, *end.velocity]).all():
        problems.append("the end is not finite")
    known = {
        "element": (ledger["element"] >= 0) & (ledger["element"] < len(scene.elements)),
        "ball": ledger["ball"] == np.where(ledger["kind"] == PART_STOPS, -1, 0),
        "kind": (ledger["kind"] >= BOUNCE) & (ledger["kind"] <= PART_STOPS),
    }
    for name, right in known.items():
        problems += [f"row {k}: {name} cannot be {ledger[name][k]}" for k in np.flatnonzero(~right)]
    times = np.concatenate([[0.0], ledger["time"], [end.time]])
    for k in np.flatnonzero(np.diff(times) < 0.0):
        problems.append(f"row {k}: time goes back from {times[k]!r} to {times[k + 1]!r}")
    return problems


class _Check(RowChecks):
    def __init__(self, scene: Scene, start: Start, ledger: Ledger, end: End, commands: Sequence[Command]) -> None:
        super().__init__(scene, State(0.0, *start.position, *start.velocity), ledger, end.time, commands)
        self.end = end

    def run(self) -> list[str]:
        for index, row in enumerate(self.rows):
            if row.kind == PART_STOPS:
                continue
            if self.walk.out:
                self.say(index, "the ball is out of play")
                continue
            self.arrive(index, State(row.time, row.x, row.y, *row.before), row.kind, row.element)
            match row.kind:
                case 0:
                    self.bounce(index, row)
                case 1:
                    self.contact_begins(index, row)
                case 2:
                    self.contact_ends(index, row)
                case 3:
                    self.crossing(index, row)
        self.finish()
        self.parts()
        whole = Whole(self.scene, self.walk.pieces, self.switches, self.size, self.extent)
        self.problems += whole.sensors(self.reports)
        self.problems += whole.penetration(self.shapes)
        self.problems += whole.sides(self.shapes, self.rows)
        return self.problems

    # ---- motions

    def arrive(self, index: int, seen: State, kind: int, element: int) -> None:
        """One of the ways from the last row must lead to what is seen at this one."""
        walk, mark = self.walk, self.walk.mark()
        if self.must_end and seen.time > walk.state.time and kind != CONTACT_ENDS:
            self.say(index, "a contact that ended is not reported")
        wrong = ""
        for way in self.ways:
            walk.back(mark)
            walk.place(*way)
            pull = walk.acceleration
            walk.carry(seen.time, index)
            here = walk.mark()
            mode, bearer, settles_at = walk.mode, walk.bearer, walk.settles_at
            acted = walk.act()
            wrong = self.differs(way.state, pull, walk.state, seen)
            switched_off = kind in (BOUNCE, CONTACT_BEGINS) and not walk.enabled[element]
            if acted and (wrong or switched_off):  # it was before the commands of this instant
                walk.back(here)
                walk.place(here.state, mode, bearer, settles_at)
                wrong = self.differs(way.state, pull, walk.state, seen)
            if not wrong:
                break
        if walk.unpressed:
            wrong = wrong or "the ball slides on a wall that does not bear it"
        if kind != CROSSING and seen.time > walk.settles_at * (1.0 + EXACT):
            wrong = wrong or f"the contact that should begin at {walk.settles_at!r} is not reported"
        if wrong:
            self.say(index, wrong)

    def differs(self, before: State, pull: tuple[float, float], derived: State, seen: State) -> str:
        """How what the ledger says differs from what follows from the last row, in words; "" if it does not."""
        seconds = derived.time - before.time
        gain = math.hypot(*pull) * seconds
        speed = max(math.hypot(before.vx, before.vy), math.hypot(derived.vx, derived.vy)) + gain
        lost = 2.0 * ULP * derived.time  # the ledger's time is rounded
        length = TOLERANCE * self.size + 32.0 * ULP * (self.extent + speed * seconds) + speed * lost
        if apart((derived.x, derived.y), (seen.x, seen.y)) > length:
            return f"the ball comes to {(derived.x, derived.y)}, not to {(seen.x, seen.y)}"
        faster = STANDING + TOLERANCE * speed + math.hypot(*pull) * lost
        if apart((derived.vx, derived.vy), (seen.vx, seen.vy)) > faster:
            return f"the ball comes with {(derived.vx, derived.vy)}, not with {(seen.vx, seen.vy)}"
        return ""

    def finish(self) -> None:
        """The end must follow from the last row."""
        end = self.end
        if not self.walk.out:
            self.arrive(len(self.rows), State(end.time, *end.position, *end.velocity), -1, -1)
        elif (self.ways[0].state[1:]) != (*end.position, *end.velocity):
            self.problems.append("a ball that is out of play stays where it went out")
        if end.status != (OUT if self.walk.out else OK) and not self.may_be_stopped():
            self.problems.append(f"at the end the status is {end.status}")
        if end.asked is not None and end.status != BUDGET and end.time != end.asked:
            self.problems.append(f"the run ends at {end.time!r}, not at {end.asked!r}")

    def may_be_stopped(self) -> bool:
        """Whether the event budget can have ended the run before the time that was asked for."""
        if self.end.status != BUDGET or self.walk.out:
            return False
        return self.end.asked is None or self.end.time < self.end.asked

    # ---- parts

    def parts(self) -> None:
        """Paddles must stop when their commands let them run into the ends of their rails."""
        for element, paddle in self.paddles.items():
            said = [(k, row) for k, row in enumerate(self.rows) if row.kind == PART_STOPS and row.element == element]
            due = [stop for stop in paddle.stops if stop.time <= self.end.time]
            if len(said) != len(due):
                self.problems.append(f"elements[{element}] stops {len(due)} times, not {len(said)}")
                continue
            for (index, row), stop in zip(said, due, strict=True):
                derived = (*stop, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
                seen = (row.time, row.x, row.y, *row.before, row.nx, row.ny, *row.after, row.ux, row.uy)
                scales = (stop.time, self.extent, self.extent, *[math.hypot(stop.vx, stop.vy)] * 2, *[0.0] * 6)
                if any(abs(a - b) > EXACT * scale for a, b, scale in zip(derived, seen, scales, strict=True)):
                    self.say(index, f"the paddle stops so: {stop}")
        for index, row in enumerate(self.rows):
            if row.kind == PART_STOPS and row.element not in self.paddles:
                self.say(index, f"elements[{row.element}] is no part")
