"""One ball's motion from event to event, carried on in closed form from what the ledger says of the last event.

Of the ledger checker: plain Python, no code of the engine.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from enum import Enum, auto
from typing import NamedTuple

from bounce_env.scene import Field, Scene
from tests.reference.ledger_drive import Command, is_command
from tests.reference.ledger_paths import Piece, Pull

LONGEST = 10_000  # pieces of one flight: no ball passes more borders of fields than that between two events


class State(NamedTuple):
    time: float
    x: float
    y: float
    vx: float
    vy: float


class Mode(Enum):
    FLIES = auto()
    SLIDES = auto()  # along a wall, under what the wall leaves of the acceleration
    RESTS = auto()
    STANDS = auto()  # between other balls, for a while
    SETTLES = auto()  # moves uniformly along a wall: pushed by a part, or shown so while its last small bounces go on


class Bearer(NamedTuple):
    """The element that a ball is in contact with, its unit normal there, and the velocity of its surface [m/s]."""

    element: int
    nx: float
    ny: float
    ux: float
    uy: float


class Mark(NamedTuple):
    """Enough of a walk to go back to."""

    state: State
    pieces: int
    waiting: tuple[Command, ...]
    enabled: tuple[bool, ...]


class Walk:
    """Where the ball is, and the pieces of the path that led there."""

    def __init__(self, scene: Scene, start: State, commands: Sequence[Command], cuts: Sequence[float]) -> None:
        """`cuts`: times at which a piece must end, ascending."""
        self.state = start
        self.pieces: list[Piece] = []
        self.mode = Mode.FLIES
        self.bearer: Bearer | None = None
        self.settles_at = math.inf
        self.stands_until = math.inf
        self.out = False
        self.waiting = tuple(sorted(commands, key=lambda command: command[0]))
        self.unpressed = False  # whether it slid where nothing pressed it on the wall, since `place`
        self._cuts = cuts
        self._scene = scene
        self._names = {e.name: i for i, e in enumerate(scene.elements) if e.name}
        self.enabled = (True,) * len(scene.elements)
        self._near = 1e-13 * max(1e-9, *(abs(side) for side in scene.bounds))
        self._take_fields()

    def _take_fields(self) -> None:
        on = [e for e, on in zip(self._scene.elements, self.enabled, strict=True) if on and isinstance(e, Field)]
        self.pull = Pull(self._scene.gravity, on)

    def place(
        self,
        state: State,
        mode: Mode,
        bearer: Bearer | None,
        settles_at: float = math.inf,
        stands_until: float = math.inf,
    ) -> None:
        """Go on from here.

        settles_at: when the contact with the bearer begins, if it has not. stands_until: when it flies, if it stands.
        """
        self.state, self.mode, self.bearer, self.settles_at = state, mode, bearer, settles_at
        self.stands_until = stands_until
        self.unpressed = False

    def mark(self) -> Mark:
        return Mark(self.state, len(self.pieces), self.waiting, self.enabled)

    def back(self, mark: Mark) -> None:
        self.state, self.waiting, self.enabled = mark.state, mark.waiting, mark.enabled
        del self.pieces[mark.pieces :]
        self._take_fields()

    @property
    def acceleration(self) -> tuple[float, float]:
        """What pulls at the ball where it is [m/s^2], whatever bears it."""
        if not self.pull.fields:
            return self.pull.gravity
        s = self.state
        return self._first_stretch(s, 1.0, *self.pull.at(s.x, s.y))[1]

    def carry(self, until: float, row: int) -> None:
        """Move on to a time; commands at that very time have yet to act."""
        while self.waiting and self.waiting[0][0] < until:
            self._move(self.waiting[0][0], row)
            self.act()
        self._move(until, row)

    def act(self) -> bool:
        """Let all commands of this instant act; False if there is none."""
        now = self.state.time
        due = [command for command in self.waiting if command[0] <= now]
        if not due:
            return False
        self.waiting = self.waiting[len(due) :]
        # Drag acts at the commands of parts.
        to_parts = [is_command(self._scene, name, value) for _, name, value in due]
        share = self._scene.drag if any(to_parts) else 1.0
        vx, vy = share * self.state.vx, share * self.state.vy
        enabled = list(self.enabled)
        for (_, name, value), to_part in zip(due, to_parts, strict=True):
            if to_part:
                continue
            if isinstance(value, bool):
                enabled[self._names[name]] = value
            else:
                vx, vy = vx + value[0], vy + value[1]  # type: ignore[index, operator]
        self.enabled = tuple(enabled)
        self._take_fields()
        self.state = self.state._replace(vx=vx, vy=vy)
        if self.settles_at < math.inf:  # that contact does not begin any more, or now
            self.place(self.state, Mode.FLIES, None)
        return True

    def _move(self, until: float, row: int) -> None:
        first = bisect_right(self._cuts, self.state.time)
        for cut in (*self._cuts[first : bisect_left(self._cuts, until)], until):
            if self.mode is Mode.STANDS and self.stands_until < cut:
                self._go(max(self.stands_until, self.state.time), row)
                self.mode = Mode.FLIES
            self._go(cut, row)

    def _go(self, until: float, row: int) -> None:
        """In pieces of constant acceleration, from border to border of the fields."""
        if self.out:
            self.state = self.state._replace(time=until)
            return
        element = -1 if self.bearer is None else self.bearer.element
        for _ in range(LONGEST):
            s = self.state
            seconds, (ax, ay) = until - s.time, self.pull.gravity
            if self.pull.fields:
                seconds, (ax, ay) = self._first_stretch(s, seconds, *self.pull.at(s.x, s.y))
            last = seconds >= until - s.time
            if self.bearer is not None and self.mode is not Mode.RESTS and seconds > 0.0:
                into = ax * self.bearer.nx + ay * self.bearer.ny
                self.unpressed |= into >= 0.0  # however little it is pressed, the wall bears it
            if self.mode is Mode.RESTS and self.bearer is not None:
                s = s._replace(vx=self.bearer.ux, vy=self.bearer.uy)
            piece = Piece(s.time, seconds, s.x, s.y, s.vx, s.vy, *self._borne(ax, ay), element, row)
            self.pieces.append(piece)
            self.state = State(until if last else s.time + seconds, *piece.at(seconds))
            if last:
                return
        raise ValueError("a flight passes more borders of fields than it can")

    def _first_stretch(self, s: State, seconds: float, ax: float, ay: float) -> tuple[float, tuple[float, float]]:
        """For how long, at most `seconds`, no border of a field is passed, and the acceleration meanwhile."""
        best = (seconds, (ax, ay))
        for _ in range(4):  # on a border the place does not tell: take the acceleration that the path then meets
            piece = Piece(s.time, seconds, s.x, s.y, s.vx, s.vy, *self._borne(ax, ay), -1, -1)
            borders = [t for t in self.pull.borders(piece) if self._leaves(piece, t)]
            middles = [0.5 * (a + b) for a, b in zip([0.0, *borders], [*borders, seconds], strict=True)]
            met = [self.pull.at(*piece.at(t)[:2]) for t in middles]
            change = next((k for k in range(1, len(met)) if met[k] != met[0]), None)
            best = (seconds if change is None else borders[change - 1], met[0])
            if met[0] == (ax, ay):
                return best
            ax, ay = met[0]
        return best

    def _leaves(self, piece: Piece, t: float) -> bool:
        """Whether the ball has gone anywhere, if only there and back, so that a border is not that of the start."""
        return (abs(piece.vx) + abs(piece.vy) + (abs(piece.ax) + abs(piece.ay)) * t) * t > self._near

    def _borne(self, ax: float, ay: float) -> tuple[float, float]:
        """The acceleration that is left to the ball."""
        return self.borne_by(self.mode, self.bearer, ax, ay)

    @staticmethod
    def borne_by(mode: Mode, bearer: Bearer | None, ax: float, ay: float) -> tuple[float, float]:
        """What an acceleration leaves to a ball that does so."""
        if mode is Mode.STANDS:
            return 0.0, 0.0
        if mode is Mode.FLIES or bearer is None:
            return ax, ay
        if mode is not Mode.SLIDES:
            return 0.0, 0.0
        into = ax * bearer.nx + ay * bearer.ny
        return ax - into * bearer.nx, ay - into * bearer.ny
