"""Each trainer of docs/clients.md trains from its recipe, and plays better than a baseline: `make clients`."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.docs.pages import DOCS, ROOT

VENVS = os.environ.get("BOUNCE_CLIENTS")
RECIPES = DOCS / "clients"
pytestmark = [
    pytest.mark.slow,
    pytest.mark.train,
    pytest.mark.skipif(VENVS is None, reason="needs environments of its own: make clients"),
]


def run(venv, *command, cwd, timeout):
    """Run Python of an environment, and return what was printed."""
    scripts = "Scripts" if os.name == "nt" else "bin"
    python = sys.executable if venv is None else str(Path(VENVS) / venv / scripts / "python")
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "NUMBA_CACHE_DIR")}
    environment |= {"OMP_NUM_THREADS": "1", "SDL_VIDEODRIVER": "dummy"}
    done = subprocess.run(
        [python, *map(str, command)],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )
    told = done.stdout[-3000:] + done.stderr[-3000:]
    assert done.returncode == 0, told
    told = (line for line in done.stdout.splitlines() if re.search(r"\d", line) and "WARN" not in line)
    sys.stdout.write("\n".join(told)[-1500:] + "\n")  # which `make clients` shows
    return done.stdout


def held_out_of(printed):
    return float(re.search(r"held-out score ([\d.]+) \+-", printed)[1])


@pytest.mark.parametrize(
    ("venv", "recipe"),
    [
        (None, "sb3_normalized"),
        ("clients", "torchrl_ppo"),
        ("clients", "tianshou_ppo"),
        ("clients", "pufferlib_ppo"),
    ],
)
def test_a_trainer_beats_the_best_scripted_player(venv, recipe, tmp_path):
    printed = run(venv, RECIPES / f"{recipe}.py", cwd=tmp_path, timeout=1200)
    assert held_out_of(printed) > 23.6


def test_rllib_trains_on_a_cluster_of_which_a_runner_and_a_node_die(tmp_path):
    printed = run("rllib", RECIPES / "rllib_ppo.py", cwd=tmp_path, timeout=1800)
    assert held_out_of(printed) > 2.0 * 7.4
    assert int(re.search(r"runners were restarted (\d+) times", printed)[1]) >= 2
    assert "a runner was killed" in printed
    assert "a node was killed" in printed
    assert re.search(r"restored, same score [\d.]+; went on", printed)


def test_a_data_set_is_the_same_to_the_bit_as_its_replay(tmp_path):
    printed = run("clients", RECIPES / "minari_dataset.py", cwd=tmp_path, timeout=1200)
    assert len(re.findall(r"bounce/\w+-trained-v0: 3 episodes", printed)) == 3


def test_the_rl_zoo_trains_enjoys_and_tunes(tmp_path):
    zoo = ("--algo", "ppo", "--env", "Bounce/Paddle-v0", "--gym-packages", "bounce_env", "--device", "cpu")
    config = ("--conf-file", ROOT / "configs" / "ppo.yml")
    run("clients", "-m", "rl_zoo3.train", *zoo, *config, "-n", 1_000_000, "-f", "logs", "--eval-freq", -1, "--seed", 0,
        cwd=tmp_path, timeout=1200)  # fmt: skip
    enjoyed = run("clients", "-m", "rl_zoo3.enjoy", *zoo, "-f", "logs", "--no-render", "-n", 40_000, "--seed", 10_000,
                  cwd=tmp_path, timeout=600)  # fmt: skip
    mean, spread = map(float, re.search(r"Mean reward: ([\d.]+) \+/- ([\d.]+)", enjoyed).groups())
    episodes = len(re.findall(r"Episode Reward", enjoyed))
    assert episodes > 20
    assert mean - 2.0 * spread / np.sqrt(episodes) > 23.6
    few = ("--n-trials", 2, "--n-startup-trials", 0, "--n-evaluations", 1, "--n-eval-envs", 1, "--pruner", "none")
    tune = ("--optimize", *few, "--sampler", "random", "-n", 4000, "-f", "tuned", "--hyperparams", "n_envs:8")
    run("clients", "-m", "rl_zoo3.train", *zoo, *config, *tune, cwd=tmp_path, timeout=900)
    assert len(list((tmp_path / "tuned").rglob("report_*.csv"))) == 1


def test_a_broken_reward_is_noticed(tmp_path):
    """The margin means something: a recipe whose rewards are noise does not pass."""
    broken = (RECIPES / "sb3_normalized.py").read_text()
    broken = broken.replace("n_envs=256, seed=2**32", "n_envs=256, seed=2**32, reward_noise=True")
    broken = broken.replace("from bounce_env.sb3 import BounceVecEnv\n", BROKEN).replace("1_300_000", "600_000")
    assert "reward_noise=True" in broken
    (tmp_path / "broken.py").write_text(f"import sys; sys.path.insert(0, {str(RECIPES)!r})\n{broken}")
    with pytest.raises(AssertionError, match="worse than the best scripted player"):
        run(None, "broken.py", cwd=tmp_path, timeout=600)


BROKEN = '''
import numpy as np
from bounce_env.sb3 import BounceVecEnv as Right


class BounceVecEnv(Right):
    """Hands out another reward than the game's."""

    def __init__(self, *args, reward_noise, **kwargs):
        super().__init__(*args, **kwargs)
        self.generator = np.random.default_rng(0)

    def step_wait(self):
        observations, rewards, dones, infos = super().step_wait()
        return observations, self.generator.permutation(rewards), dones, infos


'''
