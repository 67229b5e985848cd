"""A TOML file is read strictly: what is wrong is named by file, element, field, value and what is allowed."""

import re
from pathlib import Path

import pytest

from bounce_env.scene import (
    Ball,
    Bumper,
    Paddle,
    Scene,
    SceneError,
    Sensor,
    Wall,
    builtin_scenes,
    load_scene,
    scene_from_dict,
)

pytestmark = pytest.mark.fast

POINT = "two numbers [x, y], each from -1e+09 to 1e+09"
ZERO_OR_MORE = "a number >= 0 (at most 1e+09)"
POSITIVE = "a number > 0 (from 1e-09 to 1e+09)"
WALL_FIELDS = "start, end, b, f, kick, kick_threshold, cooldown, name, one_way, draggable, min_length, reach"


def element(kind: str, fields: str) -> str:
    return f'[[elements]]\ntype = "{kind}"\n{fields}\n'


ENDS = "start = [0, 0]\nend = [1, 0]"
CENTER = "center = [0, 0]"
RAIL = "rail_start = [0, 0]\nrail_end = [0, 0]\nhalf_width = 1\nradius = 1\nmax_speed = 1"
FLOOR = element("wall", f'{ENDS}\nname = "floor"')
TYPES = "one of wall, bumper, arc, paddle, flipper, sensor, field"
SCENE_FIELDS = "unknown field: must be one of gravity, ball, rest_speed, max_speed, drag, elements"
BALL_FIELDS = "radius, b, f"


