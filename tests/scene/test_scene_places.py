"""Errors name the line of the key: the reader of lines is held against `tomllib` on random files."""

import re
import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bounce_env.scene import SceneError, builtin_scenes, load_scene
from bounce_env.scene.load import _BUILTIN
from bounce_env.scene.places import places_of

pytestmark = pytest.mark.fast

FILE = '''# a table ] } = "
gravity = [0, -1] # [[elements]]
max_speed = 1_000.5
"rest_speed" = 0x1

[ball]
radius = -1e0

[[elements]]
type = "wall"
start = [0, # first
  0]
end = [1, 0]
name = """a
b"""

[[elements]]
type = 'wall'
start = [0, 0]
kick = 2
'''


def leaves(data, at=()):
    """Every value of a document with its location, tables and arrays included."""
    yield at, data
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in items:
        yield from leaves(value, (*at, key))


def check(text):
    """Every value has a place, and its literal there is one of the value."""
    places = places_of(text)
    lines = text.split("\n")
    for at, value in leaves(tomllib.loads(text)):
        if not at or (isinstance(value, dict | list) and at not in places):
            continue  # a table of dotted keys or headers has no place of its own
        place = places[at]
        assert 1 <= place.line <= len(lines)
        if place.literal is not None and not set("#\"'") & set(place.literal):  # blanks in texts are not kept
            read = tomllib.loads(f"x = {place.literal}")["x"]
            assert repr(read) == repr(value)
        if isinstance(at[-1], str) and at[-1].isidentifier() and at[-1].isascii():
            assert at[-1] in lines[place.line - 1]


def test_places_of_a_file():
    places = places_of(FILE)
    assert {at: (place.line, place.literal) for at, place in places.items() if not isinstance(at[-1], int)} == {
        ("gravity",): (2, "[0, -1]"),
        ("max_speed",): (3, "1_000.5"),
        ("rest_speed",): (4, "0x1"),
        ("ball",): (6, None),
        ("ball", "radius"): (7, "-1e0"),
        ("elements", 0, "type"): (10, '"wall"'),
        ("elements", 0, "start"): (11, "[0, # first 0]"),
        ("elements", 0, "end"): (13, "[1, 0]"),
        ("elements", 0, "name"): (14, '"""a b"""'),
        ("elements", 1, "type"): (18, "'wall'"),
        ("elements", 1, "start"): (19, "[0, 0]"),
        ("elements", 1, "kick"): (20, "2"),
    }
    assert places["elements", 0].line == 9
    assert places["elements", 1].line == 17
    check(FILE)


@pytest.mark.parametrize("name", builtin_scenes())
def test_every_value_of_the_built_in_scenes_has_its_place(name):
    check((_BUILTIN / f"{name}.toml").read_text(encoding="utf-8"))


SCALARS = st.one_of(
    st.integers(-1000, 1000).map(str),
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.sampled_from(["true", "inf", "-nan", "1_0.5e3", "0xff", "1979-05-27 07:32:00", "''", '""', '"a\\"]#"', "'b}='"]),
    st.sampled_from(['"""x\n"]"y"""', "'''q\n''z'''", '""""quoted""""']),
)
KEYS = st.sampled_from(["a", "b-c", "1", '"x y"', "'#'", '"\\u00e4"', '"k=v"'])
GAPS = st.sampled_from(["", " ", "\t"])
BREAKS = st.sampled_from(["", " ", "\n", " # ] }\n", "\r\n"])


def arrays(items):
    return st.tuples(st.lists(items, max_size=3), BREAKS, BREAKS).map(
        lambda parts: f"[{parts[1]}{f',{parts[2]}'.join(parts[0])}{parts[1]}]"
    )


def inline_tables(items):
    pairs = st.lists(st.tuples(KEYS, GAPS, items), max_size=3, unique_by=lambda pair: pair[0])
    return pairs.map(lambda pairs: "{" + ", ".join(f"{key}{gap}={gap}{value}" for key, gap, value in pairs) + "}")


VALUES = st.recursive(SCALARS, lambda inner: arrays(inner) | inline_tables(inner), max_leaves=6)
ASSIGNMENTS = st.lists(st.tuples(KEYS, GAPS, VALUES, BREAKS), max_size=4, unique_by=lambda pair: pair[0]).map(
    lambda pairs: "".join(f"{gap}{key} ={gap}{value}\n{end}" for key, gap, value, end in pairs)
)
SECTIONS = st.tuples(st.sampled_from(["[[e]]", "[[ e ]] # x", "[[e.in]]", '[["q"]]']), ASSIGNMENTS).map("\n".join)


@given(st.tuples(ASSIGNMENTS, st.lists(SECTIONS, max_size=4)))
def test_random_files(parts):
    head, sections = parts
    text = head + "\n".join(sections)
    try:
        tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return  # [[e.in]] before any [[e]], or a multi-line text in an inline table
    check(text)


def test_errors_name_the_line_of_the_key_and_the_literal(tmp_path):
    path = tmp_path / "table.toml"
    path.write_text(FILE)
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    lines = [line.removeprefix(f"{path}:") for line in str(caught.value).split("\n")]
    assert re.match(r"7: ball: radius = -1e0: must be ", lines[0])
    assert re.match(r"14: elements\[0\] .*: name = .*: must be printable text", lines[1])
    assert re.match(r"17: elements\[1\] \(wall\): end: required: ", lines[2])
    assert len(lines) == 3


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("\nball.radus.x = 1", 2, "ball: radus = {'x': 1}: unknown field (did you mean 'radius'?)"),
        ('[[elements]]\ntype = "wa  ll"', 2, 'type = "wa  ll": must be one of'),
        ('[[elements]]\ntype = "a\u202e\u009b31mb"', 2, 'type = "a\\u202e\\x9b31mb": must be one of'),
        ('[[elements]]\ntype = "wall"\nstart = [0, 0]\nend = [1, 0]\nkick = 2\n', 5, "max_speed: required"),
        ('[ball]\nb = 2\n[[elements]]\ntype = "wall"\nstart = [0, 0]\nend = [1, 0]\n', 2, "max_speed: required"),
        (
            '[[elements]]\ntype = "wall"\nstart = [0, 0]\nend = [9, 0]\nname = "a"\n\n'
            '[[elements]]\ntype = "wall"\nname = "a"\nstart = [0, 0]\nend = [1, 0]',
            9,
            'name = "a": must be unique',
        ),
        (
            '[[elements]]\ntype = "wall"\nstart = [0, 0]\nend = [9e3, 0]\n\n'
            '[[elements]]\ntype = "bumper"\ncenter = [0, 5]\nradius = 1e-4',
            9,
            "radius = 1e-4: must be at least 0.009 m",
        ),
        ("elements = [\n  {type = 'wall', start = [0, 0],  end = [1, 0], b = -1},\n]", 2, "b = -1: must be"),
        ("\n\nelements = [3]", 3, "elements[0] = 3: must be a table"),
    ],
)
def test_errors_of_the_whole_scene_name_a_line_too(tmp_path, text, line, words):
    path = tmp_path / "table.toml"
    path.write_text(text)
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    assert str(caught.value).startswith(f"{path}:{line}: ")
    assert words in str(caught.value)


def test_a_byte_that_is_no_utf_8_is_found(tmp_path):
    path = tmp_path / "table.toml"
    path.write_bytes(b"gravity = [0, 1]\n# caf\xe9\n")
    with pytest.raises(SceneError, match=r"table\.toml:2: is not a TOML file: has a byte that is no UTF-8"):
        load_scene(path)
