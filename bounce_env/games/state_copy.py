"""Copies of all that worlds are, to go on from: what a player needs that looks ahead."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bounce_env.engine.memory.records import Array
from bounce_env.games.episode import EPISODE, RUNNING
from bounce_env.wording import shown


@dataclass(frozen=True, eq=False)
class States:
    """The states of some worlds, one row each; `states[rows]` selects and repeats rows as NumPy does.

    A batch of the same game, scene and options goes on from them to the same bits.
    """

    game: str
    arrays: tuple[Array, ...]

    def __len__(self) -> int:
        return len(self.arrays[0])

    def __getitem__(self, rows: slice | npt.NDArray[np.generic]) -> "States":
        return States(self.game, tuple(array[rows] for array in self.arrays))

    def any_ended(self) -> bool:
        """Return whether the episode of any of the worlds has ended."""
        return any((array["end"] != RUNNING).any() for array in self.arrays if array.dtype == EPISODE)

    @classmethod
    def joined(cls, states: Sequence["States"]) -> "States":
        """Return the rows of several states, one after the other; ValueError where they are of several games."""
        if not all(isinstance(one, cls) and one.game == states[0].game for one in states):
            raise ValueError(f"states = {shown(states)}: must be what clone_state() returned, all of one game")
        return cls(states[0].game, tuple(map(np.concatenate, zip(*(one.arrays for one in states), strict=True))))


def clone_rows(game: str, arrays: tuple[Array, ...], mask: npt.NDArray[np.bool_]) -> States:
    """Return the rows of `mask` of every array, copied."""
    return States(game, tuple(array[mask] for array in arrays))


def check_rows(game: str, arrays: tuple[Array, ...], mask: npt.NDArray[np.bool_], states: object) -> None:
    """Raise ValueError where states do not fit into the rows of `mask`."""
    if not isinstance(states, States):
        raise ValueError(f"state = {shown(states)}: must be what clone_state() returned")
    if states.game != game:
        raise ValueError("state of another game, scene or options: must be restored into an equal environment")
    if len(states) != mask.sum():
        raise ValueError(f"state of {len(states)} worlds: must be of {mask.sum()}")
    if [(a.dtype, a.shape[1:]) for a in arrays] != [(rows.dtype, rows.shape[1:]) for rows in states.arrays]:
        raise ValueError("state: has other arrays than clone_state() returned")


def restore_rows(arrays: tuple[Array, ...], mask: npt.NDArray[np.bool_], states: States) -> None:
    """Write states that fit into the rows of `mask`."""
    for array, rows in zip(arrays, states.arrays, strict=True):
        array[mask] = rows
