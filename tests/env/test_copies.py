"""A copy of an environment made in the middle of an episode goes on to the same bits, and on its own."""

import copy
import pickle

import gymnasium as gym
import numpy as np
import pytest

from bounce_env.sb3 import BounceVecEnv
from tests.env.rollouts import KINDS, PADDLE, PINBALL, WALLS, assert_same, make_vec, name, scripted

COPIES = [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))]
each_copy = pytest.mark.parametrize("copied", COPIES, ids=["deepcopy", "pickle"])


@each_copy
@pytest.mark.parametrize("kwargs", KINDS, ids=name)
def test_single_env(copied, kwargs):
    env = gym.make(PADDLE, render_mode="rgb_array", **kwargs)
    env.reset(seed=4)
    env.action_space.seed(0)
    script = [env.action_space.sample() for _ in range(300)]
    for action in script[:20]:
        env.step(action)
    env.render()  # what draws can be neither copied nor sent
    twin = copied(env)
    assert_same(twin.render(), env.render())
    ended = 0
    for action in script[20:]:
        step = env.step(action)
        assert_same(twin.step(action), step)
        if step[2]:
            ended += 1
            assert_same(twin.reset(), env.reset())  # the streams of episodes go on alike, too
    assert ended > 2
    assert_same(twin.np_random.random(5), env.np_random.random(5))


@each_copy
@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP"])
@pytest.mark.parametrize("threads", [1, 2])
def test_vector_env(copied, mode, threads):
    envs = make_vec(7, mode, num_threads=threads, repeat_action_probability=0.25, render_mode="rgb_array")
    envs.reset(seed=4)
    script = scripted(envs.action_space, 300)
    for actions in script[:40]:
        envs.step(actions)
    envs.render()
    twin = copied(envs)
    assert_same(twin.render(), envs.render())
    ended = 0
    for actions in script[40:]:
        step = envs.step(actions)
        assert_same(twin.step(actions), step)
        ended += step[2].sum()
    assert ended > 7
    assert_same(twin.reset(), envs.reset())


@each_copy
def test_a_finished_world_is_finished_in_the_copy(copied):
    envs = make_vec(2, "DISABLED", time_limit=0.1)
    envs.reset(seed=0)
    for _ in range(3):
        envs.step([0.0, 0.0])
    twin = copied(envs)
    with pytest.raises(gym.error.ResetNeeded):
        twin.step([0.0, 0.0])
    assert_same(twin.reset(), envs.reset())


@each_copy
def test_sb3_env(copied):
    envs = BounceVecEnv(PADDLE, 7, seed=4, num_threads=2)
    envs.reset()
    script = scripted(gym.vector.utils.batch_space(envs.action_space, 7), 300)
    for actions in script[:40]:
        envs.step(actions)
    twin = copied(envs)
    ended = 0
    for actions in script[40:]:
        step = envs.step(actions)
        assert_same(twin.step(actions), step)
        ended += step[2].sum()
    assert ended > 7
    assert_same(twin.reset(), envs.reset())


@each_copy
def test_a_copy_shares_nothing_with_its_original(copied):
    env, untouched = gym.make(PADDLE), gym.make(PADDLE)
    env.reset(seed=4), untouched.reset(seed=4)
    twin = copied(env)
    for _ in range(10):
        twin.step(np.ones(1, np.float32))
    twin.reset(seed=9)
    assert_same(env.step([0.0]), untouched.step([0.0]))
    assert_same(env.reset(), untouched.reset())


@each_copy
def test_an_open_window_is_not_copied(copied, monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    env = gym.make(PADDLE, render_mode="human")
    env.reset(seed=0)
    twin = copied(env)
    assert_same(twin.step([0.5]), env.step([0.5]))
    env.close(), twin.close()


@pytest.mark.parametrize("env_id", [PADDLE, PINBALL, WALLS])
def test_a_restored_state_goes_on_to_the_same_bits(env_id):
    """In the worlds that it came from, and, row by row, in those of another batch."""
    envs, other = (make_vec(4, "SAME_STEP", env_id, time_limit=9.0) for _ in range(2))
    envs.reset(seed=4), other.reset(seed=9)
    script = scripted(envs.action_space, 400)
    for actions in script[:40]:
        envs.step(actions)
    states = envs.unwrapped.clone_state()
    steps = [envs.step(actions) for actions in script[40:]]
    assert any(step[2].any() or step[3].any() for step in steps)
    envs.unwrapped.restore_state(states)
    assert_same([envs.step(actions) for actions in script[40:]], steps)
    other.unwrapped.restore_state(states[np.array([2, 2, 0])], np.array([True, False, True, True]))
    for actions, step in zip(script[40:], steps, strict=True):
        observations, rewards, *_ = other.step(actions[[2, 1, 2, 0]])
        assert_same(observations[[0, 3]], step[0][[2, 0]])
        assert_same(rewards[[0, 3]], step[1][[2, 0]])


def test_a_state_that_does_not_fit_is_refused_and_changes_nothing():
    envs, untouched = make_vec(3), make_vec(3)
    with pytest.raises(gym.error.ResetNeeded, match="clone_state"):
        envs.unwrapped.clone_state()
    envs.reset(seed=0), untouched.reset(seed=0)
    longer = make_vec(3, time_limit=7.0)
    longer.reset(seed=1)
    states = envs.unwrapped.clone_state()
    for state, mask, words in (
        (longer.unwrapped.clone_state(), None, "another game, scene or options"),
        (states[:2], None, "of 2 worlds: must be of 3"),
        (states, np.array([True, False, False]), "of 3 worlds: must be of 1"),
        (b"state", None, "must be what clone_state"),
        (states, np.zeros(3, bool), "at least one world"),
    ):
        with pytest.raises(ValueError, match=words):
            envs.unwrapped.restore_state(state, mask)
    assert_same(envs.step(np.ones(3)), untouched.step(np.ones(3)))
