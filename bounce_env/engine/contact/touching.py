"""What a ball touches at the instant that is resolved: one list, whatever the shapes.

The ball does not move while its bounces at one instant are resolved, so the list is made once for all of them.
"""

import math

from bounce_env.engine.compile.jit import Record, Table, function, routine, where
from bounce_env.engine.contact.restitution import closing_speed, is_standing
from bounce_env.engine.detect.surfaces import face_line
from bounce_env.engine.impact.arc import is_in_arc_span
from bounce_env.engine.impact.line import is_beside_line
from bounce_env.engine.memory.lookup import (
    circle_near,
    circles_near,
    face_near,
    faces_near,
    is_off,
    is_one_way,
    side_of_part,
    side_on,
)
from bounce_env.engine.memory.records import CLOSED
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.parts import (
    Core,
    MovingPart,
    moving_part,
    nearest_on_core,
    part_core_at,
    part_spin,
    part_surface_velocity,
)
from bounce_env.engine.tolerances import CLUSTER_GAP, SMALLEST_REBOUND


@function
def collect_touches(state: State, w: int, k: int) -> None:
    """List in `state.touches[w]` all surfaces that ball `k` touches within its tolerance, `ball.touched` of them."""
    state.balls[w, k].touched = 0
    _touch_faces(state, w, k)
    _touch_circles(state, w, k)
    _touch_arcs(state, w, k)
    _touch_parts(state, w, k)


@function
def keep_outside_touched(ball: Record, touches: Table, w: int) -> None:
    """Put a ball that touches a part on what stands and touches it, too: if the part moves, on other parts as well.

    It has been put on the part; one that keeps pushing it there would, rounding by rounding, push it through.
    """
    pushed, moved = False, False
    for i in range(ball.touched):
        pushed = pushed or touches[w, i].part >= 0
        moved = moved or not is_standing(touches[w, i])
    for i in range(ball.touched):
        touch = touches[w, i]
        if (pushed and touch.part < 0) or (moved and is_standing(touch)):
            ball.x, ball.y = ball.x - touch.gap * touch.nx, ball.y - touch.gap * touch.ny


@routine
def keep_beside(state: State, w: int, k: int) -> None:
    """Put a ball that has been moved by less than a cluster's tolerance exactly beside what it does not leave."""
    ball, tolerance = state.balls[w, k], state.balls[w, k].tolerance
    ball.tolerance = 2.0 * CLUSTER_GAP * state.scenes[state.worlds[w].scene].extent
    collect_touches(state, w, k)
    ball.tolerance = tolerance
    for i in range(ball.touched):
        touch = state.touches[w, i]
        if touch.gap < 0.0 or closing_speed(ball, touch) >= 0.0 or touch.element == ball.support:
            ball.x, ball.y = ball.x - touch.gap * touch.nx, ball.y - touch.gap * touch.ny


@function
def _add_touch(
    state: State, w: int, k: int, nx: float, ny: float, gap: float, curvature: float, element: int, face: int
) -> bool:
    """Add a standing surface to the list, if there is room for it; returns whether there was."""
    ball = state.balls[w, k]
    if ball.touched == state.touches.shape[1]:
        return False
    touch = state.touches[w, ball.touched]
    touch.nx, touch.ny, touch.ux, touch.uy = nx, ny, 0.0, 0.0
    touch.gap, touch.curvature, touch.element, touch.face = gap, curvature, element, face
    touch.part, touch.moves, touch.arc = -1, 0, -1
    ball.touched += 1
    return True


