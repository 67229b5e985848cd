"""What the vector environments say in `info`: arrays with masks, as Gymnasium's own do."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from bounce_env.games.batch import Batch
from bounce_env.wording import nearest, shown

Flags = npt.NDArray[np.bool_]
Told = Literal["none", "ends", "all"]

HOW_MUCH: tuple[Told, ...] = ("none", "ends", "all")
"""What the keyword `info` may be: nothing; all that is said at an episode's end; and some of it at each step."""


def checked_info(info: Any) -> Told:
    """Return the keyword `info` as it is; raises ValueError for one that there is not."""
    if not isinstance(info, str) or info not in HOW_MUCH:
        raise ValueError(f"info = {shown(info)}: must be one of {list(HOW_MUCH)}{nearest(info, HOW_MUCH)}")
    return info


def info_of_worlds(batch: Batch, mask: Flags | None = None) -> dict[str, Any]:
    """Return score, ball and level of the worlds of `mask`, 0 of the others; None: of all."""
    told = {"score": batch.episodes["score"], "ball": batch.episodes["ball"]}
    if batch.game.has_levels:
        told["level"] = batch.episodes["level"]
    info: dict[str, Any] = {}
    for key, values in told.items():
        info[key] = values.copy() if mask is None else np.where(mask, values, 0)
        info[f"_{key}"] = np.ones(batch.worlds, np.bool_) if mask is None else mask.copy()
    return info


def info_of_ends(batch: Batch, ended: Flags) -> dict[str, Any]:
    """Return what is said of the episodes that ended in the last step, where these are `ended`."""
    return masked(batch.end_info(np.flatnonzero(ended)), ended)


def final_info(batch: Batch, ended: Flags, finals: npt.NDArray[Any], told: Told) -> dict[str, Any]:
    """Return what is said of episodes that have been followed by others in the same step.

    finals: their last observations, which are told in any case: without them nobody can train.
    """
    info: dict[str, Any] = {"final_obs": finals, "_final_obs": ended.copy()}
    if told == "none":
        return info
    last = {key: batch.results.ended[key].copy() for key in ("score", "ball", "level")[: 2 + batch.game.has_levels]}
    info["final_info"] = masked({**batch.end_info(np.flatnonzero(ended)), **last}, ended)
    info["_final_info"] = ended.copy()
    return info


def masked(told: Mapping[str, Any], mask: Flags) -> dict[str, Any]:
    """Return what is told with the mask of the worlds that it is told of, each array by itself."""
    info: dict[str, Any] = {}
    for key, values in told.items():
        info[key], info[f"_{key}"] = values, mask.copy()
    return info
