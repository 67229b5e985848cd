"""Each spec checks its own fields when it is made in Python."""

import copy
import dataclasses
import math
import pickle
from fractions import Fraction

import numpy as np
import pytest

from bounce_env.scene import Arc, Ball, Bumper, Field, Flipper, Paddle, Scene, SceneError, Sensor, Wall
from bounce_env.scene.errors import ABSENT
from bounce_env.wording import nearest

pytestmark = pytest.mark.fast

SEGMENT = {"start": (0.0, 0.0), "end": (3.0, 4.0)}
CIRCLE = {"center": (0.0, 0.0), "radius": 1.0}
RAIL = {"rail_start": (0.0, 0.0), "rail_end": (3.0, 4.0), "half_width": 0.1, "radius": 0.1, "max_speed": 1.0}
ARC = {**CIRCLE, "start_angle": 0.0, "end_angle": 2.0}
TURNING = {
    "pivot": (0.0, 0.0), "length": 2.0, "radius": 0.1, "rest_angle": -0.5, "active_angle": 0.5, "up_speed": 35.0,
    "down_speed": 17.0,
}  # fmt: skip
TRIANGLE = {"points": ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)), "acceleration": (0.0, 1.0)}
GOOD = {
    Ball: {},
    Wall: SEGMENT,
    Bumper: CIRCLE,
    Arc: ARC,
    Paddle: RAIL,
    Flipper: TURNING,
    Sensor: SEGMENT,
    Field: TRIANGLE,
    Scene: {},
}

ZERO_OR_MORE = "must be a number >= 0 (at most 1e+09)"
ZERO_TO_ONE = "must be a number >= 0 and <= 1"
POSITIVE = "must be a number > 0 (from 1e-09 to 1e+09)"
ZERO_OR_POSITIVE = "must be 0 or a number from 1e-09 to 1e+09"
SHARE = "must be a number > 0 and <= 1 (at least 1e-09)"
ANGLE = "must be a number of radians, from -100 to 100"
POINT = "must be two numbers [x, y], each from -1e+09 to 1e+09"
SURFACE = {
    "b": ZERO_OR_MORE,
    "f": ZERO_TO_ONE,
    "kick": ZERO_OR_MORE,
    "kick_threshold": ZERO_OR_MORE,
    "cooldown": ZERO_OR_MORE,
}

NUMBERS = [
    *((spec, field, words) for spec in (Wall, Bumper, Arc, Paddle, Flipper) for field, words in SURFACE.items()),
    (Ball, "radius", ZERO_OR_POSITIVE),
    (Ball, "b", ZERO_OR_MORE),
    (Ball, "f", ZERO_TO_ONE),
    (Bumper, "radius", POSITIVE),
    (Arc, "radius", POSITIVE),
    (Paddle, "half_width", ZERO_OR_POSITIVE),
    (Paddle, "radius", POSITIVE),
    (Paddle, "max_speed", POSITIVE),
    *((Flipper, field, POSITIVE) for field in ("length", "radius", "up_speed", "down_speed")),
    (Bumper, "speed", ZERO_OR_POSITIVE),
    (Scene, "max_speed", POSITIVE),
    (Scene, "rest_speed", ZERO_OR_POSITIVE),
    (Scene, "drag", SHARE),
]
POINTS = [
    (Wall, "start"),
    (Wall, "end"),
    (Bumper, "center"),
    (Arc, "center"),
    (Paddle, "rail_start"),
    (Paddle, "rail_end"),
    (Field, "acceleration"),
    (Scene, "gravity"),
]
NO_NUMBER = [
    True,
    False,
    np.True_,
    "1",
    "",
    [1.0],
    {},
    1j,
    math.nan,
    np.nan,
    math.inf,
    -math.inf,
    10**400,
    -1,
    2e9,
]
NO_POINT = [
    *[(), (0.0,), (0.0, 0.0, 0.0), 1.0, "12", None, {0: 0.0, 1: 1.0}, {1.0, 2.0}],
    *[(True, 0.0), (0.0, "0"), (None, 0.0), (0.0, math.nan), (math.inf, 0.0), (0.0, -2e9), (10**400, 0.0)],
    *[((0.0, 0.0), (1.0, 1.0)), [[0.0], 1.0], np.zeros((2, 2)), np.zeros(3), np.array(["0", "0"])],
]


