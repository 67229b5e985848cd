"""Observations that are frames: obs="pixels" in single, vector and SB3's environments."""

import copy
import pickle
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from stable_baselines3 import PPO
from stable_baselines3.common.env_checker import check_env as sb3_check_env

from bounce_env.envs import observed_frames
from bounce_env.registration import ENTRIES
from bounce_env.render import Renderer
from bounce_env.sb3 import BounceVecEnv
from tests.env.rollouts import MODES, PADDLE, PINBALL, assert_same, make_sync, make_vec, scripted

PIXELS = {"obs": "pixels", "height": 40}
IDS = [entry.id for entry in ENTRIES]


def scripted_for(envs, steps):
    space = gym.vector.utils.batch_space(envs.action_space, envs.num_envs)
    return scripted(space, steps)


@pytest.mark.parametrize("env_id", IDS)
def test_an_observation_is_a_frame_of_84_by_84_unless_a_size_is_asked(env_id):
    env = gym.make(env_id, obs="pixels")
    assert env.observation_space == gym.spaces.Box(0, 255, (84, 84, 3), np.uint8)
    observation, _ = env.reset(seed=0)
    assert observation in env.observation_space
    assert gym.make(env_id, obs="pixels", obs_width=30, obs_height=50).observation_space.shape == (50, 30, 3)
    wide = gym.make(env_id, obs="pixels", obs_width=50).observation_space.shape
    assert wide[1] == 50
    assert wide[0] >= 50  # as high as the table's shape asks


@pytest.mark.parametrize("env_id", IDS)
def test_what_an_agent_is_given_says_nothing_of_the_size_of_films(env_id):
    films = gym.make(env_id, obs="pixels", render_mode="rgb_array")
    states = gym.make(env_id, render_mode="rgb_array")
    for env in (films, states):
        env.reset(seed=0)
    assert films.render().shape == states.render().shape
    assert films.render().shape[0] > 84
    large = gym.make(env_id, obs="pixels", render_mode="rgb_array", width=300, height=200, obs_height=40)
    assert large.reset(seed=0)[0].shape[0] == 40
    assert large.render().shape == (200, 300, 3)


@pytest.mark.parametrize("env_id", IDS)
@pytest.mark.filterwarnings("ignore:.*render")
def test_the_checkers_of_gymnasium_and_sb3_find_nothing(env_id):
    check_env(gym.make(env_id, **PIXELS, render_mode="rgb_array", disable_env_checker=True).unwrapped)
    sb3_check_env(gym.make(env_id, obs="pixels"))


@pytest.mark.parametrize("env_id", IDS)
def test_the_play_is_that_of_the_state(env_id):
    """The same seeds, rewards, ends and infos: only what is seen differs."""
    pixels, states = gym.make(env_id, **PIXELS, time_limit=3.0), gym.make(env_id, time_limit=3.0)
    pixels.action_space.seed(0)
    assert_same(pixels.reset(seed=3)[1], states.reset(seed=3)[1])
    ends = 0
    for _ in range(200):
        action = pixels.action_space.sample()
        seen, known = pixels.step(action), states.step(action)
        assert_same(seen[1:], known[1:])
        if seen[2] or seen[3]:
            ends += 1
            assert_same(pixels.reset()[1], states.reset()[1])
    assert ends > 1


def check_alike(observation, frame):
    """A frame by compiled code is the renderer's but for rounding on edges."""
    apart = np.abs(observation.astype(np.int16) - frame)
    assert apart.mean() < 0.3
    assert np.percentile(apart, 99.9) <= 32
    assert apart.max() <= 64


def unprinted(env):
    """What the renderer draws at the observation's size, without the score."""
    frames = env.unwrapped._frames
    return Renderer(
        env.unwrapped.scene, *frames._observed, targets=frames._batch.game.targets, hidden=frames._batch.game.hidden
    ).frame(replace(env.unwrapped.picture(), score=None))


