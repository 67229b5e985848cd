"""A run in words and as a picture: the ledger with names for numbers, and the paths of balls among the elements."""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.memory.records import LEDGER, EventKind
from bounce_env.engine.recorded import BallPath, Recorded
from bounce_env.extras import missing
from bounce_env.replay.chebyshev import pieces_of
from bounce_env.scene import Arc, Bumper, Element, Field, Flipper, Paddle, Scene, Sensor
from bounce_env.wording import shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MOST_NAMES = 40
"""Of so many events at most a picture tells the elements: more names would hide the paths."""

_POINTS = 48
"""On a parabola, and on each series that a slide on a curve is drawn by."""

_NEAR = 1e-6
"""How far such a series may be from the path, as a share of the scene's size."""

_WALL, _SENSOR, _FIELD, _PART = "#3c4668", "#2f8f6a", "#6a70d8", "#16958c"
_BALLS = ("#d1495b", "#2e6fb7", "#b3791f", "#7a5195")


def element_name(scene: Scene, index: int) -> str:
    """Return how one calls an element: its name, or kind and index where it has none; beyond the elements a ball.

    index: as in the ledger's column `element`. Raises IndexError for a negative one.
    """
    if index < 0:
        raise IndexError(f"index = {index}: must be 0 or more")
    if index >= len(scene.elements):
        return f"ball {index - len(scene.elements)}"
    element = scene.elements[index]
    return element.name or f"{type(element).__name__.lower()} {index}"


def ledger_table(scene: Scene, ledger: npt.NDArray[Any]) -> list[dict[str, Any]]:
    """Return a ledger with words for numbers, one dict a row, as pandas.DataFrame takes it.

    scene: in which it was written. ledger: of `World.advance` (docs/physics.md, "Ledger"), shape (rows,). The keys are
    its columns, in its units: metres, seconds, m/s; `kind` is the kind in words, "bounce", and `element` the name of
    the element, or its kind and index. Raises ValueError for what is no ledger.
    """
    columns = getattr(getattr(ledger, "dtype", None), "names", None)
    if columns is None or columns != LEDGER.names:
        raise ValueError(f"ledger = {shown(ledger)}: must be what World.advance(..., ledger=True) returned")
    return [
        {
            **dict(zip(columns, row.item(), strict=True)),
            "kind": EventKind(int(row["kind"])).words,
            "element": element_name(scene, int(row["element"])),
        }
        for row in ledger
    ]


def plot_scene(scene: Scene, axes: "Axes | None" = None) -> "Axes":
    """Draw the elements of a scene where they are at first, in metres; return the axes.

    axes: matplotlib's, to draw on; None: a new figure with one. Walls and arcs are solid lines, sensors dashed, fields
    shaded, what moves in a colour of its own (docs/scenes.md). Raises ImportError where matplotlib is missing (extra
    `plot`).
    """
    if axes is None:
        try:
            from matplotlib import pyplot  # noqa: PLC0415
        except ModuleNotFoundError as error:
            raise missing("plot", str(error.name), "plots need") from error
        _, axes = pyplot.subplots(layout="constrained")
    for element in scene.elements:
        _draw_element(axes, element)
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    return axes


def plot_trajectory(run: Recorded, axes: "Axes | None" = None, *, names: bool = True) -> "Axes":
    """Draw the elements of a run and the paths of its balls, exactly, with the places of its events; return the axes.

    A ring marks where a ball begins, a disc where it is at last.

    run: of `World.recorded` or `env.unwrapped.recorded()`. axes: matplotlib's, to draw on; None: a new figure with one.
    names: whether bounces are labelled with the element's name, of the first 40 at most. Lengths are metres. The scene
    is drawn as by `plot_scene`. Paths are those of docs/physics.md, "Flight" and "Slides on curves". Raises TypeError
    for what is no run, ImportError where matplotlib is missing (extra `plot`).
    """
    if not isinstance(run, Recorded):
        raise TypeError(f"run = {shown(run)}: must be what World.recorded() returns, after World.record() and reset")
    axes = plot_scene(run.scene, axes)
    left, bottom, right, top = run.scene.bounds
    size = max(right - left, top - bottom, run.scene.ball.radius)
    for k, paths in enumerate(run.balls):
        colour = _BALLS[k % len(_BALLS)]
        points = np.array([*_points(paths, run.end, size)]).reshape(-1, 2)
        axes.plot(points[:, 0], points[:, 1], color=colour, linewidth=1.2, zorder=3)
        mine = run.ledger[run.ledger["ball"] == k]
        axes.plot(mine["x"], mine["y"], ".", color=colour, markersize=4, zorder=4)
        for place, inside in ((points[:1], "white"), (points[-1:], colour)):
            axes.plot(place[:, 0], place[:, 1], "o", color=colour, markersize=6, markerfacecolor=inside, zorder=4)
    if names:
        _label(axes, run)
    return axes


