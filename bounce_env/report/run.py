"""The runner: one list of jobs for all parts, with progress, resumed where it was interrupted."""

import datetime
import json
import os
import platform
import subprocess
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from bounce_env.engine.compile.cache import PACKAGE
from bounce_env.extras import version
from bounce_env.files import hash_of_files, replacing
from bounce_env.machine import processor
from bounce_env.report.errors import Plan, jobs
from bounce_env.report.features import BASE, kernel_sets, measure_cost, measure_features
from bounce_env.report.methods import all_methods
from bounce_env.report.methods.base import Method
from bounce_env.report.model import Report, Row, from_json, part_of, to_json
from bounce_env.report.problems import PROBLEMS, Problem
from bounce_env.report.speed import speed_jobs
from bounce_env.report.stability.cases import CASES
from bounce_env.report.stability.measure import measure_case
from bounce_env.report.stability.mechanisms import MECHANISMS, tried_cases
from bounce_env.scene import ALL_FEATURES, builtin_scenes, load_scene
from bounce_env.scene.features import ALL_FOR_ONE_BALL

PARTS = ("error", "stability", "features", "speed")
"""What `report` can be asked for, besides all."""

QUICK_FEATURES = ("elastic_box",)


@dataclass(frozen=True)
class Job:
    """One row to measure."""

    part: str
    name: str
    measure: Callable[[], Row]


@dataclass(frozen=True)
class Options:
    """What is asked for. parts: some of PARTS. scenes, methods: () for all."""

    parts: tuple[str, ...] = PARTS
    quick: bool = False
    seed: int = 0
    scenes: tuple[str, ...] = ()
    methods: tuple[str, ...] = ()


def planned(options: Options) -> tuple[list[Job], tuple[Method, ...]]:
    """Return all jobs, and the methods that they are of."""
    # Quick, all problems run on the one kernel that has every feature: nothing has to be compiled for a scene.
    methods = all_methods(ALL_FOR_ONE_BALL if options.quick else ())
    found: list[Job] = []
    if "error" in options.parts:
        found += [Job("error", name, partial(f, *a)) for name, f, a in jobs(*_chosen(options, methods), _plan(options))]
    if "stability" in options.parts and not (options.scenes or options.methods):
        found += _stability_jobs(options)
    if "features" in options.parts:
        found += _feature_jobs(options)
    if "speed" in options.parts and not (options.scenes or options.methods):
        found += [Job("speed", name, measure) for name, measure in speed_jobs(quick=options.quick)]
    return found, methods


def _chosen(options: Options, methods: Sequence[Method]) -> tuple[list[Method], list[Problem]]:
    problems = [p for p in PROBLEMS if not options.scenes or p.name in options.scenes]
    return [m for m in methods if not options.methods or m.name in options.methods], problems


def _plan(options: Options) -> Plan:
    if options.quick:
        return Plan(options.seed, starts=3, shortest=2e-4, bounces=20_000, longer=3, quick=True)
    return Plan(options.seed, starts=20, shortest=2e-3, bounces=1_000_000, longer=8, quick=False)


def _stability_jobs(options: Options) -> list[Job]:
    most_cases, most_steps = (2, 2000) if options.quick else (len(CASES), 60_000)
    return [
        Job(
            "stability",
            f"stability {mechanism.name}: {words}",
            partial(measure_case, mechanism, case, image, words, most_steps),
        )
        for mechanism in MECHANISMS
        for case, image, words in list(tried_cases(mechanism))[:most_cases]
    ]


def _feature_jobs(options: Options) -> list[Job]:
    if options.methods:
        return []
    names = [
        name
        for name in (QUICK_FEATURES if options.quick else builtin_scenes())
        if not options.scenes or name in options.scenes
    ]
    costs = [] if options.quick or options.scenes else sorted(ALL_FEATURES - load_scene(BASE).features)
    compiled = frozenset() if options.quick else kernel_sets(names, costs)
    pieces = 20 if options.quick else 100
    return [
        Job("features", f"features {name}", partial(measure_features, name, pieces=pieces, compiled=compiled))
        for name in names
    ] + [
        Job("features", f"cost of {feature}", partial(measure_cost, feature, pieces=pieces, compiled=compiled))
        for feature in costs
    ]


def header_of(options: Options, methods: Iterable[Method]) -> dict[str, Any]:
    """Return where, when and with which options a report is made."""
    return {
        "made": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "bounce_env": version(),
        "commit": _commit(),
        "python": platform.python_version(),
        "processor": processor(),
        "cores": os.cpu_count(),
        "load": [round(x, 2) for x in os.getloadavg()] if hasattr(os, "getloadavg") else None,
        "quick": options.quick,
        "seed": options.seed,
        "parts": list(options.parts),
        "scenes": list(options.scenes),
        "only_methods": list(options.methods),
        "methods": {m.name: {"label": m.label, "note": m.note} for m in methods},
    }


def _commit() -> str | None:
    try:
        words = ["git", "-C", str(PACKAGE), "describe", "--always", "--dirty", "--abbrev=12"]
        return subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip() or None
    except (OSError, subprocess.CalledProcessError):
        return None


class Store:
    """Rows that are measured, kept in a file as they come, for a run that goes on after an interruption.

    They are those of the same sources, scenes and options only. A line that is damaged is measured again.
    interrupted: rows that lie there of an interrupted run, whether they are taken over (`resume`) or not.
    """

    def __init__(self, path: Path, options: Options, *, resume: bool) -> None:
        self._path = path
        sources = [path for kind in ("*.py", "*.toml") for path in PACKAGE.rglob(kind)]
        self._key = [hash_of_files(sources, PACKAGE), repr(options)]
        found = self._read()
        self.interrupted = len(found)
        self.rows: dict[str, Row] = found if resume else {}
        lines = [json.dumps(self._key), *(self._line(name, row) for name, row in self.rows.items())]
        with replacing(path) as unfinished:
            unfinished.write_text("\n".join(lines) + "\n", encoding="utf-8")

    def _read(self) -> dict[str, Row]:
        rows: dict[str, Row] = {}
        try:
            lines = self._path.read_text(encoding="utf-8").splitlines()
            if not lines or json.loads(lines[0]) != self._key:
                return rows
        except (OSError, ValueError):
            return rows
        for line in lines[1:]:
            try:
                name, part, plain = json.loads(line)
                rows[str(name)] = from_json(part, plain)
            except (TypeError, ValueError):
                continue
        return rows

    def keep(self, name: str, row: Row) -> None:
        """Append a row."""
        self.rows[name] = row
        with self._path.open("a", encoding="utf-8") as file:
            file.write(self._line(name, row) + "\n")

    @staticmethod
    def _line(name: str, row: Row) -> str:
        return json.dumps([name, part_of(row), to_json(row)])

    def remove(self) -> None:
        """Forget all: the report is written."""
        self._path.unlink(missing_ok=True)


def run(
    todo: Sequence[Job], header: dict[str, Any], store: Store, progress: Callable[[Collection[Job]], Iterable[Job]]
) -> Report:
    """Measure all that is not in the store yet, and return the report. progress: shows the jobs as they are done."""
    report = Report(header)
    for job in progress([job for job in todo if job.name not in store.rows]):
        store.keep(job.name, job.measure())
    for job in todo:
        report.add(store.rows[job.name])
    return report
