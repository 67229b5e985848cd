"""A world of a batch plays what a single env plays, to the bit, whatever the mode, the threads and the actions."""

import copy

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

from bounce_env.games.kernels import reset_worlds, step_worlds
from bounce_env.registration import ENTRIES
from tests.conftest import soak_count
from tests.env.rollouts import MODES, PADDLE, PINBALL, VARIANTS, WALLS, assert_same, make_sync, make_vec, name, scripted

WORLDS = 5
SEED = 40
SHORT = 1.5  # seconds: some episodes end here, some at the drain
PLAYED = {  # for the same reason
    PADDLE: {"time_limit": SHORT},
    PINBALL: {"time_limit": 9.0, "balls": 1},
    WALLS: {"time_limit": 3.5, "balls": 2},
}


def reset_where(envs, ended):
    """What a caller of mode DISABLED does after each step; None where there is nothing to reset."""
    return envs.reset(options={"reset_mask": ended.copy()}) if ended.any() else None


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(("env_id", "kwargs"), VARIANTS, ids=name)
def test_equals_gymnasiums_vector_env_over_single_envs(env_id, kwargs, mode):
    kwargs = {**PLAYED[env_id], **kwargs}
    theirs = make_sync(WORLDS, mode, env_id, **kwargs)
    ours = [make_vec(WORLDS, mode, env_id, num_threads=n, **kwargs) for n in (1, 2, 3)]
    reset = theirs.reset(seed=SEED)
    for envs in ours:
        assert_same(envs.reset(seed=SEED), reset, "reset")
    ends = dict.fromkeys(("all_played" if env_id == WALLS else "drained", "time_limit"), 0)
    for t, actions in enumerate(scripted(theirs.action_space, soak_count(300 if env_id == PADDLE else 1500, 20000))):
        step = theirs.step(actions)
        ended = step[2] | step[3]
        again = reset_where(theirs, ended) if mode == "DISABLED" else None
        for envs in ours:
            assert_same(envs.step(actions), step, f"step {t}")
            if mode == "DISABLED":
                assert_same(reset_where(envs, ended), again, f"reset after step {t}")
        told = step[4].get("final_info", step[4])
        for world in np.flatnonzero(ended):
            ends[told["end_reason"][world]] += 1
    assert min(ends.values()) > 5


def test_one_kernel_serves_every_variant_of_a_game():
    for env_id, kwargs in VARIANTS:
        envs = make_vec(2, "SAME_STEP", env_id, num_threads=2, frame_skip=1, time_limit=None, **kwargs)
        envs.reset(seed=0)
        envs.step(envs.action_space.sample())
    assert len(step_worlds.signatures) <= len(ENTRIES)
    assert len(reset_worlds.signatures) <= len(ENTRIES)


def episode_actions(space, world, episode):
    """A script of its own for each episode: the same in every mode, though modes step at different times."""
    return scripted(space, 200, seed=1000 * world + episode)


def episodes_of_a_single_env(seed, world, count, **kwargs):
    env = gym.make(PADDLE, **kwargs)
    episodes = []
    for k in range(count):
        observation, _ = env.reset(seed=seed if k == 0 else None)
        seen, ended = [observation], False
        actions = iter(episode_actions(env.action_space, world, k))
        while not ended:
            observation, reward, terminated, truncated, info = env.step(next(actions))
            seen.append((observation, reward))
            ended = terminated or truncated
        episodes.append((seen, info))
    return episodes


