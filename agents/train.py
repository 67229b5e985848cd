"""Train an agent: `python -m agents.train`."""

import json
import time
from dataclasses import dataclass, fields
from pathlib import Path

import torch

from agents.algorithms import ALGORITHMS, Algorithm
from agents.baselines import quick_baselines
from agents.command import JsonObject, Refused, check_range, run, say
from agents.config import LARGEST_SEED, load_config
from agents.curve import Curve, draw
from agents.evaluate import check_ends, in_words, play
from agents.files import write_text
from agents.learning import Stop, learn, new_model, resumed_model
from agents.players import DEFAULT_ENV_ID, trained
from agents.record import record_episode
from agents.results import Episodes, report
from agents.runs import Run, new_run, open_run, versions
from agents.task import Task


@dataclass(frozen=True)
class TrainOptions:
    """See `train`."""

    env_id: str = DEFAULT_ENV_ID
    """What to train on."""
    algo: Algorithm = "ppo"
    """PPO; DQN, for a game with discrete actions; or SAC, for one with continuous ones."""
    config: Path | None = None
    """Hyperparameters: a YAML file in the RL Zoo's format, with an entry for the environment's id. Default:
    configs/<algo>.yml."""
    steps: int | None = None
    """Environment steps to train for. Default: n_timesteps of the config."""
    seed: int = 0
    """Of the network, of the actions sampled in training, and of the episodes trained on."""
    env_kwargs: JsonObject = None
    """Keyword arguments of the environment, such as {"frame_skip": 4}. Default: env_kwargs of the config, or none."""
    output: Path = Path("runs")
    """Folder in which the run gets its folder <id>-<time>."""
    resume: Path | None = None
    """Run folder of an interrupted training to go on with; its own config holds, so leave the options above out."""
    episodes: int = 500
    """Held-out episodes that each player is measured on at the end."""
    checkpoint_seconds: float = 5.0
    """Seconds between checkpoints; the default costs less than 1 % of the time. 0: after every update."""
    threads: int = 1
    """CPU threads for PyTorch; networks as small as these gain little from more."""
    progress_bar: bool = True
    """Show a progress bar while training."""


OF_A_NEW_RUN = ("env_id", "algo", "config", "steps", "seed", "env_kwargs", "output")


def train(options: TrainOptions) -> int:
    """Train an agent with Stable-Baselines3, compare it with the baselines on held-out episodes, and film it.

    Writes a run folder: model.zip, config.yml, tensorboard/, learning_curve.png and .csv, rollout.mp4 and .gif,
    summary.json. Ctrl-C or SIGTERM stops in order, and even after SIGKILL the newest checkpoint is whole:
    --resume goes on from it.
    """
    check_range("episodes", options.episodes, 2)
    check_range("checkpoint-seconds", options.checkpoint_seconds, 0.0)
    check_range("threads", options.threads, 1)
    run = resumed(options) if options.resume else begun(options)
    say(f"run folder: {run.folder}")
    torch.set_num_threads(options.threads)
    compile_kernels(run.task)

    model = resumed_model(run) if options.resume else new_model(run)
    curve, stop = Curve.read(run.folder), Stop()
    curve.cut(model.num_timesteps)
    say(f"training {run.algo.upper()}: {model.num_timesteps:,} of {run.hyperparameters.n_timesteps:,} steps done")
    seconds = learn(
        run, model, curve, stop, checkpoint_seconds=options.checkpoint_seconds, progress_bar=options.progress_bar
    )
    if stop.signal is not None:
        say(f"stopped after {model.num_timesteps:,} steps; go on with: python -m agents.train --resume {run.folder}")
        return 128 + stop.signal
    say(f"trained for {seconds:.0f} s")

    players = {name: baseline(run.task) for name, baseline in quick_baselines(run.task.env_id).items()}
    players |= {"trained": trained(model), "trained_sampled": trained(model, sampled=True)}
    say(f"playing {options.episodes} held-out episodes with each player ...")
    played = {name: play(run.task, player, options.episodes) for name, player in players.items()}
    title = f"{run.algo.upper()} on {run.task.env_id}, seed {run.seed}"
    draw(curve, played, title, run.folder, algo=run.algo, counted=run.task.counted)
    say("filming an episode ...")
    record_episode(run.task, players["trained"], run.folder)
    write_summary(run, model.num_timesteps, seconds, played)
    say(in_words(run.task, played))
    say(f"all in {run.folder}")
    return 0


def begun(options: TrainOptions) -> Run:
    """Return a new run folder for what the options ask."""
    check_range("seed", options.seed, 0, LARGEST_SEED)
    overrides = {"n_timesteps": options.steps, "env_kwargs": options.env_kwargs}
    given = {key: value for key, value in overrides.items() if value is not None}
    config = options.config or Path(f"configs/{options.algo}.yml")
    hyperparameters = load_config(config, options.env_id, given, ALGORITHMS[options.algo])
    task = Task(options.env_id, hyperparameters.env_kwargs)
    check_ends(task)
    return new_run(options.output, task, options.algo, hyperparameters, options.seed)


def resumed(options: TrainOptions) -> Run:
    """Return the run in the folder `options.resume`."""
    changed = [f.name for f in fields(options) if f.name in OF_A_NEW_RUN and getattr(options, f.name) != f.default]
    if changed:
        names = ", ".join(f"--{name.replace('_', '-')}" for name in changed)
        raise Refused(f"--resume goes on with what the run's config.yml says: leave out {names}")
    assert options.resume is not None
    run = open_run(options.resume)
    now = versions()
    changes = [f"{name} {then} -> {now.get(name)}" for name, then in run.versions.items() if now.get(name) != then]
    if changes:
        say(f"note: versions have changed since the run began: {', '.join(changes)}")
    return run


def compile_kernels(task: Task) -> None:
    """Play one step, so that what has to be compiled is compiled before the training's clock runs."""
    say("compiling the physics kernels: a minute or so the first time, then they are read from disk ...")
    began = time.monotonic()
    envs = task.batch(1)
    envs.reset(seed=0)
    envs.step(envs.action_space.sample())
    envs.close()
    say(f"... ready after {time.monotonic() - began:.1f} s")


def write_summary(run: Run, steps: int, seconds: float, played: dict[str, Episodes]) -> None:
    """Write summary.json."""
    summary = {
        "env_id": run.task.env_id,
        "kwargs": dict(run.task.env_kwargs),
        "versions": versions(),
        "seed": run.seed,
        "steps": steps,
        "train_seconds": round(seconds, 1),
        "results": report(played),
    }
    write_text(run.folder / "summary.json", json.dumps(summary, indent=2) + "\n")


if __name__ == "__main__":
    run(train, TrainOptions)
