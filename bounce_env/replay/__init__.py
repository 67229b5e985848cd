"""Replays: what happened in a world, exactly, in one HTML page that stands alone. docs/replay.md has the format."""

import html
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bounce_env.engine.recorded import Recorded
from bounce_env.files import replacing
from bounce_env.replay.document import document_of, text_of
from bounce_env.replay.format import read_document, read_replay
from bounce_env.replay.page import page_of

__all__ = ["Replay", "load_replay", "read_document", "replay_of"]


@dataclass(frozen=True, eq=False)
class Replay:
    """A run to look at: `save` writes the page, in a notebook it shows itself. document: see docs/replay.md."""

    document: Mapping[str, Any]

    @property
    def html(self) -> str:
        """The page, which loads nothing from elsewhere."""
        return page_of(self.document)

    @property
    def json(self) -> str:
        """The document alone."""
        return text_of(self.document)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the page, or the document alone where the path ends in .json; returns the path.

        Raises OSError where it cannot be written; what was there before is then still there.
        """
        path = Path(path)
        with replacing(path) as unfinished:
            unfinished.write_text(self.json if path.suffix == ".json" else self.html, encoding="utf-8")
        return path

    def _repr_html_(self) -> str:
        frame = 'width="100%" height="900" style="border: 0"'
        return f'<iframe sandbox="allow-scripts" {frame} srcdoc="{html.escape(self.html)}"></iframe>'


def replay_of(
    run: Recorded, *, score: Iterable[tuple[float, float]] = (), lost: int = 0, about: Mapping[str, Any] | None = None
) -> Replay:
    """Return the replay of a recorded run, as of `World.recorded`; docs/replay.md says what one is.

    score: from what time [s] on it was what. lost: how many events the recording had no room for. about: what made it,
    as `id`, `kwargs` and `seed` of an environment. Raises nothing.
    """
    return Replay(document_of(run, about=about, score=score, lost=lost))


def load_replay(path: str | os.PathLike[str]) -> Replay:
    """Return the replay in the file `path`, a page or a document alone, in the format of docs/replay.md.

    Raises OSError where it cannot be read, and ValueError for what is no replay.
    """
    return Replay(read_replay(Path(path)))
