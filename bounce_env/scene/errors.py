"""The errors of specs: what is wrong, where, in the project's own words."""

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from inspect import signature
from typing import Any, TypeAlias, TypeVar

from pydantic import ValidationError

from bounce_env.wording import cut, shown

Location: TypeAlias = tuple[str | int, ...]
"""Where in a scene: ("elements", 3, "radius")."""

ABSENT = object()
"""The value of a field that is missing."""

_Class = TypeVar("_Class", bound=type)


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong: `value`, as it was given, at a location; `message` says what is allowed."""

    at: Location
    value: object
    message: str


class SceneError(ValueError):
    """A scene, or a part of one, that is not allowed; its text is one line for each thing that is wrong.

    What is allowed: docs/scenes.md.

    problems: the same for programs, where the scene could be read at all.
    """

    def __init__(self, text: str, problems: Sequence[Problem] = ()) -> None:
        super().__init__(text)
        self.problems = tuple(problems)


def label(index: int, kind: str, name: object) -> str:
    """Return how messages call an element: `elements[3] (wall 'floor')`, or `elements[3] (wall)` without a name."""
    return f"elements[{index}] ({kind} {name!r})" if name else f"elements[{index}] ({kind})"


def describe_element(element: Any, index: int) -> str:
    """Return how messages call an element of a scene, by its class."""
    return label(index, type(element).__name__.lower(), element.name)


def line_of(problem: Problem, source: str, labels: Mapping[int, str], literal: str | None = None) -> str:
    """Return a problem in words. labels: of elements, by index; literal: the value as it stands in a file."""
    match problem.at:
        case "elements", int(index), *field:
            places = [labels.get(index, f"elements[{index}]"), *map(printable, field)]
        case _:
            places = [*map(printable, problem.at)]
    if problem.value is not ABSENT:
        places = [
            *places[:-1],
            " = ".join([*places[-1:], shown(problem.value) if literal is None else _visible(cut(literal))]),
        ]
    return ": ".join([*([source] if source else []), *places, problem.message])


def _visible(literal: str) -> str:
    """Return a literal whose letters are all seen: what would steer a terminal is escaped."""
    return "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in literal)


def printable(key: object) -> str:
    """Return a key as messages print it."""
    return key if isinstance(key, str) and key.isprintable() else repr(key)


def problems_of(error: ValidationError) -> list[Problem]:
    """Return the problems that pydantic has found, which `fields.explain` has put into words."""
    return [
        Problem(details["loc"], ABSENT if details["type"] == "required" else details["input"], details["msg"])
        for details in error.errors()
    ]


def own_words(raises: Callable[[str, list[Problem]], Exception], *, named: bool = True) -> Callable[[_Class], _Class]:
    """Let the constructor of a pydantic dataclass raise its errors in our own words.

    raises: makes the exception of its text and problems; named: whether lines begin with the name of the class.
    What validates without the constructor (a loader, through `TypeAdapter`) still gets pydantic's error, with a
    location for each thing that is wrong.
    """

    def decorate(spec: _Class) -> _Class:
        construct = spec.__init__  # type: ignore[misc]

        @functools.wraps(construct)
        def __init__(self: Any, *args: Any, **kwargs: Any) -> None:
            try:
                construct(self, *args, **kwargs)
            except ValidationError as error:
                given = dict(zip(signature(spec).parameters, args, strict=False)) | kwargs
                problems = [_as_given(problem, given) for problem in problems_of(error)]
                labels = _labels(given.get("elements"))
                source = spec.__name__ if named else ""
                text = "\n".join(line_of(problem, source, labels) for problem in problems)
                raise raises(text, problems) from None

        spec.__init__ = __init__  # type: ignore[misc]
        return spec

    return decorate


def _as_given(problem: Problem, given: Mapping[str, object]) -> Problem:
    """Return a field's problem with the value that the caller gave, where only a converted one is known."""
    if len(problem.at) == 1 and problem.value is not ABSENT and problem.at[0] in given:
        return Problem(problem.at, given[str(problem.at[0])], problem.message)
    return problem


def _labels(elements: object) -> dict[int, str]:
    """Return what to call the elements that a scene was given."""
    if not isinstance(elements, list | tuple):
        return {}
    return {i: label(i, type(e).__name__.lower(), getattr(e, "name", "")) for i, e in enumerate(elements)}


own_words_of_scenes = own_words(SceneError)
"""The decorator of everything that a scene is made of."""
