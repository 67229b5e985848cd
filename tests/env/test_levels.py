"""Levels of the paddle game: which are played, where their bumpers are, and that each is the scene that it says."""

from dataclasses import replace
from itertools import combinations

import gymnasium as gym
import numpy as np
import pytest

from bounce_env import Bumper, load_scene
from bounce_env.engine.memory.state import State
from bounce_env.engine.packing import pack
from bounce_env.envs.paddle import PaddleEnv
from bounce_env.games.paddle.game import PaddleGame
from bounce_env.games.paddle.levels import GAP, MOVING_FROM, RAIL, SPEED
from bounce_env.games.paddle.setup import PaddleOptions
from tests.conftest import soak_count
from tests.env.rollouts import PADDLE, assert_same, make_vec, scripted

BASE = load_scene("paddle_levels")


def bumpers_of(scene):
    return [e for e in scene.elements if isinstance(e, Bumper)]


def paths(bumpers):
    """Points (n, 101, 2) on the way of each bumper's centre."""
    ends = np.array([(b.center, b.rail_end or b.center) for b in bumpers])
    share = np.linspace(0.0, 1.0, 101)[:, None]
    return ends[:, :1] + share * (ends[:, 1:] - ends[:, :1])


def test_bumpers_keep_clear_of_each_other_and_of_the_walls_on_every_level():
    game, gap = PaddleGame(PaddleOptions(num_levels=0)), GAP * BASE.ball.radius
    first = range(soak_count(300, 20_000))
    for level in (*first, *range(10**6, 10**6 + len(first)), 2**31 - 1):
        bumpers = bumpers_of(game.scene_on(level))
        ways = paths(bumpers)
        for bumper, way in zip(bumpers, ways, strict=True):
            inset = bumper.radius + gap - 1e-12
            assert (way[:, 0] >= inset).all(), level
            assert (way[:, 0] <= 1.0 - inset).all(), level
            assert (way[:, 1] <= 1.4 - inset).all(), level
            assert (way[:, 1] >= 0.65).all(), level  # a ball is launched at 0.542
        for (one, path), (other, by) in combinations(zip(bumpers, ways, strict=True), 2):
            nearest = np.linalg.norm(path[:, None] - by[None], axis=2).min()
            assert nearest >= one.radius + other.radius + gap - 1e-12, level
        (rider,) = [b for b in bumpers if b.rail_end is not None]
        assert RAIL[0] <= np.abs(np.subtract(rider.rail_end, rider.center)).sum() <= RAIL[1]
        assert rider.speed == 0.0 if level < MOVING_FROM else SPEED[0] <= rider.speed <= SPEED[1]


def test_levels_differ_and_use_all_of_the_upper_field():
    game = PaddleGame(PaddleOptions(num_levels=0))
    places = np.array([[b.center for b in bumpers_of(game.scene_on(level))] for level in range(400)])
    assert len(np.unique(places[:, 0, 0])) == 400
    for j in range(4):
        assert np.ptp(places[:, j, 0]) > 0.5
        assert np.ptp(places[:, j, 1]) > 0.4
    ways = np.array([np.subtract(bumpers_of(game.scene_on(k))[2].rail_end, places[k, 2]) for k in range(400)])
    assert 150 < (ways[:, 0] > 0.0).sum() < 250  # the others ride up and down


@pytest.mark.parametrize(("number", "first"), [(5, 0), (3, 1000)])
def test_each_of_the_levels_is_played_as_often(number, first):
    envs = make_vec(300, num_levels=number, start_level=first)
    levels = np.concatenate([envs.reset(seed=k)[1]["level"] for k in (0, 1000)])
    counts = np.unique_counts(levels)
    assert counts.values.tolist() == list(range(first, first + number))
    assert counts.counts.min() > 0.7 * 600 / number


def test_unlimited_levels_are_from_the_first_on():
    envs = make_vec(500, num_levels=0, start_level=10**9)
    levels = envs.reset(seed=0)[1]["level"]
    assert levels.min() >= 10**9
    assert levels.max() < 2**31
    assert len(set(levels.tolist())) == 500
    assert levels.max() - levels.min() > 0.9 * (2**31 - 10**9)


