"""The one place that imports pygame: late, silently, and with advice where it is missing."""

import importlib
import os
from types import ModuleType

from bounce_env.extras import missing


def load_pygame() -> ModuleType:
    """Import pygame without its banner and return it.

    Raises MissingExtraError, which is `gymnasium.error.DependencyNotInstalled`, where it is not installed.
    """
    os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
    # SDL would take SIGTERM for a click on a window's close button, and `kill` would no longer end a program.
    os.environ.setdefault("SDL_NO_SIGNAL_HANDLERS", "1")
    try:
        return importlib.import_module("pygame")
    except ImportError as error:
        raise missing("render", "pygame", "drawing needs") from error
