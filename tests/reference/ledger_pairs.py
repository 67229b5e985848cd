"""The rows of balls that hit each other, that stop each other, and that a part crushes.

Of the ledger checker: plain Python and numpy, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence

from tests.reference.ledger_contact import closing_on, gets_away
from tests.reference.ledger_known import Way
from tests.reference.ledger_law import LEAST, capped
from tests.reference.ledger_row import BOUNCE, Row, apart
from tests.reference.ledger_rows import RowChecks
from tests.reference.ledger_setting import CLEARANCE, EXACT, TOLERANCE
from tests.reference.ledger_touch import ULP, Vector
from tests.reference.ledger_walk import Bearer, Mode, State

OPPOSED = 0.5


class PairChecks(RowChecks):
    """The checks of a ball's rows with other balls; `others` are the checks of all balls."""

    others: Sequence[PairChecks]
    pressed: Collection[bool] = (False,)  # whether the two balls of the last hit may have been pressed together

    def meets(self, index: int, row: Row) -> None:
        """A hit has two rows, one after the other; a ball that is stopped between others has one."""
        self.remember(row)
        count = len(self.scene.elements)
        other = self.others[row.element - count]
        mate = self._mate(self.numbers[index], row)
        if mate is None:
            self._is_stopped(index, row)
            return
        if (mate.nx, mate.ny) != (-row.nx, -row.ny):
            self.say(index, f"the normal is {(row.nx, row.ny)}, but the other ball's {(mate.nx, mate.ny)}")
        if (row.ux, row.uy) != mate.before:
            self.say(index, f"the other ball comes with {mate.before}, not with {(row.ux, row.uy)}")
        self._touches_ball(index, row, (mate.x, mate.y))
        lawful = list(self._exchanges(self.numbers[index], row, other))
        blur = max(self.blur(row), other.blur(mate))
        if all(apart(v, row.after) > blur for v in lawful):
            self.say(index, f"the hit leaves one of {lawful}, not {row.after}")
        self._go_on(row)

    def _mate(self, number: int, row: Row) -> Row | None:
        """The row of the other ball."""
        count, rows = len(self.scene.elements), self.setting.rows
        first = self._is_first(number)
        k = number + 1 if first else number - 1
        if 0 <= k < len(rows) and not (row.after == rows[k].after == (0.0, 0.0)):  # both are stopped
            mate = rows[k]
            wanted = (BOUNCE, row.time, row.element - count, count + row.ball)
            if (mate.kind, mate.time, mate.ball, mate.element) == wanted and self._is_first(k) != first:
                return mate
        return None

    def _is_first(self, number: int) -> bool:
        """Whether a row begins a pair of rows: the ball of the higher number has the first one."""
        row = self.setting.rows[number]
        return row.ball > row.element - len(self.scene.elements)

    def _touches_ball(self, index: int, row: Row, place: Vector) -> None:
        dx, dy, reach = row.x - place[0], row.y - place[1], 2.0 * self.scene.ball.radius
        distance = math.hypot(dx, dy)
        if abs(distance - reach) > TOLERANCE * self.size:
            self.say(index, f"the balls are {distance - reach:.3g} m away from each other")
        blur = EXACT + 32.0 * ULP * self.extent / reach
        if not distance or apart((dx / distance, dy / distance), (row.nx, row.ny)) > blur:
            self.say(index, f"the normal is along {(dx, dy)}, not {(row.nx, row.ny)}")

    def _exchanges(self, number: int, row: Row, other: PairChecks) -> Iterator[Vector]:
        """The velocities that the hit may leave, in the order of how usual they are."""
        nx, ny = row.nx, row.ny
        b, closing = self.scene.ball.b**2, -((row.vx0 - row.ux) * nx + (row.vy0 - row.uy) * ny)
        if self._is_first(number):  # both go on otherwise after it
            along = (row.vx0 - row.ux) * ny - (row.vy0 - row.uy) * nx
            turn = along**2 / (2.0 * self.scene.ball.radius)  # what it takes to keep to the other ball
            pulls = [(mine, theirs) for mine in self._pulls() for theirs in other._pulls()]
            self.pressed = {self._presses(mine, theirs, nx, ny, turn) for mine, theirs in pulls}
            other.pressed = self.pressed
        pressed = self.pressed
        gains = []
        if False in pressed and closing > 0.0:
            gains += [closing + b * closing, closing]  # what is left of faster hits has no rebound
        if True in pressed:
            gains += [closing + max(b * closing if closing > 0.0 else 0.0, self._least())]
        share = 1.0 if other.is_crushed else (0.0 if self.is_crushed else 0.5)
        for gain in gains:
            mine = (row.vx0 + share * gain * nx, row.vy0 + share * gain * ny)
            theirs = (row.ux - (1.0 - share) * gain * nx, row.uy - (1.0 - share) * gain * ny)
            yield capped(mine, (nx, ny), theirs, self.rules.max_speed)

    def _least(self) -> float:
        """With what speed [m/s] two balls that are pressed together leave each other at least."""
        pull = math.hypot(*self.walk.acceleration)
        return max(self.rules.rest_speed, LEAST * math.sqrt(pull * 2.0 * self.scene.ball.radius))

    def _pulls(self) -> list[Vector]:
        """The accelerations that the ball may be under."""
        a = self.walk.acceleration
        return [self.walk.borne_by(way.mode, way.bearer, *a) for way in self.ways]

    @staticmethod
    def _presses(mine: Vector, theirs: Vector, nx: float, ny: float, turn: float) -> bool:
        return (mine[0] - theirs[0]) * nx + (mine[1] - theirs[1]) * ny + turn < 0.0

    def _go_on(self, row: Row) -> None:
        """A small hop pushes the ball into nothing that it touches, and has no row that says so."""
        if self.is_crushed:
            return
        self.goes_on(row)
        v = row.after
        for bearing in self.touching(State(row.time, row.x, row.y, *row.after)):
            closing = closing_on(bearing, v)
            if closing > 0.0:
                v = (v[0] + closing * bearing.nx, v[1] + closing * bearing.ny)
        if v != row.after:
            ways, must_end = self.ways, self.must_end
            self.goes_on(row._replace(vx1=v[0], vy1=v[1]))
            self.ways, self.must_end = [*ways, *self.ways], must_end and self.must_end

    # ---- balls between others

    def _is_stopped(self, index: int, row: Row) -> None:
        """Balls that hit each other ever more at one instant are stopped, and stand for a while."""
        if row.after != (0.0, 0.0):
            self.say(index, "a hit of two balls has two rows")
        hits = self.setting.meetings(self.numbers[index])
        if not hits.are_too_many:
            self.say(index, f"{hits.at_once} hits of balls at one instant, {hits.of_two} of two: too few to stop one")
        pull = math.hypot(*self.walk.acceleration)
        until = row.time + (math.sqrt(2.0 * CLEARANCE * self.extent / pull) if pull else math.inf)
        self.jammed = row.time
        state = State(row.time, row.x, row.y, 0.0, 0.0)
        self.ways = [Way(state, Mode.STANDS, None, math.inf, until)]

    # ---- balls that are crushed

    def crushed(self, index: int, row: Row) -> None:
        """A part closes on the ball, and something else leaves it no room."""
        self.remember(row)
        own = self.stands_on(index, row)
        if row.after != (0.0, 0.0):
            self.say(index, f"a crushed ball stands, and does not move at {row.after}")
        last = next(self.at_instant(index), None)
        struck = last is not None and (last.kind, last.element) == (BOUNCE, row.element)
        state = self.walk.state
        if not struck and not self.is_over(index, self.touching(state), state[3:]):
            self.say(index, f"elements[{row.element}] crushes the ball without having struck it")
        if own is not None and not self._has_no_room(index, row):
            self.say(index, f"nothing holds the ball against elements[{row.element}]")
        self.is_crushed, self.crushed_at, self.must_end = True, self.numbers[index], False
        state = State(row.time, row.x, row.y, 0.0, 0.0)
        bearer = None if own is None else Bearer(row.element, row.nx, row.ny, 0.0, 0.0)
        self.ways = [Way(state, Mode.STANDS if bearer is None else Mode.RESTS, bearer)]

    def _has_no_room(self, index: int, row: Row) -> bool:
        room = 2.0 * CLEARANCE * self.extent
        state = State(row.time, row.x, row.y, row.ux, row.uy)
        near = self.touches.all_at(
            self.setting.shapes, state, self.walk.enabled, self.walk.acceleration, {row.element: (row.nx, row.ny)}, room
        )
        # At this instant it stops: the row tells how fast it came.
        near = [b._replace(ux=row.ux, uy=row.uy) if b.element == row.element else b for b in near]
        if not gets_away(near, self.scene.max_speed or math.inf):
            return True
        normals = [
            (r.nx, r.ny)
            for r in self.rows[max(0, index - 64) : index]
            if r.kind == BOUNCE and apart((r.x, r.y), (row.x, row.y)) <= room
        ]
        return any(nx * row.nx + ny * row.ny < -OPPOSED for nx, ny in normals)

    def set_free(self, time: float) -> None:
        """Once a command has opened the gap the ball goes on."""
        freed = self.setting.drive.freed.get(self.ball, [])
        if self.is_crushed and any(t <= time and number > self.crushed_at for t, number in freed):
            self.is_crushed = False
