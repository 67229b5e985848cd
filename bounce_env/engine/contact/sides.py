"""The sides of lines, arcs and parts that a ball is on, brought up to date at the end of a flight.

Sides matter to a ball of no radius, which can be on a wall, and to what is crossed without a bounce.
"""

import math

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.detect.surfaces import face_line, surface_normal
from bounce_env.engine.impact.grazing import bending
from bounce_env.engine.impact.line import leaves_line_end
from bounce_env.engine.memory.lookup import face_near, faces_near, is_off
from bounce_env.engine.memory.records import CLOSED, NEXT_HIT, NEXT_PART, OFF_END, ON_CURVE, ON_JOINT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.dragged_wall import height_over_dragged_wall
from bounce_env.engine.motion.flight import Flight, coordinate_after, flight_seen_from, speed_after
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.parts import is_dragged_part, moving_part
from bounce_env.engine.tolerances import ULPS_OF_SPEED


@function
def update_sides(state: State, w: int, k: int, start: Flight, t: float) -> None:
    """Bring a ball's sides of walls, arcs and parts up to date before it bounces.

    start: where and how its flight began, `t` seconds ago; its acceleration is not asked.
    """
    left = _face_left_at_end(state, w, k)
    nx, ny = surface_normal(state, w, k, left)
    _update_faces(state, w, k, start, t)
    _update_arcs(state, w, k, start, t)
    _update_parts(state, w, k, start, t)
    if left >= 0:
        turn = _turn_about_end(state, w, k, left, nx, ny)
        _turn_to_faces(state, w, k, left, turn)
        _turn_to_arcs(state, w, k, -1, turn)
    _update_at_joint(state, w, k)


@function
def _side_after_flight(
    height: float, rate: float, height0: float, rate0: float, t: float, slow: float, tolerance: float, side: int
) -> int:
    """Return on which side of a line or circle the ball is: away from it the height tells, on it the way that it came.

    It came from the side that it moves away from, unless it was there already when its flight, of `t` seconds, began,
    and neither left meanwhile nor turned round; then it keeps the side that it had.
    """
    if abs(height) > tolerance:
        return 1 if height > 0.0 else -1
    left = abs(height0) > tolerance or abs(rate0) * t > 4.0 * tolerance
    turned = rate * rate0 < 0.0 and abs(rate0) > slow
    if abs(rate) > slow and (left or turned):
        return 1 if rate < 0.0 else -1
    return side


@where("face_sides")
def _update_faces(state: State, w: int, k: int, start: Flight, t: float) -> None:
    ball, scene, sides = state.balls[w, k], state.worlds[w].scene, state.face_sides
    slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    first, last = faces_near(state, scene, ball.x, ball.y)
    for at in range(first, last):
        i = face_near(state, scene, at)
        line = state.faces[scene, i]
        height = (ball.y - line.y) * line.ux - (ball.x - line.x) * line.uy
        height0 = (start.y - line.y) * line.ux - (start.x - line.x) * line.uy
        rate, rate0 = ball.vy * line.ux - ball.vx * line.uy, start.vy * line.ux - start.vx * line.uy
        side = _side_at_start(state, height0, ball.tolerance, sides[w, k, i])
        sides[w, k, i] = _side_after_flight(height, rate, height0, rate0, t, slow, ball.tolerance, side)


def _known_side(state: State, height: float, tolerance: float, side: int) -> int:
    return side


@where("grids", otherwise=_known_side)
def _side_at_start(state: State, height: float, tolerance: float, side: int) -> int:
    """Return on which side of a wall a ball was: events bring up to date only those of walls that are near."""
    if abs(height) > tolerance:
        return 1 if height > 0.0 else -1
    return side


