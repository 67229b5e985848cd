"""Flight in closed form, from the last event: p(t) = p0 + v0 t + a t^2 / 2, v(t) = v0 + a t.

The acceleration is None in a batch without gravity, and then nothing of it is compiled. A component that is zero at run
time takes the same formula as one that is not there, so that the general kernel gives the same bits as the lean one.
"""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import NumberOrNone, Record, function, where
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import ULPS_OF_LENGTH


class Flight(NamedTuple):
    """A point in flight, seen from any origin: place [m], velocity [m/s], acceleration [m/s^2] or None."""

    x: float
    y: float
    vx: float
    vy: float
    ax: NumberOrNone
    ay: NumberOrNone


def _coasting_flight(state: State, ball: Record) -> Flight:
    return Flight(ball.x, ball.y, ball.vx, ball.vy, None, None)


@where("gravity", otherwise=_coasting_flight)
def flight_of(state: State, ball: Record) -> Flight:
    """Return the present flight of a ball, from its last event on."""
    return Flight(ball.x, ball.y, ball.vx, ball.vy, ball.ax, ball.ay)


@function
def coordinate_after(x: float, v: float, a: NumberOrNone, t: float) -> float:
    """Return one coordinate [m] after `t` seconds."""
    if a is None:
        return x + v * t
    if a == 0.0:
        return x + v * t
    return x + (v + 0.5 * a * t) * t


@function
def speed_after(v: float, a: NumberOrNone, t: float) -> float:
    """Return one component of the velocity [m/s] after `t` seconds."""
    if a is None:
        return v
    if a == 0.0:
        return v
    return v + a * t


@function
def flight_place_after(flight: Flight, t: float) -> tuple[float, float]:
    """Return where [m] the flight is after `t` seconds."""
    return coordinate_after(flight.x, flight.vx, flight.ax, t), coordinate_after(flight.y, flight.vy, flight.ay, t)


@function
def flight_velocity_after(flight: Flight, t: float) -> tuple[float, float]:
    """Return the velocity [m/s] after `t` seconds."""
    return speed_after(flight.vx, flight.ax, t), speed_after(flight.vy, flight.ay, t)


@function
def flight_after(flight: Flight, t: float) -> Flight:
    """Return the flight as it goes on after `t` seconds."""
    x, y = flight_place_after(flight, t)
    vx, vy = flight_velocity_after(flight, t)
    return Flight(x, y, vx, vy, flight.ax, flight.ay)


@function
def flight_seen_from(flight: Flight, x: float, y: float) -> Flight:
    """Return the flight with the origin at (x, y) [m]."""
    return Flight(flight.x - x, flight.y - y, flight.vx, flight.vy, flight.ax, flight.ay)


@function
def flight_seen_from_moving(flight: Flight, vx: float, vy: float) -> Flight:
    """Return the flight as seen in a frame that moves at (vx, vy) [m/s]."""
    return Flight(flight.x, flight.y, flight.vx - vx, flight.vy - vy, flight.ax, flight.ay)


def _no_flight_acceleration_along(flight: Flight, nx: float, ny: float) -> None:
    return None


@where("ax", otherwise=_no_flight_acceleration_along)
def flight_acceleration_along(flight: Flight, nx: float, ny: float) -> NumberOrNone:
    """Return the component of the acceleration [m/s^2] along a unit vector; None where there is no acceleration."""
    return flight.ax * nx + flight.ay * ny


@function
def acceleration_magnitude(ax: NumberOrNone, ay: NumberOrNone) -> float:
    """Return the length of an acceleration [m/s^2]; 0 where there is none."""
    if ax is None:
        return 0.0
    return math.sqrt(ax * ax + ay * ay)


@function
def swept_interval(x: float, v: float, a: NumberOrNone, t: float) -> tuple[float, float]:
    """Return the smallest and the largest value [m] that one coordinate takes on during the next `t` seconds."""
    end = coordinate_after(x, v, a, t)
    low, high = min(x, end), max(x, end)
    if a is not None and v * a < 0.0 and abs(v) < abs(a) * t:
        turn = x - 0.5 * v * v / a
        low, high = min(low, turn), max(high, turn)
    return low, high


def _endless_flight(flight: Flight, extent: float) -> float:
    return math.inf


@where("ax", otherwise=_endless_flight)
def flight_time_in_scene(flight: Flight, extent: float) -> float:
    """Return a duration [s] after which a free flight has fallen below everything in the scene for good.

    inf without gravity. It gives the searches of an unbounded flight an end.
    """
    g = acceleration_magnitude(flight.ax, flight.ay)
    if g == 0.0:
        return math.inf
    nx, ny = flight.ax / g, flight.ay / g
    # Nothing of the scene is further than 2 extent along any direction.
    room = max(2.0 * extent - (flight.x * nx + flight.y * ny), 0.0)
    speed = flight.vx * nx + flight.vy * ny
    root = math.sqrt(speed * speed + 2.0 * g * room)
    # The form that adds two terms of one sign: along a wall next to nothing of gravity may be left.
    return 2.0 * room / (root + speed) if speed > 0.0 else (root - speed) / g


@function
def flight_path_bound(flight: Flight, t: float) -> float:
    """Return a length [m] that the path of the next `t` seconds does not exceed."""
    return (abs(flight.vx) + abs(flight.vy) + acceleration_magnitude(flight.ax, flight.ay) * t) * t


@function
def flight_rounding(flight: Flight, extent: float, t: float) -> float:
    """Return what counts as touching [m] after `t` seconds: the rounding of the lengths that went into it."""
    return ULPS_OF_LENGTH * (extent + flight_path_bound(flight, t))
