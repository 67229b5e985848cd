"""The vector environments: many worlds of one game in one batch, without a Python object per world."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from bounce_env.engine.recorded import Recorded
from bounce_env.envs.base import (
    BounceEnv,
    action_space,
    checked_render_mode,
    checked_seed,
    taken_snapshot,
    world_seed,
)
from bounce_env.envs.infos import checked_info, final_info, info_of_ends, info_of_worlds
from bounce_env.envs.keywords import HasKeywords
from bounce_env.envs.observations import Frames
from bounce_env.envs.one_world import OneWorld
from bounce_env.envs.recording import episode_replay, recorded_episode
from bounce_env.games import episode
from bounce_env.games.batch import Batch
from bounce_env.games.reset_options import checked_options, start_rows
from bounce_env.games.state_copy import States
from bounce_env.games.timing import NO_STEP_LIMIT
from bounce_env.render import Picture
from bounce_env.render.lazy_pygame import load_pygame
from bounce_env.replay import Replay
from bounce_env.scene import Scene
from bounce_env.wording import shown, whole

Observations = npt.NDArray[np.float32] | npt.NDArray[np.uint8]
Flags = npt.NDArray[np.bool_]
MOST_WORLDS = 10_000_000
MOST_THREADS = 1024
_AUTORESET = {
    AutoresetMode.NEXT_STEP: episode.NEXT_STEP,
    AutoresetMode.SAME_STEP: episode.SAME_STEP,
    AutoresetMode.DISABLED: episode.DISABLED,
}


class BounceVectorEnv(HasKeywords, VectorEnv[Observations, Any, npt.NDArray[Any]]):
    """A game as a Gymnasium vector environment.

    World i of a reset with `seed` plays, to the bit, what the single env plays after `reset(seed=seed + i)`. As all of
    Gymnasium's, it is for one thread of Python at a time; `num_threads` are its own.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 (Gymnasium's)
        "render_modes": ["rgb_array"],
        "render_fps": 30,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }
    own_keywords: ClassVar[Mapping[str, Any]] = {
        "num_envs": 1,
        "max_episode_steps": None,
        "num_threads": 1,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
        "copy": True,
        "info": "all",
        "render_mode": None,
    }

    def __init__(self, num_envs: int = 1, **keywords: Any) -> None:
        # What is quick to refuse first.
        own = {**self.own_keywords, **keywords}
        self.num_envs = whole("num_envs", num_envs, 1, MOST_WORLDS, f"a whole number >= 1, at most {MOST_WORLDS}")
        num_threads = whole(
            "num_threads", own["num_threads"], 1, MOST_THREADS, f"a whole number >= 1, at most {MOST_THREADS}"
        )
        mode = _autoreset_mode(own["autoreset_mode"])
        if not isinstance(own["copy"], bool):
            raise ValueError(f"copy = {shown(own['copy'])}: must be True or False")
        self._told = checked_info(own["info"])
        self.render_mode = checked_render_mode(own["render_mode"], self.metadata["render_modes"])
        steps = _steps(own["max_episode_steps"])
        game, view, _ = self.sorted_out(keywords)
        self.metadata = {**self.metadata, "render_fps": round(1.0 / game.step_seconds), "autoreset_mode": mode}
        if self.render_mode is not None or view.obs == "pixels":
            load_pygame()  # where it is missing, now and not after an episode
        # A frame of an episode's end is drawn before the world is reset: not by the kernel then, but after that.
        self._resets_late = view.obs == "pixels" and mode == AutoresetMode.SAME_STEP
        autoreset = episode.DISABLED if self._resets_late else _AUTORESET[mode]
        self._batch = Batch(game, self.num_envs, autoreset=autoreset, num_threads=num_threads)
        self._batch.limit_steps(steps)
        self._frames = Frames(self._batch, view)
        self.single_observation_space = self._frames.space
        self.single_action_space = action_space(game)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._mode = mode
        self._copy: bool = own["copy"]
        self._seeded = np.zeros(self.num_envs, np.bool_)
        self._begun = False
        self._ended = np.ones(self.num_envs, np.bool_)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observations, dict[str, Any]]:
        """Begin the next episode in all worlds, or in those of `options["reset_mask"]` (bool, one per world).

        seed: an int (world i gets seed + i) or one per world. Other options as for the single env, one for all or one
        row per world. Raises ValueError, and changes nothing, for what is not allowed.
        """
        if self.closed:
            raise gym.error.ClosedEnvironmentError("reset: the environment has been closed")
        mask, snapshot, start = self.checked_reset(seed, options)
        if snapshot is not None:
            return self.restore_state(snapshot, mask), self._reset_info(mask)
        self._seed_worlds(seed, mask)
        self._batch.reset(mask, start)
        self._frames.update(np.flatnonzero(mask).tolist())
        self._ended &= ~mask
        return self._observations(), self._reset_info(mask)

    def checked_reset(self, seed: Any, options: Any) -> tuple[Flags, States | None, npt.NDArray[np.float64]]:
        """Return what `seed` and `options` of a reset ask for, without doing it: mask, snapshot and starts.

        mask: (worlds,) bool. snapshot: states or None. starts: (worlds, 5), x, y [m], vx, vy [m/s] and the level; NaN
        for the seed's own. Raises ValueError where they are not allowed.
        """
        options = checked_options(options)
        mask = self._mask_of("options['reset_mask']", options.pop("reset_mask", None))
        snapshot, options = taken_snapshot(seed, options)
        if snapshot is not None:
            self._batch.check_states(snapshot, mask)
        return mask, snapshot, start_rows(self._batch.game, self.num_envs, options)

    def step(self, actions: Any) -> tuple[Observations, npt.NDArray[np.float64], Flags, Flags, dict[str, Any]]:
        """One step of every world: observations, rewards, terminated, truncated, info.

        Observations and `actions` are those of the card, with an axis for the worlds in front; rewards are (worlds,)
        float64, terminated and truncated (worlds,) bool.
        Mode DISABLED raises ResetNeeded while a finished world has not been reset.

        Raises ValueError for bad actions, before anything moves, and ClosedEnvironmentError after `close`.
        """
        if self.closed:
            raise gym.error.ClosedEnvironmentError("step: the environment has been closed")
        if self._mode == AutoresetMode.DISABLED and self._ended.any():
            finished = np.flatnonzero(self._ended)[:8].tolist()
            raise gym.error.ResetNeeded(
                f'worlds {finished} have ended: reset(options={{"reset_mask": ...}}) them first'
            )
        if not self._begun:
            raise gym.error.ResetNeeded("call reset() before step()")
        ended = self._batch.step(actions)
        r = self._batch.results
        rewards, terminated, truncated = r.rewards.copy(), r.terminated.copy(), r.truncated.copy()
        self._frames.update(range(self.num_envs))
        over = terminated | truncated
        info = self._info_of_ends(over) if ended else {}
        if self._told == "all":
            info |= info_of_worlds(self._batch)
        elif self._told == "ends" and ended and self._mode != AutoresetMode.SAME_STEP:  # there it is in final_info
            info |= info_of_worlds(self._batch, over)
        if self._mode == AutoresetMode.DISABLED:
            self._ended = over
        return self._observations(), rewards, terminated, truncated, info

    def render(self) -> tuple[npt.NDArray[np.uint8], ...] | None:
        """Return a frame per world in mode rgb_array, shape (height, width, 3), uint8, each number 0 to 255; else None.

        Raises ResetNeeded before the first reset.
        """
        if self.render_mode is None:
            gym.logger.warn('render() needs a render mode: gym.make_vec(..., render_mode="rgb_array")')
            return None
        if not self._seeded.all():
            raise gym.error.ResetNeeded("call reset() before render()")
        return tuple(self._frames.frame(w) for w in range(self.num_envs))

    def render_world(self, world: int) -> npt.NDArray[np.uint8] | None:
        """Return the frame of one world, shape (height, width, 3), uint8, each number 0 to 255; None without a mode.

        Raises ResetNeeded before its first reset.
        """
        if self.render_mode is None:
            return None
        if not self._seeded[world]:
            raise gym.error.ResetNeeded("call reset() before render()")
        return self._frames.frame(world)

    def scene_of(self, world: int) -> Scene:
        """Return the scene of the present episode of a world, 0 to num_envs - 1; raises IndexError for another."""
        return self._batch.scene(world)

    def status_of(self, world: int) -> tuple[str, ...]:
        """Return what a player of a world, 0 to num_envs - 1, wants to know beside picture and score, in words.

        Raises IndexError for another world.
        """
        return self._batch.status(world)

    @property
    def ended(self) -> npt.NDArray[Any]:
        """What is known of episodes that ended in the last step, a record for each world (`games.episode.BOOKS`)."""
        return self._batch.results.ended.copy()

    @property
    def autoreset_mode(self) -> AutoresetMode:
        """When a world whose episode has ended is reset."""
        return self._mode

    @cached_property
    def worlds(self) -> tuple[OneWorld, ...]:
        """Each world by itself, with the face of a single environment."""
        return tuple(OneWorld(self, w) for w in range(self.num_envs))

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple[Any, ...]:
        """Call the method `name` of every world with `args` and `kwargs`, or get an attribute; one result per world.

        What a world has: `bounce_env.envs.one_world.OneWorld`. Raises AttributeError for what it has not.
        """
        return tuple(called(world, name, *args, **kwargs) for world in self.worlds)

    def get_attr(self, name: str) -> tuple[Any, ...]:
        """Return the attribute `name` of every world; raises AttributeError for what a world has not."""
        return self.call(name)

    def set_attr(self, name: str, values: Any) -> None:
        """Set an attribute `name` of your own in every world: a list or tuple with one value per world, or one for all.

        Raises ValueError for another number of values, NotImplementedError for what environments have themselves.
        """
        each = values if isinstance(values, list | tuple) else [values] * self.num_envs
        if len(each) != self.num_envs:
            raise ValueError(f"values = {shown(values)}: must be {self.num_envs}, one per world, or one for all")
        for world, value in zip(self.worlds, each, strict=True):
            setattr(world, name, value)

    def picture(self, world: int) -> Picture:
        """Return what a frame of a world shows. Raises ResetNeeded before its first reset, ValueError for no world."""
        world = whole("world", world, 0, self.num_envs - 1)
        if not self._seeded[world]:
            raise gym.error.ResetNeeded("call reset() before picture()")
        return self._frames.picture(world)

    def clone_state(self, mask: Flags | None = None) -> States:
        """Return what the worlds of `mask` (bool, one per world; None for all) follow from; see the single env's.

        Raises ResetNeeded before the first reset.
        """
        if not self._begun:
            raise gym.error.ResetNeeded("call reset() before clone_state()")
        return self._batch.clone(self._mask_of("mask", mask))

    def restore_state(self, states: States, mask: Flags | None = None) -> Observations:
        """Let the worlds of `mask` go on from cloned states, one row each; returns all worlds' observations.

        Raises ValueError, and changes nothing, for states of another game, scene or options, or of another number.
        """
        rows = self._mask_of("mask", mask)
        self._batch.restore(states, rows)
        self._frames.restart(np.flatnonzero(rows).tolist())
        self._seeded |= rows
        self._begun = bool(self._seeded.all())
        self._ended[rows] = self._batch.episodes["end"][rows] != episode.RUNNING
        return self._observations()

    def record(self, world: int | None) -> None:
        """Keep all events of one world from its next episode on, for `replay`; None: of none any more.

        Raises ValueError for a world that there is not.
        """
        self._batch.record(None if world is None else whole("world", world, 0, self.num_envs - 1))

    def replay(self, *, last: bool = False) -> Replay:
        """Return the present episode of the recorded world as a replay; `last`: the one before it.

        Raises RuntimeError where that was not recorded.
        """
        return episode_replay(self._batch, self.spec, last=last)

    def recorded(self, *, last: bool = False) -> Recorded:
        """Return the same as the engine's run, with its ledger: for `ledger_table` and `plot_trajectory`.

        last: the episode before it. Raises RuntimeError as `replay` does.
        """
        return recorded_episode(self._batch, last=last)[1]

    def close_extras(self, **kwargs: Any) -> None:
        """End the threads; Gymnasium's `close` calls it. Raises nothing, and looks at none of `kwargs`."""
        self._batch.close()

    def _mask_of(self, name: str, mask: Any) -> Flags:
        if mask is None:
            return np.ones(self.num_envs, np.bool_)
        if not (isinstance(mask, np.ndarray) and mask.dtype == np.bool_ and mask.shape == (self.num_envs,)):
            raise ValueError(f"{name} = {shown(mask)}: must be a bool array of shape ({self.num_envs},)")
        if not mask.any():
            raise ValueError(f"{name}: must be True for at least one world")
        return mask.copy()  # it is handed out in info

    def _seed_worlds(self, seed: int | Sequence[int | None] | None, mask: Flags) -> None:
        """Seed the worlds of `mask` as the single env would: by their own seed, or once at random."""
        if isinstance(seed, np.ndarray):
            seed = seed.tolist()
        if isinstance(seed, Sequence) and not isinstance(seed, str | bytes):
            seeds = [checked_seed(f"seed[{w}]", each) for w, each in enumerate(seed)]
        else:
            first = checked_seed("seed", seed)
            if first is not None:
                self._np_random, self._np_random_seed = seeding.np_random(first)
            seeds = [None if first is None else first + w for w in range(self.num_envs)]
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed: must be one number, or {self.num_envs}, one per world; got {len(seeds)}")
        generators = {w: seeding.np_random(seeds[w])[0] for w in np.flatnonzero(mask).tolist() if seeds[w] is not None}
        generators |= {w: self.np_random for w in np.flatnonzero(mask & ~self._seeded).tolist() if seeds[w] is None}
        for w, generator in generators.items():
            self._batch.seed(w, world_seed(generator), seeds[w])
        self._seeded |= mask
        self._begun = bool(self._seeded.all())

    def _observations(self) -> Observations:
        observations = self._frames.observations
        return observations.copy() if self._copy else observations

    def _finals(self, ended: Flags) -> npt.NDArray[Any]:
        """Return the last observations of the episodes that have ended, of worlds that are reset in the same step."""
        seen = self._frames.observations if self._resets_late else self._batch.results.final_observations
        finals = np.full(self.num_envs, None, object)
        for w in np.flatnonzero(ended).tolist():
            finals[w] = seen[w].copy()
        return finals

    def _reset_info(self, mask: Flags) -> dict[str, Any]:
        return info_of_worlds(self._batch, mask) if self._told == "all" else {}

    def _info_of_ends(self, ended: Flags) -> dict[str, Any]:
        """Return what is said at the end of these episodes; where worlds are reset after the step, reset them."""
        if self._mode != AutoresetMode.SAME_STEP:
            return {} if self._told == "none" else info_of_ends(self._batch, ended)
        info = final_info(self._batch, ended, self._finals(ended), self._told)
        if self._resets_late:
            self._batch.reset(ended)
            self._frames.update(np.flatnonzero(ended).tolist())
        return info


