"""Measure every agent and every baseline on every game: `python -m agents.study`, which `make results` runs."""

import json
import multiprocessing
import subprocess
import sys
from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from agents.algorithms import ALGORITHMS
from agents.baselines import BASELINES
from agents.command import Refused, check_range, run, say
from agents.config import load_config
from agents.curve import Curve
from agents.evaluate import play
from agents.export import write_agent
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
    Study("Paddle, 200 levels", "Bounce/Paddle-v0", {"ppo": 3}, 6, LEVELS),
    Study("Paddle, unseen levels", "Bounce/Paddle-v0", {"ppo": 3}, 6, LEVELS, UNSEEN),
)


class Training(NamedTuple):
    """An agent to be trained. kwargs: of the environment, as JSON; {} for what the config says."""

    env_id: str
    kwargs: str
    algo: str
    seed: int

    @property
    def name(self) -> str:
        """Of its folder."""
        game = self.env_id.removeprefix("Bounce/").rsplit("-v", 1)[0].lower()
        kwargs = "".join(f"-{key}={value}" for key, value in json.loads(self.kwargs).items())
        return f"{game}{kwargs}-{self.algo}-{self.seed}"


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
    agents: Path | None = None
    """Folder for the best agent of each game, as a file that NumPy plays. Default: the folder agents of the output."""


def study(options: StudyOptions, studies: Sequence[Study] = STUDIES) -> int:
    """Train PPO with three seeds on each game, DQN and SAC once, and measure them and all baselines.

    Writes results.md (a table: mean score, its 95 % interval over trainings and episodes, normalised score, steps and
    seconds of a training), results.json and learning_curves.png, anew after each game, and the best agent of each game.
    At most an hour on two cores.
    """
    check_range("episodes", options.episodes, 2)
    check_range("processes", options.processes, 1)
    trainings = {training: None for one in studies for training in trainings_of(one)}  # each once, in this order
    context = multiprocessing.get_context("spawn")  # a forked child would inherit torch's threads
    with ProcessPoolExecutor(options.processes, mp_context=context) as pool:
        say(f"training {len(trainings)} agents; each writes to {options.output}/<training>/log.txt")
        made = {training: pool.submit(train_one, training, options) for training in trainings}
        folders = {training: future.result() for training, future in made.items()}
        say("measuring them and the baselines")
        asked = [scores_of(one, folders, options.episodes, pool) for one in studies]
        rows: list[Row] = []
        for k, (one, scores) in enumerate(zip(studies, asked, strict=True), start=1):
            played = {name: [f.result() for f in each] for name, each in scores.items()}
            rows += measured(one, played, folders)
            if not one.train_kwargs:
                say(f"{one.title}: {write_best(one, played, folders, options.agents or options.output / 'agents')}")
            write_results(options.output, rows, [panel(s, folders, rows) for s in studies[:k] if s.test_kwargs is None])
    say(table(rows).rstrip())
    say(f"all in {options.output}")
    return 0


def write_best(
    one: Study, played: Mapping[str, list[Scores]], folders: Mapping[Training, Path], output: Path
) -> Path:  # fmt: skip
    """Write the PPO agent with the highest mean score to a file; returns its path.

    It is the best of a few on the very episodes that its score is of, so that score is a little flattered.
    """
    trainings = [training for training in trainings_of(one) if training.algo == "ppo"]
    scores = dict(zip(trainings, played["PPO, argmax"], strict=True))
    best = max(trainings, key=lambda training: float(scores[training].mean()))
    return write_agent(folders[best], output, bootstrap([scores[best]]))


def write_results(output: Path, rows: list[Row], panels: list[Panel]) -> None:
    """Write the table, as Markdown and JSON, and the picture."""
    draw(panels, output / "learning_curves.png")
    write_text(output / "results.md", table(rows))
    content = {"versions": versions(), "rows": [asdict(row) for row in rows]}
    write_text(output / "results.json", json.dumps(content, indent=2) + "\n")


def trainings_of(one: Study) -> list[Training]:
    """Return what a study needs to have trained."""
    kwargs = json.dumps(dict(one.train_kwargs), sort_keys=True)
    return [Training(one.env_id, kwargs, algo, seed) for algo, seeds in one.agents.items() for seed in range(seeds)]


