"""The tutorial's algorithm: its formulas, what it says of b and f, and its two versions."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bounce_env.engine import tutorial
from bounce_env.engine.tutorial import Vector, bounce, run, start, step
from bounce_env.scene import Ball, Bumper, Scene, Wall
from tests.conftest import soak_count
from tests.reference.random_scenes import box, walls_only

pytestmark = pytest.mark.fast

number = st.floats(-1e3, 1e3)
share = st.floats(0, 2)


def flying(*elements, **ball):
    return Scene(gravity=(0, 0), ball=Ball(**ball), max_speed=1e9, elements=elements)


@given(v=st.tuples(number, number), wall=st.tuples(number, number), b=share, f=st.floats(0, 1), ball=share)
def test_formulas_are_the_vector_law(v, wall, b, f, ball):
    """v' = f_ball f_wall v_t - b_ball b_wall v_n, for walls of any length (as printed: only for 1 m)."""
    length = math.hypot(*wall)
    if length < 1e-3:
        return
    v1 = Vector((3.0, 4.0), *v, b=ball, f=0.5)
    v2 = Vector((1.0, 2.0), *wall, b=b, f=f)
    n = np.array([-wall[1], wall[0]]) / length
    v_n = np.dot(v, n) * n
    v_t = np.array(v) - v_n
    law = 0.5 * f * v_t - ball * b * v_n
    assert bounce(v1, v2) == pytest.approx(law, rel=1e-12, abs=1e-12 * math.hypot(*v))


def test_printed_formulas_are_for_walls_of_length_one():
    """The erratum of the docstring: with raw dot products a bounce off 2 m of wall doubles the speed."""
    v1, v2 = Vector((0, 1), 3.0, -4.0, 1.0, 1.0), Vector((0, 0), 2.0, 0.0, 1.0, 1.0)
    dp1 = v1.vx * v2.vx + v1.vy * v2.vy
    dp2 = v1.vx * v2.lx + v1.vy * v2.ly
    printed = (
        dp1 * v2.dx - dp2 * (v2.lx / v2.len),
        dp1 * v2.dy - dp2 * (v2.ly / v2.len),
    )
    assert printed == (6.0, 8.0)
    assert bounce(v1, v2) == (3.0, 4.0)


@pytest.mark.parametrize("seed", range(soak_count(20, 500)))
def test_perfect_bounces_conserve_speed_and_stay_inside(seed):
    case = walls_only(seed, lossy=False)
    state = start(case.scene, case.position, case.velocity)
    speed = math.hypot(*case.velocity)
    inside = walls_inside(case.scene)
    turns = 0
    for _ in range(400):
        before = state.velocity
        state = step(case.scene, state, 1 / 16)
        turns += state.velocity != before
        assert math.hypot(*state.velocity) == pytest.approx(speed, rel=1e-12)
        assert inside(state.position)
    assert turns >= 10


def walls_inside(scene):
    """Whether a point is in the convex polygon of the first four walls, up to rounding."""
    sides = [(np.array(w.start), np.subtract(w.end, w.start)) for w in scene.elements[:4]]

    def inside(p):
        return all(np.cross(np.append(along, 0), np.append(p - a, 0))[2] > -1e-12 for a, along in sides)

    return inside


@pytest.mark.parametrize(("ball_b", "wall_b"), [(0.0, 1.0), (1.0, 0.0)])
def test_no_bounce_leaves_the_point_moving_along_the_wall(ball_b, wall_b):
    scene = flying(Wall((-10, -10), (10, 10), b=wall_b), b=ball_b)
    state = run(scene, (0.0, 1.0), (1.0, 0.0), 0.25, 8)
    assert state.velocity == pytest.approx((0.5, 0.5), abs=1e-15)
    assert state.position == pytest.approx((1.5, 1.5), abs=1e-14)  # 1 s to the wall, 1 s along it


def test_friction_acts_once_on_a_point_that_goes_on_along_the_wall():
    """Rounding leaves it going a little towards the wall at some slopes; that is no further hit."""
    for slope in np.linspace(0, 3.1, 200):
        c, s = math.cos(slope), math.sin(slope)
        scene = flying(Wall((0, 0), (99 * c, 99 * s), b=0.0, f=0.5))
        state = run(scene, (1.0 - 2 * s, 2 * c), (4 * c + s, 4 * s - c), 1.0, 20)
        assert state.velocity == pytest.approx((2 * c, 2 * s), rel=1e-14, abs=1e-14)


