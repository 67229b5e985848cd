"""What a replay's document is, format 1 (docs/replay.md), and how one is read: nothing of it is ever run."""

import json
import re
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Len
from pydantic import BaseModel, ConfigDict, Field, JsonValue, TypeAdapter, ValidationError

from bounce_env.wording import shown

FORMAT = 1

Number = Annotated[float, Field(allow_inf_nan=False)]
Instant = Annotated[int, Field(ge=0)]
"""A time, as an index of the document's `instants`."""
Index = Annotated[int, Field(ge=-1)]
Series = Annotated[list[Number], Len(1, 64)]
Flight = tuple[Instant, Number, Number, Number, Number, Number, Number]
BallEvent = tuple[Instant, int, Annotated[int, Field(ge=0)], Index, Number, Number, Number, Number]
PartEvent = tuple[Instant, int, Literal[-1], Index]


class Part(BaseModel):
    """Of a moving part: [instant, [number ...], [its rate ...]], one after the other."""

    model_config = ConfigDict(extra="forbid", strict=True)
    element: Annotated[int, Field(ge=0)]
    paths: Annotated[list[tuple[Instant, list[Number], list[Number]]], Len(1)]


class Document(BaseModel):
    """A replay: see docs/replay.md."""

    model_config = ConfigDict(extra="forbid", strict=True)
    format: Literal[1]
    versions: dict[str, str]
    about: dict[str, JsonValue]
    scene: str
    bounds: Annotated[list[Number], Len(4, 4)]
    ball_radius: Annotated[Number, Field(ge=0.0)]
    elements: list[dict[str, JsonValue]]
    end: Annotated[Number, Field(ge=0.0)]
    kinds: list[str]
    lost: Annotated[int, Field(ge=0)]
    instants: list[Number]
    balls: list[Annotated[list[Flight | tuple[Instant, Instant, Series, Series]], Len(1)]]
    parts: list[Part]
    changes: list[tuple[Instant, Annotated[int, Field(ge=0)], str, JsonValue]]
    score: list[tuple[Instant, Number]]
    events: list[BallEvent | PartEvent]


_READER = TypeAdapter(Document)
_BLOCK = re.compile(r'<script type="application/json" id="replay">(.*?)</script>', re.DOTALL)


def read_replay(path: Path) -> dict[str, Any]:
    """Return the document in a file, alone (.json) or within its page; raises OSError, and as `read_document`."""
    text = path.read_text(encoding="utf-8")
    block = _BLOCK.search(text)
    return read_document(block[1] if block else text, str(path))


def read_document(text: str, source: str = "replay") -> dict[str, Any]:
    """Return the document of a text; raises ValueError for what is none, or of another format, naming the place."""
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{source}: cannot be read as JSON: {error}") from error
    if not isinstance(document, dict):
        raise ValueError(f"{source}: must be an object of JSON")
    if document.get("format") != FORMAT:
        found = shown(document["format"]) if "format" in document else "missing"
        raise ValueError(f"{source}: format = {found}: this version of bounce_env reads {FORMAT}")
    try:
        _READER.validate_json(text)
    except ValidationError as error:
        raise ValueError(_first_of(error, source)) from None
    _check_indices(document, source)
    return document


def _first_of(error: ValidationError, source: str) -> str:
    first = error.errors(include_url=False)[0]
    place = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in first["loc"]).lstrip(".")
    return f"{source}: {place} = {shown(first['input'])}: {first['msg']}"


def _check_indices(document: dict[str, Any], source: str) -> None:
    """Raise ValueError where a number names an instant, an element, a kind, a ball or a field that is not there."""

    def below(place: str, number: int, count: int) -> None:
        if number >= count:
            raise ValueError(f"{source}: {place} = {number}: must be below {count}")

    instants, elements = document["instants"], len(document["elements"])
    kinds, balls = len(document["kinds"]), len(document["balls"])
    if any(later <= earlier for earlier, later in pairwise(instants)):
        raise ValueError(f"{source}: instants: each must be greater than the one before")
    for b, paths in enumerate(document["balls"]):
        for i, path in enumerate(paths):
            for k in (0, 1) if len(path) == 4 else (0,):
                below(f"balls[{b}][{i}][{k}]", path[k], len(instants))
    for i, part in enumerate(document["parts"]):
        below(f"parts[{i}].element", part["element"], elements)
        for k, path in enumerate(part["paths"]):
            below(f"parts[{i}].paths[{k}][0]", path[0], len(instants))
    for name in ("changes", "score", "events"):
        for i, row in enumerate(document[name]):
            below(f"{name}[{i}][0]", row[0], len(instants))
    for i, (_, element, field, _) in enumerate(document["changes"]):
        below(f"changes[{i}][1]", element, elements)
        if field not in ("disabled", *document["elements"][element]):
            raise ValueError(f"{source}: changes[{i}][2] = {shown(field)}: must be a field of its element")
    for i, (_, kind, ball, *_) in enumerate(document["events"]):
        below(f"events[{i}][1]", kind, kinds)
        below(f"events[{i}][2]", ball, balls)
