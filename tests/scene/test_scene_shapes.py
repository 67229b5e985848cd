"""Arcs, circular sensors and fields: which shapes there are, and the boxes around them."""

import math

import numpy as np
import pytest

from bounce_env.scene import Arc, Field, Scene, SceneError, Sensor, Wall
from bounce_env.scene.errors import ABSENT
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

TURN = 2 * math.pi
POINT = "two numbers [x, y], each from -1e+09 to 1e+09"
FORMS = "a sensor is a segment (start and end) or a circle (center and radius)"
CONVEX = "must be the corners of a strictly convex polygon, in order around it: "


def refusals(make) -> list[tuple[str, object, str]]:
    with pytest.raises(SceneError) as caught:
        make()
    return [
        (".".join(map(str, problem.at)), None if problem.value is ABSENT else problem.value, problem.message)
        for problem in caught.value.problems
    ]


# Arcs


@pytest.mark.parametrize("start", [-99.0, -1.0, 0.0, 0.1, 3.0, 90.0])
def test_a_span_of_two_pi_is_a_closed_circle_and_no_other(start):
    for end in (start + TURN, start + TURN + 9e-13, start + TURN - 9e-13):
        assert Arc((0, 0), 1, start, end).closed
    for end in (start + TURN - 1.01e-6, start + 3.0, start + 1.01e-6):
        assert not Arc((0, 0), 1, start, end).closed


@pytest.mark.parametrize("start", [-3.0, 0.0, 0.5])
@pytest.mark.parametrize("span", [-1.0, 0.0, 0.99e-6, TURN + 1.1e-12, 7.0, 90.0])
def test_a_span_is_positive_and_at_most_two_pi(start, span):
    end = start + span
    message = f"must be more than start_angle = {start}, by 1e-06 to 2 pi radians (to {start + TURN!r})"
    assert refusals(lambda: Arc((0, 0), 1, start, end)) == [("end_angle", end, message)]


@pytest.mark.parametrize("end", [6.2831853, TURN - 0.99e-6, TURN - 1.1e-12])
def test_a_gap_too_narrow_to_be_meant_is_refused(end):
    message = f"must be start_angle + 2 pi = {TURN!r} for a closed circle, or less by 1e-06 or more"
    assert refusals(lambda: Arc((0, 0), 1, 0, end)) == [("end_angle", end, message)]


@pytest.mark.parametrize("angle", [100.1, -100.1, math.nan, "1", True, None])
@pytest.mark.parametrize("field", ["start_angle", "end_angle"])
def test_an_angle_is_a_number_of_radians(field, angle):
    fields = {"start_angle": 0.0, "end_angle": 1.0, field: angle}
    [(refused, _, message)] = refusals(lambda: Arc((0, 0), 1, **fields))
    assert (refused, message) == (field, "must be a number of radians, from -100 to 100")


def test_an_arc_is_long_enough_to_have_a_direction():
    assert Arc((0, 0), 1e-6, 0, 1.01e-3)
    message = "must be such that the arc is at least 1e-09 m long"
    assert refusals(lambda: Arc((0, 0), 1e-6, 0, 0.99e-3)) == [("end_angle", 0.99e-3, message)]


def test_a_refused_angle_or_radius_raises_no_second_complaint():
    assert [field for field, *_ in refusals(lambda: Arc((0, 0), 1, "a", 1))] == ["start_angle"]
    assert [field for field, *_ in refusals(lambda: Arc((0, 0), -1, 0, 1e-6))] == ["radius"]


S = math.sqrt(0.5)


