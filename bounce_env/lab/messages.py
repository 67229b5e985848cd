"""What tabs send, checked field by field before anything is done with it."""

from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from bounce_env.wording import shown

LARGEST = 1e6
"""Of a coordinate [m], a speed [m/s] or any other number."""

Number = Annotated[float, Field(ge=-LARGEST, le=LARGEST, allow_inf_nan=False)]
ZeroOrMore = Annotated[float, Field(ge=0.0, le=LARGEST, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Point = tuple[Number, Number]
Seconds = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Index = Annotated[int, Field(ge=0, le=100_000)]
NAME = r"[A-Za-z0-9_-]{1,60}"
FileName = Annotated[str, Field(pattern=f"^{NAME}$")]
"""Of a scene in the folder, without its ending: no folders, no dots."""

_Message = TypeVar("_Message")


class Message(BaseModel):
    """What all messages have in common: nothing in them is unknown, and nothing is converted."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


def reader(kinds: Any) -> TypeAdapter[Any]:
    """Return what reads messages of these kinds, which `do` tells apart."""
    return TypeAdapter(Annotated[kinds, Field(discriminator="do")])


def read(adapter: TypeAdapter[_Message], text: str) -> _Message:
    """Return a message of JSON as its kind; raises ValueError that names the field, its value and what is allowed."""
    try:
        return adapter.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(str(step) for step in first["loc"]) or "message"
        raise ValueError(f"{place} = {shown(first['input'])}: {first['msg']}") from None
