"""The rules of pinball: points, lamps, balls, and what keeps a player from earning by doing nothing."""

from dataclasses import replace
from itertools import pairwise

import gymnasium as gym
import numpy as np
import pytest

from bounce_env import Scene, Sensor, Wall, load_scene
from bounce_env.games.pinball import setup
from bounce_env.games.pinball.setup import layout_of, problems_of
from bounce_env.render import Projection
from tests.env.rollouts import assert_same

PINBALL = "Bounce/Pinball-v0"
NONE, LEFT, RIGHT, BOTH = range(4)
# Where the observation has what, on the built-in table.
X, Y, VX, VY, LEFT_UP, RIGHT_UP, BALLS, SAVE, HELD, MULTIPLIER, FARMED, IDLE, LEFT_REST, RIGHT_REST = range(14)
TARGETS, LANES, COOLING, TILT = slice(14, 17), slice(17, 20), slice(20, 23), 23
TABLE = load_scene("pinball")


def index(name):
    return next(i for i, e in enumerate(TABLE.elements) if e.name == name)


def begun(position=None, velocity=(0.0, 0.0), *, seed=0, **kwargs):
    env = gym.make(PINBALL, **kwargs)
    options = None if position is None else {"position": position, "velocity": velocity}
    env.reset(seed=seed, options=options)
    return env


def until(env, happens, action=NONE, steps=600):
    """Steps of one action until something `happens`; all that these steps returned."""
    taken = []
    for _ in range(steps):
        taken.append(env.step(action))
        if happens(taken[-1]):
            return taken
    raise AssertionError(f"not within {steps} steps; at {taken[-1]}")


def test_the_observation_is_what_the_card_says():
    env = begun()
    assert env.observation_space.shape == (23,)
    observation, _ = env.reset(seed=0)
    assert env.observation_space.contains(observation)
    np.testing.assert_allclose(observation[X], 0.496 / 0.514 * 2 - 1, rtol=1e-6)
    np.testing.assert_allclose(observation[Y], (0.06 - 0.02) / 1.047 * 2 - 1, rtol=1e-6)
    assert observation[VX] == 0.0
    assert 1.45 <= observation[VY] <= 2.4
    assert observation[[LEFT_UP, RIGHT_UP]].tolist() == [0.0, 0.0]
    np.testing.assert_allclose(
        observation[[BALLS, SAVE, HELD, FARMED, IDLE, LEFT_REST, RIGHT_REST]], [1, 1, 0, 0, 0, 0, 0]
    )
    np.testing.assert_allclose(observation[MULTIPLIER], 0.2)
    assert observation[TARGETS].tolist() == [1.0] * 3
    assert observation[LANES].tolist() == [0.0] * 3
    assert observation[COOLING].tolist() == [0.0] * 3


def test_the_first_step_lasts_until_the_ball_is_in_play():
    env = begun()
    before = env.unwrapped._batch.episodes[0]["frames"]
    observation, reward, *_ = env.step(BOTH)
    after = env.unwrapped._batch.episodes[0]["frames"]
    x, y = (observation[X] + 1) / 2 * 0.514, (observation[Y] + 1) / 2 * 1.047 + 0.02
    assert (before, reward) == (0, 0.0)
    assert 20 < after < 120
    assert y > 0.76  # above the gate
    assert x > 0.3
    np.testing.assert_allclose(observation[SAVE], 1.0 - 2 / 300, rtol=1e-5)
    assert 0.4 < observation[LEFT_UP] <= 1.0  # pressed for two frames


def test_launches_depend_on_seed_and_ball_alone():
    def speeds(seed, action):
        env = begun(seed=seed)
        seen, ball = [], -1
        for _ in range(3000):
            if int(env.unwrapped._batch.memory["serving"][0]) == setup.SHOT:
                seen.append(float(env.unwrapped._batch.state.balls[0, 0].vy))
            _, _, terminated, truncated, info = env.step(action)
            ball = max(ball, info["ball"])
            if terminated or truncated:
                break
        return seen

    assert speeds(5, NONE) == speeds(5, LEFT)
    assert speeds(5, NONE) != speeds(6, NONE)


@pytest.mark.parametrize("name", ["bumper_1", "bumper_2", "bumper_3"])
def test_a_bumper_scores_and_cools_down(name):
    x, y = TABLE.elements[index(name)].center
    env = begun((x, y + 0.06), (0.0, -1.0))
    steps = until(env, lambda step: step[1] != 0.0)
    observation, reward, *_, info = steps[-1]
    assert (reward, info["score"]) == (0.05, 50.0)
    np.testing.assert_allclose(observation[FARMED], 1 / 20)
    assert observation[IDLE] <= 1 / 600
    cooling = observation[COOLING]
    assert 0.0 < cooling[int(name[-1]) - 1] < 1.0
    assert np.count_nonzero(cooling) == 1
    assert observation[VY] > 0.8  # 0.6 of its speed, and the kick


