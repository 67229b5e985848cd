"""The game of walls: targets, launches, rewards, the wall that is dragged, and how balls and episodes end."""

import math
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

from bounce_env import Ball, Scene, Sensor, Wall, load_scene
from bounce_env.render.projection import Projection
from bounce_env.sb3 import BounceVecEnv
from tests.env.rollouts import WALLS, assert_same, make_vec, scripted

# Where the observation has what.
BALL, VELOCITY, ENDS, TARGET = slice(0, 2), slice(2, 4), slice(4, 8), slice(8, 10)
TIME, BALLS = 10, 11
FIELD = load_scene("walls")
STILL, GRAVITY = np.zeros(4), 2.0
DIAGONAL = math.sqrt(2.0)


def metres(seen):
    """Places on the built-in field, [m], from what is observed of them."""
    return (np.asarray(seen, np.float64) + 1.0) / 2.0


def field(target=0.06, *more, **changes):
    """A field with nothing between its walls but the player's, low on the left, and `more`."""
    dragged = Wall((0.05, 0.1), (0.2, 0.1), b=0.9, draggable=True, min_length=0.1, reach=((0.0, 0.0), (1.0, 1.0)))
    outside = [Wall((0, -0.1), (0, 1)), Wall((1, -0.1), (1, 1)), Wall((0, 1), (1, 1))]
    sensors = [Sensor(center=(0.5, 0.5), radius=target, drain=True, name="target"), Sensor((-1, 0), (2, 0), drain=True)]
    elements = (*outside, dragged, *sensors, *more)
    rest = {"gravity": (0.0, -GRAVITY), "ball": Ball(radius=0.02), "max_speed": 3.0, "elements": elements}
    return Scene(**rest | changes)


# A ball that falls on the middle line always meets so large a target, wherever it is, and one beside a wall never.
EASY = field(0.3)
HIT, MISS = (0.5, 0.97), (0.03, 0.97)


def begun(scene=None, position=None, velocity=(0.0, 0.0), *, seed=0, **kwargs):
    env = gym.make(WALLS, scene=scene, **kwargs)
    options = {} if position is None else {"position": position, "velocity": velocity}
    return env, env.reset(seed=seed, options=options)[0]


def played(env, action=STILL):
    """An episode to its end: its rewards and the last info."""
    rewards = []
    for _ in range(5 * 8 * 30):
        _, reward, terminated, truncated, info = env.step(action)
        rewards.append(reward)
        if terminated or truncated:
            return rewards, info
    raise AssertionError("no ball is played for longer than 8 s")


def test_the_observation_is_what_the_card_says():
    env, observation = begun(position=(0.3, 0.9), velocity=(0.5, -1.0))
    assert env.observation_space.contains(observation)
    np.testing.assert_allclose(observation[BALL], [-0.4, 0.8], rtol=1e-6)
    np.testing.assert_allclose(observation[VELOCITY], [0.25, -0.5])
    np.testing.assert_allclose(metres(observation[ENDS]), [0.4, 0.15, 0.6, 0.15], rtol=1e-6)
    (target,) = (e for e in env.unwrapped.scene.elements if e.name == "target")
    np.testing.assert_allclose(metres(observation[TARGET]), target.circle[0], atol=1e-6)
    assert observation[[TIME, BALLS]].tolist() == [1.0, 1.0]
    observation, *_ = env.step([0.5, -0.25, 0.75, 1.0])
    t = 1 / 30
    np.testing.assert_allclose(metres(observation[BALL]), [0.3 + 0.5 * t, 0.9 - t - t * t], rtol=1e-6)
    np.testing.assert_allclose(
        metres(observation[ENDS]), [0.4 + t / 2, 0.15 - t / 4, 0.6 + 3 * t / 4, 0.15 + t], rtol=1e-6
    )
    np.testing.assert_allclose(observation[TIME], 1 - 2 / 480)
    sticky, _ = begun(repeat_action_probability=0.5, seed=3)
    rows = np.array([sticky.step([0.125 * k, -3.0, 0.25, 0.5])[0][12:] for k in range(1, 9)])
    assert_same(rows[:, 1:], np.tile(np.float32([-1.0, 0.25, 0.5]), (8, 1)))
    assert {*rows[:, 0]} < {0.125 * k for k in range(9)}  # some were not taken


