"""The study of all agents: its intervals, and one tiny study from the training to the table."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy import stats

from agents import study
from agents.command import Refused
from agents.intervals import bootstrap
from agents.study import UNSEEN, Study, StudyOptions, train_one, trainings_of

pytestmark = [pytest.mark.slow, pytest.mark.train]

TINY = """\
Bounce/Paddle-v0:
  n_timesteps: 2048
  n_envs: 16
  n_steps: 32
  batch_size: 128
  n_epochs: 2
  policy_kwargs: {net_arch: [8]}
"""
LEVELS = {"num_levels": 4, "time_limit": 3.0}
STUDIES = (
    Study("Levels", "Bounce/Paddle-v0", {"ppo": 2}, 3, LEVELS),
    Study("Unseen", "Bounce/Paddle-v0", {"ppo": 2}, 3, LEVELS, UNSEEN | {"time_limit": 3.0}),
)


def test_the_interval_of_one_run_is_that_of_its_episodes() -> None:
    scores = np.random.default_rng(3).normal(10.0, 2.0, 400)
    interval = bootstrap([scores])
    half = stats.norm.ppf(0.975) * scores.std() / 20.0
    assert interval.mean == scores.mean()
    assert interval.lo == pytest.approx(scores.mean() - half, abs=0.05 * half)
    assert interval.hi == pytest.approx(scores.mean() + half, abs=0.05 * half)
    assert (interval.runs, interval.episodes) == (1, 400)
    assert bootstrap([scores]) == interval


def test_trainings_that_differ_widen_the_interval() -> None:
    """Of two runs of 0 and 1 all the time, two drawn again are alike, 0 or 1, every second time."""
    interval = bootstrap([np.zeros(50), np.ones(50)])
    assert (interval.mean, interval.lo, interval.hi) == (0.5, 0.0, 1.0)
    # Three: the variance of the mean is that between the runs over 3, when that of the episodes is small.
    generator = np.random.default_rng(0)
    runs = [level + generator.normal(0.0, 0.1, 100) for level in (0.0, 3.0, 6.0)]
    interval = bootstrap(runs)
    assert interval.lo < 1.1
    assert interval.hi > 4.9


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("study")
    (folder / "configs").mkdir()
    (folder / "configs" / "ppo.yml").write_text(TINY)
    options = StudyOptions(output=folder / "results", episodes=6, configs=folder / "configs")
    assert study.study(options, STUDIES) == 0
    return folder


def test_what_a_study_writes(results: Path) -> None:
    content = json.loads((results / "results" / "results.json").read_text())
    rows = {(row["study"], row["player"]): row for row in content["rows"]}
    players = ["random", "nothing", "follow", "predictor", "look_ahead", "PPO, argmax", "PPO, sampled"]
    assert list(rows) == [(title, player) for title in ("Levels", "Unseen") for player in players]
    for (_, player), row in rows.items():
        interval = row["interval"]
        assert interval["lo"] <= interval["mean"] <= interval["hi"]
        trained = player.startswith("PPO")
        assert (interval["runs"], interval["episodes"]) == (2, 12) if trained else (1, 3 if "ahead" in player else 6)
        assert (row["steps"], row["seconds"] is None) == ((2048, False) if trained else (None, True))
        idle, best = (rows[row["study"], name]["interval"]["mean"] for name in ("nothing", "look_ahead"))
        if player not in ("nothing", "look_ahead"):
            assert row["normalised"] == pytest.approx((interval["mean"] - idle) / (best - idle))
    assert rows["Levels", "follow"]["interval"] != rows["Unseen", "follow"]["interval"]
    table = (results / "results" / "results.md").read_text().splitlines()
    assert len(table) == 2 + len(rows)
    assert {line.count("|") for line in table} == {9}
    with Image.open(results / "results" / "learning_curves.png") as picture:
        assert picture.size[0] == 1200


def test_what_is_trained_already_is_not_trained_again(results: Path) -> None:
    before = sorted((results / "results").glob("*/*"))
    assert len(before) == 4  # a log and a run folder of each training; unseen levels are played by the same agents
    options = StudyOptions(output=results / "results", episodes=2, configs=results / "configs")
    assert study.study(options, [replace(STUDIES[0], look_ahead=2)]) == 0
    assert sorted((results / "results").glob("*/*")) == before
    (training, _) = trainings_of(STUDIES[0])
    (results / "configs" / "ppo.yml").write_text(TINY.replace("n_epochs: 2", "n_epochs: 3"))
    with pytest.raises(Refused, match=r"levels.*: was trained with other hyperparameters"):
        train_one(training, options)


def test_the_table_names_every_game() -> None:
    assert {one.env_id for one in study.STUDIES} == set(study.BASELINES)
