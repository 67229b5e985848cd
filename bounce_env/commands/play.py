"""`play`."""

from dataclasses import asdict

import numpy as np

from bounce_env.commands import games
from bounce_env.commands.cli import FINE, Refused, check_range, say
from bounce_env.commands.options import Play
from bounce_env.commands.scenes import check_named
from bounce_env.render.lazy_pygame import load_pygame
from bounce_env.window.film import Film
from bounce_env.window.keys import controls_for
from bounce_env.window.play import play, prepare
from bounce_env.window.session import Session

NO_KEYWORDS = ("game", "seed", "films", "frames")
"""The options that are not the environment's keywords."""


def play_game(options: Play) -> int:
    """Open a window with the game, until the player quits."""
    env_id = games.game_id(options.game)
    games.check_seed_and_folder(options.seed, options.films)
    if options.frames is not None:
        check_range("frames", options.frames, 1)
    if options.scene is not None:
        check_named(options.scene)
    games.check_display(f"on such a machine `bounce-env watch {options.game} --film FILE.mp4` shows an agent")
    env = games.made(env_id, keywords(options))
    try:
        controls_for(env.action_space)
    except ValueError as error:
        raise Refused(str(error)) from error
    seed = int(np.random.SeedSequence().generate_state(1)[0]) if options.seed is None else options.seed
    say(f"{env_id}, launches of seed {seed}")
    fps = float(env.metadata["render_fps"])

    def film() -> Film:
        height, width, _ = session.frame.shape
        return games.new_film(options.films, env_id, (width, height), fps)

    prepare(env)
    session = Session(env, seed, film, waits=options.frames is None)
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


def keywords(options: Play) -> dict[str, object]:
    """Return the environment's keywords among the options: those that were given, and what suits a person better."""
    given = {name: value for name, value in asdict(options).items() if name not in NO_KEYWORDS}
    given = {name: value for name, value in given.items() if value is not None and value is not False}
    if given.get("time_limit") == 0:
        given["time_limit"] = None
    if given.get("nudge"):
        given.setdefault("action", "buttons")  # a flipper may be held while the table is shoved
    return {"frame_skip": 1, **given}
