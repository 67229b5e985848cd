"""Flight in closed form, from the last event: p(t) = p0 + v0 t + g t^2 / 2, v(t) = v0 + g t.

`g` is None in a scene without gravity, and then nothing of it is compiled. A component that is zero at run time takes
the same formula as one that is not there, so that the general kernel gives the same bits as the lean one.
"""

import math

from bounce_env.engine.compile.jit import Feature, Record, function, function_of_feature
from bounce_env.engine.tolerances import ULPS_OF_LENGTH, ULPS_OF_SPEED


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
    root = math.sqrt(speed * speed + 2.0 * g * room)
    # The form that adds two terms of one sign: along a wall next to nothing of gravity may be left.
    return 2.0 * room / (root + speed) if speed > 0.0 else (root - speed) / g


@function
def touch_tolerance(extent: float, vx: float, vy: float, gx: Feature, gy: Feature, t: float) -> float:
    """What counts as touching [m] after a flight of `t` seconds: rounding of the lengths that entered its end."""
    return ULPS_OF_LENGTH * (extent + (abs(vx) + abs(vy) + magnitude(gx, gy) * t) * t)


@function
def fly(ball: Record, gx: Feature, gy: Feature, t: float, hi: float, lo: float) -> None:
    """Move the ball along its flight by `t` seconds and let that be where, at (hi, lo), a new one starts."""
    ball.x, ball.y = moved(ball.x, ball.vx, gx, t), moved(ball.y, ball.vy, gy, t)
    ball.vx, ball.vy = sped(ball.vx, gx, t), sped(ball.vy, gy, t)
    ball.hi, ball.lo = hi, lo


@function
def slow_on_circle(vx: float, vy: float, reach: float, slack: float) -> float:
    """Closing slower than this [m/s] is no hit of a circle: the rounding of the velocity and of the normal."""
    return (ULPS_OF_SPEED + slack / reach) * (abs(vx) + abs(vy))


@function
def bending(x: float, y: float, vx: float, vy: float, ax: Feature, ay: Feature) -> float:
    """Second derivative [m/s^2] of the distance from the origin."""
    distance = math.sqrt(x * x + y * y)
    across = (x * vy - y * vx) / distance
    turn = across * across / distance
    if ax is None:
        return turn
    return turn + (x * ax + y * ay) / distance


@function
def grazes(closing_square: float, opening: float, depth: float) -> bool:
    """Whether a ball comes no deeper than `depth` [m] into what it closes on, while its gap bends open.

    closing_square: the square of how fast it closes in [m^2/s^2]. opening: the gap's second derivative [m/s^2].
    Such a touch in passing is told where the path is nearest, after closing / opening seconds: nothing closes there, so
    there is no bounce, but all that the ball touches is seen, as where a wall goes on smoothly as an arc.
    """
    return closing_square < 2.0 * opening * depth
