"""What is not allowed is refused, by name, value and what is allowed, before anything has moved."""

import gymnasium as gym
import numpy as np
import pytest

from bounce_env.envs.paddle import PaddleEnv, PaddleVectorEnv
from tests.env.rollouts import PADDLE, assert_same, make_vec

NAN, INF = float("nan"), float("inf")
PYDANTICS = ["validation error", "input_value", "type=", "pydantic"]

# keyword: (bad value, words of the message besides the keyword and the value)
GAME_KWARGS = [
    ("scene", "nowhere", ["paddle", ".toml"]),
    ("scene", "padle", ["did you mean 'paddle'?"]),
    ("scene", 3, ["Scene", "built-in"]),
    ("action", "keyboard", ["continuous, discrete"]),
    ("reward", "sparse", ["score, dense"]),
    ("gamma", 0.0, ["> 0 and <= 1"]),
    ("gamma", 1.5, ["> 0 and <= 1"]),
    *(("frame_skip", value, ["a whole number from 1 to 60"]) for value in (0, 61, True, 2.0, None, 10**400)),
    *(("repeat_action_probability", value, ["a number >= 0 and < 1"]) for value in (1.0, -0.1, NAN, "0.5", True)),
    *(("time_limit", value, ["a number > 0", "1e+09"]) for value in (0, -1.0, NAN, INF, "long", 10**400, 1e308)),
    ("num_levels", -1, ["a whole number from 0 to 2147483648"]),
    ("start_level", 3, ["must be 0 where num_levels is None"]),
    ("render_mode", "x", ["rgb_array"]),
    ("render_mode", ["rgb_array"], ["rgb_array"]),
    *((name, value, ["an integer from 1 to 8192"]) for name in ("width", "height") for value in (0, -3, 1.5, 8193)),
    ("obs_width", 84, ["None where obs is"]),
    ("grayscale", True, ["False where obs is"]),
    ("obs", "frames", ["state, pixels"]),
    ("obs", None, ["state, pixels"]),
    *(("trail", value, ["finite number >= 0", "at most 60"]) for value in (-0.1, NAN, INF, True, None, "0.5", 10**400)),
    ("show_bounces", 1, ["True or False"]),
]
VECTOR_KWARGS = [
    ("num_envs", 0, [">= 1"]),
    ("num_envs", 2.0, [">= 1"]),
    ("num_envs", True, [">= 1"]),
    ("num_envs", 10**400, [">= 1"]),
    ("num_threads", 10**9, [">= 1, at most 1024"]),
    ("num_threads", 0, [">= 1"]),
    ("num_threads", None, [">= 1"]),
    ("autoreset_mode", "x", ["NEXT_STEP", "SAME_STEP", "DISABLED"]),
    ("copy", "no", ["True or False"]),
    ("info", "end", ["'none', 'ends', 'all'", "did you mean 'ends'"]),
    ("max_episode_steps", 0, ["None, -1 or a whole number >= 1"]),
    ("max_episode_steps", 7.5, ["None, -1 or a whole number >= 1"]),
    ("max_episode_steps", 10**400, ["None, -1 or a whole number >= 1"]),
    ("render_mode", "human", ["rgb_array"]),
]


def check_words(error, words):
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(("keyword", "value", "allowed"), GAME_KWARGS)
def test_single_env_names_the_keyword_the_value_and_what_is_allowed(keyword, value, allowed):
    with pytest.raises(ValueError, match=keyword) as error:
        PaddleEnv(**{keyword: value})
    check_words(error, [str(value)[:50], *allowed])
    assert not any(word in str(error.value) for word in PYDANTICS)


@pytest.mark.parametrize(("keyword", "value", "allowed"), GAME_KWARGS + VECTOR_KWARGS)
def test_vector_env_names_the_keyword_the_value_and_what_is_allowed(keyword, value, allowed):
    with pytest.raises(ValueError, match=keyword) as error:
        PaddleVectorEnv(**{"num_envs": 2, keyword: value})
    check_words(error, [str(value)[:50], *allowed])
    assert not any(word in str(error.value) for word in PYDANTICS)


def test_an_unknown_keyword_is_named():
    words = r"frameskip = 4: unknown keyword \(did you mean 'frame_skip'\?\): must be one of scene, .*frame_skip"
    with pytest.raises(TypeError, match=words):
        gym.make(PADDLE, frameskip=4)
    with pytest.raises(TypeError, match=words):
        make_vec(2, frameskip=4)


def test_a_scene_given_as_a_dict_is_checked_like_a_file():
    with pytest.raises(ValueError, match=r"scene: gravty = 3: unknown field \(did you mean 'gravity'\?\)"):
        gym.make(PADDLE, scene={"gravty": 3})


def test_a_scene_that_cannot_be_played_says_what_it_lacks():
    with pytest.raises(ValueError, match=r"paddles = 0: must be exactly 1.*drains = 0.*max_speed"):
        gym.make(PADDLE, scene="box")


