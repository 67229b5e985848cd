"""The commands explain themselves, and refuse in one line."""

import subprocess
import sys
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import pytest

from agents.command import run
from agents.evaluate import EvaluateOptions, evaluate
from agents.record import RecordOptions, record
from agents.train import TrainOptions, train

pytestmark = pytest.mark.train

ROOT = Path(__file__).parents[2]
COMMANDS = {"train": (train, TrainOptions), "evaluate": (evaluate, EvaluateOptions), "record": (record, RecordOptions)}


@pytest.mark.parametrize("name", COMMANDS)
def test_help_names_every_option_with_its_default(name: str) -> None:
    command = [sys.executable, "-W", "error", "-m", f"agents.{name}", "--help"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(f"usage: python -m agents.{name}")
    optional = [option.name.replace("_", "-") for option in fields(COMMANDS[name][1]) if option.name != "player"]
    for option in optional:
        assert f"--{option}" in done.stdout
    assert " ".join(done.stdout.split()).count("(default:") == len(optional)


def refusal(command: Callable[..., int], options: type, words: list[str], monkeypatch: pytest.MonkeyPatch) -> int:
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "argv", ["command", *words])
    with pytest.raises(SystemExit) as ended:
        run(command, options)
    assert isinstance(ended.value.code, int)
    return ended.value.code


@pytest.mark.parametrize(
    ("words", "error"),
    [
        ("train --env-id Bounce/None-v0", "has no entry 'Bounce/None-v0'"),
        ("train --steps 0", "n_timesteps = 0: must be a whole number >= 1"),
        ("train --seed -1", "--seed -1: must be from 0 to 4294967295"),
        ("train --episodes 1", "--episodes 1: must be >= 2"),
        ('train --env-kwargs {"frame_skp":2}', "frame_skp"),
        ('train --env-kwargs {"frame_skip":0}', "frame_skip"),
        ('train --env-kwargs {"time_limit":null}', "time_limit = null"),
        ("train --resume runs/none", "runs/none: is not a run folder"),
        ("train --resume runs/none --seed 3 --steps 9", "leave out --steps, --seed"),
        ("evaluate nobody", "'nobody': must be a run folder, or, for Bounce/Paddle-v0, one of random, nothing, follow"),
        ("evaluate random --env-id CartPole-v1", "env_id = 'CartPole-v1': must be one of Bounce/"),
        ('evaluate random --env-kwargs {"time_limit":null}', "time_limit = null"),
        ('evaluate predictor --env-kwargs {"scene":"box"}', "box"),
        ("record random --seed -1", "--seed -1: must be >= 0"),
    ],
)
def test_a_bad_option_is_refused(
    words: str, error: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    name, *rest = words.split()
    assert refusal(*COMMANDS[name], rest, monkeypatch) == 2
    printed = capsys.readouterr().err
    assert printed.startswith("error: ")
    assert error in printed


@pytest.mark.parametrize("value", ["{", "[1]"])
def test_env_kwargs_must_be_a_json_object(
    value: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert refusal(evaluate, EvaluateOptions, ["random", "--env-kwargs", value], monkeypatch) == 2
    assert "--env-kwargs" in "".join(capsys.readouterr())
