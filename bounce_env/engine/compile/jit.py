"""The one place that decides how the engine is compiled.

`function` is for everything that kernels call, `kernel` for the entry points called from Python. Both are plain
`numba.njit` with one policy:

* `error_model="numpy"`: a division by zero gives inf, it does not raise from inside a step;
* `fastmath` stays off: it would let the compiler change results from machine to machine;
* `nogil`, and never `parallel=True`: threads run kernels over slices of a batch (a forked child survives that).

Only entry points are cached on disk; what they call is compiled into them. Numba checks a cached binary against the
one file that defines the entry point, so a change in a helper would leave it stale. Here a hash over all sources that
can be compiled into a kernel is checked, too.
"""

import functools
import hashlib
import logging
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import numba
import numpy as np
from numba.core import caching, cgutils
from numba.core import types as nb_types
from numba.extending import intrinsic, overload

from bounce_env.engine.compile.pipeline import InnerCompiler, KernelCompiler

Record = Any  # one record of a table or of the state, see `engine.memory.records`; compiled code changes it in place
Table = Any  # an array, or None where no scene of the batch has what it holds
Feature = Any  # a number, or None where no scene of the batch has the feature
F = TypeVar("F", bound=Callable[..., Any])
POLICY: dict[str, Any] = {"error_model": "numpy", "nogil": True}

# Without their wrappers for Python and C, which nobody calls, functions compile twice as fast. Nothing in them makes an
# array, and kernels borrow theirs: without reference counts they compile faster by another fifth.
INLINED = {
    **POLICY,
    "forceinline": True,
    "no_cpython_wrapper": True,
    "no_cfunc_wrapper": True,
    "_nrt": False,
    "pipeline_class": InnerCompiler,
}


@functools.cache
def sources_hash(folder: Path) -> str:
    """SHA-256 over every source file that can end up in a kernel of `folder`, by place and content.

    These are the engine's, and where the kernel is not the engine's those of its part of the package, or beside it;
    subfolders included.
    """
    engine = Path(__file__).resolve().parent.parent
    package = engine.parent
    own = package / folder.relative_to(package).parts[0] if package in folder.parents else folder
    digest = hashlib.sha256()
    for place in sorted({engine, own}):
        for path in sorted(place.rglob("*.py")):
            digest.update(path.relative_to(place.parent).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


class _KernelCache(caching.FunctionCache):  # type: ignore[misc]
    """Numba's cache, in which another state of the sources counts as another version of Numba.

    An index of another version is put aside unread: reading it could fail on a class that is no longer there. One that
    cannot be read is begun afresh, and what cannot be written is kept in memory: a cache is no reason to fail.
    """

    def __init__(self, python_function: Callable[..., Any]) -> None:
        super().__init__(python_function)
        folder = Path(python_function.__code__.co_filename).resolve().parent
        self._cache_file._version = f"{numba.__version__} {sources_hash(folder)}"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the binary of a signature; None, after a word to the user, where it has to be compiled."""
        binary = None
        try:
            binary = super().load_overload(sig, target_context)
        except Exception:  # whatever a file that was damaged, or is somebody else's, makes of unpickling
            self._begin_afresh()
        if binary is None:
            _say_compiling(f"once: they are kept in {self.cache_path}")
        return binary

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a binary on disk, if that is possible."""
        try:
            super().save_overload(sig, data)
        except Exception as error:  # a disk that is full, a folder that has become read-only, an index as above
            _say_cache_fails(f"{self.cache_path} cannot be used ({type(error).__name__}: {error})")

    def _begin_afresh(self) -> None:
        try:
            self.flush()
        except OSError as error:
            _say_cache_fails(f"{self.cache_path} cannot be used ({type(error).__name__}: {error})")


class _NoCache(caching.NullCache):  # type: ignore[misc]
    """The cache of a kernel for which there is no folder that can be written."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return None, after a word to the user."""
        _say_cache_fails("neither the package's folder nor the user's cache folder can be written")
        _say_compiling("in each process")


def _say_compiling(how_often: str) -> None:
    """Say before the first wait what takes so long."""
    _say_once("compiling", f"compiling kernels, up to a minute for each game and kind of scene, {how_often}")


def _say_cache_fails(why: str) -> None:
    advice = "set NUMBA_CACHE_DIR to a folder that can be written, and they are kept there"
    _say_once("cache", f"kernels are compiled in memory, for this process only, as {why}: {advice}")


_said: set[str] = set()


def _say_once(topic: str, words: str) -> None:
    """Tell the user through `logging`, which without a handler of its own writes to stderr."""
    if topic not in _said:
        _said.add(topic)
        logging.getLogger("bounce_env").warning("bounce_env: %s", words)


def cache_folder(compiled: Callable[..., Any]) -> str | None:
    """Return the folder that the binary of a kernel is kept in; None where there is none that can be written."""
    try:
        return str(_KernelCache(interpreted(compiled)).cache_path)
    except RuntimeError:
        return None


def function(python_function: F) -> F:
    """Compile a function that kernels call; Python calls it through `from_python`."""
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
        return _without_warnings(python_function)
    compiled: Any = numba.njit(**POLICY, pipeline_class=KernelCompiler)(python_function)
    try:
        compiled._cache = _KernelCache(compiled.py_func)
    except RuntimeError:  # Numba's, where no folder can be written
        compiled._cache = _NoCache()
    return compiled


def _without_warnings(python_function: F) -> F:
    """Run a kernel as Python, where NumPy's scalars warn of what compiled code does silently: wrap around, overflow."""

    @functools.wraps(python_function)
    def quiet(*arguments: Any) -> Any:
        with np.errstate(all="ignore"):
            return python_function(*arguments)

    return quiet  # type: ignore[return-value]


def from_python(compiled: F) -> F:
    """A `function` as an entry point of its own, for what calls it from Python: packing, tests."""
    return kernel(interpreted(compiled))


def interpreted(compiled: F) -> F:
    """The Python of a `function`, for what is called too rarely to be compiled for it."""
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


def _without_owner(context: Any, builder: Any, kind: Any, value: Any) -> Any:
    """A value of which no array, however deep in tuples it lies, says who owns its memory."""
    if isinstance(kind, nb_types.Array):
        array = context.make_array(kind)(context, builder, value=value)
        array.meminfo = cgutils.get_null_value(array.meminfo.type)
        array.parent = cgutils.get_null_value(array.parent.type)
        return array._getvalue()
    if isinstance(kind, nb_types.BaseTuple):  # type: ignore[attr-defined]
        for i, member in enumerate(kind.types):
            bare = _without_owner(context, builder, member, builder.extract_value(value, i))
            value = builder.insert_value(value, bare, i)
    return value


def _borrowed(typing_context: Any, argument: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return _without_owner(context, builder, argument, values[0])

    return argument(argument), generate


_borrow = intrinsic(_borrowed)


def _borrow_interpreted(argument: Any) -> Any:
    return argument


@function
def _borrow_compiled(argument: Any) -> Any:
    return _borrow(argument)


borrow = _borrow_interpreted if numba.config.DISABLE_JIT else _borrow_compiled
"""The same array, or (named) tuple of arrays, tuples and numbers, without reference counts.

Numba counts references at every call that an array is passed to, atomically; over a batch that costs more than the
physics. A kernel borrows its arguments once: its caller holds them for as long as it runs.
"""
