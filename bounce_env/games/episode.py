"""What every game keeps for each world beside the engine's state, and what it says of an episode."""

import math
from typing import Any, NamedTuple

import numba
import numpy as np
import numpy.typing as npt
from numba.experimental import structref

from bounce_env.engine.jit import Record, borrow, function, kernel
from bounce_env.engine.layout import State, Tables, record
from bounce_env.games.streams import EPISODES, bits

Array = npt.NDArray[Any]

EPISODE = record(
    world_seed="u8", episodes="i8",  # the world's stream of episodes and how many it has begun
    seed="u8",  # of the present episode
    frames="i8",  # 1 / fps each, since the episode began
    score="f8",
    touches="i8",  # hits of the parts that the agent moves
    last_action="f8",  # what the parts do: repeated when actions are sticky
    end="i8",  # how the episode has ended
)  # fmt: skip

BOOKS = record(seconds="f8", score="f8", touches="i8", end="i8", bounces="i8", speed_capped="i8")

# How an episode ends; END_REASONS names them in info["end_reason"].
RUNNING, DRAINED, TIME_LIMIT, OUT_OF_BUDGET = 0, 1, 2, 3
END_REASONS = (None, "drained", "time_limit", "budget")

# Autoreset modes, as in gymnasium.vector.AutoresetMode.
NEXT_STEP, SAME_STEP, DISABLED = 0, 1, 2

FPS = 60  # frames a second, the unit of `frame_skip` and of sticky actions

# Events in one step of a game; more is a ball that rattles itself to death, and truncates the episode.
MAX_EVENTS = 500


class Results(NamedTuple):
    """What a step returns, per world; written in place by the kernel."""

    observations: Array  # (worlds, size) float32
    rewards: Array  # (worlds,) float64
    terminated: Array  # (worlds,) bool
    truncated: Array  # (worlds,) bool
    final_observations: Array  # (worlds, size) float32: of episodes that ended in this step, when reset in the same
    ended: Array  # (worlds,) BOOKS of the episodes that ended in this step
    busy: Array  # (worlds,) uint64: the kernel's list of worlds in which something happens


class _Parts(NamedTuple):
    """All that a game's kernels work on."""

    state: State
    tables: Tables
    rules: Any
    episodes: Array  # (worlds,) EPISODE
    start: Array  # (worlds, 4) x, y, vx, vy of a launch in place of the seed's; NaN for the seed's own
    results: Results


@structref.register
class _HandleType(numba.types.StructRef):  # type: ignore[misc]
    def preprocess_fields(self, fields: Any) -> Any:
        return tuple((name, numba.types.unliteral(kind)) for name, kind in fields)


class Handle(structref.StructRefProxy):  # type: ignore[misc]
    """One object in place of thirty arrays: calling a kernel with it costs 1 us, not 10."""

    def __new__(cls, *parts: Any) -> Any:
        return structref.StructRefProxy.__new__(cls, *parts)


structref.define_proxy(Handle, _HandleType, list(_Parts._fields))


@kernel
def _bind_compiled(parts: _Parts) -> Any:
    return Handle(parts.state, parts.tables, parts.rules, parts.episodes, parts.start, parts.results)


def bind(state: State, tables: Tables, rules: Any, episodes: Array, start: Array, results: Results) -> Any:
    """A handle to all that a game's kernels work on; it keeps the arrays alive."""
    parts = _Parts(state, tables, rules, episodes, start, results)
    return parts if numba.config.DISABLE_JIT else _bind_compiled(parts)


def new_results(worlds: int, size: int) -> Results:
    """Zeroed results for observations of `size` numbers."""
    return Results(
        observations=np.zeros((worlds, size), np.float32),
        rewards=np.zeros(worlds),
        terminated=np.zeros(worlds, np.bool_),
        truncated=np.zeros(worlds, np.bool_),
        final_observations=np.zeros((worlds, size), np.float32),
        ended=np.zeros(worlds, BOOKS),
        busy=np.zeros(worlds, np.uint64),
    )


@function
def borrow_results(results: Results) -> Results:
    """The same results, borrowed; see `engine.jit.borrow`."""
    return Results(
        borrow(results.observations),
        borrow(results.rewards),
        borrow(results.terminated),
        borrow(results.truncated),
        borrow(results.final_observations),
        borrow(results.ended),
        borrow(results.busy),
    )


@function
def all_finite(numbers: Array) -> bool:
    """Whether there is neither NaN nor infinity in (n,) floats."""
    # Counted, not asked one by one: so the processor looks at several at a time.
    others = 0
    for number in numbers:
        others += 0 if abs(number) < math.inf else 1
    return others == 0


@function
def begin_episode(episode: Record) -> None:
    """Give the next episode of a world its seed and clear its books."""
    episode.seed = bits(episode.world_seed, EPISODES, episode.episodes)
    episode.episodes += 1
    episode.frames, episode.touches, episode.end = 0, 0, RUNNING
    episode.score, episode.last_action = 0.0, 0.0


@function
def close_books(results: Results, episode: Record, world: Record, w: int) -> None:
    """Note how the episode of world `w` ended, before anything of it is reset."""
    ended = results.ended[w]
    ended.seconds, ended.score = episode.frames / FPS, episode.score
    ended.touches, ended.end = episode.touches, episode.end
    ended.bounces, ended.speed_capped = world.bounces, world.speed_capped


@function
def open_books(results: Results, w: int) -> None:
    """Forget how an episode of world `w` ended."""
    ended = results.ended[w]
    ended.seconds, ended.score, ended.touches, ended.end = 0.0, 0.0, 0, RUNNING
    ended.bounces, ended.speed_capped = 0, 0
