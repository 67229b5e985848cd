"""What the report is made of: rows of numbers, and how they are written to JSON and CSV, and read again."""

import csv
import dataclasses
import io
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from bounce_env.files import replacing
from bounce_env.wording import shown

SCHEMA = 1
"""Version of `report.json`; it grows by one when a reader of the last one would misread it."""


@dataclass(frozen=True)
class Spread:
    """A median with its quartiles, over starts. Infinite where a run came to no end."""

    median: float
    low: float
    high: float


@dataclass(frozen=True)
class ErrorRow:
    """One method at one setting on one problem.

    reason: why there are no numbers; "" where there are. error: the greatest distance from the truth at the times that
    are compared [m], where the problem is chaotic over the growth of a small error. cost: microseconds of CPU for a
    simulated second. wrong_order: share of starts with a wrong order of bounces; None where it is not compared.
    missed: bounces fewer than there are, in all starts. lost: share of starts that left the scene or came to no end.
    """

    problem: str
    method: str
    setting: str
    reason: str = ""
    error: Spread | None = None
    cost: Spread | None = None
    wrong_order: float | None = None
    missed: int | None = None
    lost: float | None = None
    starts: int = 0


@dataclass(frozen=True)
class LongRow:
    """One method on one problem, for long.

    energy: share of the energy that is gained or lost after so many `bounces`. right_bounces: how many come in the
    right order before the first wrong one (median over starts), `of` so many that were compared.
    """

    problem: str
    method: str
    setting: str
    reason: str = ""
    energy: float | None = None
    bounces: int | None = None
    right_bounces: float | None = None
    of: int | None = None


@dataclass(frozen=True)
class FeatureRow:
    """A built-in scene on the kernel of its own features (lean), and on the one that has them all (general).

    step: ns of CPU for a world's step in which nothing happens, in a batch. bounce: ns of CPU for a flight and its
    bounce; None where balls do not bounce for long. compile, bytes: seconds of compiling and machine code of the
    kernel that advances a batch; None where that was not measured.
    """

    scene: str
    has: tuple[str, ...]
    left_out: tuple[str, ...]
    lean_step: float
    general_step: float
    lean_bounce: float | None
    general_bounce: float | None
    lean_compile: float | None
    general_compile: float | None
    lean_bytes: int | None
    general_bytes: int | None


@dataclass(frozen=True)
class FeatureCostRow:
    """What one feature costs a scene that does not need it: `scene` with it forced on, against `scene` without.

    step, bounce: ns of CPU, as in a FeatureRow; compile, bytes: seconds of compiling and machine code. `lean_...`: the
    same without it.
    """

    feature: str
    scene: str
    step: float
    lean_step: float
    bounce: float
    lean_bounce: float
    compile: float
    lean_compile: float
    bytes: int
    lean_bytes: int


@dataclass(frozen=True)
class SpeedRow:
    """How fast something steps: `rate` a second on one core, of so many `worlds`, median and quartiles over rounds."""

    what: str
    peer: bool
    worlds: int
    unit: str
    rate: Spread


@dataclass(frozen=True)
class StabilityRow:
    """One hard case.

    kind: stiff, extreme or degenerate. why: what makes it hard. source: where the right answer comes from. what: of all
    that the case expects the worst, with `expected`, `seen`, `error` and the `bound` that was stated beforehand (SI
    units; of what is no number 0 is right and 1 wrong). cost: microseconds of CPU of the whole run, with its ledger.
    pymunk, box2d, tutorial: where these have the ball at the end, at 1/960 s.
    """

    mechanism: str
    kind: str
    case: str
    why: str
    source: str
    what: str
    expected: str
    seen: str
    error: float
    bound: float
    verdict: str
    cost: float
    pymunk: str
    box2d: str
    tutorial: str


Row = ErrorRow | LongRow | StabilityRow | FeatureRow | FeatureCostRow | SpeedRow

PARTS: dict[str, type[Row]] = {
    "errors": ErrorRow,
    "long": LongRow,
    "stability": StabilityRow,
    "features": FeatureRow,
    "costs": FeatureCostRow,
    "speed": SpeedRow,
}
"""The parts of a report by their names in `report.json`."""

