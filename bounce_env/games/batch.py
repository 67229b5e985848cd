"""A batch of worlds that play one game: the one thing that the single env, the vector env and SB3's share."""

import hashlib
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cached_property, partial
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.binding import bind
from bounce_env.engine.compile.jit import interpreted
from bounce_env.engine.compile.rows import Rows
from bounce_env.engine.memory.records import NO_WORLD, Array
from bounce_env.engine.memory.state import State, moving_arrays, with_recording
from bounce_env.engine.motion.readout import view
from bounce_env.engine.packing import pack
from bounce_env.games.episode import (
    END_REASONS,
    EPISODE,
    FPS,
    RUNNING,
    SAME_STEP,
    TIME_LIMIT,
    GameState,
    Handle,
    Results,
    close_books,
    new_results,
)
from bounce_env.games.game import Game
from bounce_env.games.guarded import check_written, guarded
from bounce_env.games.kernels import reset_worlds, step_worlds
from bounce_env.games.recorder import MOMENTS, ROWS, Origin, Recorder, Step
from bounce_env.games.rules import check_defined
from bounce_env.games.state_copy import States, check_states_fit
from bounce_env.games.timing import NO_STEP_LIMIT
from bounce_env.scene import Scene, Sensor
from bounce_env.wording import shown

Mask = npt.NDArray[np.bool_]

_FIRST_CALLS = 20
"""After so many resets, and steps with ends, a game is not looked at any more: where it writes is in its code."""

_END_REASONS = np.array(END_REASONS, dtype=object)


