"""How the trainers of docs/clients.md use an environment, without the trainers: `make clients` runs those."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec, VectorizeMode
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers.vector import DictInfoToList

PADDLE = "bounce_env:Bounce/Paddle-v0"
WORLDS = 16


def made(mode, **keywords):
    return gym.make_vec(
        PADDLE, num_envs=WORLDS, vectorization_mode=VectorizeMode("vector_entry_point"), autoreset_mode=mode, **keywords
    )


def until_an_end(envs):
    """Step at random until some episodes end; return that step."""
    envs.action_space.seed(0)
    for _ in range(400):
        step = envs.step(envs.action_space.sample())
        if (step[2] | step[3]).any():
            return step
    raise AssertionError("no episode has ended")


def test_torchrl_finds_the_mode_and_the_last_observations():
    envs = made("SAME_STEP", info="none")
    assert envs.autoreset_mode is AutoresetMode.SAME_STEP
    envs.reset(seed=0)
    observations, _, terminated, truncated, info = until_an_end(envs)
    over = terminated | truncated
    np.testing.assert_array_equal(info["_final_obs"], over)
    for w in np.flatnonzero(over):
        assert info["final_obs"][w].shape == observations[w].shape
        assert info["final_obs"][w][1] < -0.9  # the ball was at the drain
        assert observations[w][1] > -0.9


def test_tianshou_resets_some_worlds_and_leaves_the_others_alone():
    envs = made("DISABLED", info="none")
    envs.reset(seed=0)
    observations, _, terminated, truncated, info = until_an_end(envs)
    over = terminated | truncated
    assert info == {}
    again, _ = envs.reset(options={"reset_mask": over})
    np.testing.assert_array_equal(again[~over], observations[~over])
    assert (again[over][:, 1] > -0.9).all()
    envs.step(envs.action_space.sample())


def test_pufferlib_takes_observations_that_are_written_in_place():
    envs = made("SAME_STEP", info="none", copy=False)
    first, _ = envs.reset(seed=0)
    second = envs.step(envs.action_space.sample())[0]
    assert np.shares_memory(first, second)


def test_rllib_makes_it_by_its_module_and_turns_infos_into_lists():
    envs = DictInfoToList(made("NEXT_STEP", info="none"))
    _, infos = envs.reset(seed=0)
    assert infos == [{}] * WORLDS
    *_, terminated, truncated, infos = until_an_end(envs)
    assert infos == [{}] * WORLDS
    _, rewards, *ended, _ = envs.step(envs.action_space.sample())
    over = terminated | truncated
    assert not rewards[over].any()
    assert not np.any([each[over] for each in ended])


@pytest.mark.parametrize("game", ["Pinball", "Paddle", "Walls"])
def test_minari_makes_the_environment_anew_from_its_spec(game):
    env = gym.make(f"bounce_env:Bounce/{game}-v0", time_limit=3.0)
    again = gym.make(EnvSpec.from_json(env.spec.to_json()))
    env.action_space.seed(0)
    np.testing.assert_array_equal(env.reset(seed=5)[0], again.reset(seed=5)[0])
    for _ in range(60):
        action = env.action_space.sample()
        mine, theirs = env.step(action), again.step(action)
        np.testing.assert_array_equal(mine[0], theirs[0])
        assert mine[1:4] == theirs[1:4]
        if mine[2] or mine[3]:
            break
