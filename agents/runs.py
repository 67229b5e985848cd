"""Run folders: what a training writes, under which names, and how it is found again.

    runs/<id>-<time>/
      config.yml           the hyperparameters, all of them, in the RL Zoo's format; seed and versions
      model.zip            the newest checkpoint, at the end the trained model
      learning_curve.csv   and .png
      tensorboard/
      rollout.mp4          and .gif
      summary.json

A model.zip is SB3's own format, which can run code when it is loaded: load only files that you trust.
"""

import platform
import time
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import yaml
from stable_baselines3.common.vec_env import VecEnv

from agents.algorithms import ALGORITHMS, Algorithm, Hyperparameters, Model
from agents.command import Refused
from agents.config import Seed, Strict, checked, read_yaml
from agents.files import replacing, write_text
from agents.task import Task

PACKAGES = ("bounce_env", "gymnasium", "numpy", "numba", "stable-baselines3", "torch")

HEADER = """\
# A finished or interrupted training. `python -m agents.train --resume FOLDER` goes on with it;
# `python -m agents.train --config THIS_FILE` does it again.
"""


def versions() -> dict[str, str]:
    """Versions of Python and of all that decides the result of a training."""
    return {"python": platform.python_version(), **{name: version(name) for name in PACKAGES}}


class Origin(Strict):
    """The part of a run's config that is not hyperparameters."""

    env_id: str
    algo: Algorithm = "ppo"
    seed: Seed
    versions: dict[str, str]


@dataclass(frozen=True)
class Run:
    """A training: what is trained on what, and the folder that holds it."""

    folder: Path
    task: Task
    algo: str
    hyperparameters: Hyperparameters
    seed: int
    versions: dict[str, str]

    @property
    def model(self) -> Path:
        """The newest checkpoint."""
        return self.folder / "model.zip"

    def save_model(self, model: Model) -> None:
        """Replace the checkpoint; it holds the hyperparameters, too (SB3 saves whatever a model has)."""
        model.hyperparameters = self.hyperparameters.model_dump()
        with replacing(self.model) as unfinished:
            model.save(unfinished)

    def load_model(self, env: VecEnv | None = None) -> Model:
        """The newest checkpoint. Raises Refused if there is none, if it is damaged, or does not fit the config."""
        if not self.model.exists():
            raise Refused(f"{self.folder}: has no model.zip: it was stopped before the first checkpoint; start anew")
        try:
            model = self.hyperparameters.algorithm.load(self.model, env=env, device="cpu")
        except Exception as error:  # whatever SB3, torch, pickle and zip may raise on a damaged file
            raise Refused(f"{self.model}: cannot be loaded: {error}") from error
        trained = getattr(model, "hyperparameters", {})
        for key, value in self.hyperparameters.model_dump().items():
            if trained.get(key) != value:
                raise Refused(
                    f"{self.folder / 'config.yml'}: {key} = {value!r}: must be {trained.get(key)!r}, with which "
                    "model.zip was trained; restore it, or start anew with --config"
                )
        return model


def new_run(output: Path, task: Task, algo: str, hyperparameters: Hyperparameters, seed: int) -> Run:
    """Make a folder <id>-<time> in `output`, with the config."""
    name = f"{task.env_id.replace('/', '-')}-{time.strftime('%Y%m%d-%H%M%S')}"
    folder, again = output / name, 1
    while folder.exists():
        again += 1
        folder = output / f"{name}-{again}"
    try:
        folder.mkdir(parents=True)
    except OSError as error:
        raise Refused(f"--output {output}: cannot be made: {error.strerror}") from error
    run = Run(folder, task, algo, hyperparameters, seed, versions())
    content = {
        task.env_id: hyperparameters.model_dump(),
        "run": {"env_id": task.env_id, "algo": algo, "seed": seed, "versions": run.versions},
    }
    write_text(folder / "config.yml", HEADER + yaml.safe_dump(content, sort_keys=False))
    return run


def open_run(folder: Path) -> Run:
    """Return the run in `folder`. Raises Refused where there is none, or where its config.yml is not valid."""
    path = folder / "config.yml"
    if not path.is_file():
        raise Refused(f"{folder}: is not a run folder: it has no config.yml")
    data = read_yaml(path)
    origin = checked(Origin, data.pop("run", None), f"{path}: run")
    if set(data) != {origin.env_id}:
        raise Refused(f"{path}: must have the entries 'run' and {origin.env_id!r}; it has {', '.join(map(str, data))}")
    hyperparameters = checked(ALGORITHMS[origin.algo], data[origin.env_id], f"{path}: {origin.env_id}")
    task = Task(origin.env_id, hyperparameters.env_kwargs)
    return Run(folder, task, origin.algo, hyperparameters, origin.seed, origin.versions)
