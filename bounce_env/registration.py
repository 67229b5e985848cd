"""The one table of environments: id, both entry points and kwargs."""

from dataclasses import dataclass, field
from typing import Any

import gymnasium as gym


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
        entry_point="bounce_env.cards:PinballEnv",
        vector_entry_point="bounce_env.vector:PinballVectorEnv",
    ),
    Entry(
        "Bounce/Paddle-v0",
        entry_point="bounce_env.cards:PaddleEnv",
        vector_entry_point="bounce_env.vector:PaddleVectorEnv",
    ),
    Entry(
        "Bounce/Walls-v0",
        entry_point="bounce_env.cards:WallsEnv",
        vector_entry_point="bounce_env.vector:WallsVectorEnv",
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
