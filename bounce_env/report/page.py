"""The page: one HTML file that stands alone, its pictures inside."""

import base64
import math
from collections.abc import Mapping, Sequence
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

from bounce_env.report.model import ErrorRow, Report, Spread
from bounce_env.report.pictures import STYLES, features_picture, speed_picture, work_precision
from bounce_env.report.problems import PROBLEMS, Problem
from bounce_env.report.winners import pairs_compared, wins_of_peers


def pictures_of(report: Report) -> dict[str, bytes]:
    """Return the report's pictures as PNG, by file name."""
    labels = {name: method["label"] for name, method in report.header["methods"].items()}
    pictures = {}
    for problem in PROBLEMS:
        rows = [row for row in report.errors if row.problem == problem.name]
        if any(row.error for row in rows):
            pictures[f"error_{problem.name}.png"] = work_precision(rows, labels, _unit(problem))
    if any(row.lean_bounce and row.general_bounce for row in report.features):
        pictures["features.png"] = features_picture(report.features)
    if any(row.what.endswith(", vector env") for row in report.speed):
        pictures["speed.png"] = speed_picture(report.speed)
    return pictures


def _unit(problem: Problem) -> str:
    return "m, divided by growth" if problem.chaotic else "m"


def page_of(report: Report, pictures: Mapping[str, bytes]) -> str:
    """Return the page as HTML."""
    environment = Environment(
        loader=PackageLoader("bounce_env.report", "templates"),
        autoescape=select_autoescape(default=True),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    filters: dict[str, Any] = {"spread": _spread, "number": _number, "share": _share, "rate": _rate}
    environment.filters |= filters
    template = environment.get_template("report.html.jinja")
    order = list(STYLES)
    problems = [
        {
            "problem": problem,
            "unit": _unit(problem),
            "picture": f"error_{problem.name}.png",
            "rows": sorted(rows, key=lambda row: order.index(row.method)),
            "alt": _alt(problem, rows),
        }
        for problem in PROBLEMS
        if (rows := [row for row in report.errors if row.problem == problem.name])
    ]
    return template.render(
        report=report,
        header=report.header,
        methods=report.header["methods"],
        problems=problems,
        wins=wins_of_peers(report.errors),
        pairs=pairs_compared(report.errors),
        command=_command(report.header),
        pictures={name: base64.b64encode(data).decode() for name, data in pictures.items()},
        any=any,
    )


def _command(header: Mapping[str, Any]) -> str:
    """Return the command that makes this report again."""
    words = ["python -m bounce_env report", *(header["parts"] if len(header["parts"]) == 1 else ())]
    words += ["--quick"] * header["quick"] + [f"--seed {header['seed']}"] * bool(header["seed"])
    only = [*header["scenes"], *header["only_methods"]]
    return " ".join([*words, *([f"--only {','.join(only)}"] if only else [])])


def _alt(problem: Problem, rows: Sequence[ErrorRow]) -> str:
    """Return the picture in a sentence, for those who do not see it."""
    measured = [row for row in rows if row.error is not None and row.cost is not None]
    peers = [row for row in measured if not row.method.startswith("engine") and math.isfinite(row.error.median)]  # type: ignore[union-attr]
    own = next((row for row in measured if row.method == "engine"), None)
    words = [f"Error against CPU time, both logarithmic, on the problem {problem.title}."]
    if own is not None and own.error is not None and own.cost is not None:
        words.append(f"bounce_env at one call: {own.error.median:.1e} at {own.cost.median:.3g} microseconds.")
    if peers:
        best = min(peers, key=lambda row: row.error.median)  # type: ignore[union-attr]
        assert best.error is not None
        assert best.cost is not None
        words.append(
            f"The most accurate other method, {best.method} at {best.setting}: {best.error.median:.1e} at "
            f"{best.cost.median:.3g} microseconds."
        )
    return " ".join(words)


def _spread(value: Spread | None, style: str = ".1e") -> str:
    if value is None:
        return ""
    if not math.isfinite(value.median):
        return "no end"
    return f"{value.median:{style}} ({_number(value.low, style)} to {_number(value.high, style)})"


def _number(value: Any, style: str = ".3g") -> str:
    if value is None:
        return ""
    return f"{value:{style}}" if math.isfinite(value) else "no end"


def _share(value: float | None) -> str:
    return "" if value is None else f"{100 * value:.0f} %"


def _rate(value: float) -> str:
    for size, name in ((1e6, "million"), (1e3, "thousand")):
        if value >= size:
            return f"{value / size:.3g} {name}"
    return f"{value:.3g}"
