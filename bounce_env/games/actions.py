"""What an agent may do: from what Gymnasium hands over to the numbers that a game's kernel reads."""

from dataclasses import dataclass
from typing import ClassVar, TypeAlias

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import function
from bounce_env.wording import shown

Controls: TypeAlias = npt.NDArray[np.float64]
"""(worlds, k): what a game's kernel reads."""


@function
def clipped(action: float) -> float:
    """Return what a number of a `Continuous` action stands for: a share, -1 to 1."""
    return min(max(action, -1.0), 1.0)


@dataclass(frozen=True)
class Continuous:
    """`size` numbers from -1 to 1; what lies beyond is clipped by the game."""

    size: int

    @property
    def width(self) -> int:
        """How many numbers the kernel reads of each world."""
        return self.size

    def controls(self, actions: npt.NDArray[np.generic], worlds: int) -> Controls:
        """Raises ValueError for another shape or type; whether they are finite the kernel asks."""
        lone = self.size == 1 and (actions.shape == (worlds,) or (worlds == 1 and actions.shape == ()))
        if not (lone or actions.shape == (worlds, self.size) or (worlds == 1 and actions.shape == (self.size,))):
            each = "one" if self.size == 1 else str(self.size)
            what = f"{worlds * self.size} numbers, {each} per world"
            raise ValueError(f"actions of shape {actions.shape}: must be {what}")
        if actions.dtype.kind not in "fiu":
            raise ValueError(f"actions = {shown(actions)}: must be numbers")
        rows = actions.reshape(worlds, self.size)
        # A kernel is compiled for arrays of one kind: those that are in order and may be written.
        if rows.dtype == np.float64 and rows.flags.carray:
            return rows.view(np.float64)
        return np.array(rows, np.float64, order="C")


@dataclass(frozen=True)
class Discrete:
    """One whole number; `codes[number]` is what the kernel reads."""

    codes: tuple[float, ...]

    width: ClassVar[int] = 1

    def controls(self, actions: npt.NDArray[np.generic], worlds: int) -> Controls:
        """Raises ValueError for another shape or type, and for a number that means nothing."""
        what = f"whole numbers from 0 to {len(self.codes) - 1}"
        if actions.shape != (worlds,) and not (worlds == 1 and actions.shape == ()):
            raise ValueError(f"actions of shape {actions.shape}: must be {worlds} {what}, one per world")
        if actions.dtype.kind not in "iu":
            raise ValueError(f"actions = {shown(actions)}: must be {what}")
        numbers = actions.reshape(worlds).astype(np.int64)
        if (numbers < 0).any() or (numbers >= len(self.codes)).any():
            raise ValueError(f"actions = {shown(actions)}: each must be a whole number from 0 to {len(self.codes) - 1}")
        return np.array(self.codes)[numbers][:, None]


@dataclass(frozen=True)
class Buttons:
    """`count` buttons, pressed (1) or not (0); the kernel reads one number, of which each button is a bit."""

    count: int

    width: ClassVar[int] = 1

    def controls(self, actions: npt.NDArray[np.generic], worlds: int) -> Controls:
        """Raises ValueError for another shape or type, and for what is neither 0 nor 1."""
        if actions.shape != (worlds, self.count) and not (worlds == 1 and actions.shape == (self.count,)):
            raise ValueError(
                f"actions of shape {actions.shape}: must be ({worlds}, {self.count}), 0 or 1 for each button"
            )
        if actions.dtype.kind not in "iub" or not np.isin(actions, (0, 1)).all():
            raise ValueError(f"actions = {shown(actions)}: each must be 0 or 1")
        bits = actions.reshape(worlds, self.count).astype(np.float64) * 2.0 ** np.arange(self.count)
        return bits.sum(axis=1, keepdims=True)


Actions: TypeAlias = Continuous | Discrete | Buttons
