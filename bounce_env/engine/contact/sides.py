"""The sides of lines, arcs and parts that a ball is on, brought up to date at the end of a flight.

Sides matter to a ball of no radius, which can be on a wall, and to what is crossed without a bounce.
"""

import math

from bounce_env.engine.compile.jit import Record, Table, function
from bounce_env.engine.detect.surfaces import wall_normal
from bounce_env.engine.impact.line import leaves_end
from bounce_env.engine.memory.lookup import is_dragged, is_off
from bounce_env.engine.memory.records import CLOSED, NEXT_PART, OFF_END
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.dragged_wall import height_over
from bounce_env.engine.motion.flight import bending, moved, sped
from bounce_env.engine.motion.instant import since
from bounce_env.engine.tolerances import ULPS_OF_SPEED


@function
def _side_after(
    height: float, rate: float, height0: float, rate0: float, t: float, slow: float, slack: float, side: int
) -> int:
    """On which side of a line or circle the ball is: away from it the height tells, on it the way that it came.

    It came from the side that it moves away from, unless it was there already when its flight, of `t` seconds, began,
    and neither left meanwhile nor turned round; then it keeps the side that it had.
    """
    if abs(height) > slack:
        return 1 if height > 0.0 else -1
    left = abs(height0) > slack or abs(rate0) * t > 4.0 * slack
    turned = rate * rate0 < 0.0 and abs(rate0) > slow
    if abs(rate) > slow and (left or turned):
        return 1 if rate < 0.0 else -1
    return side


@function
def arrive(state: State, w: int, k: int, x0: float, y0: float, vx0: float, vy0: float, t: float) -> None:
    """Bring a ball's sides of walls and arcs up to date before it bounces.

    (x0, y0) [m] and (vx0, vy0) [m/s] are where and how its flight began, `t` seconds ago.
    """
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    left = _left_face(ball, state.faces, head.faces, state.face_sides, state.disabled, w, scene)
    nx, ny = wall_normal(state, state.faces, w, k, left)
    _arrive_at_lines(ball, state.faces, head.faces, state.face_sides, w, k, scene, x0, y0, vx0, vy0, t)
    _arrive_at_arcs(ball, state.arcs, head.arcs, state.arc_sides, w, k, scene, x0, y0, vx0, vy0, t)
    _arrive_at_parts(
        ball, state.parts, head.parts, state.motions, state.ends, state.part_sides, w, k, scene, x0, y0, vx0, vy0, t
    )
    if left >= 0:
        turn = _turn_about_end(ball, state.faces, left, scene, nx, ny)
        _turn_to_faces(ball, state.faces, head.faces, state.face_sides, w, k, scene, left, turn)
        _turn_to_arcs(ball, state.arcs, head.arcs, state.arc_sides, w, k, scene, turn)


@function
def _arrive_at_lines(
    ball: Record, lines: Table, count: int, sides: Table, w: int, k: int, scene: int,
    x0: float, y0: float, vx0: float, vy0: float, t: float,
) -> None:  # fmt: skip
    if lines is None or sides is None:
        return
    slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    for i in range(count):
        line = lines[scene, i]
        height = (ball.y - line.y) * line.ux - (ball.x - line.x) * line.uy
        height0 = (y0 - line.y) * line.ux - (x0 - line.x) * line.uy
        rate, rate0 = ball.vy * line.ux - ball.vx * line.uy, vy0 * line.ux - vx0 * line.uy
        sides[w, k, i] = _side_after(height, rate, height0, rate0, t, slow, ball.slack, sides[w, k, i])


@function
def _arrive_at_arcs(
    ball: Record, arcs: Table, count: int, sides: Table, w: int, k: int, scene: int,
    x0: float, y0: float, vx0: float, vy0: float, t: float,
) -> None:  # fmt: skip
    if arcs is None or sides is None:
        return
    slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    for i in range(count):
        arc = arcs[scene, i]
        dx, dy, dx0, dy0 = ball.x - arc.x, ball.y - arc.y, x0 - arc.x, y0 - arc.y
        distance, distance0 = math.sqrt(dx * dx + dy * dy), math.sqrt(dx0 * dx0 + dy0 * dy0)
        height, height0 = distance - arc.outer, distance0 - arc.outer
        rate, rate0 = (ball.vx * dx + ball.vy * dy) / distance, (vx0 * dx0 + vy0 * dy0) / distance0
        # Of a touch in passing (see `grazes`) the instant, and so the way the distance changes, is only roughly known.
        bend = bending(dx, dy, ball.vx, ball.vy, ball.ax, ball.ay)
        vague = max(slow, math.sqrt(2.0 * abs(bend) * ball.slack))
        sides[w, k, i] = _side_after(height, rate, height0, rate0, t, vague, ball.slack, sides[w, k, i])


