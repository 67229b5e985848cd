"""What a ball meets next, from its last event: standing elements first, whose earliest hit bounds all other searches.

Everything standing is searched once per flight and kept as a duration from the flight's start; the ball's search for a
moving part starts at the later of the ball's last event and the part's last command or stop. Neither depends on where
a step ends. A ball in contact with a wall flies, too: along its line, under what the wall leaves of its acceleration.
"""

import math

from bounce_env.engine.compile.jit import Record, function, routine, where
from bounce_env.engine.detect.along_curve import first_along_curve
from bounce_env.engine.detect.by_advancement import first_by_advancement
from bounce_env.engine.detect.cells import first_face_or_circle
from bounce_env.engine.detect.crossings_along_curve import next_crossing_along
from bounce_env.engine.detect.crossings_by_advancement import next_crossing_by_advancement
from bounce_env.engine.detect.parts import plan_part_hits, plan_part_zones, way_off_part
from bounce_env.engine.detect.sensors import Crossing, next_crossing
from bounce_env.engine.detect.surfaces import (
    first_arc,
    first_end,
    first_joint,
    surface_normal,
)
from bounce_env.engine.memory.records import (
    NEXT_HIT,
    NEXT_PART,
    NEXT_SENSOR,
    NEXT_ZONE,
    OFF_END,
    OFF_PART,
    ON_ARC,
    ON_BALLS,
    ON_CIRCLE,
    ON_FACE,
    ON_JOINT,
    RESOLVE,
    RIDING,
)
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import flight_of, flight_time_in_scene
from bounce_env.engine.motion.instant import before, later
from bounce_env.engine.motion.path import is_bent, is_bent_and_moving


@routine
def schedule_parts(state: State, w: int, k: int) -> None:
    """Search the parts in whose zone a ball is, and set its next event."""
    ball = state.balls[w, k]
    plan_part_hits(state, w, k)
    schedule_next_event(ball)


@function
def schedule_crossing(state: State, w: int, k: int, after: float, kind: int, index: int) -> None:
    """Search the next crossing after (after, kind, index) in the present flight, and set the ball's next event."""
    _plan_next_crossing(state, w, k, Crossing(after, kind, index))
    schedule_next_event(state.balls[w, k])


@function
def _following_crossing_in_flight(state: State, w: int, k: int, last: Crossing) -> Crossing:
    return next_crossing(state, w, k, flight_of(state, state.balls[w, k]), last)


@where("carried", otherwise=next_crossing_along)
def _following_crossing_off_flights(state: State, w: int, k: int, last: Crossing) -> Crossing:
    if is_bent_and_moving(state, w, k):
        return next_crossing_by_advancement(state, w, k, last)
    return next_crossing_along(state, w, k, last)


@where("curve_slides", otherwise=_following_crossing_in_flight)
def _following_crossing(state: State, w: int, k: int, last: Crossing) -> Crossing:
    if is_bent(state, w, k):
        return _following_crossing_off_flights(state, w, k, last)
    return _following_crossing_in_flight(state, w, k, last)


@function
def _plan_next_crossing(state: State, w: int, k: int, last: Crossing) -> None:
    ball = state.balls[w, k]
    following = _following_crossing(state, w, k, last)
    ball.sensor_after, ball.sensor_kind, ball.sensor_index = following.after, following.kind, following.row


