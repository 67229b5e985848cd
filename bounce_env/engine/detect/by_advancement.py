"""What stands in the way of a ball that slides on a curve which translates, or that two surfaces carry.

In the frame of what moves everything else does so, and geometry alone does not tell what comes first: the search goes
on by bounded-acceleration advancement (docs/physics.md, "Slides on curves").
"""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import Record, function, routine, where
from bounce_env.engine.detect.along_curve import curve_search, first_of_itself, found_after
from bounce_env.engine.detect.surfaces import face_line
from bounce_env.engine.impact.advancement import advancement_step, advancement_to_closing
from bounce_env.engine.impact.arc import is_in_arc_span
from bounce_env.engine.impact.line import Line, is_beside_line
from bounce_env.engine.memory.lookup import is_off, is_one_way, side_on
from bounce_env.engine.memory.records import OFF_CURVE, ON_ARC, ON_CIRCLE, ON_FACE, RESOLVE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import later, since
from bounce_env.engine.motion.parts import moving_part, part_core_at, part_stop_instant
from bounce_env.engine.motion.path import acceleration_bound, is_carried, motion_after, top_speed_bound
from bounce_env.engine.tolerances import SEARCH_STEPS, ULPS_OF_LENGTH, ULPS_OF_SPEED


class Moving(NamedTuple):
    """A ball at an instant of its path: place and velocity [m, m/s], and what bounds its way from there."""

    x: float
    y: float
    vx: float
    vy: float
    tolerance: float  # [m] what counts as touching
    top_speed: float  # [m/s]
    pull: float  # [m/s^2] its acceleration does not exceed


class Ahead(NamedTuple):
    """How long [s] nothing is met for, and what is met then: kind and row, kind -1 for nothing."""

    seconds: float
    kind: int
    row: int


@routine
def moving_after(state: State, w: int, k: int, t: float) -> Moving:
    """Return a ball `t` seconds after its last event, where its path is no flight."""
    extent, top_speed = state.scenes[state.worlds[w].scene].extent, top_speed_bound(state, w, k)
    x, y, vx, vy = motion_after(state, w, k, t)
    return Moving(x, y, vx, vy, ULPS_OF_LENGTH * (extent + top_speed * t), top_speed, acceleration_bound(state, w, k))


@function
def least_step(ball: Moving) -> float:
    """Return how long [s] it takes to change a gap that neither opens nor closes by what counts as touching."""
    return math.sqrt(2.0 * ball.tolerance / ball.pull) if ball.pull > 0.0 else math.inf


def _nothing_ahead(state: State, w: int, k: int, ball: Moving, ahead: Ahead) -> Ahead:
    return ahead


@routine
def first_by_advancement(state: State, w: int, k: int) -> tuple[float, float, int, int]:
    """Return what ends a ball's path first while its part moves on: (duration [s], end of the search [s], kind, row).

    The duration is inf where nothing does before the part stops. Where nothing comes closer for very long, the search
    ends before a hit.
    """
    ball = state.balls[w, k]
    part = moving_part(state, w, ball.rides)
    stop_hi, stop_lo = part_stop_instant(part.motion, part.shape)
    own = _own_end(state, w, k)
    end, t = min(own.seconds, since(stop_hi, stop_lo, ball.hi, ball.lo)), 0.0
    for _ in range(16 * SEARCH_STEPS):
        now, ahead = moving_after(state, w, k, t), Ahead(math.inf, -1, -1)
        ahead = _face_ahead(state, w, k, now, ahead)
        ahead = _circle_ahead(state, w, k, now, ahead)
        ahead = _arc_ahead(state, w, k, now, ahead)
        ahead = _end_of_straight_ahead(state, w, k, now, t, ahead)
        t += ahead.seconds
        if not t < end:
            return own.seconds if own.seconds <= end else math.inf, end, own.kind, own.row
        if ahead.kind >= 0:
            return t, t, ahead.kind, ahead.row
    return t, t, RESOLVE, -1


@function
def _own_end(state: State, w: int, k: int) -> Ahead:
    """Return where a path ends if nothing stands in its way."""
    if is_carried(state, w, k):
        return Ahead(state.carried[w, k].end, OFF_CURVE, -1)
    search = curve_search(state, w, k)
    found = first_of_itself(state, w, k, search)
    return Ahead(found_after(search, found), found.kind, found.row)