def name(part: object) -> str | None:
    return part.__name__ if isinstance(part, type) else None if isinstance(part, str) else f"{part!r:.20}"


def refusals(spec, *args, **fields) -> list[tuple[str, object, str]]:
    """Field, value and message of all that the spec refuses; its text holds them and the spec's name."""
    with pytest.raises(SceneError) as caught:
        spec(*args, **fields)
    errors = []
    for problem, line in zip(caught.value.problems, str(caught.value).split("\n"), strict=True):
        assert line.startswith(f"{spec.__name__}: ")
        assert line.endswith(f": {problem.message}")
        errors.append(
            (".".join(map(str, problem.at)), None if problem.value is ABSENT else problem.value, problem.message)
        )
    return errors


@pytest.mark.parametrize(("spec", "field", "words"), NUMBERS, ids=name)
@pytest.mark.parametrize("value", NO_NUMBER, ids=name)
def test_refuses_what_is_no_number_of_its_range(spec, field, words, value):
    [(refused, given, message)] = refusals(spec, **{**GOOD[spec], field: value})
    assert (refused, message) == (field, words)
    assert given is value


@pytest.mark.parametrize(("spec", "field"), POINTS, ids=name)
@pytest.mark.parametrize("value", NO_POINT, ids=name)
def test_refuses_what_is_no_point(spec, field, value):
    [(refused, given, message)] = refusals(spec, **{**GOOD[spec], field: value})
    assert (refused, message) == (field, POINT)
    assert given is value


@pytest.mark.parametrize(
    ("spec", "field", "low", "high"),
    [
        (Ball, "radius", 0.0, 1e9),
        (Ball, "radius", 1e-9, 1e9),
        (Ball, "f", 0.0, 1.0),
        (Wall, "b", 0.0, 1e9),
        (Wall, "kick_threshold", 0.0, 1e9),
        (Bumper, "radius", 1e-9, 1e9),
        (Paddle, "max_speed", 1e-9, 1e9),
        (Scene, "max_speed", 1e-9, 1e9),
        (Scene, "rest_speed", 0.0, 1e9),
        (Scene, "drag", 1e-9, 1.0),
    ],
    ids=name,
)
def test_a_range_ends_where_it_says(spec, field, low, high):
    for value in (low, high):
        assert getattr(spec(**{**GOOD[spec], field: value}), field) == value
    for value in (math.nextafter(low, -math.inf), math.nextafter(high, math.inf)):
        [(refused, _, _)] = refusals(spec, **{**GOOD[spec], field: value})
        assert refused == field


@pytest.mark.parametrize("one", [1, 1.0, np.float64(1), np.float32(1), np.int64(1), np.uint8(1), Fraction(1)], ids=name)
def test_takes_any_real_number_and_keeps_a_float(one):
    wall = Wall((0, 0), (one, one), b=one)
    assert (type(wall.b), wall.b) == (float, 1.0)
    assert (wall.end, set(map(type, wall.end))) == ((1.0, 1.0), {float})


@pytest.mark.parametrize("pair", [(1, 2), [1, 2], np.array([1, 2]), np.array([1, 2], "f4")], ids=name)
def test_takes_any_pair_and_keeps_a_tuple_of_floats(pair):
    center = Bumper(pair, 1).center
    assert (center, type(center), set(map(type, center))) == ((1.0, 2.0), tuple, {float})


def test_minus_zero_becomes_zero():
    assert math.copysign(1.0, Wall((-0.0, 0.0), (1.0, 0.0)).start[0]) == 1.0
    assert math.copysign(1.0, Wall((0.0, 0.0), (1.0, 0.0), b=-0.0).b) == 1.0