def train_one(training: Training, options: StudyOptions) -> Path:
    """Train an agent in a process of its own, unless it has been; returns its run folder.

    Raises Refused where the training failed, and where one that is there had other hyperparameters.
    """
    home, config = options.output / training.name, options.configs / f"{training.algo}.yml"
    if not list(home.glob("*/summary.json")):
        home.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, "-m", "agents.train", "--env-id", training.env_id, "--algo", training.algo]
        command += ["--seed", str(training.seed), "--config", str(config), "--output", str(home)]
        command += ["--no-progress-bar", "--episodes", "20"]
        command += ["--env-kwargs", training.kwargs] if training.kwargs != "{}" else []
        with (home / "log.txt").open("w", encoding="utf-8") as log:
            code = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
        if code:
            raise Refused(f"{home}: the training ended with {code}; see log.txt")
    folder = sorted(home.glob("*/summary.json"))[-1].parent
    kwargs = json.loads(training.kwargs)
    asked = load_config(config, training.env_id, {"env_kwargs": kwargs} if kwargs else {}, ALGORITHMS[training.algo])
    if open_run(folder).hyperparameters != asked:
        raise Refused(f"{home}: was trained with other hyperparameters than {config} has now: remove it")
    return folder


def scores_of(
    one: Study, folders: Mapping[Training, Path], episodes: int, pool: ProcessPoolExecutor
) -> dict[str, list[Future[Scores]]]:
    """Return the scores of each player, the baselines first, one entry for each training."""
    counts = {name: one.look_ahead if name == BEST else episodes for name in BASELINES[one.env_id]}
    scores = {name: [pool.submit(baseline_scores, one, name, count)] for name, count in counts.items()}
    for algo in one.agents:
        paths = [folders[training] for training in trainings_of(one) if training.algo == algo]
        for sampled in (False, True):
            futures = [pool.submit(agent_scores, one, path, episodes, sampled) for path in paths]
            scores[f"{algo.upper()}, {'sampled' if sampled else 'argmax'}"] = futures
    return scores


def measured(one: Study, scores: Mapping[str, list[Scores]], folders: Mapping[Training, Path]) -> list[Row]:
    """Return the rows of a study."""
    intervals = {name: bootstrap(each) for name, each in scores.items()}
    idle, best = intervals[IDLE].mean, intervals[BEST].mean
    rows = []
    for name, interval in intervals.items():
        normalised = None if name in (IDLE, BEST) else (interval.mean - idle) / (best - idle)
        trainings = [training for training in trainings_of(one) if name.startswith(f"{training.algo.upper()},")]
        summaries = [json.loads((folders[t] / "summary.json").read_text(encoding="utf-8")) for t in trainings]
        steps = summaries[0]["steps"] if summaries else None
        seconds = float(np.mean([summary["train_seconds"] for summary in summaries])) if summaries else None
        rows.append(Row(one.title, name, interval, normalised, steps, seconds))
    return rows


def baseline_scores(one: Study, name: str, episodes: int) -> Scores:
    """Return the scores of a baseline on the held-out episodes, (episodes,)."""
    return play(one.task, BASELINES[one.env_id][name](one.task), episodes).scores


def agent_scores(one: Study, folder: Path, episodes: int, sampled: bool) -> Scores:
    """Return the scores of a trained agent on the held-out episodes, (episodes,)."""
    kwargs = open_run(folder).task.env_kwargs if one.test_kwargs is None else one.test_kwargs
    task, players = named(str(folder), one.env_id, kwargs)
    return play(task, players["trained_sampled" if sampled else "trained"], episodes).scores


def panel(one: Study, folders: Mapping[Training, Path], rows: list[Row]) -> Panel:
    """Return the learning curves of a study, and its baselines."""
    curves: dict[str, list[Curve]] = {}
    for training in trainings_of(one):
        curves.setdefault(training.algo.upper(), []).append(Curve.read(folders[training]))
    levels = {r.player: r.interval.mean for r in rows if r.study == one.title and r.player in BASELINES[one.env_id]}
    return Panel(one.title, one.task.counted, curves, levels)


def table(rows: list[Row]) -> str:
    """Return the rows in Markdown."""
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
