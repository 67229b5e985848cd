"""What a ledger's row holds, and of which kinds there are.

Of the ledger checker: plain Python, no code of the engine.
"""

from __future__ import annotations

import math
from typing import NamedTuple

BOUNCE, CONTACT_BEGINS, CONTACT_ENDS, CROSSING, PART_STOPS, CRUSH = range(6)
CORNER_BOUNCE = 7


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


def apart(a: tuple[float, float], b: tuple[float, float]) -> float:
    return math.hypot(a[0] - b[0], a[1] - b[1])