def test_point_an_ulp_behind_the_wall_it_touches_is_not_moved_back_along_its_path():
    scene = flying(Wall((-1, 0), (1, 0), f=0.0))
    touching = start(scene, (0.5, 0.1), (1.0, 0.0))._replace(position=(0.5, -1e-17), velocity=(1.0, -1e-12))
    x, y = step(scene, touching, 1.0).position
    assert (x, y) == (0.5, pytest.approx(1e-12, rel=1e-4))


def test_b_and_f_of_zero_glue_the_point():
    scene = flying(Wall((-1, 0), (1, 0), b=0.0, f=0.0))
    state = run(scene, (0.0, 0.3), (0.4, -1.0), 0.25, 8)
    assert state.velocity == (0.0, 0.0)
    assert state.position == pytest.approx((0.12, 0.0), abs=1e-15)


def test_b_and_f_of_ball_and_wall_multiply():
    scene = flying(Wall((-1, 0), (1, 0), b=0.5, f=0.75), b=0.5, f=0.5)
    assert run(scene, (0.0, 0.5), (0.5, -1.0), 1.0, 1).velocity == (0.1875, 0.25)


def test_bounce_of_more_than_one_speeds_up_for_the_rest_of_the_tick():
    """0.25 of the tick to the wall, 0.75 in the new direction at twice the speed."""
    state = run(flying(Wall((-1, 0), (1, 0), b=2.0)), (0.0, 0.25), (0.0, -1.0), 1.0, 1)
    assert (state.position, state.velocity) == ((0.0, 1.5), (0.0, 2.0))


def test_closest_wall_only_passes_a_second_wall_in_one_tick():
    """The tutorial's own point 2: 0.2 to the right wall, then 0.4 to the top one, within one tick of 0.5."""
    scene = flying(*box(1.0, 1.0))
    closest_only = run(scene, (0.8, 0.6), (1.0, 1.0), 0.5, 1, recheck=False)
    assert closest_only.position == pytest.approx((0.7, 1.1))
    assert closest_only.velocity == pytest.approx((-1.0, 1.0))
    recheck = run(scene, (0.8, 0.6), (1.0, 1.0), 0.5, 1)
    assert recheck.position == pytest.approx((0.7, 0.9))
    assert recheck.velocity == pytest.approx((-1.0, -1.0))


def test_both_versions_agree_where_one_wall_is_hit():
    scene = flying(*box(1.0, 1.0))
    once, again = (run(scene, (0.8, 0.3), (1.0, 0.5), 0.5, 1, recheck) for recheck in (False, True))
    assert once == again
    assert once.velocity == (-1.0, 0.5)


@pytest.mark.parametrize("dt", [0.125, 8.0])
def test_wall_is_hit_from_its_other_side_after_the_point_went_round_its_end(dt):
    ceiling_and_floor = Wall((0, 0), (9, 0)), Wall((-9, -1), (9, -1))
    state = run(flying(*ceiling_and_floor), (-1.0, 0.5), (1.0, -1.0), dt, round(8 / dt))
    assert state.velocity == (1.0, 1.0)  # floor at 1.5 s, ceiling at 2.5 s ... floor at 7.5 s
    assert state.position == pytest.approx((7.0, -0.5))


def test_closest_of_several_walls_is_picked_whatever_their_order():
    near, far = Wall((0.5, -1), (0.5, 1), b=0.5), Wall((0.6, -1), (0.6, 1), b=0.25)
    for walls in ((near, far), (far, near)):
        assert run(flying(*walls), (0.0, 0.0), (1.0, 0.0), 1.0, 1).velocity == (-0.5, 0.0)


def test_walls_that_end_before_the_path_are_not_hit():
    assert run(flying(Wall((1, 0.1), (1, 2))), (0.0, 0.0), (1.0, 0.0), 2.0, 1).position == (2.0, 0.0)