@function
def _arrive_at_parts(
    ball: Record, parts: Table, count: int, motions: Table, all_ends: Table, sides: Table, w: int, k: int, scene: int,
    x0: float, y0: float, vx0: float, vy0: float, t: float,
) -> None:  # fmt: skip
    """A dragged wall is looked at from its last command or stop on, where the flight began before that."""
    if parts is None or motions is None or all_ends is None or sides is None:
        return
    slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    for m in range(count):
        motion, ends = motions[w, m], all_ends[w, m]
        if not is_dragged(ends, parts[scene, m]):
            continue
        until = since(ball.hi, ball.lo, motion.hi, motion.lo)
        both = max(min(t, until), 0.0)
        x, y = moved(x0, vx0, ball.ax, t - both), moved(y0, vy0, ball.ay, t - both)
        vx, vy = sped(vx0, ball.ax, t - both), sped(vy0, ball.ay, t - both)
        height0, rate0 = height_over(ends, until - both, x, y, vx, vy)
        height, rate = height_over(ends, until, ball.x, ball.y, ball.vx, ball.vy)
        slower = slow + ULPS_OF_SPEED * (abs(ends.vx0) + abs(ends.vy0) + abs(ends.vx1) + abs(ends.vy1))
        sides[w, k, m] = _side_after(height, rate, height0, rate0, both, slower, ball.slack, sides[w, k, m])


@function
def _left_face(ball: Record, faces: Table, count: int, sides: Table, disabled: Table, w: int, scene: int) -> int:
    """The face off whose end a ball of no radius comes just now, sliding or flying along it; -1 if there is none.

    What goes on at the end may be met at the same instant, and be what it is said to have hit.
    """
    if faces is None or sides is None:
        return -1
    if ball.next_kind != NEXT_PART and ball.hit_kind == OFF_END:
        return ball.hit_index
    for i in range(count):
        face = faces[scene, i]
        x, y, vx, vy = ball.x - face.x, ball.y - face.y, ball.vx, ball.vy
        leaves = leaves_end(x, y, vx, vy, None, None, face.ux, face.uy, face.length, face.reach, ball.slack)
        if leaves and not is_off(disabled, w, face.element):
            return i
    return -1


@function
def _turn_about_end(ball: Record, faces: Table, left: int, scene: int, nx: float, ny: float) -> float:
    """Which way a point turns that comes off a wall's end: about the end, from the wall through the side it is on.

    1.0 is counter-clockwise, -1.0 clockwise. Of what else begins or ends there it is on the side that is met first.
    """
    if faces is None:
        return 0.0
    face = faces[scene, left]
    along = (ball.x - face.x) * face.ux + (ball.y - face.y) * face.uy
    back = -1.0 if along > 0.5 * face.length else 1.0
    return 1.0 if back * (face.ux * ny - face.uy * nx) > 0.0 else -1.0


@function
def _turn_to_faces(
    ball: Record, faces: Table, count: int, sides: Table, w: int, k: int, scene: int, left: int, turn: float
) -> None:
    if faces is None or sides is None:
        return
    for i in range(count):
        face = faces[scene, i]
        dx, dy = ball.x - face.x, ball.y - face.y
        if i == left or abs(dy * face.ux - dx * face.uy) > ball.slack:
            continue
        along = dx * face.ux + dy * face.uy
        if abs(along) <= ball.slack:
            sides[w, k, i] = -1 if turn > 0.0 else 1
        elif abs(along - face.length) <= ball.slack:
            sides[w, k, i] = 1 if turn > 0.0 else -1


@function
def _turn_to_arcs(ball: Record, arcs: Table, count: int, sides: Table, w: int, k: int, scene: int, turn: float) -> None:
    if arcs is None or sides is None:
        return
    for i in range(count):
        arc = arcs[scene, i]
        if arc.span == CLOSED:
            continue
        dx, dy = ball.x - arc.x, ball.y - arc.y
        if abs(dx - arc.sx * arc.outer) + abs(dy - arc.sy * arc.outer) <= 2.0 * ball.slack:
            sides[w, k, i] = 1 if turn > 0.0 else -1
        elif abs(dx - arc.ex * arc.outer) + abs(dy - arc.ey * arc.outer) <= 2.0 * ball.slack:
            sides[w, k, i] = -1 if turn > 0.0 else 1


@function
def face_crossings(state: State, w: int, k: int) -> None:
    """Bring the ball's sides of sensors and fields up to date where its place tells; a crossing itself flips them."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    _face_lines(ball, state.sensors, head.sensors, state.sensor_sides, w, k, scene)
    _face_lines(ball, state.edges, head.fields, state.edge_sides, w, k, scene)
    _face_rings(ball, state.rings, head.rings, state.ring_sides, w, k, scene)


@function
def _face_lines(ball: Record, lines: Table, count: int, sides: Table, w: int, k: int, scene: int) -> None:
    if lines is None or sides is None:
        return
    for i in range(count):
        line = lines[scene, i]
        height = (ball.y - line.y) * line.ux - (ball.x - line.x) * line.uy
        if abs(height) > ball.slack:
            sides[w, k, i] = 1 if height > 0.0 else -1


@function
def _face_rings(ball: Record, rings: Table, count: int, sides: Table, w: int, k: int, scene: int) -> None:
    if rings is None or sides is None:
        return
    for i in range(count):
        ring = rings[scene, i]
        dx, dy = ball.x - ring.x, ball.y - ring.y
        height = math.sqrt(dx * dx + dy * dy) - ring.radius
        if abs(height) > ball.slack:
            sides[w, k, i] = 1 if height > 0.0 else -1