@pytest.mark.parametrize(
    ("angles", "box"),
    [
        ((0, math.pi / 2), (0, 0, 1, 1)),
        ((math.pi / 2, math.pi), (-1, 0, 0, 1)),
        ((-math.pi, -math.pi / 2), (-1, -1, 0, 0)),
        ((3 * math.pi / 2, TURN), (0, -1, 1, 0)),
        ((math.pi / 4, 3 * math.pi / 4), (-S, S, S, 1)),
        ((3 * math.pi / 4, 5 * math.pi / 4), (-1, -S, -S, S)),
        ((5 * math.pi / 4, 7 * math.pi / 4), (-S, -1, S, -S)),
        ((-math.pi / 4, math.pi / 4), (S, -S, 1, S)),
        ((math.pi / 6, math.pi / 3), (0.5, 0.5, math.sqrt(0.75), math.sqrt(0.75))),  # passes no axis
        ((math.pi / 4, 7 * math.pi / 4), (-1, -1, S, 1)),
        ((0.3, 0.2 + TURN), (-1, -1, 1, 1)),
        ((0.3, 0.3 + TURN), (-1, -1, 1, 1)),
        ((30.0, 30.0 + TURN), (-1, -1, 1, 1)),
        ((8 * TURN, 8 * TURN + math.pi), (-1, 0, 1, 1)),
        ((-9 * TURN + 0.1, -9 * TURN + 0.2), (math.cos(0.2), math.sin(0.1), math.cos(0.1), math.sin(0.2))),
    ],
)
def test_bounds_of_an_arc_reach_to_the_axes_that_it_passes(angles, box):
    assert Arc((0, 0), 1, *angles).bounds == pytest.approx(box, abs=1e-12)
    x0, y0, x1, y1 = box
    assert Arc((10, -20), 3, *angles).bounds == pytest.approx(
        (10 + 3 * x0, -20 + 3 * y0, 10 + 3 * x1, -20 + 3 * y1), abs=1e-11
    )


def test_bounds_of_any_arc_hold_it_and_no_more():
    rng = np.random.default_rng(4)
    for _ in range(soak_count(200, 20_000)):
        start, span = rng.uniform(-90, 90), rng.uniform(1e-5, TURN - 1e-5)
        center, radius = rng.uniform(-5, 5, 2), rng.uniform(0.1, 5)
        angles = start + span * np.linspace(0, 1, 4001)
        points = center + radius * np.transpose([np.cos(angles), np.sin(angles)])
        x0, y0, x1, y1 = Arc(center, radius, start, start + span).bounds
        low, high = points.min(axis=0), points.max(axis=0)
        assert (low - (x0, y0) > -1e-11).all()
        assert ((x1, y1) - high > -1e-11).all()
        sagitta = radius * (span / 4000) ** 2  # how far the line bulges between two of the points
        assert np.abs([*(low - (x0, y0)), *((x1, y1) - high)]).max() < 1e-11 + sagitta


@pytest.mark.parametrize("angle", [math.pi / 3, 2 * math.pi / 3, math.pi / 6, 5 * math.pi / 6])
def test_round_off_of_sine_and_cosine_does_not_show_in_bounds(angle):
    """Libm may give a half as 0.49999999999999994; a power of two, above which the engine sees another, stays one."""
    for ends in ((angle - 0.1, angle), (angle, angle + 0.1)):
        assert 1.0 in [abs(side) for side in Arc((0, 0), 2, *ends).bounds]


# Sensors


def test_a_sensor_is_a_segment_or_a_circle():
    segment, circle = Sensor((0, 1), (2, 3)), Sensor(center=(1, 2), radius=0.5, drain=True, name="hole")
    assert (segment.segment, segment.circle) == (((0.0, 1.0), (2.0, 3.0)), None)
    assert (circle.segment, circle.circle) == (None, ((1.0, 2.0), 0.5))
    assert (circle.start, circle.end, segment.center, segment.radius) == (None,) * 4
    assert circle.bounds == (0.5, 1.5, 1.5, 2.5)
    assert Scene(elements=[circle, Wall((0, 0), (1, 0))]).bounds == (0.0, 0.0, 1.5, 2.5)


P, R = (0.0, 0.0), 1.0


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ({}, [("start", None, f"required: {POINT}; {FORMS}")]),
        ({"start": P}, [("end", None, f"required: {POINT}; {FORMS}")]),
        ({"end": P}, [("start", None, f"required: {POINT}; {FORMS}")]),
        ({"center": P}, [("radius", None, f"required: a number > 0 (from 1e-09 to 1e+09); {FORMS}")]),
        ({"radius": R}, [("center", None, f"required: {POINT}; {FORMS}")]),
        ({"start": P, "end": (1, 1), "radius": R}, [("radius", R, f"must be left out: {FORMS}")]),
        (
            {"start": P, "end": (1, 1), "center": P, "radius": R},
            [("center", P, f"must be left out: {FORMS}"), ("radius", R, f"must be left out: {FORMS}")],
        ),
        (
            {"start": P, "center": P},
            [("center", P, f"must be left out: {FORMS}"), ("end", None, f"required: {POINT}; {FORMS}")],
        ),
    ],
    ids=lambda part: ", ".join(part) if isinstance(part, dict) else "",
)
def test_a_sensor_of_no_form_or_of_two_is_refused(fields, expected):
    assert refusals(lambda: Sensor(**fields)) == expected


