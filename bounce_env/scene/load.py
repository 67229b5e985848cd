"""Scenes as TOML: read from a file or by a built-in's name, checked strictly, and written back."""

import math
import os
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from importlib import resources
from inspect import signature
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import TypeAdapter, ValidationError

from bounce_env.scene.checks import check_scene, label
from bounce_env.scene.elements import Ball, Element
from bounce_env.scene.spec import Scene

_ELEMENT_TYPES: dict[str, type[Element]] = {spec.__name__.lower(): spec for spec in get_args(Element)}
_BUILTIN = resources.files("bounce_env.scene") / "builtin"
_LONGEST_VALUE = 60  # characters of a value that a message shows
_ABSENT = object()

_Spec = TypeVar("_Spec", bound=Scene | Ball | Element)


class SceneError(ValueError):
    """A scene that cannot be read; its text is one line for each thing that is wrong."""


def builtin_scenes() -> tuple[str, ...]:
    """The names of the scenes that come with the package, sorted."""
    return tuple(sorted(Path(item.name).stem for item in _BUILTIN.iterdir() if item.name.endswith(".toml")))


def load_scene(source: str | os.PathLike[str]) -> Scene:
    """The scene of a TOML file, or a built-in scene.

    source: the path of a .toml file; or, as text without path separator and without .toml, the name of one of
    `builtin_scenes()`. The built-in paddle.toml describes the format.

    Raises SceneError if there is no such scene, if the file cannot be read or is not TOML (naming the line),
    and for all that is wrong in it, one line each: file, element, field, value and what is allowed.
    """
    if isinstance(source, str) and not source.endswith(".toml") and not {"/", os.sep} & set(source):
        if source not in builtin_scenes():
            known = ", ".join(builtin_scenes())
            raise SceneError(f"scene {source!r}: must be one of {known}, or the path of a .toml file")
        return _parse((_BUILTIN / f"{source}.toml").read_bytes(), f"built-in scene {source!r}")
    if not isinstance(source, str | os.PathLike):
        raise SceneError(f"scene {_shown(source)}: must be the name of a scene or the path of a .toml file")
    path = Path(source)
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a path with a null character
        raise SceneError(f"{_printable(str(path))}: cannot be read: {error}") from error
    return _parse(data, _printable(str(path)))


def _parse(data: bytes, source: str) -> Scene:
    try:
        table = tomllib.loads(data.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:  # ValueError: not UTF-8, not TOML, or thousands of digits
        raise SceneError(f"{source}: is not a TOML file: {error}") from error
    return scene_from_dict(table, source)


def scene_from_dict(data: Mapping[str, Any], source: str = "scene") -> Scene:
    """The scene of a TOML file's contents, nested dicts and lists; `source` is what messages call it.

    Raises SceneError with a line for each thing that is wrong.
    """
    reader = _Reader(source)
    scene = reader.scene(data)
    if scene is None or reader.problems:
        raise SceneError("\n".join(reader.problems))
    return scene


class _Reader:
    """Makes the parts of one scene and collects what is wrong with them."""

    def __init__(self, source: str) -> None:
        self.problems: list[str] = []
        self._source = source
        self._labels: dict[object, str] = {}  # of the elements whose type is known

    def scene(self, data: object) -> Scene | None:
        if not isinstance(data, Mapping):
            self._refuse(data, f"must be a table of {_field_names(Scene)}")
            return None
        header = {key: value for key, value in data.items() if key not in {"ball", "elements"}}
        # field by field, so that one that is refused does not hide what is wrong between the others
        accepted = {key: value for key, value in header.items() if self._make(Scene, {key: value})}
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
            self._refuse(_ABSENT, f"required: {types}", *at, "type")
            return None
        kind, name = table["type"], table.get("name")
        if not isinstance(kind, str) or kind not in _ELEMENT_TYPES:
            self._refuse(kind, f"must be {types}", *at, "type")
            return None
        self._labels[index] = label(index, kind, name if isinstance(name, str) else "")
        fields = {key: value for key, value in table.items() if key != "type"}
        return self._make(_ELEMENT_TYPES[kind], fields, *at)

    def _make(self, spec: type[_Spec], fields: Mapping[str, Any], *at: str | int) -> _Spec | None:
        try:
            return TypeAdapter(spec).validate_python(fields)
        except ValidationError as error:
            self._report(error, *at)
            return None

    def _report(self, error: ValidationError, *at: str | int) -> None:
        for details in error.errors():
            value = _ABSENT if details["type"] == "required" else details["input"]
            self._refuse(value, details["msg"], *at, *details["loc"])

    def _refuse(self, value: object, message: str, *at: str | int) -> None:
        """Note that the value at this place of the scene is wrong."""
        match at:
            case "elements", int(index), *field:
                places = [self._labels.get(index, f"elements[{index}]"), *map(_printable, field)]
            case _:
                places = [*map(_printable, at)]
        if value is not _ABSENT:
            places = [*places[:-1], " = ".join([*places[-1:], _shown(value)])]
        self.problems.append(": ".join([self._source, *places, message]))


def _field_names(spec: type[Scene | Ball]) -> str:
    return ", ".join(signature(spec).parameters)


def _shown(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()  # as TOML spells it
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # thousands of digits, or of brackets
        return "a value too long to show"
    return text if len(text) <= _LONGEST_VALUE else f"{text[:_LONGEST_VALUE]}..."


def _printable(key: object) -> str:
    return key if isinstance(key, str) and key.isprintable() else repr(key)


def dump_scene(scene: Scene) -> str:
    """The scene as the text of a TOML file, from which `load_scene` returns an equal one, bit for bit."""
    ball = "\n".join(["[ball]", *_assignments(scene.ball)])
    elements = (
        "\n".join(["[[elements]]", f'type = "{type(element).__name__.lower()}"', *_assignments(element)])
        for element in scene.elements
    )
    return "\n\n".join(["\n".join(_assignments(scene, "ball", "elements")), ball, *elements]) + "\n"


def _assignments(spec: Scene | Ball | Element, *skip: str) -> list[str]:
    values = {name: getattr(spec, name) for name in signature(type(spec)).parameters if name not in skip}
    return [f"{name} = {_toml(value)}" for name, value in values.items() if value is not None]


def _toml(value: object) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():  # printable, as `Name` demands: only these two need an escape
            return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
        case tuple():
            return f"[{', '.join(map(_toml, value))}]"
        case _:
            return repr(value)
