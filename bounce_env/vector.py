"""The vector environments: many worlds of one game in one batch, without a Python object per world."""

from collections.abc import Sequence
from dataclasses import fields
from typing import Any, ClassVar, Literal

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from bounce_env.cards import PaddleEnv, PinballEnv, WallsEnv
from bounce_env.env import action_space, taken_snapshot, world_seed
from bounce_env.frames import Frames
from bounce_env.games import episode
from bounce_env.games.batch import Batch
from bounce_env.games.clone import States
from bounce_env.games.game import Game
from bounce_env.games.options import Options, PaddleOptions, PinballOptions, WallsOptions
from bounce_env.games.paddle import PaddleGame
from bounce_env.games.pinball import PinballGame
from bounce_env.games.start import start_rows
from bounce_env.games.walls import WallsGame
from bounce_env.render import Picture

Observations = npt.NDArray[np.float32] | npt.NDArray[np.uint8]
Flags = npt.NDArray[np.bool_]

_AUTORESET = {
    AutoresetMode.NEXT_STEP: episode.NEXT_STEP,
    AutoresetMode.SAME_STEP: episode.SAME_STEP,
    AutoresetMode.DISABLED: episode.DISABLED,
}


class BounceVectorEnv(VectorEnv[Observations, Any, npt.NDArray[Any]]):
    """A game as a Gymnasium vector environment.

    World i of a reset with `seed` plays, to the bit, what the single env plays after `reset(seed=seed + i)`.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 (Gymnasium's)
        "render_modes": ["rgb_array"],
        "render_fps": 30,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    game_type: ClassVar[type[Game]]
    options_type: ClassVar[type[Options]]

    def __init__(
        self,
        num_envs: int = 1,
        *,
        max_episode_steps: int | None = None,
        num_threads: int = 1,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        obs: Literal["state", "pixels"] = "state",
        render_mode: str | None = None,
        width: int | None = None,
        height: int | None = None,
        trail: float = 0.0,
        show_bounces: bool = False,
        **options: Any,
    ) -> None:
        for name, value in (("num_envs", num_envs), ("num_threads", num_threads)):
            if not _whole(value):
                raise ValueError(f"{name} = {value!r}: must be a whole number >= 1")
        if not isinstance(copy, bool):
            raise ValueError(f"copy = {copy!r}: must be True or False")
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode = {render_mode!r}: must be one of {[None, *self.metadata['render_modes']]}")
        # -1 is `gym.make`'s word for no limit.
        steps = None if max_episode_steps == -1 else max_episode_steps
        if steps is not None and not _whole(steps):
            raise ValueError(f"max_episode_steps = {steps!r}: must be None, -1 or a whole number >= 1")
        unknown = sorted(set(options) - {field.name for field in fields(self.options_type)})
        if unknown:
            raise TypeError(f"{type(self).__name__} got unexpected keyword arguments: {', '.join(unknown)}")
        game = self.game_type(self.options_type(**options)).with_step_limit(steps)
        mode = _autoreset_mode(autoreset_mode)
        self.metadata = {**self.metadata, "render_fps": round(1.0 / game.step_seconds), "autoreset_mode": mode}
        self.num_envs = int(num_envs)
        self.render_mode = render_mode
        # A frame of an episode's end is drawn before the world is reset: not by the kernel then, but after that.
        self._resets_late = obs == "pixels" and mode == AutoresetMode.SAME_STEP
        autoreset = episode.DISABLED if self._resets_late else _AUTORESET[mode]
        self._batch = Batch(game, self.num_envs, autoreset=autoreset, num_threads=int(num_threads))
        self._frames = Frames(self._batch, obs=obs, width=width, height=height, trail=trail, show_bounces=show_bounces)
        self.single_observation_space = self._frames.space
        self.single_action_space = action_space(game)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._mode = mode
        self._copy = copy
        self._seeded = np.zeros(self.num_envs, np.bool_)
        self._begun = False
        self._every = np.ones(self.num_envs, np.bool_)
        self._every.flags.writeable = False
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
        options = dict(options or {})
        mask = self._mask_of("options['reset_mask']", options.pop("reset_mask", None))
        snapshot, options = taken_snapshot(seed, options)
        if snapshot is not None:
            return self.restore_state(snapshot, mask), self._info(mask)
        start = start_rows(self._batch.game, self.num_envs, options)
        self._seed_worlds(seed, mask)
        self._batch.reset(mask, start)
        self._frames.update(np.flatnonzero(mask).tolist())
        self._ended[mask] = False
        return self._observations(), self._info(mask)

    def step(self, actions: Any) -> tuple[Observations, npt.NDArray[np.float64], Flags, Flags, dict[str, Any]]:
        """One step of every world. Mode DISABLED raises ResetNeeded while a finished world has not been reset."""
        if self._mode == AutoresetMode.DISABLED and self._ended.any():
            finished = np.flatnonzero(self._ended)[:8].tolist()
            raise gym.error.ResetNeeded(
                f'worlds {finished} have ended: reset(options={{"reset_mask": ...}}) them first'
            )
        if not self._begun:
            raise gym.error.ResetNeeded("call reset() before step()")
        ended = self._batch.step(np.asarray(actions))
        r = self._batch.results
        rewards, terminated, truncated = r.rewards.copy(), r.terminated.copy(), r.truncated.copy()
        over = terminated | truncated
        self._frames.update(range(self.num_envs))
        finals = self._finals(over) if ended and self._mode == AutoresetMode.SAME_STEP else None
        if ended and self._resets_late:
            self._batch.reset(over)
            self._frames.update(np.flatnonzero(over).tolist())
        info = self._info(self._every)
        if ended:
            self._tell_ends(info, over, finals)
        if self._mode == AutoresetMode.DISABLED:
            self._ended = over
        return self._observations(), rewards, terminated, truncated, info

    def render(self) -> tuple[npt.NDArray[np.uint8], ...] | None:
        """One frame (height, width, 3) per world in mode rgb_array."""
        if self.render_mode is None:
            gym.logger.warn('render() needs a render mode: gym.make_vec(..., render_mode="rgb_array")')
            return None
        if not self._seeded.all():
            raise gym.error.ResetNeeded("call reset() before render()")
        return tuple(self._frames.frame(w) for w in range(self.num_envs))

    def picture(self, world: int) -> Picture:
        """What a frame of a world shows now. Raises ResetNeeded before its first reset."""
        if not self._seeded[world]:
            raise gym.error.ResetNeeded("call reset() before picture()")
        return self._frames.picture(world)

    def clone_state(self, mask: Flags | None = None) -> States:
        """What the worlds of `mask` (bool, one per world; None for all) follow from; see the single env's.

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

    def close_extras(self, **kwargs: Any) -> None:
        """End the threads."""
        self._batch.close()

    def _mask_of(self, name: str, mask: Any) -> Flags:
        if mask is None:
            return np.ones(self.num_envs, np.bool_)
        if not (isinstance(mask, np.ndarray) and mask.dtype == np.bool_ and mask.shape == (self.num_envs,)):
            raise ValueError(f"{name} = {mask!r}: must be a bool array of shape ({self.num_envs},)")
        if not mask.any():
            raise ValueError(f"{name}: must be True for at least one world")
        return mask.copy()  # it is handed out in info

    def _seed_worlds(self, seed: int | Sequence[int | None] | None, mask: Flags) -> None:
        """Seed the worlds of `mask` as the single env would: by their own seed, or once at random."""
        if isinstance(seed, int | np.integer):
            self._np_random, self._np_random_seed = seeding.np_random(int(seed))
            seed = [int(seed) + i for i in range(self.num_envs)]
        if seed is None:
            seed = [None] * self.num_envs
        if len(seed) != self.num_envs:
            raise ValueError(f"seed: must be one number, or {self.num_envs}, one per world; got {len(seed)}")
        # All generators first: a seed that is not allowed raises before any world has changed.
        generators = {w: seeding.np_random(seed[w])[0] for w in np.flatnonzero(mask).tolist() if seed[w] is not None}
        generators |= {w: self.np_random for w in np.flatnonzero(mask & ~self._seeded).tolist() if seed[w] is None}
        for w, generator in generators.items():
            self._batch.seed(w, world_seed(generator))
        self._seeded |= mask
        self._begun = bool(self._seeded.all())

    def _observations(self) -> Observations:
        observations = self._frames.observations
        return observations.copy() if self._copy else observations

    def _finals(self, ended: Flags) -> npt.NDArray[Any]:
        """The last observations of the episodes that have ended, of worlds that are reset in the same step."""
        seen = self._frames.observations if self._resets_late else self._batch.results.final_observations
        finals = np.full(self.num_envs, None, object)
        for w in np.flatnonzero(ended).tolist():
            finals[w] = seen[w].copy()
        return finals

    def _info(self, mask: Flags) -> dict[str, Any]:
        told = {"score": self._batch.episodes["score"], "ball": self._batch.episodes["ball"]}
        if self._batch.levels is not None:
            told["level"] = self._batch.levels
        info: dict[str, Any] = {}
        for key, values in told.items():
            info[key], info[f"_{key}"] = np.where(mask, values, 0), mask
        return info

    def _tell_ends(self, info: dict[str, Any], ended: Flags, finals: npt.NDArray[Any] | None) -> None:
        """Add what is said at an episode's end, as Gymnasium's own vector envs do: arrays with masks."""
        told: dict[str, Any] = {}
        for key, values in self._batch.end_info().items():
            told[key], told[f"_{key}"] = values, ended
        if finals is None:
            info.update(told)
            return
        r = self._batch.results
        told |= {"score": r.ended["score"].copy(), "_score": ended}
        told |= {"ball": r.ended["ball"].copy(), "_ball": ended}
        if self._batch.game.has_levels:
            told |= {"level": r.ended["level"].copy(), "_level": ended}
        info.update(final_obs=finals, _final_obs=ended, final_info=told, _final_info=ended)


def _whole(value: Any) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool) and bool(value >= 1)


def _autoreset_mode(mode: AutoresetMode | str) -> AutoresetMode:
    for known in AutoresetMode:
        if mode in (known, known.name, known.value):
            return known
    raise ValueError(f"autoreset_mode = {mode!r}: must be one of {', '.join(m.name for m in AutoresetMode)}")


class PaddleVectorEnv(BounceVectorEnv):
    __doc__ = PaddleEnv.__doc__
    game_type = PaddleGame
    options_type = PaddleOptions


class PinballVectorEnv(BounceVectorEnv):
    __doc__ = PinballEnv.__doc__
    game_type = PinballGame
    options_type = PinballOptions


class WallsVectorEnv(BounceVectorEnv):
    __doc__ = WallsEnv.__doc__
    game_type = WallsGame
    options_type = WallsOptions