@pytest.fixture
def problems(tmp_path, monkeypatch):
    """The lines of the error that a file of this text gives."""
    monkeypatch.chdir(tmp_path)

    def lines(text: str | bytes) -> list[str]:
        Path("mytable.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
        with pytest.raises(SceneError) as caught:
            load_scene("mytable.toml")
        # Which line each names is asked in `test_scene_places`.
        return [re.sub(r"^mytable\.toml:\d+:", "mytable.toml:", line) for line in str(caught.value).split("\n")]

    return lines


def test_a_file_gives_the_scene_that_it_says(tmp_path):
    path = tmp_path / "table.toml"
    path.write_text(
        """
        gravity = [0, -2]
        max_speed = 9
        [ball]
        radius = 0.1
        b = 0.9
        f = 0.8
        [[elements]]
        type = "sensor"
        start = [0, -1]
        end = [5, -1]
        drain = true
        name = "drain"
        [[elements]]
        type = "wall"
        start = [0, 0]
        end = [0.5, 3]
        b = 0.5
        f = 0.25
        kick = 2
        kick_threshold = 1
        name = "left \\u00e4"
        [[elements]]
        type = "paddle"
        rail_start = [1, 0]
        rail_end = [4, 0]
        half_width = 0.5
        radius = 0.125
        max_speed = 3
        [[elements]]
        type = "bumper"
        center = [2, 2]
        radius = 0.5
        """
    )
    expected = Scene(
        gravity=(0, -2),
        max_speed=9,
        ball=Ball(0.1, 0.9, 0.8),
        elements=(
            Sensor((0, -1), (5, -1), drain=True, name="drain"),
            Wall((0, 0), (0.5, 3), b=0.5, f=0.25, kick=2, kick_threshold=1, name="left ä"),
            Paddle((1, 0), (4, 0), half_width=0.5, radius=0.125, max_speed=3),
            Bumper((2, 2), 0.5),
        ),
    )
    assert load_scene(path) == expected
    assert load_scene(str(path)) == expected


def test_a_file_without_anything_is_the_default_scene(tmp_path):
    (tmp_path / "empty.toml").write_text("")
    assert load_scene(tmp_path / "empty.toml") == Scene()


def test_a_byte_order_mark_is_let_pass(tmp_path):
    (tmp_path / "bom.toml").write_bytes(b"\xef\xbb\xbfmax_speed = 2.0\r\n")
    assert load_scene(tmp_path / "bom.toml") == Scene(max_speed=2.0)


@pytest.mark.parametrize(
    ("toml", "shown"),
    [
        ("true", "true"),
        ('"1"', '"1"'),
        ('""', '""'),
        ("nan", "nan"),
        ("-nan", "-nan"),
        ("inf", "inf"),
        ("-inf", "-inf"),
        ("-1.0", "-1.0"),
        ("-1", "-1"),
        ("1e300", "1e300"),
        ("[1.0]", "[1.0]"),
        ("[[1.0]]", "[[1.0]]"),
        ("{ value = 1 }", "{ value = 1 }"),
        ("1979-05-27", "1979-05-27"),
        ("1" + "0" * 400, "1" + "0" * 59 + "..."),
        ("0x" + "f" * 5000, "0x" + "f" * 58 + "..."),
        ('"' + "long" * 100 + '"', '"' + ("long" * 100)[:59] + "..."),
        ('"two\\nlines"', r'"two\nlines"'),
    ],
)
def test_a_field_that_is_no_number_is_named(problems, toml, shown):
    assert problems(f"{FLOOR}b = {toml}") == [
        f"mytable.toml: elements[0] (wall 'floor'): b = {shown}: must be {ZERO_OR_MORE}"
    ]
    assert problems(f"[ball]\nb = {toml}") == [f"mytable.toml: ball: b = {shown}: must be {ZERO_OR_MORE}"]
    assert problems(f"max_speed = {toml}") == [f"mytable.toml: max_speed = {shown}: must be {POSITIVE}"]


@pytest.mark.parametrize(
    ("toml", "shown"),
    [
        ("[0.0]", "[0.0]"),
        ("[0, 0, 0]", "[0, 0, 0]"),
        ("[]", "[]"),
        ("0.0", "0.0"),
        ('"12"', '"12"'),
        ("[0, nan]", "[0, nan]"),
        ("[inf, 0]", "[inf, 0]"),
        ("[0, true]", "[0, true]"),
        ('["0", 0]', '["0", 0]'),
        ("[[0, 0], [1, 1]]", "[[0, 0], [1, 1]]"),
        ("[2e9, 0]", "[2e9, 0]"),
        ("[0x" + "f" * 5000 + ", 0]", "[0x" + "f" * 57 + "..."),
        ("{ x = 1, y = 2 }", "{ x = 1, y = 2 }"),
    ],
)
def test_a_field_that_is_no_point_is_named(problems, toml, shown):
    assert problems(element("wall", f"end = [3, 3]\nstart = {toml}")) == [
        f"mytable.toml: elements[0] (wall): start = {shown}: must be {POINT}"
    ]
    assert problems(f"gravity = {toml}") == [f"mytable.toml: gravity = {shown}: must be {POINT}"]


@pytest.mark.parametrize(
    ("text", "where", "message"),
    [
        ("max_sped = 3", "max_sped = 3", SCENE_FIELDS.replace(":", " (did you mean 'max_speed'?):", 1)),
        ("[[element]]\na = 1", "element = [{'a': 1}]", SCENE_FIELDS.replace(":", " (did you mean 'elements'?):", 1)),
        ('"a\\nb" = 1', r"'a\nb' = 1", SCENE_FIELDS),
        ("rest_speed = -0.5", "rest_speed = -0.5", "must be 0 or a number from 1e-09 to 1e+09"),
        ("drag = 1.5", "drag = 1.5", "must be a number > 0 and <= 1 (at least 1e-09)"),
        ("ball = 3", "ball = 3", f"must be a table of {BALL_FIELDS}"),
        ("[[ball]]\nradius = 1", "ball = [{'radius': 1}]", f"must be a table of {BALL_FIELDS}"),
        ("[ball]\nmass = 1", "ball: mass = 1", f"unknown field: must be one of {BALL_FIELDS}"),
        ("[ball]\nradius = 1e-10", "ball: radius = 1e-10", "must be 0 or a number from 1e-09 to 1e+09"),
        ("[ball]\nf = 1.5", "ball: f = 1.5", "must be a number >= 0 and <= 1"),
        ("elements = 3", "elements = 3", "must be a list of tables, each under a line [[elements]]"),
        ("[elements]", "elements = {}", "must be a list of tables, each under a line [[elements]]"),
        ("elements = [3]", "elements[0] = 3", "must be a table, under a line [[elements]]"),
        ("elements = [[]]", "elements[0] = []", "must be a table, under a line [[elements]]"),
        ("[[elements]]", "elements[0]: type", f"required: {TYPES}"),
        ("[[elements]]\ntype = []", "elements[0]: type = []", f"must be {TYPES}"),
        (element("spring", ""), 'elements[0]: type = "spring"', f"must be {TYPES}"),
        (element("Wall", ENDS), 'elements[0]: type = "Wall"', f"must be {TYPES} (did you mean 'wall'?)"),
        (element("wall", "start = [0, 0]"), "elements[0] (wall): end", f"required: {POINT}"),
        (
            element("wall", f"{ENDS}\nlength = 1"),
            "elements[0] (wall): length = 1",
            f"unknown field (did you mean 'min_length'?): must be one of {WALL_FIELDS}",
        ),
        (
            element("wall", f"{ENDS}\n__dataclass_self__ = 1"),
            "elements[0] (wall): __dataclass_self__ = 1",
            f"unknown field: must be one of {WALL_FIELDS}",
        ),
        (
            element("wall", "start = [0, 0]\nend = [0.0, 0]"),
            "elements[0] (wall): end = [0.0, 0]",
            "must be at least 1e-09 m away from start = [0.0, 0.0]",
        ),
        (
            element("paddle", RAIL),
            "elements[0] (paddle): rail_end = [0, 0]",
            "must be at least 1e-09 m away from rail_start = [0.0, 0.0]",
        ),
        (
            element("bumper", f"{CENTER}\nradius = -1"),
            "elements[0] (bumper): radius = -1",
            f"must be {POSITIVE}",
        ),
        (
            element("bumper", f'{CENTER}\nname = "b"'),
            "elements[0] (bumper 'b'): radius",
            f"required: {POSITIVE}",
        ),
        (
            element("sensor", f"{ENDS}\ndrain = 1"),
            "elements[0] (sensor): drain = 1",
            "must be true or false",
        ),
        (
            element("sensor", f"{ENDS}\nb = 1"),
            "elements[0] (sensor): b = 1",
            "unknown field: must be one of start, end, center, radius, drain, name",
        ),
        (element("sensor", f"{ENDS}\nname = 3"), "elements[0] (sensor): name = 3", "must be printable text"),
        (
            FLOOR + FLOOR,
            "elements[1] (wall 'floor'): name = \"floor\"",
            "must be unique, but is also the name of elements[0] (wall 'floor')",
        ),
        (
            element("wall", f"{ENDS}\nkick = 2"),
            "max_speed",
            "required: a number > 0, because elements[0] (wall) has kick = 2.0, "
            "so that bounces may add speed without limit",
        ),
        (
            element("wall", f"{ENDS}\nb = 1.5"),
            "max_speed",
            "required: a number > 0, because elements[0] (wall) has b = 1.5, "
            "times ball.b = 1.0 is more than 1, so that bounces may add speed without limit",
        ),
        (
            f"[ball]\nradius = 1e-7\n{FLOOR}",
            "ball: radius = 1e-7",
            "must be 0 or at least 1e-06 m, in a scene whose longer side is 1 m and whose largest coordinate is 1 m",
        ),
    ],
)
def test_what_is_wrong_is_named(problems, text, where, message):
    assert problems(text) == [f"mytable.toml: {where}: {message}"]


def test_all_errors_of_a_file_are_reported(problems):
    text = "gravity = [0, nan]\n" + FLOOR + "b = -1.0\ncolour = 3\n" + element("bumper", f"{CENTER}\nradius = true")
    assert problems(text) == [
        f"mytable.toml: gravity = [0, nan]: must be {POINT}",
        f"mytable.toml: elements[0] (wall 'floor'): b = -1.0: must be {ZERO_OR_MORE}",
        f"mytable.toml: elements[0] (wall 'floor'): colour = 3: unknown field: must be one of {WALL_FIELDS}",
        f"mytable.toml: elements[1] (bumper): radius = true: must be {POSITIVE}",
    ]


def test_errors_of_the_whole_are_reported_beside_those_of_the_parts(problems):
    # elements[0] is refused and left out: the others keep their own indices
    small = element("bumper", f"{CENTER}\nradius = 1e-7")
    text = "gravity = 3\n" + element("wall", "") + FLOOR + FLOOR + "kick = 1\n" + small
    lines = problems(text)
    assert [re.sub(r" = .*|: required.*", "", line) for line in lines] == [
        "mytable.toml: gravity",
        "mytable.toml: elements[0] (wall): start",
        "mytable.toml: elements[0] (wall): end",
        "mytable.toml: elements[2] (wall 'floor'): name",
        "mytable.toml: elements[3] (bumper): radius",
        "mytable.toml: max_speed",
    ]
    assert "also the name of elements[1] (wall 'floor')" in lines[3]
    assert "because elements[2] (wall 'floor') has kick = 1.0" in lines[5]


def test_a_refused_field_raises_no_second_complaint(problems):
    # neither "max_speed required" when the one given is refused, nor a product with a ball that is refused
    bouncy = FLOOR + "b = 1.5\n"
    assert problems(f"max_speed = -3\n{bouncy}") == [f"mytable.toml: max_speed = -3: must be {POSITIVE}"]
    assert problems(f"{bouncy}[ball]\nb = -0.1") == [f"mytable.toml: ball: b = -0.1: must be {ZERO_OR_MORE}"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("gravity = [0, -1]\nmax_speed = = 3", r"is not a TOML file: .*\(at line 2, column 13\)"),
        ("max_speed = 3\nmax_speed = 4\n\n", r"is not a TOML file: .*\(at line 2, column 14\)"),
        ("a = " + "[" * 5000, "is not a TOML file: "),
        ("max_speed = 1" + "0" * 5000, "is not a TOML file: .*digits"),
        (b"\xff\xfe", "is not a TOML file: has a byte that is no UTF-8: 'utf-8' codec"),
    ],
)
def test_a_file_that_is_not_toml(problems, text, message):
    [line] = problems(text)
    assert re.match(f"mytable.toml: {message}", line)