def vector_env_of(single: type[BounceEnv]) -> type[BounceVectorEnv]:
    """Return the vector environment of the game of a single one: its card, its keywords, its name with Vector in it.

    The same one each time. Methods that the single environment's class overrides are not in it. See docs/own_game.md.
    Raises AttributeError for a class without `game_type`.
    """
    made: type[BounceVectorEnv] | None = single.__dict__.get("_vector_env")
    if made is None:
        name = single.__name__.removesuffix("Env") + "VectorEnv"
        members = {"__doc__": single.__doc__, "__module__": single.__module__, "game_type": single.game_type}
        made = type(name, (BounceVectorEnv,), members)
        single._vector_env = made
    return made


def called(world: OneWorld, name: str, *args: Any, **kwargs: Any) -> Any:
    """Return what a method of a world returns, or an attribute that is none."""
    attribute = getattr(world, name)
    return attribute(*args, **kwargs) if callable(attribute) else attribute


def _steps(limit: Any) -> int | None:
    # -1 is `gym.make`'s word for no limit.
    if limit is None or (isinstance(limit, int | np.integer) and limit == -1):
        return None
    return whole("max_episode_steps", limit, 1, NO_STEP_LIMIT, "None, -1 or a whole number >= 1, at most 2^62")


def _autoreset_mode(mode: AutoresetMode | str) -> AutoresetMode:
    for known in AutoresetMode:
        if isinstance(mode, AutoresetMode | str) and mode in (known, known.name, known.value):
            return known
    raise ValueError(f"autoreset_mode = {shown(mode)}: must be one of {', '.join(m.name for m in AutoresetMode)}")
