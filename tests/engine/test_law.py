"""The bounce law against the vector formula, and the cap."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bounce_env.engine.compile.jit import from_python
from bounce_env.engine.contact import restitution
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

bounce, capped = from_python(restitution.bounce), from_python(restitution.capped)

speed = st.floats(-10.0, 10.0)
angle = st.floats(0.0, 2.0 * math.pi)


@settings(max_examples=soak_count(300, 100_000), deadline=None)
@given(v=st.tuples(speed, speed), u=st.tuples(speed, speed), a=angle, b=st.floats(0.0, 3.0), f=st.floats(0.0, 1.0))
def test_bounce_is_the_law(v: tuple[float, float], u: tuple[float, float], a: float, b: float, f: float) -> None:
    """v' = u + f w_t - b w_n with w = v - u."""
    nx, ny = math.cos(a), math.sin(a)
    wx, wy = v[0] - u[0], v[1] - u[1]
    normal = wx * nx + wy * ny
    tx, ty = wx - normal * nx, wy - normal * ny
    x, y = bounce(*v, nx, ny, *u, -b * normal, f)
    assert math.isclose(x, u[0] + f * tx - b * normal * nx, abs_tol=1e-13)
    assert math.isclose(y, u[1] + f * ty - b * normal * ny, abs_tol=1e-13)


def test_tar_and_glue() -> None:
    assert bounce(3.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0) == (3.0, 0.0)
    assert bounce(3.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0) == (0.0, 0.0)


@settings(max_examples=soak_count(500, 100_000), deadline=None)
@given(v=st.tuples(speed, speed), a=angle, push=st.floats(-0.99, 0.99), cap=st.floats(0.1, 5.0))
def test_cap_never_leaves_the_ball_closing(v: tuple[float, float], a: float, push: float, cap: float) -> None:
    """After a bounce the ball leaves the surface, which moves slower than the cap; so it does after the cap."""
    nx, ny = math.cos(a), math.sin(a)
    ux, uy = push * cap * nx, push * cap * ny
    if (v[0] - ux) * nx + (v[1] - uy) * ny < 0.0:
        return
    x, y, shrunk = capped(*v, nx, ny, ux, uy, cap)
    assert math.hypot(x, y) <= cap * (1.0 + 4e-16) or not shrunk
    assert shrunk == (v[0] * v[0] + v[1] * v[1] > cap * cap)
    assert (x - ux) * nx + (y - uy) * ny >= -1e-15 * cap
