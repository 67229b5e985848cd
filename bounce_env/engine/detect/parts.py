"""The zone that each moving part can reach, and what a ball meets there."""

import math

from bounce_env.engine.compile.jit import Record, function, where
from bounce_env.engine.detect.along_curve import curve_search
from bounce_env.engine.detect.crossings_along_curve import circle_change_along, strip_change_along
from bounce_env.engine.detect.parts_along_curve import meet_part_along_curve
from bounce_env.engine.impact.arc import Circle, arc_crossing_time
from bounce_env.engine.impact.capsule import capsule_time
from bounce_env.engine.impact.line import Line, face_time
from bounce_env.engine.impact.rotating_capsule import rotating_capsule_time
from bounce_env.engine.impact.stretching_wall import stretching_wall_time
from bounce_env.engine.impact.swept_box import box_entry_time, box_leaving_time, box_of, is_in_box
from bounce_env.engine.memory.lookup import is_off, side_of_part
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import (
    Flight,
    flight_acceleration_along,
    flight_after,
    flight_of,
    flight_rounding,
    flight_seen_from,
    flight_seen_from_moving,
    swept_interval,
)
from bounce_env.engine.motion.instant import before, later, since
from bounce_env.engine.motion.parts import (
    Core,
    MovingPart,
    is_dragged_part,
    moving_part,
    part_core_at,
    part_stop_instant,
    part_surface_velocity,
)
from bounce_env.engine.motion.path import is_bent, is_bent_and_moving, is_on_curve
from bounce_env.engine.motion.roots import falling_root
from bounce_env.engine.tolerances import ZONE_MARGIN


@function
def plan_part_zones(state: State, w: int, k: int, now: float) -> None:
    """Bring the ball's zones up to `now` seconds after its last event, and set when the next of them changes.

    The zone of a part is where it can be met: of one that slides the strip along its rail, of one that turns a box (or,
    while the ball slides on a curve, the circle about its pivot), of a dragged wall everything; all is in it while the
    ball slides on a curve that moves, or is carried. It is a static sensor of the engine's own: passing its border
    neither re-bases the flight nor shows in the ledger.
    """
    state.balls[w, k].zone_after = math.inf
    _plan_part_zones(state, w, k, now)


@where("parts", inline=False)
def _plan_part_zones(state: State, w: int, k: int, now: float) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for m in range(state.scenes[scene].parts):
        part, zone = moving_part(state, w, m), state.zones[w, k, m]
        if is_dragged_part(part) or is_bent_and_moving(state, w, k):
            zone.inside, zone.after = 1, math.inf
            continue
        if now == 0.0:
            inside = _is_in_part_zone(state, w, k, part)
            zone.inside, zone.after = 1 if inside else 0, 0.0
        elif zone.after <= now:
            zone.inside = 1 - zone.inside
        if zone.after <= now:
            zone.after = _part_zone_change(state, w, k, m, zone.inside == 1, now)
            if zone.after > ball.end_after:
                zone.after = math.inf
        ball.zone_after = min(ball.zone_after, zone.after)


@function
def _is_in_part_zone(state: State, w: int, k: int, part: MovingPart) -> bool:
    ball, shape = state.balls[w, k], part.shape
    if part.turn != 0 and not is_on_curve(state, w, k):
        return is_in_box(box_of(shape), ball.x, ball.y)
    x, y, border = ball.x - shape.x, ball.y - shape.y, _part_zone_border(part)
    if part.turn != 0:
        return x * x + y * y <= border * border
    return abs(y * shape.ux - x * shape.uy) <= border


@function
def _part_zone_border(part: MovingPart) -> float:
    """Return how far [m] the zone of a part reaches from its rail, or from its pivot where it is a circle."""
    shape = part.shape
    return (1.0 + ZONE_MARGIN) * (shape.front + shape.offset_radius if part.turn != 0 else shape.offset_radius)


@function
def _part_zone_change_in_flight(state: State, w: int, k: int, m: int, inside: bool, after: float) -> float:
    flight, part = flight_of(state, state.balls[w, k]), moving_part(state, w, m)
    shape = part.shape
    if part.turn != 0:
        box = box_of(shape)
        return box_leaving_time(flight, box, after) if inside else box_entry_time(flight, box, after)
    seen = flight_seen_from(flight, shape.x, shape.y)
    return _part_strip_change(seen, shape.ux, shape.uy, _part_zone_border(part), inside, after)


