"""How the commands talk to their user, and what they refuse."""

import math
import sys

FINE, PROBLEMS, BAD_USAGE, INTERRUPTED = 0, 1, 2, 130


class Refused(ValueError):
    """What a user asked for cannot be done; the message says what was given and what is allowed."""


def check_range(option: str, value: float, low: float, high: float = math.inf) -> None:
    """Raises Refused where the value of `--option` is not from `low` to `high`."""
    if not low <= value <= high:
        allowed = f"from {low} to {high}" if high < math.inf else f">= {low}"
        raise Refused(f"--{option} {value}: must be {allowed}")


def say(text: str) -> None:
    """Tell the user, at once even where the output is a file."""
    print(text, flush=True)  # noqa: T201 (a command talks to its user)


def complain(text: str) -> int:
    """Say on stderr why nothing was done; returns the exit code for it."""
    print(f"error: {text}", file=sys.stderr)  # noqa: T201
    return BAD_USAGE
