"""A batch of worlds that play one game: the one thing that the single env, the vector env and SB3's share."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any, ClassVar, Protocol

import numpy as np
import numpy.typing as npt

from bounce_env.engine.layout import Array, State, Tables, new_state
from bounce_env.engine.view import view
from bounce_env.games.episode import END_REASONS, EPISODE, Results, bind, new_results
from bounce_env.scene import Scene

Mask = npt.NDArray[np.bool_]

_END_REASONS = np.array(END_REASONS, dtype=object)


class Game(Protocol):
    """What a batch needs of a game."""

    reset_worlds: ClassVar[Callable[..., None]]
    step_worlds: ClassVar[Callable[..., int]]  # negative where an action was not finite, and nothing was done

    scenes: tuple[Scene, ...]
    tables: Tables
    rules: Any
    step_seconds: float
    field: tuple[float, float, float, float]  # x_min, y_min, x_max, y_max [m]: where a ball may be launched
    discrete_actions: int | None
    observation_high: npt.NDArray[np.float32]  # bounds of what is observed; the lower ones are their negatives

    @staticmethod
    def speeds(actions: Array) -> Array: ...


class Batch:
    """`worlds` worlds of one game, stepped by `num_threads` threads.

    state, episodes, results: what the kernels work on, rows by world; `results` is overwritten by each call. The result
    does not depend on the number of threads: no world reads what another writes.
    """

    def __init__(self, game: Game, worlds: int, *, autoreset: int, num_threads: int = 1) -> None:
        self.game = game
        self.worlds = worlds
        self.autoreset = autoreset
        point = game.scenes[0].ball.radius == 0.0
        self.state: State = new_state(game.tables, worlds, 1, point)
        self.episodes: Array = np.zeros(worlds, EPISODE)
        self.results: Results = new_results(worlds, len(game.observation_high))
        self._start = np.full((worlds, 4), np.nan)
        self._borders = np.linspace(0, worlds, min(num_threads, worlds) + 1).astype(int).tolist()
        self._threads: ThreadPoolExecutor | None = None
        self._handle: Any = None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_threads": None, "_handle": None}

    def seed(self, world: int, seed: np.uint64) -> None:
        """Let the stream of episodes of a world begin anew from `seed`."""
        self.episodes[world].world_seed = seed
        self.episodes[world].episodes = 0

    def reset(self, mask: Mask, start: npt.NDArray[np.float64] | None = None) -> None:
        """Begin the next episode in the worlds of `mask`; `start` (worlds, 4): x, y, vx, vy, NaN for the seed's own."""
        self._start[:] = np.nan if start is None else start
        self.game.reset_worlds(self._bound(), mask)
        self._start[:] = np.nan

    def _bound(self) -> Any:
        if self._handle is None:
            game = self.game
            self._handle = bind(self.state, game.tables, game.rules, self.episodes, self._start, self.results)
        return self._handle

    def step(self, actions: Array) -> int:
        """One step of every world; returns how many episodes ended.

        actions: (worlds,) whole numbers where `game.discrete_actions`, otherwise (worlds,) or (worlds, 1) floats, which
        are clipped to [-1, 1]; one world takes a plain number, too. Raises ValueError, before anything moves, for
        another shape or type, NaN, infinity, or no such action.
        """
        speeds = self._checked(np.asarray(actions))
        if len(self._borders) == 2:
            ended = self.game.step_worlds(self._bound(), speeds, self.autoreset, 0, self.worlds)
        else:
            if self._threads is None:
                self._threads = ThreadPoolExecutor(len(self._borders) - 1)
            step = partial(self.game.step_worlds, self._bound(), speeds, self.autoreset)
            ended = sum(self._threads.map(step, self._borders[:-1], self._borders[1:]))
        if ended < 0:
            self._refuse(speeds)
        return ended

    def _checked(self, actions: Array) -> Array:
        """The actions as (worlds,) numbers for the kernel; whether they are finite is asked after this."""
        discrete = self.game.discrete_actions
        kinds, what = ("fiu", "numbers") if discrete is None else ("iu", f"whole numbers from 0 to {discrete - 1}")
        column = discrete is None and actions.shape == (self.worlds, 1)
        if not (column or actions.shape == (self.worlds,) or (self.worlds == 1 and actions.shape == ())):
            raise ValueError(f"actions of shape {actions.shape}: must be {self.worlds} {what}, one per world")
        if actions.dtype.kind not in kinds:
            raise ValueError(f"actions = {actions!r}: must be {what}")
        if discrete is None:
            return actions.reshape(self.worlds).astype(np.float64, copy=False)
        if (actions < 0).any() or (actions >= discrete).any():
            raise ValueError(f"actions = {actions!r}: each must be a whole number from 0 to {discrete - 1}")
        return self.game.speeds(actions.reshape(self.worlds))

    def _refuse(self, actions: Array) -> None:
        world = int(np.flatnonzero(~np.isfinite(actions))[0])
        raise ValueError(f"actions[{world}] = {actions[world]}: must be finite")

    def end_info(self) -> dict[str, Array]:
        """What is said of the episodes that ended in the last step, (worlds,) each; 0 or None where none did."""
        books = self.results.ended
        reasons = np.full(self.worlds, None, object)
        ended = np.flatnonzero(books["end"])
        reasons[ended] = _END_REASONS[books["end"][ended]]
        return {
            "end_reason": reasons,
            "points_bumpers": books["score"].copy(),
            "bounces": books["bounces"].copy(),
            "touches": books["touches"].copy(),
            "speed_capped": books["speed_capped"].copy(),
            "game_seconds": books["seconds"].copy(),
        }

    def view(self, world: int) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Balls (1, 4): x, y [m], vx, vy [m/s], and the ends of the parts' cores (m, 4) [m] of a world now."""
        parts = self.game.tables.parts
        balls, cores = np.empty((1, 4)), np.empty((0 if parts is None else parts.shape[1], 4))
        view(self.state, self.game.tables, world, balls, cores)
        return balls, cores

    def close(self) -> None:
        """End the threads."""
        if self._threads is not None:
            self._threads.shutdown()
            self._threads = None
