"""The one place that decides how the engine is compiled.

`function` is for everything that kernels call, `kernel` for the entry points called from Python. Both are plain
`numba.njit` with one policy:

* `error_model="numpy"`: a division by zero gives inf, it does not raise from inside a step;
* `fastmath` stays off: it would let the compiler change results from machine to machine;
* `nogil`, and never `parallel=True`: threads run kernels over slices of a batch (a forked child survives that).

Only entry points are cached on disk (`compile.cache`); what they call is compiled into them.
"""

import functools
from collections.abc import Callable
from typing import Any, TypeVar

import numba
import numpy as np
from numba.core import types as nb_types
from numba.extending import overload

from bounce_env.engine.compile.cache import KernelCache, NoCache
from bounce_env.engine.compile.pipeline import InnerCompiler, KernelCompiler

Record = Any  # one record of a table or of the state, see `engine.memory.records`; compiled code changes it in place
Table = Any  # an array, or None where no scene of the batch has what it holds
NumberOrNone = Any  # None where no scene of the batch has what it is needed for
F = TypeVar("F", bound=Callable[..., Any])
POLICY: dict[str, Any] = {"error_model": "numpy", "nogil": True}

# Without their wrappers for Python and C, which nobody calls, functions compile twice as fast. Nothing in them makes an
# array, and those that are bound have no owner: without reference counts they compile faster by another fifth.
INLINED = {
    **POLICY,
    "forceinline": True,
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "_nrt": False,
    "pipeline_class": InnerCompiler,
}


def function(python_function: F) -> F:
    """Compile `python_function`, which kernels call; Python calls it through `from_python`. See docs/own_game.md.

    It may read and write arrays, but neither make nor return them. What Numba cannot compile raises Numba's error when
    the first kernel is compiled that calls it.
    """
    compiled: F = numba.njit(**INLINED)(python_function)
    return compiled


def routine(python_function: F) -> F:
    """As `function`, for what is large, and called from several places: compiled once, and not into each of them."""
    compiled: F = numba.njit(**{**INLINED, "forceinline": False})(python_function)
    return compiled


def unfolded(python_function: F) -> F:
    """As `function`, for what returns records in a tuple: Numba can but write it out where it is called."""
    compiled: F = numba.njit(**POLICY, inline="always")(python_function)
    return compiled


def kernel(python_function: F) -> F:
    """Compile an entry point and keep its binary on disk."""
    if numba.config.DISABLE_JIT:
        return _kernel_without_jit(python_function)
    compiled: Any = numba.njit(**POLICY, pipeline_class=KernelCompiler)(python_function)
    try:
        compiled._cache = KernelCache(compiled.py_func)
    except RuntimeError:  # Numba's, where no folder can be written
        compiled._cache = NoCache()
    return compiled


def _kernel_without_jit(python_function: F) -> F:
    """Run a kernel as Python, where NumPy's scalars warn of what compiled code does silently: wrap around, overflow."""

    @functools.wraps(python_function)
    def quiet(*arguments: Any) -> Any:
        with np.errstate(all="ignore"):
            return python_function(*arguments)

    return quiet  # type: ignore[return-value]


def from_python(compiled: F) -> F:
    """Return a `function` as an entry point of its own, for what calls it from Python: packing, tests."""
    return kernel(interpreted(compiled))


def interpreted(compiled: F) -> F:
    """Return the Python of a `function`, for what is called too rarely to be compiled for it."""
    python: F = getattr(compiled, "py_func", compiled)
    return python


def where(member: str, *, otherwise: Any = None, inline: bool = True) -> Callable[[F], F]:
    """Compile the decorated function, or `otherwise` where `member` of its first argument, a named tuple, is None.

    So a feature that no scene has leaves nothing behind: what is called in its place is another function of the same
    arguments, or the constant that is given. inline: False for what is large, and called from several places.
    """

    def decorate(present: F) -> F:
        absent = interpreted(otherwise) if callable(otherwise) else _constantly(otherwise)

        def chosen(first: Any, *rest: Any) -> Callable[..., Any]:
            return absent if first.types[first.fields.index(member)] == nb_types.none else present

        def python(first: Any, *rest: Any) -> Any:
            return (absent if getattr(first, member) is None else present)(first, *rest)

        functools.update_wrapper(python, present)
        overload(python, strict=False, jit_options={**INLINED, "forceinline": inline})(chosen)
        return python  # type: ignore[return-value]

    return decorate


def _constantly(value: Any) -> Callable[..., Any]:
    def constant(*arguments: Any) -> Any:
        return value

    return constant
