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
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from numba.extending import overload

from bounce_env.engine.compile.cache import follow_sources
from bounce_env.engine.compile.jit import INLINED, interpreted

F = TypeVar("F", bound=Callable[..., Any])

Functions = dict[str, Callable[..., Any]]

_games: dict[type, Functions] = {}


def define_game(
    rules: type,
    *,
    begin: Callable[..., Any],
    play: Callable[..., Any],
    observe: Callable[..., Any],
    step_quietly: Callable[..., bool] | None = None,
) -> None:
    """Let these functions, compiled by `engine.compile.jit.function`, be what the game with this type of rules does.

    Of a game outside of the package the kernels that are kept on disk depend on the files that define the functions,
    and those beside them.
    """
    functions = {"begin": begin, "play": play, "observe": observe, "step_quietly": step_quietly or _always_play}
    _games[rules] = {name: interpreted(given) for name, given in functions.items()}
    follow_sources(rules, {Path(given.__code__.co_filename) for given in _games[rules].values()})


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
