"""What people run into: arrays that change under them, forks, step limits, vectors without the usual calls."""

import copy
import os
import pickle
import signal
import threading

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.wrappers import TimeAwareObservation, TimeLimit
from stable_baselines3.common.monitor import Monitor

from bounce_env.sb3 import BounceVecEnv
from tests.conftest import require
from tests.env.rollouts import MODES, PADDLE, PINBALL, WALLS, assert_same, make_vec, scripted

IDS = (PADDLE, PINBALL, WALLS)


def vector(env_id, worlds=2, **kwargs):
    return gym.make_vec(env_id, worlds, vectorization_mode="vector_entry_point", **kwargs)


def arrays_of(value, at=()):
    """Every array in what was handed out, with where it is."""
    if isinstance(value, np.ndarray) and value.dtype != object:
        yield at, value
    elif isinstance(value, np.ndarray | tuple | list):
        for i, item in enumerate(value):
            yield from arrays_of(item, (*at, i))
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from arrays_of(item, (*at, key))
    elif hasattr(value, "__dataclass_fields__"):
        yield from arrays_of({name: getattr(value, name) for name in value.__dataclass_fields__}, at)


# Arrays


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("env_id", IDS)
def test_what_was_handed_out_is_never_written_again(env_id, mode):
    envs = vector(env_id, 3, autoreset_mode=mode, time_limit=4.0, render_mode="rgb_array", height=40)
    handed = [envs.reset(seed=1)]
    ended = np.zeros(3, np.bool_)
    state = envs.clone_state()
    for k, actions in enumerate(scripted(envs.action_space, 140)):
        if mode == "DISABLED" and ended.any():
            handed.append(envs.reset(options={"reset_mask": ended}))
        handed.append(envs.step(actions))
        ended = handed[-1][2] | handed[-1][3]
        if k % 40 == 0:
            handed.append((envs.picture(k % 3), envs.render(), state))
    before = copy.deepcopy([list(arrays_of(each)) for each in handed])
    for actions in scripted(envs.action_space, 30):
        if mode == "DISABLED" and ended.any():
            envs.reset(options={"reset_mask": ended})
        ended = np.logical_or(*envs.step(actions)[2:4])
    envs.restore_state(state[:1], np.array([True, False, False]))
    envs.reset(seed=4)
    for was, now in zip(before, handed, strict=True):
        for (at, old), (_, new) in zip(was, arrays_of(now), strict=True):
            np.testing.assert_array_equal(old, new, err_msg=str(at))


@pytest.mark.parametrize("mode", MODES)
def test_what_was_handed_out_may_be_written_to_without_harm(mode):
    """By a user who clears masks and observations in place: the environment keeps none of them."""
    ours, theirs = (make_vec(2, mode, time_limit=0.1) for _ in range(2))
    ended = np.zeros(2, np.bool_)
    steps = [(ours.reset(seed=3), theirs.reset(seed=3))]
    for _ in range(8):
        if mode == "DISABLED" and ended.any():
            options = {"reset_mask": ended.copy()}
            steps.append((ours.reset(options=options), theirs.reset(options=options)))
        steps.append(tuple(envs.step(np.zeros((2, 1))) for envs in (ours, theirs)))
        assert_same(*steps[-1])
        ended = (steps[-1][1][2] | steps[-1][1][3]).copy()
        mine = list(arrays_of(steps[-1][0]))
        assert len({id(array) for _, array in mine}) == len(mine)
        for _, array in mine:
            assert array.flags.writeable
            array[...] = 0
    if mode == "DISABLED":
        ours.reset(), theirs.reset()
        for _ in range(3):
            *_, info = ours.step(np.zeros((2, 1)))
        info["_end_reason"][:] = False
        with pytest.raises(gym.error.ResetNeeded):
            ours.step(np.zeros((2, 1)))


# Threads and processes


def test_a_forked_child_steps_with_threads_of_its_own():
    require("fork", hasattr(os, "fork"), "os.fork")
    envs = make_vec(8, num_threads=2)
    envs.reset(seed=0)
    envs.step(np.zeros((8, 1)))
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        envs.step(np.zeros((8, 1)))
        envs.close()
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0
    envs.step(np.zeros((8, 1)))  # the parent's are still its own


