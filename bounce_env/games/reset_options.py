"""The `options` of a reset: where the ball is launched, and on which level, in place of what the seed says."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.placement import part_cores_at_start, place_clear
from bounce_env.games.game import Game
from bounce_env.games.options import END_OF_LEVELS
from bounce_env.wording import at_least, at_most, nearest, numbers, shown

PAIRS = ("position", "velocity")

SLACK = 1e-12
"""As a share of the field: a place on its border, as messages print it, is on the field."""

LEVEL = "level"


def start_rows(game: Game, worlds: int, options: Mapping[str, Any] | None) -> npt.NDArray[np.float64]:
    """Beginnings (worlds, 5): x, y [m], vx, vy [m/s] of the launch and the level, NaN where the seed decides.

    Each option is one pair, or level, for all worlds or one for each. Raises ValueError for an unknown option, another
    shape, what is not finite, no level, a place without the level it is on, a speed above the scene's `max_speed`, and
    a ball that overlaps an element or is off the field.
    """
    rows = np.full((worlds, 5), np.nan)
    given = checked_options(options)
    if game.has_levels and LEVEL in given:
        rows[:, 4] = _levels(given.pop(LEVEL), worlds)
    for name, value in given.items():
        if name not in PAIRS:
            known = (*PAIRS, LEVEL)[: 2 + game.has_levels]
            raise ValueError(f"options[{shown(name)}]{nearest(name, known)}: must be one of {', '.join(known)}")
        pairs = numbers(value)
        if pairs is None or pairs.shape not in ((2,), (worlds, 2)):
            raise ValueError(
                f"options[{name!r}] = {shown(value)}: must be a pair of numbers, or one for each of {worlds} worlds"
            )
        if not np.isfinite(pairs).all():
            raise ValueError(f"options[{name!r}] = {shown(value)}: must be finite")
        first = 2 * PAIRS.index(name)
        rows[:, first : first + 2] = pairs
    for row in rows if given else ():
        _check(game, row, given)
    return rows


def checked_options(options: Any) -> dict[str, Any]:
    """The options of a reset, as a dict of their own. Raises ValueError for what is neither None nor a mapping."""
    if options is not None and not isinstance(options, Mapping):
        raise ValueError(f"options = {shown(options)}: must be None or a dict")
    return dict(options or {})


def _levels(value: Any, worlds: int) -> npt.NDArray[np.int64]:
    levels = numbers(value)
    if levels is None or levels.shape not in ((), (worlds,)) or np.asarray(value).dtype.kind == "f":
        raise ValueError(
            f"options['level'] = {shown(value)}: must be a whole number, or one for each of {worlds} worlds"
        )
    if (levels < 0).any() or (levels >= END_OF_LEVELS).any():
        raise ValueError(f"options['level'] = {shown(value)}: must be 0 to {END_OF_LEVELS - 1}")
    return levels.astype(np.int64)


def _check(game: Game, row: npt.NDArray[np.float64], given: Mapping[str, Any]) -> None:
    x, y, vx, vy, level = row.tolist()
    if game.has_levels and math.isnan(level) and not math.isnan(x):
        raise ValueError("options['position']: options['level'] must be given, too; levels have different bumpers")
    scene = game.scene_on(None if math.isnan(level) else int(level))
    left, below, right, above = game.field
    below += scene.ball.radius  # a centre that starts on the drain never crosses it
    if not math.isnan(x):
        slack = SLACK * max(right - left, above - below)
        if not (left - slack <= x <= right + slack and below - slack <= y <= above + slack):
            raise ValueError(
                f"options['position'] = {_given(given, 'position', (x, y))}: must be on the field, "
                f"x {at_least(left, 6, slack)} to {at_most(right, 6, slack)} "
                f"and y {at_least(below, 6, slack)} to {at_most(above, 6, slack)}"
            )
        row[:2] = place_clear(scene, part_cores_at_start(scene), x, y)
    if scene.max_speed is not None and math.hypot(vx, vy) > scene.max_speed:
        speed = _given(given, "velocity", (vx, vy))
        raise ValueError(f"options['velocity'] = {speed}: must be at most {scene.max_speed} m/s")


def _given(given: Mapping[str, Any], name: str, row: tuple[float, float]) -> str:
    """Return a world's pair as the caller gave it; of several pairs the world's own."""
    return shown(given[name] if np.shape(given[name]) == (2,) else row)
