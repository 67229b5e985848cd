"""BounceVecEnv keeps SB3's conventions: what DummyVecEnv does with our single envs, it does."""

import gymnasium as gym
import numpy as np
import pytest
from stable_baselines3 import PPO
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import (
    DummyVecEnv,
    VecCheckNan,
    VecFrameStack,
    VecMonitor,
    VecNormalize,
    VecVideoRecorder,
)

from bounce_env.sb3 import BounceVecEnv
from tests.env.rollouts import KINDS, PADDLE, PINBALL, WALLS, assert_same, name, scripted

pytestmark = pytest.mark.train

WORLDS = 4
SHORT = {"time_limit": 1.5}


def scripted_for(envs, steps):
    return scripted(gym.vector.utils.batch_space(envs.action_space, envs.num_envs), steps)


def same_step(ours, theirs):
    """All but what differs by design: the wall clock, and SB3's flag on steps that end nothing."""
    assert_same(ours[:3], theirs[:3])
    for info, expected, done in zip(ours[3], map(dict, theirs[3]), theirs[2], strict=True):
        if done:
            told, monitored = info.pop("episode"), expected.pop("episode")
            assert (told["r"], told["l"]) == (monitored["r"], monitored["l"])
            assert {key: type(value) for key, value in told.items()} == {"r": float, "l": int, "t": float}
        else:
            assert expected.pop("TimeLimit.truncated") is False
        assert_same(info, expected)


@pytest.mark.parametrize("kwargs", KINDS, ids=name)
def test_steps_equal_dummy_vec_env_over_single_envs(kwargs):
    ours = BounceVecEnv(PADDLE, WORLDS, seed=7, **SHORT, **kwargs)
    theirs = DummyVecEnv([lambda: Monitor(gym.make(PADDLE, **SHORT, **kwargs))] * WORLDS)
    theirs.seed(7)
    assert ours.observation_space == theirs.observation_space
    assert ours.action_space == theirs.action_space
    assert_same(ours.reset(), theirs.reset())
    assert_same(ours.reset_infos, theirs.reset_infos)
    flags = []
    for actions in scripted_for(theirs, 400):
        step = theirs.step(actions)
        same_step(ours.step(actions), step)
        assert_same(ours.reset_infos, theirs.reset_infos)
        flags += [info["TimeLimit.truncated"] for info, done in zip(step[3], step[2], strict=True) if done]
    assert 5 < sum(flags) < len(flags) - 5  # ends of both kinds were compared
    assert_same(ours.reset(), theirs.reset())  # without a new seed the streams go on


@pytest.mark.parametrize("env_id", [PINBALL, WALLS])
@pytest.mark.parametrize("reward", ["dense", None])
def test_an_episodes_return_is_the_sum_of_its_rewards(env_id, reward):
    """Not its score, which is something else where a reward is shaped or a lost ball costs."""
    kwargs = {} if reward is None else {"reward": reward}
    ours = BounceVecEnv(env_id, WORLDS, seed=7, time_limit=6.0, **kwargs)
    theirs = DummyVecEnv([lambda: Monitor(gym.make(env_id, time_limit=6.0, **kwargs))] * WORLDS)
    theirs.seed(7)
    ours.reset()
    theirs.reset()
    returns = []
    for actions in scripted_for(theirs, 400):
        step = theirs.step(actions)
        same_step(ours.step(actions), step)
        returns += [(info["episode"]["r"], info["score"]) for info, done in zip(step[3], step[2], strict=True) if done]
    assert len(returns) >= WORLDS
    if reward == "dense":
        assert all(total != score for total, score in returns)


def test_an_episode_ends_with_what_sb3_bootstraps_from():
    envs = BounceVecEnv(PADDLE, 1, seed=0, time_limit=0.1)
    envs.reset()
    for _ in range(2):
        _, _, (done,), (info,) = envs.step(np.zeros((1, 1), np.float32))
        assert not done
        assert "terminal_observation" not in info
        assert not info.get("TimeLimit.truncated", False)
    observations, rewards, (done,), (info,) = envs.step(np.zeros((1, 1), np.float32))
    assert done
    assert rewards.dtype == np.float32
    assert info["TimeLimit.truncated"] is True
    assert info["end_reason"] == "time_limit"
    assert info["terminal_observation"].shape == (5,)
    assert not np.array_equal(info["terminal_observation"], observations[0])


