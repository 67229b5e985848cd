"""Writing files so that whoever looks sees the old one or the new one, never half of one."""

from pathlib import Path

from bounce_env.files import replacing

__all__ = ["replacing", "write_text"]


def write_text(path: Path, text: str) -> None:
    """Write a text file; see `replacing`."""
    with replacing(path) as unfinished:
        unfinished.write_text(text, encoding="utf-8")