@pytest.mark.parametrize("source", ["missing.toml", "no/such", "no/such.toml", ".", "./", "nul\0.toml"])
def test_a_file_that_cannot_be_read(tmp_path, monkeypatch, source):
    monkeypatch.chdir(tmp_path)
    path = Path(source) if source == "." else source
    with pytest.raises(SceneError, match="cannot be read: ") as caught:
        load_scene(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("source", [None, 0, b"paddle", 1.0, ["paddle"]])
def test_a_source_that_is_neither_name_nor_path(source):
    with pytest.raises(SceneError, match=r"must be the name of a scene or the path of a \.toml file"):
        load_scene(source)


@pytest.mark.parametrize("name", ["padle", "", "Paddle", "..", "paddle.tom"])
def test_an_unknown_name_lists_the_built_in_scenes(name):
    with pytest.raises(SceneError) as caught:
        load_scene(name)
    known = ", ".join(builtin_scenes())
    assert str(caught.value).startswith(f"scene {name!r}: must be one of {known}, or the path of a .toml file")


@pytest.mark.parametrize("data", [None, 3, [], "paddle"])
def test_a_dict_that_is_none(data):
    allowed = "must be a table of gravity, ball, rest_speed, max_speed, drag, elements"
    with pytest.raises(SceneError) as caught:
        scene_from_dict(data, "here")
    assert str(caught.value) == f"here: {data!r}: {allowed}"


def test_a_dict_may_come_from_json():
    data = {"max_speed": None, "elements": [{"type": "wall", "start": [0, 0], "end": [1, 1]}]}
    assert scene_from_dict(data) == Scene(elements=[Wall((0, 0), (1, 1))])
    data["elements"][0]["b"] = None
    with pytest.raises(SceneError) as caught:
        scene_from_dict(data)
    assert str(caught.value) == f"scene: elements[0] (wall): b = None: must be {ZERO_OR_MORE}"


@pytest.mark.parametrize("data", [{3: 4}, {"ball": {3: 4}}, {"elements": [{"type": "sensor", 3: 4}]}])
def test_a_key_that_is_no_text_is_an_unknown_field(data):
    with pytest.raises(SceneError, match=r": 3 = 4: unknown field: must be one of "):
        scene_from_dict(data)