@pytest.mark.parametrize("env_id", IDS)
@pytest.mark.parametrize(("width", "height"), [(84, 84), (33, 57), (160, 120)])
def test_an_observation_is_what_render_gives_but_for_the_score(env_id, width, height):
    env = gym.make(env_id, obs="pixels", obs_width=width, obs_height=height)
    grey = gym.make(env_id, obs="pixels", obs_width=width, obs_height=height, grayscale=True)
    assert grey.observation_space == gym.spaces.Box(0, 255, (height, width, 1), np.uint8)
    env.action_space.seed(0)
    for seed in range(3):
        env.reset(seed=seed)
        grey.reset(seed=seed)
        over = False
        while not over:
            action = env.action_space.sample()
            observation, _, terminated, truncated, _ = env.step(action)
            over = terminated or truncated or env.unwrapped.picture().score > 3.0
            luma = observation @ np.array([0.299, 0.587, 0.114])
            assert np.abs(grey.step(action)[0][:, :, 0] - luma).max() <= 2.0
        check_alike(observation, unprinted(env))


@pytest.mark.parametrize("env_id", IDS)
def test_lamps_lights_and_targets_are_seen(env_id):
    """In each step of some seconds: what was struck lights up, and what is lit."""
    env = gym.make(env_id, obs="pixels", time_limit=20.0)
    env.reset(seed=1)
    env.action_space.seed(1)
    lights = 0
    for _ in range(150):
        observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
        if np.any(env.unwrapped.picture().hits):
            lights += 1
            check_alike(observation, unprinted(env))
        if terminated or truncated:
            env.reset()
    assert lights > 5


def test_a_trail_is_drawn_by_the_renderer_itself():
    env = gym.make(PADDLE, obs="pixels", trail=0.5)
    grey = gym.make(PADDLE, obs="pixels", trail=0.5, grayscale=True)
    env.reset(seed=0)
    grey.reset(seed=0)
    for _ in range(30):
        observation, seen = env.step([0.0])[0], grey.step([0.0])[0]
    assert_same(observation, unprinted(env))
    assert_same(seen[:, :, 0], np.rint(observation @ np.array([0.299, 0.587, 0.114])).astype(np.uint8))


@pytest.mark.parametrize(("env_id", "options"), [*((env_id, {}) for env_id in IDS), (PADDLE, {"num_levels": 20})])
@pytest.mark.parametrize("mode", MODES)
def test_a_batch_sees_what_single_environments_see(env_id, options, mode):
    """Frames, final frames of episodes that are over, infos and ends: all as Gymnasium's own vector env has them."""
    kwargs = {**PIXELS, "time_limit": 1.5, "trail": 0.2, **options}
    ours, theirs = make_vec(3, mode, env_id, **kwargs), make_sync(3, mode, env_id, **kwargs)
    assert_same(ours.reset(seed=7), theirs.reset(seed=7))
    assert ours.observation_space == theirs.observation_space
    ends = 0
    for actions in scripted(ours.action_space, 100):
        result = ours.step(actions)
        assert_same(result, theirs.step(actions))
        over = result[2] | result[3]
        ends += int(over.sum())
        if mode == "DISABLED" and over.any():
            options = {"reset_mask": over}
            assert_same(ours.reset(options=options), theirs.reset(options=dict(options)))
    assert ends > 3


def test_a_frame_shows_the_level_that_is_played(monkeypatch):
    monkeypatch.setattr(observed_frames, "_MOST_SCENERIES", 2)
    env = gym.make(PADDLE, num_levels=20, **PIXELS, disable_env_checker=True).unwrapped
    levels = set()
    for seed in range(8):
        observation, info = env.reset(seed=seed)
        check_alike(observation, unprinted(env))
        levels.add(info["level"])
    assert len(levels) > 4


def test_the_final_frame_is_of_the_end_and_the_observation_of_the_next_start():
    envs = make_vec(2, "SAME_STEP", **PIXELS)
    single = gym.make(PADDLE, **PIXELS)
    envs.reset(seed=1), single.reset(seed=1)
    ended = np.zeros(2, bool)
    while not ended[0]:
        observations, _, terminated, truncated, info = envs.step(np.zeros((2, 1)))
        last, *_ = single.step([0.0])
        ended = terminated | truncated
    assert_same(info["final_obs"][0], last)
    assert_same(observations[0], single.reset()[0])
    assert not np.array_equal(observations[0], last)


