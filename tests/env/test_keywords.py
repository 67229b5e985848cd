"""Every keyword with every other one: both checkers find nothing, and what cannot be is refused in our own words."""

import itertools
import math
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
import stable_baselines3.common.env_checker
from allpairspy import AllPairs
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import check_env

from bounce_env import load_scene
from bounce_env.envs.paddle import PaddleEnv
from bounce_env.envs.pinball import PinballEnv
from bounce_env.envs.walls import WallsEnv
from bounce_env.scene import dump_scene, scene_to_dict
from tests.conftest import soak_count
from tests.env.rollouts import PADDLE, PINBALL, WALLS, assert_same

NAMES = {PADDLE: "paddle", PINBALL: "pinball", WALLS: "walls"}
FORMS = ("default", "name", "text path", "path", "object", "dict")
COMMON = {
    "scene": FORMS,
    "frame_skip": (2, 1, 7),
    "repeat_action_probability": (0.0, 0.25),
    "time_limit": (30.0, 5.0, None),
    "obs": ("state", "pixels"),
    "render_mode": (None, "rgb_array", "human"),
    "record_events": (False, True),
    "width": (None, 60),
    "height": (None, 90),
    "obs_width": (None, 40),
    "obs_height": (None, 80),
    "grayscale": (False, True),
    "trail": (0.0, 0.3),
    "show_bounces": (False, True),
    "max_episode_steps": (None, 6),
}
KEYWORDS = {
    PADDLE: COMMON
    | {
        "action": ("continuous", "discrete"),
        "reward": ("score", "dense"),
        "gamma": (0.99, 1.0),
        "num_levels": (None, 0, 20),
        "start_level": (0, 7),
    },
    PINBALL: COMMON
    | {"action": ("discrete", "buttons"), "reward": ("dense", "score"), "nudge": (False, True), "balls": (3, 1)},
    WALLS: COMMON | {"reward": ("sparse", "dense"), "gamma": (0.99, 0.5), "balls": (5, 1)},
}
TRIPLES = soak_count(0, 1)  # pairs; in a soak triples
PYDANTICS = ["validation error", "input_value", "type=", "pydantic"]


def combinations():
    """(id, keywords) such that any two values of any two keywords come together; in a soak any three of any three."""
    for env_id, keywords in KEYWORDS.items():
        for values in triples(list(keywords.values())) if TRIPLES else AllPairs(list(keywords.values())):
            yield env_id, dict(zip(keywords, values, strict=True))


def triples(options):
    """Each value of each keyword with all pairs of those after it (the library's own triples are not complete)."""
    turn = itertools.count()
    for i, values in enumerate(options[:-2]):
        for value, later in itertools.product(values, list(AllPairs(options[i + 1 :]))):
            yield [*(earlier[next(turn) % len(earlier)] for earlier in options[:i]), value, *later]


def impossible(keywords) -> str | None:
    """The keyword that is refused, if any is."""
    if keywords["obs"] == "state" and keywords["obs_width"] is not None:
        return "obs_width"
    if keywords["obs"] == "state" and keywords["obs_height"] is not None:
        return "obs_height"
    if keywords["obs"] == "state" and keywords["grayscale"]:
        return "grayscale"
    if keywords.get("start_level") and keywords["num_levels"] is None:
        return "start_level"
    return None


def of_scene(env_id: str, form: str, folder: Path):
    """The game's scene in a form that the keyword takes."""
    name = NAMES[env_id]
    scene = load_scene(name)
    path = folder / f"{name}.toml"
    path.write_text(dump_scene(scene))
    forms = (None, name, str(path), path, scene, scene_to_dict(scene))
    return dict(zip(FORMS, forms, strict=True))[form]


@pytest.fixture(autouse=True)
def without_a_window(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


def shown(value) -> str | None:
    if isinstance(value, dict):
        return "-".join(str(v) for v in value.values())
    return None


@pytest.mark.filterwarnings("ignore:.*render:UserWarning")  # Gymnasium's, of render_mode None
@pytest.mark.parametrize(("env_id", "keywords"), list(combinations()), ids=shown)
def test_both_checkers_find_nothing_and_a_spec_makes_it_again(env_id, keywords, tmp_path):
    given = {**keywords, "scene": of_scene(env_id, keywords["scene"], tmp_path)}
    refused = impossible(keywords)
    if refused is not None:
        with pytest.raises(ValueError, match=f"{refused} = ") as error:
            gym.make(env_id, **given)
        assert not any(word in str(error.value) for word in PYDANTICS)
        return
    made = gym.make(env_id, **given, disable_env_checker=True)
    check_env(made.unwrapped)
    stable_baselines3.common.env_checker.check_env(made.unwrapped, warn=True)
    again = gym.make(EnvSpec.from_json(made.spec.to_json()))
    assert again.spec.kwargs == made.spec.kwargs
    assert_same(again.reset(seed=4), made.reset(seed=4))
    made.action_space.seed(1)
    for _ in range(8):
        action = made.action_space.sample()
        step = made.step(action)
        assert_same(again.step(action), step)
        if step[2] or step[3]:
            assert step[4]["end_reason"] is not None
            break
    if keywords["max_episode_steps"] is not None:
        assert step[3]
    made.close(), again.close()


@pytest.mark.parametrize("env_type", [PaddleEnv, PinballEnv, WallsEnv])
def test_every_keyword_is_tried_and_named_on_the_card(env_type):
    env_id = f"Bounce/{env_type.__name__.removesuffix('Env')}-v0"
    assert set(KEYWORDS[env_id]) == {*env_type.defaults(), "max_episode_steps"}
    listed = env_type.__doc__.partition("Keyword arguments:")[2]
    for keyword in env_type.defaults():
        assert f"`{keyword}`" in listed


def test_any_two_values_are_tried_together_and_in_a_soak_any_three():
    """Of the tests above, not of the library that chooses them."""
    chosen = [keywords for env_id, keywords in combinations() if env_id == PADDLE]
    for names in itertools.combinations(KEYWORDS[PADDLE], 3 if TRIPLES else 2):
        seen = {tuple(repr(keywords[name]) for name in names) for keywords in chosen}
        assert len(seen) == math.prod(len(KEYWORDS[PADDLE][name]) for name in names)


def test_a_spec_with_a_scene_of_ones_own_needs_no_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(dump_scene(load_scene("paddle")).replace("gravity = [0.0, -1.5]", "gravity = [0.0, -1.25]"))
    for scene in (path, str(path), load_scene(path)):
        env = gym.make(PADDLE, scene=scene)
        vector = gym.make_vec(PADDLE, 2, vectorization_mode="vector_entry_point", scene=scene, num_threads=np.int64(2))
        texts = env.spec.to_json(), vector.spec.to_json()
        path.rename(tmp_path / "gone.toml")
        single, both = gym.make(EnvSpec.from_json(texts[0])), gym.make_vec(EnvSpec.from_json(texts[1]))
        assert single.unwrapped.scene == env.unwrapped.scene
        assert both.get_attr("scene") == vector.get_attr("scene") if both.reset() and vector.reset() else False
        assert single.unwrapped.scene.gravity == (0.0, -1.25)
        (tmp_path / "gone.toml").rename(path)
