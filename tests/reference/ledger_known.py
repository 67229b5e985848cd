"""What is known on the way through the rows of one ball, and what the checks of its rows have in common.

Of the ledger checker: plain Python and numpy, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import NamedTuple

import numpy as np

from bounce_env.scene import Field, Sensor
from tests.reference.ledger_contact import PRESSING, is_carried, is_over, is_pushed_along
from tests.reference.ledger_law import Surface, is_friction, least_rebound
from tests.reference.ledger_motion import Turning
from tests.reference.ledger_row import BOUNCE, CONTACT_BEGINS, CONTACT_ENDS, CORNER_BOUNCE, CRUSH, Row, apart
from tests.reference.ledger_sensors import Report
from tests.reference.ledger_setting import EXACT, STANDING, TOLERANCE, Setting
from tests.reference.ledger_touch import ULP, Bearing, Ledger, Own, Touches, Vector
from tests.reference.ledger_walk import Bearer, Mode, State, Walk

BOUNCES_AT_ONE_INSTANT = 32  # after so many, or more in a corner, the ball is stopped by what it touches
ENDS_INSTANT = (BOUNCE, CORNER_BOUNCE, CONTACT_BEGINS, CONTACT_ENDS, CRUSH)


class Way(NamedTuple):
    """One of the motions that a row may lead to, see `Walk.place`."""

    state: State
    mode: Mode
    bearer: Bearer | None
    settles_at: float = math.inf
    stands_until: float = math.inf


class Known:
    """What is known on the way through a ball's rows, and the checks of its rows; `problems` fills meanwhile."""

    def __init__(self, setting: Setting, ball: int, start: State, ledger: Ledger) -> None:
        """`ledger`: the whole one, of which the rows of this ball count."""
        self.setting, self.scene, self.ball = setting, setting.scene, ball
        self.size, self.extent, self.rules = setting.size, setting.extent, setting.rules
        mine = np.flatnonzero(ledger["ball"] == ball)
        self.numbers = [*mine.tolist(), len(ledger)]  # of the rows in the ledger, and that of its end
        self.rows = [setting.rows[k] for k in mine]
        self.problems: list[str] = []
        self.touches = Touches(setting.shapes, ledger[mine], setting.switches, {0.0, *setting.commanded}, self.extent)
        cuts = sorted({t for run in setting.runs.values() for t in run.changes})
        self.walk = Walk(self.scene, start, setting.commands, cuts)
        self.kicked: dict[int, float] = setting.kicked
        self.ways = [Way(start, Mode.FLIES, None)]  # that the last row may have led to
        self.must_end = False  # whether the ball has left what it was in contact with
        self.reports: dict[int, list[Report]] = {}
        self.instant, self.fastest = -math.inf, 0.0  # [s] of the last bounce or contact, [m/s] in any row of it
        self.left = -math.inf  # [s] when the ball last left a part with the smallest rebound
        self.jammed = -math.inf  # [s] when other balls last stopped it
        self.shared = -1  # the number of the row that began a bounce from two elements at once
        self.is_crushed, self.crushed_at = False, -1  # the number of the row that says so
        self.place = start[1:3]
        self.known: dict[int, tuple[float, float]] = {}  # normals of what was touched at this place

    def say(self, index: int, words: str) -> None:
        self.problems.append(f"row {self.numbers[index]}: {words}")

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
        blur = EXACT + 32.0 * ULP * self.extent * abs(own.curvatures[0]) + self._turned(row)
        if apart((own.nx, own.ny), (row.nx, row.ny)) > blur:
            self.say(index, f"the normal is {(own.nx, own.ny)}, not {(row.nx, row.ny)}")
        allowed = list(self._surface_velocities(row))
        if all(apart(u, (row.ux, row.uy)) > near for u, near in allowed):
            self.say(index, f"the surface moves at {allowed[-1][0]}, not {(row.ux, row.uy)}")
        if own.owner != row.element and own.owner not in self.setting.switches:
            self.say(index, f"it is elements[{own.owner}] that ends there first")
        return own

    def _turned(self, row: Row) -> float:
        """By what angle [rad] a part may turn within the rounding of the row's time."""
        run = self.setting.runs.get(row.element)
        if run is None:
            return 0.0
        core = run.core(np.array([row.time]))
        length = max(math.hypot(core.x1[0] - core.x0[0], core.y1[0] - core.y0[0]), STANDING)
        spread = math.hypot(core.vx1[0] - core.vx0[0], core.vy1[0] - core.vy0[0])
        return 4.0 * ULP * row.time * (spread / length)

    def _surface_velocities(self, row: Row) -> Iterator[tuple[tuple[float, float], float]]:
        """What the surface's velocity may be at the ball, and how far each [m/s] is known."""
        run = self.setting.runs.get(row.element)
        if run is None:
            yield (0.0, 0.0), 0.0
            return
        core = run.around(row.time, EXACT * row.time)
        radius = self.scene.ball.radius
        ux, uy = core.surface(row.x - radius * row.nx, row.y - radius * row.ny)
        spread = np.hypot(core.vx1 - core.vx0, core.vy1 - core.vy0)
        length = np.maximum(np.hypot(core.x1 - core.x0, core.y1 - core.y0), STANDING)
        # Which point of the core it is, is known as well as the place.
        near = EXACT * np.hypot(ux, uy) + 32.0 * ULP * spread / length * (self.extent + spread * row.time)
        yield from zip(zip(ux.tolist(), uy.tolist(), strict=True), near.tolist(), strict=True)

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

    def surfaces(self, row: Row, curvature: float) -> list[Surface]:
        """The surface that a row tells of; of a part about to move otherwise each that it may be."""
        ball, element = self.scene.ball, self.scene.elements[row.element]
        ax, ay = self.walk.acceleration
        still = Surface(
            row.nx, row.ny, row.ux, row.uy, curvature, ax, ay,
            ball.b * element.b, ball.f * element.f, element.kick, element.kick_threshold,
        )  # fmt: skip
        run = self.setting.runs.get(row.element)
        if run is None:
            return [still]
        core = run.around(row.time, EXACT * row.time)
        ex, ey = core.vx1 - core.vx0, core.vy1 - core.vy0
        dx, dy = core.x1 - core.x0, core.y1 - core.y0
        found = []
        for k in range(len(ex)):
            moves = bool(core.spin[k] or ex[k] or ey[k])
            length = math.hypot(dx[k], dy[k])
            spin = float(ey[k] * dx[k] - ex[k] * dy[k]) / length**2 if length else 0.0
            size = run.radius + ball.radius + (length if moves or isinstance(run, Turning) else 0.0)
            least = least_rebound(self.rules.rest_speed, math.hypot(ax, ay), spin, size)
            found.append(still._replace(moves=moves, least=least))
        return found

    def bearings(self, row: Row) -> list[Bearing]:
        """Everything that is touched when the ball comes with the velocity before the row."""
        return self.touching(State(row.time, row.x, row.y, *row.before))

    def touching(self, state: State) -> list[Bearing]:
        walk = self.walk
        return self.touches.all_at(self.setting.shapes, state, walk.enabled, walk.acceleration, self.known)

    def is_over(self, index: int, bearings: Sequence[Bearing], v: Vector) -> bool:
        """Whether the bounces of a ball that comes with `v` end at this row, because they are soft or too many."""
        row = self.rows[index]
        kicks = []
        for bearing in bearings:
            element = self.scene.elements[bearing.element]
            kicks.append(element.kick_threshold if element.kick > 0.0 else math.inf)
        if is_over(bearings, v, self.walk.acceleration, self.rules, kicks):
            return True
        first = max(0, index - BOUNCES_AT_ONE_INSTANT - 2)  # the end of a contact may come between
        return sum(r.kind == BOUNCE and r.time == row.time for r in self.rows[first:index]) >= BOUNCES_AT_ONE_INSTANT

    def goes_on(self, row: Row) -> None:
        """From here the ball goes on as before: in flight, or in the contact that it is in."""
        if self.walk.settles_at < math.inf:  # the contact to which it settled never began
            self.walk.settles_at, self.walk.bearer = math.inf, None
        state, bearer = State(row.time, row.x, row.y, *row.after), self.walk.bearer
        mode = Mode.FLIES
        if bearer is not None:
            if row.element == bearer.element:  # which may move otherwise than it did
                bearer = Bearer(row.element, row.nx, row.ny, row.ux, row.uy)
            mode = self.mode_on(bearer, state)
            wx, wy = row.vx1 - bearer.ux, row.vy1 - bearer.uy
            moves = math.hypot(wx, wy) > self.blur(row)
            self.must_end = wx * bearer.nx + wy * bearer.ny > self.blur(row) or (mode is Mode.RESTS and moves)
            mode = Mode.FLIES if self.must_end else mode
        self.ways = [Way(state, mode, bearer)]

    def mode_on(self, bearer: Bearer, state: State) -> Mode:
        """What a ball does that is in contact with an element."""
        f = self.scene.ball.f * self.scene.elements[bearer.element].f
        ax, ay = self.walk.acceleration
        press = -(ax * bearer.nx + ay * bearer.ny)
        bearings = self.touching(state)
        others = [b for b in bearings if b.element != bearer.element]
        moved = apart((state.vx, state.vy), (bearer.ux, bearer.uy)) > STANDING
        pushed = moved and any(b.ux or b.uy for b in others)
        if is_friction(f, self.rules) and press > PRESSING * (abs(ax) + abs(ay)) and not pushed:
            return Mode.RESTS
        if state.vx == state.vy == 0.0 and is_carried(self.walk.acceleration, bearings):
            return Mode.RESTS
        borne = [b for b in bearings if b.element == bearer.element and b.straight]
        if any(is_pushed_along(b, bearings, (state.vx, state.vy)) for b in borne):
            return Mode.SETTLES
        slides = bool(borne)
        return Mode.SLIDES if slides else Mode.RESTS

    def at_instant(self, index: int) -> Iterator[Row]:
        """The ball's earlier rows at the instant of a row, the latest first."""
        time = self.rows[index].time
        return takewhile(lambda row: row.time == time, reversed(self.rows[:index]))

    def is_last(self, index: int) -> bool:
        """Whether nothing more happens to the ball at this instant."""
        later = (r for r in self.rows[index + 1 :] if r.kind in ENDS_INSTANT)
        return next((r.time for r in later), math.inf) > self.rows[index].time

    def closes_no_more(self, index: int, row: Row) -> None:
        closing = self.touches.rival(index).closing
        if closing > self.blur(row) and self.is_last(index):
            self.say(index, f"something is still closed on, at {closing:.3g} m/s")