def test_threads_of_python_step_environments_of_their_own():
    batches = [make_vec(4, num_threads=2) for _ in range(3)]
    expected = make_vec(4)
    seen = {}

    def play(k):
        batches[k].reset(seed=7)
        seen[k] = [batches[k].step(actions)[0] for actions in scripted(batches[k].action_space, 30)]

    threads = [threading.Thread(target=play, args=(k,)) for k in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(timeout=120)
    expected.reset(seed=7)
    alone = [expected.step(actions)[0] for actions in scripted(expected.action_space, 30)]
    for k in range(3):
        assert_same(seen[k], alone)


def test_closed_is_closed():
    envs = make_vec(4, num_threads=2)
    envs.reset()
    envs.step(np.zeros((4, 1)))
    envs.close()
    for call in (lambda: envs.step(np.zeros((4, 1))), envs.reset):
        with pytest.raises(gym.error.ClosedEnvironmentError, match="closed"):
            call()


def test_actions_that_are_read_only_compile_nothing_anew():
    from bounce_env.games.kernels import step_worlds

    envs = vector(WALLS, 3)
    envs.reset(seed=0)
    envs.step(np.zeros((3, 4)))
    known = len(step_worlds.signatures)
    actions = np.zeros((3, 4))
    actions.flags.writeable = False
    envs.step(actions)
    envs.step(np.zeros((4, 3), np.float32).T)
    assert len(step_worlds.signatures) == known


# Step limits


def limited(env_id, how, steps, **kwargs):
    match how:
        case "keyword":
            return gym.make(env_id, max_episode_steps=steps, **kwargs)
        case "by hand":
            return TimeLimit(gym.make(env_id, **kwargs), steps)
        case "nested":
            return TimeLimit(gym.make(env_id, max_episode_steps=steps + 3, **kwargs), steps)
        case _:
            wrapped = TimeLimit(gym.wrappers.RecordEpisodeStatistics(gym.make(env_id, **kwargs)), steps)
            return gym.wrappers.Autoreset(wrapped) if how == "inside others" else wrapped


@pytest.mark.parametrize("how", ["keyword", "by hand", "nested", "around others", "inside others"])
@pytest.mark.parametrize("env_id", IDS)
def test_an_episode_cut_by_any_time_limit_has_its_end_info(env_id, how):
    """And ends as in the vector env, which takes the limit by keyword: at the same step, with the same words."""
    env, envs = limited(env_id, how, 12), vector(env_id, 1, max_episode_steps=12)
    for _ in range(2):
        env.reset(seed=5), envs.reset(seed=5)
        for k in range(12):
            observation, reward, *ends, info = env.step(np.zeros_like(env.action_space.sample()))
            observations, rewards, *all_ends, told = envs.step(np.zeros_like(envs.action_space.sample()))
            assert_same(observation, observations[0])
            assert (reward, *ends) == (rewards[0], all_ends[0][0], all_ends[1][0])
            assert ("end_reason" in info) == (k == 11) == ("end_reason" in told)
        assert info["end_reason"] == "time_limit"
        info.pop("episode", None)
        assert info == {key: value[0] for key, value in told.items() if key[0] != "_"}


@pytest.mark.parametrize("env_id", IDS)
def test_monitor_finds_its_keywords_at_a_cut(env_id):
    env = Monitor(gym.make(env_id, max_episode_steps=3), None, info_keywords=("end_reason", "bounces"))
    env.reset(seed=0)
    for _ in range(3):
        *_, info = env.step(np.zeros_like(env.action_space.sample()))
    assert info["episode"]["l"] == 3
    assert info["episode"]["end_reason"] == "time_limit"


@pytest.mark.parametrize(("env_id", "kwargs"), [(PADDLE, {}), (PINBALL, {"balls": 1}), (WALLS, {"balls": 1})])
def test_a_ball_that_is_lost_in_the_last_step_ends_alike_everywhere(env_id, kwargs):
    env = gym.make(env_id, **kwargs)
    env.reset(seed=0)
    still = np.zeros_like(env.action_space.sample())
    steps = 1
    while not env.step(still)[2]:
        steps += 1
    single = gym.make(env_id, max_episode_steps=steps, **kwargs)
    envs = vector(env_id, 1, max_episode_steps=steps, **kwargs)
    single.reset(seed=0), envs.reset(seed=0)
    for _ in range(steps):
        one, all_ = single.step(still), envs.step(still[None] if still.shape else np.zeros(1, np.int64))
    assert (one[2], one[3]) == (all_[2][0], all_[3][0]) == (True, True)
    assert one[4]["end_reason"] == all_[4]["end_reason"][0] != "time_limit"


@pytest.mark.parametrize("env_id", IDS)
def test_a_time_limit_counts_the_steps_of_its_own_level(env_id):
    """Not those of the environment, of which a wrapper between them takes several at a time."""
    env = TimeLimit(gym.wrappers.MaxAndSkipObservation(gym.make(env_id), skip=4), 6)
    for _ in range(2):
        env.reset(seed=0)
        for k in range(6):
            *_, terminated, truncated, info = env.step(np.zeros_like(env.action_space.sample()))
            assert (terminated, truncated) == (False, k == 5)
            assert ("end_reason" in info) == (k == 5)
        assert info["end_reason"] == "time_limit"


def test_a_limit_counts_on_after_a_state_was_restored():
    env = gym.make(PADDLE, max_episode_steps=20)
    env.reset(seed=0)
    for _ in range(5):
        env.step([0.0])
    state = env.unwrapped.clone_state()
    for k in range(5, 20):
        if k == 12:
            env.unwrapped.restore_state(state)
        *_, truncated, info = env.step([0.0])
        assert truncated == (k == 19) == ("end_reason" in info)
    env.reset(options={"snapshot": state})
    for k in range(20):
        *_, truncated, info = env.step([0.0])
        assert truncated == (k == 19) == ("end_reason" in info)


def test_a_spec_tells_the_smallest_limit():
    assert vector(PADDLE, 2, max_episode_steps=7).spec.max_episode_steps == 7
    assert vector(PADDLE, 2, max_episode_steps=np.int64(-1), time_limit=2.0).spec.max_episode_steps == 60
    tiny = gym.make(gym.make(PADDLE, time_limit=1e-9).spec)
    assert tiny.spec.max_episode_steps == 1


def test_a_limit_that_is_taken_away_is_forgotten():
    env = gym.make(PADDLE, max_episode_steps=3)
    env.reset(seed=0)
    env.unwrapped.reset(seed=0)
    for _ in range(5):
        _, _, terminated, truncated, info = env.unwrapped.step([0.0])
        assert not terminated
        assert not truncated
        assert "end_reason" not in info


@pytest.mark.parametrize("env_id", IDS)
def test_time_can_be_observed(env_id):
    env = TimeAwareObservation(gym.make(env_id, time_limit=5.0), normalize_time=True)
    assert env.max_timesteps == 150
    env.reset(seed=0)
    assert env.step(np.zeros_like(env.action_space.sample()))[0][-1] == pytest.approx(1 / 150)
    assert TimeAwareObservation(gym.make(env_id, max_episode_steps=7)).max_timesteps == 7
    with pytest.raises(ValueError, match="max_episode_steps"):
        TimeAwareObservation(gym.make(env_id, time_limit=None))


# Vectors


def test_the_mode_is_a_property():
    assert make_vec(2, "SAME_STEP").autoreset_mode is gym.vector.AutoresetMode.SAME_STEP


def test_call_get_attr_and_set_attr_are_those_of_single_environments():
    ours = vector(PADDLE, 2, num_levels=0, render_mode="rgb_array", height=40)
    theirs = gym.make_vec(PADDLE, 2, vectorization_mode="sync", num_levels=0, render_mode="rgb_array", height=40)
    assert_same(ours.reset(seed=3), theirs.reset(seed=3))
    for name in ("scene", "render_mode", "action_space", "observation_space", "status"):
        assert ours.get_attr(name) == theirs.get_attr(name)
    assert ours.get_attr("scene")[0] != ours.get_attr("scene")[1]
    assert_same(ours.call("render"), theirs.call("render"))
    assert_same(ours.call("reset", seed=9), theirs.call("reset", seed=9))
    assert_same(ours.step(np.zeros((2, 1))), theirs.step(np.zeros((2, 1))))
    for envs in (ours, theirs):
        envs.set_attr("stage", [1, 2])
        assert envs.get_attr("stage") == (1, 2)
        envs.set_attr("stage", 3)
        assert envs.get_attr("stage") == (3, 3)
        with pytest.raises(ValueError, match="2"):
            envs.set_attr("stage", [1, 2, 3])
        with pytest.raises(AttributeError):
            envs.get_attr("no_such")


def test_one_world_is_reset_and_no_other():
    ours, untouched = (vector(WALLS, 3) for _ in range(2))
    ours.reset(seed=1), untouched.reset(seed=1)
    observation, info = ours.worlds[1].reset(seed=8, options={"position": (0.5, 0.8)})
    assert_same((observation, info), gym.make(WALLS).reset(seed=8, options={"position": (0.5, 0.8)}))
    after, before = (envs.step(np.zeros((3, 4)))[0] for envs in (ours, untouched))
    assert_same(after[[0, 2]], before[[0, 2]])
    assert not np.array_equal(after[1], before[1])
    state = ours.worlds[2].clone_state()
    assert len(state) == 1
    assert_same(ours.worlds[0].restore_state(state), after[2])


def test_no_episode_that_has_ended_goes_on_in_mode_same_step():
    env = gym.make(PADDLE, time_limit=0.1)
    env.reset(seed=0)
    while not env.step([0.0])[3]:
        pass
    envs = make_vec(1, "SAME_STEP", time_limit=0.1)
    envs.reset(seed=5)
    with pytest.raises(ValueError, match="has ended"):
        envs.restore_state(env.unwrapped.clone_state())


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda envs: pickle.loads(pickle.dumps(envs))])
def test_worlds_of_a_copy_are_its_own(copied):
    envs = vector(PADDLE, 2)
    envs.reset(seed=0)
    envs.set_attr("stage", 4)
    other = copied(envs)
    assert other.get_attr("stage") == (4, 4)
    other.worlds[0].reset(seed=77)
    assert_same(envs.worlds[0].clone_state().data, envs.clone_state()[:1].data)
    assert not np.array_equal(other.step(np.zeros((2, 1)))[0][0], envs.step(np.zeros((2, 1)))[0][0])


@pytest.mark.parametrize("env_id", IDS)
def test_an_episode_of_sb3_is_as_long_as_its_steps(env_id):
    envs = BounceVecEnv(env_id, 2, seed=0, max_episode_steps=9)
    envs.reset()
    for _ in range(9):
        _, _, dones, infos = envs.step(np.zeros_like([envs.action_space.sample()] * 2))
    assert dones.all()
    assert [info["episode"]["l"] for info in infos] == [9, 9]
