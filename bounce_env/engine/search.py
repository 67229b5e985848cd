"""What a ball meets next, from its last event: standing elements first, whose earliest hit bounds all other searches.

Everything standing is searched once per flight and kept as a duration from the flight's start; the ball's search for a
moving part starts at the later of the ball's last event and the part's last command or stop. Neither depends on where
a step ends. A ball in contact with a wall flies, too: along its line, under what the wall leaves of its acceleration.
"""

import math

from bounce_env.engine.arc import arc_time
from bounce_env.engine.flight import dot, moved, swept, time_in_scene
from bounce_env.engine.impact import beside, circle_time, face_time, facing_time, falling_time, leaves_end
from bounce_env.engine.instant import before, later
from bounce_env.engine.jit import Feature, Record, Table, function, function_of_feature, routine
from bounce_env.engine.layout import (
    NEXT_HIT,
    NEXT_PART,
    NEXT_SENSOR,
    NEXT_ZONE,
    OFF_END,
    OFF_PART,
    ON_ARC,
    ON_CIRCLE,
    ON_FACE,
    RESOLVE,
    RIDING,
    State,
    Tables,
)
from bounce_env.engine.parts import is_off, plan_meetings, plan_zones, way_off_part
from bounce_env.engine.sensing import next_crossing
from bounce_env.engine.tolerances import PRESSING, ULPS_OF_SPEED


def _no_pull(gravity: Table, ball: Record) -> tuple[None, None]:
    return None, None


@function_of_feature(absent=_no_pull)
def pull(gravity: Table, ball: Record) -> tuple[Feature, Feature]:
    """The acceleration [m/s^2] of the ball's present flight; (None, None) where no scene of the batch has any."""
    return ball.ax, ball.ay


@function
def side_on(sides: Table, w: int, k: int, i: int) -> int:
    """On which side, 1 or -1, of surface `i` a touching ball of no radius is; 0 for a disc, whose centre tells."""
    if sides is None:
        return 0
    return sides[w, k, i]


@function
def is_gate(gates: Table, scene: int, i: int) -> bool:
    """Whether face `i` is that of a one-way wall, which is struck from the left only."""
    if gates is None:
        return False
    return gates[scene, i] != 0


@function
def is_sliding(ball: Record) -> bool:
    """Whether a ball slides on a wall or on the straight side of a part."""
    return ball.contact >= 0 or ball.contact == RIDING


@function
def wall_normal(state: State, faces: Table, w: int, k: int, i: int) -> tuple[float, float]:
    """Unit normal, to the ball, of face `i`, that it is in contact with or touches; (0, 0) if there is none (i < 0)."""
    ball = state.balls[w, k]
    if faces is None or i < 0:
        return 0.0, 0.0
    face = faces[state.worlds[w].scene, i]
    side = side_on(state.face_sides, w, k, i)
    height = (ball.y - face.y) * face.ux - (ball.x - face.x) * face.uy
    facing = 1.0 if side > 0 or (side == 0 and height >= 0.0) else -1.0
    return -facing * face.uy, facing * face.ux


@function
def _is_level(ball: Record, face: Record, gx: Feature, gy: Feature) -> bool:
    """Whether a ball touches a wall and keeps doing so: it moves along it, and nothing pulls it off."""
    height = (ball.y - face.y) * face.ux - (ball.x - face.x) * face.uy
    if abs(abs(height) - face.reach) > ball.slack:
        return False
    rate = ball.vy * face.ux - ball.vx * face.uy
    if abs(rate) > 4.0 * ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy)):
        return False
    if gx is None:
        return True
    return abs(gy * face.ux - gx * face.uy) <= PRESSING * (abs(gx) + abs(gy))


@function
def first_face(
    ball: Record,
    faces: Table,
    gates: Table,
    count: int,
    sides: Table,
    disabled: Table,
    w: int,
    k: int,
    scene: int,
    gx: Feature,
    gy: Feature,
    nx: float,
    ny: float,
    horizon: float,
) -> tuple[float, int]:
    """Earliest hit of a wall's straight part before `horizon`: (duration, face). (nx, ny): see `wall_normal`."""
    best, index = horizon, -1
    if faces is None:
        return best, index
    for i in range(count):
        face = faces[scene, i]
        if is_off(disabled, w, face.element):
            continue
        if is_sliding(ball) and (i == ball.contact or _is_level(ball, face, gx, gy)):
            continue
        x, y, side = ball.x - face.x, ball.y - face.y, side_on(sides, w, k, i)
        if is_gate(gates, scene, i):
            t = facing_time(
                x, y, ball.vx, ball.vy, gx, gy, face.ux, face.uy, face.length, face.reach, 1.0, side, ball.slack, best
            )
        else:
            t = face_time(
                x, y, ball.vx, ball.vy, gx, gy, face.ux, face.uy, face.length, face.reach, side, ball.slack, best
            )
        if t < best and not _slides_over(ball, face, nx, ny, gx, gy, t):
            best, index = t, i
    return best, index