@pytest.mark.parametrize(
    ("spec", "given", "missing"),
    [
        (Wall, {"start": (0, 0)}, [("end", POINT)]),
        (Bumper, {}, [("center", POINT), ("radius", POSITIVE)]),
        (
            Paddle,
            {"rail_start": (0, 0)},
            [
                ("rail_end", POINT),
                ("half_width", ZERO_OR_POSITIVE),
                ("radius", POSITIVE),
                ("max_speed", POSITIVE),
            ],
        ),
        (Arc, {}, [("center", POINT), ("radius", POSITIVE), ("start_angle", ANGLE), ("end_angle", ANGLE)]),
        (
            Field,
            {},
            [("points", "must be at least 3 points [x, y], each number from -1e+09 to 1e+09"), ("acceleration", POINT)],
        ),
    ],
    ids=name,
)
def test_a_missing_field_says_what_it_takes(spec, given, missing):
    expected = {(field, None, message.replace("must be", "required:")) for field, message in missing}
    assert set(refusals(spec, **given)) == expected


@pytest.mark.parametrize(
    ("spec", "field", "allowed"),
    [
        (Ball, "mass", "radius, b, f"),
        (Wall, "length", f"start, end, one_way, draggable, min_length, reach, {', '.join(SURFACE)}, name"),
        (Bumper, "one_way", f"center, radius, rail_end, speed, {', '.join(SURFACE)}, name"),
        (Arc, "angle", f"center, radius, start_angle, end_angle, {', '.join(SURFACE)}, name"),
        (Paddle, "width", f"rail_start, rail_end, half_width, radius, max_speed, {', '.join(SURFACE)}, name"),
        (Sensor, "b", "start, end, center, radius, drain, name"),
        (Field, "drag", "points, acceleration, name"),
        (Scene, "walls", "gravity, ball, rest_speed, max_speed, drag, elements"),
    ],
    ids=name,
)
def test_an_unknown_field_says_which_there_are(spec, field, allowed):
    [(refused, given, message)] = refusals(spec, **GOOD[spec], **{field: 7})
    assert (refused, given) == (field, 7)
    head, _, fields = message.partition(": must be one of ")
    assert head == f"unknown field{nearest(field, allowed.split(', '))}"
    assert sorted(fields.split(", ")) == sorted(allowed.split(", "))


def test_positional_fields_are_named_in_errors():
    assert refusals(Wall, (0, 0), (1, "x")) == [("end", (1, "x"), POINT)]
    assert refusals(Bumper, (0, 0), -1) == [("radius", -1, POSITIVE)]


@pytest.mark.parametrize(
    ("spec", "start", "end"),
    [(Wall, "start", "end"), (Sensor, "start", "end"), (Paddle, "rail_start", "rail_end")],
    ids=name,
)
@pytest.mark.parametrize("point", [(1, 1), (1, 1 + 5e-10)], ids=name)
def test_two_ends_are_two_points(spec, start, end, point):
    message = f"must be at least 1e-09 m away from {start} = [1.0, 1.0]"
    assert refusals(spec, **{**GOOD[spec], start: (1, 1), end: point}) == [(end, point, message)]


@pytest.mark.parametrize("value", [1, 0, "true", None, np.True_], ids=name)
def test_a_flag_is_true_or_false(value):
    assert refusals(Sensor, **SEGMENT, drain=value) == [("drain", value, "must be true or false")]
    assert refusals(Wall, **SEGMENT, one_way=value) == [("one_way", value, "must be true or false")]


@pytest.mark.parametrize("value", [3, None, True, b"a", "a\nb", "a\x00", "\x7f", "\ud800"], ids=name)
def test_a_name_is_printable_text(value):
    assert refusals(Wall, **SEGMENT, name=value) == [("name", value, "must be printable text")]


def test_a_scene_takes_specs_only():
    allowed = "must be a Wall, Bumper, Arc, Paddle, Flipper, Sensor or Field"
    ball = Ball()
    assert refusals(Scene, elements=[Wall(**SEGMENT), 3, ball]) == [
        ("elements.1", 3, allowed),
        ("elements.2", ball, allowed),
    ]
    assert refusals(Scene, ball={"radius": 1}) == [("ball", {"radius": 1}, "must be a Ball")]
    for elements in ({Wall(**SEGMENT)}, Wall(**SEGMENT), None, "wall", iter([])):
        message = "must be a tuple or list of Wall, Bumper, Arc, Paddle, Flipper, Sensor and Field"
        assert refusals(Scene, elements=elements) == [("elements", elements, message)]


