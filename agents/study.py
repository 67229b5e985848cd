"""Measure every agent and every baseline on every game: `python -m agents.study`, which `make results` runs."""

import json
import multiprocessing
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from agents.baselines import BASELINES
from agents.command import Refused, check_range, run, say
from agents.curve import Curve
from agents.evaluate import play
from agents.files import write_text
from agents.intervals import Interval, bootstrap
from agents.players import named
from agents.runs import open_run, versions
from agents.study_picture import Panel, draw
from agents.task import Task

Scores = npt.NDArray[np.float64]

IDLE, BEST = "nothing", "look_ahead"
"""The players that a normalised score sets to 0 and 1."""


@dataclass(frozen=True)
class Study:
    """A game as it is trained on and as it is measured; `agents`: how many trainings of each algorithm."""

    title: str
    env_id: str
    agents: Mapping[str, int]
    look_ahead: int  # episodes of the player that looks ahead, which is slow
    train_kwargs: Mapping[str, Any] = field(default_factory=dict)
    test_kwargs: Mapping[str, Any] | None = None  # None: as trained on

    @property
    def task(self) -> Task:
        """What is measured."""
        return Task(self.env_id, self.train_kwargs if self.test_kwargs is None else self.test_kwargs)


LEVELS = {"num_levels": 200}
UNSEEN = {"num_levels": 0, "start_level": 1_000_000}

STUDIES = (
    Study("Pinball", "Bounce/Pinball-v0", {"ppo": 3}, look_ahead=12),
    Study("Paddle", "Bounce/Paddle-v0", {"ppo": 3, "dqn": 1, "sac": 1}, look_ahead=8),
    Study("Walls", "Bounce/Walls-v0", {"ppo": 3}, look_ahead=8),
    Study("Paddle, 200 levels", "Bounce/Paddle-v0", {"ppo": 1}, 6, LEVELS),
    Study("Paddle, unseen levels", "Bounce/Paddle-v0", {"ppo": 1}, 6, LEVELS, UNSEEN),
)


@dataclass(frozen=True)
class Row:
    """A line of the table: a player on a game. `normalised`: None for the players that it is measured by."""

    study: str
    player: str
    interval: Interval
    normalised: float | None
    steps: int | None = None  # environment steps of one training
    seconds: float | None = None  # of one training, the mean


@dataclass(frozen=True)
class StudyOptions:
    """See `study`."""

    output: Path = Path("runs/results")
    """Folder for the run folders, the table and the picture. What is finished there already is not trained again."""
    episodes: int = 500
    """Held-out episodes of each player."""
    configs: Path = Path("configs")
    """Folder with the hyperparameters, <algo>.yml."""
    processes: int = 2
    """Trainings, and then evaluations, side by side."""
    steps: int | None = None
    """Environment steps of each training. Default: what the configs say."""


def study(options: StudyOptions, studies: Sequence[Study] = STUDIES) -> int:
    """Train PPO with three seeds on each game, DQN and SAC once, and measure them and all baselines.

    Writes results.md (a table: mean score, its 95 % interval over trainings and episodes, normalised score, steps and
    seconds of a training), results.json and learning_curves.png. At most an hour on two cores.
    """
    check_range("episodes", options.episodes, 2)
    check_range("processes", options.processes, 1)
    context = multiprocessing.get_context("spawn")  # a forked child would inherit torch's threads
    with ProcessPoolExecutor(options.processes, mp_context=context) as pool:
        trainings: dict[Any, Study] = {}
        for one in studies:
            for algo, seed in runs_of(one):
                trainings.setdefault((one.env_id, *kwargs_key(one), algo, seed), one)
        say(
            f"training {len(trainings)} agents, {options.processes} at a time; their output: {options.output}/*/log.txt"
        )
        made = {key: pool.submit(train_one, one, key[-2], key[-1], options) for key, one in trainings.items()}
        folders = {}
        for key, future in made.items():
            folders[key] = future.result()
            say(f"trained: {folders[key]}")
        rows = [row for one in studies for row in measured(one, folders, options.episodes, pool)]
    panels = [panel(one, folders, rows) for one in studies if one.test_kwargs is None]
    draw(panels, options.output / "learning_curves.png")
    write_text(options.output / "results.md", table(rows))
    content = {"versions": versions(), "rows": [asdict(row) for row in rows]}
    write_text(options.output / "results.json", json.dumps(content, indent=2) + "\n")
    say(table(rows).rstrip())
    say(f"all in {options.output}")
    return 0


def kwargs_key(one: Study) -> tuple[str]:
    """What trainings of one environment id differ in."""
    return (json.dumps(dict(one.train_kwargs), sort_keys=True),)