def test_a_player_who_does_nothing_scores_nothing_and_targets_are_everywhere_else():
    envs = make_vec(400, "SAME_STEP", WALLS)
    observations, _ = envs.reset(seed=0)
    seen = [observations]
    for _ in range(300):
        observations, rewards, *_ = envs.step(np.zeros((400, 4)))
        assert not rewards.any()
        seen.append(observations[observations[:, TIME] == 1.0])
    launches = np.concatenate(seen)
    balls, targets = metres(launches[:, BALL]), metres(launches[:, TARGET])
    assert len(targets) > 1500
    assert np.linalg.norm(balls - targets, axis=1).min() > 0.25 * DIAGONAL
    np.testing.assert_allclose([targets.min(axis=0), targets.max(axis=0)], [[0.06] * 2, [0.94] * 2], atol=0.01)
    counts, _ = np.histogramdd(targets, bins=(4, 4), range=((0.06, 0.94), (0.06, 0.94)))
    assert counts.min() > 20
    np.testing.assert_allclose([balls[:, 0].min(), balls[:, 0].max()], [0.2, 0.8], atol=0.01)
    np.testing.assert_allclose(balls[:, 1], 0.9, rtol=1e-6)
    speeds = launches[:, VELOCITY] * 2.0
    np.testing.assert_allclose([speeds[:, 0].min(), speeds[:, 0].max()], [-0.5, 0.5], atol=0.01)
    assert not speeds[:, 1].any()


def test_launch_and_target_of_a_ball_follow_from_the_seed_and_its_number_alone():
    def launches(action, seed):
        env, observation = begun(seed=seed)
        seen, ended = [observation], False
        while not ended:
            observation, _, terminated, truncated, info = env.step(action)
            ended = terminated or truncated
            if info["ball"] == len(seen):
                seen.append(observation)
        return np.array(seen)

    idle = launches(STILL, 5)
    assert idle.shape == (5, 12)
    np.testing.assert_allclose(idle[:, BALLS], [1.0, 0.8, 0.6, 0.4, 0.2], rtol=1e-6)
    assert_same(launches([1.0, 0.3, -0.2, 0.5], 5), idle)
    assert len(np.unique(idle[:, TARGET], axis=0)) == 5
    assert not np.array_equal(launches(STILL, 6), idle)


def test_a_target_is_hit_at_the_instant_at_which_the_centre_comes_in():
    for seed in range(20):
        env, observation = begun(EASY, HIT, seed=seed)
        x, y = metres(observation[TARGET])
        rim = y + math.sqrt(0.09 - (0.5 - x) ** 2)
        if rim > HIT[1]:  # launched within it, and so never enters
            continue
        fall = math.sqrt(2.0 * (HIT[1] - rim) / GRAVITY)
        rewards = [env.step(STILL)[1] for _ in range(math.ceil(fall * 30))]
        assert rewards == [0.0] * (len(rewards) - 1) + [1.0]


@pytest.mark.parametrize("frame_skip", [1, 7, 60])
def test_what_is_passed_within_a_step_counts(frame_skip):
    env, _ = begun(EASY, HIT, (0.0, -2.9), balls=1, frame_skip=frame_skip)
    _, info = played(env)
    assert (info["points_targets"], info["drained"]) == (1.0, 0)


def test_an_episode_ends_with_its_last_ball():
    env, _ = begun(EASY, HIT, seed=3)
    rewards, info = played(env)
    assert env.unwrapped._batch.results.terminated[0]
    assert sum(rewards) == info["score"] == info["points_targets"]
    ends = [info[name] for name in ("points_targets", "drained", "timed_out", "crushed")]
    assert sum(ends) == 5
    assert min(ends[:2]) > 0
    assert (info["end_reason"], info["ball"]) == ("all_played", 4)
    assert info["game_seconds"] == len(rewards) / 30


@pytest.mark.parametrize(("position", "success"), [(HIT, True), (MISS, False)])
def test_success_is_more_than_half_of_the_balls(position, success):
    env, _ = begun(EASY, position, seed=3, balls=1)
    _, info = played(env)
    assert info["is_success"] is success
    half, _ = begun(EASY, MISS, seed=7, balls=2)  # the second ball of this seed meets its target
    _, info = played(half)
    assert (info["score"], info["is_success"]) == (1.0, False)
    envs = BounceVecEnv(WALLS, 2, scene=EASY, seed=3)
    envs.reset()
    told = []
    while len(told) < 20:
        _, _, dones, infos = envs.step(np.zeros((2, 4)))
        told += [info for info, done in zip(infos, dones, strict=True) if done]
    assert all(info["is_success"] is (info["score"] >= 3) for info in told)
    assert {info["is_success"] for info in told} == {True, False}


def potential(observation):
    return -np.linalg.norm(metres(observation[BALL]) - metres(observation[TARGET])) / DIAGONAL


