"""The path of a ball from its last event on: a flight, a slide on a curve, or between two surfaces that carry it."""

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.memory.records import CARRIED_ALONG, ON_CURVE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.carried import (
    carried_acceleration,
    carried_acceleration_bound,
    carried_after,
    carried_direction,
    carried_of,
    carried_top_speed,
)
from bounce_env.engine.motion.curve_slide import (
    curve_slide_acceleration,
    curve_slide_after,
    curve_slide_of,
    curve_slide_top_speed,
)
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


@where("carried", otherwise=False)
def is_carried(state: State, w: int, k: int) -> bool:
    """Return whether a straight surface and a round one carry a ball between them."""
    return state.balls[w, k].contact == CARRIED_ALONG


@where("carried", otherwise=False)
def is_on_moving_curve(state: State, w: int, k: int) -> bool:
    """Return whether a ball slides on a curve that moves."""
    slide = state.curve_slides[w, k]
    return state.balls[w, k].contact == ON_CURVE and (slide.ux != 0.0 or slide.uy != 0.0)


@where("curve_slides", otherwise=False)
def is_bent(state: State, w: int, k: int) -> bool:
    """Return whether a ball's path is no flight."""
    return is_on_curve(state, w, k) or is_carried(state, w, k)


@function
def is_bent_and_moving(state: State, w: int, k: int) -> bool:
    """Return whether a ball's path lies on what moves, and is no flight: geometry alone does not tell what it meets."""
    return is_carried(state, w, k) or is_on_moving_curve(state, w, k)


@function
def _flight_motion_after(state: State, w: int, k: int, t: float) -> Motion:
    flight = flight_of(state, state.balls[w, k])
    x, y = flight_place_after(flight, t)
    vx, vy = flight_velocity_after(flight, t)
    return x, y, vx, vy


@where("carried", otherwise=_flight_motion_after)
def _motion_after_off_curves(state: State, w: int, k: int, t: float) -> Motion:
    if is_carried(state, w, k) and t != 0.0:
        return carried_after(carried_of(state.carried[w, k]), t)
    return _flight_motion_after(state, w, k, t)


@where("curve_slides", otherwise=_flight_motion_after)
def motion_after(state: State, w: int, k: int, t: float) -> Motion:
    """Return where [m] a ball is `t` seconds after its last event, and how fast [m/s]: (x, y, vx, vy)."""
    if is_on_curve(state, w, k) and t != 0.0:  # at its last event it may have been pushed off, and not be resolved yet
        return curve_slide_after(curve_slide_of(state.curve_slides[w, k]), t)
    return _motion_after_off_curves(state, w, k, t)


@function
def _flight_length_bound(state: State, w: int, k: int, t: float) -> float:
    return flight_path_bound(flight_of(state, state.balls[w, k]), t)


@where("curve_slides", otherwise=_flight_length_bound)
def path_length_bound(state: State, w: int, k: int, t: float) -> float:
    """Return a length [m] that the path of a ball in the `t` seconds after its last event does not exceed."""
    if is_bent(state, w, k):
        return top_speed_bound(state, w, k) * t
    return _flight_length_bound(state, w, k, t)


@where("carried", otherwise=0.0)
def _carried_speed_bound(state: State, w: int, k: int) -> float:
    return carried_top_speed(carried_of(state.carried[w, k])) if is_carried(state, w, k) else 0.0


@where("curve_slides", otherwise=0.0)
def top_speed_bound(state: State, w: int, k: int) -> float:
    """Return a speed [m/s] that a ball whose path is no flight does not exceed until its next event."""
    if is_on_curve(state, w, k):
        return curve_slide_top_speed(curve_slide_of(state.curve_slides[w, k]))
    return _carried_speed_bound(state, w, k)


@function
def _flight_acceleration_bound(state: State, w: int, k: int) -> float:
    flight = flight_of(state, state.balls[w, k])
    return acceleration_magnitude(flight.ax, flight.ay)


@where("carried", otherwise=_flight_acceleration_bound)
def _acceleration_bound_off_curves(state: State, w: int, k: int) -> float:
    if is_carried(state, w, k):
        return carried_acceleration_bound(carried_of(state.carried[w, k]))
    return _flight_acceleration_bound(state, w, k)


@where("curve_slides", otherwise=_flight_acceleration_bound)
def acceleration_bound(state: State, w: int, k: int) -> float:
    """Return what the magnitude of a ball's acceleration [m/s^2] does not exceed until its next event."""
    if is_on_curve(state, w, k):
        ball = state.balls[w, k]
        return curve_slide_acceleration(curve_slide_of(state.curve_slides[w, k]), ball.gx, ball.gy)
    return _acceleration_bound_off_curves(state, w, k)


@function
def _flight_acceleration(state: State, w: int, k: int, t: float, motion: Motion) -> tuple[float, float]:
    return state.balls[w, k].ax, state.balls[w, k].ay


@where("carried", otherwise=_flight_acceleration)
def _acceleration_off_curves(state: State, w: int, k: int, t: float, motion: Motion) -> tuple[float, float]:
    if is_carried(state, w, k):
        carried = carried_of(state.carried[w, k])
        return carried_acceleration(carried, carried_direction(carried, t)[1])
    return _flight_acceleration(state, w, k, t, motion)


@where("curve_slides", otherwise=_flight_acceleration)
def acceleration_in(state: State, w: int, k: int, t: float, motion: Motion) -> tuple[float, float]:
    """Return the acceleration [m/s^2] of a ball `t` seconds after its last event, where its motion is this one."""
    if not is_on_curve(state, w, k):
        return _acceleration_off_curves(state, w, k, t, motion)
    ball, slide, (x, y, vx, vy) = state.balls[w, k], state.curve_slides[w, k], motion
    nx, ny = (x - slide.x - slide.ux * t) / slide.radius, (y - slide.y - slide.uy * t) / slide.radius
    vx, vy = vx - slide.ux, vy - slide.uy
    along, inward = ball.gy * nx - ball.gx * ny, (vx * vx + vy * vy) / slide.radius
    return -along * ny - inward * nx, along * nx - inward * ny
