"""What only a whole scene can show is refused, with element, field, value and what is allowed."""

import pytest

from bounce_env.scene import Arc, Ball, Bumper, Field, Paddle, Scene, SceneError, Sensor, Wall
from bounce_env.scene.errors import ABSENT

pytestmark = pytest.mark.fast

FLOOR = Wall((0, 0), (1, 0), name="floor")


def paddle(**changes) -> Paddle:
    return Paddle((0, 0), (1, 0), **{"half_width": 0.1, "radius": 0.1, "max_speed": 1.5, **changes})


def refusals(**fields) -> list[tuple[str, object, str]]:
    with pytest.raises(SceneError, match="Scene: ") as caught:
        Scene(**fields)
    return [
        (".".join(map(str, problem.at)), None if problem.value is ABSENT else problem.value, problem.message)
        for problem in caught.value.problems
    ]


def test_a_name_is_used_once():
    elements = [FLOOR, Wall((0, 1), (1, 1)), Sensor((0, 2), (1, 2)), Bumper((0, 5), 1, name="floor")]
    message = "must be unique, but is also the name of elements[0] (wall 'floor')"
    assert refusals(elements=elements) == [("elements.3.name", "floor", message)]
    both = [*elements, Sensor((0, 3), (1, 3), name="floor")]
    assert refusals(elements=both) == [(f"elements.{i}.name", "floor", message) for i in (3, 4)]


@pytest.mark.parametrize(
    ("ball_b", "element", "because"),
    [
        (
            1.0,
            Wall((0, 1), (1, 1), b=1.5),
            "elements[1] (wall) has b = 1.5, times ball.b = 1.0 is more than 1",
        ),
        (
            2.0,
            Bumper((0, 5), 1, b=0.6, name="x"),
            "elements[1] (bumper 'x') has b = 0.6, times ball.b = 2.0 is more than 1",
        ),
        (0.5, Wall((0, 1), (1, 1), kick=0.1), "elements[1] (wall) has kick = 0.1"),
        (1.0, Arc((0, 5), 1, 0, 1, kick=2, name="arch"), "elements[1] (arc 'arch') has kick = 2.0"),
        (
            1.0,
            Arc((0, 5), 1, 0, 1, b=1.25),
            "elements[1] (arc) has b = 1.25, times ball.b = 1.0 is more than 1",
        ),
    ],
)
def test_a_gain_needs_a_max_speed(ball_b, element, because):
    floor = Wall((0, 0), (1, 0), b=0.1)
    message = f"required: a number > 0, because {because}, so that bounces may add speed without limit"
    assert refusals(ball=Ball(b=ball_b), elements=[floor, element]) == [("max_speed", None, message)]
    assert Scene(ball=Ball(b=ball_b), elements=[floor, element], max_speed=1.0).max_speed == 1.0


def test_a_gain_with_a_paddle_needs_a_max_speed_above_the_paddles():
    [(field, _, message)] = refusals(elements=[paddle(kick=1), paddle(max_speed=2)])
    assert field == "max_speed"
    assert message.startswith("required: a number > 2, because elements[0] (paddle) has kick = 1.0")


def test_without_gain_no_max_speed_is_needed():
    # the product counts, not its factors, and what the ball passes through has none
    field = Field(((0, 0), (1, 0), (0, 1)), (5, 5))
    scene = Scene(ball=Ball(b=2.0), elements=[Wall((0, 0), (1, 0), b=0.5), Sensor((0, 1), (1, 1)), field])
    assert scene.max_speed is None
    assert Scene(elements=[FLOOR, paddle()]).max_speed is None


def test_max_speed_exceeds_every_paddles():
    elements = [paddle(max_speed=1), paddle(max_speed=1.5, name="p"), paddle(max_speed=0.5)]
    message = "must be greater than 1.5, the fastest that the surface of elements[1] (paddle 'p') moves"
    assert refusals(elements=elements, max_speed=1.5) == [("max_speed", 1.5, message)]
    assert Scene(elements=elements, max_speed=1.6).max_speed == 1.6


WIDE = Wall((0, 0), (0, 1000))  # the longer side
SIZES = "in a scene whose longer side is 1e+03 m and whose largest coordinate is 1e+03 m"


