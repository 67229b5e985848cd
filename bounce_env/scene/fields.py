"""What one field of a spec takes: numbers, points, flags and names, with the words that an error prints."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from inspect import signature
from numbers import Real
from types import UnionType
from typing import Annotated

import numpy as np
from pydantic import GetCoreSchemaHandler, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, ErrorDetails, InitErrorDetails, PydanticCustomError, core_schema

from bounce_env.wording import unknown_name

LARGEST = 1e9
"""No number of a scene is larger: products of a few of them stay far from overflow in float64."""

SMALLEST = 1e-9
"""No positive length or speed of a scene is smaller: its square stays far from underflow."""

LARGEST_ANGLE = 100.0
"""No angle of a scene is larger [rad]: its 16 digits leave 14 behind the point, for sine and cosine."""


@dataclass(frozen=True)
class Allowed:
    """Annotation of a spec's field: `convert` returns the value to keep or raises, `words` say what it takes.

    Pydantic's own conversions are replaced, because they take `True` and `"1"` for 1.0, keep a NumPy
    scalar as it is, and name one violated bound where a user wants to read all that is allowed.
    """

    words: str
    convert: Callable[[object], object] = field(repr=False)

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self._check)

    def _check(self, value: object) -> object:
        try:
            return self.convert(value)
        except (TypeError, ValueError, OverflowError):
            raise not_allowed(self.words) from None


def not_allowed(words: str) -> PydanticCustomError:
    """Return the error of a field whose value is not what `words` allow."""
    return PydanticCustomError("not_allowed", "must be {words}", {"words": words})


def required(words: str, because: Sequence[str | int] = ()) -> PydanticCustomError:
    """The error of a field that must be given; `words` say with what value, `because` where the reason for it is."""
    return PydanticCustomError("required", "required: {words}", {"words": words, "because": list(because)})


def explain(error: ValidationError, spec: type) -> ValidationError:
    """Return the error of a spec, in which each field is named and a missing or unknown one says what is allowed."""
    names = list(signature(spec).parameters)
    fields: dict[str, FieldInfo] = spec.__pydantic_fields__  # type: ignore[attr-defined]

    extra = [e["loc"][0] for e in error.errors() if e["type"] == "unexpected_positional_argument"]
    by_position = min((position for position in extra if isinstance(position, int)), default=0)

    def explained(details: ErrorDetails) -> InitErrorDetails:
        loc, value, message, what = details["loc"], details["input"], details["msg"], details["type"]
        position = loc[0]
        if isinstance(position, int) and position < len(names):
            loc = (names[position], *loc[1:])
        match what:
            case "missing":
                allowed = next(item for item in fields[str(loc[0])].metadata if isinstance(item, Allowed))
                kind, value = required(allowed.words), None  # not the dump of all the other fields
            case "required":
                kind = PydanticCustomError("required", "{message}", {**details.get("ctx", {}), "message": message})
            case "unexpected_keyword_argument":
                kind = PydanticCustomError("unknown", "{words}", {"words": unknown_name(loc[-1], names, "field")})
            case "unexpected_positional_argument":
                taken = ", ".join(names[:by_position]) or "none"
                words = f"too many values by position: only {taken} may be given so"
                kind = PydanticCustomError("unknown", "{words}", {"words": words})
            case "multiple_argument_values":
                kind = PydanticCustomError("twice", "is given twice: must be given by position or by name")
            case _:
                kind = PydanticCustomError("not_allowed", "{message}", {"message": message})
        return InitErrorDetails(type=kind, loc=loc, input=value)

    return ValidationError.from_exception_data(error.title, list(map(explained, error.errors())))


def real_number(value: object, low: float, high: float) -> float:
    """Keep a number from `low` to `high`, as float; refuse all else."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError
    number = float(value) + 0.0  # -0.0 becomes 0.0: equal scenes have equal bits
    if not low <= number <= high:  # also false for NaN
        raise ValueError
    return number


def _zero_or_more(value: object) -> float:
    return real_number(value, 0.0, LARGEST)


def _zero_to_one(value: object) -> float:
    return real_number(value, 0.0, 1.0)


def _positive(value: object) -> float:
    return real_number(value, SMALLEST, LARGEST)


def _zero_or_positive(value: object) -> float:
    number = _zero_or_more(value)
    return number if number == 0.0 else _positive(number)


def _share(value: object) -> float:
    return real_number(value, SMALLEST, 1.0)


