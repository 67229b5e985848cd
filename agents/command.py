"""What the commands share: options that are JSON, and errors without a traceback."""

import inspect
import json
import sys
from collections.abc import Callable
from typing import Annotated, Any, TypeVar

import tyro
from tyro.constructors import PrimitiveConstructorSpec

Options = TypeVar("Options")


class Refused(ValueError):
    """What a user asked for cannot be done; the message says what was given and what is allowed."""


def check_range(name: str, value: float, low: float, high: float = float("inf")) -> None:
    """Raises Refused where an option is not from `low` to `high`."""
    if not low <= value <= high:
        raise Refused(f"--{name} {value}: must be {f'from {low} to {high}' if high < float('inf') else f'>= {low}'}")


def say(text: str) -> None:
    """Tell the user, at once even where the output is a file."""
    print(text, flush=True)  # noqa: T201 (a command talks to its user)


def _json_object(words: list[str]) -> dict[str, Any] | None:
    value = json.loads(words[0])  # its error is a ValueError, which tyro shows
    if not isinstance(value, dict | None):
        raise ValueError('must be a JSON object, such as {"frame_skip": 4}')
    return value


JsonObject = Annotated[
    dict[str, Any] | None,
    PrimitiveConstructorSpec(
        nargs=1,
        metavar="JSON",
        instance_from_str=_json_object,
        is_instance=lambda value: isinstance(value, dict | None),
        str_from_instance=lambda value: [json.dumps(value)],
    ),
]
"""An option given as a JSON object; null, or left out, for none."""


def run(command: Callable[[Options], int], options: type[Options]) -> None:
    """Read the options from the command line, run the command, and exit with what it returns; 2 when refused."""
    module = command.__module__ if command.__module__ != "__main__" else f"agents.{command.__name__}"
    given = tyro.cli(options, prog=f"python -m {module}", description=inspect.getdoc(command))
    try:
        sys.exit(command(given))
    except Refused as error:
        print(f"error: {error}", file=sys.stderr)  # noqa: T201
        sys.exit(2)
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)  # noqa: T201
        sys.exit(130)
