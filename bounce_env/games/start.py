"""The `options` of a reset: where the ball is launched in place of what the seed says."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.overlap import cleared, cores_at_start
from bounce_env.games.game import Game

ALLOWED = ("position", "velocity")


def start_rows(game: Game, worlds: int, options: Mapping[str, Any] | None) -> npt.NDArray[np.float64]:
    """Launches (worlds, 4): x, y [m], vx, vy [m/s], NaN where the seed decides.

    Each option is one pair for all worlds or one row for each. Raises ValueError for an unknown option, another shape,
    what is not finite, a speed above the scene's `max_speed`, and a ball that overlaps an element or is off the field.
    """
    rows = np.full((worlds, 4), np.nan)
    for name, value in (options or {}).items():
        if name not in ALLOWED:
            raise ValueError(f"options[{name!r}]: must be one of {', '.join(ALLOWED)}")
        try:
            pairs = np.asarray(value, np.float64)
        except (TypeError, ValueError):  # not numbers, or of no shape at all
            pairs = np.empty(0)
        if pairs.shape not in ((2,), (worlds, 2)):
            raise ValueError(
                f"options[{name!r}] = {value!r}: must be a pair of numbers, or one for each of {worlds} worlds"
            )
        if not np.isfinite(pairs).all():
            raise ValueError(f"options[{name!r}] = {value!r}: must be finite")
        first = 2 * ALLOWED.index(name)
        rows[:, first : first + 2] = pairs
    for row in rows if options else ():
        _check(game, row)
    return rows


def _check(game: Game, row: npt.NDArray[np.float64]) -> None:
    scene = game.scenes[0]
    x, y, vx, vy = row.tolist()
    left, below, right, above = game.field
    below += scene.ball.radius  # a centre that starts on the drain never crosses it
    if not math.isnan(x):
        if not (left <= x <= right and below <= y <= above):
            raise ValueError(
                f"options['position'] = ({x}, {y}): must be on the field, "
                f"x {left:g} to {right:g} and y {below:g} to {above:g}"
            )
        row[:2] = cleared(scene, cores_at_start(scene), x, y)
    if scene.max_speed is not None and math.hypot(vx, vy) > scene.max_speed:
        raise ValueError(f"options['velocity'] = ({vx}, {vy}): must be at most {scene.max_speed} m/s")