class Batch:
    """`worlds` worlds of one game, stepped by `num_threads` threads.

    state, episodes, results: what the kernels work on, rows by world; `results` is overwritten by each call. The result
    does not depend on the number of threads: no world reads what another writes.
    """

    def __init__(self, game: Game, worlds: int, *, autoreset: int, num_threads: int = 1) -> None:
        self.game = game
        self.worlds = worlds
        self.autoreset = autoreset
        self.rules = game.rules_for(worlds)
        check_defined(type(self.rules))
        self.state: State = pack(game.scenes, worlds, own_rows=game.owns_scenes)
        self._written = game.written(self.state, self.rules)
        self.episodes: Array = np.zeros(worlds, EPISODE)
        self.results: Results = new_results(worlds, len(game.observed), len(game.counters))
        self.memory: Array | None = None if game.memory is None else np.zeros(worlds, game.memory)
        self.held = np.zeros((worlds, game.actions.width))
        self.counters = guarded(worlds, len(game.counters), np.float64)
        self._unchecked = _FIRST_CALLS
        self._start = np.full((worlds, 5), np.nan)
        self._borders = np.linspace(0, worlds, min(num_threads, worlds) + 1).astype(int).tolist()
        self._threads: ThreadPoolExecutor | None = None
        self._process = os.getpid()
        self._handle: Any = None
        self.recorder: Recorder | None = None
        self._given: dict[int, tuple[int, int | None]] = {}  # by world: its seed, and from which its user has it

    def __getstate__(self) -> dict[str, Any]:
        # In a copy the arrays lie elsewhere.
        return {
            **{name: value for name, value in self.__dict__.items() if name != "_rows"},
            "_threads": None,
            "_handle": None,
        }

    def limit_steps(self, steps: int | None) -> None:
        """Truncate episodes after so many steps, if nothing else ends them before; None: never."""
        steps = NO_STEP_LIMIT if steps is None else steps
        if steps != self.rules.pace.steps:
            self.rules = self.rules._replace(pace=self.rules.pace._replace(steps=steps))
            self._handle = None

    def seed(self, world: int, seed: np.uint64, given: int | None = None) -> None:
        """Let the stream of episodes of a world begin anew from `seed`. given: from which its user has it."""
        self._given[world] = int(seed), given
        self.episodes[world].world_seed = seed
        self.episodes[world].episodes = 0

    def reset(self, mask: Mask, start: npt.NDArray[np.float64] | None = None) -> None:
        """Begin the next episode in the worlds of `mask`; `start` (worlds, 5): x, y, vx, vy, level; NaN: the seed's."""
        self._start[:] = np.nan if start is None else start
        recorder = self.recorder
        if recorder is not None and mask[recorder.world]:
            recorder.begin(self.state)
        reset_worlds(self._bound(), mask)
        self._check_what_is_new()
        self._start[:] = np.nan
        self._take_recording(stepped=False)

    def _origin(self, world: int) -> Origin:
        episode = self.episodes[world]
        world_seed, given = self._given.get(world, (-1, None))
        seed = given if world_seed == int(episode["world_seed"]) else None  # else it is that of a state restored
        return Origin(int(episode["world_seed"]), int(episode["episodes"]), seed)

    def record(self, world: int | None) -> None:
        """Keep what happens in a world from its next episode on, in `recorder`; None: no longer."""
        if world is not None and self.recorder is not None and self.recorder.world == world:
            return
        self.recorder = None if world is None else Recorder(world, self._origin(world))
        room = () if world is None else (ROWS, MOMENTS)
        self.state = with_recording(self.state, *room)
        self.state.recording.head["world"] = NO_WORLD if world is None else world
        self._handle = None
        self.__dict__.pop("bound_state", None)

    def _take_recording(self, *, stepped: bool) -> None:
        recorder = self.recorder
        if recorder is None:
            return
        w = recorder.world
        episode, ended = self.episodes[w], self.results.ended[w]
        step, over = None, ended["end"] != RUNNING
        # Where an episode begins in place of a step there is none.
        origin = self._origin(w)
        if stepped and (over or origin == recorder.origin):
            time, score = (ended["seconds"], ended["score"]) if over else (episode["frames"] / FPS, episode["score"])
            step = Step(float(time), float(self.results.rewards[w]), float(score))
        recorder.take(self.state, self.scene(w), origin, step)

    @cached_property
    def bound_state(self) -> Any:
        """The state as the engine's kernels get it."""
        return bind(self.state)

    def _bound(self) -> Any:
        if self._handle is None:
            self._handle = bind(Handle(self.rules, self._all()))
        return self._handle

    def _all(self) -> GameState:
        return GameState(self.state, self.episodes, self.memory, self.held, self.counters, self._start, self.results)

    def note_cut(self, world: int) -> None:
        """Let `end_info` tell of a world's episode as one that was cut by time, though its state goes on."""
        interpreted(close_books)(self._all(), world)
        self.results.ended[world]["end"] = TIME_LIMIT

    def step(self, actions: npt.ArrayLike) -> int:
        """One step of every world; returns how many episodes ended.

        actions: as `game.actions` says. Raises ValueError, before anything moves, for another shape or type, NaN,
        infinity, or no such action.
        """
        controls = self.game.actions.controls(_as_array(actions), self.worlds)
        if len(self._borders) == 2:
            ended = step_worlds(self._bound(), controls, self.autoreset, 0, self.worlds)
        else:
            step = partial(step_worlds, self._bound(), controls, self.autoreset)
            own, *others = pairwise(self._borders)
            played = [self._pool().submit(step, *borders) for borders in others]
            ended = step(*own) + sum(slice_.result() for slice_ in played)
        if ended < 0:
            world, j = np.argwhere(~np.isfinite(controls))[0].tolist()
            place = f"{world}, {j}" if controls.shape[1] > 1 else f"{world}"
            raise ValueError(f"actions[{place}] = {controls[world, j]}: must be finite")
        if ended:
            self._check_what_is_new()
        self._take_recording(stepped=True)
        return ended

    def _check_what_is_new(self) -> None:
        if self._unchecked:
            self._unchecked -= 1
            check_written(self.game, self.results.observations, self.counters)

    def _pool(self) -> ThreadPoolExecutor:
        """The threads beside the one that calls: a forked child has a copy of the pool, but none of its threads."""
        if self._threads is None or self._process != os.getpid():
            self._threads, self._process = ThreadPoolExecutor(len(self._borders) - 2), os.getpid()
        return self._threads

    def clone(self, mask: Mask) -> States:
        """Return the states of the worlds of `mask`, with their streams of episodes and what the last step returned."""
        worlds = mask.nonzero()[0]
        return States(self._digest, self._rows.copied(worlds), self.episodes["end"][worlds] != RUNNING)

    def restore(self, states: States, mask: Mask) -> None:
        """Let the worlds of `mask` go on from `states`; raises ValueError as `check_states` does."""
        self.check_states(states, mask)
        self._rows.write(mask.nonzero()[0], np.ascontiguousarray(states.data))
        if self.recorder is not None and mask[self.recorder.world]:
            self.recorder.interrupt(self.state, self._origin(self.recorder.world))
        if self.game.owns_scenes:  # world w has row w of the tables for itself, wherever its state comes from
            self.state.worlds["scene"] = np.arange(self.worlds)

    def check_states(self, states: Any, mask: Mask) -> None:
        """Raise ValueError where `states` are not of an equal batch, a row for each world of `mask`.

        And, where worlds are reset in the step in which their episode ends, for states of episodes that have ended.
        """
        check_states_fit(self._digest, self._rows, int(np.count_nonzero(mask)), states)
        if self.autoreset == SAME_STEP and states.ended.any():
            raise ValueError("state of an episode that has ended: there is none to go on with in mode SAME_STEP")

    @cached_property
    def _rows(self) -> Rows:
        """All arrays with a row for each world that steps read."""
        results = (array for name, array in zip(Results._fields, self.results, strict=True) if name != "busy")
        arrays = (
            *moving_arrays(self.state),
            *self._written,
            self.episodes,
            self.memory,
            self.held,
            self.counters,
            *results,
        )
        return Rows([array for array in arrays if array is not None and array.size])

    @cached_property
    def _digest(self) -> str:
        """Of all that a state belongs to: who looks ahead clones and restores before every step."""
        game = self.game
        text = repr((type(game).__module__, type(game).__qualname__, game.scenes, replace(game.options, scene=None)))
        return hashlib.sha256(text.encode()).hexdigest()

    def end_info(self, ended: Array) -> dict[str, Array]:
        """Return what is said of the episodes that ended in the last step, in the worlds `ended` (indices).

        Of shape (worlds,) each; 0 or None of the other worlds.
        """
        books, counted = self.results.ended, self.results.counted
        reasons = np.empty(self.worlds, object)  # of None
        reasons[ended] = _END_REASONS[books["end"][ended]]
        return {
            "end_reason": reasons,
            **{name: _counts(name, counted[:, j]) for j, name in enumerate(self.game.counters)},
            "bounces": books["bounces"].copy(),
            "speed_capped": books["speed_capped"].copy(),
            "game_seconds": books["seconds"].copy(),
        }

    def view(self, world: int) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
        """Balls (1, 4): x, y [m], vx, vy [m/s], and the ends of the parts' cores (m, 4) [m] of a world now."""
        parts = self.state.parts
        balls, cores = np.empty((1, 4)), np.empty((0 if parts is None else parts.shape[1], 4))
        view(self.bound_state, world, balls, cores)
        return balls, cores

    @property
    def levels(self) -> npt.NDArray[np.int64] | None:
        """The level that each world plays, (worlds,); None where the game has none."""
        return self.episodes["level"].copy() if self.game.has_levels else None

    def scene(self, world: int) -> Scene:
        """Return the scene that a world plays now."""
        scene = self.game.scene_on(None if self.levels is None else int(self.levels[world]))
        centres = self.target_places(np.array([world]))[0].tolist()
        places = dict(zip(self.game.targets, map(tuple, centres), strict=True))
        elements = (
            replace(e, center=places[i]) if i in places and isinstance(e, Sensor) else e
            for i, e in enumerate(scene.elements)
        )
        return replace(scene, elements=tuple(elements)) if places else scene

    def status(self, world: int) -> tuple[str, ...]:
        """Return what a player of a world wants to know beside picture and score, in words."""
        return self.game.status(self.episodes[world], None if self.memory is None else self.memory[world])

    def target_places(self, worlds: npt.NDArray[np.intp]) -> npt.NDArray[np.float64]:
        """Return the centres of the game's `targets` in some worlds (n,) now, (n, targets, 2) [m]."""
        if not self.game.targets or self.state.circle_sensors is None:
            return np.zeros((len(worlds), 0, 2))
        rings = self.state.circle_sensors[self.state.worlds["scene"][worlds]]
        rows = [int(np.flatnonzero(rings["element"][0] == index)[0]) for index in self.game.targets]
        return np.stack([rings["x"][:, rows], rings["y"][:, rows]], axis=2)

    def close(self) -> None:
        """End the threads."""
        if self._threads is not None and self._process == os.getpid():
            self._threads.shutdown()
        self._threads = None


def _counts(name: str, counts: Array) -> Array:
    """Return a copy of what a game has counted as what it is by its name: points, whether, or how many."""
    if name.startswith("points_"):
        return counts.copy()
    return counts.astype(np.bool_ if name.startswith("is_") else np.int64)


def _as_array(actions: Any) -> Array:
    try:
        return np.asarray(actions)
    except ValueError:  # NumPy's, of rows that differ in length
        raise ValueError(f"actions = {shown(actions)}: must be an array, with rows of one length") from None