@where("arc_sides")
def _update_arcs(state: State, w: int, k: int, start: Flight, t: float) -> None:
    ball, scene, sides = state.balls[w, k], state.worlds[w].scene, state.arc_sides
    slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    for i in range(state.scenes[scene].arcs):
        arc = state.arcs[scene, i]
        dx, dy, dx0, dy0 = ball.x - arc.x, ball.y - arc.y, start.x - arc.x, start.y - arc.y
        distance, distance0 = math.sqrt(dx * dx + dy * dy), math.sqrt(dx0 * dx0 + dy0 * dy0)
        height, height0 = distance - arc.outer, distance0 - arc.outer
        rate, rate0 = (ball.vx * dx + ball.vy * dy) / distance, (start.vx * dx0 + start.vy * dy0) / distance0
        # Of a touch in passing (see `grazes`) the instant, and so the way the distance changes, is only roughly known.
        curvature = bending(Flight(dx, dy, ball.vx, ball.vy, ball.ax, ball.ay))
        vague = max(slow, math.sqrt(2.0 * abs(curvature) * ball.tolerance))
        sides[w, k, i] = _side_after_flight(height, rate, height0, rate0, t, vague, ball.tolerance, sides[w, k, i])


@where("part_sides")
def _update_parts(state: State, w: int, k: int, start: Flight, t: float) -> None:
    """A dragged wall is looked at from its last command or stop on, where the flight began before that."""
    ball, sides = state.balls[w, k], state.part_sides
    slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    for m in range(state.scenes[state.worlds[w].scene].parts):
        part = moving_part(state, w, m)
        if not is_dragged_part(part):
            continue
        ends = part.ends
        until = since(ball.hi, ball.lo, part.motion.hi, part.motion.lo)
        both = max(min(t, until), 0.0)
        x, y = (
            coordinate_after(start.x, start.vx, ball.ax, t - both),
            coordinate_after(start.y, start.vy, ball.ay, t - both),
        )
        vx, vy = speed_after(start.vx, ball.ax, t - both), speed_after(start.vy, ball.ay, t - both)
        height0, rate0 = height_over_dragged_wall(ends, until - both, x, y, vx, vy)
        height, rate = height_over_dragged_wall(ends, until, ball.x, ball.y, ball.vx, ball.vy)
        slower = slow + ULPS_OF_SPEED * (abs(ends.vx0) + abs(ends.vy0) + abs(ends.vx1) + abs(ends.vy1))
        sides[w, k, m] = _side_after_flight(height, rate, height0, rate0, both, slower, ball.tolerance, sides[w, k, m])


@where("face_sides", otherwise=-1)
def _face_left_at_end(state: State, w: int, k: int) -> int:
    """Return the face off whose end a ball of no radius comes just now, sliding or flying along it; -1 for none.

    What goes on at the end may be met at the same instant, and be what it is said to have hit.
    """
    ball, scene = state.balls[w, k], state.worlds[w].scene
    if ball.next_kind != NEXT_PART and ball.hit_kind == OFF_END:
        return ball.hit_index
    now = Flight(ball.x, ball.y, ball.vx, ball.vy, None, None)
    first, last = faces_near(state, scene, ball.x, ball.y)
    for at in range(first, last):
        i = face_near(state, scene, at)
        face = state.faces[scene, i]
        leaves = leaves_line_end(flight_seen_from(now, face.x, face.y), face_line(face), ball.tolerance)
        if leaves and not is_off(state, w, face.element):
            return i
    return -1


@where("faces", otherwise=0.0)
def _turn_about_end(state: State, w: int, k: int, left: int, nx: float, ny: float) -> float:
    """Return which way a point turns about a wall's end that it comes off, from the wall through its own side.

    1.0 is counter-clockwise, -1.0 clockwise. Of what else begins or ends there it is on the side that is met first.
    """
    ball, face = state.balls[w, k], state.faces[state.worlds[w].scene, left]
    along = (ball.x - face.x) * face.ux + (ball.y - face.y) * face.uy
    back = -1.0 if along > 0.5 * face.length else 1.0
    return 1.0 if back * (face.ux * ny - face.uy * nx) > 0.0 else -1.0


