"""The card of Bounce/Paddle-v0, number by number: launch, observation, reward, info, ends."""

import math
from collections import Counter
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

from bounce_env import Bumper, load_scene
from bounce_env.games.paddle.setup import TOUCHES
from tests.conftest import soak_count
from tests.env.rollouts import KINDS, PADDLE, assert_same, make_vec, name, scripted

WIDTH, BOTTOM, TOP = 1.0, -0.03, 1.4  # [m] the walls, the drain
LEFT_STOP, RIGHT_STOP = 0.12, 0.88  # [m] of the paddle's centre
EACH_STEP = {"score": float, "ball": int}
AT_THE_END = {
    "end_reason": str,
    "points_bumpers": float,
    "bounces": int,
    "touches": int,
    "speed_capped": int,
    "game_seconds": float,
}


def follow(observations):
    """Stay under the ball: long episodes with many bounces."""
    paddle = (LEFT_STOP + RIGHT_STOP) / 2 + observations[:, 4] * (RIGHT_STOP - LEFT_STOP) / 2
    return np.clip(((observations[:, 0] + 1) / 2 - paddle) / 0.05, -1.0, 1.0)


def expected_observation(env):
    """The card's formulas, in float64, from the state in metres."""
    ((x, y, vx, vy),), (*_, (left, _, right, _)) = env.unwrapped._batch.view(0)
    paddle = (left + right) / 2
    place = (paddle - LEFT_STOP) / (RIGHT_STOP - LEFT_STOP)
    return np.array([2 * x / WIDTH - 1, 2 * (y - BOTTOM) / (TOP - BOTTOM) - 1, vx / 2, vy / 2, 2 * place - 1])