@pytest.mark.parametrize("recheck", [False, True])
@pytest.mark.parametrize("slope", [0.0, 0.1, 1 / 3, 0.7])
def test_tick_that_ends_on_a_wall_neither_passes_it_nor_hits_it_twice(slope, recheck):
    """Speed and tick are such that every tick ends on one of two parallel walls, in rounded numbers."""
    c, s = math.cos(slope), math.sin(slope)
    walls = [Wall((-9 * c - y * s, -9 * s + y * c), (9 * c - y * s, 9 * s + y * c)) for y in (0.3, -0.4)]
    state = start(flying(*walls), (-0.3 * s, 0.3 * c), (7 * s, -7 * c))
    for tick in range(200):  # the tutorial's formulas lose an ulp of speed a bounce
        state = step(flying(*walls), state, 0.1, recheck)
        away = 7 if tick % 2 == 0 else -7  # bounced at the tick's end or at the start of the next one
        y = state.position[1] * c - state.position[0] * s
        assert y == pytest.approx(-0.4 if tick % 2 == 0 else 0.3, abs=1e-11)
        assert abs(state.velocity[1] * c - state.velocity[0] * s) == pytest.approx(abs(away), rel=1e-11)


def test_corner_reverses_the_point():
    for wall_order in (1, -1):
        scene = flying(*box(1.0, 1.0)[::wall_order])
        state = run(scene, (0.5, 0.5), (0.6, 0.6), 1.0, 1)
        assert state.velocity == pytest.approx((-0.6, -0.6), rel=1e-15)
        assert state.position == pytest.approx((0.9, 0.9), rel=1e-15)


def test_point_that_starts_on_a_wall_leaves_it_or_is_pressed_on_it():
    floor = Wall((-1, 0), (1, 0))
    assert run(flying(floor), (0.0, 0.0), (0.25, 1.0), 0.5, 1).position == (0.125, 0.5)
    assert run(flying(floor), (0.0, 0.0), (0.25, -1.0), 0.5, 1).position == (0.125, -0.5)
    for g in (-2.0, 2.0):
        y = run(Scene(gravity=(0, g), elements=(floor,)), (0.0, 0.0), (0.0, 0.0), 0.5, 2).position[1]
        assert y * g < 0  # it has bounced off


def test_gravity_is_stepped_velocity_first():
    state = run(Scene(gravity=(0.5, -2.0)), (0.0, 0.0), (1.0, 3.0), 0.25, 8)
    assert state.velocity == (2.0, -1.0)
    n, dt = 8, 0.25
    fallen = dt * dt * n * (n + 1) / 2
    assert state.position == (1.0 * n * dt + 0.5 * fallen, 3.0 * n * dt - 2.0 * fallen)


def test_more_than_the_tutorial_knows_is_refused_by_name():
    floor = Wall((0, 0), (1, 0), name="floor")
    refused = [
        (Scene(ball=Ball(radius=0.1), elements=(floor,)), r"ball: radius=0\.1 is not allowed"),
        (Scene(elements=(floor, Bumper((3, 3), 1, name="pop"))), r"element 1 \(pop\): a Bumper is not"),
        (
            Scene(max_speed=9, elements=(floor, Wall((0, 1), (1, 1), kick=2))),
            r"element 1 \(Wall\): kick=2\.0",
        ),
    ]
    for scene, message in refused:
        with pytest.raises(ValueError, match=message):
            start(scene, (0, 5), (0, 0))


def test_bad_numbers_are_refused_by_name():
    scene = flying(Wall((0, 0), (1, 0)))
    with pytest.raises(ValueError, match=r"velocity: .*nan.* finite"):
        start(scene, (0, 1), (0, math.nan))
    with pytest.raises(ValueError, match=r"position: .*inf.* finite"):
        start(scene, (0, math.inf), (0, 1))
    for dt in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match=r"dt: .* positive and finite"):
            run(scene, (0, 1), (0, 1), dt, 1)


def test_cap_on_speed_is_reported_not_ignored():
    scene = Scene(gravity=(0, 0), max_speed=1.5, elements=(Wall((-1, 0), (1, 0), b=2),))
    with pytest.raises(ValueError, match=r"element 0: .*max_speed=1\.5"):
        run(scene, (0, 0.5), (0, -1), 1.0, 1)


def test_endless_wedge_is_reported():
    """With b = 0 in a sharp corner each wall sends the point along itself, into the other one, for ever."""
    scene = flying(Wall((0, 0), (1, 0), b=0.0), Wall((0, 0), (1, 0.001), b=0.0))
    with pytest.raises(RuntimeError, match=f"{tutorial.MAX_BOUNCES} bounces in one tick"):
        run(scene, (0.5, 0.00025), (-1.0, 0.0), 1.0, 1)
