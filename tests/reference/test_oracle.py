"""The oracle itself, by what must hold for any right engine; the engine under test takes no part."""

from itertools import pairwise

import mpmath
import pytest
from mpmath import mpf

from bounce_env.report.reference.flights import BOUNCE, PART_STOPS, SENSOR, Oracle
from bounce_env.report.reference.polynomials import evaluate, roots
from bounce_env.scene import Ball, Bumper, Paddle, Scene, Sensor, Wall
from tests.conftest import soak_count
from tests.reference.random_scenes import box, clearance, table


@pytest.fixture(autouse=True)
def _fifty_digits():
    with mpmath.workdps(50):
        yield


def oracle(scene):
    return Oracle(scene, mpf, mpf(10) ** -35)


def test_roots_of_a_quartic_with_known_roots():
    poly = [mpf(1)]
    for root in (mpf(1) / 3, mpf(-2), mpf(5) / 7, mpf(3)):
        poly = [a - root * b for a, b in zip([0, *poly], [*poly, 0], strict=True)]
    found = roots(poly, mpf(2))
    assert found == pytest.approx([mpf(1) / 3, mpf(5) / 7], rel=1e-45)
    assert all(abs(evaluate(poly, t)) < 1e-45 for t in found)


@pytest.mark.parametrize("radius", [0.0, 0.02])
def test_elastic_flight_conserves_energy_and_runs_backwards(radius):
    elements = (*box(1.0, 1.4), Bumper((0.3, 0.9), 0.1), Bumper((0.7, 0.6), 0.08))
    scene = Scene(gravity=(0.2, -1.5), ball=Ball(radius=radius), elements=elements)
    there = oracle(scene).run((0.3, 0.4), (1.0, 1.3), mpf(12))
    assert len(there.events) >= 12
    for e in there.events:
        energy = (e.vx**2 + e.vy**2) / 2 - mpf(0.2) * e.x + mpf(1.5) * e.y
        assert abs(energy - (mpf(1) + mpf(1.3) ** 2) / 2 + mpf(0.2) * mpf(0.3) - mpf(1.5) * mpf(0.4)) < 1e-45
    back = oracle(scene).run(there.position, tuple(-v for v in there.velocity), mpf(12))
    assert [e.element for e in back.events] == [e.element for e in reversed(there.events)]
    assert mpmath.hypot(back.position[0] - mpf(0.3), back.position[1] - mpf(0.4)) < 1e-35


@pytest.mark.parametrize("seed", range(soak_count(4, 40)))
def test_path_never_enters_an_obstacle(seed):
    case = table(seed, gravity=True, radius=0.02)
    run = oracle(case.scene).run(case.position, case.velocity, mpf(60), max_events=12)
    bounces = [e for e in run.events if e.kind == BOUNCE]
    assert len(bounces) >= 4
    gx, gy = case.scene.gravity
    solid = [e for e in case.scene.elements if not isinstance(e, Sensor)]
    for e, following in pairwise(bounces):
        flight = float(following.time - e.time)
        for k in range(200):
            t = flight * k / 200
            p = (float(e.x + e.vx * t + gx * t * t / 2), float(e.y + e.vy * t + gy * t * t / 2))
            assert min(clearance(p, s) for s in solid) > 0.02 - 1e-12


def test_lossy_drop():
    scene = Scene(gravity=(0, -2), ball=Ball(radius=0.25, b=0.5), elements=(Wall((-1, 0), (1, 0)),))
    events = oracle(scene).run((0, 1.25), (0, 0), mpf("2.5")).events
    assert [float(e.time) for e in events] == pytest.approx([1, 2, 2.5], abs=1e-15)
    assert [float(e.vy) for e in events] == pytest.approx([1, 0.5, 0.25], abs=1e-15)


def test_corner_and_drain_and_sensor():
    scene = Scene(
        gravity=(0, 0),
        ball=Ball(radius=0.25),
        elements=(*box(2.0, 2.0), Sensor((0, 1.25), (2, 1.25)), Sensor((0, 0.5), (2, 0.5), drain=True)),
    )
    run = oracle(scene).run((1, 1), (1, 1), mpf(10))
    assert [e.element for e in run.events] == [4, 1, 2, 4, 5]
    assert [e.kind for e in run.events] == [SENSOR, BOUNCE, BOUNCE, SENSOR, SENSOR]
    assert [float(e.time) for e in run.events] == [0.25, 0.75, 0.75, 1.25, 2.0]
    assert run.out
    assert (run.position, run.velocity) == ((0.5, 0.5), (-1, -1))


def test_paddle_overtakes_stops_and_caps():
    paddle = Paddle((0, 0), (4, 0), half_width=0.5, radius=0.25, max_speed=2)
    scene = Scene(gravity=(0, 0), ball=Ball(radius=0.25), max_speed=3, elements=(paddle,))
    run = oracle(scene).run((3.5, 0), (0.5, 0), mpf(2), [(0, 2)])
    hit, stop = run.events
    assert (hit.kind, float(hit.time)) == (BOUNCE, pytest.approx(1 / 3))
    assert hit.vx == 3  # 2u - v = 3.5, capped
    assert (stop.kind, float(stop.time)) == (PART_STOPS, 1)


def test_cap_never_leaves_the_ball_closing():
    """u.n = 2; v' = (100, 2.1) is capped to 3: shrinking it as a whole would leave v'.n = 0.06."""
    paddle = Paddle((0, 0), (0, 9), half_width=0, radius=0.5, max_speed=2, b=0.05)
    scene = Scene(gravity=(0, 0), ball=Ball(radius=0.5), max_speed=3, elements=(paddle,))
    engine = oracle(scene)
    engine.run((0, 20), (100, 0), mpf(0))
    engine.v = (mpf(100), mpf(0))
    after = engine.after(0, (mpf(0), mpf(2)), (mpf(0), mpf(1)))
    assert float(after[1]) == pytest.approx(2.1)
    assert float(mpmath.hypot(*after)) == pytest.approx(3)
