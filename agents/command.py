"""What the commands share: options that are JSON, and errors without a traceback."""

import json
import sys
from collections.abc import Callable
from typing import Annotated, Any, TypeVar

import tyro
from tyro.constructors import PrimitiveConstructorSpec


Options = TypeVar("Options")


class Refused(ValueError):
    """What a user asked for cannot be done; the message says what was given and what is allowed."""


def _json_object(words: list[str]) -> dict[str, Any]:
    try:
        value = json.loads(words[0])
    except json.JSONDecodeError as error:
        raise ValueError(f"not JSON: {error}") from None
    if not isinstance(value, dict):
        raise ValueError('must be a JSON object, such as {"frame_skip": 4}')
    return value


JsonObject = Annotated[
    dict[str, Any],
    PrimitiveConstructorSpec(
        nargs=1,
        metavar="JSON",
        instance_from_str=_json_object,
        is_instance=lambda value: isinstance(value, dict),
        str_from_instance=lambda value: [json.dumps(value)],
    ),
]
"""An option given as a JSON object."""


def run(command: Callable[[Options], int], options: type[Options], module: str) -> None:
    """Read the options from the command line, run the command, and exit: 0 when done, 2 when refused."""
    given = tyro.cli(options, prog=f"python -m agents.{module}", description=command.__doc__)
    try:
        sys.exit(command(given))
    except Refused as error:
        print(f"error: {error}", file=sys.stderr)  # noqa: T201 (a command talks to its user)
        sys.exit(2)
