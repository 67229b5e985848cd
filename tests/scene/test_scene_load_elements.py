"""Arcs, fields, circular sensors and one-way walls in TOML: read as they say, refused by name."""

import re
from pathlib import Path

import pytest

from bounce_env.scene import Arc, Bumper, Field, Flipper, Paddle, Scene, SceneError, Sensor, Wall, load_scene

pytestmark = pytest.mark.fast

POINT = "two numbers [x, y], each from -1e+09 to 1e+09"
POINTS = "at least 3 points [x, y], each number from -1e+09 to 1e+09"
ANGLE = "a number of radians, from -100 to 100"
POSITIVE = "a number > 0 (from 1e-09 to 1e+09)"
ZERO_OR_MORE = "a number >= 0 (at most 1e+09)"
FORMS = "a sensor is a segment (start and end) or a circle (center and radius)"
CONVEX = "must be the corners of a strictly convex polygon, in order around it: "
SIZES = "in a scene whose longer side is 100 m and whose largest coordinate is 100 m"

ARC = "center = [0, 0]\nradius = 1\nstart_angle = 0\n"
SQUARE = "points = [[0, 0], [1, 0], [1, 1], [0, 1]]\n"
PUSH = "acceleration = [0, 1]\n"
CIRCLE = "center = [3, 4]\nradius = 1\n"


def element(kind: str, fields: str) -> str:
    return f'[[elements]]\ntype = "{kind}"\nname = "it"\n{fields}\n'


WIDE = '[[elements]]\ntype = "wall"\nstart = [0, 0]\nend = [0, 100]\n'


@pytest.fixture
def problems(tmp_path, monkeypatch):
    """The lines of the error that a file of this text gives."""
    monkeypatch.chdir(tmp_path)

    def lines(text: str) -> list[str]:
        Path("mytable.toml").write_text(text)
        with pytest.raises(SceneError) as caught:
            load_scene("mytable.toml")
        # Which line each names is asked in `test_scene_places`.
        return [re.sub(r"^mytable\.toml:\d+:", "mytable.toml:", line) for line in str(caught.value).split("\n")]

    return lines


WRITTEN = [
    (
        """type = "arc"\ncenter = [1, 2]\nradius = 3\nstart_angle = 0.5\nend_angle = 3\nname = "arch"
        b = 0.5\nf = 0.25\nkick = 2\nkick_threshold = 1\ncooldown = 0.125""",
        Arc((1, 2), 3, 0.5, 3, b=0.5, f=0.25, kick=2, kick_threshold=1, cooldown=0.125, name="arch"),
    ),
    (
        """type = "arc"\ncenter = [1, 2]\nradius = 1\nstart_angle = 0\nend_angle = 6.283185307179586""",
        Arc((1, 2), 1, 0, 6.283185307179586),
    ),
    (
        """type = "field"\npoints = [[0, 0], [1, 0], [0.5, 2]]\nacceleration = [0.5, -3]\nname = "wind" """,
        Field(((0, 0), (1, 0), (0.5, 2)), (0.5, -3), name="wind"),
    ),
    (
        """type = "sensor"\ncenter = [2, 2]\nradius = 0.25\ndrain = true\nname = "hole" """,
        Sensor(center=(2, 2), radius=0.25, drain=True, name="hole"),
    ),
    (
        """type = "wall"\nstart = [0, 0]\nend = [1, 0]\none_way = true\ncooldown = 0.5""",
        Wall((0, 0), (1, 0), one_way=True, cooldown=0.5),
    ),
    (
        """type = "wall"\nstart = [0, 1]\nend = [1, 1]\ndraggable = true
        min_length = 0.25\nreach = [[-1, 0], [2, 3]]""",
        Wall((0, 1), (1, 1), draggable=True, min_length=0.25, reach=((-1, 0), (2, 3))),
    ),
    (
        """type = "bumper"\ncenter = [5, 5]\nradius = 1\ncooldown = 0.5""",
        Bumper((5, 5), 1, cooldown=0.5),
    ),
    (
        """type = "bumper"\ncenter = [5, 5]\nradius = 1\nrail_end = [7, 5]\nspeed = 2""",
        Bumper((5, 5), 1, rail_end=(7, 5), speed=2),
    ),
    (
        """type = "paddle"\nrail_start = [1, 0]\nrail_end = [4, 0]\nhalf_width = 0.5\nradius = 0.125
        max_speed = 3\ncooldown = 1""",
        Paddle((1, 0), (4, 0), half_width=0.5, radius=0.125, max_speed=3, cooldown=1),
    ),
    (
        """type = "flipper"\npivot = [0, 0]\nlength = 1\nradius = 0.125\nrest_angle = -0.5\nactive_angle = 0.5
        up_speed = 2\ndown_speed = 1""",
        Flipper((0, 0), 1, radius=0.125, rest_angle=-0.5, active_angle=0.5, up_speed=2, down_speed=1),
    ),
]


