"""What a ball touches at the instant that is resolved: one list, whatever the shapes.

The ball does not move while its bounces at one instant are resolved, so the list is made once for all of them.
"""

import math

from bounce_env.engine.arc import in_span
from bounce_env.engine.impact import beside
from bounce_env.engine.jit import Record, Table, function
from bounce_env.engine.layout import State, Tables
from bounce_env.engine.parts import is_off, rail_offset
from bounce_env.engine.search import is_gate, side_on


@function
def on_capsule(x: float, y: float, ux: float, uy: float, half_width: float) -> tuple[float, float, float]:
    """From the nearest point of a capsule's core about the origin to (x, y): unit normal (nx, ny) and distance [m]."""
    along = x * ux + y * uy
    if abs(along) <= half_width:
        height = y * ux - x * uy
        facing = 1.0 if height >= 0.0 else -1.0
        return -facing * uy, facing * ux, abs(height)
    nearest = math.copysign(half_width, along)
    dx, dy = x - nearest * ux, y - nearest * uy
    distance = math.sqrt(dx * dx + dy * dy)
    return dx / distance, dy / distance, distance


@function
def collect_touches(state: State, tables: Tables, w: int, k: int) -> None:
    """List in `state.touches[w]` all surfaces that ball `k` touches within its slack, `ball.touched` of them."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = tables.scenes[scene]
    ball.touched = 0
    _touch_faces(
        ball, tables.faces, tables.gates, head.faces, state.face_sides, state.touches, state.disabled, w, k, scene
    )
    _touch_circles(ball, tables.circles, head.circles, state.touches, state.disabled, w, scene)
    _touch_arcs(ball, tables.arcs, head.arcs, state.arc_sides, state.touches, state.disabled, w, k, scene)
    _touch_paddles(ball, tables.rails, state.paddles, head.paddles, state.touches, state.disabled, w, scene)


@function
def _add(ball: Record, touches: Table, w: int, nx: float, ny: float, bend: float, element: int, face: int) -> None:
    if ball.touched == touches.shape[1]:
        return
    touch = touches[w, ball.touched]
    touch.nx, touch.ny, touch.ux, touch.uy = nx, ny, 0.0, 0.0
    touch.bend, touch.element, touch.face, touch.moves = bend, element, face, 0
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
        _add(ball, touches, w, -facing * face.uy, facing * face.ux, 0.0, face.element, i)


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
        _add(ball, touches, w, dx / distance, dy / distance, 1.0 / circle.reach, circle.element, -1)


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
        _add(ball, touches, w, nx, ny, bend, arc.element, -1)


@function
def _touch_paddles(
    ball: Record, rails: Table, paddles: Table, count: int, touches: Table, disabled: Table, w: int, scene: int
) -> None:
    if rails is None:
        return
    for m in range(count):
        rail, paddle = rails[scene, m], paddles[w, m]
        offset = rail_offset(paddle, ball.hi, ball.lo)
        dx, dy = ball.x - (rail.x + offset * rail.ux), ball.y - (rail.y + offset * rail.uy)
        nx, ny, distance = on_capsule(dx, dy, rail.ux, rail.uy, rail.half_width)
        if distance > rail.reach + ball.slack or is_off(disabled, w, rail.element):
            continue
        listed = ball.touched
        _add(ball, touches, w, nx, ny, 1.0 / rail.reach, rail.element, -1)
        if ball.touched > listed:
            touch = touches[w, listed]
            touch.ux, touch.uy, touch.moves = paddle.velocity * rail.ux, paddle.velocity * rail.uy, 1