@where("curve_slides", otherwise=_part_zone_change_in_flight)
def _part_zone_change(state: State, w: int, k: int, m: int, inside: bool, after: float) -> float:
    """Return when the ball next passes the border of part `m`'s zone, no earlier than `after` [s] on its path."""
    if not is_on_curve(state, w, k):
        return _part_zone_change_in_flight(state, w, k, m, inside, after)
    part, search = moving_part(state, w, m), curve_search(state, w, k)
    shape, border = part.shape, _part_zone_border(part)
    x, y = shape.x - search.slide.x, shape.y - search.slide.y
    if part.turn != 0:
        return circle_change_along(search, x, y, border, inside, after)
    return strip_change_along(search, shape.ux, shape.uy, x, y, border, inside, after)


@function
def _part_strip_change(flight: Flight, ux: float, uy: float, border: float, inside: bool, after: float) -> float:
    """Return when a flight next passes the distance `border` from the line along (ux, uy), not before `after` [s]."""
    height, rate = flight.y * ux - flight.x * uy, flight.vy * ux - flight.vx * uy
    best = math.inf
    for facing in (1.0, -1.0):
        gap = facing * height - border
        if inside:
            pull = flight_acceleration_along(flight, facing * uy, -facing * ux)
            t = falling_root(-gap, gap > 0.0, -facing * rate, pull)
        else:
            pull = flight_acceleration_along(flight, -facing * uy, facing * ux)
            t = falling_root(gap, gap < 0.0, facing * rate, pull)
        if t >= after:
            best = min(best, t)
    return best


@function
def _meet_part_in_flight(state: State, w: int, k: int, m: int, side: int, leaves_after: float) -> tuple[float, float]:
    """In the frame of a part that slides the ball flies as ever, and the part is a standing capsule."""
    ball, part, extent = state.balls[w, k], moving_part(state, w, m), state.scenes[state.worlds[w].scene].extent
    shape, motion, flight = part.shape, part.motion, flight_of(state, ball)
    if before(ball.hi, ball.lo, motion.hi, motion.lo):
        hi, lo = motion.hi, motion.lo
    else:
        hi, lo = ball.hi, ball.lo
    t = since(hi, lo, ball.hi, ball.lo)
    stop_hi, stop_lo = part_stop_instant(motion, shape)
    horizon = min(min(ball.end_after, leaves_after) - t, since(stop_hi, stop_lo, hi, lo))
    core = part_core_at(part, hi, lo)
    seen = flight_seen_from(flight_after(flight, t), core.x, core.y)
    tolerance = flight_rounding(flight, extent, t)
    if is_dragged_part(part):
        after = _meet_dragged_part(part, seen, core, side, tolerance, horizon)
    elif part.turn != 0 and motion.velocity != 0.0:
        horizon = min(ball.end_after - t, since(stop_hi, stop_lo, hi, lo))
        after = _meet_turning_part(ball, part, flight, t, seen, core, tolerance, horizon)
    else:
        if part.turn == 0:
            seen = flight_seen_from_moving(seen, motion.velocity * core.ux, motion.velocity * core.uy)
        after = capsule_time(seen, core, shape.offset_radius, tolerance, horizon)
    if after == math.inf:
        return math.inf, 0.0
    return later(hi, lo, after)


@function
def _meet_turning_part(
    ball: Record, part: MovingPart, flight: Flight, t: float, seen: Flight, core: Core, tolerance: float, horizon: float
) -> float:
    """Hit of a part that turns, seen from its pivot from `t` seconds after the flight's beginning on.

    The ball passes the circle that the part can reach up to twice; the shorter a search, the nearer its bounds.
    """
    spin, shape, after, found = part.turn * part.motion.velocity, part.shape, t, math.inf
    circle = Circle(_part_zone_border(part), 1.0)
    from_pivot = flight_seen_from(flight, shape.x, shape.y)
    for _ in range(2):
        leaves = arc_crossing_time(from_pivot, None, circle, after == 0.0, ball.tolerance, after, ball.end_after)
        found = rotating_capsule_time(seen, core, shape.offset_radius, spin, tolerance, min(horizon, leaves - t))
        if found < math.inf or leaves == math.inf:
            return found
        after = leaves
    return found


