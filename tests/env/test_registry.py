"""Gymnasium's and SB3's own checks over every registered id, and how ids are found, stored and made again."""

import importlib
import subprocess
import sys

import gymnasium as gym
import pytest
import stable_baselines3.common.env_checker
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import check_env

import bounce_env
from bounce_env.registration import ENTRIES
from tests.env.rollouts import MODES, VARIANTS, assert_same, name, scripted

pytestmark = pytest.mark.fast

# What a user may do with a fresh interpreter: the package is not imported, Gymnasium has to find it by the id's prefix.
BY_PREFIX = """
import gymnasium as gym
env = gym.make("bounce_env:Bounce/Paddle-v0")
observation, info = env.reset(seed=3)
assert observation in env.observation_space
print(env.spec.id)
"""


@pytest.fixture(autouse=True)
def without_a_window(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")  # check_env tries human mode


@pytest.mark.parametrize(("env_id", "kwargs"), VARIANTS, ids=name)
def test_gymnasiums_check_env_has_nothing_to_say(env_id, kwargs):
    check_env(gym.make(env_id, render_mode="rgb_array", **kwargs).unwrapped)


@pytest.mark.parametrize(("env_id", "kwargs"), VARIANTS, ids=name)
def test_sb3s_check_env_has_nothing_to_say(env_id, kwargs):
    env = gym.make(env_id, render_mode="rgb_array", **kwargs).unwrapped
    stable_baselines3.common.env_checker.check_env(env, warn=True)


@pytest.mark.parametrize(("env_id", "kwargs"), VARIANTS, ids=name)
def test_a_spec_goes_through_json_and_makes_the_same_env(env_id, kwargs):
    made = gym.make(env_id, frame_skip=3, time_limit=None, **kwargs)
    spec = EnvSpec.from_json(made.spec.to_json())
    assert spec == made.spec
    again = gym.make(spec)
    assert again.unwrapped.metadata["render_fps"] == 20
    assert_same(again.reset(seed=5), made.reset(seed=5))
    made.action_space.seed(0)
    for _ in range(20):
        action = made.action_space.sample()
        step = made.step(action)
        assert_same(again.step(action), step)
        if step[2]:
            assert_same(again.reset(), made.reset())


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.id)
def test_a_vector_spec_goes_through_json_and_makes_the_same_envs(entry, mode):
    made = gym.make_vec(entry.id, num_envs=3, vectorization_mode="vector_entry_point", autoreset_mode=mode)
    again = gym.make_vec(EnvSpec.from_json(made.spec.to_json()))
    assert again.metadata["autoreset_mode"].name == mode
    assert again.num_envs == 3
    assert_same(again.reset(seed=5), made.reset(seed=5))
    for actions in scripted(made.action_space, 10):
        assert_same(again.step(actions), made.step(actions))


def test_ids_carry_no_step_limit_and_string_entry_points():
    for entry in ENTRIES:
        spec = gym.spec(entry.id)
        assert spec.max_episode_steps is None
        assert isinstance(spec.entry_point, str)
        assert isinstance(spec.vector_entry_point, str)


def test_metadata_belongs_to_the_instance():
    usual, slow = gym.make("Bounce/Paddle-v0"), gym.make("Bounce/Paddle-v0", frame_skip=6)
    assert (slow.unwrapped.metadata["render_fps"], usual.unwrapped.metadata["render_fps"]) == (10, 30)
    assert type(usual.unwrapped).metadata["render_fps"] == 30


def test_registering_again_changes_nothing_and_says_nothing():
    before = {entry.id: gym.spec(entry.id) for entry in ENTRIES}
    importlib.reload(bounce_env)  # Gymnasium would warn of an id that is overridden
    assert {entry.id: gym.spec(entry.id) for entry in ENTRIES} == before


def test_an_id_with_the_modules_name_needs_no_import():
    done = subprocess.run([sys.executable, "-W", "error", "-c", BY_PREFIX], capture_output=True, text=True, check=False)
    assert done.stderr == ""
    assert done.stdout.split() == ["Bounce/Paddle-v0"]