def test_a_slingshot_scores():
    env = begun((0.14, 0.26), (-1.0, -0.5))
    *_, (observation, reward, *_, info) = until(env, lambda step: step[1] != 0.0)
    assert (reward, info["score"]) == (0.01, 10.0)
    np.testing.assert_allclose(observation[FARMED], 1 / 20)


def hit_targets(env, order):
    """Shoots a ball at the targets of `order` in turn, each time a new one; yields observation and points."""
    memory, kept = env.unwrapped._batch.memory, {"lit": 0b111, "multiplier": 1}
    for k in order:
        wall = TABLE.elements[index(f"target_{k + 1}")]
        env.reset(seed=0, options={"position": (0.08, (wall.start[1] + wall.end[1]) / 2), "velocity": (-2.0, 0.0)})
        for name, value in kept.items():
            memory[name] = value
        observation, *_, info = until(env, lambda step: step[1] != 0.0, steps=10)[-1]
        kept = {name: memory[name].copy() for name in kept}
        yield observation, info["score"]


def test_targets_go_out_and_the_last_of_the_bank_pays_more_and_raises_the_multiplier():
    env = begun((0.25, 0.5))
    hits = list(hit_targets(env, [1, 0, 2, 2]))
    assert [points for _, points in hits] == [250.0, 250.0, 1250.0, 500.0]
    assert [hit[TARGETS].tolist() for hit, _ in hits] == [[1, 0, 1], [0, 0, 1], [1, 1, 1], [1, 1, 0]]
    np.testing.assert_allclose([hit[MULTIPLIER] for hit, _ in hits], [0.2, 0.2, 0.4, 0.4])


def test_the_multiplier_stops_at_five():
    env = begun((0.25, 0.5))
    hits = [points for _, points in hit_targets(env, [0, 1, 2] * 6)]
    assert hits[2::3] == [1250.0, 2500.0, 3750.0, 5000.0, 6250.0, 6250.0]


def test_a_target_that_is_out_pays_nothing():
    env = begun((0.25, 0.5))
    with pytest.raises(AssertionError, match="not within"):
        list(hit_targets(env, [1, 1]))


def test_lanes_light_up_and_the_last_one_pays_more():
    env = begun((0.25, 0.5))
    batch = env.unwrapped._batch
    points = []
    for k, passed in ((0, 0b000), (1, 0b001), (2, 0b011), (2, 0b100)):
        x = 0.177 + 0.05 * (k + 0.5)
        env.reset(seed=0, options={"position": (x, 0.915), "velocity": (0.0, -1.0)})
        batch.memory["passed"] = passed
        observation, reward, *_ = env.step(NONE)
        points.append((round(1000 * reward), observation[LANES].tolist()))
    assert points == [(100, [1, 0, 0]), (100, [1, 1, 0]), (600, [0, 0, 0]), (0, [0, 0, 1])]


def test_bumpers_pay_for_twenty_hits_only_until_a_flipper_touches_the_ball():
    env = begun()
    batch = env.unwrapped._batch
    x, y = TABLE.elements[index("bumper_1")].center
    earned = []
    for farmed in (18, 19, 20, 21):
        env.reset(seed=0, options={"position": (x, y + 0.05), "velocity": (0.0, -1.0)})
        batch.memory["farmed"] = farmed
        batch.memory["scored"] = -60
        observation, reward, *_ = env.step(NONE)
        earned.append((reward, observation[IDLE] > 0.1))
    assert earned == [(0.05, False), (0.05, False), (0.0, True), (0.0, True)]  # for nothing it is as good as stuck
    tip = (TABLE.elements[index("flipper_left")].pivot[0] + 0.045, 0.14)
    env.reset(seed=0, options={"position": tip, "velocity": (0.0, -1.0)})
    batch.memory["farmed"] = 25
    *_, (observation, *_) = until(env, lambda step: step[0][FARMED] == 0.0, steps=20)
    assert observation[FARMED] == 0.0


def drained(env, steps=3000):
    """Does nothing until a ball is lost or given back; returns observation, reward and info of that step."""
    saves, ball = int(env.unwrapped._batch.memory["saved"][0]), int(env.unwrapped._batch.episodes["ball"][0])
    for _ in range(steps):
        observation, reward, terminated, _, info = env.step(NONE)
        memory = env.unwrapped._batch.memory[0]
        if terminated or info["ball"] != ball or memory["saved"] != saves:
            return observation, reward, terminated, info
    raise AssertionError(f"no ball was lost in {steps} steps")


