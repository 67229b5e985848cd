"""What a ball that slides on a curve meets among what stands, and where its slide ends by itself."""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import Record, function, routine, where
from bounce_env.engine.detect.surfaces import face_line
from bounce_env.engine.impact.arc import is_in_arc_span
from bounce_env.engine.impact.curve_path import (
    Crossings,
    CurveStart,
    Waypoint,
    circle_crossings,
    crossing_point,
    curve_start,
    is_next_to_start,
    line_crossings,
    waypoint,
    waypoint_time,
)
from bounce_env.engine.impact.line import is_beside_line
from bounce_env.engine.memory.lookup import is_off, is_one_way, side_on
from bounce_env.engine.memory.records import CLOSED, OFF_CURVE, ON_ARC, ON_CIRCLE, ON_FACE, ON_JOINT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.curve_slide import CurveSlide, curve_slide_of, direction_from_lowest, half_angle
from bounce_env.engine.motion.parts import moving_part, part_core_at
from bounce_env.engine.tolerances import ULPS_OF_SPEED


class Search(NamedTuple):
    """A slide, where it begins, the ball there: place and velocity relative to the centre [m, m/s], tolerance [m]."""

    slide: CurveSlide
    start: CurveStart
    x: float
    y: float
    vx: float
    vy: float
    tolerance: float


class Found(NamedTuple):
    """The first of what is found along the way: its place in the order, S, C, direction, kind and row."""

    order: float
    s: float
    c: float
    forth: bool
    kind: int
    row: int


@routine
def curve_search(state: State, w: int, k: int) -> Search:
    """Return what a search along the slide that a ball begins starts from."""
    ball, slide = state.balls[w, k], curve_slide_of(state.curve_slides[w, k])
    x, y = ball.x - slide.x, ball.y - slide.y
    start = curve_start(slide, x / slide.radius, y / slide.radius)
    return Search(slide, start, x, y, ball.vx - slide.ux, ball.vy - slide.uy, ball.tolerance)


@routine
def first_along_curve(state: State, w: int, k: int) -> tuple[float, int, int]:
    """Return what ends a ball's slide on a curve first: (duration [s], kind, row); inf where nothing does."""
    search = curve_search(state, w, k)
    first = first_of_itself(state, w, k, search)
    first = _first_face_along(state, w, k, search, first)
    first = _first_circle_along(state, w, k, search, first)
    first = _first_arc_along(state, w, k, search, first)
    return found_after(search, first), first.kind, first.row


@routine
def found_after(search: Search, found: Found) -> float:
    """Return after how long [s] a slide comes to what was found."""
    return waypoint_time(search.slide, Waypoint(found.order, found.s, found.c, found.forth))


@routine
def first_of_itself(state: State, w: int, k: int, search: Search) -> Found:
    """Return where a slide ends if nothing stands in its way: the curve lets go, or a part's straight side begins."""
    first = _let_go(state, w, k, search, Found(math.inf, 0.0, 1.0, True, OFF_CURVE, -1))
    return _joints_of_part(state, w, k, search, first)


@routine
def _earlier(
    search: Search, first: Found, nx: float, ny: float, forth: bool, passed: bool, kind: int, row: int
) -> Found:
    """Return the earlier of what was found and the point in the direction (nx, ny)."""
    point = waypoint(search.slide, search.start, nx, ny, forth, passed)
    return Found(point.order, point.s, point.c, forth, kind, row) if point.order < first.order else first


@function
def _let_go(state: State, w: int, k: int, search: Search, first: Found) -> Found:
    """Return the point at which the curve stops pressing: at a third of the energy's height, h = E / (3 G).

    E is v^2 + 2 G h; inside on the way up, outside on the way down (docs/physics.md, "Slides on curves").
    """
    ball, slide, inside = state.balls[w, k], search.slide, state.curve_slides[w, k].facing < 0.0
    pull = math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
    # h / radius, from the speed in the lowest point: E = v_lowest^2 - 2 G radius.
    height = (slide.lowest_speed * slide.lowest_speed - 2.0 * pull * slide.radius) / (3.0 * pull * slide.radius)
    # Written so that without a pull nothing is found; inside a ball that stays below the centre is never let go.
    if not (height < 1.0 and (height > 0.0 or (height > -1.0 and not inside))):
        return first
    s, c = half_angle(math.sqrt((1.0 - height) * (1.0 + height)), -height)
    for forth in (True, False):
        right = forth == inside  # on which side of the lowest point it goes that way
        nx, ny = direction_from_lowest(slide, s if right else -s, c)
        first = _earlier(search, first, nx, ny, forth, False, OFF_CURVE, -1)
    return first


