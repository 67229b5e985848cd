"""Scenes as TOML: read from a file or by a built-in's name, checked strictly, and written back."""

import math
import os
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from importlib import resources
from inspect import signature
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import TypeAdapter, ValidationError

from bounce_env.scene.checks import check_scene
from bounce_env.scene.elements import Ball, Element
from bounce_env.scene.errors import ABSENT, Location, Problem, SceneError, label, line_of, printable, problems_of
from bounce_env.scene.places import Place, places_of
from bounce_env.scene.spec import Scene
from bounce_env.wording import nearest, shown, unknown_name

_ELEMENT_TYPES: dict[str, type[Element]] = {spec.__name__.lower(): spec for spec in get_args(Element)}
_BUILTIN = resources.files("bounce_env.scene") / "builtin"

_Spec = TypeVar("_Spec", bound=Scene | Ball | Element)


def builtin_scenes() -> tuple[str, ...]:
    """Return the names of the scenes that come with the package, sorted; docs/scenes.md says what they are for."""
    return tuple(sorted(Path(item.name).stem for item in _BUILTIN.iterdir() if item.name.endswith(".toml")))


def load_scene(source: str | os.PathLike[str]) -> Scene:
    """Return the scene of a TOML file, or a built-in scene.

    source: the path of a .toml file; or, as text without path separator and without .toml, the name of one of
    `builtin_scenes()`. docs/scenes.md describes the format.

    Raises SceneError if there is no such scene, if the file cannot be read or is not TOML (naming the line),
    and for all that is wrong in it, one line each: file, element, field, value and what is allowed.
    """
    if isinstance(source, str) and not source.endswith(".toml") and not {"/", os.sep} & set(source):
        if source not in builtin_scenes():
            known = ", ".join(builtin_scenes())
            hint = nearest(source, builtin_scenes())
            raise SceneError(f"scene {source!r}: must be one of {known}, or the path of a .toml file{hint}")
        return _parse((_BUILTIN / f"{source}.toml").read_bytes(), f"built-in scene {source!r}")
    if not isinstance(source, str | os.PathLike):
        raise SceneError(f"scene {shown(source)}: must be the name of a scene or the path of a .toml file")
    path = Path(source)
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        raise SceneError(f"{printable(str(path))}: cannot be read: {error}") from error
    return _parse(data, printable(str(path)))


def as_scene(source: str | os.PathLike[str] | Scene | Mapping[str, Any]) -> Scene:
    """Return the scene that a user gave as `source`, in any form: itself, its contents (`scene_to_dict`), name or path.

    Raises SceneError as `load_scene` does. The format: docs/scenes.md.
    """
    if isinstance(source, Scene):
        return source
    return scene_from_dict(source) if isinstance(source, Mapping) else load_scene(source)


def _parse(data: bytes, source: str) -> Scene:
    try:
        text = data.decode("utf-8-sig")
        table = tomllib.loads(text)
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise SceneError(f"{source}:{line}: is not a TOML file: has a byte that is no UTF-8: {error}") from error
    except (ValueError, RecursionError) as error:  # ValueError: not TOML, or thousands of digits
        raise SceneError(f"{source}: is not a TOML file: {error}") from error
    return _read(table, source, partial(places_of, text))


def scene_from_dict(data: Mapping[str, Any], source: str = "scene") -> Scene:
    """Return the scene of a TOML file's contents `data`, nested dicts and lists; `source` is what messages call it.

    Raises SceneError with a line for each thing that is wrong. The format: docs/scenes.md.
    """
    return _read(data, source, dict)


def _read(data: object, source: str, places_of_text: Callable[[], dict[Location, Place]]) -> Scene:
    reader = _Reader()
    scene = reader.scene(data)
    if scene is None or reader.problems:
        places = places_of_text()  # only now: nobody asks for the lines of what is right
        lines = [_line(problem, because, source, reader.labels, places) for problem, because in reader.problems]
        raise SceneError("\n".join(lines), [problem for problem, _ in reader.problems])
    return scene


def _line(
    problem: Problem, because: Location, source: str, labels: Mapping[int, str], places: Mapping[Location, Place]
) -> str:
    """Return a problem in words, with the line and the literal of the file where there is one.

    The line is that of the key; of a key that is missing that of the reason for it, or of the table that lacks it.
    """
    at = because or problem.at
    place = next((places[at[:n]] for n in range(len(at), 0, -1) if at[:n] in places), None)
    literal = places[problem.at].literal if problem.at in places else None
    return line_of(problem, f"{source}:{place.line}" if place else source, labels, literal)