def episodes_of_a_batch(seed, count, mode, **kwargs):
    """The first `count` episodes of each world, in the form of `episodes_of_a_single_env`."""
    envs = make_vec(WORLDS, mode, num_threads=2, **kwargs)
    space = envs.single_action_space
    observations, _ = envs.reset(seed=seed)
    seen = [[observations[w]] for w in range(WORLDS)]
    scripts = [iter(episode_actions(space, w, 0)) for w in range(WORLDS)]
    episodes, ended = [[] for _ in range(WORLDS)], np.zeros(WORLDS, bool)
    while min(len(e) for e in episodes) < count:
        idle = ended if mode == "NEXT_STEP" else np.zeros(WORLDS, bool)  # this step only resets them
        actions = np.array([np.zeros(space.shape, space.dtype) if idle[w] else next(scripts[w]) for w in range(WORLDS)])
        observations, rewards, terminated, truncated, info = envs.step(actions)
        ended = terminated | truncated
        final = info["final_obs"] if mode == "SAME_STEP" and ended.any() else observations
        told = info.get("final_info", info)
        for w in range(WORLDS):
            if idle[w]:
                seen[w] = [observations[w]]
                continue
            seen[w].append((final[w] if ended[w] else observations[w], float(rewards[w])))
            if ended[w]:
                row = {key: value[w] for key, value in told.items() if key[0] != "_" and told[f"_{key}"][w]}
                episodes[w].append((seen[w], row))
                scripts[w] = iter(episode_actions(space, w, len(episodes[w])))
                seen[w] = [observations[w]]
        if mode == "DISABLED" and ended.any():
            observations, _ = envs.reset(options={"reset_mask": ended})
            for w in np.flatnonzero(ended):
                seen[w] = [observations[w]]
    return [e[:count] for e in episodes]


@pytest.mark.parametrize("mode", MODES)
def test_episode_k_of_world_i_is_the_same_in_every_mode(mode):
    kwargs = {"repeat_action_probability": 0.25, "time_limit": SHORT}
    count = soak_count(6, 100)
    batch = episodes_of_a_batch(SEED, count, mode, **kwargs)
    for world in range(WORLDS):
        single = episodes_of_a_single_env(SEED + world, world, count, **kwargs)
        for k in range(count):
            assert_same(batch[world][k][0], single[k][0], f"world {world}, episode {k}")
            assert batch[world][k][1] == single[k][1]


def test_seeds_may_be_given_one_per_world():
    envs, one_by_one = make_vec(3), make_vec(3)
    observations, _ = envs.reset(seed=[9, 2, 30])
    for world, seed in enumerate((9, 2, 30)):
        single, _ = gym.make(PADDLE).reset(seed=seed)
        assert_same(observations[world], single)
    one_by_one.reset(seed=8)
    mask = np.array([False, True, True])
    again, _ = one_by_one.reset(seed=[None, 2, 30], options={"reset_mask": mask})
    assert_same(again[1:], observations[1:])


def test_a_world_without_a_seed_goes_on_with_its_stream():
    envs, seeded = make_vec(3), make_vec(3)
    envs.reset(seed=8), seeded.reset(seed=8)
    second, _ = envs.reset()
    mixed, _ = seeded.reset(seed=[None, 2, None])
    assert_same(mixed[[0, 2]], second[[0, 2]])
    assert not np.array_equal(mixed[1], second[1])


def test_unseeded_envs_differ():
    first = [env.reset()[0] for env in (gym.make(PADDLE), gym.make(PADDLE))]
    assert not np.array_equal(*first)
    observations, _ = make_vec(50).reset()
    assert len(np.unique(observations[:, 0])) == 50


def test_launches_follow_from_the_seed_alone_and_not_from_the_play():
    still, busy = gym.make(PADDLE), gym.make(PADDLE)
    busy.action_space.seed(0)
    launches = {id(still): [], id(busy): []}
    for k in range(20):
        for env, act in ((still, lambda: [0.0]), (busy, busy.action_space.sample)):
            launches[id(env)].append(env.reset(seed=6 if k == 0 else None)[0])
            for _ in range(3 + k):  # not to the end: the number of steps does not matter either
                env.step(act())
    assert_same(launches[id(busy)], launches[id(still)])
    assert len({launch.tobytes() for launch in launches[id(still)]}) == 20


