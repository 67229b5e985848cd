"""A game outside of the package (own_game.py): Gymnasium's checks, the vector env, SB3, and kernels kept on disk."""

import os
import pickle
import subprocess
import sys
from collections import deque
from pathlib import Path
from typing import NamedTuple

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import bounce_env
from bounce_env.engine.compile import cache
from bounce_env.envs import BounceEnv
from bounce_env.games import define_game
from bounce_env.games.batch import Batch
from bounce_env.games.episode import SAME_STEP
from tests.env.own_game import OwnEnv, OwnGame, OwnOptions, Rules, begin, observe, play

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


@pytest.mark.train
def test_sb3_trains_on_it():
    from stable_baselines3 import PPO

    from bounce_env.sb3 import BounceVecEnv

    envs = BounceVecEnv(OWN, 4)
    PPO("MlpPolicy", envs, n_steps=32, batch_size=64, n_epochs=1, device="cpu").learn(256)
    envs.close()


def test_it_is_sent_copied_and_told_in_json():
    env = gym.make(OWN)
    env.reset(seed=3)
    other = pickle.loads(pickle.dumps(env))
    assert other.step([0.5])[0].tobytes() == env.step([0.5])[0].tobytes()
    again = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert again.reset(seed=3)[0].tobytes() == gym.make(OWN).reset(seed=3)[0].tobytes()


def test_its_scene_is_its_own():
    with pytest.raises(ValueError, match="scene: must be left out"):
        gym.make(OWN, scene="pinball")


@pytest.mark.parametrize(
    ("env_id", "env", "keywords", "words"),
    [
        (3, OwnEnv, {}, "env_id = 3: must be a string"),
        (OWN, None, {}, "env = None: must be a subclass of BounceEnv with a game_type"),
        (OWN, BounceEnv, {}, "must be a subclass of BounceEnv with a game_type"),
        (OWN, OwnEnv, {"time_limt": 3.0}, "time_limt = 3.0: unknown keyword .did you mean 'time_limit'"),
    ],
)
def test_what_cannot_be_registered(env_id, env, keywords, words):
    with pytest.raises(TypeError, match=words):
        bounce_env.register(env_id, env, **keywords)


def test_rules_that_are_none_or_another_games():
    functions = {"begin": begin, "play": play, "observe": observe}
    with pytest.raises(TypeError, match=r"rules = .*int.*: must be a subclass of NamedTuple"):
        define_game(int, **functions)
    with pytest.raises(ValueError, match="must be a type of their own"):
        define_game(Rules, **functions)


class Unseen(OwnGame):
    """Says of one number less what it is than `observe` writes."""

    def __init__(self, options):
        super().__init__(options)
        self.observed = self.observed[:-1]


class Uncounted(OwnGame):
    """Names none of what `play` counts."""

    counters = ()


@pytest.mark.parametrize("worlds", [1, 3])
def test_what_a_game_writes_too_far_is_told(worlds):
    every = np.ones(worlds, np.bool_)
    with pytest.raises(IndexError, match="Unseen: observe writes beyond the 4 numbers of `observed`"):
        Batch(Unseen(OwnOptions()), worlds, autoreset=SAME_STEP).reset(every)
    batch = Batch(Uncounted(OwnOptions()), worlds, autoreset=SAME_STEP)
    for w in range(worlds):
        batch.seed(w, np.uint64(w))
    batch.reset(every)
    with pytest.raises(IndexError, match="Uncounted: play writes beyond the 0 names of `counters`"):
        deque((batch.step(np.full((worlds, 1), np.sin(k))) for k in range(3000)), maxlen=0)
    right = Batch(OwnGame(OwnOptions()), worlds, autoreset=SAME_STEP)
    right.reset(every)
    for _ in range(300):
        right.step(np.zeros((worlds, 1)))


def test_rules_that_were_not_defined_are_told():
    class Others(NamedTuple):
        pace: object

    class Undefined(OwnGame):
        def __init__(self, options):
            super().__init__(options)
            self.rules = Others(self.rules.pace)

    with pytest.raises(TypeError, match=r"define_game\(Others, begin="):
        Batch(Undefined(OwnOptions()), 1, autoreset=SAME_STEP)


def test_what_a_kernel_depends_on(tmp_path):
    """A module beside the game, a package above it; what lies in no file is not kept."""
    beside, above = tmp_path / "loose", tmp_path / "package" / "inner"
    for folder in (beside, above):
        folder.mkdir(parents=True)
        (folder / "game.py").write_text("")
    for folder in (above, above.parent):
        (folder / "__init__.py").write_text("")
    helpers = {beside: beside / "helper.py", above: above.parent / "constants.py"}
    for folder, helper in helpers.items():
        kind = type("Rules", (), {})
        seen = []
        for text in ("X = 1\n", "X = 2\n"):
            helper.write_text(text)
            cache.follow_sources(kind, {folder / "game.py"})
            seen.append(cache._foreign[kind])
        assert None not in seen
        assert seen[0] != seen[1]
    cache.follow_sources(kind, {Path("<stdin>")})
    assert cache._foreign[kind] is None


TWO = """
import importlib, pathlib, sys
import gymnasium as gym, bounce_env
import one, other
seen = []
for n, module in enumerate((one, other)):
    bounce_env.register(f"Own/Game{n}-v0", module.OwnEnv)
    seen.append(float(gym.make(f"Own/Game{n}-v0", disable_env_checker=True).reset(seed=0)[0][1]))
path = pathlib.Path(one.__file__)
path.write_text(path.read_text().replace("0.5, 0.4", "0.5, 0.7"))
sys.dont_write_bytecode = True
bounce_env.register("Own/Game2-v0", importlib.reload(one).OwnEnv)
seen.append(float(gym.make("Own/Game2-v0", disable_env_checker=True).reset(seed=0)[0][1]))
print(*(round(y, 3) for y in seen))
"""


def test_two_games_with_rules_of_one_name_and_one_that_is_defined_again(tmp_path):
    """Numba tells named tuples apart by the names of type and fields alone."""
    source = (Path(__file__).parent / "own_game.py").read_text()
    assert source.count("w, 0, 0.5, 0.4,") == 1
    (tmp_path / "one.py").write_text(source)
    (tmp_path / "other.py").write_text(source.replace("w, 0, 0.5, 0.4,", "w, 0, 0.5, 0.6,"))
    package = Path(bounce_env.__file__).parents[1]
    places = {"PYTHONPATH": f"{tmp_path}{os.pathsep}{package}", "NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    environment = {**os.environ, **places, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run([sys.executable, "-c", TWO], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["-0.2", "0.2", "0.4"]


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
