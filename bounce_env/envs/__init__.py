"""The games as Gymnasium environments: a class a game, whose docstring is its card, and what they are made of.

For a game of your own: `BounceEnv`, with its `game_type` (see `bounce_env.games`), and `bounce_env.register`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bounce_env.envs.base import BounceEnv
    from bounce_env.envs.paddle import PaddleEnv, PaddleVectorEnv
    from bounce_env.envs.pinball import PinballEnv, PinballVectorEnv
    from bounce_env.envs.vector import BounceVectorEnv, vector_env_of
    from bounce_env.envs.walls import WallsEnv, WallsVectorEnv

_HOME = {
    "BounceEnv": "base",
    "BounceVectorEnv": "vector",
    "vector_env_of": "vector",
    **dict.fromkeys(("PaddleEnv", "PaddleVectorEnv"), "paddle"),
    **dict.fromkeys(("PinballEnv", "PinballVectorEnv"), "pinball"),
    **dict.fromkeys(("WallsEnv", "WallsVectorEnv"), "walls"),
}

__all__ = [
    "BounceEnv",
    "BounceVectorEnv",
    "PaddleEnv",
    "PaddleVectorEnv",
    "PinballEnv",
    "PinballVectorEnv",
    "WallsEnv",
    "WallsVectorEnv",
    "vector_env_of",
]


def __getattr__(name: str) -> Any:
    """Import a name when it is first asked for."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted(__all__)
