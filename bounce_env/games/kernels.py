"""The kernels that step a batch of worlds of any game, and reset them."""

import math
from typing import Any

import numpy as np

from bounce_env.engine.compile.jit import function, kernel
from bounce_env.engine.memory.records import Array
from bounce_env.games.episode import (
    ALL_PLAYED,
    DRAINED,
    NEXT_STEP,
    OUT_OF_BUDGET,
    RUNNING,
    SAME_STEP,
    TIME_LIMIT,
    GameState,
    close_books,
    open_books,
)
from bounce_env.games.rules import of_game


@of_game
def begin(rules: Any, game: GameState, w: int) -> None:
    """See `games.rules`."""


@of_game
def play(rules: Any, game: GameState, actions: Array, w: int) -> float:
    """See `games.rules`."""
    raise NotImplementedError


@of_game
def step_quietly(rules: Any, game: GameState, actions: Array, w: int) -> bool:
    """See `games.rules`."""
    raise NotImplementedError


@of_game
def observe(rules: Any, game: GameState, w: int, out: Array) -> None:
    """See `games.rules`."""


@kernel
def reset_worlds(handle: Any, mask: Array) -> None:
    """Begin an episode in every world that `mask` names, launched as `handle.start` says."""
    game, rules = handle.game, handle.rules
    results = game.results
    for w in range(mask.shape[0]):
        if mask[w]:
            begin(rules, game, w)
            observe(rules, game, w, results.observations)
            results.terminated[w] = False
            results.truncated[w] = False
            results.rewards[w] = 0.0


@kernel
def step_worlds(handle: Any, actions: Array, autoreset: int, first: int, last: int) -> int:
    """One step of worlds `first` to `last` - 1, with the autoreset mode's resets; returns how many episodes ended.

    actions: (worlds, controls) float64; where any of them is NaN or infinite nothing is done and -1 returned. A world
    whose episode has ended is reset in place of a step (NEXT_STEP), was reset at its end (SAME_STEP), or must have been
    reset by the caller (DISABLED).
    """
    game, rules = handle.game, handle.rules
    results, episodes = game.results, game.episodes
    if not _all_finite(actions):
        return -1
    results.rewards[first:last] = 0.0
    results.terminated[first:last] = False
    results.truncated[first:last] = False
    busy = first
    # Of an unsigned index Numba does not ask whether it counts from the end.
    for w in range(np.uint64(first), np.uint64(last)):
        if not step_quietly(rules, game, actions, w):
            results.busy[busy] = w
            busy += 1
    ended = 0
    for i in range(first, busy):
        w = results.busy[i]
        if autoreset == NEXT_STEP and episodes[w].end != RUNNING:
            begin(rules, game, w)
            observe(rules, game, w, results.observations)
            open_books(results, w)
            continue
        results.rewards[w] = play(rules, game, actions, w)
        episodes[w].rewards += results.rewards[w]
        if results.ended[w].end != RUNNING:
            open_books(results, w)
        end = episodes[w].end
        results.terminated[w] = end in (DRAINED, ALL_PLAYED)
        # What ends in the last step that there may be is truncated, too, as by Gymnasium's TimeLimit.
        last = end != RUNNING and episodes[w].steps >= rules.pace.steps
        results.truncated[w] = last or end in (TIME_LIMIT, OUT_OF_BUDGET)
        observe(rules, game, w, results.observations)
        if end != RUNNING:
            ended += 1
            close_books(game, w)
            if autoreset == SAME_STEP:
                for j in range(results.observations.shape[1]):
                    results.final_observations[w, j] = results.observations[w, j]
                begin(rules, game, w)
                observe(rules, game, w, results.observations)
    return ended


@function
def _all_finite(numbers: Array) -> bool:
    """Return whether there is neither NaN nor infinity in (n, k) floats."""
    # Counted, not asked one by one: so the processor looks at several at a time.
    others = 0
    for i in range(numbers.shape[0]):
        for j in range(numbers.shape[1]):
            others += 0 if abs(numbers[i, j]) < math.inf else 1
    return others == 0
