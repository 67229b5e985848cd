"""Time of impact against closed forms in extended precision, and against dense sampling: no root is stepped over."""

import math

import mpmath
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from bounce_env.engine.compile.jit import from_python
from bounce_env.engine.impact import arc, capsule, circle, line
from bounce_env.engine.motion import roots
from bounce_env.engine.motion.flight import Flight
from bounce_env.engine.motion.parts import Core
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

capsule_time, circle_time, face_time = map(from_python, (capsule.capsule_time, circle.circle_time, line.face_time))
falling_time, straight_circle_time = map(from_python, (roots.falling_root, circle.straight_circle_time))
crossing_time = from_python(arc.arc_crossing_time)

SLACK = 16.0 * 2.0**-52
coordinate = st.floats(-5.0, 5.0)
normal = st.floats(-5.0, 5.0, allow_subnormal=False)  # a subnormal number has lost digits before anything is computed
positive = st.floats(1e-3, 10.0)


@settings(max_examples=soak_count(300, 100_000), deadline=None)
@given(gap=st.floats(0.0, 10.0, allow_subnormal=False), rate=normal, pull=normal)
def test_falling_time_is_the_falling_root(gap: float, rate: float, pull: float) -> None:
    """The root taken in 50 digits, within 4 units in the last place; no root where there is none."""
    t = falling_time(gap, False, rate, pull)
    with mpmath.workdps(50):
        g, r, a = mpmath.mpf(gap), mpmath.mpf(rate), mpmath.mpf(pull)
        square = r * r - 2 * a * g
        if abs(square) < mpmath.mpf(10) ** -12 * (r * r + abs(a * g) + mpmath.mpf(10) ** -300):
            return  # a graze: touching is not falling through, and round-off decides
        if 0 < r * r + abs(2 * a * g) < mpmath.mpf(10) ** -290:
            return  # the squares are subnormal numbers, or nearly so, and have lost digits
        if a == 0:
            expected = g / -r if r < 0 else mpmath.inf
        elif square < 0 or (a > 0 and r >= 0):
            expected = mpmath.inf
        else:
            root = mpmath.sqrt(square)
            expected = 2 * g / (root - r) if r < 0 else (r + root) / -a
        if expected > 1e300:  # no run is that long, and it may be more than a float holds
            assert t > 1e300
        else:
            # Where the two terms under the root nearly cancel, the root itself is that ill-conditioned.
            condition = 1 + (r * r + abs(2 * a * g)) / abs(square)
            assert abs(t - expected) <= 4e-16 * condition * abs(expected) + mpmath.mpf(10) ** -300


def test_falling_time_from_behind_needs_to_rise_first() -> None:
    assert falling_time(-1.0, True, -1.0, 1.0) == math.inf
    assert falling_time(-1.0, True, 1.0, None) == math.inf
    assert falling_time(-1.0, True, 1.0, -10.0) == math.inf  # does not rise high enough
    assert falling_time(-1.0, True, 3.0, -1.0) == pytest.approx(3.0 + math.sqrt(7.0), rel=1e-15)


def dense_gap(x: float, y: float, vx: float, vy: float, g: tuple[float, float], t: np.ndarray) -> np.ndarray:
    """Distance from the origin along a flight."""
    return np.hypot(x + vx * t + 0.5 * g[0] * t * t, y + vy * t + 0.5 * g[1] * t * t)


@settings(max_examples=soak_count(300, 100_000), deadline=None)
@given(x=coordinate, y=coordinate, vx=coordinate, vy=coordinate, gx=coordinate, gy=coordinate, reach=positive)
@example(x=0.0, y=2.0, vx=0.0, vy=0.0, gx=1e-185, gy=4e-260, reach=1.0)  # gravity whose square is 0
def test_no_circle_is_stepped_over(
    x: float, y: float, vx: float, vy: float, gx: float, gy: float, reach: float
) -> None:
    """Up to the time found the flight stays outside, at it it touches and closes; if none is found, it never enters."""
    if math.hypot(x, y) < reach * 1.0001:
        return
    horizon = 20.0
    scale = reach + math.hypot(x, y) + (math.hypot(vx, vy) + math.hypot(gx, gy) * horizon) * horizon
    slack = SLACK * scale
    t = circle_time(Flight(x, y, vx, vy, gx, gy), reach, slack, horizon)
    end = min(t, horizon)
    samples = dense_gap(x, y, vx, vy, (gx, gy), np.linspace(0.0, end, 20_001))
    assert samples.min() >= reach - 4.0 * slack
    if t < horizon:
        px, py = x + vx * t + 0.5 * gx * t * t, y + vy * t + 0.5 * gy * t * t
        assert abs(math.hypot(px, py) - reach) <= 4.0 * slack
        qx, qy = vx + gx * t, vy + gy * t
        # Where it only touches in passing it is told nearest, where nothing closes.
        assert px * qx + py * qy <= 4.0 * slack * math.hypot(qx, qy)