BAD_ACTIONS = {
    "continuous": [
        (NAN, "actions\\[0\\] = nan: must be finite"),
        ([-INF], "actions\\[0\\] = -inf: must be finite"),
        ([0.0, 0.0], "shape \\(2,\\): must be 1 numbers"),
        ([[[0.5]]], "shape \\(1, 1, 1\\): must be 1 numbers"),
        ("0.5", "'0.5'.*must be numbers"),
        (None, "None.*must be numbers"),
        (True, "True.*must be numbers"),
        (1j, "1.j.*must be numbers"),
    ],
    "discrete": [
        (3, "3.*: each must be a whole number from 0 to 2"),
        (-1, "-1.*: each must be a whole number from 0 to 2"),
        (1.0, "1.*must be whole numbers"),
        (NAN, "nan.*must be whole numbers"),
        (True, "True.*must be whole numbers"),
        ([1, 1], "shape \\(2,\\): must be 1 whole numbers from 0 to 2"),
        ([[1]], "shape \\(1, 1\\): must be 1 whole numbers"),
    ],
}


@pytest.mark.parametrize(("kind", "action", "message"), [(k, *bad) for k, some in BAD_ACTIONS.items() for bad in some])
def test_a_bad_action_raises_and_moves_nothing(kind, action, message):
    env, untouched = (PaddleEnv(action=kind) for _ in range(2))
    env.reset(seed=1), untouched.reset(seed=1)
    with pytest.raises(ValueError, match=message):
        env.step(action)
    assert_same(env.step(1), untouched.step(1))


@pytest.mark.parametrize(
    ("kind", "actions", "message"),
    [
        ("continuous", [0, NAN, 0], "actions\\[1\\] = nan: must be finite"),
        ("continuous", [0, 0, INF], "actions\\[2\\] = inf: must be finite"),
        ("continuous", [[0, 0, 0]], "shape \\(1, 3\\): must be 3 numbers, one per world"),
        ("continuous", [[0, 0]] * 3, "shape \\(3, 2\\): must be 3 numbers, one per world"),
        ("continuous", 0.5, "shape \\(\\): must be 3 numbers, one per world"),
        ("discrete", [0, 1, 3], "3\\].*: each must be a whole number from 0 to 2"),
        ("discrete", [0.0, 1.0, 2.0], "must be whole numbers"),
        ("discrete", 1, "shape \\(\\): must be 3 whole numbers from 0 to 2, one per world"),
        ("discrete", [0, 1], "shape \\(2,\\): must be 3 whole numbers from 0 to 2, one per world"),
    ],
)
@pytest.mark.parametrize("threads", [1, 2])
def test_one_bad_action_moves_no_world(kind, actions, message, threads):
    envs, untouched = (PaddleVectorEnv(3, action=kind, num_threads=threads) for _ in range(2))
    envs.reset(seed=1), untouched.reset(seed=1)
    with pytest.raises(ValueError, match=message):
        envs.step(actions)
    good = np.array([0, 1, 1])
    assert_same(envs.step(good), untouched.step(good))


BAD_OPTIONS = [
    ({"level": 1}, "options\\['level'\\]: must be one of position, velocity"),
    ({"snapshot": b""}, "options\\['snapshot'\\]: must come without seed"),
    ({"level": 3}, "options\\['level'\\]: must be one of position, velocity"),
    ({"position": (0.5, 0.8)}, "\\(0.5, 0.8\\) overlaps .*bumper_bottom.* at least 0.08 m away"),
    ({"position": (0.01, 0.6)}, "\\(0.01, 0.6\\) overlaps .*'left'.* at least 0.02 m away"),
    ({"position": (0.5, 0.09)}, "\\(0.5, 0.09\\) overlaps .*'paddle'"),
    ({"position": (1.5, 0.6)}, "options\\['position'\\] = \\(1.5, 0.6\\): must be on the field, x 0 to 1 "),
    ({"position": (0.05, -0.03)}, "\\(0.05, -0.03\\): must be on the field, .* y -0.01"),  # it would never drain
    ({"position": (0.5, 9.0)}, "\\(0.5, 9.0\\): must be on the field, .* to 1.4"),
    ({"position": (0.5, NAN)}, "options\\['position'\\] = \\(0.5, nan\\): must be finite"),
    ({"position": (0.5, 0.6, 0.7)}, "options\\['position'\\] = \\(0.5, 0.6, 0.7\\): must be a pair"),
    ({"position": "middle"}, "options\\['position'\\] = 'middle': must be a pair of numbers"),
    ({"position": None}, "options\\['position'\\] = None: must be a pair of numbers"),
    ({"position": (9, 9)}, "options\\['position'\\] = \\(9, 9\\): must be on the field"),
    ({"position": ("0.5", "0.6")}, "must be a pair of numbers"),
    ({"position": (10**400, 0.6)}, "options\\['position'\\] = .*: must be finite"),
    (
        {"postion": (0.5, 0.6)},
        "options\\['postion'\\] \\(did you mean 'position'\\?\\): must be one of position, velocity",
    ),
    (3, "options = 3: must be None or a dict"),
    ({"velocity": (3.0, 0.1)}, "options\\['velocity'\\] = \\(3.0, 0.1\\): must be at most 3.0 m/s"),
    ({"velocity": (INF, 0.0)}, "options\\['velocity'\\] = \\(inf, 0.0\\): must be finite"),
    ({"velocity": 1.0}, "options\\['velocity'\\] = 1.0: must be a pair"),
]