def test_a_drained_ball_is_no_truncation_even_at_the_limit():
    """Lost in the very step that the time ends with: terminated, so nothing is to be bootstrapped."""
    fall = {"position": (0.05, 0.02), "velocity": (0.0, -1.0)}
    env = gym.make(PADDLE)
    env.reset(seed=0, options=fall)
    steps = 1
    while not env.step([0.0])[2]:
        steps += 1
    envs = BounceVecEnv(PADDLE, 1, max_episode_steps=steps)
    envs.set_options(fall)
    envs.reset()
    for _ in range(steps):
        _, _, (done,), (info,) = envs.step(np.zeros((1, 1), np.float32))
    assert done
    assert info["end_reason"] == "drained"
    assert info["TimeLimit.truncated"] is False


def test_seed_counts_from_the_next_reset_once():
    envs, again = BounceVecEnv(PADDLE, WORLDS), BounceVecEnv(PADDLE, WORLDS, seed=5)
    assert envs.seed(5) == [5, 6, 7, 8]
    first = envs.reset()
    assert_same(again.reset(), first)
    second = envs.reset()
    assert not np.array_equal(second, first)
    assert_same(again.reset(), second)
    envs.seed(5)
    assert_same(envs.reset(), first)


def test_making_one_without_a_seed_draws_nothing_from_the_global_generator():
    np.random.seed(3)  # noqa: NPY002 (the one that SB3's set_random_seed sets)
    before = np.random.get_state()[1].copy()  # noqa: NPY002
    first, second = (BounceVecEnv(PADDLE, WORLDS).reset() for _ in range(2))
    assert_same(np.random.get_state()[1], before)  # noqa: NPY002
    assert not np.array_equal(first, second)


def test_options_go_to_the_next_reset_only():
    envs = BounceVecEnv(PADDLE, 2, seed=0)
    envs.set_options({"velocity": np.array([0.5, -0.5])})
    np.testing.assert_array_equal(envs.reset()[:, 2:4], [[0.25, -0.25]] * 2)
    assert not np.array_equal(envs.reset()[:, 2:4], [[0.25, -0.25]] * 2)
    envs.set_options([{"velocity": (0.5, 1.0)}, {"velocity": (1.0, -1.0)}])
    np.testing.assert_array_equal(envs.reset()[:, 2:4], [[0.25, 0.5], [0.5, -0.5]])
    envs.set_options({"level": 3})
    with pytest.raises(ValueError, match="level"):
        envs.reset()


def test_attributes_are_those_of_one_world():
    envs = BounceVecEnv(PADDLE, 3, render_mode="rgb_array", frame_skip=3)
    single = gym.make(PADDLE)
    assert envs.get_attr("render_mode") == ["rgb_array"] * 3
    assert BounceVecEnv(PADDLE, 2).get_attr("render_mode") == [None] * 2
    assert envs.render_mode == "rgb_array"
    assert envs.get_attr("spec", [0, 2]) == [envs.spec] * 2
    assert envs.spec.id == PADDLE
    assert envs.get_attr("metadata", 0)[0]["render_fps"] == envs.metadata["render_fps"] == 20
    assert envs.get_attr("observation_space") == [single.observation_space] * 3
    assert envs.get_attr("action_space", 1) == [single.action_space]
    assert envs.has_attr("num_envs")
    assert not envs.has_attr("compute_reward")
    for attribute in ("frame_skip", "render_mode", "reset"):
        with pytest.raises(NotImplementedError, match=f"{attribute} cannot be set: pass keyword arguments"):
            envs.set_attr(attribute, 4)
    with pytest.raises(AttributeError, match=r"no 'scen' \(did you mean 'scene'\?\)"):
        envs.get_attr("scen")
    envs.set_attr("stage", 2, indices=[0, 2])
    assert envs.get_attr("stage", [0, 2]) == [2, 2]
    with pytest.raises(AttributeError):
        envs.get_attr("stage", 1)


