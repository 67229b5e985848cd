"""One tiny training: what it writes, how it is measured, filmed and gone on with."""

import csv
import json
import shutil
import subprocess
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import imageio_ffmpeg
import numpy as np
import pytest
import torch
import yaml
from PIL import Image
from stable_baselines3 import PPO
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from agents.algorithms import Model, PPOHyperparameters
from agents.baselines import BASELINES
from agents.command import Refused
from agents.config import load_config
from agents.curve import Curve
from agents.evaluate import EvaluateOptions, evaluate, play
from agents.files import write_text
from agents.players import named
from agents.record import RecordOptions, frames, record
from agents.results import Episodes, estimate, statistics
from agents.runs import open_run, versions
from agents.task import HELD_OUT, Task, training_seed
from agents.train import TrainOptions, train

pytestmark = pytest.mark.train

ENV_ID = "Bounce/Paddle-v0"
TINY = """\
Bounce/Paddle-v0:
  n_timesteps: 2048
  n_envs: 16
  n_steps: 32
  batch_size: 128
  n_epochs: 2
  learning_rate: lin_1e-3
  policy_kwargs: {net_arch: [8], log_std_init: -0.5}
"""


@pytest.fixture(scope="module")
def config(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("configs") / "tiny.yml"
    path.write_text(TINY)
    return path


def trained_in(output: Path, config: Path, **changes: Any) -> Path:
    options = TrainOptions(config=config, output=output, episodes=12, seed=5, progress_bar=False)
    assert train(replace(options, **changes)) == 0
    (folder,) = output.iterdir()
    return folder


@pytest.fixture(scope="module")
def run_folder(config: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return trained_in(tmp_path_factory.mktemp("runs"), config)


@pytest.fixture
def copy(run_folder: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(run_folder, tmp_path / "run"))


def parameters(model: Model) -> list[torch.Tensor]:
    return list(model.policy.state_dict().values())


def test_a_run_folder_holds_what_is_promised(run_folder: Path) -> None:
    assert run_folder.name.startswith("Bounce-Paddle-v0-")
    names = {path.name for path in run_folder.iterdir()}
    assert names == {
        "config.yml", "model.zip", "summary.json", "tensorboard",
        "learning_curve.csv", "learning_curve.png", "rollout.mp4", "rollout.gif",
    }  # fmt: skip


def test_summary(run_folder: Path) -> None:
    summary = json.loads((run_folder / "summary.json").read_text())
    results = summary.pop("results")
    seconds = summary.pop("train_seconds")
    assert summary == {"env_id": ENV_ID, "kwargs": {}, "versions": versions(), "seed": 5, "steps": 2048}
    assert seconds > 0.0
    assert list(results) == ["random", "nothing", "follow", "predictor", "trained", "trained_sampled"]
    for result in results.values():
        assert set(result) == {"mean", "lo", "hi", "n"}
        assert result["lo"] <= result["mean"] <= result["hi"]
        assert result["n"] == 12
    follow = estimate(play(Task(ENV_ID), BASELINES[ENV_ID]["follow"](Task(ENV_ID)), 12).scores)
    assert (results["follow"]["mean"], results["follow"]["hi"]) == (follow.mean, follow.hi)


def test_config_of_the_run_says_everything_and_is_a_config(run_folder: Path, config: Path) -> None:
    written = yaml.safe_load((run_folder / "config.yml").read_text())
    assert written["run"] == {"env_id": ENV_ID, "algo": "ppo", "seed": 5, "versions": versions()}
    assert written[ENV_ID]["gamma"] == 0.99  # a default
    assert load_config(run_folder / "config.yml", ENV_ID, {}, PPOHyperparameters) == load_config(
        config, ENV_ID, {}, PPOHyperparameters
    )


def test_learning_curve(run_folder: Path) -> None:
    rows = list(csv.DictReader((run_folder / "learning_curve.csv").read_text().splitlines()))
    assert int(rows[-1]["steps"]) == 2048
    steps = [int(row["steps"]) for row in rows]
    seconds = [float(row["seconds"]) for row in rows]
    assert steps == sorted(set(steps))
    assert seconds == sorted(seconds)
    assert sum(int(row["episodes"]) for row in rows) > 10
    with Image.open(run_folder / "learning_curve.png") as picture:
        assert picture.size == (960, 600)
        assert len(np.unique(np.asarray(picture.convert("RGB")).reshape(-1, 3), axis=0)) > 6


def test_tensorboard_follows_the_steps(run_folder: Path) -> None:
    events = EventAccumulator(str(run_folder / "tensorboard"))
    events.Reload()
    assert [event.step for event in events.Scalars("train/loss")][-1] >= 1536
    assert "rollout/ep_rew_mean" in events.Tags()["scalars"]


@pytest.mark.parametrize("algo", ["dqn", "sac"])
def test_other_algorithms(algo: str, tmp_path: Path) -> None:
    path = tmp_path / "tiny.yml"
    action = "discrete" if algo == "dqn" else "continuous"
    entry = {"n_timesteps": 640, "n_envs": 4, "learning_starts": 100, "env_kwargs": {"action": action}}
    path.write_text(yaml.safe_dump({ENV_ID: entry}))
    folder = trained_in(tmp_path / "runs", path, algo=algo)
    run = open_run(folder)
    assert run.algo == algo
    assert type(run.load_model()).__name__ == algo.upper()
    assert run.load_model().num_timesteps == 640
    assert json.loads((folder / "summary.json").read_text())["results"]["trained"]["n"] == 12
    task, players = named(str(folder), None, None)
    assert task.resolved_kwargs["action"] == action
    assert play(task, players["trained"], 4).scores.shape == (4,)
    # The same seed trains the same agent.
    again = open_run(trained_in(tmp_path / "again", path, algo=algo)).load_model()
    assert all(torch.equal(a, b) for a, b in zip(parameters(run.load_model()), parameters(again), strict=True))
    # It goes on, with an empty replay buffer.
    config = yaml.safe_load((folder / "config.yml").read_text())
    config[ENV_ID]["n_timesteps"] = 960
    (folder / "config.yml").write_text(yaml.safe_dump(config))
    model = run.load_model()
    model.hyperparameters["n_timesteps"] = 960
    model.save(folder / "model.zip")
    assert train(TrainOptions(resume=folder, episodes=4, progress_bar=False)) == 0
    assert open_run(folder).load_model().num_timesteps == 960


def test_the_same_seed_trains_the_same_agent(run_folder: Path, config: Path, tmp_path: Path) -> None:
    again = open_run(trained_in(tmp_path / "again", config)).load_model()
    other = open_run(trained_in(tmp_path / "other", config, seed=6)).load_model()
    first = open_run(run_folder).load_model()
    assert all(torch.equal(a, b) for a, b in zip(parameters(first), parameters(again), strict=True))
    assert not all(torch.equal(a, b) for a, b in zip(parameters(first), parameters(other), strict=True))


# Going on with a run.


def test_a_finished_run_is_measured_again(copy: Path) -> None:
    before = parameters(open_run(copy).load_model())
    for name in ("summary.json", "rollout.mp4"):
        (copy / name).unlink()
    assert train(TrainOptions(resume=copy, episodes=12, progress_bar=False)) == 0
    assert (copy / "rollout.mp4").exists()
    assert json.loads((copy / "summary.json").read_text())["steps"] == 2048
    after = parameters(open_run(copy).load_model())
    assert all(torch.equal(a, b) for a, b in zip(before, after, strict=True))


def edited(folder: Path, change: Mapping[str, Any]) -> None:
    path = folder / "config.yml"
    content = yaml.safe_load(path.read_text())
    content[ENV_ID].update(change)
    path.write_text(yaml.safe_dump(content))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"n_steps": 64}, "n_steps = 64: must be 32"),
        ({"n_envs": 32}, "n_envs = 32: must be 16"),
        ({"learning_rate": 0.5}, "learning_rate = 0.5: must be 'lin_1e-3'"),
        ({"env_kwargs": {"frame_skip": 4}}, "env_kwargs = .*: must be {}"),
        ({"policy_kwargs": {"net_arch": [9]}}, "policy_kwargs = .*: must be .*8"),
        ({"gamma": 2}, "gamma = 2: must be a number from 0 to 1"),
    ],
)
def test_a_folder_whose_config_does_not_fit_is_refused(copy: Path, change: Mapping[str, Any], words: str) -> None:
    edited(copy, change)
    with pytest.raises(Refused, match=words):
        train(TrainOptions(resume=copy))


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("config.yml", None, "is not a run folder: it has no config.yml"),
        ("config.yml", "a: 1", "run = None: must be a mapping|run: must be a mapping"),
        ("model.zip", None, "has no model.zip"),
        ("model.zip", "PK half of a file", "model.zip: cannot be loaded"),
    ],
)
def test_a_damaged_folder_is_refused(copy: Path, name: str, content: str | None, words: str) -> None:
    (copy / name).unlink()
    if content is not None:
        (copy / name).write_text(content)
    with pytest.raises(Refused, match=words):
        train(TrainOptions(resume=copy))


