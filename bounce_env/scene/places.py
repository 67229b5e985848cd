"""Where in a TOML file its values stand: `tomllib` reads them, but does not tell.

Only for files that `tomllib` has read, which are known to be TOML: nothing is checked here.
"""

import re
import tomllib
from bisect import bisect_left
from typing import NamedTuple

from bounce_env.scene.errors import Location


class Place(NamedTuple):
    """The line, from 1 on, of a key or header, and the value as it is written there; None for a table."""

    line: int
    literal: str | None


_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_BREAK = re.compile(r"\s*\r?\n\s*")
_KEY = re.compile(r'"(?:\\.|[^"\\])*"|\'[^\']*\'|[A-Za-z0-9_-]+')
_TEXT = re.compile(
    r'"""(?:\\.|[^\\])*?"""(?:"{0,2})|\'\'\'.*?\'\'\'(?:\'{0,2})|"(?:\\.|[^"\\])*"|\'[^\']*\'', re.DOTALL
)
_BARE = re.compile(r"[^,\]}#\r\n]*")


def places_of(text: str) -> dict[Location, Place]:
    """Return the place of every table and value of a TOML file, by its location: ("elements", 3, "radius")."""
    return _Reader(text).places


class _Reader:
    """Goes through a file once, from statement to statement."""

    def __init__(self, text: str) -> None:
        self.places: dict[Location, Place] = {}
        self._text = text
        self._at = 0
        self._breaks = [i for i, letter in enumerate(text) if letter == "\n"]
        self._counts: dict[Location, int] = {}  # of tables in each array of tables
        table: Location = ()
        self._skip_blank()
        while self._at < len(text):
            table = self._statement(table)
            self._skip_blank()

    def _statement(self, table: Location) -> Location:
        """Read a header or an assignment; returns the table that the next one belongs to."""
        line = self._line()
        if self._text.startswith("[[", self._at):
            path = self._header(2)
            count = self._counts[path] = self._counts.get(path, 0) + 1
            path = (*path, count - 1)
        elif self._text.startswith("[", self._at):
            path = self._header(1)
        else:
            self._assignment(table)
            return table
        self.places[path] = Place(line, None)
        return path

    def _header(self, brackets: int) -> Location:
        self._at += brackets
        keys = self._keys()
        self._at += brackets
        path: Location = ()
        for key in keys[:-1]:
            path = (*path, key)
            if path in self._counts:
                path = (*path, self._counts[path] - 1)
        return (*path, keys[-1])

    def _assignment(self, table: Location) -> None:
        line, keys = self._line(), self._keys()
        path = (*table, *keys)
        for n in range(len(table) + 1, len(path)):  # the tables that a dotted key names
            self.places.setdefault(path[:n], Place(line, None))
        self._at += 1  # the =
        self._value(path, line)

    def _keys(self) -> list[str]:
        """Return the parts of a dotted key, and the blanks around it."""
        keys: list[str] = []
        while not keys or self._text.startswith(".", self._at):
            self._at += 1 if keys else 0
            self._skip_blank()
            match = _KEY.match(self._text, self._at)
            assert match is not None
            self._at = match.end()
            keys.append(_decoded(match.group()))
            self._skip_blank()
        return keys

    def _value(self, path: Location, line: int) -> None:
        self._skip_blank()
        first = self._at
        if self._text.startswith("[", first):
            self._items(path, "]")
        elif self._text.startswith("{", first):
            self._items(path, "}")
        else:
            match = _TEXT.match(self._text, first) or _BARE.match(self._text, first)
            assert match is not None
            self._at = match.end()
        self.places[path] = Place(line, _BREAK.sub(" ", self._text[first : self._at]).rstrip())

    def _items(self, path: Location, closing: str) -> None:
        """The values of an array, or the assignments of an inline table."""
        self._at += 1
        self._skip_blank()
        index = 0
        while not self._text.startswith(closing, self._at):
            if closing == "}":
                self._assignment(path)
            else:
                self._value((*path, index), self._line())
            index += 1
            self._skip_blank()
            self._at += self._text.startswith(",", self._at)
            self._skip_blank()
        self._at += 1

    def _skip_blank(self) -> None:
        match = _BLANK.match(self._text, self._at)
        assert match is not None
        self._at = match.end()

    def _line(self) -> int:
        return bisect_left(self._breaks, self._at) + 1


def _decoded(key: str) -> str:
    return str(tomllib.loads(f"key = {key}")["key"]) if key[0] in "\"'" else key
