"""What users wrap around an environment or run it in: Gymnasium's wrappers, workers in other processes, videos."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AsyncVectorEnv, AutoresetMode
from gymnasium.wrappers import RecordEpisodeStatistics, RecordVideo
from gymnasium.wrappers import vector as vector_wrappers
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.vec_env import DummyVecEnv, SubprocVecEnv

from tests.env.rollouts import PADDLE, assert_same, make_env, make_sync, make_vec, scripted

pytestmark = pytest.mark.slow

WORLDS = 2
SHORT = {"time_limit": 1.0}


@pytest.mark.parametrize("context", ["fork", "spawn"])
def test_gymnasiums_workers_play_the_same(context):
    envs = AsyncVectorEnv([make_env] * WORLDS, context=context)
    here = make_sync(WORLDS, "NEXT_STEP", **SHORT)
    try:
        assert_same(envs.reset(seed=3), here.reset(seed=3))
        for actions in scripted(here.action_space, 80):
            assert_same(envs.step(actions), here.step(actions))
    finally:
        envs.close()


def test_a_fork_survives_the_threads_of_its_parent():
    """Under OpenMP a forked child would die at its first kernel; our threads only call kernels that release the GIL."""
    threaded = make_vec(4, num_threads=2)
    threaded.reset(seed=0)
    threaded.step(np.zeros(4))
    envs = AsyncVectorEnv([make_env], context="fork")
    try:
        envs.reset(seed=3)
        envs.step(np.zeros((1, 1), np.float32))
    finally:
        envs.close()


def test_sb3s_workers_play_the_same():
    envs = SubprocVecEnv([make_env] * WORLDS, start_method="fork")
    here = DummyVecEnv([make_env] * WORLDS)
    try:
        envs.seed(3), here.seed(3)
        assert_same(envs.reset(), here.reset())
        for actions in scripted(gym.vector.utils.batch_space(here.action_space, WORLDS), 80):
            observations, rewards, dones, infos = envs.step(actions)
            # SubprocVecEnv's own way: rewards as float64, infos as a tuple
            assert_same((observations, rewards.astype(np.float32), dones, list(infos)), here.step(actions))
    finally:
        envs.close()


def test_sb3s_make_vec_env_takes_the_id_and_its_kwargs():
    envs = make_vec_env(PADDLE, n_envs=2, seed=0, env_kwargs=SHORT)
    envs.reset()
    for _ in range(31):
        _, _, dones, infos = envs.step(np.zeros((2, 1), np.float32))
        if dones.any():
            break
    assert infos[int(np.argmax(dones))]["episode"]["l"] <= 30


def test_record_video_writes_each_episode(tmp_path):
    videos = tmp_path / "videos"
    env = RecordVideo(
        gym.make(PADDLE, render_mode="rgb_array", time_limit=0.2, height=120), videos, episode_trigger=lambda _: True
    )
    for _ in range(2):
        env.reset(seed=0)
        while not env.step([0.0])[3]:
            pass
    env.close()
    assert [video.stat().st_size > 500 for video in videos.glob("*.mp4")] == [True, True]


def test_vector_record_video_writes_a_grid(tmp_path):
    videos = tmp_path / "videos"
    envs = vector_wrappers.RecordVideo(
        make_vec(4, render_mode="rgb_array", height=120), str(videos), video_length=5, step_trigger=lambda t: t == 0
    )
    envs.reset(seed=0)
    for _ in range(8):
        envs.step(np.zeros(4))
    envs.close()
    assert [video.stat().st_size > 500 for video in videos.glob("*.mp4")] == [True]


def test_episode_statistics_of_a_single_env_are_the_score():
    env = RecordEpisodeStatistics(gym.make(PADDLE))
    env.action_space.seed(0)
    for episode in range(5):
        env.reset(seed=episode)
        ended, steps = False, 0
        while not ended:
            *_, terminated, truncated, info = env.step(env.action_space.sample())
            ended, steps = terminated or truncated, steps + 1
        assert info["episode"]["r"] == info["score"]
        assert info["episode"]["l"] == steps


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP"])
def test_episode_statistics_of_a_batch_are_the_scores(mode):
    envs = vector_wrappers.RecordEpisodeStatistics(make_vec(6, mode, **SHORT))
    envs.reset(seed=0)
    ends = 0
    for actions in scripted(envs.action_space, 120):
        _, _, terminated, truncated, info = envs.step(actions)
        ended = terminated | truncated
        if ended.any():
            told = info["final_info"] if mode == "SAME_STEP" else info
            assert_same(info["_episode"], ended)
            assert_same(info["episode"]["r"][ended], told["score"][ended])
            seconds = info["episode"]["l"][ended] / 30
            np.testing.assert_allclose(seconds, told["game_seconds"][ended], rtol=1e-12)
            ends += ended.sum()
    assert ends > 12


BOTH, NEXT = ("NEXT_STEP", "SAME_STEP"), ("NEXT_STEP",)  # those that change observations know no final ones
TWO = np.float32(2.0)
VECTOR_WRAPPERS = {
    "NormalizeObservation": (vector_wrappers.NormalizeObservation, NEXT),
    "FlattenObservation": (vector_wrappers.FlattenObservation, NEXT),
    "NormalizeReward": (vector_wrappers.NormalizeReward, BOTH),
    "ClipReward": (lambda envs: vector_wrappers.ClipReward(envs, 0.0, 1.0), BOTH),
    "ClipAction": (vector_wrappers.ClipAction, BOTH),
    "RescaleAction": (lambda envs: vector_wrappers.RescaleAction(envs, -TWO, TWO), BOTH),
    "DictInfoToList": (vector_wrappers.DictInfoToList, BOTH),
}


@pytest.mark.parametrize(("wrapper", "mode"), [(w, m) for w, (_, modes) in VECTOR_WRAPPERS.items() for m in modes])
def test_gymnasiums_vector_wrappers_do_the_same_around_ours_as_around_theirs(wrapper, mode):
    wrap, _ = VECTOR_WRAPPERS[wrapper]
    ours, theirs = wrap(make_vec(3, mode, **SHORT)), wrap(make_sync(3, mode, **SHORT))
    assert_same(ours.reset(seed=0), theirs.reset(seed=0))
    for actions in scripted(make_vec(3).action_space, 60):
        assert_same(ours.step(actions), theirs.step(actions))


def test_the_default_of_make_vec_is_our_own_batch():
    envs = gym.make_vec(PADDLE, num_envs=2)
    assert type(envs).__name__ == "PaddleVectorEnv"
    assert envs.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