def test_all_errors_are_reported_together():
    fields = [field for field, *_ in refusals(Paddle, (0, 0), half_width=-1, radius=True, b="1", colour="red")]
    assert sorted(fields) == ["b", "colour", "half_width", "max_speed", "radius", "rail_end"]


def test_signatures_are_those_of_the_design():
    assert Ball(0.5, 2.0, 0.5) == Ball(radius=0.5, b=2.0, f=0.5)
    surface = {"b": 1.0, "f": 1.0, "kick": 0.0, "kick_threshold": 0.0, "cooldown": 0.0, "name": ""}
    assert Wall((0, 0), (1, 1)) == Wall(start=(0, 0), end=(1, 1), one_way=False, **surface)
    assert Bumper((0, 0), 2) == Bumper(center=(0, 0), radius=2.0, **surface)
    assert Arc((0, 0), 2, 0, 1) == Arc(center=(0, 0), radius=2.0, start_angle=0.0, end_angle=1.0, **surface)
    assert Sensor((0, 0), (1, 1)) == Sensor(start=(0, 0), end=(1, 1), drain=False, name="")
    corners = ((0, 0), (1, 0), (0, 1))
    assert Field(corners, (0, 1)) == Field(points=corners, acceleration=(0.0, 1.0), name="")
    assert Scene() == Scene(gravity=(0.0, -9.81), ball=Ball(0.0), rest_speed=0.0, max_speed=None, drag=1.0, elements=())
    for too_many in (
        lambda: Wall((0, 0), (1, 1), 1.0),
        lambda: Bumper((0, 0), 1, 1.0),
        lambda: Arc((0, 0), 1, 0, 1, 1.0),
        lambda: Field(corners, (0, 1), "wind"),
        lambda: Paddle((0, 0), (1, 1), 1.0, half_width=0, radius=1, max_speed=1),
        lambda: Sensor((0, 0), (1, 1), True),
        lambda: Scene((0, 0)),
    ):
        with pytest.raises(ValueError, match="too many values by position"):
            too_many()


def test_specs_are_frozen_values():
    scene = Scene(elements=[Wall(**SEGMENT, name="a"), Sensor(**SEGMENT), Arc(**ARC), Field(**TRIANGLE)])
    for copied in (pickle.loads(pickle.dumps(scene)), copy.deepcopy(scene), dataclasses.replace(scene)):
        assert copied == scene
        assert hash(copied) == hash(scene)
    with pytest.raises(dataclasses.FrozenInstanceError):
        scene.gravity = (0.0, 0.0)
    with pytest.raises(ValueError, match="must be a number >= 0"):
        dataclasses.replace(scene.elements[0], b=-1.0)
    assert scene != dataclasses.replace(scene, elements=scene.elements[::-1])


@pytest.mark.parametrize(
    ("element", "box"),
    [
        (Wall((3, -1), (1, 2)), (1, -1, 3, 2)),
        (Sensor((3, -1), (1, 2)), (1, -1, 3, 2)),
        (Bumper((1, 2), 0.5), (0.5, 1.5, 1.5, 2.5)),
        # a rail along (3, 4) / 5: the core reaches 0.5 further at each stop, and 0.25 more all around
        (Paddle((3, 4), (0, 0), half_width=0.5, radius=0.25, max_speed=1), (-0.55, -0.65, 3.55, 4.65)),
        (Paddle((0, 1), (2, 1), half_width=0, radius=1, max_speed=1), (-1, 0, 3, 2)),
    ],
    ids=name,
)
def test_bounds_of_an_element(element, box):
    assert element.bounds == pytest.approx(box, abs=1e-15)


def test_bounds_of_a_scene():
    assert Scene(elements=[Wall((0, 0), (1, 0)), Bumper((5, 5), 2)]).bounds == (0, 0, 7, 7)
    assert Scene(elements=[Wall((3, 4), (5, 6))]).bounds == (3, 4, 5, 6)
    assert Scene().bounds == (0, 0, 0, 0)


