"""The package's command line: `bounce-env`, or `python -m bounce_env`."""

import sys
from collections.abc import Sequence

from gymnasium.error import DependencyNotInstalled

from bounce_env.commands.cli import BAD_USAGE, FINE, INTERRUPTED, Refused, complain, say
from bounce_env.extras import missing, version

EXTRAS = {
    **dict.fromkeys(("tyro", "tqdm", "imageio_ffmpeg"), "cli"),
    **dict.fromkeys(("mpmath", "matplotlib", "jinja2"), "report"),
    **dict.fromkeys(("starlette", "uvicorn", "websockets", "platformdirs"), "lab"),
}
"""Modules that commands cannot do without, and the extra that has each."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Do what the words after the program's name say; returns the exit code.

    0: all is well. 1: problems were found. 2: what was asked for cannot be done, and a line on stderr says why.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    try:
        if words == ["--version"]:
            say(f"bounce_env {version()}")
            return FINE
        if words == ["doctor"]:  # it tells what is missing, the extra that reads options included
            from bounce_env.commands.doctor import diagnose  # noqa: PLC0415

            return diagnose()
        from bounce_env.commands.options import read  # noqa: PLC0415 (tyro is an extra)

        return read(words).run()
    except ModuleNotFoundError as error:
        if error.name == "playwright":
            return complain("--benchmark needs Playwright: python -m pip install playwright")
        if error.name not in EXTRAS:
            raise
        return complain(str(missing(EXTRAS[error.name], error.name, "the commands need")))
    except (Refused, DependencyNotInstalled) as error:
        return complain(str(error))
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)  # noqa: T201 (a command talks to its user)
        return INTERRUPTED


__all__ = ["BAD_USAGE", "main"]
