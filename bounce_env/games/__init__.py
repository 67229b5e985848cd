"""The games, and what a game of your own is made of; docs/own_game.md shows how, tests/env/own_game.py is one.

A game is a subclass of `Game` with the class of its `Options`, and a named tuple of rules for which `define_game` names
the functions that the kernel calls; these are compiled by `function`, and build on what is listed here.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bounce_env.engine.compile.jit import function
    from bounce_env.engine.events.commands import command, command_ends, command_flipper, full_speed
    from bounce_env.engine.events.flights import disturb, place
    from bounce_env.engine.events.loop import DONE, clear_hits, restart, resume, run
    from bounce_env.engine.memory.records import OUT
    from bounce_env.engine.motion.readout import ball_now, core_now, offset_now, stroke_now
    from bounce_env.games.actions import Buttons, Continuous, Discrete, clipped
    from bounce_env.games.episode import (
        ALL_PLAYED,
        DRAINED,
        OUT_OF_BUDGET,
        RUNNING,
        TIME_LIMIT,
        GameState,
        begin_episode,
        hold_action,
    )
    from bounce_env.games.game import Game
    from bounce_env.games.observed import Observed
    from bounce_env.games.options import CONFIG, Options, TimeLimit, options_class
    from bounce_env.games.rules import define_game
    from bounce_env.games.streams import LAUNCHES, uniform
    from bounce_env.games.timing import Pace, out_of_time, pace_of

_HOME = {
    "engine.compile.jit": ("function",),
    "engine.events.commands": ("command", "command_ends", "command_flipper", "full_speed"),
    "engine.events.flights": ("disturb", "place"),
    "engine.events.loop": ("DONE", "clear_hits", "restart", "resume", "run"),
    "engine.memory.records": ("OUT",),
    "engine.motion.readout": ("ball_now", "core_now", "offset_now", "stroke_now"),
    "games.actions": ("Buttons", "Continuous", "Discrete", "clipped"),
    "games.episode": (
        "ALL_PLAYED",
        "DRAINED",
        "OUT_OF_BUDGET",
        "RUNNING",
        "TIME_LIMIT",
        "GameState",
        "begin_episode",
        "hold_action",
    ),
    "games.game": ("Game",),
    "games.observed": ("Observed",),
    "games.options": ("CONFIG", "Options", "TimeLimit", "options_class"),
    "games.rules": ("define_game",),
    "games.streams": ("LAUNCHES", "uniform"),
    "games.timing": ("Pace", "out_of_time", "pace_of"),
}
_HOME_OF = {name: f"bounce_env.{module}" for module, names in _HOME.items() for name in names}

__all__ = [
    "ALL_PLAYED",
    "CONFIG",
    "DONE",
    "DRAINED",
    "LAUNCHES",
    "OUT",
    "OUT_OF_BUDGET",
    "RUNNING",
    "TIME_LIMIT",
    "Buttons",
    "Continuous",
    "Discrete",
    "Game",
    "GameState",
    "Observed",
    "Options",
    "Pace",
    "TimeLimit",
    "ball_now",
    "begin_episode",
    "clear_hits",
    "clipped",
    "command",
    "command_ends",
    "command_flipper",
    "core_now",
    "define_game",
    "disturb",
    "full_speed",
    "function",
    "hold_action",
    "offset_now",
    "options_class",
    "out_of_time",
    "pace_of",
    "place",
    "restart",
    "resume",
    "run",
    "stroke_now",
    "uniform",
]


def __getattr__(name: str) -> Any:
    """Import a name when it is first asked for."""
    if name not in _HOME_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME_OF[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
