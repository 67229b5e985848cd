"""What every game keeps for each world beside the engine's state, and what it says of an episode."""

from typing import Any, NamedTuple

import numpy as np

from bounce_env.engine.compile.jit import Record, function
from bounce_env.engine.memory.records import Array, record
from bounce_env.engine.memory.state import State
from bounce_env.games.guarded import guarded
from bounce_env.games.streams import EPISODES, STICKY_ACTIONS, bits, uniform

EPISODE = record(
    world_seed="u8", episodes="i8",  # the world's stream of episodes and how many it has begun
    seed="u8",  # of the present episode
    frames="i8",  # 1 / fps each, since the episode began
    steps="i8", rewards="f8",  # of the agent, since the episode began: how many, and their sum
    score="f8",
    ball="i8",  # which one is played, from 0 on
    level="i8",  # which one it is played on; NO_LEVEL in a game without
    end="i8",  # how the episode has ended
)  # fmt: skip

BOOKS = record(
    seconds="f8", steps="i8", rewards="f8", score="f8", ball="i8", level="i8", end="i8", bounces="i8",
    speed_capped="i8",
)  # fmt: skip

RUNNING = 0
"""An episode's `end` while it goes on."""

DRAINED = 1
"""It ended when the last ball was lost: terminated."""

TIME_LIMIT = 2
"""It ended at its time limit: truncated."""

OUT_OF_BUDGET = 3
"""It ended as more events fell into one run of the event loop than `Pace.max_events`: truncated."""

ALL_PLAYED = 4
"""It ended when the last ball was brought to its target, or lost: terminated."""

# In the order of these numbers, for info["end_reason"].
END_REASONS = (None, "drained", "time_limit", "budget", "all_played")

NO_LEVEL = -1

# Autoreset modes, as in gymnasium.vector.AutoresetMode.
NEXT_STEP, SAME_STEP, DISABLED = 0, 1, 2

FPS = 60  # frames a second, the unit of `frame_skip` and of sticky actions


class Results(NamedTuple):
    """What a step returns, per world; written in place by the kernel."""

    observations: Array  # (worlds, size) float32
    rewards: Array  # (worlds,) float64
    terminated: Array  # (worlds,) bool
    truncated: Array  # (worlds,) bool
    final_observations: Array  # (worlds, size) float32: of episodes that ended in this step, when reset in the same
    ended: Array  # (worlds,) BOOKS of the episodes that ended in this step
    counted: Array  # (worlds, counters) float64: what the game has counted in them
    busy: Array  # (worlds,) uint64: the kernel's list of worlds in which something happens


class GameState(NamedTuple):
    """All that a game's kernels work on, beside its rules; first axis worlds. See docs/own_game.md.

    state: of the engine, with `state.hits` (worlds, elements). episodes: (worlds,) records of EPISODE. memory: what the
    game's rules remember of a world, or None. held: (worlds, controls) float64, the action in force. counters: (worlds,
    counters) float64, what the game counts in an episode. start: (worlds, 5), what the options of a reset ask for.
    results: what a step returns.
    """

    state: State
    episodes: Array  # (worlds,) EPISODE
    memory: Any  # (worlds,) of the game's own record: what its rules remember; None: nothing
    held: Array  # (worlds, controls) float64: the action in force, which a sticky one repeats
    counters: Array  # (worlds, counters) float64: what the game counts in an episode
    start: Array  # (worlds, 5) x, y, vx, vy of a launch and the level in place of the seed's; NaN for the seed's own
    results: Results


class Handle(NamedTuple):
    """All that a game's kernels get, bound as one."""

    rules: Any  # the game's own, see `games.rules`
    game: GameState


def new_results(worlds: int, size: int, counters: int) -> Results:
    """Zeroed results for observations of `size` numbers and so many counters."""
    return Results(
        observations=guarded(worlds, size, np.float32),
        rewards=np.zeros(worlds),
        terminated=np.zeros(worlds, np.bool_),
        truncated=np.zeros(worlds, np.bool_),
        final_observations=np.zeros((worlds, size), np.float32),
        ended=np.zeros(worlds, BOOKS),
        counted=np.zeros((worlds, counters)),
        busy=np.zeros(worlds, np.uint64),
    )


@function
def begin_episode(game: GameState, w: int) -> Record:
    """Give the next episode of world `w` its seed and clear its books."""
    episode = game.episodes[w]
    episode.seed = bits(episode.world_seed, EPISODES, episode.episodes)
    episode.episodes += 1
    episode.frames, episode.steps, episode.rewards, episode.score = 0, 0, 0.0, 0.0
    episode.ball, episode.level, episode.end = 0, NO_LEVEL, RUNNING
    for j in range(game.held.shape[1]):
        game.held[w, j] = 0.0
    for j in range(game.counters.shape[1]):
        game.counters[w, j] = 0.0
    return episode


@function
def hold_action(game: GameState, actions: Array, w: int, repeat: float) -> None:
    """Let the action of this step be in force, or, with the probability `repeat` per frame, go on with the last one.

    actions: (worlds, controls) float64, each number as the game's `Actions` give it.
    """
    episode = game.episodes[w]
    if repeat == 0.0 or uniform(episode.seed, STICKY_ACTIONS, episode.frames) >= repeat:
        for j in range(game.held.shape[1]):
            game.held[w, j] = actions[w, j]


@function
def close_books(game: GameState, w: int) -> None:
    """Note how the episode of world `w` ended, before anything of it is reset."""
    ended, episode, world = game.results.ended[w], game.episodes[w], game.state.worlds[w]
    ended.seconds, ended.score = episode.frames / FPS, episode.score
    ended.steps, ended.rewards = episode.steps, episode.rewards
    ended.ball, ended.level, ended.end = episode.ball, episode.level, episode.end
    ended.bounces, ended.speed_capped = world.bounces, world.speed_capped
    for j in range(game.counters.shape[1]):
        game.results.counted[w, j] = game.counters[w, j]


@function
def open_books(results: Results, w: int) -> None:
    """Forget how an episode of world `w` ended."""
    ended = results.ended[w]
    ended.seconds, ended.score, ended.ball, ended.level, ended.end = 0.0, 0.0, 0, 0, RUNNING
    ended.steps, ended.rewards, ended.bounces, ended.speed_capped = 0, 0.0, 0, 0
    for j in range(results.counted.shape[1]):
        results.counted[w, j] = 0.0
