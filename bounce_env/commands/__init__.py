"""The package's command line: `python -m bounce_env scenes|play`."""

import sys
from collections.abc import Sequence

from gymnasium.error import DependencyNotInstalled

from bounce_env.commands.words import BAD_USAGE, INTERRUPTED, Refused, complain

EXTRAS = ("tyro", "tqdm", "imageio_ffmpeg")


def main(arguments: Sequence[str]) -> int:
    """Do what the words after `python -m bounce_env` say; returns the exit code.

    0: all is well. 1: problems were found. 2: what was asked for cannot be done, and a line on stderr says why.
    """
    try:
        from bounce_env.commands.options import read  # noqa: PLC0415 (tyro is an extra)

        return read(arguments).run()
    except ModuleNotFoundError as error:
        if error.name not in EXTRAS:
            raise
        return complain(f'the commands need {error.name}, which is not installed: pip install "bounce_env[cli]"')
    except (Refused, DependencyNotInstalled) as error:
        return complain(str(error))
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)  # noqa: T201 (a command talks to its user)
        return INTERRUPTED


__all__ = ["BAD_USAGE", "main"]
