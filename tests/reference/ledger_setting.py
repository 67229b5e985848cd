"""What all balls of a run have in common: the scene and its scales, the motion of its parts, commands and rules.

Of the ledger checker: plain Python and numpy, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from bounce_env.scene import Arc, Scene
from tests.reference.ledger_drive import Command, Drive, is_command
from tests.reference.ledger_law import HOP_ULPS, Rules
from tests.reference.ledger_row import BOUNCE, Row
from tests.reference.ledger_sensors import Switches
from tests.reference.ledger_shapes import Shapes
from tests.reference.ledger_touch import Ledger

TOLERANCE = 1e-9  # of lengths relative to the scene's size, of speeds relative to those that enter
EXACT = 1e-12  # what one formula may lose
STANDING = 1e-290  # [m/s] slower than this is not at all

CLEARANCE = 2.0**-14  # of the extent: a crushed ball has no more room than this
MEETINGS = 4 * 256  # hits of any balls at one instant after which those that go on are stopped
MEETINGS_OF_TWO = 4 * 1024  # the same for two balls in all


class Meetings(NamedTuple):
    """Hits of balls up to a row: of any at one instant, or at instants between which none moves by more than a touch;
    and of the two of the row, at any time.
    """

    at_once: int
    of_two: int

    @property
    def are_too_many(self) -> bool:
        """Whether a ball may be stopped for them."""
        return self.at_once >= MEETINGS or self.of_two >= MEETINGS_OF_TWO


class Setting:
    def __init__(self, scene: Scene, ledger: Ledger, end: float, commands: Sequence[Command]) -> None:
        self.scene, self.commands = scene, commands
        self.rows = [Row(*values) for values in ledger.tolist()]
        x0, y0, x1, y1 = scene.bounds
        # An arc's places are known from its centre, however far that is from what it occupies.
        far = [max(map(abs, e.center)) + e.radius for e in scene.elements if isinstance(e, Arc)]
        largest = max(abs(x0), abs(y0), abs(x1), abs(y1), *far) + scene.ball.radius
        self.size = max(x1 - x0, y1 - y0) or 1.0
        self.extent = math.ldexp(1.0, math.frexp(largest)[1])
        names = {element.name: index for index, element in enumerate(scene.elements) if element.name}
        self.switches: Switches = {}
        for time, name, value in commands:
            if isinstance(value, bool) and not is_command(scene, name, value):
                self.switches.setdefault(names[name], []).append((time, value))
        self.commanded = {command[0] for command in commands}
        self.drive = Drive(scene, self.rows, commands, end, self.extent, self.size)
        self.runs = self.drive.runs
        self.shapes = Shapes(scene, self.runs)
        max_speed = math.inf if scene.max_speed is None else scene.max_speed
        self.rules = Rules(scene.rest_speed, max_speed, HOP_ULPS * self.extent)
        self.kicked: dict[int, float] = {}  # when each element gave its last kick, to any ball

    def meetings(self, number: int) -> Meetings:
        """Those that lead up to the row of this number."""
        elements, last = len(self.scene.elements), self.rows[number]
        met = [row for row in self.rows[:number] if row.kind == BOUNCE and row.element >= elements]
        two = (last.ball, last.element - elements)
        return Meetings(self._at_once(met), sum((row.ball, row.element - elements) == two for row in met))

    def _at_once(self, met: Sequence[Row]) -> int:
        last, count, speed = -math.inf, 0, 0.0
        for row in met:
            if not self._way(speed, row.time - last) <= HOP_ULPS * self.extent:
                count, speed = 0, 0.0
            last = row.time
            count += row.ball > row.element - len(self.scene.elements)
            speed = max(speed, sum(map(abs, (*row.before, row.ux, row.uy))))
        return count

    def _way(self, speed: float, t: float) -> float:
        return (speed + math.hypot(*self.scene.gravity) * t) * t
