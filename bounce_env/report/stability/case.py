"""What a case of the stability suite is, how it is played and how its outcome is judged.

A case is a scene, a start, a script of durations and commands, and what must come of it: which rows the ledger has,
and numbers with the place that the right answer comes from. It is written once, in one of the modules of `cases`,
for the tests and for the report.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np

from bounce_env.engine.memory.records import BUDGET, CRUSHED, OK, OUT
from bounce_env.engine.world import World
from bounce_env.scene import Scene
from bounce_env.scene.features import ALL_FOR_ONE_BALL

Point: TypeAlias = tuple[float, float]
Step: TypeAlias = float | tuple[Any, ...]
Watch: TypeAlias = Callable[[World, set[str]], None]

ULP = 2.0**-52
KINDS = ("bounce", "begin", "end", "cross", "stop", "crush", "absorbed", "bounce")  # two from a corner are bounces
STATUS = {OK: "OK", BUDGET: "BUDGET", CRUSHED: "CRUSHED", OUT: "OUT"}


@dataclass(frozen=True)
class Expect:
    """A number that a run must show: `seen(run)` within `within` of `expected`, in SI units."""

    what: str
    seen: Callable[[Run], float]
    expected: float
    within: float


@dataclass(frozen=True, kw_only=True)
class Case:
    """One case. `why` says where the right answer comes from.

    script: seconds to advance, or a command as a tuple: ("push", (dvx, dvy)), ("enable", name, bool), ("replace",
    scene), ("command", name, value). rows: regular expression of the whole ledger as `Run.text` spells it; None where
    it is not known. status: of the ball at the end, one of these. refused: what a ValueError says where the start or a
    command must be refused. keep_ledger: False where it is too long to be looked at.
    """

    name: str
    why: str
    scene: Scene
    position: Point
    velocity: Point = (0.0, 0.0)
    script: tuple[Step, ...]
    rows: str | None = None
    expect: tuple[Expect, ...] = ()
    status: tuple[str, ...] = ("OK",)
    refused: str = ""
    keep_ledger: bool = True
    max_events: int = 20_000  # more than any case but one needs: an endless loop is found soon
    exact_scaling: bool = True  # whether it may be run at other sizes (not: at the edge of what a float holds)


@dataclass
class Run:
    """What a case did."""

    names: list[str]
    ledger: Any = None  # structured array, see World.advance
    position: Point = (math.nan, math.nan)
    velocity: Point = (math.nan, math.nan)
    time: float = math.nan
    status: str = ""
    refusal: str = ""
    states: list[bytes] = field(default_factory=list)  # position and velocity after each step of the script

    def tokens(self) -> list[str]:
        """The ledger's rows as "element kind"."""
        rows: Any = [] if self.ledger is None else self.ledger
        return [f"{self.names[row['element']]} {KINDS[row['kind']]}" for row in rows]

    def text(self) -> str:
        return ", ".join(self.tokens())

    def row(self, token: str, n: int = 0) -> Any:
        """The n-th row (from the end if negative) spelled `token`; all fields NaN where there is none."""
        found = self.ledger[[t == token for t in self.tokens()]]
        if -len(found) <= n < len(found):
            return found[n]
        return dict.fromkeys(self.ledger.dtype.names or (), math.nan)


# ---- expectations


def at(x: float, y: float, within: float) -> tuple[Expect, Expect]:
    """The ball's place at the end [m]."""
    return (
        Expect("x", lambda run: run.position[0], x, within),
        Expect("y", lambda run: run.position[1], y, within),
    )


def going(vx: float, vy: float, within: float) -> tuple[Expect, Expect]:
    """The ball's velocity at the end [m/s]."""
    return (
        Expect("vx", lambda run: run.velocity[0], vx, within),
        Expect("vy", lambda run: run.velocity[1], vy, within),
    )


def resting(x: float, y: float, within: float) -> tuple[Expect, ...]:
    """The ball's place at the end, where it stands still to the bit."""
    return (*at(x, y, within), *going(0.0, 0.0, 0.0))


def when(token: str, seconds: float, within: float, n: int = 0) -> Expect:
    """The time of a row."""
    return Expect(f"time of '{token}' {n}", lambda run: float(run.row(token, n)["time"]), seconds, within)


def last_time(seconds: float, within: float) -> Expect:
    """The time of the last row."""
    return Expect("time of the last row", lambda run: float(run.ledger["time"][-1]), seconds, within)


def of_row(token: str, name: str, value: float, within: float, n: int = 0) -> Expect:
    """Another field of a row."""
    return Expect(f"{name} of '{token}' {n}", lambda run: float(run.row(token, n)[name]), value, within)


def count(token: str, rows: int, within: int = 0) -> Expect:
    """How many rows of one kind there are."""
    return Expect(f"number of '{token}'", lambda run: float(run.tokens().count(token)), rows, within)


def speed(value: float, within: float) -> Expect:
    return Expect("speed", lambda run: math.hypot(*run.velocity), value, within)


def between(what: str, seen: Callable[[Run], float], low: float, high: float) -> Expect:
    """A number that is only known to lie in a range."""
    return Expect(what, seen, (low + high) / 2, (high - low) / 2)


