"""Where the binaries of kernels are kept, and when one of them is too old.

Numba checks a cached binary against the one file that defines the entry point, so that a change in a helper would leave
it stale. Here a hash over all sources that can be compiled into a kernel is checked, too.
"""

import copy
import functools
import hashlib
import logging
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numba
from numba.core import caching
from numba.core import types as nb_types

from bounce_env.engine.compile.binding import BoundType
from bounce_env.files import hash_of_files

PACKAGE = Path(__file__).resolve().parents[2]

_foreign: dict[type, str | None] = {}
"""Types of named tuples from outside of the package, with a hash of the sources there; None: they lie in no file."""


@functools.cache
def sources_hash(folder: Path) -> str:
    """Return what tells states of the sources apart that can end up in a kernel of `folder`.

    These are the engine's, and where the kernel is not the engine's those of its part of the package, or beside it;
    subfolders included.
    """
    own = PACKAGE / folder.relative_to(PACKAGE).parts[0] if PACKAGE in folder.parents else folder
    places = sorted({PACKAGE / "engine", own})
    return " ".join(hash_of_files(place.rglob("*.py"), place.parent) for place in places)


def follow_sources(kind: type, files: Iterable[Path]) -> None:
    """Let kernels that are compiled for named tuples of this type depend on these files, if they are not the package's.

    And on the modules beside them; of a package on all of it. What these import from elsewhere is not followed. Code
    that lies in no file (a notebook, a prompt) cannot be found again: its kernels are not kept.
    """
    foreign = {file.resolve() for file in files if PACKAGE not in file.resolve().parents}
    if not foreign:
        return
    sources = {path for file in foreign if file.is_file() for path in _modules_around(file)}
    is_found = all(file.is_file() for file in foreign)
    _foreign[kind] = hash_of_files(sources) if is_found else None


def _modules_around(file: Path) -> Iterable[Path]:
    """The modules in the folder of a file, or in the whole package that it is in."""
    top = file.parent
    if not (top / "__init__.py").is_file():
        return top.glob("*.py")
    while (top.parent / "__init__.py").is_file():
        top = top.parent
    return top.rglob("*.py")


class KernelCache(caching.FunctionCache):  # type: ignore[misc]
    """Numba's cache, in which another state of the sources counts as another version of Numba.

    An index of another version is put aside unread: reading it could fail on a class that is no longer there. One that
    cannot be read is begun afresh, and what cannot be written is kept in memory: a cache is no reason to fail.
    Kernels of games from outside of the package have files of their own: whoever does not know such a game cannot read
    them, and one that was defined in a script cannot be found again at all.
    """

    def __init__(self, python_function: Callable[..., Any]) -> None:
        super().__init__(python_function)
        folder = Path(python_function.__code__.co_filename).resolve().parent
        self._cache_file._version = f"{numba.__version__} {sources_hash(folder)}"

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the binary of a signature; None, after a word to the user, where it has to be compiled."""
        kinds = _foreign_kinds(sig)
        if kinds:
            cache = self._beside(kinds)
            if cache is None:
                return _say_compiling("in each process, as the game is in a script or notebook: put it into a module")
            return cache._load(sig, target_context)
        return self._load(sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep a binary on disk, if that is possible."""
        kinds = _foreign_kinds(sig)
        cache = self._beside(kinds) if kinds else self
        if cache is not None:
            cache._save(sig, data)

    def _beside(self, kinds: list[type]) -> "KernelCache | None":
        """Return the cache for these types from outside of the package; None where there can be none."""
        hashes = [_foreign[kind] for kind in kinds]
        if None in hashes or any(kind.__module__ == "__main__" for kind in kinds):
            return None
        names = " ".join(f"{kind.__module__}.{kind.__qualname__}" for kind in kinds)
        other = copy.copy(self)
        other._cache_file = caching.IndexDataCacheFile(
            cache_path=self._cache_path,
            filename_base=f"{self._impl.filename_base}.{hashlib.sha256(names.encode()).hexdigest()[:12]}",
            source_stamp=self._impl.locator.get_source_stamp(),
        )
        other._cache_file._version = " ".join([self._cache_file._version, *map(str, hashes)])
        return other

    def _load(self, sig: Any, target_context: Any) -> Any:
        binary = None
        try:
            binary = super().load_overload(sig, target_context)
        except Exception:  # whatever a file that was damaged, or is somebody else's, makes of unpickling
            self._begin_afresh()
        if binary is None:
            _say_compiling(f"once: they are kept in {self.cache_path}")
        return binary

    def _save(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except Exception as error:  # a disk that is full, a folder that has become read-only, an index as above
            _say_cache_fails(f"{self.cache_path} cannot be used ({type(error).__name__}: {error})")

    def _begin_afresh(self) -> None:
        try:
            self.flush()
        except OSError as error:
            _say_cache_fails(f"{self.cache_path} cannot be used ({type(error).__name__}: {error})")


class NoCache(caching.NullCache):  # type: ignore[misc]
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


def _foreign_kinds(sig: Any) -> list[type]:
    """Return the types from outside of the package that a signature mentions, in order of their names."""
    found = {kind for argument in getattr(sig, "args", sig) for kind in _named_tuples_of(argument)}
    return sorted(found & _foreign.keys(), key=lambda kind: (kind.__module__, kind.__qualname__))


def _named_tuples_of(argument: Any) -> Iterator[type]:
    if isinstance(argument, nb_types.BaseNamedTuple | BoundType):  # type: ignore[attr-defined]
        yield argument.instance_class
    if isinstance(argument, nb_types.BaseTuple | BoundType):  # type: ignore[attr-defined]
        for member in argument.types:
            yield from _named_tuples_of(member)


def cache_folder(compiled: Callable[..., Any]) -> str | None:
    """Return the folder that the binary of a kernel is kept in; None where there is none that can be written."""
    try:
        return str(KernelCache(getattr(compiled, "py_func", compiled)).cache_path)
    except RuntimeError:
        return None
