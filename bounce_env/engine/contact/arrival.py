"""The end of a flight: the ball is put on the surface that it has hit."""

import math

from bounce_env.engine.compile.jit import Feature, Record, Table, function
from bounce_env.engine.contact.touching import on_capsule
from bounce_env.engine.memory.lookup import ends_of, side_of_part, turn_of
from bounce_env.engine.memory.records import NEXT_PART, OFF_END, ON_ARC, ON_CIRCLE, ON_FACE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import fly, magnitude, touch_tolerance
from bounce_env.engine.motion.parts import core_at
from bounce_env.engine.tolerances import CORNER, ROOM_TO_MEET, SEARCH_ENDS, ULPS_OF_LENGTH


@function
def snap(state: State, w: int, k: int) -> None:
    """Put the ball on the surface of what it hits, along the normal: the rounding of the flight ends here."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    face, part = -1, -1
    if ball.next_kind == NEXT_PART:
        part = ball.part_index
    elif ball.hit_kind in (ON_FACE, OFF_END):
        face = ball.hit_index
    elif ball.hit_kind == ON_CIRCLE:
        _snap_to_circle(ball, state.circles, scene)
    elif ball.hit_kind == ON_ARC:
        _snap_to_arc(ball, state.arcs, scene)
    elif ball.contact >= 0:
        face = ball.contact
    else:
        part = ball.rides
    if face >= 0:
        _snap_to_face(ball, state.faces, face, scene)
    if part >= 0:
        _snap_to_part(state, state.motions, state.parts, w, k, part)


@function
def end_flight(
    ball: Record, state: State, scene: int, gx: Feature, gy: Feature, t: float, hi: float, lo: float
) -> None:
    """Move the ball along its flight by `t` seconds, to the instant (hi, lo), and set what counts as touching there."""
    extent = state.scenes[scene].extent
    ball.slack = touch_tolerance(extent, ball.vx, ball.vy, gx, gy, t)
    way = (abs(ball.vx) + abs(ball.vy) + magnitude(gx, gy) * t) * t
    if way > CORNER * ULPS_OF_LENGTH * extent:
        ball.confined = 0
    ball.strayed += way
    if ball.strayed > ROOM_TO_MEET * extent:
        ball.strayed, ball.legs = 0.0, ball.legs + 1
    fly(ball, gx, gy, t, hi, lo)
    if t > 0.0:  # in no time nothing is rounded, and a push may wait to be resolved
        _keep_along(ball, state.faces, scene)


@function
def _keep_along(ball: Record, faces: Table, scene: int) -> None:
    """Take from the velocity of a ball that has slid on a wall what is not along it: rounding, of speeds it had."""
    if faces is None or ball.contact < 0:
        return
    face = faces[scene, ball.contact]
    rate = ball.vx * face.ux + ball.vy * face.uy
    ball.vx, ball.vy = rate * face.ux, rate * face.uy


@function
def _snap_to_face(ball: Record, faces: Table, index: int, scene: int) -> None:
    if faces is None:
        return
    face = faces[scene, index]
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
def _snap_to_arc(ball: Record, arcs: Table, scene: int) -> None:
    if arcs is None:
        return
    arc = arcs[scene, ball.hit_index]
    dx, dy = ball.x - arc.x, ball.y - arc.y
    distance = math.sqrt(dx * dx + dy * dy)
    reach = arc.outer if abs(distance - arc.outer) <= abs(distance - arc.inner) else arc.inner
    ball.x = arc.x + dx * (reach / distance)
    ball.y = arc.y + dy * (reach / distance)


@function
def _snap_to_part(state: State, motions: Table, parts: Table, w: int, k: int, m: int) -> None:
    if parts is None or motions is None:
        return
    ball, scene = state.balls[w, k], state.worlds[w].scene
    part, ends = parts[scene, m], ends_of(state.ends, w, m)
    x, y, ux, uy, back, front = core_at(part, motions[w, m], turn_of(state.turns, scene, m), ends, ball.hi, ball.lo)
    side = side_of_part(state.part_sides, w, k, m)
    nx, ny, distance, _ = on_capsule(ball.x - x, ball.y - y, ux, uy, back, front, side, ball.slack)
    # A search may end before a hit: then there is nothing to put the ball on.
    if distance - part.reach <= SEARCH_ENDS * (part.reach + front - back):
        ball.x += (part.reach - distance) * nx
        ball.y += (part.reach - distance) * ny
