"""The truths of the report against closed forms: nothing here runs the engine."""

import math

import mpmath
import numpy as np
import pytest

from bounce_env.report.problems import PROBLEMS, problem
from bounce_env.report.reference.pendulum import pendulum_flight
from bounce_env.report.truths import FRAMES, Start
from bounce_env.scene import builtin_scenes

pytestmark = pytest.mark.fast


def folded(x: float, low: float, high: float) -> float:
    """Where a point is that moves to and fro between two walls, had it gone on to x."""
    span = high - low
    there = (x - low) % (2.0 * span)
    return low + min(there, 2.0 * span - there)


def test_every_problem_is_a_built_in_scene_with_a_truth():
    assert len(PROBLEMS) == 13
    for which in PROBLEMS:
        assert which.name in builtin_scenes()
        (start,) = which.starts(1, seed=1)
        truth = which.solve(start)
        assert truth.frames.tolist() == sorted(set(truth.frames.tolist()))
        assert truth.places.shape == (len(truth.frames), 2)
        assert np.isfinite(truth.places).all()
        assert (truth.growth >= 1.0).all()
        assert (truth.order is not None) == which.ordered


def test_starts_are_the_same_for_every_method_and_others_for_another_seed():
    which = problem("box")
    assert which.starts(3, 0) == which.starts(3, 0) == which.starts(5, 0)[:3]
    assert which.starts(3, 0) != which.starts(3, 1)


def test_in_the_elastic_box_the_unfolded_way_is_straight():
    start = Start((0.3, 0.4), (2.0, -1.5))
    truth = problem("elastic_box").solve(start)
    for frame, (x, y) in zip(truth.frames.tolist(), truth.places.tolist(), strict=True):
        t = frame / FRAMES
        assert x == pytest.approx(folded(0.3 + 2.0 * t, 0.05, 1.95), abs=1e-13)
        assert y == pytest.approx(folded(0.4 - 1.5 * t, 0.05, 0.95), abs=1e-13)
    assert set(truth.order) == {0, 1, 2, 3}


def test_a_zeno_drop_is_over_at_the_sum_of_the_series_and_its_first_hops_are_parabolas():
    start = Start((0.0, 0.55), (0.25, 0.0))
    truth = problem("zeno_drop").solve(start)
    over = math.sqrt(2 * 0.5 / 9.81) * (1 + 0.7) / (1 - 0.7)
    for frame, (x, y) in zip(truth.frames.tolist(), truth.places.tolist(), strict=True):
        assert x == pytest.approx(0.25 * frame / FRAMES, rel=1e-15)
        assert (y == 0.05) == (frame / FRAMES > over)
    fall, t = math.sqrt(2 * 0.5 / 9.81), 30 / FRAMES
    rise = 0.7 * 9.81 * fall
    assert truth.frames[0] == 30
    assert truth.places[0, 1] == pytest.approx(0.05 + rise * (t - fall) - 9.81 * (t - fall) ** 2 / 2, rel=1e-14)


def test_a_release_is_where_the_press_is_zero_and_the_flight_goes_on_from_there():
    radius, pull, speed = 0.95, 9.81, math.sqrt(3.5 * 9.81 * 0.95)
    place, again = pendulum_flight(radius, 0.0, -radius, speed, pull, lets_go=True)
    times = [mpmath.mpf(k) / 1000 for k in range(int(again * 1000))]
    distance = [math.hypot(*place(t)) for t in times]
    assert max(distance) == pytest.approx(radius, rel=1e-14)
    release = next(t for t, d in zip(times, distance, strict=True) if d < radius * (1 - 1e-12))
    # cos = (v^2 - 2 g r) / (3 g r), from the top down.
    assert place(release)[1] == pytest.approx(radius * (3.5 - 2.0) / 3.0, abs=5e-3)
    assert math.hypot(*place(again)) == pytest.approx(radius, rel=1e-14)


def test_the_growth_of_a_small_error_is_that_of_the_next_start():
    which = problem("box")
    start = which.starts(6, 0)[1]
    truth = which.solve(start)
    x, y = start.position
    other = which.solve(Start((x + 1e-12, y + 1e-12 / 3), start.velocity))
    grown = np.hypot(*(other.places - truth.places).T) / 1e-12
    assert truth.growth[-1] > 100.0
    assert grown == pytest.approx(truth.growth, rel=0.02)
