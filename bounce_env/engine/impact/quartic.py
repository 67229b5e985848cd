"""Crossings of a circle on a curved flight, all of them in order: what an arc needs, whose inside is not convex.

The squared distance from the centre less the squared radius is a polynomial of degree four in time. The roots of its
second derivative (a quadratic) part time into intervals on which the first is monotone, the first's roots into
intervals on which the polynomial itself is, and in each of these a root is bracketed: none can be stepped over.
"""

import math

from bounce_env.engine.compile.jit import function
from bounce_env.engine.motion.flight import Flight
from bounce_env.engine.tolerances import BRACKETING_STEPS

Coefficients = tuple[float, float, float, float, float]  # of t^0 to t^4


@function
def distance_quartic(flight: Flight, offset_radius: float) -> Coefficients:
    """Return |p(t)|^2 - offset_radius^2 of a flight p(t), as a polynomial in t."""
    x, y, vx, vy, ax, ay = flight
    distance = math.sqrt(x * x + y * y)
    return (
        (distance - offset_radius) * (distance + offset_radius),
        2.0 * (x * vx + y * vy),
        vx * vx + vy * vy + x * ax + y * ay,
        vx * ax + vy * ay,
        0.25 * (ax * ax + ay * ay),
    )


@function
def quartic_without_root_at_zero(c: Coefficients) -> Coefficients:
    """Return the polynomial divided by t, its constant taken for zero: all crossings but the one at the start."""
    return c[1], c[2], c[3], c[4], 0.0


@function
def quartic_value(c: Coefficients, t: float) -> float:
    """Return the polynomial at t."""
    return c[0] + (c[1] + (c[2] + (c[3] + c[4] * t) * t) * t) * t


@function
def quartic_slope(c: Coefficients, t: float) -> float:
    """Return its first derivative at t."""
    return c[1] + (2.0 * c[2] + (3.0 * c[3] + 4.0 * c[4] * t) * t) * t


@function
def quartic_inflections(c: Coefficients, horizon: float) -> tuple[float, float]:
    """Return the roots of the second derivative, in order and cut to [0, horizon]."""
    p, q, r = 2.0 * c[2], 3.0 * c[3], 12.0 * c[4]  # p + 2 q t + r t^2
    square = q * q - p * r
    if square <= 0.0:
        return 0.0, 0.0
    z = -(q + math.copysign(math.sqrt(square), q))
    first = z / r if r != 0.0 else math.inf
    second = p / z if z != 0.0 else 0.0
    first, second = min(max(first, 0.0), horizon), min(max(second, 0.0), horizon)
    return min(first, second), max(first, second)


@function
def quartic_turning_point(c: Coefficients, low: float, high: float) -> float:
    """Return where in [low, high] the first derivative, monotone there, is zero; `low` if nowhere."""
    at_low = quartic_slope(c, low)
    if (at_low < 0.0) == (quartic_slope(c, high) < 0.0):
        return low
    start, end = low, high
    t = 0.5 * (start + end)
    for _ in range(BRACKETING_STEPS):
        s = quartic_slope(c, t)
        if (s < 0.0) == (at_low < 0.0):
            start = t
        else:
            end = t
        curvature = 2.0 * c[2] + (6.0 * c[3] + 12.0 * c[4] * t) * t
        following = t - s / curvature
        if not start < following < end:
            following = 0.5 * (start + end)
        if following == t or end - start <= 1e-15 * end:
            break
        t = following
    return t


@function
def quartic_root_between(c: Coefficients, low: float, high: float) -> float:
    """Return the root in [low, high], where the polynomial is monotone and changes sign."""
    at_low = quartic_value(c, low)
    start, end = low, high
    t = 0.5 * (start + end)
    for _ in range(BRACKETING_STEPS):
        f = quartic_value(c, t)
        if (f < 0.0) == (at_low < 0.0):
            start = t
        else:
            end = t
        following = t - f / quartic_slope(c, t)
        if not start < following < end:
            following = 0.5 * (start + end)
        if following == t or end - start <= 1e-16 * end:
            break
        t = following
    return t


@function
def quartic_monotone_borders(c: Coefficients, horizon: float) -> tuple[float, float, float, float, float]:
    """Return times in order, from 0 to `horizon`, between which the polynomial is monotone."""
    first, second = quartic_inflections(c, horizon)
    return (
        0.0,
        quartic_turning_point(c, 0.0, first),
        quartic_turning_point(c, first, second),
        quartic_turning_point(c, second, horizon),
        horizon,
    )
