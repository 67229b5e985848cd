"""What stands in the way of a ball: the earliest hit of walls, circles and arcs, and the end of what it slides on."""

import math

from bounce_env.engine.compile.jit import Record, function, where
from bounce_env.engine.impact.arc import arc_time
from bounce_env.engine.impact.circle import circle_time
from bounce_env.engine.impact.line import Line, face_time, facing_time, is_beside_line, leaves_line_end
from bounce_env.engine.impact.swept_box import box_of, circle_box, misses_box, sweep_of
from bounce_env.engine.memory.lookup import face_near, faces_near, is_off, is_one_way, is_sliding, side_on
from bounce_env.engine.memory.records import CLOSED, LEANS, RIDING
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import (
    Flight,
    flight_acceleration_along,
    flight_place_after,
    flight_seen_from,
)
from bounce_env.engine.motion.roots import falling_root
from bounce_env.engine.tolerances import CLUSTER_GAP, PRESSING, ULPS_OF_SPEED


@function
def face_line(face: Record) -> Line:
    """Return the wall of a face, as seen from its start."""
    return Line(face.ux, face.uy, face.length, face.offset_radius)


@where("faces", otherwise=(0.0, 0.0))
def surface_normal(state: State, w: int, k: int, i: int) -> tuple[float, float]:
    """Return the unit normal, to ball `k`, of face `i`, which it touches; (0, 0) if there is none (i < 0)."""
    if i < 0:
        return 0.0, 0.0
    ball, face = state.balls[w, k], state.faces[state.worlds[w].scene, i]
    side = side_on(state.face_sides, w, k, i)
    height = (ball.y - face.y) * face.ux - (ball.x - face.x) * face.uy
    facing = 1.0 if side > 0 or (side == 0 and height >= 0.0) else -1.0
    return -facing * face.uy, facing * face.ux


@function
def _height_over(ball: Record, face: Record) -> float:
    """Return the height [m] of a ball's centre over the line of a wall."""
    height: float = (ball.y - face.y) * face.ux - (ball.x - face.x) * face.uy
    return height


@where("pairs", otherwise=False)
def _is_left_to_cluster(state: State, w: int, ball: Record, gap: float, rate: float) -> bool:
    """Return whether a surface needs no search: the ball leans on others, with which it is resolved before long.

    That is so where it touches the surface, and moves along it nearly: `gap` [m] and `rate` [m/s].
    """
    room = CLUSTER_GAP * state.scenes[state.worlds[w].scene].extent
    pull = abs(ball.gx) + abs(ball.gy) + abs(ball.ax) + abs(ball.ay)
    noise = PRESSING * (abs(ball.vx) + abs(ball.vy))
    return ball.settling == LEANS and gap <= room and rate * rate <= 8.0 * room * pull + noise * noise


@function
def _is_circle_left_to_cluster(state: State, w: int, ball: Record, seen: Flight, radius: float) -> bool:
    """Return the same of a circle about the origin, from outside or inside."""
    distance = math.sqrt(seen.x * seen.x + seen.y * seen.y)
    rate = (seen.x * seen.vx + seen.y * seen.vy) / distance if distance > 0.0 else 0.0
    return _is_left_to_cluster(state, w, ball, abs(distance - radius), rate)


@function
def _is_level_on_face(ball: Record, flight: Flight, face: Record) -> bool:
    """Return whether a ball touches a wall and keeps doing so: it moves along it, and nothing pulls it off."""
    height = _height_over(ball, face)
    if abs(abs(height) - face.offset_radius) > ball.tolerance:
        return False
    rate = ball.vy * face.ux - ball.vx * face.uy
    if abs(rate) > 4.0 * ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy)):
        return False
    return _is_pulled_along_face(flight, face)


@where("ax", otherwise=True)
def _is_pulled_along_face(flight: Flight, face: Record) -> bool:
    return abs(flight.ay * face.ux - flight.ax * face.uy) <= PRESSING * (abs(flight.ax) + abs(flight.ay))


def _no_standing_surface(
    state: State, w: int, k: int, flight: Flight, nx: float, ny: float, horizon: float
) -> tuple[float, int]:
    return horizon, -1


def _no_hit(state: State, w: int, k: int, flight: Flight, nx: float, ny: float, i: int, horizon: float) -> float:
    return math.inf


