"""What a ball touches at the instant that is resolved: one list, whatever the shapes.

The ball does not move while its bounces at one instant are resolved, so the list is made once for all of them.
"""

import math

from bounce_env.engine.compile.jit import Record, Table, function
from bounce_env.engine.contact.restitution import stands
from bounce_env.engine.impact.arc import in_span
from bounce_env.engine.impact.line import beside
from bounce_env.engine.memory.lookup import ends_of, is_gate, is_off, side_of_part, side_on, turn_of
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.parts import core_at, spin_of, surface_velocity
from bounce_env.engine.tolerances import ROLLING


@function
def on_capsule(
    x: float, y: float, ux: float, uy: float, back: float, front: float, side: int, slack: float
) -> tuple[float, float, float, float]:
    """From the nearest point of a capsule's core to (x, y): unit normal (nx, ny), distance [m], and where it is.

    The core runs from `back` to `front` [m] along the unit (ux, uy) through the origin; where is along that.
    side: on which side a ball of no radius is of a core without thickness, of which the ends count up to the slack, and
    to which the normal points; the distance is negative on the other one. Otherwise 0.
    """
    along, more = x * ux + y * uy, slack if side != 0 else 0.0
    if back - more <= along <= front + more:
        height = y * ux - x * uy
        facing = 1.0 if (height >= 0.0 if side == 0 else side > 0) else -1.0
        return -facing * uy, facing * ux, facing * height, along
    nearest = front if along > front else back
    dx, dy = x - nearest * ux, y - nearest * uy
    distance = math.sqrt(dx * dx + dy * dy)
    return dx / distance, dy / distance, distance, nearest