@pytest.mark.parametrize("level", [3, 57])
def test_a_level_is_the_scene_that_it_says_it_is(level):
    """Played as a scene of the user, which the tables are packed from, it gives the same bits."""
    levels = gym.make(PADDLE, num_levels=0)
    scene = levels.unwrapped._batch.game.scene_on(level)
    alone = gym.make(PADDLE, scene=scene)
    ours, info = levels.reset(seed=7, options={"level": level})
    assert info["level"] == level
    theirs, _ = alone.reset(seed=7)
    ball = slice(0, 5)
    for t, action in enumerate(scripted(gym.vector.utils.batch_space(levels.action_space, 1), 1500)):
        assert_same(ours[ball], theirs[ball], f"step {t}")
        one, other = levels.step(action[0]), alone.step(action[0])
        assert_same(one[1:4], other[1:4], f"step {t}")
        ours, theirs = one[0], other[0]
        if one[2] or one[3]:
            assert one[4].pop("level") == level
            assert one[4] == other[4]
            ours, theirs = levels.reset(options={"level": level})[0], alone.reset()[0]


def test_every_world_has_the_tables_of_its_level():
    envs = make_vec(6, "SAME_STEP", num_levels=50, time_limit=0.5)
    envs.reset(seed=1)
    played = set()
    for _ in range(100):
        info = envs.step(envs.action_space.sample())[-1]
        batch = envs.unwrapped._batch
        for w, level in enumerate(info["level"].tolist()):
            if level not in played:
                played.add(level)
                packed = pack((batch.game.scene_on(level),))
                for name in State._fields[: State._fields.index("recording")]:
                    ours, theirs = getattr(batch.state, name), getattr(packed, name)
                    assert (ours is None) == (theirs is None)
                    assert ours is None or ours[w : w + 1].tobytes() == theirs.tobytes(), name
                assert batch.scene(w) == batch.game.scene_on(level)
    assert len(played) > 20


def test_what_is_seen_of_the_bumpers():
    env = PaddleEnv(num_levels=0)
    seen, info = env.reset(seed=0, options={"level": 20})
    bumpers = bumpers_of(env._batch.game.scene_on(20))
    time = 0.0
    for _ in range(200):
        expected = []
        for bumper in bumpers:
            (x, y), place = bumper.center, []
            if bumper.rail_end is not None:
                span = np.subtract(bumper.rail_end, bumper.center)
                length = np.abs(span).sum()
                phase = bumper.speed * time % (2.0 * length)
                along, way = (phase, 1.0) if phase < length else (2.0 * length - phase, -1.0)
                now, velocity = bumper.center + span / length * along, way * bumper.speed * span / length
                place = [*now, *velocity, x, y, *bumper.rail_end]
            expected += place or [x, y]
        values = np.array(expected)
        speeds = [i for i in range(len(values)) if len(values) == 14 and i in (6, 7)]
        scaled = np.where(np.arange(len(values)) % 2 == 0, 2.0 * values - 1.0, 2.0 * (values + 0.03) / 1.43 - 1.0)
        scaled[speeds] = values[speeds] / 0.4
        np.testing.assert_allclose(seen[5:], scaled, rtol=0.0, atol=1e-6)
        seen, _, terminated, _, info = env.step([0.0])
        time += 1 / 30
        if terminated:
            break
    assert info["level"] == 20
    assert time > 0.5


def test_a_moving_bumper_is_seen_without_levels_too():
    (plain,) = PaddleEnv().observation_space.shape
    (moving,) = PaddleEnv(scene="paddle_levels").observation_space.shape
    assert moving == plain + 8
    fast = replace(bumpers_of(BASE)[2], speed=0.8)
    scene = replace(BASE, elements=tuple(fast if e.name == fast.name else e for e in BASE.elements))
    env = PaddleEnv(scene=scene)
    assert env.observation_space.contains(env.reset(seed=0)[0])
    assert env.observation_space.high[7:9].tolist() == [2.0, 2.0]


def test_the_level_is_told_when_an_episode_ends_and_the_next_one_is_on_another():
    envs = make_vec(8, "SAME_STEP", num_levels=1000, time_limit=0.2)
    before = envs.reset(seed=0)[1]["level"]
    for _ in range(6):
        info = envs.step(envs.action_space.sample())[-1]
    assert info["_final_info"].all()
    assert info["final_info"]["level"].tolist() == before.tolist()
    assert (info["level"] != before).all()