@where("faces", otherwise=_no_hit)
def face_hit(state: State, w: int, k: int, flight: Flight, nx: float, ny: float, i: int, horizon: float) -> float:
    """Return the hit of the straight part of wall `i`, up to `horizon` [s], or inf; as `first_one_by_one`."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    face = state.faces[scene, i]
    if is_off(state, w, face.element):
        return math.inf
    if is_sliding(ball) and (i == ball.contact or _is_level_on_face(ball, flight, face)):
        return math.inf
    if _is_left_to_cluster(
        state, w, ball, abs(_height_over(ball, face)) - face.offset_radius, ball.vy * face.ux - ball.vx * face.uy
    ):
        return math.inf
    from_start, side = flight_seen_from(flight, face.x, face.y), side_on(state.face_sides, w, k, i)
    if is_one_way(state, scene, i):
        t = facing_time(from_start, face_line(face), 1.0, side, ball.tolerance, horizon)
    else:
        t = face_time(from_start, face_line(face), side, ball.tolerance, horizon)
    return math.inf if t <= horizon and _slides_over_face_end(ball, flight, face, nx, ny, t) else t


@where("faces", otherwise=_no_standing_surface)
def _first_face(
    state: State, w: int, k: int, flight: Flight, nx: float, ny: float, horizon: float
) -> tuple[float, int]:
    scene = state.worlds[w].scene
    extent, best, index = state.scenes[scene].extent, horizon, -1
    sweep = sweep_of(flight, extent, horizon)
    for i in range(state.scenes[scene].faces):
        if misses_box(flight, sweep, box_of(state.faces[scene, i])):
            continue
        t = face_hit(state, w, k, flight, nx, ny, i, best)
        if t < best:
            best, index, sweep = t, i, sweep_of(flight, extent, t)
    return best, index


@function
def _slides_over_face_end(ball: Record, flight: Flight, face: Record, nx: float, ny: float, t: float) -> bool:
    """Return whether a point that slides on a wall with normal (nx, ny) passes an end beneath it after `t` seconds."""
    if not is_sliding(ball) or face.offset_radius > 0.0:
        return False
    x, y = flight_place_after(flight, t)
    along = (x - face.x) * face.ux + (y - face.y) * face.uy
    rise = face.ux * nx + face.uy * ny
    return (along <= ball.tolerance and rise <= 0.0) or (along >= face.length - ball.tolerance and rise >= 0.0)


@function
def _slides_past_circle(ball: Record, nx: float, ny: float, x: float, y: float, offset_radius: float) -> bool:
    """Return whether a ball that slides on a wall with normal (nx, ny) just touches a circle that has it at (x, y)."""
    return is_sliding(ball) and x * nx + y * ny >= offset_radius - ball.tolerance


@where("circles", otherwise=_no_hit)
def circle_hit(state: State, w: int, k: int, flight: Flight, nx: float, ny: float, i: int, horizon: float) -> float:
    """Return the hit of bumper or end `i`, up to `horizon` [s], or inf; as `first_one_by_one`."""
    ball, circle = state.balls[w, k], state.circles[state.worlds[w].scene, i]
    seen = flight_seen_from(flight, circle.x, circle.y)
    if _is_circle_left_to_cluster(state, w, ball, seen, circle.offset_radius):
        return math.inf
    if is_off(state, w, circle.element) or _slides_past_circle(ball, nx, ny, seen.x, seen.y, circle.offset_radius):
        return math.inf
    return circle_time(seen, circle.offset_radius, ball.tolerance, horizon)


@where("circles", otherwise=_no_standing_surface)
def _first_circle(
    state: State, w: int, k: int, flight: Flight, nx: float, ny: float, horizon: float
) -> tuple[float, int]:
    scene = state.worlds[w].scene
    extent, best, index = state.scenes[scene].extent, horizon, -1
    sweep = sweep_of(flight, extent, horizon)
    for i in range(state.scenes[scene].circles):
        circle = state.circles[scene, i]
        if misses_box(flight, sweep, circle_box(circle.x, circle.y, circle.offset_radius)):
            continue
        t = circle_hit(state, w, k, flight, nx, ny, i, best)
        if t < best:
            best, index, sweep = t, i, sweep_of(flight, extent, t)
    return best, index


@function
def first_one_by_one(
    state: State, w: int, k: int, flight: Flight, nx: float, ny: float, horizon: float
) -> tuple[float, int, int]:
    """Return the earliest hit of a wall's straight part, a bumper or an end before `horizon` [s].

    As (duration, face, circle), -1 for none. (nx, ny) is the normal of what the ball slides on, (0, 0) in flight.
    """
    after, face = _first_face(state, w, k, flight, nx, ny, horizon)
    after, circle = _first_circle(state, w, k, flight, nx, ny, after)
    return after, -1 if circle >= 0 else face, circle


@where("arcs", otherwise=_no_standing_surface)
def first_arc(state: State, w: int, k: int, flight: Flight, nx: float, ny: float, horizon: float) -> tuple[float, int]:
    """Return the earliest hit of an arc before `horizon` [s]: (duration, arc); as `first_one_by_one`."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    extent, best, index = state.scenes[scene].extent, horizon, -1
    sweep = sweep_of(flight, extent, horizon)
    for i in range(state.scenes[scene].arcs):
        arc = state.arcs[scene, i]
        if misses_box(flight, sweep, box_of(arc)) or is_off(state, w, arc.element):
            continue
        seen = flight_seen_from(flight, arc.x, arc.y)
        if _is_circle_left_to_cluster(state, w, ball, seen, arc.outer) or _is_circle_left_to_cluster(
            state, w, ball, seen, arc.inner
        ):
            continue
        past = _slides_past_circle(ball, nx, ny, seen.x, seen.y, arc.outer)
        t = arc_time(seen, arc, side_on(state.arc_sides, w, k, i), past, ball.tolerance, best)
        if t < best:
            best, index, sweep = t, i, sweep_of(flight, extent, t)
    return best, index


