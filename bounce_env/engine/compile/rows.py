"""Copy rows of many arrays in one call: the state of a world is a row in each of some thirty."""

import ctypes
from collections.abc import Sequence
from typing import Any

import numba
import numpy as np
import numpy.typing as npt
from llvmlite import ir
from numba.core import cgutils
from numba.core import types as nb_types
from numba.extending import intrinsic

from bounce_env.engine.compile.jit import kernel

Array = npt.NDArray[Any]
Bytes = npt.NDArray[np.uint8]


class Rows:
    """Rows of arrays of one length, as bytes.

    width: bytes of one row of all of them. Raises ValueError for an array that does not lie in order in memory. They
    are held, and must stay where they are.
    """

    def __init__(self, arrays: Sequence[Array]) -> None:
        for array in arrays:
            if not array.flags.c_contiguous:
                raise ValueError(f"an array of shape {array.shape} does not lie in order in memory")
        self._held = tuple(arrays)
        self._places = np.array([(array.ctypes.data, array.nbytes // len(array)) for array in arrays], np.int64)
        self.width = int(self._places[:, 1].sum())

    def copied(self, rows: npt.NDArray[np.intp]) -> Bytes:
        """Return copies of some rows (n,), as (n, width) bytes."""
        copies = np.empty((len(rows), self.width), np.uint8)
        _copy(self._places, rows, copies, False)
        return copies

    def write(self, rows: npt.NDArray[np.intp], copies: Bytes) -> None:
        """Write copies (n, width), C-contiguous, into some rows (n,)."""
        _copy(self._places, rows, copies, True)


@intrinsic  # type: ignore[untyped-decorator]
def _copy_bytes(typing: Any, to: Any, come_from: Any, count: Any) -> Any:
    """Copy bytes from one address to another one."""

    def write(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        target, source, size = arguments
        pointer = ir.IntType(8).as_pointer()
        cgutils.raw_memcpy(builder, builder.inttoptr(target, pointer), builder.inttoptr(source, pointer), size, 1)
        return context.get_dummy_value()

    return nb_types.void(nb_types.intp, nb_types.intp, nb_types.intp), write


@kernel
def _copy_compiled(places: Array, rows: Array, copies: Array, back: bool) -> None:
    """Copy rows of the arrays at `places` (address, bytes of a row) to `copies`, one array after the other; or back."""
    for i in range(rows.shape[0]):
        at = copies.ctypes.data + i * copies.shape[1]
        for j in range(places.shape[0]):
            size = places[j, 1]
            place = places[j, 0] + rows[i] * size
            if back:
                _copy_bytes(place, at, size)
            else:
                _copy_bytes(at, place, size)
            at += size


def _copy_interpreted(places: Array, rows: Array, copies: Array, back: bool) -> None:
    for row, at in zip(rows.tolist(), range(copies.ctypes.data, 2**63, max(copies.shape[1], 1)), strict=False):
        for address, size in places.tolist():
            place = address + row * size
            ctypes.memmove(place if back else at, at if back else place, size)
            at += size  # noqa: PLW2901


_copy = _copy_interpreted if numba.config.DISABLE_JIT else _copy_compiled