@routine
def _enters(
    search: Search, first: Found, crossings: Crossings, forth: bool, touching: bool, closes: bool, kind: int, row: int
) -> Found:
    """Return the earlier of what was found and one crossing, if the ball does not come from there.

    touching: whether the ball touches it where it begins; closes: and closes on it.
    """
    nx, ny = crossing_point(crossings, forth)
    if not (touching and forth == search.start.forth and is_next_to_start(search.start, crossings, forth)):
        return _earlier(search, first, nx, ny, forth, False, kind, row)
    if closes:
        return _earlier(search, first, search.start.nx, search.start.ny, forth, False, kind, row)
    return _earlier(search, first, nx, ny, forth, True, kind, row)


@function
def _closes(search: Search, rate: float, curvature: float) -> bool:
    """Return whether a gap that opens at `rate` [m/s] closes by more than rounding."""
    return rate < -(ULPS_OF_SPEED + search.tolerance * curvature) * (abs(search.vx) + abs(search.vy))


def _nothing_along(state: State, w: int, k: int, search: Search, first: Found) -> Found:
    return first


@where("parts", otherwise=_nothing_along)
def _joints_of_part(state: State, w: int, k: int, search: Search, first: Found) -> Found:
    """Look for where the round end of a part that carries the ball goes on into its straight sides."""
    ball = state.balls[w, k]
    if ball.rides < 0:
        return first
    core = part_core_at(moving_part(state, w, ball.rides), ball.hi, ball.lo)
    if core.back < core.front:
        for height in (search.slide.radius, -search.slide.radius):
            first = _joint_along(search, first, -height * core.uy, height * core.ux)
    return first


@where("faces", otherwise=_nothing_along)
def _first_face_along(state: State, w: int, k: int, search: Search, first: Found) -> Found:
    scene = state.worlds[w].scene
    for i in range(state.scenes[scene].faces):
        face = state.faces[scene, i]
        x, y = face.x - search.slide.x, face.y - search.slide.y
        across = y * face.ux - x * face.uy  # height of the line over the centre
        if abs(across) > search.slide.radius + face.offset_radius + search.tolerance or is_off(state, w, face.element):
            continue
        first = _joint_of_face(search, first, face, x, y)
        side = side_on(state.face_sides, w, k, i)
        for facing in (1.0, -1.0):
            if facing > 0.0 or not is_one_way(state, scene, i):
                first = _face_along(search, first, face, facing, side, x, y, facing * across + face.offset_radius, i)
    return first


@function
def _face_along(
    search: Search, first: Found, face: Record, facing: float, side: int, x: float, y: float, height: float, i: int
) -> Found:
    """Look for one side of a wall that begins at (x, y) from the centre and is met at a height over that."""
    nx, ny, slide = -facing * face.uy, facing * face.ux, search.slide
    crossings = line_crossings(slide.radius, nx, ny, height, search.tolerance)
    if not crossings.any:
        return first
    touching = abs(search.x * nx + search.y * ny - height) <= search.tolerance
    closes = side * facing >= 0.0 and _closes(search, search.vx * nx + search.vy * ny, 0.0)
    for forth in (True, False):
        ex, ey = crossing_point(crossings, forth)
        if is_beside_line(face_line(face), slide.radius * ex - x, slide.radius * ey - y, search.tolerance):
            first = _enters(search, first, crossings, forth, touching, closes, ON_FACE, i)
    return first


