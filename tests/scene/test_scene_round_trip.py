"""A scene written as TOML and read back is the same scene, to the bit."""

import math
import tomllib
from dataclasses import replace

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from bounce_env.scene import (
    Arc,
    Ball,
    Bumper,
    Field,
    Flipper,
    Paddle,
    Scene,
    Sensor,
    Wall,
    builtin_scenes,
    dump_scene,
    load_scene,
    scene_from_dict,
)
from tests.conftest import soak_count

pytestmark = pytest.mark.fast


def polygon(corners: int, center: tuple[float, float], radius: float) -> list[tuple[float, float]]:
    angles = [2 * math.pi * i / corners for i in range(corners)]
    return [(center[0] + radius * math.cos(angle), center[1] + radius * math.sin(angle)) for angle in angles]


# Sizes are such that no scene is refused; the digits of all numbers are arbitrary.
SIZE = st.floats(0.01, 10.0)
FACTOR = st.floats(0.0, 10.0)
POINT = st.tuples(st.floats(-100.0, 100.0), st.floats(-100.0, 100.0))
SEGMENT = st.tuples(POINT, POINT).filter(lambda ends: abs(ends[0][0] - ends[1][0]) > 0.01)
SURFACE = {"b": FACTOR, "f": st.floats(0.0, 1.0), "kick": FACTOR, "kick_threshold": FACTOR, "cooldown": FACTOR}
NAME = st.text(st.characters(exclude_categories=["C", "Z"]) | st.sampled_from(" \"'\\#=[]"), min_size=1, max_size=8)
ELEMENT = st.one_of(
    st.builds(lambda ends, **fields: Wall(*ends, **fields), SEGMENT, one_way=st.booleans(), **SURFACE),
    st.builds(
        lambda ends, low, high, **fields: Wall(*ends, draggable=True, reach=(low, high), **fields),
        SEGMENT,
        st.tuples(st.floats(-200.0, -100.0), st.floats(-200.0, -100.0)),
        st.tuples(st.floats(100.5, 200.0), st.floats(100.5, 200.0)),
        min_length=st.none() | st.floats(0.001, 0.01),
        **SURFACE,
    ),
    st.builds(Bumper, POINT, SIZE, **SURFACE),
    st.builds(
        lambda center, radius, start, span, **fields: Arc(center, radius, start, start + span, **fields),
        POINT,
        st.floats(11.0, 20.0),  # no ball is as large
        st.floats(-10.0, 10.0),
        st.floats(0.01, 6.28) | st.just(2 * math.pi),
        **SURFACE,
    ),
    st.builds(
        lambda ends, **fields: Paddle(*ends, **fields),
        SEGMENT,
        half_width=st.just(0.0) | SIZE,
        radius=SIZE,
        max_speed=SIZE,
        **SURFACE,
    ),
    st.builds(
        lambda ends, **fields: Bumper(ends[0], rail_end=ends[1], **fields),
        SEGMENT,
        radius=SIZE,
        speed=SIZE,
        **SURFACE,
    ),
    st.builds(
        lambda rest, stroke, **fields: Flipper(rest_angle=rest, active_angle=rest + stroke, **fields),
        st.floats(-10.0, 10.0),
        st.floats(0.01, 6.28) | st.floats(-6.28, -0.01),
        pivot=POINT,
        length=SIZE,
        radius=SIZE,
        up_speed=SIZE,
        down_speed=SIZE,
        **SURFACE,
    ),
    st.builds(lambda ends, drain: Sensor(*ends, drain=drain), SEGMENT, st.booleans()),
    st.builds(
        lambda center, radius, drain: Sensor(center=center, radius=radius, drain=drain), POINT, SIZE, st.booleans()
    ),
    st.builds(
        lambda corners, center, radius, acceleration: Field(polygon(corners, center, radius), acceleration),
        st.integers(3, 8),
        POINT,
        SIZE,
        POINT,
    ),
)
SCENE = st.builds(
    lambda elements, names, **fields: Scene(
        elements=[replace(element, name=name) for element, name in zip(elements, names, strict=False)],
        **fields,
    ),
    st.lists(ELEMENT, max_size=6),
    st.lists(NAME, min_size=6, max_size=6, unique=True),
    gravity=POINT,
    ball=st.builds(Ball, st.just(0.0) | SIZE, FACTOR, st.floats(0.0, 1.0)),
    rest_speed=st.just(0.0) | SIZE,
    max_speed=st.floats(200.0, 1e9, exclude_min=True),
    drag=st.floats(0.01, 1.0),
)


def read_back(scene: Scene) -> Scene:
    return scene_from_dict(tomllib.loads(dump_scene(scene)))


@settings(max_examples=soak_count(100, 5000), derandomize=True, deadline=None)
@given(SCENE)
@example(Scene(elements=[Sensor((0, 0), (1, 0), name=r'a "b" \n # = [c]')]))
def test_any_scene_comes_back(scene):
    assert read_back(scene) == scene
    assert repr(read_back(scene)) == repr(scene)  # every digit of every float


@pytest.mark.parametrize("name", builtin_scenes())
def test_built_in_scenes_come_back_from_a_file(name, tmp_path):
    path = tmp_path / "copy.toml"
    path.write_text(dump_scene(load_scene(name)), encoding="utf-8")
    assert load_scene(path) == load_scene(name)


def test_the_smallest_scene_comes_back():
    assert read_back(Scene()) == Scene()
