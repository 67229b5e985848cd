"""A native Stable-Baselines3 VecEnv over the same batch: no wrapper, no Python object per world."""

from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode
from stable_baselines3.common.vec_env import VecEnv
from stable_baselines3.common.vec_env.base_vec_env import VecEnvIndices, VecEnvObs, VecEnvStepReturn

from bounce_env.env import checked_seed
from bounce_env.one_world import OneWorld, row_of
from bounce_env.vector import BounceVectorEnv

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
        envs = gym.make_vec(
            env_id,
            num_envs=n_envs,
            vectorization_mode="vector_entry_point",
            autoreset_mode=AutoresetMode.SAME_STEP.name,
            **kwargs,
        )
        if not isinstance(envs.unwrapped, BounceVectorEnv):
            raise ValueError(f"env_id = {env_id!r}: must be an environment of bounce_env")
        self._envs: BounceVectorEnv = envs.unwrapped
        self._actions: Any = None
        super().__init__(n_envs, envs.single_observation_space, envs.single_action_space)
        self.metadata = envs.metadata
        self.spec = envs.spec
        self._lengths = np.zeros(n_envs, np.int64)
        self._returns = np.zeros(n_envs)
        if checked_seed("seed", seed) is not None:
            self.seed(seed)

    def reset(self) -> VecEnvObs:
        """Begin an episode in every world; seeds of `seed()` are used once, then the streams go on."""
        given = any(seed is not None for seed in self._seeds)
        observations, info = self._envs.reset(seed=self._seeds if given else None, options=self._option_rows())
        self._lengths[:] = 0
        self._returns[:] = 0.0
        self.reset_infos = self._rows(info)
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
        self._lengths += 1
        self._returns += rewards
        infos: list[dict[str, Any]] = self._rows(info)
        for w in np.flatnonzero(dones).tolist():
            self.reset_infos[w] = infos[w]
            final = info["final_info"]
            infos[w] = row_of(final, w)
            infos[w]["terminal_observation"] = info["final_obs"][w]
            infos[w]["TimeLimit.truncated"] = bool(truncated[w] and not terminated[w])
            infos[w]["episode"] = {
                "r": round(float(self._returns[w]), 6),  # as Monitor does
                "l": int(self._lengths[w]),
                "t": infos[w]["game_seconds"],
            }
            self._lengths[w], self._returns[w] = 0, 0.0
        return observations, rewards.astype(np.float32), dones, infos

    def close(self) -> None:
        """End the threads."""
        self._envs.close()

    def get_attr(self, attr_name: str, indices: VecEnvIndices = None) -> list[Any]:
        """An attribute of the worlds of `indices`, see `OneWorld`."""
        return [getattr(world, attr_name) for world in self._worlds(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: VecEnvIndices = None) -> None:
        """Set an attribute of your own in the worlds of `indices`; AttributeError for what environments have."""
        for world in self._worlds(indices):
            setattr(world, attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: VecEnvIndices = None, **kwargs: Any) -> list[Any]:
        """Call a method of the worlds of `indices`, and of no others; see `OneWorld`."""
        results = [getattr(world, method_name)(*args, **kwargs) for world in self._worlds(indices)]
        if method_name == "reset":
            for w in self._get_indices(indices):
                self._lengths[w], self._returns[w] = 0, 0.0
        return results

    def _worlds(self, indices: VecEnvIndices) -> list[OneWorld]:
        return [self._envs.worlds[w] for w in self._get_indices(indices)]

    def env_is_wrapped(
        self, wrapper_class: type[gym.Wrapper[Any, Any, Any, Any]], indices: VecEnvIndices = None
    ) -> list[bool]:
        """Whether there is a wrapper: never, except that episodes are monitored."""
        from stable_baselines3.common.monitor import Monitor  # noqa: PLC0415

        return [wrapper_class is Monitor for _ in self._get_indices(indices)]

    def get_images(self) -> Sequence[np.ndarray | None]:
        """One frame per world."""
        frames: Iterable[np.ndarray] | None = self._envs.render()
        return [None] * self.num_envs if frames is None else list(frames)

    def _rows(self, info: dict[str, Any]) -> list[dict[str, Any]]:
        told = [name for name in ("score", "ball", "level") if name in info]
        return [dict(zip(told, row, strict=True)) for row in zip(*(info[name].tolist() for name in told), strict=True)]

    def _option_rows(self) -> dict[str, Any]:
        """The options of `set_options`, one dict per world, as the batch takes them: one row per world."""
        names = self._options[0].keys()
        if any(options.keys() != names for options in self._options):
            raise ValueError("options: must have the same names in every world")
        return {name: [options[name] for options in self._options] for name in names}