_READERS: dict[str, TypeAdapter[Any]] = {part: TypeAdapter(kind) for part, kind in PARTS.items()}


@dataclass
class Report:
    """Rows of each part, in the order of their measuring. header: where, when and with which options it was made."""

    header: dict[str, Any]
    errors: list[ErrorRow] = field(default_factory=list)
    long: list[LongRow] = field(default_factory=list)
    stability: list[StabilityRow] = field(default_factory=list)
    features: list[FeatureRow] = field(default_factory=list)
    costs: list[FeatureCostRow] = field(default_factory=list)
    speed: list[SpeedRow] = field(default_factory=list)

    @property
    def rows(self) -> dict[str, list[Any]]:
        """The rows by the names of their parts; of those that have any."""
        return {part: rows for part in PARTS if (rows := getattr(self, part))}

    def add(self, row: Row) -> None:
        """Put a row into its part."""
        getattr(self, part_of(row)).append(row)


def part_of(row: Row) -> str:
    """Return the name of the part that a row belongs to."""
    return next(part for part, kind in PARTS.items() if isinstance(row, kind))


def to_json(row: Row) -> dict[str, Any]:
    """Return a row as JSON has it: what is not finite as a word, for JSON has no such numbers."""
    plain: dict[str, Any] = _spelled(dataclasses.asdict(row))
    return plain


def _spelled(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _spelled(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_spelled(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"
    return value


def from_json(part: str, plain: Mapping[str, Any]) -> Row:
    """Return the row that `to_json` wrote; raises ValueError for what is none."""
    if part not in PARTS or not isinstance(plain, Mapping):
        raise ValueError(f"{shown(part)}: must be a row of one of {', '.join(PARTS)}")
    kind = PARTS[part]
    names = {f.name for f in dataclasses.fields(kind)}
    if set(plain) - names:
        raise ValueError(f"{part}: unknown fields {sorted(set(plain) - names)}, must be of {sorted(names)}")
    try:
        row: Row = _READERS[part].validate_python(plain)
    except ValidationError as error:
        wrong = error.errors()[0]
        where = ".".join(map(str, wrong["loc"]))
        raise ValueError(f"{part}: {where} = {shown(wrong['input'])}: {wrong['msg']}") from error
    return row


def write_report(report: Report, path: Path) -> None:
    """Write `report.json`."""
    rows = {part: [to_json(row) for row in getattr(report, part)] for part in PARTS}
    with replacing(path) as unfinished:
        text = json.dumps({"schema": SCHEMA, "header": report.header, **rows}, indent=1, allow_nan=False)
        unfinished.write_text(text + "\n", encoding="utf-8")


def read_report(path: Path) -> Report:
    """Read a `report.json`; raises ValueError that says what of it is wrong."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise ValueError(f"{path}: cannot be read as a report: {error}") from error
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        found = data.get("schema") if isinstance(data, dict) else None
        raise ValueError(f"{path}: schema = {found!r}: must be {SCHEMA}")
    report = Report(data.get("header", {}))
    try:
        for part in PARTS:
            for plain in data.get(part, []):
                report.add(from_json(part, plain))
    except (TypeError, ValueError) as error:
        raise ValueError(f"{path}: {error}") from error
    return report


def write_csv(rows: Iterable[Row], path: Path) -> None:
    """Write rows of one part as a table, a spread as three columns."""
    flat = [_flat(row) for row in rows]
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, list(flat[0]) if flat else [])
    writer.writeheader()
    writer.writerows(flat)
    with replacing(path) as unfinished:
        unfinished.write_text(text.getvalue(), encoding="utf-8")


def _flat(row: Row) -> dict[str, Any]:
    columns: dict[str, Any] = {}
    for f in dataclasses.fields(row):
        value = getattr(row, f.name)
        if f.type in (Spread, Spread | None):
            for share in ("median", "low", "high"):
                columns[f"{f.name}_{share}"] = None if value is None else getattr(value, share)
        else:
            columns[f.name] = " ".join(value) if isinstance(value, tuple) else value
    return columns
