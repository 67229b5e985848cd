"""What an agent may do: from what Gymnasium hands over to the numbers that a game's kernel reads."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, TypeAlias

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import function
from bounce_env.wording import shown

_FEW = 16  # numbers that are looked through faster in Python than by NumPy
_VERY_LARGE = 2**64

Controls: TypeAlias = npt.NDArray[np.float64]
"""(worlds, k): what a game's kernel reads."""


@function
def clipped(action: float) -> float:
    """Return what a number of a `Continuous` action stands for: a share, -1 to 1."""
    return min(max(action, -1.0), 1.0)


@dataclass(frozen=True)
class Continuous:
    """`size` numbers from -1 to 1; what lies beyond is clipped by the game. See docs/own_game.md."""

    size: int

    @property
    def width(self) -> int:
        """How many numbers the kernel reads of each world."""
        return self.size

    def controls(self, actions: npt.NDArray[np.generic], worlds: int) -> Controls:
        """Return `actions` as the kernel reads them, (worlds, size) float64.

        Raises ValueError for another shape or type; whether they are finite the kernel asks.
        """
        if actions.shape != (worlds, self.size) and not self._is_short(actions.shape, worlds):
            each = "one" if self.size == 1 else str(self.size)
            what = f"{worlds * self.size} numbers, {each} per world"
            raise ValueError(f"actions of shape {actions.shape}: must be {what}")
        if actions.dtype.kind not in "fiu":
            raise ValueError(f"actions = {shown(actions)}: must be numbers")
        rows = actions.reshape(worlds, self.size)
        # A kernel is compiled for arrays of one kind: those that are in order and may be written.
        if rows.dtype == np.float64 and rows.flags.carray:
            return rows.view(np.float64)
        return rows.astype(np.float64, order="C")

    def _is_short(self, shape: tuple[int, ...], worlds: int) -> bool:
        """Return whether a shape leaves out an axis of length 1."""
        lone = self.size == 1 and (shape == (worlds,) or (worlds == 1 and shape == ()))
        return lone or (worlds == 1 and shape == (self.size,))


@dataclass(frozen=True)
class Discrete:
    """One whole number; `codes[number]` is what the kernel reads. See docs/own_game.md."""

    codes: tuple[float, ...]

    width: ClassVar[int] = 1

    def controls(self, actions: npt.NDArray[np.generic], worlds: int) -> Controls:
        """Return `actions` as the kernel reads them, (worlds, 1) float64.

        Raises ValueError for another shape or type, and for a number that means nothing.
        """
        what = f"whole numbers from 0 to {len(self.codes) - 1}"
        if actions.shape != (worlds,) and not (worlds == 1 and actions.shape == ()):
            raise ValueError(f"actions of shape {actions.shape}: must be {worlds} {what}, one per world")
        if actions.dtype.kind not in "iu":
            raise ValueError(f"actions = {shown(actions)}: must be {what}")
        numbers = actions.reshape(worlds)
        if _largest(numbers) >= len(self.codes):
            raise ValueError(f"actions = {shown(actions)}: each must be a whole number from 0 to {len(self.codes) - 1}")
        return self._table[numbers]

    @cached_property
    def _table(self) -> Controls:
        return np.array(self.codes)[:, None]


@dataclass(frozen=True)
class Buttons:
    """`count` buttons, pressed (1) or not (0); the kernel reads one number, of which each button is a bit.

    See docs/own_game.md.
    """

    count: int

    width: ClassVar[int] = 1

    def controls(self, actions: npt.NDArray[np.generic], worlds: int) -> Controls:
        """Return `actions` as the kernel reads them, (worlds, 1) float64.

        Raises ValueError for another shape or type, and for what is neither 0 nor 1.
        """
        if actions.shape != (worlds, self.count) and not (worlds == 1 and actions.shape == (self.count,)):
            raise ValueError(
                f"actions of shape {actions.shape}: must be ({worlds}, {self.count}), 0 or 1 for each button"
            )
        if actions.dtype.kind not in "iub" or _largest(actions) > 1:
            raise ValueError(f"actions = {shown(actions)}: each must be 0 or 1")
        rows = actions.reshape(worlds, self.count)
        bits: Controls = rows.dot(self._weights)
        return bits

    @cached_property
    def _weights(self) -> Controls:
        return np.exp2(np.arange(self.count, dtype=np.float64))[:, None]


def _largest(numbers: npt.NDArray[np.generic]) -> int:
    """Return the largest of whole numbers; one below zero counts as a very large one."""
    if numbers.size < _FEW:
        values: list[int] = numbers.ravel().tolist()
        return _VERY_LARGE if min(values) < 0 else max(values)
    # Read as unsigned ones, those below zero are the largest that there are.
    return int(numbers.view(f"{numbers.dtype.byteorder}u{numbers.dtype.itemsize}").max())


Actions: TypeAlias = Continuous | Discrete | Buttons