def test_sticky_actions_follow_the_seed_and_leave_launches_alone():
    plain, sticky = make_vec(20), make_vec(20, repeat_action_probability=0.25)
    assert_same(sticky.reset(seed=1)[0][:, :5], plain.reset(seed=1)[0])
    left_and_right = [np.full((20, 1), speed, np.float32) for speed in (1, -1) * 3]
    paddles = []
    for _ in range(2):
        sticky.reset(seed=1)
        paddles.append([sticky.step(actions)[0][:, 4] for actions in left_and_right])
    assert_same(paddles[1], paddles[0])
    assert len(np.unique(paddles[0][-1])) > 3  # each world is held back by its own dice


def test_sticky_actions_repeat_with_the_given_probability_per_frame():
    """One frame a step, action 1 then -1 after a second: how often is the first -1 held back?"""
    envs = make_vec(4000, frame_skip=1, repeat_action_probability=0.25)
    envs.reset(seed=2)
    held = envs.step(np.ones((4000, 1), np.float32))[0][:, 5] == 0.0
    np.testing.assert_allclose(held.mean(), 0.25, atol=4 * np.sqrt(0.25 * 0.75 / 4000))
    for _ in range(4):
        before = envs.step(np.ones((4000, 1), np.float32))[0][:, 5]
    after = envs.step(-np.ones((4000, 1), np.float32))[0][:, 5]
    assert set(np.unique(after)) <= {-1.0, 0.0, 1.0}
    np.testing.assert_allclose((after == before).mean(), 0.25, atol=4 * np.sqrt(0.25 * 0.75 / 4000))


@pytest.mark.parametrize("mode", MODES)
def test_copy_decides_whether_observations_are_the_batchs_own(mode):
    fast, safe = make_vec(3, mode, copy=False), make_vec(3, mode)
    first, _ = fast.reset(seed=0)
    kept, _ = safe.reset(seed=0)
    unchanged = kept.copy()
    assert_same(first, kept)
    for actions in scripted(fast.action_space, 20):
        quick, careful = fast.step(actions), safe.step(actions)
        assert quick[0] is first
        assert_same(quick, careful)
        assert not any(np.shares_memory(careful[0], old) for old in (kept, first))
    assert_same(kept, unchanged)
    assert fast.reset()[0] is first


def test_what_a_step_returned_stays_as_it_was():
    envs = make_vec(8, "SAME_STEP", time_limit=SHORT)
    envs.reset(seed=0)
    kept, before = [], []
    for actions in scripted(envs.action_space, 150):
        kept.append(envs.step(actions))
        before.append(copy.deepcopy(kept[-1]))
    assert_same(kept, before)
    assert all(any(step[part].any() for step in kept) for part in (1, 2, 3))
    assert any("final_obs" in step[4] for step in kept)


def test_disabled_raises_until_the_finished_worlds_are_reset():
    envs = make_vec(3, "DISABLED", time_limit=0.1)
    envs.reset(seed=0, options={"position": [(0.5, 0.5), (0.05, 0.02), (0.5, 0.5)], "velocity": (0.0, -1.0)})
    ended = np.zeros(3, bool)
    while not ended.any():
        _, _, terminated, truncated, _ = envs.step(np.zeros(3))
        ended = terminated | truncated
    assert ended.tolist() == [False, True, False]
    with pytest.raises(gym.error.ResetNeeded, match=r"worlds \[1\]"):
        envs.step(np.zeros(3))
    with pytest.raises(gym.error.ResetNeeded, match=r"worlds \[1\]"):
        envs.reset(options={"reset_mask": ~ended}), envs.step(np.zeros(3))
    envs.reset(options={"reset_mask": ended})
    envs.step(np.zeros(3))