def test_methods_act_on_the_worlds_of_their_indices_alone():
    envs = BounceVecEnv(PADDLE, 3, seed=1, render_mode="rgb_array", height=60)
    envs.reset()
    frames = envs.env_method("render")
    assert_same(frames, envs.get_images())
    assert_same(envs.env_method("render", indices=[1]), frames[1:2])
    states = envs.env_method("clone_state")
    observations = [envs.step(np.ones((3, 1)))[0] for _ in range(3)][-1]
    restored = envs.env_method("restore_state", states[2], indices=2)[0]
    assert not np.array_equal(restored, observations[2])
    after, *_ = envs.step(np.zeros((3, 1)))
    assert not np.array_equal(after[2], after[1])
    with pytest.raises(NotImplementedError, match="one world cannot be stepped alone"):
        envs.env_method("step", [0.0], indices=0)


def test_a_reset_of_one_world_begins_its_statistics_anew():
    envs = BounceVecEnv("Bounce/Walls-v0", 2, seed=0, time_limit=1.0)
    envs.reset()
    for _ in range(5):
        envs.step(np.zeros((2, 4)))
    observation, info = envs.env_method("reset", indices=[1], seed=4)[0]
    assert_same(observation, gym.make("Bounce/Walls-v0").reset(seed=4)[0])
    assert info == {"score": 0.0, "ball": 0}
    lengths = {}
    for _ in range(31):
        _, _, dones, infos = envs.step(np.zeros((2, 4)))
        lengths |= {w: infos[w]["episode"]["l"] for w in np.flatnonzero(dones).tolist() if w not in lengths}
    assert lengths == {0: 30, 1: 30}


def test_worlds_may_have_other_options_and_snapshots():
    envs, other = (BounceVecEnv(PADDLE, 3, seed=2) for _ in range(2))
    plain = other.reset()
    envs.set_options([{"position": (0.5, 0.6)}, {}, {"position": (0.4, 0.6), "velocity": (0.0, 1.0)}])
    observations = envs.reset()
    assert_same(observations[1], plain[1])
    np.testing.assert_allclose(observations[[0, 2], 0], [0.0, -0.2], atol=1e-6)
    states = envs.env_method("clone_state")
    for _ in range(3):
        envs.step(np.zeros((3, 1)))
    envs.set_options([{"snapshot": state} for state in states])
    assert_same(envs.reset(), observations)


def test_options_of_one_world_that_are_refused_reset_none():
    envs, other = (BounceVecEnv(PADDLE, 2, seed=2) for _ in range(2))
    envs.reset(), other.reset()
    for bad in ([{"position": (0.5, 0.6)}, {"foo": 1}], [{"velocity": (0.0, 1.0)}, {"reset_mask": np.ones(2, bool)}]):
        envs.set_options(bad)
        with pytest.raises(ValueError, match="options"):
            envs.reset()
    assert_same(envs.step(np.zeros((2, 1)))[0], other.step(np.zeros((2, 1)))[0])


def test_what_is_no_environment_of_ours_is_refused():
    for env_id in ("CartPole-v1", "Pendulum-v1"):
        with pytest.raises(ValueError, match=f"env_id = '{env_id}': must be an environment of bounce_env"):
            BounceVecEnv(env_id, 2)


def test_monitored_and_in_no_other_wrapper():
    envs = BounceVecEnv(PADDLE, 3)
    assert envs.env_is_wrapped(Monitor) == [True] * 3
    assert envs.env_is_wrapped(gym.wrappers.TimeLimit, [0, 1]) == [False] * 2


@pytest.mark.parametrize(
    ("keyword", "value"), [("autoreset_mode", "NEXT_STEP"), ("copy", False), ("vectorization_mode", "sync")]
)
def test_what_sb3_relies_on_cannot_be_chosen(keyword, value):
    """With copy=False the next step would overwrite the observations that a rollout has yet to store."""
    with pytest.raises(ValueError, match=f"{keyword} = .*: must be left out"):
        BounceVecEnv(PADDLE, 2, **{keyword: value})