@pytest.mark.parametrize("frame_skip", [1, 2, 7])
@pytest.mark.parametrize("kwargs", KINDS, ids=name)
def test_observations_never_leave_their_space(kwargs, frame_skip):
    envs = make_vec(128, "SAME_STEP", frame_skip=frame_skip, time_limit=20.0, **kwargs)
    space = envs.single_observation_space
    low, high = np.full(space.shape, np.inf), np.full(space.shape, -np.inf)
    observations, _ = envs.reset(seed=0)
    reasons = Counter()
    for random in scripted(envs.action_space, soak_count(3000, 100000) // frame_skip):
        chase = follow(observations[:100])
        actions = random.reshape(128).copy()  # some play at random
        actions[:100] = chase if kwargs["action"] == "continuous" else 1 + np.sign(chase)
        observations, _, terminated, truncated, info = envs.step(actions)
        ended = terminated | truncated
        seen = np.vstack([observations, *info["final_obs"][ended]]) if ended.any() else observations
        low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
        if ended.any():
            reasons.update(info["final_info"]["end_reason"][ended])
    assert reasons.keys() == {"drained", "time_limit"}  # and never "budget"
    assert (low >= space.low).all()
    assert (high <= space.high).all()
    # The bounds are those of the physics, not a mile away: the play comes near all of them.
    assert (high[[0, 1, 4]] > 0.95).all()
    assert (low[[0, 1, 4]] < -0.95).all()
    assert (np.abs([low[2:4], high[2:4]]) > 0.7 * space.high[2]).all()


def test_bounds_on_speed_are_the_fall_from_the_top_at_the_cap():
    space = gym.make(PADDLE).observation_space
    bound = math.sqrt(3.0**2 + 2 * 1.5 * (TOP - BOTTOM)) / 2
    np.testing.assert_allclose(space.high, [1, 1, bound, bound, 1], rtol=1e-7)
    np.testing.assert_array_equal(space.low, -space.high)


def test_a_ball_shot_down_from_the_top_at_the_cap_stays_in_bounds():
    env = gym.make(PADDLE)
    env.reset(seed=0, options={"position": (0.05, 1.38), "velocity": (0.0, -3.0)})
    env.step([1.0])
    ended = False
    while not ended:
        observation, _, ended, _, _ = env.step([1.0])
        assert observation in env.observation_space
    assert observation[3] < -0.98 * env.observation_space.high[3]


def potential(observation):
    """-(distance along the rail from the paddle's middle to the ball) / (diagonal of the field)."""
    ball = WIDTH * (observation[0] + 1) / 2
    paddle = (LEFT_STOP + RIGHT_STOP) / 2 + observation[4] * (RIGHT_STOP - LEFT_STOP) / 2
    return -abs(ball - paddle) / math.hypot(WIDTH, TOP - BOTTOM)


@pytest.mark.parametrize("gamma", [0.9, 0.99, 1.0])
def test_the_dense_reward_is_the_score_with_shaping_that_telescopes(gamma):
    plain, dense = gym.make(PADDLE), gym.make(PADDLE, reward="dense", gamma=gamma)
    plain.reset(seed=1)
    observation, _ = dense.reset(seed=1)
    first, bumpers, difference, discount, ended = potential(observation), 0.0, 0.0, 1.0, False
    while not ended:
        before, action = potential(observation), 0.2 * follow(observation[None])  # too slow for the eighth
        again, points, *_ = plain.step(action)
        observation, reward, ended, _, info = dense.step(action)
        assert_same(observation, again)
        after = 0.0 if ended else potential(observation)
        assert reward - points == pytest.approx(gamma * after - before, abs=1e-6)
        bumpers, difference, discount = bumpers + points, difference + discount * (reward - points), discount * gamma
    assert info["score"] == info["points_bumpers"] == bumpers > 0.0
    assert difference == pytest.approx(-first, abs=1e-5)


def test_where_time_is_up_the_potential_stays():
    env = gym.make(PADDLE, reward="dense", gamma=0.9, time_limit=0.2)
    first, _ = env.reset(seed=3)
    difference = 0.0
    for k in range(6):
        observation, reward, terminated, truncated, _ = env.step([1.0])
        difference += 0.9**k * reward
    assert (terminated, truncated) == (False, True)
    assert difference == pytest.approx(0.9**6 * potential(observation) - potential(first), abs=1e-6)


@pytest.mark.parametrize("kwargs", KINDS, ids=name)
def test_observations_are_the_cards_formulas_of_the_state(kwargs):
    env = gym.make(PADDLE, **kwargs)
    env.action_space.seed(1)
    episodes = 0
    observation, _ = env.reset(seed=1)
    for _ in range(600):
        expected = expected_observation(env)
        rounding = np.maximum(np.spacing(np.abs(expected).astype(np.float32)), 1e-15)
        assert (np.abs(observation[:5] - expected) <= rounding).all()
        assert observation.dtype == np.float32
        observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
        if terminated or truncated:
            episodes += 1
            observation, _ = env.reset()
    assert episodes > 5


def test_a_drained_ball_is_seen_at_the_drain():
    env = gym.make(PADDLE)
    env.reset(seed=0, options={"position": (0.05, 0.02), "velocity": (0.0, -1.0)})
    ended = False
    while not ended:
        observation, _, ended, _, _ = env.step([0.0])
    assert observation[1] == -1.0
    assert observation[0] == np.float32(-0.9)


def test_launches_are_as_the_card_says():
    observations, _ = make_vec(4000).reset(seed=0)
    x, y, vx, vy, paddle = observations.astype(float).T
    np.testing.assert_allclose(y, 2 * 0.4 - 1, atol=1e-7)
    np.testing.assert_allclose(2 * np.hypot(vx, vy), 1.5, rtol=1e-6)
    assert set(paddle) == {0.0}
    angle = np.degrees(np.arctan2(vy, vx))
    for values, low, high in ((x, -0.6, 0.6), (angle, 30.0, 150.0)):
        share = np.sort((values - low) / (high - low))
        assert share[0] >= -1e-6
        assert share[-1] <= 1 + 1e-6
        # Kolmogorov-Smirnov against the uniform distribution, at a level of about 1e-4
        assert np.abs(share - (np.arange(4000) + 0.5) / 4000).max() < 2.2 / math.sqrt(4000)
    assert abs(np.corrcoef(x, angle)[0, 1]) < 4 / math.sqrt(4000)


@pytest.mark.parametrize("frame_skip", [1, 2, 5])
def test_the_paddle_moves_at_its_speed_and_stops_at_its_stops(frame_skip):
    env = gym.make(PADDLE, frame_skip=frame_skip)
    observation, _ = env.reset(seed=0)
    step = 2 * 1.5 * (frame_skip / 60) / (RIGHT_STOP - LEFT_STOP)
    expected = 0.0
    for action in [0.5] * 3 + [1.0] * 8 + [-1.0] * 12:
        observation, *_ = env.step([action])
        expected = min(max(expected + action * step, -1.0), 1.0)
        assert observation[4] == pytest.approx(expected, abs=1e-6)
        if env.unwrapped._running is False:
            break


def test_sticky_actions_are_observed():
    """What the paddle does now decides what it may go on doing: it is part of the state, and seen."""
    env = gym.make(PADDLE, repeat_action_probability=0.25)
    observation, _ = env.reset(seed=0)
    assert observation[5] == 0.0
    applied = set()
    for t in range(40):
        action = np.float32((-1) ** t * (0.25 + t / 80))
        before, (observation, _, terminated, *_) = observation, env.step([action])
        assert observation[5] in (action, before[5])
        applied.add(bool(observation[5] == action))
        moved = observation[4] - before[4]
        if abs(observation[4]) < 1 and observation[5] == before[5]:
            assert moved == pytest.approx(2 * 1.5 / 30 / 0.76 * before[5], abs=1e-6)
        if terminated:
            break
    assert applied == {True, False}


def test_a_hit_of_a_bumper_is_worth_one_point_and_nothing_else_is():
    env = gym.make(PADDLE)
    env.reset(seed=0, options={"position": (0.5, 0.6), "velocity": (0.0, 1.5)})
    rewards = [env.step([0.0])[1] for _ in range(4)]
    assert rewards == [0.0, 0.0, 1.0, 0.0]  # 0.12 m to the lowest bumper's surface: 0.084 s
    env.reset(seed=0, options={"position": (0.5, 0.2), "velocity": (0.0, -1.0)})
    rewards, info = [], {}
    for _ in range(4):
        _, reward, _, _, info = env.step([0.0])
        rewards.append(reward)
    assert rewards == [0.0] * 4
    assert env.unwrapped._batch.counters[0, TOUCHES] == 1
    assert info["score"] == 0.0


@pytest.mark.parametrize("kwargs", KINDS, ids=name)
def test_single_infos_are_plain_and_as_on_the_card(kwargs):
    env = gym.make(PADDLE, time_limit=1.5, **kwargs)
    each_step = EACH_STEP | ({"level": int} if "num_levels" in kwargs else {})
    env.action_space.seed(0)
    reasons = []
    for k in range(12):
        _, info = env.reset(seed=k)
        assert {key: type(value) for key, value in info.items()} == each_step
        total, ended, steps = 0.0, False, 0
        while not ended:
            _, reward, terminated, truncated, info = env.step(env.action_space.sample())
            total, steps, ended = total + reward, steps + 1, terminated or truncated
            assert [type(v) for v in (reward, terminated, truncated)] == [float, bool, bool]
            kinds = each_step | AT_THE_END if ended else each_step
            assert {key: type(value) for key, value in info.items()} == kinds
            score = info["score"] if kwargs.get("reward") == "dense" else total
            assert (info["score"], info["ball"]) == (score, 0)
        assert info["end_reason"] == ("drained" if terminated else "time_limit")
        assert terminated != truncated
        assert info["points_bumpers"] == info["score"]
        assert info["game_seconds"] == pytest.approx(steps / 30, abs=1 / 30 + 1e-9)
        assert info["bounces"] >= info["points_bumpers"] + info["touches"]
        reasons.append(info["end_reason"])
    assert set(reasons) == {"drained", "time_limit"}


def test_vector_infos_are_arrays_with_masks():
    envs = make_vec(16, "DISABLED", time_limit=1.5)
    _, info = envs.reset(seed=0)
    ended = np.zeros(16, bool)
    assert info.keys() == {f"{mask}{key}" for key in EACH_STEP for mask in ("", "_")}
    while not ended.any():
        assert info.keys() == {f"{mask}{key}" for key in EACH_STEP for mask in ("", "_")}
        _, _, terminated, truncated, info = envs.step(np.zeros(16))
        ended = terminated | truncated
    assert info.keys() == {f"{mask}{key}" for key in EACH_STEP | AT_THE_END for mask in ("", "_")}
    for key, kind in (EACH_STEP | AT_THE_END).items():
        assert info[key].shape == info[f"_{key}"].shape == (16,)
        assert info[key].dtype == np.array([kind()]).dtype if kind is not str else object
        assert_same(info[f"_{key}"], ended if key in AT_THE_END else np.ones(16, bool))


def play_on(env, actions):
    return [env.step([action]) for action in actions]


@pytest.mark.parametrize("kwargs", [{}, {"repeat_action_probability": 0.25}])
def test_equal_observation_and_actions_give_equal_futures_whatever_went_before(kwargs):
    """The state that matters is observed: what was played, bounced and scored before leaves no trace.

    Sticky actions are dice of the episode's own: there, both histories end in an episode of the same seed.
    """
    place = {"position": (0.3, 0.5), "velocity": (0.4, 1.2)}
    fresh, used = gym.make(PADDLE, **kwargs), gym.make(PADDLE, **kwargs)
    for history in range(10):
        if not kwargs:
            used.reset(seed=100 + history)
            play_on(used, [(-1) ** history] * (3 + history))
        else:  # an episode of the same seed, after another play
            fresh.reset(seed=history), used.reset(seed=history)
            play_on(used, [1.0] * (3 + history))
        seed = None if kwargs else 200 + history
        first, _ = fresh.reset(seed=seed, options=place)
        second, _ = used.reset(options=place)
        assert_same(second, first)
        actions = scripted(gym.spaces.Box(-1, 1, ()), 20, seed=history)
        for one, other in zip(play_on(fresh, actions), play_on(used, actions), strict=True):
            assert_same(other[:4], one[:4])
            if one[2]:
                break


def test_the_time_already_played_is_no_hidden_state():
    """A ball put where another is in mid-flight, as fast: the same future, though one episode is 10 steps older."""
    older, newer = gym.make(PADDLE), gym.make(PADDLE)
    compared = rewarded = 0
    for seed in range(20):
        older.reset(seed=seed)
        play_on(older, [0.0] * 10)
        ((x, y, vx, vy),), _ = older.unwrapped._batch.view(0)
        now = older.unwrapped._batch.results.observations[0].copy()
        if older.unwrapped._batch.state.worlds[0].bounces > 0:
            continue  # its last bits are not in the four numbers any more
        placed, _ = newer.reset(seed=999, options={"position": (x, y), "velocity": (vx, vy)})
        assert_same(placed, now)
        bounces = 0
        for action in scripted(gym.spaces.Box(-1, 1, ()), 30, seed=seed):
            one, other = older.step([action]), newer.step([action])
            bounces = older.unwrapped._batch.state.worlds[0].bounces
            if one[2] or bounces > 3:
                break  # round-off grows with each bounce
            np.testing.assert_allclose(other[0], one[0], atol=1e-6)
            assert other[1:4] == one[1:4]
            compared, rewarded = compared + 1, rewarded + one[1]
    assert compared > 100
    assert rewarded > 3


def test_a_moving_bumper_that_comes_first_is_not_the_paddle():
    scene = load_scene("paddle")
    drifting = Bumper((0.2, 0.9), 0.05, rail_end=(0.8, 0.9), speed=0.3, b=1.5)
    elements = tuple(e for e in scene.elements if not isinstance(e, Bumper))
    played = [
        gym.make(PADDLE, scene=replace(scene, elements=e)) for e in ((drifting, *elements), (*elements, drifting))
    ]
    for env in played:
        env.reset(seed=0)
    for _ in range(60):
        first, last = (env.step([0.5])[0] for env in played)
        assert_same(first, last)
    assert first[4] > 0.5