@pytest.mark.parametrize("sense", [-1.0, 1.0])
def test_no_circle_is_stepped_over_from_a_touch(sense: float) -> None:
    """Just after a bounce from outside (-1) or inside (1) the ball leaves it at any speed that is more than rounding.

    Samples in equal ratios from the start on: hops may be 1e-16 of a second long.
    """
    rng, hits = np.random.default_rng(3), 0
    for _ in range(soak_count(2000, 200_000)):
        reach, speed, pull = 10.0 ** rng.uniform((-2.0, -6.0, -2.0), (0.0, 1.0, 2.0))
        leaving = speed * 10.0 ** rng.uniform(-17.0, 0.0)
        angles = rng.uniform(0.0, 2.0 * math.pi, 2)
        (nx, down), (ny, across) = np.cos(angles).tolist(), np.sin(angles).tolist()
        x, y = reach * nx, reach * ny
        vx, vy = -speed * ny - sense * leaving * nx, speed * nx - sense * leaving * ny
        gx, gy = pull * down, pull * across
        slack = SLACK * (1.0 + reach)
        # What moves along the circle and is drawn onto it is in contact (`gap_trend`): no search is asked of it.
        bend = -sense * (gx * nx + gy * ny + speed * speed / reach)
        if leaving <= 2.0 * (SLACK + slack / reach) * speed and bend < 0.0:
            continue
        if sense < 0.0:
            t = circle_time(Flight(x, y, vx, vy, gx, gy), reach, slack, 1.0)
        else:
            t = crossing_time(Flight(x, y, vx, vy, gx, gy), None, arc.Circle(reach, sense), True, slack, -1.0, 1.0)
        end = min(t, 1.0)
        instants = np.concatenate([np.geomspace(1e-16, 1.0, 300), np.linspace(0.0, 1.0, 300)]) * end
        gaps = -sense * (dense_gap(x, y, vx, vy, (gx, gy), instants) - reach)
        assert gaps.min() >= -slack - SLACK * (speed + leaving + 2.0 * pull * end) * end
        hits += 0.0 < t < 1.0
    assert hits > 500


@settings(max_examples=soak_count(300, 100_000), deadline=None)
@given(x=coordinate, y=coordinate, vx=coordinate, vy=coordinate, reach=positive)
def test_straight_circle_time_in_closed_form(x: float, y: float, vx: float, vy: float, reach: float) -> None:
    distance, speed = math.hypot(x, y), math.hypot(vx, vy)
    if distance < reach * 1.0001 or speed < 1e-6:
        return
    t = straight_circle_time(Flight(x, y, vx, vy, None, None), reach, SLACK, math.inf)
    with mpmath.workdps(60):
        X, Y, VX, VY, R = map(mpmath.mpf, (x, y, vx, vy, reach))
        a, b, c = VX * VX + VY * VY, X * VX + Y * VY, X * X + Y * Y - R * R
        square = b * b - a * c
        if abs(square) < mpmath.mpf(10) ** -9 * a * (X * X + Y * Y):
            return  # a graze
        if b >= 0 or square < 0:
            assert t == math.inf
        else:
            expected = (-b - mpmath.sqrt(square)) / a
            condition = (X * X + Y * Y) * a / square + (X * X + Y * Y) / abs(c)
            assert abs(t - expected) <= 4e-16 * condition * expected


@settings(max_examples=soak_count(200, 100_000), deadline=None)
@given(
    x=coordinate, y=coordinate, vx=coordinate, vy=coordinate, gy=st.floats(-5.0, 0.0),
    half=st.floats(0.01, 2.0), reach=st.floats(0.01, 1.0), angle=st.floats(0.0, 6.3),
)  # fmt: skip
@example(
    x=0.0, y=2.0, vx=2.2e-309, vy=0.0, gy=-1.0, half=1.0, reach=1.0, angle=1.0
)  # a denormal speed: its inverse is inf
def test_no_capsule_is_stepped_over(
    x: float, y: float, vx: float, vy: float, gy: float, half: float, reach: float, angle: float
) -> None:
    """A capsule from every side: dense sampling of the distance to its core finds no earlier touch."""
    ux, uy = math.cos(angle), math.sin(angle)
    ux, uy = ux / math.hypot(ux, uy), uy / math.hypot(ux, uy)

    def gap(t: np.ndarray) -> np.ndarray:
        px, py = x + vx * t, y + vy * t + 0.5 * gy * t * t
        along = np.clip(px * ux + py * uy, -half, half)
        return np.hypot(px - along * ux, py - along * uy) - reach

    if gap(np.zeros(1))[0] < 1e-6:
        return
    slack = SLACK * (abs(x) + abs(y) + half + reach + (abs(vx) + abs(vy) - gy * 10.0) * 10.0)
    t = capsule_time(Flight(x, y, vx, vy, 0.0, gy), Core(0.0, 0.0, ux, uy, -half, half), reach, slack, 10.0)
    samples = gap(np.linspace(0.0, min(t, 10.0), 20_001))
    assert samples.min() >= -4.0 * slack
    if t < 10.0:
        assert abs(gap(np.array([t]))[0]) <= 8.0 * slack


@pytest.mark.parametrize("side", [1, -1])
def test_point_on_a_wall_leaves_on_its_side(side: int) -> None:
    """A ball of no radius on the wall itself is where `side` says, whatever the sign of its round-off."""
    for offset in (0.0, 1e-17, -1e-17):
        wall = line.Line(1.0, 0.0, 9.0, 0.0)
        leaving = face_time(Flight(0.5, offset, 0.1, side * 1.0, 0.0, -side * 1.0), wall, side, SLACK, math.inf)
        assert leaving == pytest.approx(2.0, rel=1e-12)
        closing = face_time(Flight(0.5, offset, 0.1, -side * 1.0, 0.0, 0.0), wall, side, SLACK, math.inf)
        assert closing == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("height", [3.4e-14, 1e-17, 0.0])
def test_a_point_that_turns_before_a_wall_does_not_meet_its_far_face(height: float) -> None:
    """Nearly touching in a pocket, where much counts as touching, it comes down a little and is pulled up again."""
    fall = -0.9 * math.sqrt(2.0 * 3.5 * height)
    wall = line.Line(1.0, 0.0, 1.0, 0.0)
    t = face_time(Flight(0.5, height, 1e-6, fall, 5.0, 3.5), wall, 1.0, 4.5e-13, math.inf)
    assert t == math.inf
