"""What happens at the instant of a hit: the ball is put on the surface, and all that it touches is bounced from.

Of several elements touched at once the one closed on fastest is bounced from first, ties by element order, until none
is closed on. So a corner is right from either side, and mirror images stay mirror images.
"""

import math

from bounce_env.engine.jit import Record, Table, function
from bounce_env.engine.law import bounce, capped
from bounce_env.engine.layout import BOUNCE, NEXT_PART, ON_FACE, State, Tables
from bounce_env.engine.search import rail_offset, side_on
from bounce_env.engine.tolerances import BOUNCES_AT_ONE_INSTANT, ULPS_OF_SPEED


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
def snap(ball: Record, tables: Tables, paddles: Table, w: int, scene: int) -> None:
    """Put the ball on the surface of what it hits, along the normal: the rounding of the flight ends here."""
    if ball.next_kind == NEXT_PART:
        _snap_to_paddle(ball, tables.rails, paddles, w, scene)
    elif ball.hit_kind == ON_FACE:
        _snap_to_face(ball, tables.faces, scene)
    else:
        _snap_to_circle(ball, tables.circles, scene)


@function
def _snap_to_face(ball: Record, faces: Table, scene: int) -> None:
    if faces is None:
        return
    face = faces[scene, ball.hit_index]
    height = (ball.y - face.y) * face.ux - (ball.x - face.x) * face.uy
    error = height - math.copysign(face.reach, height)
    ball.x += error * face.uy
    ball.y -= error * face.ux


@function
def _snap_to_circle(ball: Record, circles: Table, scene: int) -> None:
    if circles is None:
        return
    circle = circles[scene, ball.hit_index]
    dx, dy = ball.x - circle.x, ball.y - circle.y
    stretch = circle.reach / math.sqrt(dx * dx + dy * dy)
    ball.x = circle.x + dx * stretch
    ball.y = circle.y + dy * stretch


@function
def _snap_to_paddle(ball: Record, rails: Table, paddles: Table, w: int, scene: int) -> None:
    if rails is None:
        return
    rail, paddle = rails[scene, ball.part_index], paddles[w, ball.part_index]
    offset = rail_offset(paddle, ball.hi, ball.lo)
    cx, cy = rail.x + offset * rail.ux, rail.y + offset * rail.uy
    nx, ny, distance = on_capsule(ball.x - cx, ball.y - cy, rail.ux, rail.uy, rail.half_width)
    ball.x += (rail.reach - distance) * nx
    ball.y += (rail.reach - distance) * ny


@function
def arrive(ball: Record, faces: Table, count: int, sides: Table, w: int, k: int, scene: int, travelled: float) -> None:
    """Bring a point ball's sides of the walls up to date: away from a wall its position tells, on it the flight.

    A ball that has `travelled` [m] to a wall came from the side that it moves away from; one that has gone nowhere, or
    along the wall, keeps the side it had.
    """
    if faces is None or sides is None:
        return
    slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    for i in range(count):
        face = faces[scene, i]
        height = (ball.y - face.y) * face.ux - (ball.x - face.x) * face.uy
        rate = ball.vy * face.ux - ball.vx * face.uy
        if abs(height) > ball.slack:
            sides[w, k, i] = 1 if height > 0.0 else -1
        elif travelled > ball.slack and abs(rate) > slow:
            sides[w, k, i] = 1 if rate < 0.0 else -1


@function
def face_sensors(ball: Record, sensors: Table, count: int, sides: Table, w: int, k: int, scene: int) -> None:
    """Bring the ball's sides of the sensors up to date where its position tells; a crossing itself flips them."""
    if sensors is None:
        return
    for i in range(count):
        sensor = sensors[scene, i]
        height = (ball.y - sensor.y) * sensor.ux - (ball.x - sensor.x) * sensor.uy
        if abs(height) > ball.slack:
            sides[w, k, i] = 1 if height > 0.0 else -1


@function
def closest_face(
    ball: Record, faces: Table, count: int, sides: Table, w: int, k: int, scene: int, best: float
) -> tuple[float, int, float, float]:
    """Of the touched walls the one closed on faster than `best`: (closing speed, element, nx, ny)."""
    element, bx, by = -1, 0.0, 0.0
    if faces is None:
        return best, element, bx, by
    for i in range(count):
        face = faces[scene, i]
        dx, dy = ball.x - face.x, ball.y - face.y
        height = dy * face.ux - dx * face.uy
        if abs(height) > face.reach + ball.slack:
            continue
        along = dx * face.ux + dy * face.uy
        if along < -ball.slack or along > face.length + ball.slack:
            continue
        ball.touched += 1
        facing = float(side_on(sides, w, k, i))
        if facing == 0.0:
            facing = 1.0 if height >= 0.0 else -1.0
        nx, ny = -facing * face.uy, facing * face.ux
        closing = -(ball.vx * nx + ball.vy * ny)
        if closing > best:
            best, element, bx, by = closing, face.element, nx, ny
    return best, element, bx, by


