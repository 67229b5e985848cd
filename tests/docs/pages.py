"""The pages of README and site, and the snippets in them."""

import re
from pathlib import Path
from typing import NamedTuple

import bounce_env

ROOT = Path(bounce_env.__file__).parent.parent
DOCS = ROOT / "docs"

MADE = {"_build", "_made", "gallery"}
"""Folders of `docs` that building the site fills."""

PAGES = sorted(
    path
    for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "SECURITY.md", *DOCS.rglob("*.md"))
    if not MADE.intersection(path.relative_to(ROOT).parts)
)

_FENCE = re.compile(r"^(?P<fence>`{3,})(?P<language>[^\n`]*)\n(?P<code>.*?)^(?P=fence)\s*$", re.MULTILINE | re.DOTALL)


class Snippet(NamedTuple):
    """A fenced block of a page. line: of the page, at which its code begins."""

    language: str
    code: str
    line: int


def name_of(page: Path) -> str:
    """Return a page's path from the root on."""
    return page.relative_to(ROOT).as_posix()


def snippets(page: Path) -> list[Snippet]:
    """Return the fenced blocks of a page, in order."""
    text = page.read_text(encoding="utf-8")
    return [
        Snippet(found["language"].strip(), found["code"], text.count("\n", 0, found.start()) + 2)
        for found in _FENCE.finditer(text)
    ]


COMMAND = re.compile(
    r"^(?:\w+=\S+ )*(?:\.venv/bin/)?(?:bounce-env|python|make|pytest|git|pre-commit|pip)\b(?! = )[^\n]*$"
)


def commands(page: Path) -> list[str]:
    """Return the lines for a shell of a page: of its blocks without a language, and between backticks in its text."""
    text = page.read_text(encoding="utf-8")
    lines = [line for snippet in snippets(page) if snippet.language == "" for line in snippet.code.splitlines()]
    lines += re.findall(r"(?<!`)`([^`\n]+)`(?!`)", _FENCE.sub("", text))
    return [line.strip() for line in lines if COMMAND.match(line.strip())]