@function
def collect_touches(state: State, w: int, k: int) -> None:
    """List in `state.touches[w]` all surfaces that ball `k` touches within its slack, `ball.touched` of them."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    ball.touched = 0
    _touch_faces(
        ball, state.faces, state.gates, head.faces, state.face_sides, state.touches, state.disabled, w, k, scene
    )
    _touch_circles(ball, state.circles, head.circles, state.touches, state.disabled, w, scene)
    _touch_arcs(ball, state.arcs, head.arcs, state.arc_sides, state.touches, state.disabled, w, k, scene)
    _touch_parts(
        ball,
        state.parts,
        state.motions,
        state.turns,
        state.ends,
        state.part_sides,
        state.zones,
        head.parts,
        state.touches,
        state.disabled,
        w,
        k,
        scene,
        head.rest_speed,
    )


@function
def keep_outside(ball: Record, touches: Table, w: int) -> None:
    """Put a ball that touches a part on what stands and touches it, too: if the part moves, on other parts as well.

    It has been put on the part; one that keeps pushing it there would, rounding by rounding, push it through.
    """
    pushed, moved = False, False
    for i in range(ball.touched):
        pushed = pushed or touches[w, i].part >= 0
        moved = moved or not stands(touches[w, i])
    for i in range(ball.touched):
        touch = touches[w, i]
        if (pushed and touch.part < 0) or (moved and stands(touch)):
            ball.x, ball.y = ball.x - touch.gap * touch.nx, ball.y - touch.gap * touch.ny


@function
def _add(
    ball: Record, touches: Table, w: int, nx: float, ny: float, gap: float, bend: float, element: int, face: int
) -> None:
    if ball.touched == touches.shape[1]:
        return
    touch = touches[w, ball.touched]
    touch.nx, touch.ny, touch.ux, touch.uy = nx, ny, 0.0, 0.0
    touch.gap, touch.bend, touch.element, touch.face, touch.part, touch.moves = gap, bend, element, face, -1, 0
    ball.touched += 1


@function
def _touch_faces(
    ball: Record,
    faces: Table,
    gates: Table,
    count: int,
    sides: Table,
    touches: Table,
    disabled: Table,
    w: int,
    k: int,
    scene: int,
) -> None:
    if faces is None:
        return
    for i in range(count):
        face = faces[scene, i]
        dx, dy = ball.x - face.x, ball.y - face.y
        height = dy * face.ux - dx * face.uy
        if abs(height) > face.reach + ball.slack:
            continue
        if not beside(dx, dy, face.ux, face.uy, face.length, ball.slack) or is_off(disabled, w, face.element):
            continue
        facing = float(side_on(sides, w, k, i))
        if facing == 0.0:
            facing = 1.0 if height >= 0.0 else -1.0
        # A ball may be half-way through a one-way wall.
        if is_gate(gates, scene, i) and (facing < 0.0 or height < face.reach - ball.slack):
            continue
        listed = ball.touched
        gap = facing * height - face.reach
        _add(ball, touches, w, -facing * face.uy, facing * face.ux, gap, 0.0, face.element, i)
        if ball.touched > listed:
            along = dx * face.ux + dy * face.uy
            touches[w, listed].along = along if facing > 0.0 else face.length - along
            touches[w, listed].length = face.length


@function
def _touch_circles(
    ball: Record, circles: Table, count: int, touches: Table, disabled: Table, w: int, scene: int
) -> None:
    if circles is None:
        return
    for i in range(count):
        circle = circles[scene, i]
        dx, dy = ball.x - circle.x, ball.y - circle.y
        reach = circle.reach + ball.slack
        square = dx * dx + dy * dy
        if square > reach * reach or is_off(disabled, w, circle.element):
            continue
        distance = math.sqrt(square)
        gap = distance - circle.reach
        _add(ball, touches, w, dx / distance, dy / distance, gap, 1.0 / circle.reach, circle.element, -1)


@function
def _touch_arcs(
    ball: Record, arcs: Table, count: int, sides: Table, touches: Table, disabled: Table, w: int, k: int, scene: int
) -> None:
    if arcs is None:
        return
    for i in range(count):
        arc = arcs[scene, i]
        dx, dy = ball.x - arc.x, ball.y - arc.y
        distance = math.sqrt(dx * dx + dy * dy)
        outside = abs(distance - arc.outer) <= ball.slack
        inside = abs(distance - arc.inner) <= ball.slack and arc.inner > 0.0
        side = side_on(sides, w, k, i)
        if side != 0:
            outside, inside = outside and side > 0, inside and side < 0
        if not (outside or inside) or not in_span(arc, dx, dy, ball.slack) or is_off(disabled, w, arc.element):
            continue
        facing = 1.0 if outside else -1.0
        bend = 1.0 / arc.outer if outside else -1.0 / arc.inner
        nx, ny = facing * (dx / distance), facing * (dy / distance)
        gap = distance - arc.outer if outside else arc.inner - distance
        _add(ball, touches, w, nx, ny, gap, bend, arc.element, -1)


@function
def _touch_parts(
    ball: Record,
    parts: Table,
    motions: Table,
    turns: Table,
    all_ends: Table,
    sides: Table,
    zones: Table,
    count: int,
    touches: Table,
    disabled: Table,
    w: int,
    k: int,
    scene: int,
    rest_speed: float,
) -> None:
    if parts is None or motions is None or zones is None:
        return
    for m in range(count):
        if not zones[w, k, m].inside:
            continue
        part, motion, turn, ends = parts[scene, m], motions[w, m], turn_of(turns, scene, m), ends_of(all_ends, w, m)
        x, y, ux, uy, back, front = core_at(part, motion, turn, ends, ball.hi, ball.lo)
        dx, dy = ball.x - x, ball.y - y
        side = side_of_part(sides, w, k, m)
        nx, ny, distance, nearest = on_capsule(dx, dy, ux, uy, back, front, side, ball.slack)
        if abs(distance) > part.reach + ball.slack or is_off(disabled, w, part.element):
            continue
        spin, moves = spin_of(motion, part, turn, ends, ux, uy, front)
        reach = front + part.reach if moves or turn != 0 else part.reach
        rx, ry = nearest * ux + part.radius * nx, nearest * uy + part.radius * ny
        vx, vy = surface_velocity(motion, part, turn, ends, ux, uy, front, rx, ry)
        pull = math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
        least = max(rest_speed, ROLLING * math.sqrt((pull + spin * spin * reach) * reach))
        # Where the straight side passes into the round end both are touched.
        for straight in (True, False):
            if straight and side == 0 and not back < nearest < front:
                continue
            if not straight and (side != 0 or back + ball.slack < nearest < front - ball.slack):
                continue
            listed = ball.touched
            gap, bend = distance - part.reach, 0.0 if straight else 1.0 / part.reach
            _add(ball, touches, w, nx, ny, gap, bend, part.element, -1)
            if ball.touched == listed:
                return
            touch = touches[w, listed]
            touch.part, touch.ux, touch.uy, touch.least = m, vx, vy, least
            touch.moves = 1 if moves else 0
            touch.length = front - back
            touch.along = nearest - back if ux * ny > uy * nx else front - nearest
