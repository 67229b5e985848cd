"""A training that is really killed leaves a run folder that goes on."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from stable_baselines3 import PPO

from agents.curve import Curve
from agents.runs import open_run
from agents.train import TrainOptions, train
from tests.conftest import soak_count

pytestmark = pytest.mark.train

ROOT = Path(__file__).parents[2]
CONFIG = """\
Bounce/Paddle-v0:
  n_timesteps: 512000
  n_envs: 16
  n_steps: 32
  batch_size: 512
  n_epochs: 1
  policy_kwargs: {net_arch: [4]}
"""
ROLLOUT = 16 * 32
PATIENCE = 240.0  # s: a cold start compiles the kernels


def interrupted(tmp_path: Path, signals: list[int], after_steps: int) -> tuple[Path, int]:
    """Begin a long training, send it the signals once a checkpoint holds `after_steps`; its folder and exit code."""
    config = tmp_path / "long.yml"
    config.write_text(CONFIG)
    command = [sys.executable, "-W", "error", "-m", "agents.train", "--config", str(config)]
    command += ["--output", str(tmp_path / "runs"), "--checkpoint-seconds", "0", "--no-progress-bar"]
    log = (tmp_path / "log.txt").open("w")
    with log, subprocess.Popen(command, cwd=ROOT, stdout=log, stderr=subprocess.STDOUT) as process:
        deadline = time.monotonic() + PATIENCE
        while checkpointed_steps(tmp_path) < after_steps:
            assert process.poll() is None, (tmp_path / "log.txt").read_text()
            assert time.monotonic() < deadline
            time.sleep(0.05)
        for number in signals:
            os.kill(process.pid, number)
            time.sleep(0.1)
        code = process.wait(timeout=60.0)
    (folder,) = (tmp_path / "runs").iterdir()
    return folder, code


def checkpointed_steps(tmp_path: Path) -> int:
    """Steps of the newest checkpoint, read while it may be replaced at any moment: it must always load."""
    models = list((tmp_path / "runs").glob("*/model.zip"))
    return PPO.load(models[0], device="cpu").num_timesteps if models else -1


def check_goes_on(folder: Path) -> None:
    """Train a little further, in this process."""
    run = open_run(folder)
    model = run.load_model()
    steps, updates = model.num_timesteps, adam_steps(model)
    assert steps % ROLLOUT == 0
    assert updates == steps // ROLLOUT  # the optimizer belongs to just these steps
    assert all(point.steps <= steps + ROLLOUT for point in Curve.read(folder).points)

    shorten(folder, model, steps + 3 * ROLLOUT)
    assert train(TrainOptions(resume=folder, episodes=4, progress_bar=False)) == 0
    after = open_run(folder).load_model()
    assert after.num_timesteps == steps + 3 * ROLLOUT
    assert adam_steps(after) == updates + 3
    counted = [point.steps for point in Curve.read(folder).points]
    assert counted == sorted(set(counted))
    assert {"summary.json", "rollout.mp4", "learning_curve.png"} <= {path.name for path in folder.iterdir()}


def shorten(folder: Path, model: PPO, steps: int) -> None:
    """Let the run end after `steps`, in its config and its checkpoint alike."""
    path = folder / "config.yml"
    path.write_text(path.read_text().replace("n_timesteps: 512000", f"n_timesteps: {steps}"))
    model.hyperparameters["n_timesteps"] = steps
    model.save(folder / "model.zip")


def adam_steps(model: PPO) -> int:
    states = model.policy.optimizer.state_dict()["state"]
    return int(states[0]["step"]) if states else 0


def test_killed_without_warning(tmp_path: Path) -> None:
    for k in range(soak_count(1, 20)):
        place = tmp_path / str(k)
        place.mkdir()
        folder, code = interrupted(place, [signal.SIGKILL], after_steps=(2 + k) * ROLLOUT)
        assert code == -signal.SIGKILL
        check_goes_on(folder)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_stopped_in_order(tmp_path: Path, number: int) -> None:
    folder, code = interrupted(tmp_path, [number], after_steps=2 * ROLLOUT)
    assert code == 128 + number
    log = (tmp_path / "log.txt").read_text()
    assert f"--resume {folder}" in log
    assert "Traceback" not in log
    assert {path.name for path in folder.iterdir() if path.name.startswith(".")} == set()
    check_goes_on(folder)