def _no_joint(state: State, w: int, k: int, flight: Flight, horizon: float) -> tuple[float, int]:
    return horizon, -1


@where("faces", otherwise=_no_joint)
def first_joint(state: State, w: int, k: int, flight: Flight, horizon: float) -> tuple[float, int]:
    """Return when a ball that moves along a wall first comes to where an arc begins on it: (duration [s], wall).

    There it may go on along the arc, also where the wall goes on beneath. It slides on the wall, or flies along it.
    """
    return _first_arc_joint(state, w, k, flight, horizon)


@where("arcs", otherwise=_no_joint, inline=False)
def _first_arc_joint(state: State, w: int, k: int, flight: Flight, horizon: float) -> tuple[float, int]:
    ball, scene, best, index = state.balls[w, k], state.worlds[w].scene, horizon, -1
    if ball.contact >= 0:
        return _first_joint_on_face(state, w, k, flight, ball.contact, horizon), ball.contact
    for i in range(state.scenes[scene].faces if ball.touched > 0 and ball.contact != RIDING else 0):
        face = state.faces[scene, i]
        if _is_level_on_face(ball, flight, face) and not is_off(state, w, face.element):
            t = _first_joint_on_face(state, w, k, flight, i, best)
            if t < best:
                best, index = t, i
    return best, index


@function
def _first_joint_on_face(state: State, w: int, k: int, flight: Flight, i: int, horizon: float) -> float:
    ball, scene, best = state.balls[w, k], state.worlds[w].scene, horizon
    face = state.faces[scene, i]
    for j in range(state.scenes[scene].arcs):
        arc = state.arcs[scene, j]
        if arc.span == CLOSED or is_off(state, w, arc.element):
            continue
        for radius in (arc.outer, arc.inner):
            if radius > 0.0:
                best = _joint_time(ball, flight, face, arc.x + radius * arc.sx, arc.y + radius * arc.sy, best)
                best = _joint_time(ball, flight, face, arc.x + radius * arc.ex, arc.y + radius * arc.ey, best)
    return best


@function
def _joint_time(ball: Record, flight: Flight, face: Record, x: float, y: float, best: float) -> float:
    """Return the earlier of `best` and when the ball comes to (x, y), if that lies on its way."""
    dx, dy = flight.x - x, flight.y - y
    along, rate = dx * face.ux + dy * face.uy, flight.vx * face.ux + flight.vy * face.uy
    if abs(dy * face.ux - dx * face.uy) > 2.0 * ball.tolerance:
        return best
    if abs(along) <= 4.0 * ball.tolerance:  # it begins there, and may come back
        along, sign = 0.0, math.copysign(1.0, rate)
    else:
        sign = math.copysign(1.0, along)
    pull = flight_acceleration_along(flight, sign * face.ux, sign * face.uy)
    t = falling_root(abs(along), False, sign * rate, pull)
    return t if 0.0 < t < best else best


def _no_face_end(state: State, w: int, k: int, flight: Flight, horizon: float) -> tuple[float, int]:
    return horizon, -1


@where("faces", otherwise=_no_face_end)
def first_end(state: State, w: int, k: int, flight: Flight, horizon: float) -> tuple[float, int]:
    """Return the earliest end before `horizon` [s] of a wall that the ball slides on: (duration, face).

    A ball of no radius that only flies along a wall comes to its end, too: what goes on there it would not meet
    otherwise, where a disc touches the round end.
    """
    ball = state.balls[w, k]
    if ball.contact >= 0:
        t = _way_to_face_end(flight, state.faces[state.worlds[w].scene, ball.contact])
        return (t, ball.contact) if t < horizon else (horizon, -1)
    return _first_end_of_point(state, w, k, flight, horizon)


@where("face_sides", otherwise=_no_face_end)
def _first_end_of_point(state: State, w: int, k: int, flight: Flight, horizon: float) -> tuple[float, int]:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    best, index = horizon, -1
    if ball.contact == RIDING:
        return best, index
    first, last = faces_near(state, scene, ball.x, ball.y)
    for at in range(first, last):
        i = face_near(state, scene, at)
        face = state.faces[scene, i]
        if is_off(state, w, face.element) or not _is_level_on_face(ball, flight, face):
            continue
        from_start, line = flight_seen_from(flight, face.x, face.y), face_line(face)
        if not is_beside_line(line, from_start.x, from_start.y, ball.tolerance) or leaves_line_end(
            from_start, line, ball.tolerance
        ):
            continue
        t = _way_to_face_end(flight, face)
        if t < best:
            best, index = t, i
    return best, index


@function
def _way_to_face_end(flight: Flight, face: Record) -> float:
    """Duration after which a ball that moves along a wall is at one of its ends; inf if it comes to none."""
    along = (flight.x - face.x) * face.ux + (flight.y - face.y) * face.uy
    rate = flight.vx * face.ux + flight.vy * face.uy
    pull, back = (
        flight_acceleration_along(flight, face.ux, face.uy),
        flight_acceleration_along(flight, -face.ux, -face.uy),
    )
    return min(falling_root(along, False, rate, pull), falling_root(face.length - along, False, -rate, back))
