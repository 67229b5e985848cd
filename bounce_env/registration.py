"""The one table of environments: id, both entry points and kwargs; and the way to register others."""

import sys
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

    @property
    def short_name(self) -> str:
        """paddle of Bounce/Paddle-v0."""
        return short_name(self.id)


def short_name(env_id: str) -> str:
    """Return how people call a game: paddle, for Bounce/Paddle-v0."""
    return env_id.removeprefix("Bounce/").rsplit("-v", 1)[0].lower()


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


def games() -> dict[str, str]:
    """Return the ids of the games by their short names; of several versions the last in the table."""
    return {entry.short_name: entry.id for entry in ENTRIES}


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

    env_id: such as "Own/Game-v0"; one that is there already is replaced, with Gymnasium's warning. env: a subclass of
    BounceEnv with its `game_type`; its vector environment plays the same game, but knows nothing of methods that the
    subclass overrides. The spec names both by their places, so that `spec.to_json()` works, where the class is at the
    top of a module. keywords: of the game, in place of its defaults.

    Raises TypeError for what is no such class and for an unknown keyword, gymnasium.error.Error for a malformed id.
    """
    from bounce_env.envs.base import BounceEnv  # noqa: PLC0415 (it compiles)
    from bounce_env.envs.vector import vector_env_of  # noqa: PLC0415
    from bounce_env.wording import shown, unknown_name  # noqa: PLC0415

    if not isinstance(env_id, str):
        raise TypeError(f"env_id = {shown(env_id)}: must be a string such as 'Own/Game-v0'")
    if not (isinstance(env, type) and issubclass(env, BounceEnv) and hasattr(env, "game_type")):
        raise TypeError(f"env = {shown(env)}: must be a subclass of BounceEnv with a game_type")
    for name in sorted(keywords.keys() - env.defaults().keys()):
        raise TypeError(f"{name} = {shown(keywords[name])}: {unknown_name(name, env.defaults(), 'keyword')}")
    vector = vector_env_of(env)
    module = sys.modules.get(env.__module__)
    if getattr(module, env.__name__, None) is env and not hasattr(module, vector.__name__):
        setattr(module, vector.__name__, vector)
    gym.register(env_id, entry_point=_place_of(env), vector_entry_point=_place_of(vector), kwargs=keywords)


def _place_of(env: type) -> Any:
    """Where a class is, as "module:name"; the class itself where it is not at the top of a module."""
    found = getattr(sys.modules.get(env.__module__), env.__name__, None)
    return f"{env.__module__}:{env.__name__}" if found is env else env