def test_a_ball_lost_early_is_given_back_once_and_three_balls_make_an_episode():
    env = begun((0.239, 0.1), (0.0, -1.0))
    observation, reward, terminated, info = drained(env)
    assert (reward, terminated, info["ball"]) == (0.0, False, 0)
    assert observation[SAVE] == 0.0
    lost = []
    for _ in range(6):
        before = int(env.unwrapped._batch.memory["saved"][0])
        *_, terminated, info = drained(env)
        if int(env.unwrapped._batch.memory["saved"][0]) <= before:
            lost.append(info["ball"])
        if terminated:
            break
    assert terminated
    assert lost[-1] == 2
    assert info["end_reason"] == "drained"
    with pytest.raises(gym.error.ResetNeeded):
        env.step(NONE)


@pytest.mark.parametrize(("kwargs", "cost"), [({}, -2.0), ({"reward": "dense"}, -2.0), ({"reward": "score"}, 0.0)])
def test_a_lost_ball_costs_two_points_of_reward_and_none_of_the_score(kwargs, cost):
    env = begun((0.239, 0.1), (0.0, -1.0), balls=2, **kwargs)
    env.unwrapped._batch.memory["saved"] = 1
    observation, reward, terminated, info = drained(env)
    assert (reward, terminated, info["score"], info["ball"]) == (cost, False, 0.0, 1)
    assert observation[BALLS] == 0.5
    assert observation[SAVE] > 0.9  # the new ball has its own


def test_the_multiplier_is_lost_with_the_ball_and_the_lamps_are_not():
    env = begun((0.239, 0.1), (0.0, -1.0))
    memory = env.unwrapped._batch.memory
    memory["saved"], memory["multiplier"], memory["lit"], memory["passed"] = 1, 3, 0b101, 0b010
    observation, *_ = drained(env)
    np.testing.assert_allclose(observation[MULTIPLIER], 0.2)
    assert observation[TARGETS].tolist() == [1, 0, 1]
    assert observation[LANES].tolist() == [0, 1, 0]


def test_a_ball_held_for_two_seconds_is_let_go_until_it_has_left():
    """Both flippers up: a ball comes to rest between the left one and the guide above it."""
    env = begun((0.16, 0.17), (0.0, -0.1))
    steps = until(env, lambda step: step[0][HELD] == 1.0, action=BOTH, steps=200)
    assert len(steps) in range(55, 75)  # it took a moment to come into the zone
    assert steps[-2][0][LEFT_UP] == 1.0
    released = until(env, lambda step: step[0][LEFT_UP] == 0.0, action=BOTH, steps=10)
    assert all(step[0][HELD] == 1.0 for step in released)
    gone = until(env, lambda step: step[0][HELD] == 0.0, action=BOTH, steps=300)
    assert len(gone) < 120
    until(env, lambda step: step[0][LEFT_UP] > 0.0, action=BOTH, steps=5)
    state = env.unwrapped._batch.counters[0]
    assert state[setup.HOLD_RELEASED] == 1


def test_a_button_that_is_let_go_rests_for_three_tenths_of_a_second():
    """Pressed again at once it waits, while the other one acts; what is held goes up as soon as it may."""
    env = begun((0.25, 0.5))
    env.step(LEFT)
    observation, *_ = env.step(NONE)
    np.testing.assert_allclose(observation[[LEFT_REST, RIGHT_REST]], [16 / 18, 0.0], rtol=1e-6)
    observation, *_ = env.step(BOTH)
    assert observation[LEFT_UP] < 0.2 < observation[RIGHT_UP]
    *_, (observation, *_) = taken = until(env, lambda step: step[0][LEFT_REST] == 0.0, action=BOTH, steps=20)
    assert len(taken) == 7
    assert observation[LEFT_UP] == 0.0
    observation, *_ = env.step(BOTH)
    assert observation[LEFT_UP] > 0.4
    assert env.unwrapped._batch.counters[0, setup.FLIPS] == 3


def cup():
    """The built-in table with a cup in its middle."""
    corners = [(0.2, 0.45), (0.2, 0.4), (0.28, 0.4), (0.28, 0.45)]
    walls = [Wall(start, end, b=0.2) for start, end in pairwise(corners)]
    return replace(TABLE, elements=(*TABLE.elements, *walls))


def test_a_stuck_ball_is_shot_again_after_ten_seconds_and_counted():
    env = begun((0.24, 0.43), scene=cup())
    steps = until(env, lambda step: step[0][IDLE] > 0.99, steps=301)
    assert len(steps) >= 297
    until(env, lambda step: step[0][IDLE] == 0.0, steps=5)
    until(env, lambda step: step[0][Y] > 0.4, steps=3)
    assert env.unwrapped._batch.counters[0, setup.STUCK_FREED] == 1
    assert env.unwrapped._batch.episodes["ball"][0] == 0


