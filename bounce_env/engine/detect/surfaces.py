"""What stands in the way of a ball: the earliest hit of walls, circles and arcs, and the end of what it slides on."""

from bounce_env.engine.compile.jit import Feature, Record, Table, function
from bounce_env.engine.impact.arc import arc_time
from bounce_env.engine.impact.circle import circle_time
from bounce_env.engine.impact.line import beside, face_time, facing_time, leaves_end
from bounce_env.engine.memory.lookup import is_gate, is_off, is_sliding, side_on
from bounce_env.engine.memory.records import RIDING
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import dot, moved, swept
from bounce_env.engine.motion.roots import falling_time
from bounce_env.engine.tolerances import PRESSING, ULPS_OF_SPEED


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