# ---- playing


def new_world(scene: Scene, *, balls: int = 1, lean: bool = False) -> World:
    """A world of the scene, in the kernel that has every feature of one ball, or in the scene's own.

    There is one kernel for each set of features, and it takes long to compile. With the one that has them all, the
    whole suite needs one for discs and one for points; a soak runs it in the lean ones, too.
    """
    return World(scene, balls, features=() if lean else ALL_FOR_ONE_BALL)


def play(case: Case, *, pieces: int = 1, restored: bool = False, lean: bool = False, watch: Watch | None = None) -> Run:
    """Play a case: each duration in `pieces` uneven pieces.

    restored: each piece in a new world from a snapshot. watch: called after each piece with the world and the names of
    the elements that are switched off.
    """
    run = Run(_names(case.scene))
    pages: list[np.ndarray] = []
    off = set[str]()
    try:
        world = new_world(case.scene, lean=lean)
        world.reset(position=case.position, velocity=case.velocity)
        for step in case.script:
            if isinstance(step, tuple):
                _command(world, step)
                if step[0] == "replace":
                    off = set()
                elif step[0] == "enable":
                    (off.discard if step[2] else off.add)(step[1])
            else:
                for piece in cut(step, pieces):
                    if restored:
                        world = _restored(world, lean)
                    rows = world.advance(piece, ledger=True, max_events=case.max_events)
                    if case.keep_ledger and rows is not None:
                        pages.append(rows)
                    if watch is not None:
                        watch(world, off)
            run.states.append(world.position.tobytes() + world.velocity.tobytes())
    except ValueError as error:
        run.refusal = str(error)
        return run
    run.ledger = np.concatenate(pages) if pages else None
    run.position, run.velocity = tuple(world.position[0].tolist()), tuple(world.velocity[0].tolist())
    run.time, run.status = world.time, STATUS[int(world.status[0])]
    return run


def cut(seconds: float, pieces: int) -> list[float]:
    """Uneven durations whose exact sum is `seconds`: all are multiples of its unit in the last place."""
    if pieces == 1:
        return [seconds]
    unit = math.ulp(seconds)
    marks = [math.floor((math.sqrt(5) * k + k * k / pieces) % pieces / pieces * seconds / unit) for k in range(pieces)]
    marks = sorted({*marks, 0, round(seconds / unit)})
    return [(b - a) * unit for a, b in pairwise(marks)]


def _names(scene: Scene) -> list[str]:
    return [element.name or str(index) for index, element in enumerate(scene.elements)]


def _command(world: World, step: tuple[Any, ...]) -> None:
    name, *arguments = step
    getattr(world, name)(*arguments)


def _restored(world: World, lean: bool) -> World:
    other = new_world(world.scene, lean=lean)
    other.restore(world.snapshot())
    return other


# ---- judging


@dataclass(frozen=True)
class Outcome:
    """One thing that a case expects, and what was seen."""

    case: str
    what: str
    expected: str
    seen: str
    error: float  # 0 or 1 for what is no number
    within: float

    @property
    def right(self) -> bool:
        return self.error <= self.within  # False for NaN


def judge(case: Case, run: Run) -> Iterator[Outcome]:
    """All outcomes of a run: refusal, status, ledger and numbers."""
    if case.refused or run.refusal:
        right = bool(case.refused) and re.search(case.refused, run.refusal) is not None
        yield Outcome(case.name, "refusal", case.refused, run.refusal, float(not right), 0.0)
        return
    yield Outcome(case.name, "status", "|".join(case.status), run.status, float(run.status not in case.status), 0.0)
    text = run.text()
    if case.keep_ledger and case.rows is not None:
        right = re.fullmatch(case.rows, text) is not None
        yield Outcome(case.name, "ledger", case.rows, shortened(text), float(not right), 0.0)
    for item in case.expect:
        seen = item.seen(run)
        yield Outcome(case.name, item.what, repr(item.expected), repr(seen), abs(seen - item.expected), item.within)
    numbers = [*run.position, *run.velocity, run.time]
    if run.ledger is not None:
        numbers += [x for name in run.ledger.dtype.names or () for x in run.ledger[name].tolist()]
        yield Outcome(case.name, "time runs on", "True", *_flag(bool((np.diff(run.ledger["time"]) >= 0).all())), 0.0)
    yield Outcome(case.name, "no NaN", "True", *_flag(all(map(math.isfinite, numbers))), 0.0)


def _flag(right: bool) -> tuple[str, float]:
    return str(right), float(not right)


def shortened(text: str) -> str:
    """The text of a ledger with repeated rows counted."""
    parts: list[list[Any]] = []
    for token in text.split(", ") if text else []:
        if parts and parts[-1][0] == token:
            parts[-1][1] += 1
        else:
            parts.append([token, 1])
    words = [token if n == 1 else f"{token} x{n}" for token, n in parts]
    return ", ".join(words if len(words) <= 12 else [*words[:8], f"... {len(words) - 12} more", *words[-4:]])
