"""The opponents: each is what it says that it is, and right in the limit of small steps."""

import numpy as np
import pytest

from bounce_env.engine import tutorial
from bounce_env.report.errors import solved
from bounce_env.report.measure import error_of
from bounce_env.report.methods import all_methods
from bounce_env.report.methods.base import Method, steps_of
from bounce_env.report.methods.moreau import Moreau
from bounce_env.report.methods.tutorial import Tutorial, points_scene
from bounce_env.report.problems import PROBLEMS, Problem, problem

pytestmark = pytest.mark.slow

STEPPERS = [m for m in all_methods() if m.name in ("moreau", "pymunk", "box2d")]
OTHERS = {"scipy", "by_hand"}


def median_error(which: Problem, method: Method, setting, count: int = 5) -> float:
    starts, truths = solved(which, count, 0)
    player = method.player(which, setting, max(truth.top_speed for truth in truths))
    errors = [
        error_of(player.trace(start, truth.frames), truth, chaotic=which.chaotic)
        for start, truth in zip(starts, truths, strict=True)
    ]
    return float(np.median(errors))


@pytest.mark.parametrize("recheck", [True, False])
@pytest.mark.parametrize("name", ["elastic_box", "gravity_box", "wedge", "zeno_incline"])
def test_the_compiled_stepper_is_the_tutorials_to_the_bit(name: str, recheck: bool):
    which = problem(name)
    player = Tutorial(recheck=recheck).player(which, steps_of(240), 1.0)
    for start in which.starts(3, 0):
        frames = np.array([30, 60, 90])
        places = player.trace(start, frames).places
        scene = points_scene(which.scene, start.position)
        for frame, place in zip(frames.tolist(), places, strict=True):
            state = tutorial.run(scene, start.position, start.velocity, 1.0 / 240, 4 * frame, recheck)
            assert place.tobytes() == np.array(state.position).tobytes()


@pytest.mark.parametrize("method", STEPPERS, ids=lambda m: m.name)
@pytest.mark.parametrize("name", ["gravity_box", "circle", "flipper_strike", "closing_wall", "pinball"])
def test_steppers_come_nearer_to_the_truth_with_smaller_steps(name: str, method: Method):
    """So they mean the same physics as the truth: kicks, caps, moving parts and arcs included.

    Box2D up to its slop, which does not shrink with its step.
    """
    which = problem(name)
    coarse, fine = (median_error(which, method, steps_of(60 * k)) for k in (1, 64))
    assert fine < (1.0 if method.name == "box2d" else 0.5) * coarse
    assert fine < 0.1


def test_moreau_keeps_a_ball_in_a_wedge_and_its_energy_in_a_box():
    player = Moreau().player(problem("gravity_box"), steps_of(240), 1.0)
    (start,) = problem("gravity_box").starts(1, 0)
    trace = player.trace(start, np.array([6000]))
    energy = 9.81 * trace.places[-1, 1] + 0.5 * np.square(trace.velocity).sum()
    assert energy == pytest.approx(9.81 * start.position[1] + 0.5 * np.square(start.velocity).sum(), rel=1e-10)


@pytest.mark.parametrize(
    "name", ["elastic_box", "box", "gravity_box", "circle", "flipper_strike", "closing_wall", "pinball"]
)
def test_an_ode_solver_agrees_with_the_truth(name: str):
    """Of all problems with finitely many bounces: another method, without the truth's polynomials and bisections."""
    scipy = next(m for m in all_methods() if m.name == "scipy")
    assert median_error(problem(name), scipy, scipy.settings[2], count=3) < 1e-11


@pytest.mark.parametrize("name", ["bowl", "loop"])
def test_an_ode_told_the_contact_agrees_with_the_truth(name: str):
    by_hand = next(m for m in all_methods() if m.name == "by_hand")
    assert median_error(problem(name), by_hand, by_hand.settings[3]) < 1e-11


def test_every_method_plays_a_problem_or_says_why_not():
    for method in all_methods():
        for which in PROBLEMS:
            reason = method.why_not(which)
            assert reason is None or reason.startswith(("not applicable: ", "not measured: "))
