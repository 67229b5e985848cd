"""Whether what stands in different places of a replay's document fits together: then a page can show it."""

import tomllib
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from bounce_env.scene import Flipper, Scene, Wall, moves, scene_from_dict, scene_to_dict
from bounce_env.wording import shown

NEEDED = {"type", "start", "end", "center", "radius", "start_angle", "end_angle", "pivot", "length", "points"}
"""Fields of elements that a page needs, of those that an element has."""


def check_document(document: Mapping[str, Any]) -> None:
    """Raise ValueError, naming the place, for a document of the right types that no run has."""
    _check_indices(document)
    scene = _scene_of(document)
    _check_elements(document, scene)
    _check_parts(document, scene)
    _check_changes(document, scene)


def _below(place: str, number: int, count: int) -> None:
    if number >= count:
        raise ValueError(f"{place} = {number}: must be below {count}")


def _check_indices(document: Mapping[str, Any]) -> None:
    instants, elements = document["instants"], len(document["elements"])
    if any(later <= earlier for earlier, later in pairwise(instants)):
        raise ValueError("instants: each must be greater than the one before")
    for b, paths in enumerate(document["balls"]):
        for i, path in enumerate(paths):
            for k in (0, 1) if len(path) == 4 else (0,):
                _below(f"balls[{b}][{i}][{k}]", path[k], len(instants))
            if len(path) == 4 and path[1] <= path[0]:
                raise ValueError(f"balls[{b}][{i}]: must end after it begins")
    for i, part in enumerate(document["parts"]):
        _below(f"parts[{i}].element", part["element"], elements)
        for k, path in enumerate(part["paths"]):
            _below(f"parts[{i}].paths[{k}][0]", path[0], len(instants))
    for name in ("changes", "score", "events"):
        for i, row in enumerate(document[name]):
            _below(f"{name}[{i}][0]", row[0], len(instants))
    for i, (_, element, *_) in enumerate(document["changes"]):
        _below(f"changes[{i}][1]", element, elements)
    for i, (_, kind, ball, *_) in enumerate(document["events"]):
        _below(f"events[{i}][1]", kind, len(document["kinds"]))
        _below(f"events[{i}][2]", ball, len(document["balls"]))


def _scene_of(document: Mapping[str, Any]) -> Scene:
    try:
        return scene_from_dict(tomllib.loads(document["scene"]))
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"scene: is not TOML: {error}") from error


def _check_elements(document: Mapping[str, Any], scene: Scene) -> None:
    """They are the scene's; a later version may know fields that are missing here."""
    elements = scene_to_dict(scene)["elements"]
    if len(document["elements"]) != len(elements):
        raise ValueError(f"elements: must be those of the scene, {len(elements)}")
    for i, (told, element) in enumerate(zip(document["elements"], elements, strict=True)):
        for field, value in told.items():
            if field not in element or element[field] != value:
                raise ValueError(f"elements[{i}].{field} = {shown(value)}: must be that of the scene")
        if missing := (element.keys() - told.keys()) & NEEDED:
            raise ValueError(f"elements[{i}]: lacks {sorted(missing)}")
    left, bottom, right, top = document["bounds"]
    if right < left or top < bottom or not (right > left or top > bottom or document["ball_radius"] > 0.0):
        raise ValueError(f"bounds = {document['bounds']}: must be left, bottom, right, top")


def _check_parts(document: Mapping[str, Any], scene: Scene) -> None:
    for i, part in enumerate(document["parts"]):
        element = scene.elements[part["element"]]
        if not moves(element):
            raise ValueError(f"parts[{i}].element = {part['element']}: must be a part that moves")
        numbers = 1 if isinstance(element, Flipper) else 4 if isinstance(element, Wall) else 2
        if any(len(place) != numbers or len(rate) != numbers for _, place, rate in part["paths"]):
            raise ValueError(f"parts[{i}].paths: each must have {numbers} numbers, and as many rates")


def _check_changes(document: Mapping[str, Any], scene: Scene) -> None:
    contents = scene_to_dict(scene)
    for i, (_, index, field, value) in enumerate(document["changes"]):
        if field == "disabled":
            if not isinstance(value, bool):
                raise ValueError(f"changes[{i}][3] = {shown(value)}: must be true or false")
            continue
        if field not in document["elements"][index]:
            raise ValueError(f"changes[{i}][2] = {shown(field)}: must be a field of its element")
        changed = [*contents["elements"]]
        changed[index] = {**changed[index], field: value}
        scene_from_dict({**contents, "elements": changed}, f"changes[{i}]")
