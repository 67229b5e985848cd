"""What `play` and `watch` have in common: which game, and in which window."""

import time
from pathlib import Path
from typing import Any

import gymnasium as gym

from bounce_env.commands.cli import Refused, check_range
from bounce_env.registration import ENTRIES, games, short_name
from bounce_env.render.lazy_pygame import load_pygame
from bounce_env.render.window import display_problem
from bounce_env.window.film import Film
from bounce_env.wording import nearest

HEIGHT = 720
LARGEST_SEED = 2**32 - 1


def game_id(name: str) -> str:
    """Return the id of a game, given as it is or as its short name; of several versions the last in the table.

    Raises Refused for any other name.
    """
    names = games() | {entry.id: entry.id for entry in ENTRIES}
    if name not in names:
        raise Refused(f"game {name!r}: must be one of {', '.join(names)}{nearest(name, names)}")
    return names[name]


def made(env_id: str, kwargs: dict[str, Any]) -> gym.Env[Any, Any]:
    """The environment, for pictures as large as the window if no size is asked. Raises Refused where it cannot be."""
    if kwargs.get("width") is None and kwargs.get("height") is None:
        kwargs = {**kwargs, "height": HEIGHT}
    load_pygame()
    try:
        return gym.make(env_id, render_mode="rgb_array", disable_env_checker=True, **kwargs)
    except (TypeError, ValueError) as error:  # a scene that cannot be read or played, a size, an unknown keyword
        raise Refused(str(error).partition(" was raised from the environment creator")[0]) from error


def check_seed_and_folder(seed: int | None, films: Path) -> None:
    """Raises Refused for a seed that is none, and for a folder that is not there."""
    if seed is not None:
        check_range("seed", seed, 0, LARGEST_SEED)
    if not films.is_dir():
        raise Refused(f"--films {films}: must be a folder that is there")


def check_display(instead: str) -> None:
    """Raises Refused where no window can be seen; `instead` says what to do then."""
    problem = display_problem()
    if problem is not None:
        raise Refused(f"no window can be opened, {problem}; {instead}")


def new_film(folder: Path, env_id: str, size: tuple[int, int], fps: float) -> Film:
    """Return a film under a name that no other has: two may begin in one second."""
    stem = f"{short_name(env_id)}-{time.strftime('%Y%m%d-%H%M%S')}"
    path, number = folder / f"{stem}.mp4", 1
    while path.exists():
        number += 1
        path = folder / f"{stem}-{number}.mp4"
    return Film(path, size, fps)