def _points(paths: Sequence[BallPath], end: float, size: float) -> Iterator[tuple[float, float]]:
    """Return points on the paths of a ball, so near to each other that their chords look round. size: of the scene."""
    for path, until in zip(paths, [*(path.begin for path in paths[1:]), end], strict=True):
        if path.out or until <= path.begin:
            yield path.at(path.begin)
        elif path.bent is not None:  # it may swing many times: as many points as series are needed
            for piece in pieces_of(path.at, path.begin, until, _NEAR * size):
                yield from map(path.at, np.linspace(piece.begin, piece.end, _POINTS).tolist())
        else:
            count = 2 if path.ax == path.ay == 0.0 else _POINTS
            yield from map(path.at, np.linspace(path.begin, until, count).tolist())


def _label(axes: "Axes", run: Recorded) -> None:
    """Write the elements of bounces beside them, a name no second time so near that the two would touch."""
    left, bottom, right, top = run.scene.bounds
    apart = 0.06 * max(right - left, top - bottom)
    told: list[tuple[str, float, float]] = []
    for row in run.ledger:
        if row["ball"] < 0 or len(told) >= _MOST_NAMES:
            continue
        name = element_name(run.scene, int(row["element"]))
        x, y, nx, ny = (float(row[column]) for column in ("x", "y", "nx", "ny"))
        if any(name == other and math.hypot(x - u, y - v) < apart for other, u, v in told):
            continue
        told.append((name, x, y))
        at = (7.0 * nx, 7.0 * ny)  # beside the surface, on the ball's side of it
        sides = ("left" if nx > 0.3 else "right" if nx < -0.3 else "center", "bottom" if ny > 0.3 else "top")
        axes.annotate(
            name, (x, y), at, textcoords="offset points", ha=sides[0], va=sides[1] if abs(ny) > 0.3 else "center",
            fontsize=7, color="#333333", zorder=5,
        )  # fmt: skip


def _draw_element(axes: "Axes", element: Element) -> None:
    """Draw an element, with its kind of line: walls and arcs solid, sensors dashed, fields shaded, parts thick."""
    match element:
        case Field():
            xs, ys = zip(*element.points, strict=True)
            axes.fill(xs, ys, color=_FIELD, alpha=0.12, linewidth=0)
        case Sensor() if element.segment is not None:
            _line(axes, element.segment, _SENSOR, "--")
        case Sensor():
            assert element.circle is not None
            _line(axes, _circle(*element.circle), _SENSOR, "--")
        case Bumper():
            _line(axes, _circle(element.center, element.radius), _PART if element.rail_end else _WALL)
        case Arc():
            _line(axes, _circle(element.center, element.radius, element.start_angle, element.end_angle), _WALL)
        case Flipper():
            (x, y), length, angle = element.pivot, element.length, element.rest_angle
            _capsule(axes, (x, y), (x + length * math.cos(angle), y + length * math.sin(angle)), element.radius)
        case Paddle():
            (x0, y0), (x1, y1) = element.rail_start, element.rail_end
            share = element.half_width / math.dist((x0, y0), (x1, y1))
            x, y, dx, dy = 0.5 * (x0 + x1), 0.5 * (y0 + y1), share * (x1 - x0), share * (y1 - y0)
            _capsule(axes, (x - dx, y - dy), (x + dx, y + dy), element.radius)
        case _:
            _line(axes, (element.start, element.end), _PART if element.draggable else _WALL)


def _line(axes: "Axes", points: Sequence[tuple[float, float]], colour: str, style: str = "-") -> None:
    xs, ys = zip(*points, strict=True)
    axes.plot(xs, ys, style, color=colour, linewidth=1.4, solid_capstyle="round", zorder=2)


def _capsule(axes: "Axes", start: tuple[float, float], end: tuple[float, float], radius: float) -> None:
    """Draw the outline of all points within a radius of a segment."""
    angle = math.atan2(end[1] - start[1], end[0] - start[0])
    quarter = 0.5 * math.pi
    tip = _circle(end, radius, angle - quarter, angle + quarter)
    back = _circle(start, radius, angle + quarter, angle + 3.0 * quarter)
    _line(axes, [*tip, *back, tip[0]], _PART)


def _circle(
    center: tuple[float, float], radius: float, start: float = 0.0, end: float = 2.0 * math.pi
) -> list[tuple[float, float]]:
    """Return points on a circle from one angle to another [rad], both included."""
    (x, y), angles = center, np.linspace(start, end, 2 + math.ceil(24 * (end - start))).tolist()
    return [(x + radius * math.cos(angle), y + radius * math.sin(angle)) for angle in angles]
