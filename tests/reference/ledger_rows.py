"""The rows of a ledger one by one: bounces, contacts, crossings; what each leaves is what the next motion starts from.

Of the ledger checker: plain Python and numpy, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from bounce_env.scene import Sensor, Wall
from tests.reference.ledger_contact import (
    Settling,
    after_contact,
    along,
    closing_on,
    press_on,
    projections,
    settling,
)
from tests.reference.ledger_known import Known, Way
from tests.reference.ledger_law import HOP_ULPS, Surface, outcomes, split
from tests.reference.ledger_motion import Core
from tests.reference.ledger_row import BOUNCE, CONTACT_BEGINS, CORNER_BOUNCE, Row, apart
from tests.reference.ledger_sensors import Report, curve_of
from tests.reference.ledger_setting import EXACT, TOLERANCE
from tests.reference.ledger_shapes import direction
from tests.reference.ledger_touch import ULP, Bearing, Own
from tests.reference.ledger_walk import Bearer, Mode, State


class RowChecks(Known):
    """The checks of rows; what is wrong goes to `problems`."""

    # ---- bounces

    def comes_to(self, index: int, row: Row) -> Own | None:
        """The element that a bounce's row names, if the ball lies on it; the ball goes on from there."""
        self.remember(row)
        own = self.stands_on(index, row)
        self.goes_on(row)
        return own

    def bounce(self, index: int, row: Row) -> None:
        own, scale = self.comes_to(index, row), self.blur(row)
        if own is None:
            return
        closing, _ = split(self.surfaces(row, 0.0)[0], *row.before)
        rival = self.touches.rival(index)
        if rival.which != row.element and rival.faster > scale:
            self.say(index, f"elements[{rival.which}] is closed on faster, by {rival.faster:.3g} m/s")
        if rival.first < row.element and closing > scale:
            self.say(index, f"elements[{rival.first}] is closed on as fast, and comes first")
        self.closes_no_more(index, row)
        if closing <= scale:
            off = [(row.vx0 + s.least * s.nx, row.vy0 + s.least * s.ny) for s in self.surfaces(row, 0.0) if s.least]
            if any(apart(v, row.after) <= scale for v in off):  # the smallest rebound
                self.left = row.time
                return
            if closing <= 0.0:
                words = f"at {closing:.3g} m/s the ball does not close on elements[{row.element}]"
                self.say(index, f"{words}, nor does it leave with the smallest rebound, to one of {off}")
                return
        self.bounces_by_law(index, row, own, scale)

    def corner_bounce(self, index: int, row: Row) -> None:
        """Two rows that stand side by side: each pushes along its normal, both together turn the velocity round."""
        own, scale = self.comes_to(index, row), self.blur(row)
        if own is None:
            return
        push = (row.vx1 - row.vx0) * row.nx + (row.vy1 - row.vy0) * row.ny
        if push < -scale or apart((row.vx0 + push * row.nx, row.vy0 + push * row.ny), row.after) > scale:
            self.say(index, f"{row.before} to {row.after} is no push along the normal")
        mates = [self.rows[k] for k in (index - 1, index + 1) if 0 <= k < len(self.rows)]
        mates = [mate for mate in mates if (mate.kind, mate.time) == (CORNER_BOUNCE, row.time)]
        if not mates:
            self.say(index, "nothing else shares in this bounce")
        elif mates[0] == self.rows[index - 1] and self.shared == index - 1:
            first = mates[0]
            b = self.scene.ball.b * self.scene.elements[row.element].b
            closing = [-(first.vx0 * r.nx + first.vy0 * r.ny) for r in (first, row)]
            if min(closing) <= 0.0 or abs(closing[0] - closing[1]) > scale:
                self.say(index, f"the two are closed on at {closing[0]:.9g} and {closing[1]:.9g} m/s")
            if all(apart((-e * first.vx0, -e * first.vy0), row.after) > scale for e in (b, 0.0)):
                self.say(index, f"the bounce turns {first.before} into {row.after}, not into {-b} times it")
            self.closes_no_more(index, row)
        else:
            self.shared = index

    def bounces_by_law(self, index: int, row: Row, own: Own, scale: float) -> None:
        """The velocity after must be what the law makes of the one before, or what a corner leaves of it."""
        lawful = []
        for surface in (s for curvature in own.curvatures for s in self.surfaces(row, curvature)):
            lawful = list(self.lawful(row, surface))
            met = [kicked for v, kicked in lawful if apart(v, row.after) <= scale]
            if met and met[0]:
                self.kicked[row.element] = row.time
            elif met and self.walk.bearer is None and (way := self.settles(row, surface)) is not None:
                self.ways.insert(0, way)
            if met:
                return
        ends = list(self.ends_of_corner(index, row, self.bearings(row)))
        if self.left == row.time:  # what the smallest rebound closes on it leaves along
            ends += [along(b, row.before) for b in self.bearings(row) if b.element == row.element]
        if all(apart(v, row.after) > scale for v in ends):
            self.say(index, f"the bounce leaves one of {[v for v, _ in lawful] + ends}, not {row.after}")

    def lawful(self, row: Row, surface: Surface) -> Iterator[tuple[tuple[float, float], bool]]:
        """The velocities that the law allows, and whether each took a kick."""
        cooldown = self.scene.elements[row.element].cooldown
        since = row.time - self.kicked.get(row.element, -math.inf)
        close = 4.0 * ULP * row.time
        for outcome in outcomes(surface, self.rules, *row.before, since >= cooldown - close, since < cooldown + close):
            yield (outcome.vx, outcome.vy), outcome.kicked

    def ends_of_corner(self, index: int, row: Row, bearings: Sequence[Bearing]) -> Iterator[tuple[float, float]]:
        """What is left of the velocity where the bounces in a corner are over."""
        if not self.is_over(index, bearings, row.before):
            return
        a = self.walk.acceleration
        for left in projections(bearings, row.before):
            yield left
            yield from self.kept_ahead(row, bearings, left)
            for b in bearings:
                if self.walk.bearer is not None and b.element == self.walk.bearer.element:
                    f = self.scene.ball.f * self.scene.elements[b.element].f
                    yield from after_contact(b, bearings, left, a, f, self.rules)

    def kept_ahead(
        self, row: Row, bearings: Sequence[Bearing], v: tuple[float, float]
    ) -> Iterator[tuple[float, float]]:
        """The same velocity, but for what lets it leave a part that turns or stretches with the smallest rebound."""
        for part in bearings:
            for surface in self.surfaces(row._replace(element=part.element), 0.0) if part.moves else ():
                short = surface.least + closing_on(part, v)
                if short > 0.0:
                    yield v[0] + short * part.nx, v[1] + short * part.ny
                for other in bearings:
                    turn = part.nx * other.ny - part.ny * other.nx
                    if short > 0.0 and abs(turn) > 1e-9:
                        yield v[0] + short * other.ny / turn, v[1] - short * other.nx / turn

    def settles(self, row: Row, surface: Surface) -> Way | None:
        """The motion along a wall that stands for the bounces still to come, where they are too small to tell."""
        end: Settling | None = settling(surface, self.rules, row.after)
        if end is None:
            return None
        bearer = Bearer(row.element, row.nx, row.ny, row.ux, row.uy)
        state = State(row.time, row.x, row.y, end.vx, end.vy)
        return Way(state, Mode.SLIDES if end.slides else Mode.SETTLES, bearer, row.time + end.seconds)

    # ---- contacts

    def contact_begins(self, index: int, row: Row) -> None:
        self.remember(row)
        own = self.stands_on(index, row)
        settles_at = self.walk.settles_at
        settled = settles_at < math.inf
        if settled and self.walk.bearer is not None and self.walk.bearer.element == row.element:
            undisturbed = row.time not in self.setting.commanded and not self.walk.pull.fields and not self.setting.runs
            if abs(settles_at - row.time) > EXACT * settles_at and undisturbed:
                self.say(index, f"the bounces end at {settles_at!r}, not at {row.time!r}")
        elif self.walk.bearer is not None and not settled:
            self.say(index, f"the ball is in contact with elements[{self.walk.bearer.element}]")
        state = State(row.time, row.x, row.y, *row.after)
        self.ways = [Way(state, Mode.FLIES, None)]
        if own is None:
            return
        bearer = Bearer(row.element, row.nx, row.ny, row.ux, row.uy)
        mode = self.mode_on(bearer, state)
        if mode is Mode.RESTS and apart(row.after, (row.ux, row.uy)) > self.blur(row):
            mode = Mode.SLIDES  # pushed along by something else
        self.ways = [Way(state, mode, bearer)]
        self.closes_no_more(index, row)
        bearings = self.bearings(row)
        a, scale = self.walk.acceleration, self.blur(row)
        closing = max((closing_on(b, row.before) for b in bearings), default=0.0)
        # Whether it closes on anything that it surely touches has been looked at.
        bases = [row.before] if split(self.surfaces(row, 0.0)[0], *row.before)[0] <= scale else []
        if closing > 0.0 and self.is_over(index, bearings, row.before):
            for left in projections(bearings, row.before):
                bases += [left, *self.kept_ahead(row, bearings, left)]
        lawful = []
        for b in bearings:
            if b.element == row.element and apart((b.nx, b.ny), (row.nx, row.ny)) <= TOLERANCE:
                f = self.scene.ball.f * self.scene.elements[b.element].f
                lawful += [v for base in bases for v in after_contact(b, bearings, base, a, f, self.rules)]
        if all(apart(v, row.after) > scale for v in lawful):
            self.say(index, f"the contact can leave one of {lawful}, not {row.after}")

    def contact_ends(self, index: int, row: Row) -> None:
        self.remember(row)
        bearer = self.walk.bearer
        self.ways = [Way(State(row.time, row.x, row.y, *row.after), Mode.FLIES, None)]
        self.must_end = False
        if bearer is None or bearer.element != row.element or self.walk.settles_at < math.inf:
            self.say(index, f"the ball is not in contact with elements[{row.element}]")
            return
        self.stands_on(index, row)
        self.closes_no_more(index, row)
        if apart(row.before, row.after) > self.blur(row):
            self.say(index, f"the end of a contact changes no velocity, but here {row.before} to {row.after}")
        if not self.has_reason_to_end(index, row, bearer):
            self.say(index, f"nothing ends the contact with elements[{row.element}]")

    def has_reason_to_end(self, index: int, row: Row, bearer: Bearer) -> bool:
        """Taken off or pushed off, not pressed any more, switched off, past the wall's end, taken over, or rolling."""
        vx, vy = row.after
        leaving = max(
            (vx - ux) * bearer.nx + (vy - uy) * bearer.ny for ux, uy in ((bearer.ux, bearer.uy), (row.ux, row.uy))
        )
        off = not self.walk.enabled[row.element] or (row.time, False) in self.setting.switches.get(row.element, [])
        freed = any(time == row.time for time, _ in self.setting.drive.freed.get(self.ball, []))
        if leaving > 4.0 * ULP * (abs(vx) + abs(vy)) or off or freed:
            return True
        takes_over = self.rows[index + 1 : index + 2]
        if any(r.kind == CONTACT_BEGINS and r.time == row.time for r in takes_over):
            return True
        bounces = [r for r in takes_over if (r.kind, r.time) == (BOUNCE, row.time)]
        if any(r.vx1 * bearer.nx + r.vy1 * bearer.ny > vx * bearer.nx + vy * bearer.ny for r in bounces):  # it hops off
            return True
        run = self.setting.runs.get(row.element)
        core = None if run is None else run.around(row.time, EXACT * row.time)
        if self.is_moved_on(index, row):
            return True
        if self.jammed == row.time or (core is not None and _deforms(core)):
            return True
        wall = self.scene.elements[row.element]
        ax, ay = self.walk.acceleration
        flat = Bearing(row.element, bearer.nx, bearer.ny, 0.0, 0.0, 0.0, True)
        if press_on(flat, row.after, (ax, ay)) <= EXACT * math.hypot(ax, ay):
            return True
        if not isinstance(wall, Wall):
            return math.hypot(vx, vy) > self.blur(row)
        start, end = wall.start, wall.end
        if core is not None:
            start, end = (float(core.x0[0]), float(core.y0[0])), (float(core.x1[0]), float(core.y1[0]))
        ex, ey, length = direction(start, end)
        at = (row.x - start[0]) * ex + (row.y - start[1]) * ey
        rate = (vx - row.ux) * ex + (vy - row.uy) * ey or ax * ex + ay * ey
        allowed = TOLERANCE * self.size
        return (at >= length - allowed and rate > 0.0) or (at <= allowed and rate < 0.0)

    def is_moved_on(self, index: int, row: Row) -> bool:
        """Whether a part that touches the ball, too, moves it on or has just begun to, or another ball put it off."""
        now = {k for k, run in self.setting.runs.items() if row.time in run.changes}
        bearings = self.bearings(row)
        if any(b.element in now or (b.element != row.element and (b.ux or b.uy)) for b in bearings):
            return True
        met = any(r.kind == BOUNCE and r.element >= len(self.scene.elements) for r in self.at_instant(index))
        return met and self.touches.own(index).gap > HOP_ULPS * self.extent

    # ---- sensors

    def crossing(self, index: int, row: Row) -> None:
        sensor = self.scene.elements[row.element]
        walk = self.walk
        self.ways = [Way(State(row.time, row.x, row.y, *row.after), walk.mode, walk.bearer, walk.settles_at)]
        if not isinstance(sensor, Sensor):
            self.say(index, f"elements[{row.element}] is no sensor")
            return
        curve = curve_of(sensor)
        allowed = TOLERANCE * self.size
        if abs(curve.height(row.x, row.y)) > allowed or curve.margin(row.x, row.y) < -allowed:
            self.say(index, f"the ball's centre is not on elements[{row.element}]")
        nx, ny = curve.normal(row.x, row.y)
        side = -1.0 if nx * row.vx0 + ny * row.vy0 > 0.0 and sensor.segment is not None else 1.0
        if apart((side * nx, side * ny), (row.nx, row.ny)) > EXACT:
            self.say(index, f"the normal is {(side * nx, side * ny)}, not {(row.nx, row.ny)}")
        if (row.after, row.ux, row.uy) != (row.before, 0.0, 0.0):
            self.say(index, "a sensor changes no velocity and has none")
        self.reports.setdefault(row.element, []).append(Report(index, row.time, (row.nx, row.ny)))
        self.walk.out = sensor.drain


def _deforms(core: Core) -> bool:
    """Whether a part turns or stretches: then there is no contact with it."""
    return bool(core.spin.any() or (core.vx0 != core.vx1).any() or (core.vy0 != core.vy1).any())