@pytest.mark.parametrize("gamma", [0.9, 0.99, 1.0])
def test_the_dense_reward_is_the_sparse_one_with_shaping_that_telescopes(gamma):
    sparse, first = begun(seed=4)
    dense, _ = begun(seed=4, reward="dense", gamma=gamma)
    difference, discount, before, ended = 0.0, 1.0, potential(first), False
    for action in scripted(sparse.action_space, 2000, seed=1):
        observation, plain, terminated, *_ = sparse.step(action)
        again, shaped, ended, _, info = dense.step(action)
        assert_same(again, observation)
        after = 0.0 if terminated else potential(observation)
        np.testing.assert_allclose(shaped - plain, gamma * after - before, atol=1e-6)
        before, difference, discount = after, difference + discount * (shaped - plain), discount * gamma
        if ended:
            break
    assert ended
    np.testing.assert_allclose(difference, -potential(first), atol=1e-6)
    assert info["score"] == info["points_targets"]


def test_where_time_is_up_the_potential_stays():
    env, observation = begun(seed=4, reward="dense", gamma=0.9, time_limit=0.2)
    difference, first = 0.0, observation
    for k in range(6):
        observation, reward, terminated, truncated, info = env.step([0.0, 1.0, 0.0, 1.0])
        difference += 0.9**k * reward
    assert (terminated, truncated, info["end_reason"]) == (False, True, "time_limit")
    np.testing.assert_allclose(difference, 0.9**6 * potential(observation) - potential(first), atol=1e-6)


def length(observation):
    x0, y0, x1, y1 = metres(observation[ENDS])
    return math.hypot(x1 - x0, y1 - y0)


def test_the_wall_keeps_its_length_and_its_box():
    envs = make_vec(64, "SAME_STEP", WALLS, repeat_action_probability=0.25)
    observations, _ = envs.reset(seed=0)
    generator = np.random.default_rng(0)
    lengths, ends = [], []
    for k in range(400):
        if k % 20 == 0:
            actions = np.sign(generator.uniform(-1, 1, (64, 4))) * generator.choice([0.3, 1.0, 5.0], (64, 4))
        observations, *_ = envs.step(actions)
        seen = metres(observations[:, ENDS])
        ends.append(seen)
        lengths.append(np.linalg.norm(seen[:, :2] - seen[:, 2:], axis=1))
    np.testing.assert_allclose([np.min(lengths), np.max(lengths)], [0.1, 0.4], rtol=2e-6)
    low, high = np.min(ends, axis=(0, 1)), np.max(ends, axis=(0, 1))
    np.testing.assert_allclose(low, [0.05] * 4, rtol=1e-5)
    np.testing.assert_allclose(high, [0.95, 0.65] * 2, rtol=1e-5)


def test_an_end_that_is_drawn_away_drags_the_other_one_along():
    env, _ = begun(position=(0.5, 0.9))
    for _ in range(15):
        observation, *_ = env.step([-0.2, 0.0, 0.2, 0.0])
    np.testing.assert_allclose(length(observation), 0.4, rtol=1e-6)
    before = metres(observation[ENDS])
    observation, *_ = env.step([0.0, 0.0, 1.0, 0.0])
    np.testing.assert_allclose(metres(observation[ENDS]) - before, [1 / 60, 0.0, 1 / 60, 0.0], atol=1e-6)


def test_a_ball_that_the_wall_crushes_is_over():
    floor = Wall((0.3, 0.3), (0.7, 0.3), b=0.5)
    press = Wall((0.4, 0.5), (0.6, 0.5), b=0.5, draggable=True, min_length=0.1, reach=((0.0, 0.0), (1.0, 1.0)))
    scene = field(0.06, floor, press)
    elements = tuple(e for e in scene.elements if not (isinstance(e, Wall) and e.draggable and e is not press))
    env, _ = begun(replace(scene, elements=elements), (0.5, 0.33), balls=1)
    rewards, info = played(env, [0.0, -1.0, 0.0, -1.0])
    assert (info["crushed"], info["drained"], info["end_reason"]) == (1, 0, "all_played")
    assert len(rewards) == math.ceil((0.5 - 0.34) * 30)


def test_a_ball_that_rests_is_over_after_eight_seconds():
    scene = field(0.06, Wall((0.3, 0.3), (0.7, 0.3), b=0.0))
    env, _ = begun(scene, (0.5, 0.33), balls=2)
    for _ in range(239):
        *_, info = env.step(STILL)
    assert info["ball"] == 0
    observation, *_, info = env.step(STILL)
    assert info["ball"] == 1
    assert observation[TIME] == 1.0
    _, info = played(env)
    assert info["timed_out"] >= 1


