"""A game outside of the package (own_game.py): Gymnasium's checks, the vector env, SB3, and kernels kept on disk."""

import os
import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import bounce_env
from tests.env.own_game import OwnEnv

pytestmark = pytest.mark.slow

OWN = "Own/Game-v0"


@pytest.fixture(autouse=True)
def registered():
    bounce_env.register(OWN, OwnEnv)
    yield
    gym.registry.pop(OWN)


def test_it_is_short():
    assert len((Path(__file__).parent / "own_game.py").read_text().splitlines()) <= 120


def test_gymnasium_finds_nothing_wrong():
    check_env(gym.make(OWN).unwrapped, skip_render_check=True)


def test_a_batch_plays_what_the_single_env_plays():
    envs = gym.make_vec(OWN, num_envs=3, vectorization_mode="vector_entry_point", autoreset_mode="SAME_STEP")
    singles = [gym.make(OWN) for _ in range(3)]
    seen, _ = envs.reset(seed=7)
    for w, single in enumerate(singles):
        assert single.reset(seed=7 + w)[0].tobytes() == seen[w].tobytes()
    rng, ends, points = np.random.default_rng(0), 0, 0.0
    for _ in range(300):
        actions = rng.uniform(-1.0, 1.0, (3, 1)).astype(np.float32)
        seen, rewards, terminated, truncated, _ = envs.step(actions)
        for w, single in enumerate(singles):
            alone = single.step(actions[w])
            assert alone[1:4] == (rewards[w], terminated[w], truncated[w])
            observation = single.reset()[0] if alone[2] or alone[3] else alone[0]
            assert observation.tobytes() == seen[w].tobytes()
            ends += alone[2]
            points += alone[1]
    assert ends > 3
    assert points > 3.0


def test_it_is_drawn():
    env = gym.make(OWN, render_mode="rgb_array", width=80, height=80)
    env.reset(seed=0)
    assert env.render().shape == (80, 80, 3)


def test_sb3_trains_on_it():
    from stable_baselines3 import PPO

    from bounce_env.sb3 import BounceVecEnv

    envs = BounceVecEnv(OWN, 4)
    PPO("MlpPolicy", envs, n_steps=32, batch_size=64, n_epochs=1, device="cpu").learn(256)
    envs.close()


PLAY = """
import gymnasium as gym, bounce_env
from own.game import OwnEnv
from bounce_env.games.kernels import step_worlds
bounce_env.register("Own/Game-v0", OwnEnv)
env = gym.make("Own/Game-v0")
env.reset(seed=1)
print(sum(env.step([1.0])[1] for _ in range(40)))
print(sum(step_worlds.stats.cache_hits.values()), sum(step_worlds.stats.cache_misses.values()))
"""
KNOWS_NOTHING = """
import gymnasium as gym, bounce_env
from bounce_env.games.kernels import step_worlds
env = gym.make("Bounce/Paddle-v0")
env.reset(seed=1)
env.step([1.0])
print(sum(step_worlds.stats.cache_hits.values()), sum(step_worlds.stats.cache_misses.values()))
"""


def test_its_kernels_are_kept_and_an_edit_of_it_is_noticed(tmp_path):
    """And who plays another game without knowing of this one is not disturbed."""
    module = tmp_path / "own" / "game.py"
    module.parent.mkdir()
    (module.parent / "__init__.py").write_text("")
    module.write_text((Path(__file__).parent / "own_game.py").read_text())
    package = Path(bounce_env.__file__).parents[1]
    places = {"PYTHONPATH": f"{tmp_path}{os.pathsep}{package}", "NUMBA_CACHE_DIR": str(tmp_path / "cache")}

    def run(code: str) -> list[str]:
        environment = {**os.environ, **places, "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run(
            [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.split()

    first = run(PLAY)
    assert first[1:] == ["0", "1"]
    assert run(PLAY) == [first[0], "1", "0"]
    assert run(KNOWS_NOTHING) == ["0", "1"]
    assert run(KNOWS_NOTHING) == ["1", "0"]
    assert run(PLAY) == [first[0], "1", "0"]
    source = module.read_text()
    assert source.count("points = float(state.hits[w, TARGET])") == 1
    module.write_text(source.replace("float(state.hits[w, TARGET])", "1.0 + float(state.hits[w, TARGET])"))
    edited = run(PLAY)
    assert edited[1:] == ["0", "1"]
    assert float(edited[0]) == float(first[0]) + 40.0
