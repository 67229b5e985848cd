"""How one kernel steps every game: what a game does is chosen, when the kernel is compiled, by the type of its rules.

A game is a NamedTuple type of rules (all that its functions need to know beside the scene) with four functions:

* `begin(rules, worlds, w)`: the next episode of world `w` begins;
* `play(rules, worlds, actions, w)`: one step; sets the episode's `end` where it ends, returns the reward;
* `glide(rules, worlds, actions, w)`: the same where surely nothing happens; or does nothing, returns False;
* `observe(rules, worlds, w, out)`: what an agent sees, into `out[w]`.
"""

import functools
from collections.abc import Callable
from typing import Any, TypeVar

from numba.extending import overload

from bounce_env.engine.compile.jit import INLINED

F = TypeVar("F", bound=Callable[..., Any])

NAMES = ("begin", "play", "glide", "observe")

_games: dict[type, dict[str, Callable[..., Any]]] = {}


def is_game(rules: type, **functions: Callable[..., Any]) -> None:
    """Let `functions`, one for each of NAMES, be what the game with this type of rules does."""
    assert set(functions) == set(NAMES)
    _games[rules] = {name: getattr(f, "py_func", f) for name, f in functions.items()}


def of_game(stub: F) -> F:
    """Compile a call of `stub` as the function of its name of the game whose rules are the first argument."""
    name = stub.__name__

    def chosen(rules: Any, *rest: Any) -> Callable[..., Any]:
        return _games[rules.instance_class][name]

    def interpreted(rules: Any, *rest: Any) -> Any:
        return _games[type(rules)][name](rules, *rest)

    functools.update_wrapper(interpreted, stub)
    overload(interpreted, strict=False, jit_options=INLINED)(chosen)
    return interpreted  # type: ignore[return-value]
