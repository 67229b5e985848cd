"""A replay as JSON: all that a page needs to show a run at any instant. docs/replay.md specifies it."""

import json
import platform
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from bounce_env.engine.memory.records import EventKind
from bounce_env.engine.recorded import BallPath, Change, PartPath, Recorded
from bounce_env.extras import version
from bounce_env.replay.chebyshev import pieces_of
from bounce_env.replay.format import FORMAT
from bounce_env.scene import dump_scene, scene_to_dict

_SHARE = 1e-11
"""How far a series may be from the path that it stands for, as a share of the scene's size."""


def document_of(
    run: Recorded, *, about: Mapping[str, Any] | None = None, score: Iterable[tuple[float, float]] = (), lost: int = 0
) -> dict[str, Any]:
    """Return the document of a recorded run.

    about: what made it, as `id`, `kwargs` and `seed` of an environment. score: from what time [s] on it was what. lost:
    how many events the recording had no room for.
    """
    left, bottom, right, top = run.scene.bounds
    size = max(right - left, top - bottom, run.scene.ball.radius)
    return {
        "format": FORMAT,
        "versions": {"bounce_env": version(), "python": platform.python_version(), "numpy": np.__version__},
        "about": dict(about or {}),
        "scene": dump_scene(run.scene),
        "bounds": [left, bottom, right, top],
        "ball_radius": run.scene.ball.radius,
        "elements": scene_to_dict(run.scene)["elements"],
        "end": run.end,
        "balls": [list(_ball(paths, run.end, _SHARE * size)) for paths in run.balls],
        "parts": [
            {"element": index, "paths": [_part(path) for path in paths]}
            for (index, _), paths in zip(run.scene.parts, run.parts, strict=True)
        ],
        "changes": [_change(change) for change in run.changes],
        "score": [[time, *_short([points])] for time, points in _new(score)],
        "lost": lost,
        "kinds": [kind.name.lower().replace("_", " ") for kind in EventKind],
        "events": [_event(row) for row in run.ledger],
    }


def _change(change: Change) -> list[Any]:
    value = change.value
    return [change.time, change.element, change.field, [*value] if isinstance(value, tuple) else value]


def _new(score: Iterable[tuple[float, float]]) -> Iterable[tuple[float, float]]:
    """Return where the score is another than before; it is 0 at first."""
    before = 0.0
    for time, points in score:
        if points != before:
            yield time, points
        before = points


def _ball(paths: Iterable[BallPath], end: float, within: float) -> Iterable[list[Any]]:
    """Return flights as [begin, x, y, vx, vy, ax, ay], and series as [begin, end, [x ...], [y ...]]."""
    paths = list(paths)
    ends = [path.begin for path in paths[1:]] + [end]
    for path, until in zip(paths, ends, strict=True):
        if path.bent is not None and until > path.begin:
            for piece in pieces_of(path.at, path.begin, until, within):
                yield [piece.begin, piece.end, _short(piece.x), _short(piece.y)]
        elif path.out:
            yield [path.begin, *_short((path.x, path.y)), 0, 0, 0, 0]
        else:
            yield [path.begin, *_short((path.x, path.y, path.vx, path.vy, path.ax, path.ay))]


def _part(path: PartPath) -> list[Any]:
    return [path.begin, _short(path.place), _short(path.rate)]


def _event(row: Any) -> list[Any]:
    """Return [time, kind, ball, element, x, y, nx, ny, vx0, vy0, vx1, vy1]."""
    whole = [float(row["time"]), int(row["kind"]), int(row["ball"]), int(row["element"])]
    numbers = (float(row[name]) for name in ("x", "y", "nx", "ny", "vx0", "vy0", "vx1", "vy1"))
    return whole + _short(numbers, digits=9)  # they are read; what is drawn are the paths


def _short(numbers: Iterable[float], digits: int = 13) -> list[float]:
    """Return numbers of so many digits, whole ones as integers."""
    rounded = (float(f"{number:.{digits}g}") for number in numbers)
    return [int(number) if number.is_integer() and abs(number) < 1e15 else number for number in rounded]


def text_of(document: Mapping[str, Any]) -> str:
    """Return a document as JSON for the inside of a page: no text in it ends an element of HTML."""
    text = json.dumps(document, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