def test_sb3_gets_the_last_frame_of_an_episode():
    pixels = BounceVecEnv(PADDLE, 3, seed=2, **PIXELS)
    states = BounceVecEnv(PADDLE, 3, seed=2)
    single = [gym.make(PADDLE, **PIXELS) for _ in range(3)]
    seen, _ = pixels.reset(), states.reset()
    assert seen.dtype == np.uint8
    last = [env.reset(seed=2 + i)[0] for i, env in enumerate(single)]
    assert_same(seen, np.stack(last))
    ends = 0
    for actions in scripted_for(pixels, 120):
        seen, rewards, dones, infos = pixels.step(actions)
        _, expected, ended, known = states.step(actions)
        assert_same((rewards, dones), (expected, ended))
        for w, env in enumerate(single):
            last[w], *_ = env.step(actions[w])
            if dones[w]:
                assert_same(infos[w].pop("terminal_observation"), last[w])
                known[w].pop("terminal_observation")
                last[w], _ = env.reset()
                ends += 1
            assert_same(infos[w], known[w])
        assert_same(seen, np.stack(last))
    assert ends > 3


def test_a_convolutional_policy_takes_it():
    envs = BounceVecEnv(PINBALL, 2, obs="pixels", seed=0)
    model = PPO("CnnPolicy", envs, n_steps=4, batch_size=8, n_epochs=1, seed=0, device="cpu")
    model.learn(8)
    assert model.num_timesteps == 8


@pytest.mark.parametrize("make", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_copies_go_on_and_see_the_same(make):
    env = gym.make(PADDLE, **PIXELS, trail=0.3, disable_env_checker=True).unwrapped
    env.reset(seed=0)
    for _ in range(10):
        env.step([0.5])
    other = make(env)
    for _ in range(10):
        assert_same(other.step([0.5]), env.step([0.5]))
    other.reset()
    assert not np.array_equal(other._frames.observations, env._frames.observations)


def test_a_restored_state_is_seen_without_the_trail_of_another():
    env = gym.make(PADDLE, **PIXELS, trail=0.3, disable_env_checker=True).unwrapped
    plain = gym.make(PADDLE, **PIXELS, disable_env_checker=True).unwrapped
    env.reset(seed=0), plain.reset(seed=0)
    for _ in range(10):
        env.step([0.5]), plain.step([0.5])
    state = env.clone_state()
    for _ in range(5):
        env.step([0.5])
    assert_same(env.restore_state(state), unprinted(plain))
    env.step([0.5])
    later = env.clone_state()
    env.restore_state(state)
    restored = env.restore_state(later)  # one step later than what was seen last: still no step of this play
    assert len(np.unique(env.picture().trail[:, :2], axis=0)) == 1
    plain.step([0.5])
    assert_same(restored, unprinted(plain))
    plain.restore_state(state)
    envs = make_vec(2, **PIXELS, trail=0.3)
    envs.reset(seed=4)
    envs.step(np.zeros((2, 1)))
    mask = np.array([False, True])
    before = envs.step(np.zeros((2, 1)))[0]
    restored = envs.restore_state(state, mask)
    assert_same(restored[0], before[0])
    assert_same(restored[1], unprinted(plain))


def test_only_worlds_that_have_begun_are_drawn():
    envs = make_vec(3, **PIXELS)
    mask = np.array([False, True, False])
    observations, _ = envs.reset(seed=0, options={"reset_mask": mask})
    assert [bool(frame.any()) for frame in observations] == mask.tolist()


def test_observations_are_the_callers_own_unless_asked():
    envs, shared = make_vec(2, **PIXELS), make_vec(2, **PIXELS, copy=False)
    first, _ = envs.reset(seed=0)
    same, _ = shared.reset(seed=0)
    kept = first.copy()
    envs.step(np.ones((2, 1))), shared.step(np.ones((2, 1)))
    assert_same(first, kept)
    assert not np.array_equal(same, kept)