@function
def _schedule_standing_in_flight(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    flight = flight_of(state, ball)
    nx, ny = surface_normal(state, w, k, ball.contact)
    if ball.contact in (RIDING, ON_BALLS):
        nx, ny = ball.nx, ball.ny
    after = flight_time_in_scene(flight, state.scenes[state.worlds[w].scene].extent)
    after, face, circle = first_face_or_circle(state, w, k, flight, nx, ny, after)
    ball.hit_kind, ball.hit_index = ON_FACE, face
    if circle >= 0:
        ball.hit_kind, ball.hit_index = ON_CIRCLE, circle
    after, arc = first_arc(state, w, k, flight, nx, ny, after)
    if arc >= 0:
        ball.hit_kind, ball.hit_index = ON_ARC, arc
    after, end = first_end(state, w, k, flight, after)
    if end >= 0:
        ball.hit_kind, ball.hit_index = OFF_END, end
    met = face >= 0 or circle >= 0 or arc >= 0 or end >= 0
    joint, wall = first_joint(state, w, k, flight, after)
    if joint < after:
        after, met = joint, True
        ball.hit_kind, ball.hit_index = ON_JOINT, wall
    if ball.contact == RIDING or (ball.contact >= 0 and ball.rides >= 0):
        off = way_off_part(state, w, k, flight)
        if off < after:
            after, met = off, True
            ball.hit_kind, ball.hit_index = OFF_PART, ball.rides
    ball.end_after = after
    ball.hit_after = after if met else math.inf


@function
def _schedule_along_standing_curve(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    ball.hit_after, ball.hit_kind, ball.hit_index = first_along_curve(state, w, k)
    ball.end_after = ball.hit_after


@where("carried", otherwise=_schedule_along_standing_curve)
def _schedule_standing_off_flights(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    if is_bent_and_moving(state, w, k):
        ball.hit_after, ball.end_after, ball.hit_kind, ball.hit_index = first_by_advancement(state, w, k)
    else:
        _schedule_along_standing_curve(state, w, k)


@where("curve_slides", otherwise=_schedule_standing_in_flight)
def schedule_standing(state: State, w: int, k: int) -> None:
    """Search everything that stands: what ends the flight or slide that begins now, and when."""
    if is_bent(state, w, k):
        _schedule_standing_off_flights(state, w, k)
    else:
        _schedule_standing_in_flight(state, w, k)


@function
def schedule_rest(state: State, w: int, k: int) -> None:
    """Search what does not end the flight, or may move: sensors, zones, parts; and set the ball's next event."""
    _plan_next_crossing(state, w, k, Crossing(-1.0, -1, -1))
    plan_part_zones(state, w, k, 0.0)
    schedule_parts(state, w, k)


@function
def schedule_resolve(ball: Record) -> None:
    """Let the ball's next event be at the instant of its last: to bounce from what it touches, and to be planned."""
    ball.hit_kind, ball.hit_after, ball.end_after = RESOLVE, 0.0, 0.0
    ball.sensor_after, ball.zone_after, ball.part_hi, ball.part_lo = math.inf, math.inf, math.inf, 0.0
    schedule_next_event(ball)


@function
def schedule_nothing(ball: Record) -> None:
    """Let the ball have no next event: another ball's comes first, at this instant, and plans this one anew."""
    ball.hit_after, ball.end_after, ball.sensor_after, ball.zone_after = math.inf, math.inf, math.inf, math.inf
    ball.part_hi, ball.part_lo = math.inf, 0.0
    schedule_next_event(ball)


@function
def schedule_next_event(ball: Record) -> None:
    """Set the ball's next event from what is kept. At one instant: zone, standing element, part, sensor."""
    hi, lo, kind = _instant_after(ball, ball.zone_after, NEXT_ZONE)
    hit_hi, hit_lo, _ = _instant_after(ball, ball.hit_after, NEXT_HIT)
    if before(hit_hi, hit_lo, hi, lo):
        hi, lo, kind = hit_hi, hit_lo, NEXT_HIT
    if before(ball.part_hi, ball.part_lo, hi, lo):
        hi, lo, kind = ball.part_hi, ball.part_lo, NEXT_PART
    sensor_hi, sensor_lo, _ = _instant_after(ball, ball.sensor_after, NEXT_SENSOR)
    if before(sensor_hi, sensor_lo, hi, lo):
        hi, lo, kind = sensor_hi, sensor_lo, NEXT_SENSOR
    ball.next_hi, ball.next_lo, ball.next_kind = hi, lo, kind


@function
def _instant_after(ball: Record, duration: float, kind: int) -> tuple[float, float, int]:
    if duration == math.inf:
        return math.inf, 0.0, kind
    hi, lo = later(ball.hi, ball.lo, duration)
    return hi, lo, kind