@function
def closest_circle(
    ball: Record, circles: Table, count: int, scene: int, best: float, element: int, bx: float, by: float
) -> tuple[float, int, float, float]:
    """As `closest_face`, for bumpers and the ends of walls; at a tie the element that comes first."""
    if circles is None:
        return best, element, bx, by
    for i in range(count):
        circle = circles[scene, i]
        dx, dy = ball.x - circle.x, ball.y - circle.y
        reach = circle.reach + ball.slack
        square = dx * dx + dy * dy
        if square > reach * reach:
            continue
        ball.touched += 1
        distance = math.sqrt(square)
        nx, ny = dx / distance, dy / distance
        closing = -(ball.vx * nx + ball.vy * ny)
        if closing > best or (closing == best and circle.element < element):
            best, element, bx, by = closing, circle.element, nx, ny
    return best, element, bx, by


@function
def closest_paddle(
    ball: Record,
    rails: Table,
    paddles: Table,
    count: int,
    w: int,
    scene: int,
    best: float,
    element: int,
    bx: float,
    by: float,
) -> tuple[float, int, float, float, float, float]:
    """As `closest_circle`, for paddles, with the surface's velocity: (speed, element, nx, ny, ux, uy)."""
    ux, uy = 0.0, 0.0
    if rails is None:
        return best, element, bx, by, ux, uy
    for m in range(count):
        rail, paddle = rails[scene, m], paddles[w, m]
        offset = rail_offset(paddle, ball.hi, ball.lo)
        dx, dy = ball.x - (rail.x + offset * rail.ux), ball.y - (rail.y + offset * rail.uy)
        nx, ny, distance = on_capsule(dx, dy, rail.ux, rail.uy, rail.half_width)
        if distance > rail.reach + ball.slack:
            continue
        ball.touched += 1
        sx, sy = paddle.velocity * rail.ux, paddle.velocity * rail.uy
        closing = -((ball.vx - sx) * nx + (ball.vy - sy) * ny)
        if closing > best or (closing == best and rail.element < element):
            best, element, bx, by, ux, uy = closing, rail.element, nx, ny, sx, sy
    return best, element, bx, by, ux, uy


@function
def bounce_from_all(state: State, tables: Tables, w: int, k: int, ledger: Table) -> int:
    """Bounce from everything that the ball touches and closes on, fastest first; returns how many bounces that took."""
    ball, world = state.balls[w, k], state.worlds[w]
    scene = world.scene
    head = tables.scenes[scene]
    for done in range(BOUNCES_AT_ONE_INSTANT):
        slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
        ball.touched = 0
        best, element, nx, ny = closest_face(ball, tables.faces, head.faces, state.face_sides, w, k, scene, slow)
        best, element, nx, ny = closest_circle(ball, tables.circles, head.circles, scene, best, element, nx, ny)
        best, element, nx, ny, ux, uy = closest_paddle(
            ball, tables.rails, state.paddles, head.paddles, w, scene, best, element, nx, ny
        )
        if element < 0:
            return done
        material = tables.elements[scene, element]
        vx0, vy0 = ball.vx, ball.vy
        vx, vy = bounce(vx0, vy0, nx, ny, ux, uy, material.b, material.f, material.kick, material.kick_threshold)
        ball.vx, ball.vy, over = capped(vx, vy, nx, ny, ux, uy, head.max_speed)
        world.speed_capped += over
        world.bounces += 1
        count_hit(state, w, element)
        log(ledger, world, ball, k, element, BOUNCE, nx, ny, vx0, vy0, ux, uy)
        if ball.touched == 1:
            return done + 1
    return BOUNCES_AT_ONE_INSTANT


@function
def count_hit(state: State, w: int, element: int) -> None:
    """Count a bounce from, or a crossing of, an element in this step."""
    state.hits[w, element] += 1
    state.worlds[w].dirty = 1


@function
def log(
    ledger: Table,
    world: Record,
    ball: Record,
    k: int,
    element: int,
    kind: int,
    nx: float,
    ny: float,
    vx0: float,
    vy0: float,
    ux: float,
    uy: float,
) -> None:
    """Append a row to the ledger, where there is one."""
    if ledger is None:
        return
    row = ledger[world.rows]
    row.time = ball.hi
    row.ball, row.element, row.kind = k, element, kind
    row.x, row.y, row.nx, row.ny = ball.x, ball.y, nx, ny
    row.vx0, row.vy0, row.vx1, row.vy1 = vx0, vy0, ball.vx, ball.vy
    row.ux, row.uy = ux, uy
    world.rows += 1