def test_what_is_not_observed_changes_nothing():
    env, _ = begun(seed=9)
    script = scripted(env.action_space, 60, seed=2)
    for action in script[:40]:
        env.step(action)
    twin, _ = begun(seed=9)
    twin.unwrapped.restore_state(env.unwrapped.clone_state())
    batch = twin.unwrapped._batch
    batch.episodes["frames"] += 90
    batch.memory["born"] += 90
    batch.episodes["score"] += 3
    batch.counters[:, :5] += 1
    for name in ("cx0", "cy0", "cx1", "cy1"):  # the last command
        batch.state.ends[name] *= 0.5
    for action in script[40:]:
        assert_same(twin.step(action)[:4], env.step(action)[:4])


def test_a_state_goes_on_elsewhere_with_its_target():
    env, other = begun(seed=1)[0], begun(seed=2)[0]
    script = scripted(env.action_space, 400, seed=3)
    for action in script[:30]:
        env.step(action)
    assert_same(other.reset(options={"snapshot": env.unwrapped.clone_state()})[0], other.unwrapped._observation())
    assert other.unwrapped.scene == env.unwrapped.scene != FIELD
    for action in script[30:]:
        step = env.step(action)
        assert_same(other.step(action), step)
        if step[2]:
            break
    assert step[2]


def test_a_frame_shows_the_target_where_it_is():
    env = gym.make(WALLS, render_mode="rgb_array", width=200, height=200)
    fit = Projection.fit(FIELD.bounds, 200, 200)
    middles = set()
    for seed in range(5):
        observation, _ = env.reset(seed=seed)
        column, row = np.rint(fit.to_pixels(metres(observation[TARGET]))).astype(int)
        red, green, blue = env.render()[row, column].astype(int)
        assert green > 150 > max(red, blue)
        middles.add((row, column))
    assert len(middles) == 5


WRONG = {
    "paddle": "draggable walls = 0: must be exactly 1",
    field(0.06, Wall((0.3, 0.3), (0.5, 0.3), draggable=True)): "draggable walls = 2: must be exactly 1",
    replace(EASY, elements=EASY.elements[:4] + EASY.elements[5:]): '"target": must name a circular sensor',
    replace(EASY, elements=EASY.elements[:5]): "drains = 0: must be at least 1",
    replace(EASY, max_speed=None): "max_speed = None: must be given",
    replace(EASY, max_speed=2.0): "max_speed = 2.0: must be at least 2.82843",
    replace(EASY, gravity=(0.0, 0.0)): "gravity = .*: must not be zero",
    replace(EASY, ball=Ball()): "ball.radius = 0.0: must be > 0",
    field(0.55): "radius = 0.55 of the target: must be at most half",
    field(
        0.06, Wall((0.3, 0.85), (0.3, 0.95), name="post")
    ): "wall 'post'.*: must keep clear of where balls are launched",
}


@pytest.mark.parametrize(("scene", "words"), WRONG.items(), ids=WRONG.values())
def test_a_scene_that_cannot_be_played_is_refused(scene, words):
    with pytest.raises(ValueError, match=words):
        gym.make(WALLS, scene=scene)


@pytest.mark.parametrize(
    ("wall", "words"),
    [
        ({"reach": None}, "reach = None: the draggable wall must have one"),
        ({"reach": ((-0.5, 0.0), (1.0, 1.0))}, "reach = .*: must be on the field, x 0 to 1 and y 0 to 1"),
        ({"min_length": None}, "min_length = None: must be at least 0.0375, a quarter of the wall's length"),
    ],
)
def test_a_wall_that_cannot_be_dragged_as_the_game_does_is_refused(wall, words):
    elements = tuple(replace(e, **wall) if isinstance(e, Wall) and e.draggable else e for e in EASY.elements)
    with pytest.raises(ValueError, match=words):
        gym.make(WALLS, scene=replace(EASY, elements=elements))


@pytest.mark.parametrize(
    ("kwargs", "words"),
    [
        ({"reward": "score"}, "reward"),
        ({"gamma": 0.0}, "gamma"),
        ({"gamma": 1.5}, "gamma"),
        ({"balls": 0}, "balls"),
        ({"time_limit": -1.0}, "time_limit"),
    ],
)
def test_bad_keyword_arguments_are_refused(kwargs, words):
    with pytest.raises(ValueError, match=words):
        gym.make(WALLS, **kwargs)


@pytest.mark.parametrize("action", [[0.0] * 3, 0.0, [0.0, np.nan, 0.0, 0.0], [0.0, 0.0, np.inf, 0.0], ["a"] * 4])
def test_bad_actions_are_refused(action):
    env, _ = begun()
    with pytest.raises(ValueError, match="actions"):
        env.step(action)
