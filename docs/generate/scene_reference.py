"""The reference of the scene format, from the specs: fields, what they take, defaults, an example and its picture."""

import inspect
import re
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any, NamedTuple

import bounce_env
from bounce_env import Arc, Ball, Bumper, Field, Flipper, Paddle, Scene, Sensor, Wall, builtin_scenes, load_scene
from bounce_env.scene.fields import Allowed
from generate.api import linked
from generate.pictures import element_picture, scene_picture

BUILTIN = Path(bounce_env.__file__).parent / "scene" / "builtin"
EXAMPLES = Path(__file__).resolve().parent.parent / "elements"


class Example(NamedTuple):
    """A scene of docs/elements, and the ball whose way its picture shows: where [m], how fast [m/s], how long [s]."""

    name: str
    words: str
    position: tuple[float, float]
    velocity: tuple[float, float]
    seconds: float
    command: Any = None


SPECS: tuple[tuple[type, tuple[Example, ...]], ...] = (
    (
        Wall,
        (
            Example("wall", "A ball bounces along two walls.", (0.2, 0.9), (0.6, 0.0), 1.6),
            Example("one_way", "From below the ball passes, from above it bounces.", (0.2, 0.3), (0.6, 2.4), 1.7),
            Example(
                "draggable", "The wall's right end is dragged up while the ball falls.", (0.45, 1.0), (0.15, 0.0), 0.9,
                ((0.0, 0.0), (0.0, 0.5)),
            ),
        ),
    ),
    (
        Bumper,
        (
            Example("bumper", "`b` > 1 gives speed, up to `max_speed`.", (0.66, 0.98), (0.0, 0.0), 1.1),
            Example("shuttle", "A bumper that goes to and fro on a rail.", (0.6, 1.0), (0.1, 0.0), 1.5),
        ),
    ),
    (Arc, (Example("arc", "A ball slides and bounces in a bowl.", (0.16, 1.0), (0.0, 0.0), 2.0),)),
    (Paddle, (Example("paddle", "Moves to the right; it drags the ball.", (0.85, 0.75), (-0.02, 0.0), 1.25, 0.3),)),
    (Flipper, (Example("flipper", "Pressed while the ball falls.", (0.75, 0.9), (0.0, 0.0), 0.8, True),)),
    (Sensor, (Example("sensor", "Through the circle, and out at the drain.", (0.2, 0.9), (0.9, 0.0), 1.2),)),
    (Field, (Example("field", "A wind to the right in the middle.", (0.3, 1.0), (0.0, 0.0), 1.0),)),
)  # fmt: skip


def elements() -> str:
    """Return the reference: the scene's own fields, the ball, and each element with its pictures."""
    parts = ["### The scene", _reference(Scene), "### The ball", _reference(Ball)]
    for spec, examples in SPECS:
        parts += [f"### {spec.__name__}", _reference(spec), *map(_shown, examples)]
    return "\n\n".join(parts)


def _reference(spec: type) -> str:
    doc = inspect.cleandoc(spec.__doc__ or "")
    first = linked(doc.split("\n\n")[0].replace("\n", " "))
    told = meanings(spec)
    lines = [first, "", "| field | what it takes | default | what it is |", "| --- | --- | --- | --- |"]
    for field in fields(spec):
        default = "required" if field.default is MISSING else _toml(field.default)
        lines.append(f"| `{field.name}` | {_words(spec, field.name)} | {default} | {told.get(field.name, '')} |")
    return "\n".join(lines)


def _words(spec: Any, name: str) -> str:
    metadata = spec.__pydantic_fields__[name].metadata
    words = next((item.words for item in metadata if isinstance(item, Allowed)), "")
    return {"ball": "a table `[ball]`", "elements": "tables `[[elements]]`"}.get(name, words)


def _toml(default: Any) -> str:
    match default:
        case None:
            return "left out"
        case Ball():
            return "a point"
        case bool():
            return f"`{str(default).lower()}`"
        case tuple():
            return f"`{list(default)}`"
        case str():
            return f'`"{default}"`'
    return f"`{default!r}`"


def meanings(spec: type) -> dict[str, str]:
    """Return what the docstring of a spec says of each field: "start, end: its ends. b: bounciness."."""
    names = [field.name for field in fields(spec)]
    doc = " ".join(inspect.cleandoc(spec.__doc__ or "").partition("\n\nRaises")[0].split())
    some = "|".join(names)
    marks = list(re.finditer(rf"(?<![\w`])((?:{some})(?:, (?:{some}))*): ", doc))
    told = {}
    for mark, following in zip(marks, [*marks[1:], None], strict=True):
        text = doc[mark.end() : None if following is None else following.start()].strip().rstrip(".,;")
        for name in mark[1].split(", "):
            told[name] = text.replace("|", "\\|")
    return told


def _shown(example: Example) -> str:
    path = EXAMPLES / f"{example.name}.toml"
    picture = element_picture(
        example.name, load_scene(path), example.position, example.velocity, example.seconds, example.command
    )
    text = path.read_text(encoding="utf-8").strip()
    image = f"```{{image}} {picture}\n:alt: {example.words}\n:class: element\n```"
    return f"{image}\n\n{example.words}\n\n```toml\n{text}\n```"


def builtins() -> str:
    """Return the built-in scenes, each with the first sentence of its file and a picture in metres."""
    lines = ["| name | what it is | where what is |", "| --- | --- | --- |"]
    for name in builtin_scenes():
        text = (BUILTIN / f"{name}.toml").read_text(encoding="utf-8")
        lines.append(f"| `{name}` | {_head(text)} | ![{name}]({scene_picture(name)}) |")
    return "\n".join(lines)


def _head(text: str) -> str:
    """Return the first sentence of the comment that a file begins with."""
    comment = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        comment.append(line.lstrip("# ").strip())
    return re.split(r"(?<=[.:])\s", " ".join(filter(None, comment)), maxsplit=1)[0].rstrip(":").replace("|", "\\|")