@pytest.mark.parametrize("mode", MODES)
def test_reset_mask_leaves_other_worlds_alone(mode):
    envs, never_reset = make_vec(3, mode), make_vec(3, mode)
    envs.reset(seed=0), never_reset.reset(seed=0)
    for _ in range(3):
        envs.step(np.ones(3)), never_reset.step(np.ones(3))
    mask = np.array([False, True, False])
    mine = mask.copy()
    observations, info = envs.reset(options={"reset_mask": mask})
    info["_score"][:] = True  # a caller's mask is not ours to hand out
    assert_same(mask, mine)
    second = make_vec(3, mode)
    second.reset(seed=0)
    assert_same(observations[1], second.reset()[0][1])
    assert_same(envs.step(np.ones(3))[0][[0, 2]], never_reset.step(np.ones(3))[0][[0, 2]])


def test_options_place_the_ball_in_single_and_batch():
    position, velocity = [(0.3, 0.5), (0.5, 0.6), (0.7, 0.4)], [(0.0, 0.1), (0.5, -0.5), (-1.0, 1.0)]
    envs = make_vec(3)
    each, _ = envs.reset(seed=0, options={"position": position, "velocity": velocity})
    for world in range(3):
        env = gym.make(PADDLE)
        options = {"position": position[world], "velocity": velocity[world]}
        single, _ = env.reset(seed=world, options=options)
        assert_same(each[world], single)
        (x, y, vx, vy), *_ = env.unwrapped._batch.view(0)[0].tolist()
        assert ((x, y), (vx, vy)) == (position[world], velocity[world])
    for_all, _ = envs.reset(seed=0, options={"velocity": (0.5, -0.5)})
    np.testing.assert_array_equal(for_all[:, 2:4], [[0.25, -0.25]] * 3)
    by_seed, _ = envs.reset(seed=0)
    assert_same(for_all[:, :2], by_seed[:, :2])
    assert not np.array_equal(for_all[:, 2:4], by_seed[:, 2:4])


@pytest.mark.parametrize("mode", MODES)
def test_options_hold_for_one_episode_only(mode):
    placed, usual = make_vec(2, mode, time_limit=0.1), make_vec(2, mode, time_limit=0.1)
    placed.reset(seed=0, options={"position": (0.5, 0.5)}), usual.reset(seed=0)
    for _ in range(3 + (mode == "NEXT_STEP")):
        observations, *_ = placed.step(np.zeros(2))
        expected, *_ = usual.step(np.zeros(2))
    if mode == "DISABLED":
        observations, expected = placed.reset()[0], usual.reset()[0]
    assert_same(observations, expected)


@pytest.mark.parametrize("frame_skip", [1, 2, 4])
def test_time_limit_truncates_single_and_batch_after_so_many_seconds(frame_skip):
    steps = 24 // frame_skip
    env = gym.make(PADDLE, time_limit=0.4, frame_skip=frame_skip)
    env.reset(seed=0)
    flags = [env.step([0.0])[2:] for _ in range(steps)]
    assert [truncated for _, truncated, _ in flags] == [False] * (steps - 1) + [True]
    assert not any(terminated for terminated, _, _ in flags)
    assert flags[-1][2]["end_reason"] == "time_limit"
    assert flags[-1][2]["game_seconds"] == 0.4
    envs = make_vec(2, "SAME_STEP", time_limit=0.4, frame_skip=frame_skip)
    envs.reset(seed=0)
    truncated = [envs.step(np.zeros(2))[3].tolist() for _ in range(3 * steps)]
    assert truncated == ([[False] * 2] * (steps - 1) + [[True] * 2]) * 3


def test_without_a_time_limit_a_ball_that_is_kept_up_plays_on():
    envs = make_vec(256, time_limit=None)
    observations, _ = envs.reset(seed=0)
    longest = np.zeros(256)
    for _ in range(soak_count(4000, 20000)):
        chase = np.sign(2.0 * (observations[:, 0] / 0.76 - observations[:, 4])) * 0.8
        observations, _, _, truncated, _ = envs.step(chase)
        assert not truncated.any()
        longest = np.maximum(longest, envs._batch.episodes["frames"] / 60)
    assert longest.max() > 91


