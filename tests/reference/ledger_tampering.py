"""All that is done to a ledger to see whether the checker notices it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Scene
from tests.conftest import SOAK

Rows = npt.NDArray[Any]


def changes(scene: Scene, ledger: Rows, balls: int = 1) -> Iterator[tuple[str, Rows]]:
    """What is changed, in words, and the ledger that it leaves.

    A float is moved by a millionth of itself; where it is nearly zero, by a millionth of what its size goes by (the
    scene, the ball's speed, 1 for a direction), since a millionth of nearly nothing is round-off. Each is moved one
    way in turn, in a soak both ways; likewise element numbers become a neighbour's, in a soak all others.
    """
    x0, y0, x1, y1 = scene.bounds
    size = max(x1 - x0, y1 - y0)
    turn = itertools.cycle((1.0, -1.0))
    count = len(scene.elements) + (balls if balls > 1 else 0)
    for k, row in enumerate(ledger):
        speed = max(math.hypot(row["vx0"], row["vy0"]), math.hypot(row["vx1"], row["vy1"]))
        scales = {"time": row["time"], "x": size, "y": size, "nx": 1.0, "ny": 1.0}
        scales |= dict.fromkeys(("vx0", "vy0", "vx1", "vy1", "ux", "uy"), speed or 1.0)
        for name, scale in scales.items():
            step = 1e-6 * (abs(row[name]) if abs(row[name]) >= 0.01 * scale else scale)
            for sign in (1.0, -1.0) if SOAK else (next(turn),):
                yield f"row {k}: {name} {sign * step:+.3g}", changed(ledger, k, name, row[name] + sign * step)
        others = range(-1, count + 1) if SOAK else {row["element"] + 1, row["element"] - 1}
        for name, values in (("element", others), ("kind", (*range(6), 7)), ("ball", range(-1, max(balls, 2)))):
            for value in values:
                if value != row[name]:
                    yield f"row {k}: {name} {value}", changed(ledger, k, name, value)
        yield f"row {k} removed", np.delete(ledger, k)
        yield f"row {k} twice", np.insert(ledger, k, row)


def pair_changes(scene: Scene, ledger: Rows) -> Iterator[tuple[str, Rows]]:
    """Of two rows that belong together (a hit of two balls, the stops of a wall's two ends): both gone, or swapped."""
    for k, (row, other) in enumerate(itertools.pairwise(ledger)):
        hit = row["element"] == len(scene.elements) + other["ball"] and row["time"] == other["time"]
        stop = row["kind"] == other["kind"] == 4 and (row["element"], row["time"]) == (other["element"], other["time"])
        if hit or stop:
            swapped = ledger.copy()
            swapped[k], swapped[k + 1] = other, row
            yield f"rows {k} and {k + 1} swapped", swapped
            yield f"rows {k} and {k + 1} removed", np.delete(ledger, [k, k + 1])


def changed(ledger: Rows, k: int, name: str, value: float) -> Rows:
    copy = ledger.copy()
    copy[name][k] = value
    return copy