def test_a_file_gives_the_elements_that_it_says(tmp_path):
    path = tmp_path / "table.toml"
    texts = [f"[[elements]]\n{text}" for text, _ in WRITTEN]
    path.write_text("\n".join(["rest_speed = 0.02", "drag = 0.999", "max_speed = 5", *texts]))
    arch, ring, *_ = elements = tuple(element for _, element in WRITTEN)
    assert load_scene(path) == Scene(rest_speed=0.02, drag=0.999, max_speed=5, elements=elements)
    assert (arch.closed, ring.closed) == (False, True)


@pytest.mark.parametrize(
    ("text", "where", "message"),
    [
        (element("arc", ARC), "(arc 'it'): end_angle", f"required: {ANGLE}"),
        (element("arc", f"{ARC}end_angle = nan"), "(arc 'it'): end_angle = nan", f"must be {ANGLE}"),
        (element("arc", f"{ARC}end_angle = [1]"), "(arc 'it'): end_angle = [1]", f"must be {ANGLE}"),
        (
            element("arc", f"{ARC}end_angle = 180"),
            "(arc 'it'): end_angle = 180",
            f"must be {ANGLE}",
        ),
        (
            element("arc", f"{ARC}end_angle = 45"),  # degrees
            "(arc 'it'): end_angle = 45",
            "must be more than start_angle = 0.0, by 1e-06 to 2 pi radians (to 6.283185307179586)",
        ),
        (
            element("arc", f"{ARC}end_angle = 0.0"),
            "(arc 'it'): end_angle = 0.0",
            "must be more than start_angle = 0.0, by 1e-06 to 2 pi radians (to 6.283185307179586)",
        ),
        (
            element("arc", f"{ARC}end_angle = 6.2831853"),
            "(arc 'it'): end_angle = 6.2831853",
            "must be start_angle + 2 pi = 6.283185307179586 for a closed circle, or less by 1e-06 or more",
        ),
        (
            element("arc", f"{ARC}end_angle = 1\nspan = 3"),
            "(arc 'it'): span = 3",
            "unknown field: must be one of center, radius, start_angle, end_angle, "
            "b, f, kick, kick_threshold, cooldown, name",
        ),
        (
            element("arc", f"{ARC}end_angle = 1\ncooldown = -1"),
            "(arc 'it'): cooldown = -1",
            f"must be {ZERO_OR_MORE}",
        ),
        (
            WIDE + element("arc", "center = [0, 0]\nradius = 1e-5\nstart_angle = 0\nend_angle = 1"),
            "(arc 'it'): radius = 1e-5",
            f"must be at least 0.0001 m, {SIZES}",
        ),
        (element("field", PUSH), "(field 'it'): points", f"required: {POINTS}"),
        (element("field", SQUARE), "(field 'it'): acceleration", f"required: {POINT}"),
        (
            element("field", f"{PUSH}points = [[0, 0], [1, 0]]"),
            "(field 'it'): points = [[0, 0], [1, 0]]",
            f"must be {POINTS}",
        ),
        (
            element("field", f"{PUSH}points = [[0, 0], [1, 0], [1, true]]"),
            "(field 'it'): points = [[0, 0], [1, 0], [1, true]]",
            f"must be {POINTS}",
        ),
        (
            element("field", f"{PUSH}points = [[0, 0], [2, 0], [0.5, 0.5], [0, 2]]"),
            "(field 'it'): points = [[0, 0], [2, 0], [0.5, 0.5], [0, 2]]",
            f"{CONVEX}not so at [0.5, 0.5]",
        ),
        (
            element("field", f"{PUSH}points = [[0, 0], [2, 0], [2, 2], [1, 2], [0, 2]]"),
            "(field 'it'): points = [[0, 0], [2, 0], [2, 2], [1, 2], [0, 2]]",
            f"{CONVEX}not so at [1.0, 2.0]",
        ),
        (
            WIDE + element("field", f"{PUSH}points = [[0, 0], [2, 0], [1, 1e-8]]"),
            "(field 'it'): points = [[0, 0], [2, 0], [1, 1e-8]]",
            "must be such that [1.0, 1e-08] is at least 1e-07 m off the line through the corners beside it, " + SIZES,
        ),
        (
            element("field", f"{PUSH}{SQUARE}b = 1"),
            "(field 'it'): b = 1",
            "unknown field: must be one of points, acceleration, name",
        ),
        (element("sensor", ""), "(sensor 'it'): start", f"required: {POINT}; {FORMS}"),
        (element("sensor", "center = [0, 0]"), "(sensor 'it'): radius", f"required: {POSITIVE}; {FORMS}"),
        (element("sensor", "radius = 1"), "(sensor 'it'): center", f"required: {POINT}; {FORMS}"),
        (element("sensor", "end = [0, 0]"), "(sensor 'it'): start", f"required: {POINT}; {FORMS}"),
        (
            element("sensor", "start = [0, 0]\nend = [1, 0]\nradius = 1"),
            "(sensor 'it'): radius = 1",
            f"must be left out: {FORMS}",
        ),
        (
            element("sensor", "center = [3, 4]\nradius = 0"),
            "(sensor 'it'): radius = 0",
            f"must be {POSITIVE}",
        ),
        (
            WIDE + element("sensor", "center = [3, 4]\nradius = 1e-5"),
            "(sensor 'it'): radius = 1e-5",
            f"must be at least 0.0001 m, {SIZES}",
        ),
        (
            element("wall", "start = [0, 0]\nend = [1, 0]\none_way = 1"),
            "(wall 'it'): one_way = 1",
            "must be true or false",
        ),
    ],
)
def test_what_is_wrong_is_named(problems, text, where, message):
    index = text.count("[[elements]]") - 1
    assert problems(text) == [f"mytable.toml: elements[{index}] {where}: {message}"]


def test_all_errors_of_new_elements_are_reported(problems):
    text = (
        "rest_speed = true\ndrag = 0\n"
        + element("arc", "center = [0, 0]\nradius = 0\nstart_angle = 500\nend_angle = 1")
        + element("sensor", CIRCLE)
        + element("field", "points = 3")
    )
    assert problems(text) == [
        "mytable.toml: rest_speed = true: must be 0 or a number from 1e-09 to 1e+09",
        "mytable.toml: drag = 0: must be a number > 0 and <= 1 (at least 1e-09)",
        f"mytable.toml: elements[0] (arc 'it'): radius = 0: must be {POSITIVE}",
        f"mytable.toml: elements[0] (arc 'it'): start_angle = 500: must be {ANGLE}",
        f"mytable.toml: elements[2] (field 'it'): points = 3: must be {POINTS}",
        f"mytable.toml: elements[2] (field 'it'): acceleration: required: {POINT}",
    ]
