"""What a scene still lacks to be played as one of the games, and the line that plays it."""

from typing import Any

from gymnasium.envs.registration import load_env_creator

from bounce_env.games.game import Game
from bounce_env.registration import ENTRIES
from bounce_env.scene import Scene


def needs_of(scene: Scene) -> dict[str, str]:
    """Return for each game what the scene lacks, in words; "" where it is complete."""
    envs: dict[str, Any] = {entry.id: load_env_creator(entry.entry_point) for entry in ENTRIES}
    return {env_id: _need(env.game_type, scene) for env_id, env in envs.items()}


def _need(game_type: type[Game], scene: Scene) -> str:
    options: Any = game_type.options_type
    try:
        game_type(options(scene=scene))
    except ValueError as error:
        return str(error).split("\n", 1)[0]
    return ""


def line_to_copy(path: str, scene: Scene) -> str:
    """Return the line of Python that plays a saved scene: as a game that it is complete for, else in a `World`."""
    complete = [env_id for env_id, need in needs_of(scene).items() if not need]
    if complete:
        return f'gym.make("{complete[0]}", scene={path!r})'
    return f"World(load_scene({path!r}))"
