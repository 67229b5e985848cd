"""The `options` of a reset: where the ball is launched, and on which level, in place of what the seed says."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.overlap import cleared, cores_at_start
from bounce_env.games.game import Game
from bounce_env.games.levels import END_OF_LEVELS

PAIRS = ("position", "velocity")
LEVEL = "level"


def start_rows(game: Game, worlds: int, options: Mapping[str, Any] | None) -> npt.NDArray[np.float64]:
    """Beginnings (worlds, 5): x, y [m], vx, vy [m/s] of the launch and the level, NaN where the seed decides.

    Each option is one pair, or level, for all worlds or one for each. Raises ValueError for an unknown option, another
    shape, what is not finite, no level, a place without the level it is on, a speed above the scene's `max_speed`, and
    a ball that overlaps an element or is off the field.
    """
    rows = np.full((worlds, 5), np.nan)
    given = dict(options or {})
    if game.has_levels and LEVEL in given:
        rows[:, 4] = _levels(given.pop(LEVEL), worlds)
    for name, value in given.items():
        if name not in PAIRS:
            raise ValueError(f"options[{name!r}]: must be one of {', '.join((*PAIRS, LEVEL)[: 2 + game.has_levels])}")
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
        first = 2 * PAIRS.index(name)
        rows[:, first : first + 2] = pairs
    for row in rows if given else ():
        _check(game, row)
    return rows


def _levels(value: Any, worlds: int) -> npt.NDArray[np.int64]:
    levels = np.asarray(value)
    if levels.dtype.kind not in "iu" or levels.shape not in ((), (worlds,)):
        raise ValueError(f"options['level'] = {value!r}: must be a whole number, or one for each of {worlds} worlds")
    if (levels < 0).any() or (levels >= END_OF_LEVELS).any():
        raise ValueError(f"options['level'] = {value!r}: must be 0 to {END_OF_LEVELS - 1}")
    return levels.astype(np.int64)


def _check(game: Game, row: npt.NDArray[np.float64]) -> None:
    x, y, vx, vy, level = row.tolist()
    if game.has_levels and math.isnan(level) and not math.isnan(x):
        raise ValueError("options['position']: options['level'] must be given, too; levels have different bumpers")
    scene = game.scene_on(None if math.isnan(level) else int(level))
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