@pytest.mark.parametrize("field", ["start", "end", "center"])
@pytest.mark.parametrize("value", [(), 3, "12", (0.0, math.nan), (True, 0), (0, 2e9)])
def test_a_sensors_points_are_points(field, value):
    other = {"radius": R} if field == "center" else {"start": (5, 5), "end": (6, 6)}
    assert refusals(lambda: Sensor(**{**other, field: value})) == [(field, value, f"must be {POINT}")]


@pytest.mark.parametrize("value", [0, -1, 1e-10, 2e9, math.nan, True, "1"])
def test_a_sensors_radius_is_positive(value):
    [(field, _, message)] = refusals(lambda: Sensor(center=P, radius=value))
    assert (field, message) == ("radius", "must be a number > 0 (from 1e-09 to 1e+09)")


# Fields


def regular(corners: int, winding: int = 1) -> list[tuple[float, float]]:
    angles = [winding * TURN * i / corners + 0.1 for i in range(corners)]
    return [(math.cos(angle), math.sin(angle)) for angle in angles]


@pytest.mark.parametrize("corners", [3, 4, 5, 8, 100])
def test_a_field_is_any_convex_polygon_from_any_corner_and_either_way(corners):
    points = regular(corners)
    for shift in range(corners):
        turned = points[shift:] + points[:shift]
        for given in (turned, turned[::-1]):
            assert Field(given, (0, 1)).points == tuple(given)  # kept as given, so that a file comes back
    assert Field(points, (0, 1)).bounds == pytest.approx((-1, -1, 1, 1), abs=1 - math.cos(TURN / corners))


def test_a_field_takes_an_array_and_keeps_floats():
    field = Field(np.array([[0, 0], [1, 0], [0, 1]]), np.array([3, -4]))
    assert field.points == ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
    assert {type(number) for point in (*field.points, field.acceleration) for number in point} == {float}
    assert field.bounds == (0, 0, 1, 1)


FLAT_LIST = [0, 0, 1, 0, 0, 1]


@pytest.mark.parametrize(
    "points",
    [
        *[(), [(0, 0), (1, 0)], FLAT_LIST, 3, "abc", None, {(0, 0), (1, 0), (0, 1)}],
        *[[(0, 0), (1, 0), odd] for odd in ((0, math.nan), 3, (0, 1, 2), (0, "1"), (2e9, 1))],
    ],
)
def test_a_field_has_three_points_or_more(points):
    message = "must be at least 3 points [x, y], each number from -1e+09 to 1e+09"
    assert refusals(lambda: Field(points, (0, 1))) == [("points", points, message)]


@pytest.mark.parametrize("way", [1, -1], ids=["counter-clockwise", "clockwise"])
@pytest.mark.parametrize(
    ("points", "why"),
    [
        ([(0, 0), (2, 0), (2, 2), (1, 0.5), (0, 2)], "not so at [1.0, 0.5]"),  # dented
        ([(0, 0), (1, 0), (2, 0), (2, 2)], "not so at [1.0, 0.0]"),  # a corner that is none
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "not so at [1.0, 0.0]"),  # a point twice
        ([(0, 0), (2, 0), (2, 2), (0, 0)], "not so at [0.0, 0.0]"),  # closed by hand
        (regular(5, winding=2), "these go around more than once"),
        (regular(7, winding=3), "these go around more than once"),
        (regular(3) * 2, "these go around more than once"),
    ],
)
def test_a_field_is_strictly_convex(points, why, way):
    [(field, _, message)] = refusals(lambda: Field(points[::way], (0, 1)))
    assert (field, message) == ("points", CONVEX + why)


@pytest.mark.parametrize("points", [[(0, 0), (1, 1), (1, 0), (0, 1)], [(0, 0), (1, 0), (2, 0)], [(1, 1)] * 3])
def test_a_field_that_crosses_itself_or_has_no_area_is_refused(points):
    [(field, _, message)] = refusals(lambda: Field(points, (0, 1)))
    assert field == "points"
    assert message.startswith(CONVEX)


def test_a_field_is_not_flat():
    assert Field([(0, 0), (1, 0), (0.5, 1.01e-9)], (0, 1))
    message = "must be such that [0.5, 9.9e-10] is at least 1e-09 m off the line through the corners beside it"
    assert [m for _, _, m in refusals(lambda: Field([(0, 0), (1, 0), (0.5, 9.9e-10)], (0, 1)))] == [message]