@pytest.fixture
def registered():
    """Register an id for one test."""
    ids = []

    def register(env_id, **entry):
        ids.append(env_id)
        gym.register(env_id, **entry)
        return env_id

    yield register
    for env_id in ids:
        gym.registry.pop(env_id)


def test_another_environment_is_refused_by_name(registered):
    def cart_poles(num_envs, autoreset_mode):
        return gym.vector.SyncVectorEnv([lambda: gym.make("CartPole-v1")] * num_envs)

    other = registered("Other/CartPole-v0", vector_entry_point=cart_poles)
    with pytest.raises(ValueError, match="env_id = 'Other/CartPole-v0': must be an environment of bounce_env"):
        BounceVecEnv(other, 2)


def test_an_id_of_ones_own_with_our_entry_point_is_served(registered):
    own = registered("Own/Paddle-v0", vector_entry_point="bounce_env.envs:PaddleVectorEnv", kwargs={"frame_skip": 6})
    assert BounceVecEnv(own, 2).metadata["render_fps"] == 10


def test_sb3s_wrappers_take_it():
    envs = VecFrameStack(VecNormalize(VecCheckNan(BounceVecEnv(PADDLE, 3, seed=1)), norm_reward=False), 4)
    assert envs.reset().shape == (3, 20)
    plain = BounceVecEnv(PADDLE, 3, seed=1)
    plain.reset()
    for actions in scripted_for(plain, 60):
        _, rewards, dones, infos = envs.step(actions)
        _, expected, ended, _ = plain.step(actions)
        assert_same(dones, ended)
        np.testing.assert_array_equal(rewards, expected)
        for info, done in zip(infos, dones, strict=True):
            assert ("terminal_observation" in info) == done
            assert not done or info["terminal_observation"].shape == (20,)


def test_vec_monitor_counts_what_we_count_and_says_that_it_replaces_it():
    with pytest.warns(UserWarning, match="already wrapped with a `Monitor`"):
        envs = VecMonitor(BounceVecEnv(PADDLE, 3, seed=1), info_keywords=("score", "end_reason"))
    envs.reset()
    ends = 0
    for actions in scripted_for(envs, 200):
        for info, done in zip(*envs.step(actions)[:1:-1], strict=True):
            if done:
                ends += 1
                assert info["episode"]["r"] == info["score"]
                assert info["episode"]["l"] == round(30 * info["game_seconds"])
                assert info["episode"]["end_reason"] == "drained"
    assert ends > 5


def test_vec_video_recorder_writes_a_film(tmp_path):
    envs = VecVideoRecorder(
        BounceVecEnv(PADDLE, 2, seed=1, render_mode="rgb_array", height=60),
        str(tmp_path),
        record_video_trigger=lambda step: step == 0,
        video_length=5,
    )
    envs.reset()
    for _ in range(7):
        envs.step(np.zeros((2, 1), np.float32))
    envs.close()
    assert [video.stat().st_size > 500 for video in tmp_path.glob("*.mp4")] == [True]


@pytest.mark.parametrize("action", ["continuous", "discrete"])
def test_ppo_learns_on_it_and_logs_scores(action):
    envs = BounceVecEnv(PADDLE, 16, action=action, time_limit=0.2)
    model = PPO("MlpPolicy", envs, n_steps=8, batch_size=64, n_epochs=1, seed=0, device="cpu")
    model.learn(2 * 8 * 16)
    assert model.num_timesteps == 256
    assert len(model.ep_info_buffer) > 16
    assert np.isfinite(model.logger.name_to_value["train/loss"])
    scores = [episode["r"] for episode in model.ep_info_buffer]
    logged = {}
    model.logger.record_mean = lambda *_: None
    model.logger.record = lambda key, value, *_, **__: logged.setdefault(key, value)
    model.dump_logs()
    assert logged["rollout/ep_rew_mean"] == np.mean(scores)
    assert logged["rollout/ep_len_mean"] == 6.0
    rewards, lengths = evaluate_policy(model, envs, n_eval_episodes=4, return_episode_rewards=True)
    assert len(rewards) == 4
    assert set(lengths) == {6}