def runs_of(one: Study) -> Iterator[tuple[str, int]]:
    """Algorithm and seed of each training."""
    for algo, seeds in one.agents.items():
        for seed in range(seeds):
            yield algo, seed


def train_one(one: Study, algo: str, seed: int, options: StudyOptions) -> Path:
    """Train an agent in a process of its own; returns its run folder. Raises Refused where the training failed."""
    name = "-".join(one.title.lower().replace(",", "").split())
    home = options.output / f"{name}-{algo}-{seed}"
    finished = sorted(home.glob("*/summary.json"))
    if finished:
        return finished[-1].parent
    home.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-m", "agents.train", "--env-id", one.env_id, "--algo", algo, "--seed", str(seed)]
    command += ["--config", str(options.configs / f"{algo}.yml")]
    command += ["--output", str(home), "--no-progress-bar", "--episodes", "100"]
    command += ["--steps", str(options.steps)] if options.steps else []
    command += ["--env-kwargs", json.dumps(dict(one.train_kwargs))] if one.train_kwargs else []
    with (home / "log.txt").open("w", encoding="utf-8") as log:
        code = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
    finished = sorted(home.glob("*/summary.json"))
    if code or not finished:
        raise Refused(f"{home}: the training ended with {code}; see log.txt")
    return finished[-1].parent


def measured(one: Study, folders: Mapping[Any, Path], episodes: int, pool: ProcessPoolExecutor) -> list[Row]:
    """The rows of a study, the baselines first."""
    counts = {name: one.look_ahead if name == BEST else episodes for name in BASELINES[one.env_id]}
    scores = {name: [pool.submit(baseline_scores, one, name, count)] for name, count in counts.items()}
    trainings: dict[str, list[Path]] = {}
    for algo, seed in runs_of(one):
        trainings.setdefault(algo, []).append(folders[(one.env_id, *kwargs_key(one), algo, seed)])
    for algo, paths in trainings.items():
        for sampled in (False, True):
            name = f"{algo.upper()}, {'sampled' if sampled else 'argmax'}"
            scores[name] = [pool.submit(agent_scores, one, path, episodes, sampled) for path in paths]
    intervals = {name: bootstrap([future.result() for future in each]) for name, each in scores.items()}
    idle, best = intervals[IDLE].mean, intervals[BEST].mean
    rows = []
    for name, interval in intervals.items():
        paths = trainings.get(name.split(",")[0].lower(), [])
        summaries = [json.loads((path / "summary.json").read_text(encoding="utf-8")) for path in paths]
        normalised = None if name in (IDLE, BEST) else (interval.mean - idle) / (best - idle)
        rows.append(
            Row(
                one.title,
                name,
                interval,
                normalised,
                summaries[0]["steps"] if summaries else None,
                float(np.mean([s["train_seconds"] for s in summaries])) if summaries else None,
            )
        )
    return rows


def baseline_scores(one: Study, name: str, episodes: int) -> Scores:
    """The scores of a baseline on the held-out episodes, (episodes,)."""
    return play(one.task, BASELINES[one.env_id][name](one.task), episodes).scores


def agent_scores(one: Study, folder: Path, episodes: int, sampled: bool) -> Scores:
    """The scores of a trained agent on the held-out episodes, (episodes,)."""
    kwargs = open_run(folder).task.env_kwargs if one.test_kwargs is None else one.test_kwargs
    task, players = named(str(folder), one.env_id, kwargs)
    return play(task, players["trained_sampled" if sampled else "trained"], episodes).scores


def panel(one: Study, folders: Mapping[Any, Path], rows: list[Row]) -> Panel:
    """The learning curves of a study, and its baselines."""
    curves: dict[str, list[Curve]] = {}
    for algo, seed in runs_of(one):
        curves.setdefault(algo.upper(), []).append(Curve.read(folders[(one.env_id, *kwargs_key(one), algo, seed)]))
    levels = {r.player: r.interval.mean for r in rows if r.study == one.title and r.player in BASELINES[one.env_id]}
    return Panel(one.title, curves, levels)


def table(rows: list[Row]) -> str:
    """The rows in Markdown."""
    lines = [
        "| game | player | mean score | 95 % interval | N | trainings x episodes | steps | training |",
        "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for row in rows:
        i = row.interval
        digits = 0 if abs(i.mean) >= 1000.0 else 2
        normalised = {IDLE: "0", BEST: "1"}.get(row.player) or f"{row.normalised:.2f}"
        cost = "| | |" if row.steps is None else f"| {row.steps / 1e6:.1f} M | {row.seconds:.0f} s |"
        lines.append(
            f"| {row.study} | {row.player} | {i.mean:.{digits}f} | {i.lo:.{digits}f} to {i.hi:.{digits}f} "
            f"| {normalised} | {i.runs} x {i.episodes // i.runs} {cost}"
        )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    run(study, StudyOptions)
