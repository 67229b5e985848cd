"""What a replay's document is, format 1 (docs/replay.md), and how one is read: nothing of it is ever run."""

import json
import re
from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Len
from pydantic import BaseModel, ConfigDict, Field, JsonValue, TypeAdapter, ValidationError

from bounce_env.wording import shown

FORMAT = 1

Number = Annotated[float, Field(allow_inf_nan=False)]
Row7 = Annotated[list[Number], Len(7, 7)]
Series = Annotated[list[Number], Len(1, 64)]
Index = Annotated[int, Field(ge=-1)]


class Part(BaseModel):
    """Of a moving part: [begin, [number ...], [its rate ...]], one after the other."""

    model_config = ConfigDict(extra="forbid", strict=True)
    element: Annotated[int, Field(ge=0)]
    paths: Annotated[list[tuple[Number, list[Number], list[Number]]], Len(1)]


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
    balls: list[Annotated[list[Row7 | tuple[Number, Number, Series, Series]], Len(1)]]
    parts: list[Part]
    changes: list[tuple[Number, Annotated[int, Field(ge=0)], str, JsonValue]]
    score: list[tuple[Number, Number]]
    lost: Annotated[int, Field(ge=0)]
    kinds: list[str]
    events: list[
        tuple[Number, int, Index, Index, Number, Number, Number, Number, Number, Number, Number, Number]
    ]  # fmt: skip


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
    """Raise ValueError where a number names an element, a kind or a field that is not there."""
    elements, kinds = len(document["elements"]), len(document["kinds"])
    for i, part in enumerate(document["parts"]):
        if part["element"] >= elements:
            raise ValueError(f"{source}: parts[{i}].element = {part['element']}: must be below {elements}")
    for i, (_, element, field, _) in enumerate(document["changes"]):
        if element >= elements:
            raise ValueError(f"{source}: changes[{i}][1] = {element}: must be below {elements}")
        if field not in ("disabled", *document["elements"][element]):
            raise ValueError(f"{source}: changes[{i}][2] = {shown(field)}: must be a field of its element")
    for i, (_, kind, *_) in enumerate(document["events"]):
        if not 0 <= kind < kinds:
            raise ValueError(f"{source}: events[{i}][1] = {kind}: must be from 0 to {kinds - 1}")