def _angle(value: object) -> float:
    return real_number(value, -LARGEST_ANGLE, LARGEST_ANGLE)


def _positive_or_none(value: object) -> float | None:
    return None if value is None else _positive(value)


def _vector(value: object) -> tuple[float, float]:
    if not isinstance(value, tuple | list | np.ndarray):
        raise TypeError
    x, y = value
    return real_number(x, -LARGEST, LARGEST), real_number(y, -LARGEST, LARGEST)


def _vector_or_none(value: object) -> tuple[float, float] | None:
    return None if value is None else _vector(value)


def _points(value: object) -> tuple[tuple[float, float], ...]:
    if not isinstance(value, tuple | list | np.ndarray):
        raise TypeError
    points = tuple(_vector(point) for point in value)
    if len(points) < 3:
        raise ValueError
    return points


def _box_or_none(value: object) -> tuple[tuple[float, float], tuple[float, float]] | None:
    if value is None:
        return None
    if not isinstance(value, tuple | list | np.ndarray):
        raise TypeError
    (x0, y0), (x1, y1) = map(_vector, value)
    if not (x0 < x1 and y0 < y1):
        raise ValueError
    return (x0, y0), (x1, y1)


def _flag(value: object) -> bool:
    if not isinstance(value, bool):
        raise TypeError
    return value


def _name(value: object) -> str:
    if not isinstance(value, str) or not value.isprintable():
        raise TypeError
    return str(value)


def whole_number(low: int, high: int, *, none: bool = False) -> Callable[[object], int | None]:
    """Converter that keeps a whole number from `low` to `high`, as int, and None if it may be; refuses all else."""

    def convert(value: object) -> int | None:
        if none and value is None:
            return None
        if isinstance(value, bool) or not isinstance(value, int | np.integer):
            raise TypeError
        if not low <= value <= high:
            raise ValueError
        return int(value)

    return convert


def one_of(*words: str) -> Allowed:
    """Annotation of a field that takes one of a few words."""

    def convert(value: object) -> object:
        if not isinstance(value, str) or value not in words:
            raise TypeError
        return str(value)

    return Allowed(f"one of {', '.join(words)}", convert)


def true_or_false(value: object) -> bool:
    """Keep a flag, Python's or NumPy's, as bool; refuse all else."""
    if not isinstance(value, bool | np.bool_):
        raise TypeError
    return bool(value)


def instance_of(spec: type | UnionType) -> Callable[[object], object]:
    """Converter that keeps an instance of the spec and refuses all else."""

    def convert(value: object) -> object:
        if not isinstance(value, spec):
            raise TypeError
        return value

    return convert


POINT_WORDS = f"two numbers [x, y], each from {-LARGEST:g} to {LARGEST:g}"
POSITIVE_WORDS = f"a number > 0 (from {SMALLEST:g} to {LARGEST:g})"

Vector = Annotated[tuple[float, float], Allowed(POINT_WORDS, _vector)]
VectorOrNone = Annotated[tuple[float, float] | None, Allowed(POINT_WORDS, _vector_or_none)]
Points = Annotated[
    tuple[tuple[float, float], ...],
    Allowed(f"at least 3 points [x, y], each number from {-LARGEST:g} to {LARGEST:g}", _points),
]
BoxOrNone = Annotated[
    tuple[tuple[float, float], tuple[float, float]] | None,
    Allowed("two corners [x, y] of a box, the lower left and the upper right one", _box_or_none),
]
ZeroOrMore = Annotated[float, Allowed(f"a number >= 0 (at most {LARGEST:g})", _zero_or_more)]
ZeroToOne = Annotated[float, Allowed("a number >= 0 and <= 1", _zero_to_one)]
Share = Annotated[float, Allowed(f"a number > 0 and <= 1 (at least {SMALLEST:g})", _share)]
Positive = Annotated[float, Allowed(POSITIVE_WORDS, _positive)]
ZeroOrPositive = Annotated[float, Allowed(f"0 or a number from {SMALLEST:g} to {LARGEST:g}", _zero_or_positive)]
PositiveOrNone = Annotated[float | None, Allowed(POSITIVE_WORDS, _positive_or_none)]
Angle = Annotated[float, Allowed(f"a number of radians, from {-LARGEST_ANGLE:g} to {LARGEST_ANGLE:g}", _angle)]
Flag = Annotated[bool, Allowed("true or false", _flag)]
Name = Annotated[str, Allowed("printable text", _name)]
