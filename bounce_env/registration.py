"""The one table of environments: id, both entry points and kwargs; and the way to register others."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import gymnasium as gym

if TYPE_CHECKING:
    from bounce_env.envs.base import BounceEnv


@dataclass(frozen=True)
class Entry:
    """One id. Strings, so that registering imports nothing; the kwargs are what the id adds to the class's defaults."""

    id: str
    entry_point: str
    vector_entry_point: str
    kwargs: dict[str, Any] = field(default_factory=dict)


ENTRIES = (
    Entry(
        "Bounce/Pinball-v0",
        entry_point="bounce_env.envs.pinball:PinballEnv",
        vector_entry_point="bounce_env.envs.pinball:PinballVectorEnv",
    ),
    Entry(
        "Bounce/Paddle-v0",
        entry_point="bounce_env.envs.paddle:PaddleEnv",
        vector_entry_point="bounce_env.envs.paddle:PaddleVectorEnv",
    ),
    Entry(
        "Bounce/Walls-v0",
        entry_point="bounce_env.envs.walls:WallsEnv",
        vector_entry_point="bounce_env.envs.walls:WallsVectorEnv",
    ),
)


def register_all() -> None:
    """Register every id that is not registered yet."""
    for entry in ENTRIES:
        if entry.id not in gym.registry:
            gym.register(
                entry.id,
                entry_point=entry.entry_point,
                vector_entry_point=entry.vector_entry_point,
                kwargs=entry.kwargs,
            )


def register(env_id: str, env: "type[BounceEnv]", **keywords: Any) -> None:
    """Register a game of your own for `gym.make`, `gym.make_vec` and `BounceVecEnv`.

    env_id: such as "Own/Game-v0". env: a subclass of BounceEnv with its `game_type`; its vector environment follows
    from it. keywords: of the game, in place of its defaults. Raises gymnasium.error.Error for a malformed id.
    """
    from bounce_env.envs.vector import vector_env_of  # noqa: PLC0415 (it compiles)

    gym.register(env_id, entry_point=env, vector_entry_point=vector_env_of(env), kwargs=keywords)
