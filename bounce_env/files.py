"""Writing files so that whoever looks sees the old one or the new one, never half of one; and telling them apart."""

import hashlib
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Gives a path beside `path`, with the same suffix, to write to; renames it to `path` when that went well.

    When it did not, nothing is left. The name is always the same: what a killed process leaves there is overwritten by
    the next one.
    """
    unfinished = path.with_name(f".{path.stem}-unfinished{path.suffix}")
    unfinished.unlink(missing_ok=True)  # it could be a link that leads elsewhere
    try:
        yield unfinished
        with unfinished.open("rb") as file:
            os.fsync(file.fileno())
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)


def hash_of_files(files: Iterable[Path], folder: Path | None = None) -> str:
    """Return the SHA-256 over files, by their content and their place: in `folder`, or anywhere."""
    digest = hashlib.sha256()
    for path in sorted(files):
        digest.update((path if folder is None else path.relative_to(folder)).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()