@function
def _joint_of_face(search: Search, first: Found, face: Record, x: float, y: float) -> Found:
    """Look for the ends of a wall that lie on the path: what begins there may go on from it."""
    for end in (0.0, face.length):
        for facing in (1.0, -1.0):
            qx = x + end * face.ux - facing * face.offset_radius * face.uy
            qy = y + end * face.uy + facing * face.offset_radius * face.ux
            first = _joint_along(search, first, qx, qy)
    return first


@routine
def _joint_along(search: Search, first: Found, x: float, y: float) -> Found:
    """Look at a point, seen from the centre, if it lies on the path and is not where the slide begins."""
    distance = math.sqrt(x * x + y * y)
    if not abs(distance - search.slide.radius) <= 2.0 * search.tolerance or distance == 0.0:
        return first
    nx, ny = x / distance, y / distance
    dx, dy = x - search.x, y - search.y
    passed = dx * dx + dy * dy <= 64.0 * search.tolerance * search.tolerance
    for forth in (True, False):
        first = _earlier(search, first, nx, ny, forth, passed and forth == search.start.forth, ON_JOINT, -1)
    return first


@where("circles", otherwise=_nothing_along)
def _first_circle_along(state: State, w: int, k: int, search: Search, first: Found) -> Found:
    scene = state.worlds[w].scene
    for i in range(state.scenes[scene].circles):
        circle = state.circles[scene, i]
        if not is_off(state, w, circle.element):
            x, y = circle.x - search.slide.x, circle.y - search.slide.y
            first = _circle_along(search, first, x, y, circle.offset_radius, -1.0, True, None, ON_CIRCLE, i)
    return first


@function
def _circle_along(
    search: Search, first: Found, x: float, y: float, border: float, sense: float, armed: bool, arc: Record,
    kind: int, row: int,
) -> Found:  # fmt: skip
    """Look for one side of a circle about (x, y) from the centre, or of an arc of it."""
    radius = search.slide.radius
    crossings = circle_crossings(radius, x, y, border, sense, search.tolerance)
    if not crossings.any:
        return first
    dx, dy = search.x - x, search.y - y
    distance = math.sqrt(dx * dx + dy * dy)
    touching = abs(distance - border) <= search.tolerance
    rate = -sense * (search.vx * dx + search.vy * dy) / distance
    closes = armed and _closes(search, rate, 1.0 / border)
    for forth in (True, False):
        ex, ey = crossing_point(crossings, forth)
        if is_in_arc_span(arc, radius * ex - x, radius * ey - y, search.tolerance):
            first = _enters(search, first, crossings, forth, touching, closes, kind, row)
    return first


@where("arcs", otherwise=_nothing_along)
def _first_arc_along(state: State, w: int, k: int, search: Search, first: Found) -> Found:
    scene, own = state.worlds[w].scene, state.curve_slides[w, k].arc
    for i in range(state.scenes[scene].arcs):
        arc = state.arcs[scene, i]
        if i == own:
            first = _own_ends(search, first, arc)
            continue
        if is_off(state, w, arc.element):
            continue
        x, y, side = arc.x - search.slide.x, arc.y - search.slide.y, side_on(state.arc_sides, w, k, i)
        first = _joints_of_arc(search, first, arc, x, y, arc.outer)
        first = _circle_along(search, first, x, y, arc.outer, -1.0, side >= 0, arc, ON_ARC, i)
        if arc.inner > 0.0:
            first = _joints_of_arc(search, first, arc, x, y, arc.inner)
            first = _circle_along(search, first, x, y, arc.inner, 1.0, side <= 0, arc, ON_ARC, i)
    return first


@function
def _own_ends(search: Search, first: Found, arc: Record) -> Found:
    if arc.span == CLOSED:
        return first
    first = _earlier(search, first, arc.ex, arc.ey, True, False, ON_JOINT, -1)
    return _earlier(search, first, arc.sx, arc.sy, False, False, ON_JOINT, -1)


@function
def _joints_of_arc(search: Search, first: Found, arc: Record, x: float, y: float, radius: float) -> Found:
    if arc.span == CLOSED:
        return first
    first = _joint_along(search, first, x + radius * arc.sx, y + radius * arc.sy)
    return _joint_along(search, first, x + radius * arc.ex, y + radius * arc.ey)