@function
def _slides_over(ball: Record, face: Record, nx: float, ny: float, gx: Feature, gy: Feature, t: float) -> bool:
    """Whether a point that slides on a wall with normal (nx, ny) passes, after `t` seconds, an end beneath it."""
    if not is_sliding(ball) or face.reach > 0.0:
        return False
    along = (moved(ball.x, ball.vx, gx, t) - face.x) * face.ux + (moved(ball.y, ball.vy, gy, t) - face.y) * face.uy
    rise = face.ux * nx + face.uy * ny
    return (along <= ball.slack and rise <= 0.0) or (along >= face.length - ball.slack and rise >= 0.0)


@function
def _slides_past(ball: Record, nx: float, ny: float, x: float, y: float, reach: float) -> bool:
    """Whether a ball that slides on a wall with normal (nx, ny) just touches a circle that has it at (x, y)."""
    return is_sliding(ball) and x * nx + y * ny >= reach - ball.slack


@function
def first_circle(
    ball: Record,
    circles: Table,
    count: int,
    disabled: Table,
    w: int,
    scene: int,
    gx: Feature,
    gy: Feature,
    nx: float,
    ny: float,
    horizon: float,
) -> tuple[float, int]:
    """Earliest hit of a bumper or an end before `horizon`: (duration, circle). (nx, ny): see `wall_normal`.

    A circle that the box swept by the flight does not reach cannot be hit; most are rejected by that alone.
    """
    best, index = horizon, -1
    if circles is None:
        return best, index
    left, right = swept(ball.x, ball.vx, gx, horizon)
    below, above = swept(ball.y, ball.vy, gy, horizon)
    for i in range(count):
        circle = circles[scene, i]
        reach = circle.reach + ball.slack
        # Written so that a box with infinite or undefined borders (an unbounded flight) rejects nothing.
        if circle.x + reach < left or circle.x - reach > right or circle.y + reach < below or circle.y - reach > above:
            continue
        x, y = ball.x - circle.x, ball.y - circle.y
        if is_off(disabled, w, circle.element) or _slides_past(ball, nx, ny, x, y, circle.reach):
            continue
        t = circle_time(x, y, ball.vx, ball.vy, gx, gy, circle.reach, ball.slack, best)
        if t < best:
            best, index = t, i
    return best, index


@function
def first_arc(
    ball: Record,
    arcs: Table,
    count: int,
    sides: Table,
    disabled: Table,
    w: int,
    k: int,
    scene: int,
    gx: Feature,
    gy: Feature,
    nx: float,
    ny: float,
    horizon: float,
) -> tuple[float, int]:
    """Earliest hit of an arc before `horizon`: (duration, arc)."""
    best, index = horizon, -1
    if arcs is None:
        return best, index
    left, right = swept(ball.x, ball.vx, gx, horizon)
    below, above = swept(ball.y, ball.vy, gy, horizon)
    for i in range(count):
        arc = arcs[scene, i]
        reach = arc.outer + ball.slack
        if arc.x + reach < left or arc.x - reach > right or arc.y + reach < below or arc.y - reach > above:
            continue
        if is_off(disabled, w, arc.element):
            continue
        x, y = ball.x - arc.x, ball.y - arc.y
        past = _slides_past(ball, nx, ny, x, y, arc.outer)
        t = arc_time(arc, x, y, ball.vx, ball.vy, gx, gy, side_on(sides, w, k, i), past, ball.slack, best)
        if t < best:
            best, index = t, i
    return best, index


@function
def first_end(
    ball: Record,
    faces: Table,
    count: int,
    sides: Table,
    disabled: Table,
    w: int,
    scene: int,
    gx: Feature,
    gy: Feature,
    horizon: float,
) -> tuple[float, int]:
    """Earliest end before `horizon` of a wall that the ball slides on: (duration, face).

    A ball of no radius that only flies along a wall comes to its end, too: what goes on there it would not meet
    otherwise, where a disc touches the round end.
    """
    best, index = horizon, -1
    if faces is None:
        return best, index
    if ball.contact >= 0:
        t = _way_to_end(ball, faces[scene, ball.contact], gx, gy)
        if t < best:
            best, index = t, ball.contact
    elif sides is not None and ball.contact != RIDING:
        for i in range(count):
            face = faces[scene, i]
            if is_off(disabled, w, face.element) or not _is_level(ball, face, gx, gy):
                continue
            x, y = ball.x - face.x, ball.y - face.y
            if not beside(x, y, face.ux, face.uy, face.length, ball.slack):
                continue
            if leaves_end(x, y, ball.vx, ball.vy, gx, gy, face.ux, face.uy, face.length, face.reach, ball.slack):
                continue
            t = _way_to_end(ball, face, gx, gy)
            if t < best:
                best, index = t, i
    return best, index


