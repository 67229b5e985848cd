"""Shared by the tests of the environments: the registry's variants, scripted actions, and equality to the bit."""

from itertools import product
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.vector import SyncVectorEnv, VectorEnv

from bounce_env.registration import ENTRIES

PADDLE, PINBALL, WALLS = "Bounce/Paddle-v0", "Bounce/Pinball-v0", "Bounce/Walls-v0"
MODES = ("NEXT_STEP", "SAME_STEP", "DISABLED")
KINDS = [
    {"action": action, "repeat_action_probability": p} for action, p in product(("continuous", "discrete"), (0.0, 0.25))
] + [
    {"action": "continuous", "repeat_action_probability": 0.25, "num_levels": 40},
    {"action": "continuous", "repeat_action_probability": 0.0, "reward": "dense"},
]
PINBALL_KINDS = [
    {"action": action, "repeat_action_probability": p} for action, p in product(("discrete", "buttons"), (0.0, 0.25))
]
WALLS_KINDS = [
    {"reward": reward, "repeat_action_probability": p} for reward, p in product(("sparse", "dense"), (0.0, 0.25))
]
KINDS_OF = {PADDLE: KINDS, PINBALL: PINBALL_KINDS, WALLS: WALLS_KINDS}
VARIANTS = [(entry.id, kwargs) for entry in ENTRIES for kwargs in KINDS_OF[entry.id]]


def name(value: object) -> str | None:
    """How pytest calls a variant's kwargs."""
    if isinstance(value, dict):
        sticky = "sticky" if value["repeat_action_probability"] else "plain"
        levels = "levels" if "num_levels" in value else None
        return "-".join(filter(None, (value.get("action"), value.get("reward"), sticky, levels)))
    return None


def make_env() -> gym.Env:
    """At the level of a module that imports little: a spawned worker finds it by its name."""
    return gym.make(PADDLE, time_limit=1.0)


def make_vec(num_envs: int, mode: str = "NEXT_STEP", env_id: str = PADDLE, **kwargs: Any) -> VectorEnv:
    """Our own vector environment."""
    return gym.make_vec(
        env_id, num_envs=num_envs, vectorization_mode="vector_entry_point", autoreset_mode=mode, **kwargs
    )


def make_sync(num_envs: int, mode: str, env_id: str = PADDLE, **kwargs: Any) -> SyncVectorEnv:
    """Gymnasium's vector environment over our single ones: the reference for ours."""
    mode = gym.vector.AutoresetMode[mode]
    return SyncVectorEnv([lambda: gym.make(env_id, **kwargs)] * num_envs, autoreset_mode=mode)


def scripted(space: gym.Space, steps: int, seed: int = 0) -> npt.NDArray[Any]:
    """Actions (steps, *space.shape) of a batched space, each held for 5 steps, so that a paddle gets somewhere."""
    rng = np.random.default_rng(seed)
    shape = (steps // 5 + 1, *space.shape)
    if isinstance(space, gym.spaces.MultiDiscrete):
        choices = rng.integers(0, space.nvec, shape)
    elif isinstance(space, gym.spaces.MultiBinary) or space.dtype == np.int8:
        choices = rng.integers(0, 2, shape, np.int8)
    else:
        choices = rng.uniform(-1.0, 1.0, shape).astype(np.float32)
    return np.repeat(choices, 5, axis=0)[:steps]


def assert_same(ours: Any, theirs: Any, where: str = "") -> None:
    """The same types, dtypes, shapes and bits, all the way down."""
    if isinstance(theirs, dict):
        assert ours.keys() == theirs.keys(), where
        for key, value in theirs.items():
            assert_same(ours[key], value, f"{where}[{key!r}]")
    elif isinstance(theirs, tuple | list):
        assert len(ours) == len(theirs), where
        for i, (one, other) in enumerate(zip(ours, theirs, strict=True)):
            assert_same(one, other, f"{where}[{i}]")
    elif isinstance(theirs, np.ndarray):
        assert isinstance(ours, np.ndarray), where
        assert (ours.dtype, ours.shape) == (theirs.dtype, theirs.shape), where
        if theirs.dtype == object:
            assert_same(ours.tolist(), theirs.tolist(), where)
        else:
            assert ours.tobytes() == theirs.tobytes(), f"{where}: {ours} is not {theirs}"
    else:
        assert type(ours) is type(theirs), where
        assert ours == theirs, where
