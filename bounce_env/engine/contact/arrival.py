"""The end of a flight: the ball is put on the surface that it has hit."""

import math

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.detect.pairs import note_way
from bounce_env.engine.memory.lookup import side_of_part
from bounce_env.engine.memory.records import NEXT_PART, OFF_END, ON_ARC, ON_CIRCLE, ON_FACE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.parts import moving_part, nearest_on_core, part_core_at
from bounce_env.engine.motion.path import acceleration_in, motion_after, path_length_bound
from bounce_env.engine.tolerances import CORNER, SEARCH_ENDS, ULPS_OF_LENGTH


@function
def end_flight(state: State, w: int, k: int, t: float, hi: float, lo: float) -> None:
    """Move the ball along its flight by `t` seconds, to the instant (hi, lo), and set what counts as touching there."""
    ball, extent = state.balls[w, k], state.scenes[state.worlds[w].scene].extent
    way = path_length_bound(state, w, k, t)
    ball.tolerance = ULPS_OF_LENGTH * (extent + way)
    if way > CORNER * ULPS_OF_LENGTH * extent:
        ball.confined = 0
    note_way(state, w, k, way)
    motion = motion_after(state, w, k, t)
    ball.ax, ball.ay = acceleration_in(state, w, k, t, motion)
    ball.x, ball.y, ball.vx, ball.vy = motion
    ball.hi, ball.lo = hi, lo
    if t > 0.0:  # in no time nothing is rounded, and a push may wait to be resolved
        _keep_along_face(state, w, k)


@where("faces")
def _keep_along_face(state: State, w: int, k: int) -> None:
    """Take from the velocity of a ball that has slid on a wall what is not along it: rounding, of speeds it had."""
    ball = state.balls[w, k]
    if ball.contact >= 0:
        face = state.faces[state.worlds[w].scene, ball.contact]
        rate = ball.vx * face.ux + ball.vy * face.uy
        ball.vx, ball.vy = rate * face.ux, rate * face.uy


@function
def snap_to_hit(state: State, w: int, k: int) -> None:
    """Put the ball on the surface of what it hits, along the normal: the rounding of the flight ends here."""
    ball = state.balls[w, k]
    face, part = -1, -1
    if ball.next_kind == NEXT_PART:
        part = ball.part_index
    elif ball.hit_kind in (ON_FACE, OFF_END):
        face = ball.hit_index
    elif ball.hit_kind == ON_CIRCLE:
        _snap_to_circle(state, w, k)
    elif ball.hit_kind == ON_ARC:
        _snap_to_arc(state, w, k)
    elif ball.contact >= 0:
        face = ball.contact
    else:
        part = ball.rides
    if face >= 0:
        _snap_to_face(state, w, k, face)
    if part >= 0:
        _snap_to_part(state, w, k, part)


@where("faces")
def _snap_to_face(state: State, w: int, k: int, index: int) -> None:
    ball, face = state.balls[w, k], state.faces[state.worlds[w].scene, index]
    height = (ball.y - face.y) * face.ux - (ball.x - face.x) * face.uy
    error = height - math.copysign(face.offset_radius, height)
    ball.x += error * face.uy
    ball.y -= error * face.ux


@where("circles")
def _snap_to_circle(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    circle = state.circles[state.worlds[w].scene, ball.hit_index]
    dx, dy = ball.x - circle.x, ball.y - circle.y
    stretch = circle.offset_radius / math.sqrt(dx * dx + dy * dy)
    ball.x = circle.x + dx * stretch
    ball.y = circle.y + dy * stretch


@where("arcs")
def _snap_to_arc(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    arc = state.arcs[state.worlds[w].scene, ball.hit_index]
    dx, dy = ball.x - arc.x, ball.y - arc.y
    distance = math.sqrt(dx * dx + dy * dy)
    offset_radius = arc.outer if abs(distance - arc.outer) <= abs(distance - arc.inner) else arc.inner
    ball.x = arc.x + dx * (offset_radius / distance)
    ball.y = arc.y + dy * (offset_radius / distance)


@where("parts")
def _snap_to_part(state: State, w: int, k: int, m: int) -> None:
    ball, part = state.balls[w, k], moving_part(state, w, m)
    core, offset_radius = part_core_at(part, ball.hi, ball.lo), part.shape.offset_radius
    nx, ny, distance, _ = nearest_on_core(core, ball.x, ball.y, side_of_part(state, w, k, m), ball.tolerance)
    # A search may end before a hit: then there is nothing to put the ball on.
    if distance - offset_radius <= SEARCH_ENDS * (offset_radius + core.front - core.back):
        ball.x += (offset_radius - distance) * nx
        ball.y += (offset_radius - distance) * ny
