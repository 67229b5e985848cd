"""The path of a ball from its last event on, whatever it is: a flight, or a slide on a curve."""

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.memory.records import ON_CURVE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.curve_slide import curve_slide_acceleration, curve_slide_after, curve_slide_of
from bounce_env.engine.motion.flight import (
    acceleration_magnitude,
    flight_of,
    flight_path_bound,
    flight_place_after,
    flight_velocity_after,
)

Motion = tuple[float, float, float, float]


@where("curve_slides", otherwise=False)
def is_on_curve(state: State, w: int, k: int) -> bool:
    """Return whether a ball slides on a circle or an arc."""
    return state.balls[w, k].contact == ON_CURVE


@function
def _flight_motion_after(state: State, w: int, k: int, t: float) -> Motion:
    flight = flight_of(state, state.balls[w, k])
    x, y = flight_place_after(flight, t)
    vx, vy = flight_velocity_after(flight, t)
    return x, y, vx, vy


@where("curve_slides", otherwise=_flight_motion_after)
def motion_after(state: State, w: int, k: int, t: float) -> Motion:
    """Return where [m] a ball is `t` seconds after its last event, and how fast [m/s]: (x, y, vx, vy)."""
    if is_on_curve(state, w, k) and t != 0.0:  # at its last event it may have been pushed off, and not be resolved yet
        return curve_slide_after(curve_slide_of(state.curve_slides[w, k]), t)
    return _flight_motion_after(state, w, k, t)


@function
def _flight_length_bound(state: State, w: int, k: int, t: float) -> float:
    return flight_path_bound(flight_of(state, state.balls[w, k]), t)


@where("curve_slides", otherwise=_flight_length_bound)
def path_length_bound(state: State, w: int, k: int, t: float) -> float:
    """Return a length [m] that the path of a ball in the `t` seconds after its last event does not exceed."""
    if is_on_curve(state, w, k):
        return state.curve_slides[w, k].lowest_speed * t
    return _flight_length_bound(state, w, k, t)


@function
def _flight_acceleration_bound(state: State, w: int, k: int) -> float:
    flight = flight_of(state, state.balls[w, k])
    return acceleration_magnitude(flight.ax, flight.ay)


@where("curve_slides", otherwise=_flight_acceleration_bound)
def acceleration_bound(state: State, w: int, k: int) -> float:
    """Return what the magnitude of a ball's acceleration [m/s^2] does not exceed until its next event."""
    if is_on_curve(state, w, k):
        ball = state.balls[w, k]
        return curve_slide_acceleration(curve_slide_of(state.curve_slides[w, k]), ball.gx, ball.gy)
    return _flight_acceleration_bound(state, w, k)


@function
def _flight_acceleration(state: State, w: int, k: int, motion: Motion) -> tuple[float, float]:
    return state.balls[w, k].ax, state.balls[w, k].ay


@where("curve_slides", otherwise=_flight_acceleration)
def acceleration_in(state: State, w: int, k: int, motion: Motion) -> tuple[float, float]:
    """Return the acceleration [m/s^2] of a ball at a point of its path; on a curve it changes."""
    if not is_on_curve(state, w, k):
        return _flight_acceleration(state, w, k, motion)
    ball, slide, (x, y, vx, vy) = state.balls[w, k], state.curve_slides[w, k], motion
    nx, ny = (x - slide.x) / slide.radius, (y - slide.y) / slide.radius
    along, inward = ball.gy * nx - ball.gx * ny, (vx * vx + vy * vy) / slide.radius
    return -along * ny - inward * nx, along * nx - inward * ny
