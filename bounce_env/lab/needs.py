"""What a scene still lacks to be played as one of the games, and the line that plays it."""

from typing import Any

from bounce_env.envs import PaddleEnv, PinballEnv, WallsEnv
from bounce_env.games.game import Game
from bounce_env.scene import Scene

_GAMES = {"Bounce/Paddle-v0": PaddleEnv, "Bounce/Pinball-v0": PinballEnv, "Bounce/Walls-v0": WallsEnv}


def needs_of(scene: Scene) -> dict[str, str]:
    """Return for each game what the scene lacks, in words; "" where it is complete."""
    return {env_id: _need(env.game_type, scene) for env_id, env in _GAMES.items()}


def _need(game_type: type[Game], scene: Scene) -> str:
    options: Any = game_type.options_type
    try:
        game_type(options(scene=scene))
    except ValueError as error:
        return str(error).split("\n", 1)[0]
    return ""


def line_to_copy(path: str, complete: list[str]) -> str:
    """Return the line of Python that plays a saved scene: as a game that it is complete for, else in a `World`."""
    if complete:
        return f'gym.make("{complete[0]}", scene={path!r})'
    return f"World(load_scene({path!r}))"
