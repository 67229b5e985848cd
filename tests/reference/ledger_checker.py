"""Re-derives a whole run from its ledger, and says what is not as it must be.

`find_problems(scene, start, ledger, end, commands)` goes from row to row: every flight must lead to the next row, every
bounce obey the law on the true surface, every contact begin and end with a reason, every part stop where its motion
ends. Then the whole path of each ball is searched for sensor crossings that were missed, and for elements and balls
that it went through. No code of the engine takes part; what it must do is in docs/physics.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from bounce_env.scene import Arc, Bumper, Scene, Wall
from tests.reference.ledger_drive import Command
from tests.reference.ledger_gaps import least_distances
from tests.reference.ledger_pairs import PairChecks
from tests.reference.ledger_row import (
    BOUNCE,
    CONTACT_BEGINS,
    CONTACT_ENDS,
    CORNER_BOUNCE,
    CROSSING,
    CRUSH,
    PART_STOPS,
    Row,
    apart,
)
from tests.reference.ledger_sensors import Whole
from tests.reference.ledger_setting import EXACT, STANDING, TOLERANCE, Setting
from tests.reference.ledger_touch import ULP, Ledger
from tests.reference.ledger_walk import State

OK, BUDGET, CRUSHED, OUT = range(4)


class Start(NamedTuple):
    """A ball at time 0 [m, m/s]."""

    position: tuple[float, float]
    velocity: tuple[float, float]


class End(NamedTuple):
    """A ball after the run; `asked` is the time that it was to reach, where that is known [s]."""

    time: float
    position: tuple[float, float]
    velocity: tuple[float, float]
    status: int
    asked: float | None = None


def find_problems(scene: Scene, start: Start, ledger: Ledger, end: End, commands: Sequence[Command] = ()) -> list[str]:
    """What is wrong with a run of one ball, in words; an empty list if nothing is.

    ledger: all rows from time 0 to `end.time`. commands: what was given meanwhile, see `ledger_drive.Command`.
    """
    return find_problems_of_all(scene, [start], ledger, [end], commands)


def before_a_slide_on_a_curve(scene: Scene, ledger: Ledger, end: End) -> tuple[Ledger, End]:
    """Return the run of one ball up to where a curve first holds it, or all of it.

    This checker's paths are parabolas. Slides on curves are judged by themselves, see `test_slides`.
    """
    for i, row in enumerate(ledger):
        if row["kind"] != CONTACT_BEGINS:
            continue
        element = scene.elements[row["element"]]
        at_end = False
        if isinstance(element, Wall) and scene.ball.radius > 0.0:  # its round ends are curves
            (x0, y0), (x1, y1) = element.start, element.end
            share = ((row["x"] - x0) * (x1 - x0) + (row["y"] - y0) * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2)
            at_end = not 1e-12 < share < 1.0 - 1e-12
        if isinstance(element, Arc | Bumper) or at_end:
            place, speed = (float(row["x"]), float(row["y"])), (float(row["vx0"]), float(row["vy0"]))
            if i > 0 and ledger[i - 1]["time"] == row["time"]:  # a hop shorter than the clock can tell has no row
                speed = (float(ledger[i - 1]["vx1"]), float(ledger[i - 1]["vy1"]))
            return ledger[:i], End(float(row["time"]), place, speed, 0)
    return ledger, end


def find_problems_of_all(
    scene: Scene, starts: Sequence[Start], ledger: Ledger, ends: Sequence[End], commands: Sequence[Command] = ()
) -> list[str]:
    """The same of a run of several balls."""
    problems = list(_malformed(scene, ledger, ends))
    if problems:
        return problems
    setting = Setting(scene, ledger, ends[0].time, commands)
    checks = [
        _Check(setting, ball, State(0.0, *start.position, *start.velocity), ledger, end)
        for ball, (start, end) in enumerate(zip(starts, ends, strict=True))
    ]
    for check in checks:
        check.others = checks
    reached = [0] * len(checks)
    for row in setting.rows:
        if row.kind != PART_STOPS:
            checks[row.ball].take(reached[row.ball])
            reached[row.ball] += 1
    problems = list(setting.drive.problems)
    for check in checks:
        check.finish()
        check.look_back()
        problems += check.problems
    return problems + list(_overlaps(setting, checks))


def _malformed(scene: Scene, ledger: Ledger, ends: Sequence[End]) -> Iterator[str]:
    """What makes it useless to look further."""
    if ledger.dtype.names != Row._fields:
        yield f"the fields are {ledger.dtype.names}"
        return
    for name in Row._fields:
        if not np.isfinite(ledger[name]).all():
            yield f"{name} is not finite in rows {np.flatnonzero(~np.isfinite(ledger[name])).tolist()}"
    for end in ends:
        if not np.isfinite([end.time, *end.position, *end.velocity]).all():
            yield "the end is not finite"
    ball, kind, other = ledger["ball"], ledger["kind"], ledger["element"] - len(scene.elements)
    meets = (kind == BOUNCE) & (other >= 0) & (other < len(ends)) & (other != ball)
    known = {
        "element": (ledger["element"] >= 0) & ((other < 0) | meets),
        "ball": np.where(kind == PART_STOPS, ball == -1, (ball >= 0) & (ball < len(ends))),
        "kind": ((kind >= BOUNCE) & (kind <= CRUSH)) | (kind == CORNER_BOUNCE),
    }
    for name, right in known.items():
        for k in np.flatnonzero(~right):
            yield f"row {k}: {name} cannot be {ledger[name][k]}"
    times = np.concatenate([[0.0], ledger["time"], [ends[0].time]])
    for k in np.flatnonzero(np.diff(times) < 0.0):
        yield f"row {k}: time goes back from {times[k]!r} to {times[k + 1]!r}"
    if any((end.time, end.asked) != (ends[0].time, ends[0].asked) for end in ends):
        yield "the balls' runs end at different times"


def _overlaps(setting: Setting, checks: Sequence[_Check]) -> Iterator[str]:
    """Where two balls come deeper into each other than a billionth of the scene's size."""
    reach = 2.0 * setting.scene.ball.radius
    for one, other in combinations(checks if reach else (), 2):
        if not (one.walk.pieces and other.walk.pieces):
            continue
        distances, pieces, times = least_distances(one.walk.pieces, other.walk.pieces)
        for k in np.flatnonzero(distances < reach - TOLERANCE * setting.size):
            number = one.numbers[one.walk.pieces[pieces[k]].row]
            deep = f"{reach - distances[k]:.3g} m deep in each other after {times[k]:.9g} s"
            yield f"before row {number}: balls {one.ball} and {other.ball} are {deep}"