@where("curve_slides", otherwise=_meet_part_in_flight)
def _meet_part(state: State, w: int, k: int, m: int, side: int, leaves_after: float) -> tuple[float, float]:
    """Return the instant at which a ball hits part `m` while both keep their present motion: (hi, lo), inf if not.

    side: on which side of a dragged wall a ball of no radius is while it touches it, otherwise 0.
    leaves_after: duration [s] after which, from its last event, the ball is out of the part's reach.
    """
    if is_bent(state, w, k):
        return meet_part_along_curve(state, w, k, m, side, leaves_after)
    return _meet_part_in_flight(state, w, k, m, side, leaves_after)


@where("ends", otherwise=math.inf)
def _meet_dragged_part(
    part: MovingPart, flight: Flight, core: Core, side: int, tolerance: float, horizon: float
) -> float:
    """Hit of a dragged wall, seen from where its start is now: a duration [s], or inf."""
    ends, offset_radius = part.ends, part.shape.offset_radius
    seen = flight_seen_from_moving(flight, ends.vx0, ends.vy0)
    ex, ey = ends.vx1 - ends.vx0, ends.vy1 - ends.vy0
    if ex != 0.0 or ey != 0.0:
        dx, dy = core.front * core.ux, core.front * core.uy
        if not _comes_near_dragged_part(seen, dx, dy, ex, ey, offset_radius + tolerance, horizon):
            return math.inf
        return stretching_wall_time(seen, dx, dy, ex, ey, offset_radius, side, tolerance, horizon)
    if offset_radius > 0.0:
        return capsule_time(seen, core, offset_radius, tolerance, horizon)
    return face_time(seen, Line(core.ux, core.uy, core.front, offset_radius), side, tolerance, horizon)


@function
def _comes_near_dragged_part(
    flight: Flight, dx: float, dy: float, ex: float, ey: float, offset_radius: float, horizon: float
) -> bool:
    """Return whether the boxes that a ball and a wall from the origin along (dx, dy), changing by (ex, ey), sweep meet.

    Most walls are rejected by that alone. Written so that infinite or undefined borders reject nothing.
    """
    left, right = swept_interval(flight.x, flight.vx, flight.ax, horizon)
    below, above = swept_interval(flight.y, flight.vy, flight.ay, horizon)
    sx, sy = dx + ex * horizon, dy + ey * horizon
    apart = left > max(dx, sx, 0.0) + offset_radius or right < min(dx, sx, 0.0) - offset_radius
    return not (apart or below > max(dy, sy, 0.0) + offset_radius or above < min(dy, sy, 0.0) - offset_radius)


@function
def plan_part_hits(state: State, w: int, k: int) -> None:
    """Search the parts in whose zone the ball is, and set which one it hits first, and when."""
    ball = state.balls[w, k]
    ball.part_hi, ball.part_lo, ball.part_index = math.inf, 0.0, -1
    _plan_part_hits(state, w, k)


@where("parts")
def _plan_part_hits(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    for m in range(head.parts):
        zone = state.zones[w, k, m]
        if m == ball.rides or not zone.inside or is_off(state, w, state.parts[scene, m].element):
            continue
        side = side_of_part(state, w, k, m)
        hi, lo = _meet_part(state, w, k, m, side, zone.after)
        if before(hi, lo, ball.part_hi, ball.part_lo):
            ball.part_hi, ball.part_lo, ball.part_index = hi, lo, m


@where("parts", otherwise=math.inf)
def way_off_part(state: State, w: int, k: int, flight: Flight) -> float:
    """Return after how long [s] a ball that slides on a part comes to an end of its straight side; inf: it does not."""
    ball = state.balls[w, k]
    part = moving_part(state, w, ball.rides)
    core = part_core_at(part, ball.hi, ball.lo)
    rx, ry = ball.x - core.x, ball.y - core.y
    sx, sy = part_surface_velocity(part, core, rx, ry)
    along, rate = rx * core.ux + ry * core.uy, (ball.vx - sx) * core.ux + (ball.vy - sy) * core.uy
    if not core.back <= along <= core.front and ball.contact >= 0:
        return math.inf  # at one point of its round end, pushed along a wall
    pull, against = (
        flight_acceleration_along(flight, core.ux, core.uy),
        flight_acceleration_along(flight, -core.ux, -core.uy),
    )
    to_back = falling_root(along - core.back, False, rate, pull)
    return min(to_back, falling_root(core.front - along, False, -rate, against))