@where("faces")
def _touch_faces(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    first, last = faces_near(state, scene, ball.x, ball.y)
    for at in range(first, last):
        i = face_near(state, scene, at)
        face = state.faces[scene, i]
        dx, dy = ball.x - face.x, ball.y - face.y
        height = dy * face.ux - dx * face.uy
        if abs(height) > face.offset_radius + ball.tolerance:
            continue
        if not is_beside_line(face_line(face), dx, dy, ball.tolerance) or is_off(state, w, face.element):
            continue
        facing = float(side_on(state.face_sides, w, k, i))
        if facing == 0.0:
            facing = 1.0 if height >= 0.0 else -1.0
        # A ball may be half-way through a one-way wall.
        if is_one_way(state, scene, i) and (facing < 0.0 or height < face.offset_radius - ball.tolerance):
            continue
        gap = facing * height - face.offset_radius
        if _add_touch(state, w, k, -facing * face.uy, facing * face.ux, gap, 0.0, face.element, i):
            along = dx * face.ux + dy * face.uy
            touch = state.touches[w, ball.touched - 1]
            touch.along = along if facing > 0.0 else face.length - along
            touch.length = face.length


@where("circles")
def _touch_circles(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    first, last = circles_near(state, scene, ball.x, ball.y)
    for at in range(first, last):
        circle = state.circles[scene, circle_near(state, scene, at)]
        dx, dy = ball.x - circle.x, ball.y - circle.y
        offset_radius = circle.offset_radius + ball.tolerance
        square = dx * dx + dy * dy
        if square > offset_radius * offset_radius or is_off(state, w, circle.element):
            continue
        distance = math.sqrt(square)
        gap = distance - circle.offset_radius
        if _add_touch(state, w, k, dx / distance, dy / distance, gap, 1.0 / circle.offset_radius, circle.element, -1):
            touch = state.touches[w, ball.touched - 1]
            touch.cx, touch.cy, touch.radius = circle.x, circle.y, circle.offset_radius
            touch.along, touch.length = touch.radius, 2.0 * touch.radius  # it has no ends


@where("arcs")
def _touch_arcs(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for i in range(state.scenes[scene].arcs):
        arc = state.arcs[scene, i]
        dx, dy = ball.x - arc.x, ball.y - arc.y
        distance = math.sqrt(dx * dx + dy * dy)
        outside = abs(distance - arc.outer) <= ball.tolerance
        inside = abs(distance - arc.inner) <= ball.tolerance and arc.inner > 0.0
        side = side_on(state.arc_sides, w, k, i)
        if side != 0:
            outside, inside = outside and side > 0, inside and side < 0
        if not (outside or inside) or not is_in_arc_span(arc, dx, dy, ball.tolerance) or is_off(state, w, arc.element):
            continue
        facing = 1.0 if outside else -1.0
        curvature = 1.0 / arc.outer if outside else -1.0 / arc.inner
        nx, ny = facing * (dx / distance), facing * (dy / distance)
        gap = distance - arc.outer if outside else arc.inner - distance
        if _add_touch(state, w, k, nx, ny, gap, curvature, arc.element, -1):
            _tell_arc(state.touches[w, ball.touched - 1], arc, i, outside, dx, dy)


@function
def _tell_arc(touch: Record, arc: Record, i: int, outside: bool, dx: float, dy: float) -> None:
    """Note the path along arc `i`, and how far off the ball, at (dx, dy) [m] from its centre, is from the ends."""
    radius = arc.outer if outside else arc.inner
    touch.cx, touch.cy, touch.radius, touch.arc = arc.x, arc.y, radius, i
    if arc.span == CLOSED:
        touch.along, touch.length = touch.radius, 2.0 * touch.radius  # it has no ends
        return
    sx, sy, ex, ey = dx - radius * arc.sx, dy - radius * arc.sy, dx - radius * arc.ex, dy - radius * arc.ey
    to_start, to_end = math.sqrt(sx * sx + sy * sy), math.sqrt(ex * ex + ey * ey)
    touch.along, touch.length = to_end if outside else to_start, to_start + to_end


@where("parts")
def _touch_parts(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for m in range(state.scenes[scene].parts):
        if not state.zones[w, k, m].inside:
            continue
        part = moving_part(state, w, m)
        core = part_core_at(part, ball.hi, ball.lo)
        nx, ny, distance, nearest = nearest_on_core(core, ball.x, ball.y, side_of_part(state, w, k, m), ball.tolerance)
        if abs(distance) > part.shape.offset_radius + ball.tolerance or is_off(state, w, part.shape.element):
            continue
        if not _touch_part(state, w, k, m, part, core, nx, ny, distance, nearest):
            return


@function
def _touch_part(
    state: State, w: int, k: int, m: int, part: MovingPart, core: Core, nx: float, ny: float, distance: float,
    nearest: float,
) -> bool:  # fmt: skip
    """List what a ball touches of part `m`: where the straight side passes into the round end both; False: no room."""
    ball, shape, side = state.balls[w, k], part.shape, side_of_part(state, w, k, m)
    spin, moves = part_spin(part, core)
    offset_radius = core.front + shape.offset_radius if moves or part.turn != 0 else shape.offset_radius
    vx, vy = part_surface_velocity(
        part, core, nearest * core.ux + shape.radius * nx, nearest * core.uy + shape.radius * ny
    )
    pull = math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
    rest_speed = state.scenes[state.worlds[w].scene].rest_speed
    least = max(rest_speed, SMALLEST_REBOUND * math.sqrt((pull + spin * spin * offset_radius) * offset_radius))
    for straight in (True, False):
        if straight and not _touches_straight(ball, core, side, nx, ny, distance):
            continue
        if not straight and not _touches_round(ball, core, side, nearest):
            continue
        curvature = 0.0 if straight else 1.0 / shape.offset_radius
        if not _add_touch(state, w, k, nx, ny, distance - shape.offset_radius, curvature, shape.element, -1):
            return False
        touch = state.touches[w, ball.touched - 1]
        touch.part, touch.ux, touch.uy, touch.least = m, vx, vy, least
        touch.moves = 1 if moves else 0
        if straight:
            facing = 1.0 if core.ux * ny > core.uy * nx else -1.0
            touch.nx, touch.ny = -facing * core.uy, facing * core.ux  # at an end it is that of the round end but nearly
            touch.length = core.front - core.back
            touch.along = nearest - core.back if facing > 0.0 else core.front - nearest
        else:
            touch.along, touch.length = shape.offset_radius, 2.0 * shape.offset_radius  # it has no ends
            touch.cx, touch.cy = core.x + nearest * core.ux, core.y + nearest * core.uy
            touch.radius = shape.offset_radius
    return True


@function
def _touches_straight(ball: Record, core: Core, side: int, nx: float, ny: float, distance: float) -> bool:
    """Return whether a ball that touches a part with the normal (nx, ny) is beside its core, up to the tolerance."""
    return side != 0 or (core.back < core.front and abs(nx * core.ux + ny * core.uy) * distance <= ball.tolerance)


@function
def _touches_round(ball: Record, core: Core, side: int, nearest: float) -> bool:
    """Return whether a ball that touches a part where `nearest` lies on the core is at a round end of it."""
    return side == 0 and not core.back + ball.tolerance < nearest < core.front - ball.tolerance
