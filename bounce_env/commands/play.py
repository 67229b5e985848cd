"""`play`."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from bounce_env.commands.options import Play
from bounce_env.commands.scenes import check_named
from bounce_env.commands.words import FINE, Refused, check_range, say
from bounce_env.lab.film import Film
from bounce_env.lab.keys import controls_for
from bounce_env.lab.play import play, prepare
from bounce_env.lab.session import Session
from bounce_env.registration import ENTRIES
from bounce_env.render.lazy_pygame import load_pygame

HEIGHT = 720
PATIENCE = 4.0  # seconds: twice what it takes to load kernels from disk
LARGEST_SEED = 2**32 - 1


def play_game(options: Play) -> int:
    """Open a window with the game, until the player quits."""
    env_id = game_id(options.game)
    env = _made(env_id, options)
    short = _short(env_id)
    seed = int(np.random.SeedSequence().generate_state(1)[0]) if options.seed is None else options.seed
    say(f"{env_id}, launches of seed {seed}")
    fps = float(env.metadata["render_fps"])

    def film() -> Film:
        height, width, _ = session.frame.shape
        return Film(_unused(options.films, f"{short}-{time.strftime('%Y%m%d-%H%M%S')}"), (width, height), fps)

    with _said_if_slow("compiling, about a minute: only where it is played for the first time"):
        prepare(env)
    session = Session(env, seed, film)
    try:
        play(session, env_id, fps, options.frames)
    except load_pygame().error as error:
        raise Refused(f"no window can be opened: {error}") from error
    finally:
        env.close()
    say(f"score {session.score:g}{f' ({session.end_reason})' if session.end_reason else ''}")
    if session.message:
        say(session.message)
    return FINE


@contextmanager
def _said_if_slow(words: str) -> Iterator[None]:
    """Say why it takes long, where it does: whether all kernels are on disk is not known before they are loaded."""
    timer = threading.Timer(PATIENCE, say, [words])
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def game_id(name: str) -> str:
    """The id of a game, given as it is or as its short name; of several versions the last in the table.

    Raises Refused for any other name.
    """
    ids = {entry.id: entry.id for entry in ENTRIES}
    names = {_short(env_id): env_id for env_id in ids} | ids
    if name not in names:
        raise Refused(f"game {name!r}: must be one of {', '.join(names)}")
    return names[name]


def _short(env_id: str) -> str:
    """paddle for Bounce/Paddle-v0."""
    return env_id.removeprefix("Bounce/").rsplit("-v", 1)[0].lower()


def _made(env_id: str, options: Play) -> gym.Env[Any, Any]:
    """The environment, after everything that may be wrong has been looked at."""
    if options.seed is not None:
        check_range("seed", options.seed, 0, LARGEST_SEED)
    if options.frames is not None:
        check_range("frames", options.frames, 1)
    if not options.films.is_dir():
        raise Refused(f"--films {options.films}: must be a folder that is there")
    kwargs: dict[str, Any] = {"width": options.width, "height": options.height}
    if options.width is None and options.height is None:
        kwargs["height"] = HEIGHT
    if options.scene is not None:
        check_named(options.scene)
        kwargs["scene"] = options.scene
    load_pygame()
    try:
        env = gym.make(env_id, render_mode="rgb_array", frame_skip=1, disable_env_checker=True, **kwargs)
        controls_for(env.action_space)
    except ValueError as error:  # a scene that cannot be read or played, a size, an action space without keys
        raise Refused(str(error)) from error
    return env


def _unused(folder: Path, stem: str) -> Path:
    """A name that no film has: two may begin in one second."""
    path, number = folder / f"{stem}.mp4", 1
    while path.exists():
        number += 1
        path = folder / f"{stem}-{number}.mp4"
    return path
