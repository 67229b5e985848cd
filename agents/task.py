"""What is played: an environment id and its keyword arguments."""

import inspect
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import gymnasium as gym
from gymnasium.envs.registration import load_env_creator

from agents.command import Refused
from bounce_env.registration import ENTRIES
from bounce_env.sb3 import BounceVecEnv

ENV_IDS = tuple(entry.id for entry in ENTRIES)


@dataclass(frozen=True)
class Task:
    """An environment. `env_kwargs` are JSON-able; raises Refused for an unknown id and for what the environment refuses."""

    env_id: str
    env_kwargs: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.env_id not in ENV_IDS:
            raise Refused(f"env_id = {self.env_id!r}: must be one of {', '.join(ENV_IDS)}")
        try:
            self.single().close()
            self.batch(1).close()
        except (TypeError, ValueError, OSError) as error:
            raise Refused(f"{self.env_id}: env_kwargs = {dict(self.env_kwargs)}: {error}") from None

    @property
    def resolved_kwargs(self) -> dict[str, Any]:
        """The keyword arguments, with the defaults of the id and of its class."""
        parameters = inspect.signature(load_env_creator(str(gym.spec(self.env_id).entry_point))).parameters
        defaults = {name: p.default for name, p in parameters.items() if p.default is not p.empty}
        return {**defaults, **gym.spec(self.env_id).kwargs, **self.env_kwargs}

    @property
    def action_space(self) -> gym.Space[Any]:
        """What a player may do."""
        return self.single().action_space

    def single(self, render_mode: str | None = None) -> gym.Env[Any, Any]:
        """One environment."""
        return gym.make(self.env_id, render_mode=render_mode, **self.env_kwargs)

    def batch(self, worlds: int) -> gym.vector.VectorEnv[Any, Any, Any]:
        """`worlds` environments, each reset in the step after its episode's end."""
        return gym.make_vec(
            self.env_id, num_envs=worlds, vectorization_mode="vector_entry_point", **self.env_kwargs
        )

    def for_sb3(self, worlds: int, seed: int) -> BounceVecEnv:
        """`worlds` environments to train in, with the seeds from `seed` on."""
        return BounceVecEnv(self.env_id, n_envs=worlds, seed=seed, **self.env_kwargs)