@function
def _way_to_end(ball: Record, face: Record, gx: Feature, gy: Feature) -> float:
    """Duration after which a ball that moves along a wall is at one of its ends; inf if it comes to none."""
    along = (ball.x - face.x) * face.ux + (ball.y - face.y) * face.uy
    rate = ball.vx * face.ux + ball.vy * face.uy
    pull = dot(gx, gy, face.ux, face.uy)
    back = dot(gx, gy, -face.ux, -face.uy)
    return min(falling_time(along, False, rate, pull), falling_time(face.length - along, False, -rate, back))


@routine
def plan_parts(state: State, tables: Tables, w: int, k: int) -> None:
    """Search the parts in whose zone a ball is, and set its next event."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    gx, gy = pull(tables.gravity, ball)
    plan_meetings(ball, state, tables, state.motions, tables.parts, state.zones, w, k, scene, gx, gy)
    schedule(ball)


@function
def plan_crossing(state: State, tables: Tables, w: int, k: int, after: float, kind: int, index: int) -> None:
    """Search the next crossing after (after, kind, index) in the present flight, and set the ball's next event."""
    ball = state.balls[w, k]
    gx, gy = pull(tables.gravity, ball)
    ball.sensor_after, ball.sensor_kind, ball.sensor_index = next_crossing(
        state, tables, w, k, gx, gy, after, kind, index
    )
    schedule(ball)


@function
def plan_standing(state: State, tables: Tables, w: int, k: int) -> None:
    """Search everything that stands: what ends the flight that begins now, and when."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = tables.scenes[scene]
    gx, gy = pull(tables.gravity, ball)
    nx, ny = wall_normal(state, tables.faces, w, k, ball.contact)
    if ball.contact == RIDING:
        nx, ny = ball.nx, ball.ny
    horizon = time_in_scene(head.extent, ball.x, ball.y, ball.vx, ball.vy, gx, gy)
    after, face = first_face(
        ball,
        tables.faces,
        tables.gates,
        head.faces,
        state.face_sides,
        state.disabled,
        w,
        k,
        scene,
        gx,
        gy,
        nx,
        ny,
        horizon,
    )
    ball.hit_kind, ball.hit_index = ON_FACE, face
    after, circle = first_circle(ball, tables.circles, head.circles, state.disabled, w, scene, gx, gy, nx, ny, after)
    if circle >= 0:
        ball.hit_kind, ball.hit_index = ON_CIRCLE, circle
    after, arc = first_arc(
        ball, tables.arcs, head.arcs, state.arc_sides, state.disabled, w, k, scene, gx, gy, nx, ny, after
    )
    if arc >= 0:
        ball.hit_kind, ball.hit_index = ON_ARC, arc
    after, end = first_end(ball, tables.faces, head.faces, state.face_sides, state.disabled, w, scene, gx, gy, after)
    if end >= 0:
        ball.hit_kind, ball.hit_index = OFF_END, end
    met = face >= 0 or circle >= 0 or arc >= 0 or end >= 0
    if ball.contact == RIDING:
        off = way_off_part(ball, state.motions, tables.parts, tables.turns, state.ends, w, scene, gx, gy)
        if off < after:
            after, met = off, True
            ball.hit_kind, ball.hit_index = OFF_PART, ball.rides
    ball.end_after = after
    ball.hit_after = after if met else math.inf


@function
def plan_rest(state: State, tables: Tables, w: int, k: int) -> None:
    """Search what does not end the flight, or may move: sensors, zones, parts; and set the ball's next event."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    gx, gy = pull(tables.gravity, ball)
    ball.sensor_after, ball.sensor_kind, ball.sensor_index = next_crossing(state, tables, w, k, gx, gy, -1.0, -1, -1)
    plan_zones(ball, state, tables, state.zones, tables.parts, w, k, scene, gx, gy, 0.0)
    plan_parts(state, tables, w, k)


@function
def resolve_next(ball: Record) -> None:
    """Let the ball's next event be at the instant of its last: to bounce from what it touches, and to be planned."""
    ball.hit_kind, ball.hit_after, ball.end_after = RESOLVE, 0.0, 0.0
    ball.sensor_after, ball.zone_after, ball.part_hi, ball.part_lo = math.inf, math.inf, math.inf, 0.0
    schedule(ball)


@function
def schedule(ball: Record) -> None:
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
