"""The learning curves of several games in one picture."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from agents.colours import colour_of
from agents.curve import Curve
from agents.files import replacing

COLUMNS = 2
LEFT_OUT = "look_ahead"
"""It would squeeze all others to the bottom; the table has it."""


@dataclass(frozen=True)
class Panel:
    """One game: the curves of each algorithm's trainings, and the mean score of each baseline.

    counted: what the score counts, for the axis.
    """

    title: str
    counted: str
    curves: Mapping[str, Sequence[Curve]]
    levels: Mapping[str, float]


def draw(panels: Sequence[Panel], path: Path) -> None:
    """Write the picture, one plot for each panel."""
    rows = -(-len(panels) // COLUMNS)
    figure = Figure(figsize=(10, 3.8 * rows), dpi=120, layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(rows, COLUMNS, squeeze=False).ravel().tolist()
    for axes, panel in zip(grid, panels, strict=False):
        _draw(axes, panel)
    for axes in grid[len(panels) :]:
        axes.axis("off")
    with replacing(path) as unfinished:
        figure.savefig(unfinished)


def _rounded(score: float) -> str:
    return f"{score:,.0f}" if abs(score) >= 100.0 else f"{score:.1f}"


def _draw(axes: Axes, panel: Panel) -> None:
    for algo, curves in panel.curves.items():
        for i, curve in enumerate(curves):
            label = f"{algo}, {len(curves)} trainings" if len(curves) > 1 else algo
            axes.plot(
                [point.steps / 1e6 for point in curve.points],
                [point.mean_score for point in curve.points],
                color=colour_of(algo),
                linewidth=1.0,
                alpha=0.8,
                label=label if i == 0 else None,
            )
    shown = {name: mean for name, mean in panel.levels.items() if name != LEFT_OUT}
    for name, mean in shown.items():
        axes.axhline(mean, color=colour_of(name), linestyle="--", linewidth=1.0, label=f"{name}: {_rounded(mean)}")
    axes.set_title(panel.title)
    axes.set_xlabel("environment steps (millions)")
    axes.set_ylabel(f"mean {panel.counted} in training")
    axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]))
    axes.legend(fontsize="x-small", loc="lower right")  # what is learned rises: no curve comes there
