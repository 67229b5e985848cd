"""The learning curve: kept while training, written as CSV, drawn as PNG."""

import csv
import io
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Self

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from agents.colours import colour_of
from agents.files import replacing, write_text
from agents.results import Episodes, estimate

NAME = "learning_curve"


@dataclass(frozen=True)
class Point:
    """The episodes that ended in one rollout."""

    steps: int  # environment steps at the rollout's end
    seconds: float  # of training
    episodes: int
    mean_score: float
    mean_length: float  # s of play


@dataclass
class Curve:
    """Points in order of their steps."""

    points: list[Point] = field(default_factory=list)

    @property
    def seconds(self) -> float:
        """How long the training has taken."""
        return self.points[-1].seconds if self.points else 0.0

    def cut(self, steps: int) -> None:
        """Forget what came after `steps`."""
        self.points = [point for point in self.points if point.steps <= steps]

    def write(self, folder: Path) -> None:
        """Write learning_curve.csv."""
        text = io.StringIO()
        writer = csv.DictWriter(text, [f.name for f in fields(Point)], lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(point) for point in self.points)
        write_text(folder / f"{NAME}.csv", text.getvalue())

    @classmethod
    def read(cls, folder: Path) -> Self:
        """Return the curve in a run folder; empty where there is none."""
        path = folder / f"{NAME}.csv"
        if not path.exists():
            return cls()
        rows = csv.DictReader(path.read_text(encoding="utf-8").splitlines())
        return cls([Point(**{f.name: f.type(row[f.name]) for f in fields(Point)}) for row in rows])


def draw(
    curve: Curve, played: Mapping[str, Episodes], title: str, folder: Path, *, algo: str, counted: str
) -> Path:  # fmt: skip
    """Write learning_curve.png: the score in training, and as levels what was measured on held-out episodes.

    algo: what was trained with, for its colour; counted: what the score counts, for the axis.
    """
    figure = Figure(figsize=(8, 5), dpi=120, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    millions = [point.steps / 1e6 for point in curve.points]
    axes.plot(
        millions, [p.mean_score for p in curve.points], color=colour_of(algo), label="in training (sampled actions)"
    )
    for name, episodes in played.items():
        level, colour = estimate(episodes.scores), colour_of(name, algo)
        style = ":" if name.endswith("sampled") else "--"
        axes.axhline(level.mean, color=colour, linestyle=style, label=f"{name}: {level.mean:.1f}")
        axes.axhspan(level.lo, level.hi, color=colour, alpha=0.15, linewidth=0)
    axes.set_xlabel("environment steps (millions)")
    axes.set_ylabel(f"mean {counted} per episode")
    axes.set_title(f"{title}\nlevels: held-out episodes, mean and 95 % interval", fontsize="medium")
    axes.set_ylim(bottom=0.0)
    axes.legend(fontsize="small")
    path = folder / f"{NAME}.png"
    with replacing(path) as unfinished:
        figure.savefig(unfinished)
    return path