class _Reader:
    """Makes the parts of one scene and collects what is wrong with them."""

    def __init__(self) -> None:
        self.problems: list[tuple[Problem, Location]] = []  # each with the location of what is the reason for it
        self.labels: dict[int, str] = {}  # of the elements whose type is known

    def scene(self, data: object) -> Scene | None:
        if not isinstance(data, Mapping):
            self._refuse(data, f"must be a table of {_field_names(Scene)}")
            return None
        header = {key: value for key, value in data.items() if key not in {"ball", "elements"}}
        # field by field, so that one that is refused does not hide what is wrong between the others
        made = {key for key, value in header.items() if self._make(Scene, {key: value})}
        accepted = {key: value for key, value in header.items() if key in made and isinstance(key, str)}
        scene = Scene(**accepted)
        ball = self._ball(data.get("ball", {}))
        elements = self._elements(data.get("elements", []))
        refused = header.keys() - accepted.keys()
        try:
            check_scene(ball, elements, math.inf if "max_speed" in refused else scene.max_speed)
        except ValidationError as error:
            self._report(error)
        if self.problems or ball is None:
            return None
        return replace(scene, ball=ball, elements=tuple(elements.values()))

    def _ball(self, table: object) -> Ball | None:
        if not isinstance(table, Mapping):
            self._refuse(table, f"must be a table of {_field_names(Ball)}", "ball")
            return None
        return self._make(Ball, table, "ball")

    def _elements(self, tables: object) -> dict[int, Element]:
        if not isinstance(tables, list | tuple):
            self._refuse(tables, "must be a list of tables, each under a line [[elements]]", "elements")
            return {}
        made = ((index, self._element(index, table)) for index, table in enumerate(tables))
        return {index: element for index, element in made if element is not None}

    def _element(self, index: int, table: object) -> Element | None:
        at = ("elements", index)
        if not isinstance(table, Mapping):
            self._refuse(table, "must be a table, under a line [[elements]]", *at)
            return None
        types = f"one of {', '.join(_ELEMENT_TYPES)}"
        if "type" not in table:
            self._refuse(ABSENT, f"required: {types}", *at, "type")
            return None
        kind, name = table["type"], table.get("name")
        if not isinstance(kind, str) or kind not in _ELEMENT_TYPES:
            self._refuse(kind, f"must be {types}{nearest(kind, _ELEMENT_TYPES)}", *at, "type")
            return None
        self.labels[index] = label(index, kind, name if isinstance(name, str) else "")
        fields = {key: value for key, value in table.items() if key != "type"}
        return self._make(_ELEMENT_TYPES[kind], fields, *at)

    def _make(self, spec: type[_Spec], fields: Mapping[str, Any], *at: str | int) -> _Spec | None:
        for key in fields:
            if not isinstance(key, str):  # pydantic would take the key for the value
                self._refuse(fields[key], unknown_name(key, signature(spec).parameters, "field"), *at, key)
        fields = {key: value for key, value in fields.items() if isinstance(key, str)}
        try:
            return TypeAdapter(spec).validate_python(fields)
        except ValidationError as error:
            self._report(error, *at)
            return None

    def _report(self, error: ValidationError, *at: str | int) -> None:
        for problem, details in zip(problems_of(error), error.errors(), strict=True):
            self._refuse(
                problem.value, problem.message, *at, *problem.at, because=details.get("ctx", {}).get("because")
            )

    def _refuse(self, value: object, message: str, *at: str | int, because: Sequence[str | int] | None = None) -> None:
        """Note that the value at this place of the scene is wrong."""
        self.problems.append((Problem(at, value, message), tuple(because or ())))


def _field_names(spec: type[Scene | Ball]) -> str:
    return ", ".join(signature(spec).parameters)


def scene_to_dict(scene: Scene) -> dict[str, Any]:
    """Return the contents of a scene as JSON and TOML have them, from which `scene_from_dict` makes an equal one.

    Nested dicts and lists of text, numbers and flags; what is None is left out. The format: docs/scenes.md. Raises
    nothing.
    """
    elements = [{"type": type(e).__name__.lower(), **_contents(e)} for e in scene.elements]
    return {**_contents(scene, "ball", "elements"), "ball": _contents(scene.ball), "elements": elements}


def _contents(spec: Scene | Ball | Element, *skip: str) -> dict[str, Any]:
    values = {name: getattr(spec, name) for name in signature(type(spec)).parameters if name not in skip}
    return {name: _as_lists(value) for name, value in values.items() if value is not None}


def _as_lists(value: object) -> object:
    return [*map(_as_lists, value)] if isinstance(value, tuple) else value


def dump_scene(scene: Scene) -> str:
    """Return the scene as the text of a TOML file, from which `load_scene` returns an equal one, bit for bit.

    The format: docs/scenes.md. Raises nothing.
    """
    ball = "\n".join(["[ball]", *_assignments(scene.ball)])
    elements = (
        "\n".join(["[[elements]]", f'type = "{type(element).__name__.lower()}"', *_assignments(element)])
        for element in scene.elements
    )
    return "\n\n".join(["\n".join(_assignments(scene, "ball", "elements")), ball, *elements]) + "\n"


def _assignments(spec: Scene | Ball | Element, *skip: str) -> list[str]:
    return [f"{name} = {_toml(value)}" for name, value in _contents(spec, *skip).items()]


def _toml(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():  # printable, as `Name` demands: only these two need an escape
            return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
        case list():
            return f"[{', '.join(map(_toml, value))}]"
        case _:
            return repr(value)
