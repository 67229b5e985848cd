"""When balls hit each other.

Seen from one ball the other one flies under the difference of their accelerations: on a straight line where both are
under the same gravity, so that the hit is that of a circle of twice the radius, in closed form.
"""

import math

from bounce_env.engine.compile.jit import Record, function, where
from bounce_env.engine.detect.pairs_along_curve import meeting_along_curve, time_to_press
from bounce_env.engine.impact.circle import circle_time
from bounce_env.engine.memory.records import OUT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import Flight, acceleration_magnitude, flight_after, flight_of, flight_rounding
from bounce_env.engine.motion.instant import before, later, since
from bounce_env.engine.motion.path import is_bent
from bounce_env.engine.tolerances import (
    MEETINGS_WITHOUT_ROOM,
    PRESSING,
    ROOM_TO_MEET,
    SLOW_HIT,
    ULPS_OF_SPEED,
)


@where("pairs", inline=False)
def plan_pairs(state: State, w: int, k: int) -> None:
    """Set when ball `k` hits each other ball, as long as both keep to their present flights."""
    for j in range(state.balls.shape[1]):
        if j != k:
            pair = state.pairs[w, max(j, k), min(j, k)]
            pair.hi, pair.lo = _meeting_of_pair(state, w, max(j, k), min(j, k))


@function
def _meeting_in_flight(state: State, w: int, k: int, j: int) -> tuple[float, float]:
    one, other = state.balls[w, k], state.balls[w, j]
    if OUT in (one.status, other.status):
        return math.inf, 0.0
    hi, lo = one.hi, one.lo
    if before(hi, lo, other.hi, other.lo):
        hi, lo = other.hi, other.lo
    s, t = since(hi, lo, one.hi, one.lo), since(hi, lo, other.hi, other.lo)
    of_one, of_other = flight_of(state, one), flight_of(state, other)
    horizon = min(one.end_after - s, other.end_after - t)
    head = state.scenes[state.worlds[w].scene]
    tolerance = max(flight_rounding(of_one, head.extent, s), flight_rounding(of_other, head.extent, t))
    of_one, of_other = flight_after(of_one, s), flight_after(of_other, t)
    seen = _seen_from_other_ball(of_one, of_other)
    offset_radius, noise = 2.0 * head.ball_radius, pair_noise(one, other, of_one, of_other, head)
    closing = -(seen.x * seen.vx + seen.y * seen.vy) / offset_radius
    touch = seen.x * seen.x + seen.y * seen.y <= (offset_radius + tolerance) * (offset_radius + tolerance)
    if touch and abs(closing) <= noise:
        # They neither close on each other nor come apart by more than rounding.
        off = _drawn_off_other_ball(seen, offset_radius)
        turn = (seen.vx * seen.vx + seen.vy * seen.vy) / offset_radius
        if off >= 0.0:
            return math.inf, 0.0
        if off + turn <= 2.0 * PRESSING * (pair_weight(one, other) + turn):
            third = _third_derivative(seen, offset_radius)
            return _instant_before_horizon(hi, lo, time_to_press(off + turn, third, head.extent), horizon)
    return _instant_before_horizon(hi, lo, circle_time(seen, offset_radius, tolerance, horizon), horizon)


@function
def _instant_before_horizon(hi: float, lo: float, after: float, horizon: float) -> tuple[float, float]:
    if not after <= horizon or after == math.inf:
        return math.inf, 0.0
    return later(hi, lo, after)


@where("curve_slides", otherwise=_meeting_in_flight)
def _meeting_of_pair(state: State, w: int, k: int, j: int) -> tuple[float, float]:
    """Return when balls `k` and `j` hit each other, if both keep to their paths: (hi, lo); inf if they do not."""
    if state.pairs[w, k, j].pressed:  # what is resolved as one needs no search
        return math.inf, 0.0
    if (is_bent(state, w, k) or is_bent(state, w, j)) and OUT not in (
        state.balls[w, k].status, state.balls[w, j].status,
    ):  # fmt: skip
        return meeting_along_curve(state, w, k, j)
    return _meeting_in_flight(state, w, k, j)


def _seen_from_other_ball_coasting(one: Flight, other: Flight) -> Flight:
    return Flight(one.x - other.x, one.y - other.y, one.vx - other.vx, one.vy - other.vy, None, None)


@where("ax", otherwise=_seen_from_other_ball_coasting)
def _seen_from_other_ball(one: Flight, other: Flight) -> Flight:
    """Return the flight of one ball as seen from another one."""
    ax, ay = one.ax - other.ax, one.ay - other.ay
    return Flight(one.x - other.x, one.y - other.y, one.vx - other.vx, one.vy - other.vy, ax, ay)