@pytest.mark.parametrize(("options", "message"), BAD_OPTIONS)
def test_a_bad_reset_option_raises_and_resets_nothing(options, message):
    env, untouched = PaddleEnv(), PaddleEnv()
    env.reset(seed=1), untouched.reset(seed=1)
    with pytest.raises(ValueError, match=message):
        env.reset(seed=2, options=options)
    for seed in (-1, 1.5, "1", True):
        with pytest.raises(ValueError, match=rf"seed = {seed!r}: must be None or an integer >= 0"):
            env.reset(seed=seed)
    assert_same(env.step([0.5]), untouched.step([0.5]))
    assert_same(env.reset(), untouched.reset())


TWO = np.array([True, True])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        *BAD_OPTIONS,
        ({"position": [(0.5, 0.6)] * 3}, "must be a pair of numbers, or one for each of 2 worlds"),
        ({"position": [(0.5, 0.6), (0.5, 0.8)]}, "\\(0.5, 0.8\\) overlaps"),
        ({"reset_mask": [True, False]}, "options\\['reset_mask'\\] = \\[True, False\\]: must be a bool array"),
        ({"reset_mask": np.ones(3, bool)}, "options\\['reset_mask'\\] .* shape \\(2,\\)"),
        ({"reset_mask": np.ones(2)}, "options\\['reset_mask'\\] = .*: must be a bool array"),
        ({"reset_mask": ~TWO}, "options\\['reset_mask'\\]: must be True for at least one world"),
        ({"reset_mask": TWO, "level": 1}, "options\\['level'\\]: must be one of position, velocity"),
    ],
)
def test_a_bad_reset_option_resets_no_world(options, message):
    envs, untouched = PaddleVectorEnv(2), PaddleVectorEnv(2)
    envs.reset(seed=1), untouched.reset(seed=1)
    with pytest.raises(ValueError, match=message):
        envs.reset(seed=2, options=options)
    assert_same(envs.step([0.5, 0.5]), untouched.step([0.5, 0.5]))
    assert_same(envs.reset(), untouched.reset())


@pytest.mark.parametrize(
    ("seed", "error", "message"),
    [
        (-1, gym.error.Error, "-1"),
        ([5, -7], gym.error.Error, "-7"),
        ([5, 0.5], gym.error.Error, "integer"),
        ([5], ValueError, "seed: must be one number, or 2, one per world; got 1"),
    ],
)
def test_a_bad_seed_seeds_no_world(seed, error, message):
    envs, untouched = PaddleVectorEnv(2), PaddleVectorEnv(2)
    envs.reset(seed=1), untouched.reset(seed=1)
    with pytest.raises(error, match=message):
        envs.reset(seed=seed)
    assert_same(envs.reset(), untouched.reset())


def test_a_single_env_that_is_not_running_asks_for_a_reset():
    env = PaddleEnv(time_limit=0.05, render_mode="rgb_array")
    with pytest.raises(gym.error.ResetNeeded, match=r"reset\(\)"):
        env.step([0.0])
    with pytest.raises(gym.error.ResetNeeded, match=r"reset\(\)"):
        env.render()
    env.reset(seed=0)
    while not env.step([0.0])[3]:
        pass
    with pytest.raises(gym.error.ResetNeeded, match=r"reset\(\)"):
        env.step([0.0])


def test_a_vector_env_that_is_not_running_asks_for_a_reset():
    envs = PaddleVectorEnv(2, render_mode="rgb_array")
    for call in (lambda: envs.step([0.0, 0.0]), envs.render):
        with pytest.raises(gym.error.ResetNeeded, match=r"reset\(\)"):
            call()
    envs.reset(options={"reset_mask": np.array([True, False])})
    with pytest.raises(gym.error.ResetNeeded, match=r"reset\(\)"):
        envs.step([0.0, 0.0])


def test_rendering_without_a_mode_warns_how_to_choose_one():
    for env in (PaddleEnv(), PaddleVectorEnv(2)):
        env.reset(seed=0)
        with pytest.warns(UserWarning, match="rgb_array"):
            assert env.render() is None