def test_a_model_of_other_origin_is_refused(copy: Path) -> None:
    PPO("MlpPolicy", Task(ENV_ID).for_sb3(16, 0), n_steps=32, batch_size=128).save(copy / "model.zip")
    with pytest.raises(Refused, match=r"config\.yml: n_timesteps = 2048"):
        train(TrainOptions(resume=copy))


def test_a_curve_beyond_the_checkpoint_is_cut(copy: Path) -> None:
    curve = Curve.read(copy)
    whole = list(curve.points)
    curve.cut(1024)
    assert 0 < len(curve.points) < len(whole)
    assert curve.points == [point for point in whole if point.steps <= 1024]


def test_what_cannot_be_written_whole_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "summary.json"
    write_text(path, "old")
    with pytest.raises(UnicodeEncodeError):
        write_text(path, "new \ud800")
    assert path.read_text() == "old"
    write_text(path, "new")
    assert [p.name for p in tmp_path.iterdir()] == ["summary.json"]
    assert path.read_text() == "new"


# Evaluation.


def test_an_episode_counts_once_and_whole() -> None:
    """Against single environments, played one after the other."""
    task, n = Task(ENV_ID, {"time_limit": 8.0}), 40
    player = BASELINES[ENV_ID]["predictor"](task)
    played = play(task, player, n)
    env = task.single()
    for k in range(n):
        seen, _ = env.reset(seed=HELD_OUT + k)
        ended = False
        while not ended:
            seen, _, terminated, truncated, info = env.step(player(seen[None])[0])
            ended = terminated or truncated
        alone = (info["score"], info["game_seconds"], info["touches"], truncated)
        assert alone == (played.scores[k], played.seconds[k], played.touches[k], played.at_limit[k])
    assert 0 < played.at_limit.sum() < n  # both ways of ending were seen