def test_a_flippers_stroke_is_more_than_nothing_and_at_most_a_turn() -> None:
    for active in (-0.5, -0.5 + 1e-9, 6.5):
        with pytest.raises(ValueError, match=r"1e-06 to 2 pi radians more or less than rest_angle = -0\.5"):
            Flipper(**{**TURNING, "active_angle": active})
    assert Flipper(**TURNING).surface_speed == 35.0 * 2.1


def test_a_bumper_moves_on_a_rail_only() -> None:
    with pytest.raises(ValueError, match=r"Bumper: speed = 1.0: must be 0 without a rail_end"):
        Bumper((0.0, 0.0), 0.1, speed=1.0)
    with pytest.raises(ValueError, match="away from center"):
        Bumper((0.0, 0.0), 0.1, rail_end=(0.0, 0.0), speed=1.0)
    assert Bumper((0.0, 0.0), 0.5, rail_end=(1.0, 2.0), speed=1.0).bounds == (-0.5, -0.5, 1.5, 2.5)
    assert Bumper((0.0, 0.0), 0.5, rail_end=(1.0, 2.0)).speed == 0.0  # it stands


@pytest.mark.parametrize(
    ("fields", "field", "words"),
    [
        ({"min_length": 0.5}, "min_length", "must be left out, or None, where draggable is false"),
        ({"reach": ((0, 0), (1, 1))}, "reach", "must be left out, or None, where draggable is false"),
        ({"draggable": True, "one_way": True}, "one_way", "must be false where draggable is true"),
        ({"draggable": True, "min_length": 2.5}, "min_length", "must be at most 2, the length at first"),
        ({"draggable": True, "min_length": 0.0}, "min_length", "must be a number > 0"),
        ({"draggable": True, "reach": ((0, 0), (1, 1))}, "reach", r"a box that holds start = \[0.0, 0.0\] and end ="),
        ({"draggable": True, "reach": ((0, 0), (0, 1))}, "reach", "two corners .* the lower left and the upper right"),
        ({"draggable": 1}, "draggable", "must be true or false"),
    ],
)
def test_what_a_draggable_wall_takes(fields, field, words) -> None:
    with pytest.raises(ValueError, match=rf"Wall: {field} = .*{words}"):
        Wall((0, 0), (2, 0), **fields)


def test_shortest_length_and_bounds_of_a_draggable_wall() -> None:
    assert Wall((0, 0), (2, 0), draggable=True).shortest == 0.2
    assert Wall((0, 0), (2, 0), draggable=True, min_length=0.5).shortest == 0.5
    assert Wall((0, 0), (2, 0), draggable=True).bounds == (0, 0, 2, 0)
    assert Wall((0, 0), (2, 0), draggable=True, reach=((-1, -2), (3, 4))).bounds == (-1, -2, 3, 4)


def test_bounds_of_a_flipper_are_what_it_can_reach() -> None:
    flipper = Flipper((1.0, 1.0), 2.0, radius=0.5, rest_angle=0.0, active_angle=math.pi, up_speed=1.0, down_speed=1.0)
    assert flipper.bounds == pytest.approx((-1.5, 0.5, 3.5, 3.5))


def test_parts_are_the_elements_that_move() -> None:
    still, moving = Bumper((0.0, 0.0), 0.1), Bumper((0.0, 0.0), 0.1, rail_end=(1.0, 0.0), speed=1.0)
    dragged = Wall((0, 0), (1, 0), draggable=True)
    scene = Scene(elements=(Wall((0, 0), (1, 0)), Flipper(**TURNING), still, Paddle(**RAIL), moving, dragged))
    assert [i for i, _ in scene.parts] == [1, 3, 4, 5]


def test_max_speed_exceeds_that_of_a_flippers_tip() -> None:
    with pytest.raises(ValueError, match=r"greater than 73.5, the fastest that the surface of elements\[0\]"):
        Scene(max_speed=73.0, elements=(Flipper(**TURNING),))