def test_buttons_and_numbers_say_the_same():
    numbers, buttons = begun(), begun(action="buttons")
    for k in range(400):
        action = (k * 7 // 5) % 4
        step = numbers.step(action)
        assert_same(buttons.step(np.array([action & 1, action >> 1], np.int8)), step)
        if step[2]:
            break


def test_a_nudge_moves_the_ball_and_too_many_tilt_the_table():
    plain, nudged = begun((0.25, 0.45), nudge=True), begun((0.25, 0.45), nudge=True)
    assert plain.action_space.n == 6
    (still, *_), (moved, *_) = plain.step(NONE), nudged.step(5)
    np.testing.assert_allclose(moved[VX] - still[VX], 0.25, atol=1e-6)
    np.testing.assert_allclose(moved[VY] - still[VY], 0.15, atol=1e-6)
    assert moved[TILT] == pytest.approx(1 / 3, abs=0.01)
    tilts = until(nudged, lambda step: step[0][TILT] == 1.0, action=4, steps=200)
    assert len(tilts) < 40
    observation, *_ = until(nudged, lambda step: step[2] or step[4]["ball"] == 1, action=BOTH, steps=900)[-1]
    assert nudged.unwrapped._batch.counters[0, setup.TILTS] == 1
    assert observation[TILT] < 1.0


def test_while_the_table_is_tilted_flippers_are_dead_and_nothing_pays():
    x, y = TABLE.elements[index("bumper_1")].center
    env = begun((x, y + 0.05), (0.0, -1.0), nudge=True)
    env.unwrapped._batch.memory["tilted"] = 1
    observation, reward, *_ = env.step(BOTH)
    assert reward == 0.0
    assert observation[[LEFT_UP, RIGHT_UP]].tolist() == [0.0, 0.0]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"drop": "flipper"}, "flippers = 0"),
        ({"drop": "plunger"}, '"plunger"'),
        ({"drop": "in_play"}, '"in_play"'),
        ({"drop": "drain"}, "drains = 0"),
        ({"rename": ("left", "rollover_9")}, "'rollover_9': must be a Sensor"),
        ({"rename": ("in_play", "target_9")}, "'target_9': must bounce"),
    ],
)
def test_a_scene_that_lacks_something_is_refused_by_name(change, words):
    elements = TABLE.elements
    if "drop" in change:
        elements = tuple(e for e in elements if not e.name.startswith(change["drop"]))
    if "rename" in change:
        old, new = change["rename"]
        elements = tuple(replace(e, name=new) if e.name == old else e for e in elements)
    with pytest.raises(ValueError, match=words):
        gym.make(PINBALL, scene=replace(TABLE, elements=elements))


def test_a_scene_may_have_several_flippers_of_a_button_and_other_numbers_of_lamps():
    third = replace(TABLE.elements[index("flipper_left")], pivot=(0.06, 0.62), name="flipper_left_upper")
    lane = Sensor((0.3, 0.3), (0.4, 0.3), name="rollover_low")
    scene = Scene(**{**vars_of(TABLE), "elements": (*TABLE.elements, third, lane)})
    assert problems_of(scene) == []
    layout = layout_of((scene,))
    assert layout.sides[0].tolist() == [1, 2, 1]
    assert layout.tables[0]["rollovers"] == 4


def vars_of(scene):
    return {name: getattr(scene, name) for name in ("gravity", "ball", "rest_speed", "max_speed", "drag")}


def test_what_is_hit_counts_once_and_is_lit_until_the_step_ends():
    """A bumper is hit in the first of three frames: its points are given once, and the picture shows it."""
    x, y = TABLE.elements[index("bumper_1")].center
    env = begun((x, y + 0.05), (0.0, -1.0), frame_skip=3, render_mode="rgb_array")
    dark = env.render()
    _, reward, *_ = env.step(NONE)
    assert reward == 0.05
    lit = env.render()
    env.step(NONE)
    later = env.render()
    assert env.unwrapped._batch.counters[0, setup.BY_BUMPERS] == 50.0
    projection = Projection.fit(TABLE.bounds)
    (left, top), (right, bottom) = projection.to_pixels([(x - 0.03, y), (x + 0.03, y - 0.03)])
    corner = np.s_[round(top) : round(bottom), round(left) : round(right)]
    brightness = [picture[corner].astype(float).mean() for picture in (dark, lit, later)]
    assert brightness[1] > 1.1 * brightness[0]
    assert brightness[2] < 1.05 * brightness[0]
