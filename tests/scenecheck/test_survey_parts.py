"""What a survey is made of: what scores, what is within reach, the inside, starts, places that are one."""

from dataclasses import replace

import numpy as np
import pytest

from bounce_env.engine.placement import element_gaps, part_cores_at_start
from bounce_env.scene import Arc, Ball, Bumper, Field, Flipper, Paddle, Scene, Sensor, Wall, load_scene
from bounce_env.scenecheck.inside import inside_of
from bounce_env.scenecheck.places import clusters
from bounce_env.scenecheck.reach import reach_boxes, scores, with_borders
from bounce_env.scenecheck.starts import NoRoomError, fastest, random_starts
from tests.scenecheck.tables import CUP, SOUND, box, table


@pytest.mark.parametrize(
    ("element", "expected"),
    [
        (Bumper((0, 0), 1), True),
        (Bumper((0, 0), 1, rail_end=(1, 0), speed=1), True),
        (Wall((0, 0), (1, 0)), False),
        (Wall((0, 0), (1, 0), kick=1), True),
        (Wall((0, 0), (1, 0), name="slingshot_left"), True),
        (Arc((0, 0), 1, 0, 1, name="target_1"), True),
        (Sensor((0, 0), (1, 0), name="rollover"), True),
        (Sensor((0, 0), (1, 0)), True),
        (Sensor((0, 0), (1, 0), drain=True), False),
        (Paddle((0, 0), (1, 0), half_width=0.1, radius=0.1, max_speed=1, kick=1), False),
        (Flipper((0, 0), 1, radius=0.1, rest_angle=0, active_angle=1, up_speed=1, down_speed=1, kick=1), False),
        (Field(((0, 0), (1, 0), (0, 1)), (1, 0), name="target"), False),
    ],
)
def test_what_scores(element: object, expected: bool):
    assert scores(element) is expected


def test_reach_is_the_sweep_and_a_ball_around_it_within_the_bounds():
    ((x0, y0, x1, y1),) = reach_boxes(SOUND)
    assert (x0, y0) == pytest.approx((0.2 - 0.08 - 0.012 - 0.04, 0.08 - 0.012 - 0.04))
    assert (x1, y1) == pytest.approx((0.8 + 0.08 + 0.012 + 0.04, 0.08 + 0.012 + 0.04))
    high = Paddle((0.5, 1.3), (0.5, 1.35), half_width=0.0, radius=0.04, max_speed=1)
    assert reach_boxes(table(high))[1][3] == 1.4


def test_a_wall_that_is_dragged_anywhere_reaches_everything():
    scene = Scene(elements=(*box(0, 0, 2, 1), Wall((0.5, 0.5), (1, 0.5), draggable=True)))
    assert reach_boxes(scene) == (scene.bounds,)


def test_borders_come_after_the_elements_and_leave_the_bounds():
    watched = with_borders(SOUND)
    assert watched.elements[: len(SOUND.elements)] == SOUND.elements
    assert len(watched.elements) == len(SOUND.elements) + 4
    assert watched.bounds == SOUND.bounds


@pytest.mark.parametrize("name", ["paddle", "guides", "box", "pegs"])
def test_the_inside_of_the_built_in_tables(name: str):
    inside = inside_of(load_scene(name))
    assert inside is not None
    within = {"paddle": (0.5, 0.5), "guides": (0.4775, 0.05), "box": (5, 8), "pegs": (0.5, 0.5)}[name]
    assert inside.holds(*within)
    beyond = {"paddle": (0.5, -0.05), "guides": (0.01, 0.99), "box": (-0.05, 5), "pegs": (0.5, -0.01)}[name]
    assert not inside.holds(*beyond)


def test_a_table_with_a_hole_has_no_inside():
    hole = 0.1
    sides = (Wall((0, 0), (0, 1)), Wall((0, 1), (1, 1)), Wall((1, 1), (1, hole)), Wall((0, 0), (1, 0)))
    assert inside_of(Scene(elements=sides, ball=Ball(radius=0.02))) is None
    assert inside_of(Scene(elements=sides, ball=Ball(radius=0.06))) is not None  # the hole is too small for it
    assert inside_of(Scene()) is None
    gate = replace(sides[2], end=(1, 0), one_way=True)
    assert inside_of(Scene(elements=(*sides[:2], gate, sides[3]), ball=Ball(radius=0.02))) is not None


def test_balls_start_inside_where_nothing_is_in_their_way():
    starts = random_starts(CUP, inside_of(CUP), 500, 0)
    cores = part_cores_at_start(CUP)
    assert all(gap >= 0 for x, y, _, _ in starts.tolist() for _, gap in element_gaps(CUP, cores, x, y))
    assert (starts[:, 1] > -0.04).all()  # none below the drain
    assert starts[:, 1].min() < 0.1
    assert starts[:, 1].max() > 1.3
    speeds = np.hypot(starts[:, 2], starts[:, 3])
    assert 0.9 * fastest(CUP) < speeds.max() <= fastest(CUP) * (1 + 1e-12)
    assert len(np.unique(starts, axis=0)) == 500


def test_a_scene_that_is_full_says_so():
    full = Scene(elements=box(0, 0, 1, 1), ball=Ball(radius=0.6))
    with pytest.raises(NoRoomError, match=r"ball\.radius = 0\.6: no room"):
        random_starts(full, None, 1, 0)


def test_many_places_in_vain_do_not_count_against_those_that_follow():
    tight = Scene(elements=box(0, 0, 1, 1), ball=Ball(radius=0.48))  # one place in 600
    assert len(random_starts(tight, None, 30, 0)) == 30


def test_how_fast_balls_start():
    assert fastest(SOUND) == 3.0
    walls = box(0, 0, 3, 4)
    assert fastest(Scene(gravity=(0, -10), elements=walls)) == pytest.approx(10.0)
    assert fastest(Scene(gravity=(0, 0), elements=walls)) == 5.0


def test_places_near_each_other_are_one():
    places = np.array([(0.0, 0.0), (5.0, 5.0), (0.9, 0.1), (1.8, 0.0), (2.7, 0.2)])
    chain, alone = clusters(places, 1.0)
    assert chain.rows == (0, 2, 3, 4)
    assert (chain.x_min, chain.x_max, chain.y_min, chain.y_max) == (0.0, 2.7, 0.0, 0.2)
    assert alone.rows == (1,)
