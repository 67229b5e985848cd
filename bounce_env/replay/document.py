"""A replay as JSON: all that a page needs to show a run at any instant. docs/replay.md specifies it."""

import json
import math
import platform
from collections.abc import Iterable, Iterator, Mapping
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

_ROUNDED = 2e-11
"""How far rounding may move a ball by the end of a path, as a share of the scene's size."""

_SECONDS = 12
"""Decimals of instants [s]."""


def document_of(
    run: Recorded, *, about: Mapping[str, Any] | None = None, score: Iterable[tuple[float, float]] = (), lost: int = 0
) -> dict[str, Any]:
    """Return the document of a recorded run.

    about: what made it, as `id`, `kwargs` and `seed` of an environment. score: from what time [s] on it was what. lost:
    how many events the recording had no room for.
    """
    left, bottom, right, top = run.scene.bounds
    size = max(right - left, top - bottom, run.scene.ball.radius)
    if size == 0.0:  # nothing but a point, of which a page shows the surroundings
        left, bottom, right, top, size = -1.0, -1.0, 1.0, 1.0, 2.0
    timed = {
        "balls": [list(_ball(paths, run.end, size)) for paths in run.balls],
        "parts": [
            {"element": index, "paths": list(_part(paths, run.end, size))}
            for (index, _), paths in zip(run.scene.parts, run.parts, strict=True)
        ],
        "changes": [_change(change) for change in run.changes],
        "score": [[time, _short(points)] for time, points in _new(score)],
        "events": [_event(row) for row in run.ledger],
    }
    return {
        "format": FORMAT,
        "versions": {"bounce_env": version(), "python": platform.python_version(), "numpy": np.__version__},
        "about": dict(about or {}),
        "scene": dump_scene(run.scene),
        "bounds": [left, bottom, right, top],
        "ball_radius": run.scene.ball.radius,
        "elements": scene_to_dict(run.scene)["elements"],
        "end": round(run.end, _SECONDS),
        "kinds": [kind.words for kind in EventKind],
        "lost": lost,
        "instants": _number_instants(timed),
        **timed,
    }


def _number_instants(timed: Mapping[str, Any]) -> list[float]:
    """Put, in place of each time, its number among all of them; returns these. Most stand in several places."""
    rows = [*timed["changes"], *timed["score"], *timed["events"]]
    rows += [path for paths in timed["balls"] for path in paths]
    rows += [path for part in timed["parts"] for path in part["paths"]]
    places = [(row, k) for row in rows for k in ((0, 1) if _is_series(row) else (0,))]
    instants = sorted({round(row[k], _SECONDS) for row, k in places})
    numbers = {instant: number for number, instant in enumerate(instants)}
    for row, k in places:
        row[k] = numbers[round(row[k], _SECONDS)]
    return [_short(instant, 17) for instant in instants]


def _is_series(row: list[Any]) -> bool:
    return len(row) == 4 and isinstance(row[2], list)


def _ball(paths: Iterable[BallPath], end: float, size: float) -> Iterator[list[Any]]:
    """Return flights as [begin, x, y, vx, vy, ax, ay], and series as [begin, end, [x ...], [y ...]]."""
    for path, until in _with_ends(paths, end):
        if path.bent is not None and until > path.begin:
            for piece in pieces_of(path.at, path.begin, until, _SHARE * size):
                within = 0.1 * _ROUNDED * size
                yield [piece.begin, piece.end, _rounded(piece.x, within), _rounded(piece.y, within)]
        elif path.out:
            yield [path.begin, *_rounded((path.x, path.y), _ROUNDED * size), 0, 0, 0, 0]
        else:
            duration = max(until - path.begin, 1.0)
            places = _rounded((path.x, path.y), _ROUNDED * size)
            speeds = _rounded((path.vx, path.vy), _ROUNDED * size / duration)
            yield [path.begin, *places, *speeds, _short(path.ax), _short(path.ay)]


def _part(paths: Iterable[PartPath], end: float, size: float) -> Iterator[list[Any]]:
    for path, until in _with_ends(paths, end):
        within = _ROUNDED * min(size, 1.0)  # of metres, or radians
        rates = _rounded(path.rate, within / max(until - path.begin, 1.0))
        yield [path.begin, _rounded(path.place, within), rates]


def _with_ends(paths: Iterable[Any], end: float) -> Iterator[tuple[Any, float]]:
    """Return each path with the time at which it is over [s]."""
    paths = list(paths)
    return zip(paths, [*(path.begin for path in paths[1:]), end], strict=True)


def _change(change: Change) -> list[Any]:
    value = change.value
    return [change.time, change.element, change.field, [*value] if isinstance(value, tuple) else value]


def _new(score: Iterable[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    """Return where the score is another than before; it is 0 at first."""
    before = 0.0
    for time, points in score:
        if points != before:
            yield time, points
        before = points


def _event(row: Any) -> list[Any]:
    """Return [instant, kind, ball, element] and, of a ball's, [nx, ny, vx0, vy0]: the rest is in the paths."""
    whole = [float(row["time"]), int(row["kind"]), int(row["ball"]), int(row["element"])]
    if row["ball"] < 0:
        return whole
    return whole + [_short(float(row[name]), 6) for name in ("nx", "ny", "vx0", "vy0")]  # they are read, not drawn


def _rounded(numbers: Iterable[float], within: float) -> list[float]:
    """Return numbers with as many decimals as bring them `within` so much of what they were."""
    decimals = max(0, math.ceil(-math.log10(within)))
    return [_short(round(float(number), decimals), 17) for number in numbers]


def _short(number: float, digits: int = 13) -> float:
    """Return a number of so many digits; a whole one as an integer, which JSON writes shorter."""
    rounded = float(f"{number:.{digits}g}")
    return int(rounded) if rounded.is_integer() and abs(rounded) < 1e15 else rounded


def text_of(document: Mapping[str, Any]) -> str:
    """Return a document as JSON for the inside of a page: no text in it ends an element of HTML."""
    text = json.dumps(document, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")
