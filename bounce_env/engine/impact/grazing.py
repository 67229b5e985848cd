"""Touches in passing: where a path just reaches a surface and bends away from it again, and what is too slow to hit."""

import math

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.motion.flight import Flight
from bounce_env.engine.tolerances import ULPS_OF_SPEED


@function
def slow_on_circle(flight: Flight, offset_radius: float, tolerance: float) -> float:
    """Return the speed [m/s] below which closing on a circle is no hit: the rounding of velocity and normal."""
    return (ULPS_OF_SPEED + tolerance / offset_radius) * (abs(flight.vx) + abs(flight.vy))


@function
def _bending_coasting(flight: Flight) -> float:
    distance = math.sqrt(flight.x * flight.x + flight.y * flight.y)
    across = (flight.x * flight.vy - flight.y * flight.vx) / distance
    return across * across / distance


@where("ax", otherwise=_bending_coasting)
def bending(flight: Flight) -> float:
    """Return the second derivative [m/s^2] of the distance from the origin."""
    distance = math.sqrt(flight.x * flight.x + flight.y * flight.y)
    return _bending_coasting(flight) + (flight.x * flight.ax + flight.y * flight.ay) / distance


@function
def grazes(closing_square: float, opening: float, depth: float) -> bool:
    """Return whether a ball comes no deeper than `depth` [m] into what it closes on, while its gap bends open.

    closing_square: the square of how fast it closes [m^2/s^2]. opening: the gap's second derivative [m/s^2]. The
    instant of such a touch in passing is where the path is nearest, after closing / opening seconds: nothing closes
    there, so that there is no bounce, but all that the ball touches is seen, as where a wall goes on as a tangent arc.
    """
    return closing_square < 2.0 * opening * depth