@where("ax", otherwise=0.0)
def _third_derivative(seen: Flight, offset_radius: float) -> float:
    """Return the third derivative [m/s^3] of the gap to a ball at the origin, the first two of which are 0."""
    along = (seen.x * seen.vy - seen.y * seen.vx) / offset_radius
    pull = (seen.x * seen.ay - seen.y * seen.ax) / offset_radius
    return 3.0 * along * pull / offset_radius


@where("ax", otherwise=0.0)
def _drawn_off_other_ball(seen: Flight, offset_radius: float) -> float:
    """Return the acceleration [m/s^2] that draws a ball off another one at the origin that it touches; < 0: onto it."""
    return (seen.x * seen.ax + seen.y * seen.ay) / offset_radius


@function
def pair_noise(one: Record, other: Record, of_one: Flight, of_other: Flight, head: Record) -> float:
    """Return the speed [m/s] below which closing balls do not hit: rounding, or next to nothing under gravity."""
    speeds = abs(of_one.vx) + abs(of_one.vy) + abs(of_other.vx) + abs(of_other.vy)
    return ULPS_OF_SPEED * (speeds + math.sqrt(pair_weight(one, other) * head.ball_radius))


@where("pairs", otherwise=(math.inf, 0.0, -1, -1))
def first_pair(state: State, w: int, until_hi: float, until_lo: float) -> tuple[float, float, int, int]:
    """Return the earliest hit of two balls up to an instant: (hi, lo) and the two, the higher first; -1 for none."""
    hi, lo, one, other = math.inf, 0.0, -1, -1
    for k in range(state.pairs.shape[1]):
        for j in range(k):
            pair = state.pairs[w, k, j]
            if not before(until_hi, until_lo, pair.hi, pair.lo) and before(pair.hi, pair.lo, hi, lo):
                hi, lo, one, other = pair.hi, pair.lo, k, j
    return hi, lo, one, other


@where("pairs")
def let_all_go(state: State, w: int) -> None:
    """No ball is pressed on another one yet."""
    for k in range(state.pairs.shape[1]):
        for j in range(k):
            state.pairs[w, k, j].pressed = 0


@where("pairs", otherwise=False)
def is_pressed_by_balls(state: State, w: int, k: int) -> bool:
    """Return whether ball `k` is pressed on another one."""
    pressed = False
    for j in range(state.balls.shape[1]):
        pressed = pressed or (j != k and state.pairs[w, max(j, k), min(j, k)].pressed == 1)
    return pressed


@where("members")
def forget_meetings(state: State, w: int, k: int) -> None:
    """Let a ball have hit no others: it has come somewhere else."""
    state.members[w, k].meets, state.members[w, k].strayed = 0, 0.0


@where("members")
def note_way(state: State, w: int, k: int, way: float) -> None:
    """Note that a ball has come `way` metres, which may be room enough."""
    member = state.members[w, k]
    member.strayed += way
    if member.strayed > ROOM_TO_MEET * state.scenes[state.worlds[w].scene].extent:
        forget_meetings(state, w, k)


@function
def has_no_room(state: State, w: int, k: int) -> bool:
    """Return whether a ball keeps hitting others without coming any further."""
    balls = state.balls.shape[1]
    return state.members[w, k].meets > MEETINGS_WITHOUT_ROOM + 4 * balls * balls


@function
def slowest_rebound(state: State, w: int, ball: Record) -> float:
    """Return the speed [m/s] up to which hits of a ball that lies on others have no rebound.

    A share of the speed that falling by its radius gives. What follows a curve lies on others without gravity, too.
    """
    head = state.scenes[state.worlds[w].scene]
    pull = max(acceleration_magnitude(ball.gx, ball.gy), acceleration_magnitude(ball.ax, ball.ay))
    return max(head.rest_speed, SLOW_HIT * math.sqrt(pull * head.ball_radius)) if pull > 0.0 else 0.0


@function
def slowest_pair_rebound(state: State, w: int, k: int, j: int) -> float:
    """Return the same of a hit of balls `k` and `j`; inf where neither has any room."""
    if has_no_room(state, w, k) and has_no_room(state, w, j):
        return math.inf
    return max(slowest_rebound(state, w, state.balls[w, k]), slowest_rebound(state, w, state.balls[w, j]))


@function
def pair_weight(one: Record, other: Record) -> float:
    """Return the larger of the accelerations [m/s^2] that two balls are under."""
    return max(acceleration_magnitude(one.gx, one.gy), acceleration_magnitude(other.gx, other.gy))
