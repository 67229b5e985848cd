"""How one kernel steps every game: what a game does is chosen, when the kernel is compiled, by the type of its rules.

A game's rules are a NamedTuple type of their own (all that its functions need to know beside the scene) with a `pace`,
and these compiled functions:

* `begin(rules, game, w)`: the next episode of world `w` begins;
* `play(rules, game, actions, w)`: one step; sets the episode's `end` where it ends, returns the reward;
* `observe(rules, game, w, out)`: what an agent sees, into `out[w]`;
* `step_quietly(rules, game, actions, w)`, which may be left out: the step of a world in which surely nothing happens;
  or it does nothing and returns False.
"""

import functools
import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from numba.extending import overload

from bounce_env.engine.compile.cache import follow_sources
from bounce_env.engine.compile.jit import INLINED, interpreted
from bounce_env.wording import shown

F = TypeVar("F", bound=Callable[..., Any])

Functions = dict[str, Callable[..., Any]]

_games: dict[type, Functions] = {}

_defined: dict[str, int] = {}
"""How often a type of rules of this name was defined: in a notebook that may be many times."""


def define_game(
    rules: type,
    *,
    begin: Callable[..., Any],
    play: Callable[..., Any],
    observe: Callable[..., Any],
    step_quietly: Callable[..., bool] | None = None,
) -> None:
    """Let these functions, compiled by `bounce_env.games.function`, be what the game with this type of rules does.

    begin, play, observe, step_quietly: see the head of `bounce_env.games.rules`, and docs/own_game.md.

    Of a game outside of the package the kernels that are kept on disk depend on the modules that define the functions,
    and those beside them (`engine.compile.cache.follow_sources`). Raises TypeError for what is no NamedTuple type, and
    ValueError where it is that of a game already.
    """
    if not (isinstance(rules, type) and issubclass(rules, tuple) and hasattr(rules, "_fields")):
        raise TypeError(f"rules = {shown(rules)}: must be a subclass of NamedTuple")
    if rules in _games:
        raise ValueError(f"rules = {shown(rules)}: must be a type of their own, these are a game's already")
    _tell_apart(rules)
    functions = {"begin": begin, "play": play, "observe": observe, "step_quietly": step_quietly or _always_play}
    _games[rules] = {name: interpreted(given) for name, given in functions.items()}
    follow_sources(rules, {Path(given.__code__.co_filename) for given in _games[rules].values()})


def check_defined(rules: type) -> None:
    """Raise TypeError for a type of rules that is no game's."""
    if rules not in _games:
        raise TypeError(
            f"rules = {shown(rules)}: must be a game's: define_game({rules.__name__}, begin=..., ...) is missing"
        )


def _tell_apart(rules: type) -> None:
    """Give a type of rules a name that no other has.

    Numba knows named tuples by the names of type and fields alone: two games with `class Rules(NamedTuple)` would play
    each other's functions. The name is the same in each process, unless a type is defined again in one.
    """
    place = f"{rules.__module__}.{rules.__qualname__}"
    _defined[place] = _defined.get(place, 0) + 1
    rules.__name__ = f"{rules.__name__}_{hashlib.sha256(place.encode()).hexdigest()[:12]}_{_defined[place]}"


def _always_play(rules: Any, game: Any, actions: Any, w: int) -> bool:
    return False


def of_game(stub: F) -> F:
    """Compile a call of `stub` as the function of its name of the game whose rules are the first argument."""
    name = stub.__name__

    def chosen(rules: Any, *rest: Any) -> Callable[..., Any]:
        return _games[rules.instance_class][name]

    def python(rules: Any, *rest: Any) -> Any:
        return _games[type(rules)][name](rules, *rest)

    functools.update_wrapper(python, stub)
    overload(python, strict=False, jit_options=INLINED)(chosen)
    return python  # type: ignore[return-value]
