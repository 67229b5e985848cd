"""What is known on the way through a ledger from row to row, and what the checks of its rows have in common.

Of the ledger checker: plain Python and numpy, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from ledger_contact import (
    is_carried,
    is_over,
)
from ledger_law import HOP_ULPS, Rules, Surface, is_friction
from ledger_parts import PaddleRun
from ledger_sensors import Report, Switches
from ledger_shapes import Shapes
from ledger_touch import ULP, Bearing, Ledger, Own, Touches
from ledger_walk import Bearer, Command, Mode, State, Walk

from bounce_env.scene import Arc, Field, Paddle, Scene, Sensor

BOUNCE, CONTACT_BEGINS, CONTACT_ENDS, CROSSING, PART_STOPS = range(5)
TOLERANCE = 1e-9  # of lengths relative to the scene's size, of speeds relative to those that enter
EXACT = 1e-12  # what one formula may lose
STANDING = 1e-290  # [m/s] slower than this is not at all
BOUNCES_AT_ONE_INSTANT = 32  # after so many the ball is stopped by what it touches


class Row(NamedTuple):
    time: float
    ball: int
    element: int
    kind: int
    x: float
    y: float
    nx: float
    ny: float
    vx0: float
    vy0: float
    vx1: float
    vy1: float
    ux: float
    uy: float

    @property
    def before(self) -> tuple[float, float]:
        return self.vx0, self.vy0

    @property
    def after(self) -> tuple[float, float]:
        return self.vx1, self.vy1


class Way(NamedTuple):
    """One of the motions that a row may lead to, see `Walk.place`."""

    state: State
    mode: Mode
    bearer: Bearer | None
    settles_at: float = math.inf


def apart(a: tuple[float, float], b: tuple[float, float]) -> float:
    return math.hypot(a[0] - b[0], a[1] - b[1])


class Known:
    """What is known on the way through a ledger, and the checks of its rows; `problems` fills meanwhile."""

    def __init__(self, scene: Scene, start: State, ledger: Ledger, end: float, commands: Sequence[Command]) -> None:
        self.scene = scene
        self.rows = [Row(*values) for values in ledger.tolist()]
        self.problems: list[str] = []
        x0, y0, x1, y1 = scene.bounds
        # An arc's places are known from its centre, however far that is from what it occupies.
        far = [max(map(abs, e.center)) + e.radius for e in scene.elements if isinstance(e, Arc)]
        largest = max(abs(x0), abs(y0), abs(x1), abs(y1), *far) + scene.ball.radius
        self.size = max(x1 - x0, y1 - y0) or 1.0
        self.extent = math.ldexp(1.0, math.frexp(largest)[1])
        names = {element.name: index for index, element in enumerate(scene.elements) if element.name}
        self.switches: Switches = {}
        for time, name, value in commands:
            if isinstance(value, bool):
                self.switches.setdefault(names[name], []).append((time, value))
        self.commanded = {command[0] for command in commands}
        self.paddles: dict[int, PaddleRun] = {}
        for index, element in enumerate(scene.elements):
            if isinstance(element, Paddle):
                speeds = [(t, v) for t, name, v in commands if name == element.name and type(v) is float]
                self.paddles[index] = PaddleRun(element, speeds, end)
        self.shapes = Shapes(scene, self.paddles)
        self.touches = Touches(self.shapes, ledger, self.switches, {0.0, *self.commanded}, self.extent)
        cuts = sorted({t for paddle in self.paddles.values() for t in paddle.changes})
        self.walk = Walk(scene, start, commands, cuts)
        max_speed = math.inf if scene.max_speed is None else scene.max_speed
        self.rules = Rules(scene.rest_speed, max_speed, HOP_ULPS * self.extent)
        self.kicked: dict[int, float] = {}  # when each element gave its last kick
        self.ways = [Way(start, Mode.FLIES, None)]  # that the last row may have led to
        self.must_end = False  # whether the ball has left what it was in contact with
        self.reports: dict[int, list[Report]] = {}
        self.instant, self.fastest = -math.inf, 0.0  # [s] of the last bounce or contact, [m/s] in any row of it
        self.rolls_on = -1  # the element off which the ball hopped in its last bounce
        self.place = start[1:3]
        self.known: dict[int, tuple[float, float]] = {}  # normals of what was touched at this place

    def say(self, index: int, words: str) -> None:
        self.problems.append(f"row {index}: {words}")

    # ---- what rows have in common

    def stands_on(self, index: int, row: Row) -> Own | None:
        """The ball must lie on the element that the row names."""
        if isinstance(self.scene.elements[row.element], Sensor | Field):
            self.say(index, f"elements[{row.element}] bounces nothing")
            return None
        own = self.touches.own(index)
        if not abs(own.gap) <= TOLERANCE * self.size:
            self.say(index, f"the ball is {own.gap:.3g} m away from elements[{row.element}]")
            return None
        # The normal is known as well as the place, over the distance from the middle of the curve.
        blur = EXACT + 32.0 * ULP * self.extent * abs(own.curvatures[0])
        if apart((own.nx, own.ny), (row.nx, row.ny)) > blur:
            self.say(index, f"the normal is {(own.nx, own.ny)}, not {(row.nx, row.ny)}")
        paddle = self.paddles.get(row.element)
        allowed = [(0.0, 0.0)] if paddle is None else paddle.velocities(row.time, EXACT * row.time)
        if all(apart(u, (row.ux, row.uy)) > EXACT * math.hypot(*u) for u in allowed):
            self.say(index, f"the surface moves at {allowed[-1]}, not {(row.ux, row.uy)}")
        if own.owner != row.element and own.owner not in self.switches:
            self.say(index, f"it is elements[{own.owner}] that ends there first")
        return own

    def blur(self, row: Row) -> float:
        """Speeds [m/s] smaller than this are what is left of larger ones at the same instant, or of its rounding."""
        return STANDING + EXACT * self.fastest + 4.0 * ULP * row.time * math.hypot(*self.walk.acceleration)

    def remember(self, row: Row) -> None:
        """Note what later rows at this instant, or at this place, go by."""
        speed = sum(map(abs, (*row.before, *row.after, row.ux, row.uy)))
        self.fastest = speed if row.time > self.instant else max(speed, self.fastest)
        if apart(self.place, (row.x, row.y)) > EXACT * self.extent:
            self.known.clear()
        self.instant, self.place, self.known[row.element] = row.time, (row.x, row.y), (row.nx, row.ny)

    def surface(self, row: Row, curvature: float) -> Surface:
        ball, element = self.scene.ball, self.scene.elements[row.element]
        ax, ay = self.walk.acceleration
        return Surface(
            row.nx, row.ny, row.ux, row.uy, curvature, ax, ay,
            ball.b * element.b, ball.f * element.f, element.kick, element.kick_threshold,
            self.rolls_on == row.element,
        )  # fmt: skip

    def bearings(self, row: Row) -> list[Bearing]:
        """Everything that is touched when the ball comes with the velocity before the row."""
        return self.touching(State(row.time, row.x, row.y, *row.before))

    def touching(self, state: State) -> list[Bearing]:
        walk = self.walk
        return self.touches.all_at(self.shapes, state, walk.enabled, walk.acceleration, self.known)

    def is_over(self, index: int, bearings: Sequence[Bearing]) -> bool:
        """Whether the bounces at this instant end here, because they are soft or too many."""
        row = self.rows[index]
        kicks = []
        for bearing in bearings:
            element = self.scene.elements[bearing.element]
            kicks.append(element.kick_threshold if element.kick > 0.0 else math.inf)
        if is_over(bearings, row.before, self.walk.acceleration, self.rules, kicks):
            return True
        first = max(0, index - BOUNCES_AT_ONE_INSTANT - 2)  # the end of a contact may come between
        return sum(r.kind == BOUNCE and r.time == row.time for r in self.rows[first:index]) >= BOUNCES_AT_ONE_INSTANT

    def goes_on(self, row: Row) -> None:
        """From here the ball goes on as before: in flight, or in the contact that it is in."""
        state, bearer = State(row.time, row.x, row.y, *row.after), self.walk.bearer
        mode = Mode.FLIES
        if bearer is not None:
            mode = self.mode_on(bearer, state)
            wx, wy = row.vx1 - bearer.ux, row.vy1 - bearer.uy
            moves = math.hypot(wx, wy) > self.blur(row)
            self.must_end = wx * bearer.nx + wy * bearer.ny > self.blur(row) or (mode is Mode.RESTS and moves)
            mode = Mode.FLIES if self.must_end else mode
        self.ways = [Way(state, mode, bearer)]

    def mode_on(self, bearer: Bearer, state: State) -> Mode:
        """What a ball does that is in contact with an element."""
        f = self.scene.ball.f * self.scene.elements[bearer.element].f
        if is_friction(f, self.rules):
            return Mode.RESTS
        bearings = self.touching(state)
        if state.vx == state.vy == 0.0 and is_carried(self.walk.acceleration, bearings):
            return Mode.RESTS
        slides = any(b.element == bearer.element and b.straight for b in bearings)
        return Mode.SLIDES if slides else Mode.RESTS

    def is_last(self, index: int) -> bool:
        """Whether nothing more happens to the ball at this instant."""
        later = (r for r in self.rows[index + 1 :] if r.kind in (BOUNCE, CONTACT_BEGINS, CONTACT_ENDS))
        return next((r.time for r in later), math.inf) > self.rows[index].time

    def closes_no_more(self, index: int, row: Row) -> None:
        closing = self.touches.rival(index).closing
        if closing > self.blur(row) and self.is_last(index):
            self.say(index, f"something is still closed on, at {closing:.3g} m/s")
