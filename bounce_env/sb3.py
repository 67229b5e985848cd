"""A native Stable-Baselines3 VecEnv over the same batch: no wrapper, no Python object per world."""

from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.envs.registration import load_env_creator
from gymnasium.vector import AutoresetMode

from bounce_env.extras import missing

try:
    from stable_baselines3.common.vec_env import VecEnv
    from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvObs, VecEnvStepReturn
except ModuleNotFoundError as error:
    raise missing("sb3", str(error.name), "BounceVecEnv needs") from error

from bounce_env.envs.base import checked_seed
from bounce_env.envs.one_world import OneWorld, row_of
from bounce_env.envs.vector import BounceVectorEnv
from bounce_env.games.reset_options import checked_options
from bounce_env.games.state_copy import States
from bounce_env.wording import shown, whole

# SB3's rollouts need a reset in the same step and observations of their own.
_FIXED = ("autoreset_mode", "copy", "num_envs", "vectorization_mode")


class BounceVecEnv(VecEnv):
    """`n_envs` worlds of the environment `env_id` for SB3's algorithms.

    env_id: "Bounce/...", or an id of your own with one of its entry points; seed: of the first reset, as `seed()`
    sets it. Further keyword arguments are those of the environment (its card), and `num_threads`. Info holds what the
    card says, and at an episode's end the "episode" statistics that SB3's Monitor would add.
    Raises ValueError for another environment, and as the environment does.
    """

    def __init__(self, env_id: str, n_envs: int = 1, *, seed: int | None = None, **kwargs: Any) -> None:
        for name in sorted(set(_FIXED).intersection(kwargs)):
            raise ValueError(f"{name} = {kwargs[name]!r}: must be left out, BounceVecEnv sets it")
        if not isinstance(env_id, str):
            raise ValueError(f"env_id = {shown(env_id)}: must be the id of an environment")
        n_envs = whole("n_envs", n_envs, 1)
        entry_point = gym.spec(env_id).vector_entry_point
        creator = load_env_creator(entry_point) if isinstance(entry_point, str) else entry_point
        if creator is None or (isinstance(creator, type) and not issubclass(creator, BounceVectorEnv)):
            raise ValueError(f"env_id = {shown(env_id)}: must be an environment of bounce_env")
        envs = gym.make_vec(
            env_id,
            num_envs=n_envs,
            vectorization_mode="vector_entry_point",
            autoreset_mode=AutoresetMode.SAME_STEP.name,
            **kwargs,
        )
        if not isinstance(envs.unwrapped, BounceVectorEnv):
            raise ValueError(f"env_id = {shown(env_id)}: must be an environment of bounce_env")
        self._envs: BounceVectorEnv = envs.unwrapped
        self._actions: Any = None
        super().__init__(n_envs, envs.single_observation_space, envs.single_action_space)
        self.metadata = envs.metadata
        self.spec = envs.spec
        if checked_seed("seed", seed) is not None:
            self.seed(seed)

    def reset(self) -> VecEnvObs:
        """Begin an episode in every world; seeds of `seed()` are used once, then the streams go on."""
        seeds = self._seeds if any(seed is not None for seed in self._seeds) else None
        groups = self._option_groups()  # most often one: those who have options of the same names are reset together
        for options in groups:
            self._envs.checked_reset(seeds, options)  # all of them before any world is reset
        for options in groups:
            observations, info = self._envs.reset(seed=seeds, options=options)
            for w in np.flatnonzero(options["reset_mask"]).tolist():
                self.reset_infos[w] = row_of(info, w)
        self._reset_seeds()
        self._reset_options()
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        """Keep the actions for `step_wait`."""
        self._actions = actions

    def step_wait(self) -> VecEnvStepReturn:
        """One step of every world. Rewards float32; a finished world is reset, its last observation is in its info."""
        observations, rewards, terminated, truncated, info = self._envs.step(self._actions)
        dones = terminated | truncated
        infos: list[dict[str, Any]] = self._rows(info)
        ended = self._envs.ended if dones.any() else None
        for w in np.flatnonzero(dones).tolist():
            self.reset_infos[w] = infos[w]
            infos[w] = row_of(info["final_info"], w) if "final_info" in info else {}
            infos[w]["terminal_observation"] = info["final_obs"][w]
            infos[w]["TimeLimit.truncated"] = bool(truncated[w] and not terminated[w])
            assert ended is not None
            infos[w]["episode"] = {
                "r": round(float(ended["rewards"][w]), 6),  # as Monitor does
                "l": int(ended["steps"][w]),
                "t": ended["seconds"].item(w),
            }
        return observations, rewards.astype(np.float32), dones, infos

    def close(self) -> None:
        """End the threads."""
        self._envs.close()

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """Return the attribute `attr_name` of the worlds of `indices`; AttributeError for what a world has not."""
        return [getattr(world, attr_name) for world in self._worlds(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Set an attribute `attr_name` of your own to `value` in the worlds of `indices`.

        Raises NotImplementedError for what environments have themselves.
        """
        for world in self._worlds(indices):
            setattr(world, attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: VecEnvIndices = None, **kwargs: Any) -> list[Any]:
        """Call the method `method_name` of the worlds of `indices`, and of no others, with `args` and `kwargs`.

        What a world has: `bounce_env.envs.one_world.OneWorld`. Raises AttributeError for what it has not.
        """
        return [getattr(world, method_name)(*args, **kwargs) for world in self._worlds(indices)]

    def _worlds(self, indices: VecEnvIndices) -> list[OneWorld]:
        return [self._envs.worlds[w] for w in self._get_indices(indices)]

    def env_is_wrapped(
        self, wrapper_class: type[gym.Wrapper[Any, Any, Any, Any]], indices: VecEnvIndices = None
    ) -> list[bool]:
        """Return of the worlds of `indices` whether `wrapper_class` wraps them: never, but for SB3's Monitor."""
        from stable_baselines3.common.monitor import Monitor  # noqa: PLC0415

        return [wrapper_class is Monitor for _ in self._get_indices(indices)]

    def get_images(self) -> Sequence[np.ndarray | None]:
        """One frame per world."""
        frames: Iterable[np.ndarray] | None = self._envs.render()
        return [None] * self.num_envs if frames is None else list(frames)

    def _rows(self, info: dict[str, Any]) -> list[dict[str, Any]]:
        if "score" not in info:
            return [{} for _ in range(self.num_envs)]
        scores, balls = info["score"].tolist(), info["ball"].tolist()
        if "level" not in info:
            return [{"score": score, "ball": ball} for score, ball in zip(scores, balls, strict=True)]
        rows = zip(scores, balls, info["level"].tolist(), strict=True)
        return [{"score": score, "ball": ball, "level": level} for score, ball, level in rows]

    def _option_groups(self) -> list[dict[str, Any]]:
        """The options of `set_options` as the batch takes them, one dict for all worlds that have the same names."""
        given = [checked_options(options) for options in self._options]
        for options in given:
            if "reset_mask" in options:
                raise ValueError("options['reset_mask']: must be left out, a VecEnv resets every world")
        names = [frozenset(options) for options in given]
        return [self._rows_of(given, np.array([each == group for each in names])) for group in dict.fromkeys(names)]

    def _rows_of(self, given: list[dict[str, Any]], mask: npt.NDArray[np.bool_]) -> dict[str, Any]:
        """Return the options of the worlds of `mask`."""
        chosen = [given[w] for w in np.flatnonzero(mask).tolist()]
        names = list(chosen[0])
        if "snapshot" in names:
            others = {name: chosen[0][name] for name in names if name != "snapshot"}
            snapshots = States.joined([options["snapshot"] for options in chosen])
            return {**others, "snapshot": snapshots, "reset_mask": mask}
        # The rows of worlds that are not reset are not looked at, but must be some that are allowed.
        rows = [options if mask[w] else chosen[0] for w, options in enumerate(given)]
        return {**{name: [options[name] for options in rows] for name in names}, "reset_mask": mask}
