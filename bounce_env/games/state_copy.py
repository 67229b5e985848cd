"""Copies of all that worlds are, to go on from: what a player needs that looks ahead."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.rows import Rows
from bounce_env.wording import shown


@dataclass(frozen=True, eq=False)
class States:
    """The states of some worlds, one row each; `states[rows]` selects and repeats rows as NumPy does.

    A batch of the same game, scene and options goes on from them to the same bits. data: (n, bytes of a state) uint8;
    ended: (n,) bool, whether the episode of a state has ended.
    """

    game: str
    data: npt.NDArray[np.uint8]
    ended: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.data)

    def __getitem__(self, rows: slice | npt.NDArray[np.generic]) -> "States":
        return States(self.game, self.data[rows], self.ended[rows])

    @classmethod
    def joined(cls, states: Sequence["States"]) -> "States":
        """Return the rows of several states, one after the other; ValueError where they are of several games."""
        if not all(isinstance(one, cls) and one.game == states[0].game for one in states):
            raise ValueError(f"states = {shown(states)}: must be what clone_state() returned, all of one game")
        data, ended = np.concatenate([one.data for one in states]), np.concatenate([one.ended for one in states])
        return cls(states[0].game, data, ended)


def check_states_fit(game: str, rows: Rows, count: int, states: object) -> None:
    """Raise ValueError where states are not of this game, of as many bytes, or of another number of worlds."""
    if not isinstance(states, States):
        raise ValueError(f"state = {shown(states)}: must be what clone_state() returned")
    if states.game != game:
        raise ValueError("state of another game, scene or options: must be restored into an equal environment")
    if len(states) != count:
        raise ValueError(f"state of {len(states)} worlds: must be of {count}")
    data, ended = states.data, states.ended
    if data.dtype != np.uint8 or data.shape != (count, rows.width) or ended.shape != (count,):
        raise ValueError("state: has other arrays than clone_state() returned")
