"""What is played: an environment id and its keyword arguments."""

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.envs.registration import load_env_creator

from agents.command import Refused
from bounce_env.registration import ENTRIES
from bounce_env.sb3 import BounceVecEnv
from bounce_env.scene import Scene
from bounce_env.wording import nearest

Player = Callable[[npt.NDArray[np.float32]], npt.NDArray[Any]]
"""From observations (n, size) to actions (n, *shape of an action)."""

ENV_IDS = tuple(entry.id for entry in ENTRIES)

OWN_KEYWORDS = frozenset({"render_mode", "num_envs", "num_threads", "autoreset_mode", "copy", "max_episode_steps"})
"""Keywords that are set here, as the task needs them."""

HELD_OUT = 10_000
"""First seed of the episodes that evaluation plays; training takes its seeds from 2**32 on (`training_seed`)."""


def training_seed(seed: int, steps: int) -> int:
    """First environment seed of a training that begins, or goes on, after `steps` environment steps.

    seed: of the run, >= 0. Each run has 2**32 seeds of its own, beyond those that evaluation uses; a resumed one goes
    on in them, so that it does not meet the same episodes again.
    """
    return (seed + 1) * 2**32 + steps


@dataclass(frozen=True)
class Task:
    """An environment; `env_kwargs` are JSON-able.

    Raises Refused for an unknown id, and for keyword arguments that the environment refuses.
    """

    env_id: str
    env_kwargs: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.env_id not in ENV_IDS:
            hint = nearest(self.env_id, ENV_IDS)
            raise Refused(f"env_id = {self.env_id!r}: must be one of {', '.join(ENV_IDS)}{hint}")
        for name in sorted(OWN_KEYWORDS.intersection(self.env_kwargs)):
            raise Refused(f"{self.env_id}: env_kwargs: {name} = {self.env_kwargs[name]!r}: must be left out here")
        try:
            self.single().close()
            self.batch(1).close()
        except (TypeError, ValueError) as error:
            words = str(error).partition(" was raised from the environment creator")[0]
            lines = [f"{self.env_id}: env_kwargs: {line}" for line in words.split("\n")]
            raise Refused("\n".join(lines)) from None

    @property
    def resolved_kwargs(self) -> dict[str, Any]:
        """The keyword arguments, with the defaults of the id and of its class."""
        spec = gym.spec(self.env_id)
        parameters = inspect.signature(load_env_creator(str(spec.entry_point))).parameters
        return {name: p.default for name, p in parameters.items()} | spec.kwargs | dict(self.env_kwargs)

    @property
    def scene(self) -> Scene:
        """What is played on; of a game with levels the first of them."""
        scene: Scene = self.single().unwrapped.scene
        return scene

    @property
    def counted(self) -> str:
        """What the score counts, in words."""
        words: str = load_env_creator(str(gym.spec(self.env_id).entry_point)).game_type.counted  # type: ignore[attr-defined]
        return words

    @property
    def observation_space(self) -> gym.Space[Any]:
        """What a player sees."""
        return self.single().observation_space

    @property
    def action_space(self) -> gym.Space[Any]:
        """What a player may do."""
        return self.single().action_space

    def single(self, **more: Any) -> gym.Env[Any, Any]:
        """One environment, with more keywords than the task's."""
        return gym.make(self.env_id, **more, **self.env_kwargs)

    def batch(self, worlds: int) -> gym.vector.VectorEnv[Any, Any, Any]:
        """`worlds` environments; each is reset in the step after the end of its episode."""
        return gym.make_vec(self.env_id, num_envs=worlds, vectorization_mode="vector_entry_point", **self.env_kwargs)

    def for_sb3(self, worlds: int, seed: int) -> BounceVecEnv:
        """`worlds` environments to train in, with the seeds from `seed` on."""
        return BounceVecEnv(self.env_id, n_envs=worlds, seed=seed, **self.env_kwargs)
