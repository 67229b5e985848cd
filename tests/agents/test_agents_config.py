"""Configs: what is wrong is refused by name; what is right reaches SB3 and the RL Zoo alike."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml
from stable_baselines3 import PPO
from torch import nn

from agents.algorithms import ALGORITHMS, PPOHyperparameters
from agents.command import Refused
from agents.config import checked, load_config
from agents.task import Task

ROOT = Path(__file__).parents[2]
ENV_ID = "Bounce/Paddle-v0"


def refusal(tmp_path: Path, entry: str, **overrides: object) -> str:
    path = tmp_path / "bad.yml"
    path.write_text(f"{ENV_ID}: {entry}")
    with pytest.raises(Refused) as caught:
        load_config(path, ENV_ID, overrides, PPOHyperparameters)
    message = str(caught.value)
    assert str(path) in message
    return message


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        ("{n_timesteps: 100, n_step: 3}", ["unknown key 'n_step'", "n_steps", "batch_size"]),
        ("{n_timesteps: 100, n_steps: many}", ["n_steps = 'many'", "a whole number >= 1"]),
        ("{n_timesteps: 100, n_steps: 0}", ["n_steps = 0", "a whole number >= 1"]),
        ("{n_timesteps: 100, n_envs: true}", ["n_envs = True", "a whole number >= 1"]),
        ("{n_timesteps: 1e6}", ["n_timesteps = '1e6'", "1.0e+6"]),
        ("{n_timesteps: 100.5}", ["n_timesteps = 100.5", "a whole number"]),
        ("{n_envs: 4}", ["n_timesteps: must be given"]),
        ("{n_timesteps: 100, gamma: 1.5}", ["gamma = 1.5", "a number from 0 to 1"]),
        ("{n_timesteps: 100, gamma: .nan}", ["gamma = nan", "a number from 0 to 1"]),
        ("{n_timesteps: 100, ent_coef: -1}", ["ent_coef = -1", "a number >= 0"]),
        ("{n_timesteps: 100, learning_rate: exp_1}", ["learning_rate = 'exp_1'", "lin_1e-3"]),
        ("{n_timesteps: 100, learning_rate: lin_-1}", ["learning_rate = 'lin_-1'", "a number > 0"]),
        ("{n_timesteps: 100, learning_rate: __import__('os')}", ["learning_rate", "a number > 0"]),
        ("{n_timesteps: 100, normalize_advantage: 1}", ["normalize_advantage = 1", "true or false"]),
        ("{n_timesteps: 100, policy: CnnPolicy}", ["policy = 'CnnPolicy'", "MlpPolicy"]),
        ("{n_timesteps: 100, policy_kwargs: 'dict(net_arch=print(3))'}", ["policy_kwargs", "must be a mapping"]),
        ("{n_timesteps: 100, policy_kwargs: {net_arch: [64, 6.5]}}", ["policy_kwargs.net_arch = [64, 6.5]", "pi:"]),
        ("{n_timesteps: 100, policy_kwargs: {arch: [64]}}", ["unknown key 'policy_kwargs.arch'", "net_arch"]),
        ("{n_timesteps: 100, n_envs: 3, n_steps: 5}", ["batch_size must divide n_envs * n_steps = 15"]),
        ("{n_timesteps: 100, env_kwargs: 3}", ["env_kwargs = 3", "must be a mapping"]),
        ("[1, 2]", ["must be a mapping"]),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, entry: str, words: list[str]) -> None:
    message = refusal(tmp_path, entry)
    assert ENV_ID in message
    for word in words:
        assert word in message


def test_every_mistake_has_its_line(tmp_path: Path) -> None:
    assert len(refusal(tmp_path, "{n_timesteps: 0, gamma: 2, foo: 1}").splitlines()) == 3


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: [", "is not YAML"),
        ("- 1", "must be a mapping"),
        (f"{ENV_ID}: {{n_timesteps: 1, n_timesteps: 2}}", "'n_timesteps' is given twice"),
        ("CartPole-v1: {n_timesteps: 1}", "has no entry 'Bounce/Paddle-v0'; it has CartPole-v1"),
        (f"{ENV_ID}: !!python/object/apply:os.system ['true']", "is not YAML"),
    ],
)
def test_a_file_that_is_no_config(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "bad.yml"
    path.write_text(text)
    with pytest.raises(Refused, match=words):
        load_config(path, ENV_ID, {}, PPOHyperparameters)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(Refused, match="cannot be read"):
        load_config(tmp_path / "none.yml", ENV_ID, {}, PPOHyperparameters)


def test_overrides_are_checked_too(tmp_path: Path) -> None:
    assert "n_timesteps = 0" in refusal(tmp_path, "{n_timesteps: 100}", n_timesteps=0)


def test_linear_schedule_falls_to_zero() -> None:
    kwargs = PPOHyperparameters(n_timesteps=100, learning_rate="lin_1e-3").for_sb3()
    schedule = kwargs["learning_rate"]
    # The argument is SB3's `progress_remaining`, from 1 to 0.
    np.testing.assert_allclose([schedule(1.0), schedule(0.5), schedule(0.0)], [1e-3, 5e-4, 0.0], atol=1e-18)


@pytest.mark.parametrize("algo", ALGORITHMS)
def test_each_key_is_one_of_sb3_and_its_default_is_sb3s(algo: str) -> None:
    parameters = ALGORITHMS[algo](n_timesteps=100)
    ours, algorithm = parameters.for_sb3(), parameters.algorithm
    env = Task(ENV_ID, {"action": "discrete" if algo == "dqn" else "continuous"}).for_sb3(1, seed=0)
    theirs = algorithm("MlpPolicy", env)
    model = algorithm(env=env, **ours)
    for key in set(ours) - {"policy", "policy_kwargs", "learning_rate", "clip_range"}:
        assert getattr(model, key) == getattr(theirs, key), key
    for key in {"lr_schedule", "clip_range"} & set(vars(theirs)):
        assert getattr(model, key)(0.5) == getattr(theirs, key)(0.5)
    assert str(model.policy) == str(theirs.policy)


def test_a_network_is_read_from_rl_zoos_text_and_written_as_it() -> None:
    text = "dict(net_arch=[8, 4], activation_fn=nn.ReLU)"
    read = checked(PPOHyperparameters, {"n_timesteps": 100, "policy_kwargs": text}, "here")
    assert read.for_sb3()["policy_kwargs"]["net_arch"] == [8, 4]
    assert read.for_sb3()["policy_kwargs"]["activation_fn"] is nn.ReLU
    written = read.model_dump()
    assert "activation_fn=nn.ReLU" in written["policy_kwargs"]
    assert checked(PPOHyperparameters, written, "here") == read


@pytest.mark.parametrize("algo", ALGORITHMS)
def test_the_shipped_configs_are_valid(algo: str) -> None:
    path = ROOT / f"configs/{algo}.yml"
    for env_id in yaml.safe_load(path.read_text()):
        load_config(path, env_id, {}, ALGORITHMS[algo])


def test_rl_zoo_trains_with_the_shipped_config(tmp_path: Path) -> None:
    overrides = ["n_envs:2", "n_steps:32", "batch_size:64"]
    command = [sys.executable, "-m", "rl_zoo3.train", "--algo", "ppo", "--env", ENV_ID]
    command += ["--gym-packages", "bounce_env", "--conf-file", "configs/ppo.yml", "--n-timesteps", "128"]
    command += ["--eval-freq", "-1", "--log-folder", str(tmp_path), "-params", *overrides]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    (model,) = tmp_path.glob("ppo/*/Bounce-Paddle-v0.zip")
    trained = PPO.load(model, device="cpu")
    config = load_config(ROOT / "configs/ppo.yml", ENV_ID, {}, PPOHyperparameters)
    assert trained.num_timesteps == 128
    assert trained.policy_kwargs["net_arch"] == config.policy_kwargs.net_arch
    assert trained.gamma == config.gamma