@pytest.mark.parametrize(
    ("make", "field", "limit", "words"),
    [
        (lambda x: Bumper((0, 5), x), "elements.1.radius", 1e-3, "at least 0.001 m"),
        (lambda x: paddle(radius=x), "elements.1.radius", 1e-3, "at least 0.001 m"),
        (lambda x: Arc((0, 5), x, 0, 6), "elements.1.radius", 1e-3, "at least 0.001 m"),
        (lambda x: Sensor(center=(0, 5), radius=x), "elements.1.radius", 1e-3, "at least 0.001 m"),
        (
            lambda x: Arc((0, 5), 0.1, 0, 10 * x),
            "elements.1.end_angle",
            1e-6,
            "such that the arc is at least 1e-06 m long",
        ),
        (lambda x: paddle(half_width=x), "elements.1.half_width", 1e-6, "0 or at least 1e-06 m"),
        (
            lambda x: Wall((0, 0), (0, x)),
            "elements.1.end",
            1e-6,
            "at least 1e-06 m away from start = [0.0, 0.0]",
        ),
        (
            lambda x: Sensor((0, 0), (x, 0)),
            "elements.1.end",
            1e-6,
            "at least 1e-06 m away from start = [0.0, 0.0]",
        ),
        (
            lambda x: Paddle((0, 1), (x, 1), half_width=0, radius=1, max_speed=1),
            "elements.1.rail_end",
            1e-6,
            "at least 1e-06 m away from rail_start = [0.0, 1.0]",
        ),
    ],
)
def test_no_element_is_out_of_proportion(make, field, limit, words):
    assert Scene(elements=[WIDE, make(1.01 * limit)])
    [(refused, _, message)] = refusals(elements=[WIDE, make(0.99 * limit)])
    assert (refused, message) == (field, f"must be {words}, {SIZES}")


def test_a_ball_is_a_point_or_a_disc_that_can_be_told_from_one():
    assert Scene(ball=Ball(0.0), elements=[WIDE])
    assert Scene(ball=Ball(1.01e-3), elements=[WIDE])
    assert Scene(ball=Ball(1e-9))  # no scene to compare it with
    message = f"must be 0 or at least 0.001 m, {SIZES}"
    assert refusals(ball=Ball(0.99e-3), elements=[WIDE]) == [("ball.radius", 0.99e-3, message)]


def test_no_corner_of_a_field_is_flat_in_proportion():
    assert Scene(elements=[WIDE, Field(((0, 0), (10, 0), (5, 1.01e-6)), (1, 0))])
    [(field, _, message)] = refusals(elements=[WIDE, Field(((0, 0), (10, 0), (5, 0.99e-6)), (1, 0))])
    assert field == "elements.1.points"
    line = "off the line through the corners beside it"
    assert message == f"must be such that [5.0, 9.9e-07] is at least 1e-06 m {line}, {SIZES}"


def test_no_arc_is_out_of_proportion_to_the_scene():
    """Its centre may be far outside of all that the scene occupies, and distances from it are as long."""
    assert Scene(elements=[WIDE, Arc((0, 0.99e6), 0.99e6, 4.712, 4.7121)])
    [(field, value, message)] = refusals(elements=[WIDE, Arc((0, 1.01e6), 1.01e6, 4.712, 4.7121)])
    assert (field, value, message) == ("elements.1.radius", 1.01e6, f"must be at most 1e+06 m, {SIZES}")


@pytest.mark.parametrize("gap", [0.0, 0.99e-3, -0.99e-3])
def test_no_ball_is_as_large_as_an_arc(gap):
    """Inside of the arc its centre would keep to a circle too small to be told from a point."""
    arc = Arc((500, 500), 2.0, 0, 3)
    message = f"must be at least 0.001 m more or less than ball.radius = {2.0 + gap}, {SIZES}"
    assert refusals(ball=Ball(2.0 + gap), elements=[WIDE, arc]) == [("elements.1.radius", 2.0, message)]
    for other in (0.0, 2.0 - 1.01e-3, 2.0 + 1.01e-3, 4.0):
        assert Scene(ball=Ball(other), elements=[WIDE, arc])


@pytest.mark.parametrize("corner", [(1e8, 0), (-1e8 - 1, 0), (0, 1e8), (0, -1e8 - 1)])
def test_far_from_the_origin_lengths_are_ones_that_float64_can_tell_apart(corner):
    x, y = corner
    far = Bumper((x + 0.5, y + 0.5), 0.5)
    assert Scene(ball=Ball(1.01e-4), elements=[far])
    [(field, value, message)] = refusals(ball=Ball(0.99e-4), elements=[far])
    assert (field, value) == ("ball.radius", 0.99e-4)
    assert message.endswith("whose longer side is 1 m and whose largest coordinate is 1e+08 m")


def test_far_from_the_origin_walls_have_lengths_that_float64_can_tell_apart():
    far = Wall((1e8, 0), (1e8, 1))
    assert Scene(elements=[far, Wall((1e8, 0), (1e8, 1.01e-4))])
    [(field, _, message)] = refusals(elements=[far, Wall((1e8, 0), (1e8, 0.99e-4))])
    assert field == "elements.1.end"
    assert message.startswith("must be at least 0.0001 m away from start = [100000000.0, 0.0]")


def test_an_elements_errors_are_all_reported():
    elements = [WIDE, Arc((0, 5), 1e-4, 0, 1e-3)]
    fields = [field for field, *_ in refusals(ball=Ball(1.01e-3), elements=elements)]
    assert fields == ["elements.1.radius", "elements.1.radius", "elements.1.end_angle"]


def test_all_that_is_wrong_is_reported_together():
    elements = [FLOOR, WIDE, Bumper((0, 5), 1e-4, kick=1, name="floor")]
    fields = [field for field, *_ in refusals(ball=Ball(1e-5), elements=elements)]
    assert fields == ["elements.2.name", "ball.radius", "elements.2.radius", "max_speed"]
