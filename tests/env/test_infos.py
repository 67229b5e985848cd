"""The keyword `info` of vector environments: how much they say, and that they do the same whatever they say."""

import gymnasium as gym
import numpy as np
import pytest

from bounce_env.registration import ENTRIES
from bounce_env.sb3 import BounceVecEnv
from tests.env.rollouts import MODES, assert_same

IDS = [entry.id for entry in ENTRIES]
TOLD_AT_ENDS = {"end_reason", "bounces", "speed_capped", "game_seconds"}


def vector(env_id, mode, info):
    return gym.make_vec(
        env_id, num_envs=8, vectorization_mode="vector_entry_point", autoreset_mode=mode, time_limit=2.0, info=info
    )


def steps(envs, count=200):
    envs.action_space.seed(1)
    for _ in range(count):
        result = envs.step(envs.action_space.sample())
        yield result
        over = result[2] | result[3]
        if envs.unwrapped.autoreset_mode.name == "DISABLED" and over.any():
            envs.reset(options={"reset_mask": over})


@pytest.mark.parametrize("env_id", IDS)
@pytest.mark.parametrize("mode", MODES)
def test_less_is_said_of_the_same_play(env_id, mode):
    said = {info: vector(env_id, mode, info) for info in ("all", "ends", "none")}
    first = {info: envs.reset(seed=2) for info, envs in said.items()}
    assert set(first["all"][1]) >= {"score", "_score", "ball", "_ball"}
    assert first["ends"][1] == first["none"][1] == {}
    ends = 0
    for of_all, of_ends, of_none in zip(*map(steps, said.values()), strict=True):
        assert_same(of_ends[:4], of_all[:4])
        assert_same(of_none[:4], of_all[:4])
        over = of_all[2] | of_all[3]
        ends += int(over.sum())
        in_every_step = {"score", "_score", "ball", "_ball"}
        at_ends = in_every_step if over.any() and mode != "SAME_STEP" else set()  # in that mode they are in final_info
        assert set(of_ends[4]) == set(of_all[4]) - in_every_step | at_ends
        assert_same(*({key: said[4][key] for key in set(of_ends[4]) - at_ends} for said in (of_ends, of_all)))
        for key in at_ends - {"_score", "_ball"}:
            np.testing.assert_array_equal(of_ends[4][f"_{key}"], over)
            np.testing.assert_array_equal(of_ends[4][key], np.where(over, of_all[4][key], 0))
        kept = {"final_obs", "_final_obs"} if over.any() and mode == "SAME_STEP" else set()
        assert set(of_none[4]) == kept
        assert_same(of_none[4], {key: of_all[4][key] for key in kept})
        if over.any() and mode == "SAME_STEP":
            assert {*TOLD_AT_ENDS, "score", "ball"} <= set(of_ends[4]["final_info"])
        elif over.any():
            assert set(of_ends[4]) >= TOLD_AT_ENDS
    assert ends > 8


def test_what_a_step_says_is_not_overwritten_by_the_next_one():
    envs = vector(IDS[0], "NEXT_STEP", "all")
    envs.reset(seed=0)
    said = [({key: np.array(values, copy=True) for key, values in step[4].items()}, step[4]) for step in steps(envs)]
    for copies, kept in said:
        assert_same(kept, copies)


@pytest.mark.parametrize("info", ["ends", "none"])
def test_sb3_learns_from_ends_whatever_is_said(info):
    silent, loud = (BounceVecEnv(IDS[0], 8, info=said, time_limit=2.0) for said in (info, "all"))
    silent.seed(3), loud.seed(3)
    assert_same(silent.reset(), loud.reset())
    ends = 0
    for _ in range(200):
        action = np.array([loud.action_space.sample() for _ in range(8)])
        less, more = silent.step(action), loud.step(action)
        assert_same(less[:3], more[:3])
        for w in np.flatnonzero(more[2]):
            ends += 1
            for key in ("terminal_observation", "TimeLimit.truncated", "episode"):
                assert_same(less[3][w][key], more[3][w][key])
        assert all("score" not in row for row, over in zip(less[3], more[2], strict=True) if not over)
    assert ends > 8