@pytest.mark.parametrize("mode", ["NEXT_STEP", "SAME_STEP"])
def test_a_users_step_limit_is_honoured(mode):
    env = gym.make(PADDLE, max_episode_steps=7)
    env.reset(seed=0)
    assert [env.step([0.0])[3] for _ in range(7)] == [False] * 6 + [True]
    envs = gym.make_vec(PADDLE, num_envs=2, max_episode_steps=7, autoreset_mode=mode)
    envs.reset(seed=0)
    period = 7 + (mode == "NEXT_STEP")  # there a step goes into the reset
    truncated = [envs.step(np.zeros(2))[3].all() for _ in range(3 * period)]
    assert np.flatnonzero(truncated).tolist() == [6, 6 + period, 6 + 2 * period]


@pytest.mark.parametrize(("steps", "limit", "frames"), [(7, 60.0, 14), (600, 0.2, 12), (-1, 0.2, 12), (None, 0.2, 12)])
def test_the_earlier_limit_of_steps_and_seconds_counts(steps, limit, frames):
    envs = gym.make_vec(PADDLE, max_episode_steps=steps, time_limit=limit, autoreset_mode=AutoresetMode.DISABLED)
    envs.reset(seed=0)
    count, truncated = 0, False
    while not truncated:
        _, _, _, (truncated,), info = envs.step([0.0])
        count += 2
    assert count == frames
    assert info["end_reason"][0] == "time_limit"


@pytest.mark.parametrize(("small", "large"), [(1, 2), (2, 4), (1, 6)])
def test_a_step_split_in_parts_gives_the_same_bits(small, large):
    """Play does not depend on the size of the step: only the instants of changed actions matter."""
    fine, coarse = make_vec(64, "SAME_STEP", frame_skip=small), make_vec(64, "SAME_STEP", frame_skip=large)
    assert_same(fine.reset(seed=0), coarse.reset(seed=0))
    playing = np.ones(64, bool)  # the first episode of each world is compared
    total = 0.0
    for actions in scripted(coarse.action_space, 150 // large):
        observations, rewards, drained, _, info = coarse.step(actions)
        last = np.where(drained, info["final_obs"], None) if drained.any() else None
        earned, over = np.zeros(64), np.zeros(64, bool)
        for _ in range(large // small):
            part_observations, reward, terminated, _, part_info = fine.step(actions)
            earned += np.where(over, 0.0, reward)
            over |= terminated
            for world in np.flatnonzero(playing & terminated):
                assert_same(part_info["final_obs"][world][:4], last[world][:4])  # the paddle moves on after the drain
                assert part_info["final_info"]["bounces"][world] == info["final_info"]["bounces"][world]
        assert_same(over[playing], drained[playing])
        assert_same(earned[playing], rewards[playing])
        playing &= ~drained
        assert_same(part_observations[playing], observations[playing])
        for part in ("balls", "motions"):  # in float64, too
            assert_same(getattr(fine._batch.state, part)[playing], getattr(coarse._batch.state, part)[playing], part)
        total += earned[playing].sum()
    assert total > 10
    assert 0 < playing.sum() < 54


def test_discrete_actions_are_full_speed_left_stay_and_right():
    continuous, discrete = make_vec(8), make_vec(8, action="discrete")
    assert_same(continuous.reset(seed=0), discrete.reset(seed=0))
    for actions in scripted(discrete.action_space, 200):
        assert_same(continuous.step(actions - 1.0), discrete.step(actions))


def test_continuous_actions_are_clipped_to_the_space():
    one, beyond = make_vec(8), make_vec(8)
    one.reset(seed=0), beyond.reset(seed=0)
    for actions in scripted(one.action_space, 50):
        assert_same(beyond.step(7.0 * np.sign(actions)), one.step(np.sign(actions)))