def test_training_never_meets_a_held_out_seed() -> None:
    last_held_out = HELD_OUT + 10**6
    blocks = [range(training_seed(seed, 0), training_seed(seed, 10**9)) for seed in (0, 1, 2**32 - 1)]
    assert all(block.start > last_held_out for block in blocks)
    assert blocks[0].stop <= blocks[1].start


def test_interval_is_students() -> None:
    # t(0.975, 4) = 2.7764451 (any table); s = sqrt(2.5); half = t s / sqrt(5)
    level = estimate(np.array([1.0, 2.0, 3.0, 4.0, 5.0]))
    np.testing.assert_allclose((level.mean, level.hi - 3.0, 3.0 - level.lo), (3.0, 1.9632432, 1.9632432), rtol=1e-6)
    constant = estimate(np.full(7, 2.5))
    assert (constant.lo, constant.hi) == (2.5, 2.5)


def test_statistics() -> None:
    episodes = Episodes(
        np.array([2.0, 4.0, 9.0]), np.array([1.0, 2.0, 6.0]), np.array([1, 0, 4]), np.array([0, 0, 1]) > 0
    )
    expected = {"median_score": 4.0, "mean_seconds": 3.0, "share_at_time_limit": 1 / 3, "score_per_touch": 3.0}
    assert statistics(episodes) == expected


def test_evaluate_measures_a_run_as_its_summary_says(run_folder: Path, tmp_path: Path, capsys: Any) -> None:
    path = tmp_path / "result.json"
    assert evaluate(EvaluateOptions(str(run_folder), episodes=12, json=path)) == 0
    result = json.loads(path.read_text())
    summary = json.loads((run_folder / "summary.json").read_text())
    assert set(result["results"]) == {"trained", "trained_sampled"}
    for name, measured in result["results"].items():
        assert measured == summary["results"][name]
    assert f"{summary['results']['trained']['mean']:.2f}" in capsys.readouterr().out


def test_an_agent_refuses_what_it_was_not_trained_for(run_folder: Path) -> None:
    with pytest.raises(Refused, match="was trained on"):
        named(str(run_folder), None, {"action": "discrete"})
    named(str(run_folder), None, {"frame_skip": 3})


# Film.


def check_film(folder: Path, task: Task, player: Any, seed: int) -> None:
    pictures = list(frames(task, player, seed))
    fps = 60 / task.resolved_kwargs["frame_skip"]
    count, seconds = imageio_ffmpeg.count_frames_and_secs(folder / "rollout.mp4")
    assert count == len(pictures)
    assert seconds == pytest.approx(count / fps, abs=0.01)
    decode = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-i", str(folder / "rollout.mp4")]
    decode += ["-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    decoded = subprocess.run(decode, capture_output=True, check=True).stdout
    filmed = np.frombuffer(decoded, np.uint8).reshape(len(pictures), *pictures[0].shape)
    height, width, _ = pictures[0].shape
    for k in (0, len(pictures) // 2, -1):  # H.264 loses a little, and far less than another frame would differ
        assert np.abs(filmed[k].astype(float) - pictures[k]).mean() < 3.0
    with Image.open(folder / "rollout.gif") as gif:
        durations = []
        for k in range(gif.n_frames):
            gif.seek(k)
            durations.append(gif.info["duration"])
        assert gif.size == (-(-width // 2), -(-height // 2))
    # Pillow joins frames that are alike, so only the whole is known: one instant of 1/100 s.
    np.testing.assert_allclose(sum(durations) / 1000.0, -(-len(pictures) // 2) * 2 / fps, atol=0.011)


def test_the_film_of_a_run_is_of_a_held_out_episode(run_folder: Path) -> None:
    task, players = named(str(run_folder), None, None)
    check_film(run_folder, task, players["trained"], HELD_OUT)


def test_record_a_baseline(tmp_path: Path) -> None:
    kwargs = {"frame_skip": 4, "width": 152, "height": 204, "action": "discrete", "time_limit": 6.0}
    options = RecordOptions("follow", seed=3, output=tmp_path / "film", env_kwargs=kwargs)
    assert record(options) == 0
    assert {path.name for path in (tmp_path / "film").iterdir()} == {"rollout.mp4", "rollout.gif"}
    task = Task(ENV_ID, kwargs)
    check_film(tmp_path / "film", task, BASELINES[ENV_ID]["follow"](task), 3)