@where("face_sides")
def _turn_to_faces(state: State, w: int, k: int, left: int, turn: float) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    first, last = faces_near(state, scene, ball.x, ball.y)
    for at in range(first, last):
        i = face_near(state, scene, at)
        face = state.faces[scene, i]
        dx, dy = ball.x - face.x, ball.y - face.y
        if i == left or abs(dy * face.ux - dx * face.uy) > ball.tolerance:
            continue
        along = dx * face.ux + dy * face.uy
        if abs(along) <= ball.tolerance:
            state.face_sides[w, k, i] = -1 if turn > 0.0 else 1
        elif abs(along - face.length) <= ball.tolerance:
            state.face_sides[w, k, i] = 1 if turn > 0.0 else -1


@where("arc_sides")
def _update_at_joint(state: State, w: int, k: int) -> None:
    """Set a point's sides of what begins or ends where it comes to along a wall or an arc, by the side it is on."""
    ball = state.balls[w, k]
    if ball.next_kind != NEXT_HIT or ball.hit_kind != ON_JOINT:
        return
    nx, ny = surface_normal(state, w, k, ball.hit_index)
    arc = -1
    if ball.contact == ON_CURVE:
        slide = state.curve_slides[w, k]
        nx, ny, arc = slide.facing * (ball.x - slide.x), slide.facing * (ball.y - slide.y), slide.arc
    # From where it came round through its own side, see `_turn_about_end`.
    turn = 1.0 if ball.vy * nx - ball.vx * ny > 0.0 else -1.0
    _turn_to_faces(state, w, k, ball.hit_index, turn)
    _turn_to_arcs(state, w, k, arc, turn)


@where("arc_sides")
def _turn_to_arcs(state: State, w: int, k: int, left: int, turn: float) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for i in range(state.scenes[scene].arcs):
        arc = state.arcs[scene, i]
        if i == left or arc.span == CLOSED:
            continue
        dx, dy = ball.x - arc.x, ball.y - arc.y
        if abs(dx - arc.sx * arc.outer) + abs(dy - arc.sy * arc.outer) <= 2.0 * ball.tolerance:
            state.arc_sides[w, k, i] = 1 if turn > 0.0 else -1
        elif abs(dx - arc.ex * arc.outer) + abs(dy - arc.ey * arc.outer) <= 2.0 * ball.tolerance:
            state.arc_sides[w, k, i] = -1 if turn > 0.0 else 1


@function
def update_crossing_sides(state: State, w: int, k: int) -> None:
    """Bring the ball's sides of sensors and fields up to date where its place tells; a crossing itself flips them."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    _update_lines(ball, state.sensors, state.sensor_sides, head.sensors, w, k, scene)
    _update_lines(ball, state.field_edges, state.field_edge_sides, head.fields, w, k, scene)
    _update_circle_sensors(state, w, k)


@function
def _update_lines(ball: Record, lines: Table, sides: Table, count: int, w: int, k: int, scene: int) -> None:
    """One loop for sensors and for the borders of fields: `lines` and `sides` are those of one of the two."""
    if lines is None or sides is None:
        return
    for i in range(count):
        line = lines[scene, i]
        height = (ball.y - line.y) * line.ux - (ball.x - line.x) * line.uy
        if abs(height) > ball.tolerance:
            sides[w, k, i] = 1 if height > 0.0 else -1


@where("circle_sensors")
def _update_circle_sensors(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for i in range(state.scenes[scene].circle_sensors):
        ring = state.circle_sensors[scene, i]
        dx, dy = ball.x - ring.x, ball.y - ring.y
        height = math.sqrt(dx * dx + dy * dy) - ring.radius
        if abs(height) > ball.tolerance:
            state.circle_sensor_sides[w, k, i] = 1 if height > 0.0 else -1
