"""Flight in closed form, from the last event: p(t) = p0 + v0 t + g t^2 / 2, v(t) = v0 + g t.

`g` is None in a scene without gravity, and then nothing of it is compiled. A component that is zero at run time takes
the same formula as one that is not there, so that the general kernel gives the same bits as the lean one.
"""

import math

from bounce_env.engine.jit import Feature, Table, function, function_of_feature
from bounce_env.engine.tolerances import ULPS_OF_LENGTH


@function
def moved(x: float, v: float, g: Feature, t: float) -> float:
    """One coordinate [m] after `t` seconds."""
    if g is None:
        return x + v * t
    if g == 0.0:
        return x + v * t
    return x + (v + 0.5 * g * t) * t


@function
def sped(v: float, g: Feature, t: float) -> float:
    """One component of the velocity [m/s] after `t` seconds."""
    if g is None:
        return v
    if g == 0.0:
        return v
    return v + g * t


def _no_pull(gravity: Table, scene: int) -> tuple[None, None]:
    return None, None


@function_of_feature(absent=_no_pull)
def pull(gravity: Table, scene: int) -> tuple[Feature, Feature]:
    """Gravity of a scene [m/s^2] as (gx, gy); (None, None) where no scene of the batch has any."""
    return gravity[scene, 0], gravity[scene, 1]


def _no_dot(ax: Feature, ay: Feature, nx: float, ny: float) -> None:
    return None


@function_of_feature(absent=_no_dot)
def dot(ax: Feature, ay: Feature, nx: float, ny: float) -> Feature:
    """Scalar product; None where the vector (gravity) is."""
    return ax * nx + ay * ny


@function
def magnitude(gx: Feature, gy: Feature) -> float:
    """Length of the gravity vector [m/s^2]; 0 where there is none."""
    if gx is None:
        return 0.0
    return math.sqrt(gx * gx + gy * gy)


@function
def swept(x: float, v: float, g: Feature, t: float) -> tuple[float, float]:
    """The smallest and the largest value [m] that one coordinate takes on during the next `t` seconds."""
    end = moved(x, v, g, t)
    low, high = min(x, end), max(x, end)
    if g is not None and v * g < 0.0 and abs(v) < abs(g) * t:
        turn = x - 0.5 * v * v / g
        low, high = min(low, turn), max(high, turn)
    return low, high


@function
def time_in_scene(extent: float, x: float, y: float, vx: float, vy: float, gx: Feature, gy: Feature) -> float:
    """A duration [s] after which a free flight has fallen below everything in the scene for good.

    inf without gravity. It gives the searches of an unbounded flight an end.
    """
    if gx is None:
        return math.inf
    g = magnitude(gx, gy)
    if g == 0.0:
        return math.inf
    nx, ny = gx / g, gy / g
    # Nothing of the scene is further than 2 extent along any direction.
    room = max(2.0 * extent - (x * nx + y * ny), 0.0)
    speed = vx * nx + vy * ny
    return (math.sqrt(speed * speed + 2.0 * g * room) - speed) / g


@function
def touch_tolerance(extent: float, vx: float, vy: float, gx: Feature, gy: Feature, t: float) -> float:
    """What counts as touching [m] after a flight of `t` seconds: rounding of the lengths that entered its end."""
    return ULPS_OF_LENGTH * (extent + (abs(vx) + abs(vy) + magnitude(gx, gy) * t) * t)