@function
def _end_of_straight_ahead(state: State, w: int, k: int, now: Moving, t: float, ahead: Ahead) -> Ahead:
    """Look for the ends of the straight surface along which a ball is carried."""
    if not is_carried(state, w, k):
        return ahead
    if state.carried[w, k].face >= 0:
        return _end_of_face_ahead(state, w, k, now, ahead)
    ball, carried = state.balls[w, k], state.carried[w, k]
    hi, lo = later(ball.hi, ball.lo, t)
    core = part_core_at(moving_part(state, w, ball.rides), hi, lo)
    along = (now.x - core.x) * core.ux + (now.y - core.y) * core.uy - core.back
    rate = (now.vx - carried.sx) * core.ux + (now.vy - carried.sy) * core.uy
    return _end_ahead(now, along, rate, core.front - core.back, ahead)


@where("faces", otherwise=_nothing_ahead)
def _end_of_face_ahead(state: State, w: int, k: int, ball: Moving, ahead: Ahead) -> Ahead:
    face = state.faces[state.worlds[w].scene, state.carried[w, k].face]
    along, rate = (ball.x - face.x) * face.ux + (ball.y - face.y) * face.uy, ball.vx * face.ux + ball.vy * face.uy
    return _end_ahead(ball, along, rate, face.length, ahead)


@function
def _end_ahead(ball: Moving, along: float, rate: float, length: float, ahead: Ahead) -> Ahead:
    slow = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    seconds, closed = gap_ahead(ball, along, rate, slow, True)
    ahead = _sooner(ahead, seconds, closed, OFF_CURVE, -1)
    seconds, closed = gap_ahead(ball, length - along, -rate, slow, True)
    return _sooner(ahead, seconds, closed, OFF_CURVE, -1)


@function
def gap_ahead(ball: Moving, gap: float, rate: float, slow: float, meets: bool) -> tuple[float, bool]:
    """Return for how long [s] a gap surely stays open, and whether it is closed then.

    rate: how fast it opens [m/s], zero up to `slow`; meets: whether the ball is where it would be met.
    """
    if gap <= ball.tolerance:
        if meets and rate < -slow:
            return advancement_to_closing(gap, rate, ball.pull), True
        # No step is shorter than that in which a gap changes by what counts as touching.
        return max(_step(max(gap, 0.0), max(rate, 0.0), ball.pull), least_step(ball)), False
    return _step(gap, rate, ball.pull), False


@function
def _step(gap: float, rate: float, pull: float) -> float:
    if pull > 0.0:
        return advancement_step(gap, rate, pull)
    return gap / -rate if rate < 0.0 else math.inf


@function
def line_ahead(ball: Moving, line: Line, x: float, y: float, side: int) -> tuple[float, bool, float]:
    """Return the same as `gap_ahead` for a line that begins at (x, y), and the ball's side of it, 1.0 or -1.0.

    side: the one on which it is where it touches the line's middle; 0 where the height tells.
    """
    dx, dy = ball.x - x, ball.y - y
    height = dy * line.ux - dx * line.uy
    facing = 1.0 if height >= 0.0 else -1.0
    if abs(height) <= ball.tolerance and side != 0:
        facing = float(side)
    beside = line.length == math.inf or is_beside_line(line, dx, dy, ball.tolerance)
    gap, rate = facing * height - line.offset_radius, facing * (ball.vy * line.ux - ball.vx * line.uy)
    seconds, closed = gap_ahead(ball, gap, rate, ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy)), beside)
    if not beside:
        along, speed = dx * line.ux + dy * line.uy, ball.vx * line.ux + ball.vy * line.uy
        seconds = max(seconds, _way_beside(ball, along, speed, line.length))
    return seconds, closed, facing


@function
def _way_beside(ball: Moving, along: float, rate: float, length: float) -> float:
    """Return for how long [s] a ball surely does not come beside a line of this length [m]; it is not beside it now."""
    return _step(-along, -rate, ball.pull) if along < 0.0 else _step(along - length, rate, ball.pull)


@function
def _carries_face(state: State, w: int, k: int, i: int) -> bool:
    return is_carried(state, w, k) and state.carried[w, k].face == i


@function
def _carries_arc(state: State, w: int, k: int, i: int) -> bool:
    return is_carried(state, w, k) and state.carried[w, k].arc == i


@function
def _carries_circle(state: State, w: int, k: int, circle: Record) -> bool:
    """Return whether a circle that stands carries the ball, or one that has the same centre."""
    if not is_carried(state, w, k):
        return False
    carried = state.carried[w, k]
    return carried.x == circle.x and carried.y == circle.y and carried.ux == 0.0 and carried.uy == 0.0


@function
def _sooner(ahead: Ahead, seconds: float, closed: bool, kind: int, row: int) -> Ahead:
    return Ahead(seconds, kind if closed else -1, row) if seconds < ahead.seconds else ahead


