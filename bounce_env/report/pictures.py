"""The pictures of the report, as PNG."""

import io
import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from bounce_env.report.model import ErrorRow, FeatureRow, SpeedRow

STYLES: Mapping[str, tuple[str, str]] = {
    "engine": ("#0b6e4f", "o"),
    "engine_frames": ("#238a68", "s"),
    "engine_batch": ("#08402e", "*"),
    "tutorial_recheck": ("#7a5195", "^"),
    "tutorial_once": ("#a05fb8", "v"),
    "moreau": ("#b3620a", "D"),
    "pymunk": ("#c0392b", "P"),
    "box2d": ("#2c6fbb", "X"),
    "scipy": ("#555555", "h"),
    "by_hand": ("#6f6f6f", "p"),
    "billiards": ("#8a6a08", "d"),
}
"""Colour and marker of each method: the same in all pictures, and told apart without colour."""

SMALLEST = 1e-17
"""An error of nothing is drawn here [m]: a logarithm has no zero."""


def work_precision(rows: Sequence[ErrorRow], labels: Mapping[str, str], unit: str) -> bytes:
    """Draw error against run time of one problem, one line a method, labelled at its end."""
    figure, axes = _figure(8.6, 5.0)
    figure.subplots_adjust(left=0.1, right=0.68, top=0.97, bottom=0.12)
    ends: list[_End] = []
    for method, (colour, marker) in STYLES.items():
        points = sorted(
            (row.cost.median, max(row.error.median, SMALLEST), row.error.low, row.error.high)
            for row in rows
            if row.method == method and row.cost and row.error and math.isfinite(row.error.median)
        )
        if not points:
            continue
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        low = [max(y - max(p[2], SMALLEST), 0.0) for y, p in zip(ys, points, strict=True)]
        high = [max((p[3] if math.isfinite(p[3]) else y) - y, 0.0) for y, p in zip(ys, points, strict=True)]
        axes.errorbar(
            xs, ys, yerr=(low, high), color=colour, marker=marker, markersize=7, linewidth=1.4, elinewidth=0.8
        )
        ends.append(_End(xs[-1], ys[-1], labels.get(method, method), colour))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("CPU time for a simulated second [µs], one core")
    axes.set_ylabel(f"error of the place [{unit}]")
    _label_ends(axes, ends)
    return _png(figure)


class _End(NamedTuple):
    """Where a line ends, and what is written there."""

    x: float
    y: float
    name: str
    colour: str


GAP = 0.062
"""Between two names, as a share of the height."""


def _label_ends(axes: Axes, ends: Sequence[_End]) -> None:
    """Write each line's name to the right of the plot, with a thin line from its last point, none over another."""
    axes.autoscale_view()
    bottom, top = map(math.log, axes.get_ylim())
    # Of equally accurate ones that to the right comes last, so that its line crosses none.
    ordered = sorted(ends, key=lambda end: (round(math.log(end.y), 1), -end.x))
    heights = [(math.log(end.y) - bottom) / (top - bottom) for end in ordered]
    for k in range(1, len(heights)):
        heights[k] = max(heights[k], heights[k - 1] + GAP)
    limit = 0.98
    for k in reversed(range(len(heights))):
        heights[k] = min(heights[k], limit)
        limit = heights[k] - GAP
    for end, height in zip(ordered, heights, strict=True):
        line = {"arrowstyle": "-", "color": end.colour, "linewidth": 0.5, "shrinkB": 4, "relpos": (0.0, 0.5)}
        axes.annotate(
            end.name, xy=(end.x, end.y), xycoords="data", xytext=(1.03, height), textcoords="axes fraction",
            color=end.colour, fontsize=9.5, va="center", arrowprops=line,
        )  # fmt: skip


def features_picture(rows: Sequence[FeatureRow]) -> bytes:
    """Draw what a bounce costs on the kernel of a scene's own features, and on the general one."""
    kept = [row for row in rows if row.lean_bounce and row.general_bounce]
    figure, axes = _figure(8.6, 1.2 + 0.42 * len(kept))
    figure.subplots_adjust(left=0.2, right=0.93, top=0.96, bottom=0.75 / (1.2 + 0.42 * len(kept)))
    for k, row in enumerate(reversed(kept)):
        lean, general = row.lean_bounce or 0.0, row.general_bounce or 0.0
        axes.plot([lean, general], [k, k], color="#bbbbbb", linewidth=2, zorder=1)
        axes.plot(lean, k, marker="o", color="#0b6e4f", markersize=8, linestyle="none")
        axes.plot(general, k, marker="s", color="#c0392b", markersize=7, linestyle="none")
        if k == len(kept) - 1:
            first, second = ("right", "left") if lean <= general else ("left", "right")
            for x, name, side, colour in ((lean, "own", first, "#0b6e4f"), (general, "general", second, "#c0392b")):
                axes.text(x, k + 0.28, f" {name} kernel ", ha=side, va="bottom", color=colour, fontsize=9.5)
    axes.set_yticks(range(len(kept)), [row.scene for row in reversed(kept)])
    axes.set_ylim(-0.6, len(kept) - 0.1)
    axes.set_xscale("log")
    costs = [cost for row in kept for cost in (row.lean_bounce, row.general_bounce) if cost]
    if costs:
        axes.set_xlim(min(costs) / 1.8, max(costs) * 1.8)  # room for the labels
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("CPU time for a bounce, its flight included [ns]")
    return _png(figure)


def speed_picture(rows: Sequence[SpeedRow]) -> bytes:
    """Draw steps a second against the number of worlds, one line a game."""
    figure, axes = _figure(8.6, 4.6)
    figure.subplots_adjust(left=0.1, right=0.72, top=0.97, bottom=0.13)
    lines = sorted({row.what for row in rows if row.what.endswith(", vector env")})
    marks = dict(zip(lines, zip(("#0b6e4f", "#c0392b", "#2c6fbb", "#555555"), "osDX", strict=False), strict=False))
    ends = []
    for what, (colour, marker) in marks.items():
        points = sorted((row.worlds, row.rate.median) for row in rows if row.what == what)
        xs, ys = [p[0] for p in points], [p[1] for p in points]
        axes.plot(xs, ys, color=colour, marker=marker, markersize=7, linewidth=1.4)
        ends.append(_End(xs[-1], ys[-1], what.removesuffix(", vector env"), colour))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("worlds of one vector environment")
    axes.set_ylabel("environment steps a second, one core")
    _label_ends(axes, ends)
    return _png(figure)


def _figure(width: float, height: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), dpi=110)
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.grid(visible=True, which="major", color="#e4e4e4", linewidth=0.7)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return figure, axes


def _png(figure: Figure) -> bytes:
    out = io.BytesIO()
    figure.savefig(out, format="png", metadata={"Software": None})
    return out.getvalue()