def test_a_state_goes_on_in_any_world_of_an_equal_batch():
    envs, other = (make_vec(4, num_levels=50) for _ in range(2))
    envs.reset(seed=0)
    other.reset(seed=90)
    actions = scripted(envs.action_space, 400)
    for row in actions[:20]:
        envs.step(row)
    turned = np.array([3, 2, 1, 0])
    other.unwrapped.restore_state(envs.unwrapped.clone_state()[turned])
    for row in actions[20:]:
        ours, theirs = other.step(row[turned]), envs.step(row)
        assert_same(ours[0], theirs[0][turned])
        assert_same(ours[1], theirs[1][turned])
        assert_same(ours[4]["level"], theirs[4]["level"][turned])


def test_reset_goes_on_from_a_snapshot():
    env = gym.make(PADDLE, num_levels=50)
    env.reset(seed=5)
    for _ in range(10):
        seen = env.step([1.0])
    snapshot = env.unwrapped.clone_state()
    ahead = [env.step([-1.0]) for _ in range(60)]
    env.reset(seed=6)
    observation, info = env.reset(options={"snapshot": snapshot})
    assert_same(observation, seen[0])
    assert info == seen[4]
    assert_same([env.step([-1.0]) for _ in range(60)], ahead)
    vector = make_vec(3, num_levels=50)
    vector.reset(seed=1)
    mask = np.array([False, True, False])
    observations, _ = vector.reset(options={"snapshot": snapshot, "reset_mask": mask})
    assert_same(observations[1], observation)


@pytest.mark.parametrize(
    ("kwargs", "message"),
    [
        ({"start_level": 3}, "start_level = 3: must be 0 where num_levels is None"),
        ({"num_levels": -1}, "num_levels = -1: must be None, or a whole number from 0 to 2147483648"),
        ({"num_levels": 10, "start_level": 2**31 - 5}, "num_levels = 10: .* at most 5"),
        ({"num_levels": 1.5}, "num_levels"),
    ],
)
def test_bad_levels(kwargs, message):
    for make in (gym.make, lambda env_id, **kw: make_vec(2, **kw)):
        with pytest.raises(ValueError, match=message):
            make(PADDLE, **kwargs)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"level": -1}, r"options\['level'\] = -1: must be 0 to 2147483647"),
        ({"level": 1.5}, r"options\['level'\] = 1.5: must be a whole number"),
        ({"level": [1, 2]}, r"one for each of 1 worlds"),
        ({"position": (0.5, 0.5)}, r"options\['level'\] must be given, too"),
        ({"snapshot": 3}, "state = 3: must be what clone_state"),
        ({"snapshot": 3, "level": 2}, r"options\['snapshot'\]: must come without options\['level'\]"),
    ],
)
def test_bad_options(options, message):
    env = gym.make(PADDLE, num_levels=4)
    env.reset(seed=0)
    before = env.unwrapped.clone_state()
    with pytest.raises(ValueError, match=message):
        env.reset(options=options)
    assert_same(env.unwrapped.clone_state().data, before.data)


def test_a_place_on_a_level_is_checked_against_its_bumpers():
    env = gym.make(PADDLE, num_levels=4)
    there = bumpers_of(env.unwrapped._batch.game.scene_on(2))[0].center
    with pytest.raises(ValueError, match=r"overlaps elements\[3\] \(bumper 'bumper_left'\)"):
        env.reset(options={"level": 2, "position": there})


def test_without_levels_there_is_no_such_option():
    with pytest.raises(ValueError, match=r"options\['level'\]: must be one of position, velocity$"):
        gym.make(PADDLE).reset(options={"level": 2})


def test_a_scene_too_crowded_for_levels():
    more = tuple(Bumper((0.2 * k, 5.0), 0.08, b=1.5) for k in range(12))
    crowded = replace(BASE, elements=(*BASE.elements, *more))
    gym.make(PADDLE, scene=crowded)
    with pytest.raises(ValueError, match="num_levels = 3: a scene for levels must have fewer or smaller bumpers"):
        gym.make(PADDLE, scene=crowded, num_levels=3)
