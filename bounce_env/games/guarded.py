"""Arrays that a game's functions write to: compiled code does not ask whether an index is there, so a guard does."""

from typing import Any

import numpy as np
import numpy.typing as npt

_ROOM = 64
"""Numbers behind the array that belong to it: what a game writes too far lands there, and not in what is another's."""

_UNTOUCHED = 0.7310547
"""A number that nobody writes, so small that whoever counts on from it changes it."""


def guarded(rows: int, columns: int, dtype: npt.DTypeLike) -> npt.NDArray[Any]:
    """Return zeros (rows, columns) with a guard behind the last row."""
    whole = np.zeros(rows * columns + _ROOM, dtype)
    whole[rows * columns :] = _UNTOUCHED
    return whole[: rows * columns].reshape(rows, columns)


def check_written(game: Any, observations: npt.NDArray[Any], counters: npt.NDArray[Any]) -> None:
    """Raise IndexError where the functions of a game have written beyond what its class says that there is."""
    name = type(game).__name__
    if _is_overrun(observations):
        count = len(game.observed)
        raise IndexError(f"{name}: observe writes beyond the {count} numbers of `observed`, which must list each")
    if _is_overrun(counters):
        count = len(game.counters)
        raise IndexError(f"{name}: play writes beyond the {count} names of `counters`, which must have each")


def _is_overrun(array: npt.NDArray[Any]) -> bool:
    """Return whether something was written behind a `guarded` array; of a copy, which has no guard, False."""
    whole = array.base
    if whole is None or whole.size != array.size + _ROOM:
        return False
    return bool((whole[array.size :] != whole.dtype.type(_UNTOUCHED)).any())