class _Check(PairChecks):
    """The checks of one ball."""

    def __init__(self, setting: Setting, ball: int, start: State, ledger: Ledger, end: End) -> None:
        super().__init__(setting, ball, start, ledger)
        self.end = end

    def take(self, index: int) -> None:
        """Check the next row."""
        row = self.rows[index]
        if self.walk.out:
            self.say(index, "the ball is out of play")
            return
        self.set_free(row.time)
        met = row.element >= len(self.scene.elements)
        if self.is_crushed and not met:
            self.say(index, "the ball is crushed")
        self.arrive(index, State(row.time, row.x, row.y, *row.before), row.kind, row.element)
        match row.kind:
            case 0 if met:
                self.meets(index, row)
            case 0:
                self.bounce(index, row)
            case 1:
                self.contact_begins(index, row)
            case 2:
                self.contact_ends(index, row)
            case 3:
                self.crossing(index, row)
            case 5:
                self.crushed(index, row)
            case 7:
                self.corner_bounce(index, row)

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
            switched_off = (
                kind in (BOUNCE, CORNER_BOUNCE, CONTACT_BEGINS)
                and element < len(walk.enabled)
                and not walk.enabled[element]
            )
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
        if seen.time == self.instant:  # what is left of faster bounces
            faster += EXACT * self.fastest
        if apart((derived.vx, derived.vy), (seen.vx, seen.vy)) > faster:
            return f"the ball comes with {(derived.vx, derived.vy)}, not with {(seen.vx, seen.vy)}"
        return ""

    def finish(self) -> None:
        """The end must follow from the last row."""
        end = self.end
        self.set_free(end.time)
        if not self.walk.out:
            self.arrive(len(self.rows), State(end.time, *end.position, *end.velocity), -1, -1)
        elif (self.ways[0].state[1:]) != (*end.position, *end.velocity):
            self.problems.append("a ball that is out of play stays where it went out")
        status = OUT if self.walk.out else CRUSHED if self.is_crushed else OK
        if end.status != status and not self.may_be_stopped():
            self.problems.append(f"at the end the status is {end.status}")
        if end.asked is not None and end.status != BUDGET and end.time != end.asked and len(self.others) == 1:
            self.problems.append(f"the run ends at {end.time!r}, not at {end.asked!r}")

    def may_be_stopped(self) -> bool:
        """Whether the event budget can have ended the run before the time that was asked for."""
        if self.end.status != BUDGET or self.walk.out or self.is_crushed:
            return False
        return self.end.asked is None or self.end.time < self.end.asked

    def look_back(self) -> None:
        """What the whole path passed or went through."""
        setting = self.setting
        whole = Whole(self.scene, self.walk.pieces, setting.switches, self.size, self.extent, self.numbers)
        self.problems += whole.sensors(self.reports)
        self.problems += whole.penetration(setting.shapes)
        self.problems += whole.sides(setting.shapes, self.rows)
