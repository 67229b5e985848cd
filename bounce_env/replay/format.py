"""What a replay's document is, format 1 (docs/replay.md), and how one is read: nothing of it is ever run."""

import json
import re
from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Len
from pydantic import BaseModel, ConfigDict, Field, JsonValue, TypeAdapter, ValidationError

from bounce_env.replay.consistent import check_document
from bounce_env.wording import shown

FORMAT = 1

Number = Annotated[float, Field(allow_inf_nan=False)]
Length = Annotated[float, Field(ge=-1e15, le=1e15, allow_inf_nan=False)]
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
    bounds: Annotated[list[Length], Len(4, 4)]
    ball_radius: Annotated[Length, Field(ge=0.0)]
    elements: list[dict[str, JsonValue]]
    end: Annotated[Number, Field(ge=0.0)]
    kinds: list[str]
    lost: Annotated[int, Field(ge=0, le=2**53)]
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
        document = json.loads(text, parse_constant=_refuse)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"{source}: cannot be read as JSON: {error}") from error
    if not isinstance(document, dict):
        raise ValueError(f"{source}: must be an object of JSON")
    if type(document.get("format")) is not int or document["format"] != FORMAT:
        found = shown(document["format"]) if "format" in document else "missing"
        raise ValueError(f"{source}: format = {found}: this version of bounce_env reads {FORMAT}")
    try:
        _READER.validate_json(text)
    except ValidationError as error:
        raise ValueError(_first_of(error, source)) from None
    try:
        check_document(document)
    except ValueError as error:
        raise ValueError(f"{source}: {error}") from error
    return document


def _refuse(word: str) -> float:
    raise ValueError(f"{word} is no number of JSON")


def _first_of(error: ValidationError, source: str) -> str:
    first = error.errors(include_url=False)[0]
    place = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in first["loc"]).lstrip(".")
    return f"{source}: {place} = {shown(first['input'])}: {first['msg']}"