@where("faces", otherwise=_nothing_ahead)
def _face_ahead(state: State, w: int, k: int, ball: Moving, ahead: Ahead) -> Ahead:
    scene = state.worlds[w].scene
    for i in range(state.scenes[scene].faces):
        face = state.faces[scene, i]
        if _carries_face(state, w, k, i) or is_off(state, w, face.element):
            continue
        side = side_on(state.face_sides, w, k, i)
        seconds, closed, facing = line_ahead(ball, face_line(face), face.x, face.y, side)
        if facing < 0.0 and is_one_way(state, scene, i):
            continue
        ahead = _sooner(ahead, seconds, closed, ON_FACE, i)
    return ahead


@where("circles", otherwise=_nothing_ahead)
def _circle_ahead(state: State, w: int, k: int, ball: Moving, ahead: Ahead) -> Ahead:
    scene = state.worlds[w].scene
    for i in range(state.scenes[scene].circles):
        circle = state.circles[scene, i]
        if not (is_off(state, w, circle.element) or _carries_circle(state, w, k, circle)):
            seconds, closed = outside_ahead(ball, ball.x - circle.x, ball.y - circle.y, circle.offset_radius, True)
            ahead = _sooner(ahead, seconds, closed, ON_CIRCLE, i)
    return ahead


@function
def outside_ahead(ball: Moving, dx: float, dy: float, radius: float, meets: bool) -> tuple[float, bool]:
    """Return the same as `gap_ahead` for a circle that is (dx, dy) [m] off, from outside."""
    distance = math.sqrt(dx * dx + dy * dy)
    rate = (ball.vx * dx + ball.vy * dy) / distance
    slow = (ULPS_OF_SPEED + ball.tolerance / radius) * (abs(ball.vx) + abs(ball.vy))
    return gap_ahead(ball, distance - radius, rate, slow, meets)


@function
def _inside_ahead(ball: Moving, dx: float, dy: float, radius: float, meets: bool) -> tuple[float, bool]:
    """Return the same from inside: the gap bends by v^2 / distance besides, which is bounded near the circle only."""
    distance = math.sqrt(dx * dx + dy * dy)
    if distance < 0.75 * radius:
        return 0.25 * radius / ball.top_speed, False
    rate = -(ball.vx * dx + ball.vy * dy) / distance
    slow = (ULPS_OF_SPEED + ball.tolerance / radius) * (abs(ball.vx) + abs(ball.vy))
    pull = ball.pull + 2.0 * ball.top_speed * ball.top_speed / radius
    bent = Moving(ball.x, ball.y, ball.vx, ball.vy, ball.tolerance, ball.top_speed, pull)
    seconds, closed = gap_ahead(bent, radius - distance, rate, slow, meets)
    # It keeps as far from the centre as that asks for.
    return min(seconds, 0.25 * radius / ball.top_speed), closed


@where("arcs", otherwise=_nothing_ahead)
def _arc_ahead(state: State, w: int, k: int, ball: Moving, ahead: Ahead) -> Ahead:
    scene = state.worlds[w].scene
    for i in range(state.scenes[scene].arcs):
        arc, side = state.arcs[scene, i], side_on(state.arc_sides, w, k, i)
        if is_off(state, w, arc.element) or _carries_arc(state, w, k, i):
            continue
        dx, dy = ball.x - arc.x, ball.y - arc.y
        distance, spans = math.sqrt(dx * dx + dy * dy), is_in_arc_span(arc, dx, dy, ball.tolerance)
        for radius, outside in ((arc.outer, True), (arc.inner, False)):
            if radius == 0.0:
                continue
            off = abs(distance - radius) > ball.tolerance
            if off and (distance > radius) != outside:
                # On its other side; of a disc nothing can be between the two.
                continue
            meets = spans and (off or side == 0 or (side > 0) == outside)
            if outside:
                seconds, closed = outside_ahead(ball, dx, dy, radius, meets)
            else:
                seconds, closed = _inside_ahead(ball, dx, dy, radius, meets)
            if not spans:
                seconds = max(seconds, _way_to_arc_end(ball, arc, dx, dy, radius))
            ahead = _sooner(ahead, seconds, closed, ON_ARC, i)
    return ahead


@function
def _way_to_arc_end(ball: Moving, arc: Record, dx: float, dy: float, radius: float) -> float:
    """Return for how long [s] a ball beyond the ends of an arc surely does not come to it."""
    sx, sy, ex, ey = dx - radius * arc.sx, dy - radius * arc.sy, dx - radius * arc.ex, dy - radius * arc.ey
    distance = math.sqrt(min(sx * sx + sy * sy, ex * ex + ey * ey))
    return max(distance, ball.tolerance) / ball.top_speed
