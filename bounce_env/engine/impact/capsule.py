"""Time of impact of a flying ball with a capsule that does not turn: its two straight sides and its round ends."""

import math

from bounce_env.engine.compile.jit import routine
from bounce_env.engine.impact.circle import circle_time
from bounce_env.engine.impact.line import Line, face_time
from bounce_env.engine.motion.flight import Flight, flight_seen_from
from bounce_env.engine.motion.parts import Core


@routine
def capsule_time(flight: Flight, core: Core, offset_radius: float, tolerance: float, horizon: float) -> float:
    """Return the hit of a capsule, as a duration [s] up to `horizon`, or inf; the flight is seen from (core.x, core.y).

    offset_radius: the capsule's radius plus the ball's [m].
    """
    back = flight_seen_from(flight, core.back * core.ux, core.back * core.uy)
    front = flight_seen_from(flight, core.front * core.ux, core.front * core.uy)
    t = face_time(back, Line(core.ux, core.uy, core.front - core.back, offset_radius), 0, tolerance, horizon)
    t = min(t, circle_time(back, offset_radius, tolerance, min(t, horizon)))
    t = min(t, circle_time(front, offset_radius, tolerance, min(t, horizon)))
    return t if t <= horizon else math.inf
