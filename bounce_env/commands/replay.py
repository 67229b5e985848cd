"""`replay`."""

import webbrowser
from pathlib import Path

from bounce_env.commands.cli import FINE, Refused, say
from bounce_env.replay import load_replay


def write_page(file: Path, output: Path | None, *, show: bool) -> int:
    """Write the page of a replay, and open it where that is asked for."""
    page = output or file.with_suffix(".html")
    if page.suffix != ".html":
        raise Refused(f"--output {page}: must end in .html")
    try:
        replay = load_replay(file)
    except OSError as error:
        raise Refused(f"{file}: cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise Refused(str(error)) from error
    try:
        replay.save(page)
    except OSError as error:
        raise Refused(f"--output {page}: cannot be written: {error.strerror}") from error
    say(str(page))
    if show and not webbrowser.open(page.resolve().as_uri()):
        say("no browser was found to open it")
    return FINE
