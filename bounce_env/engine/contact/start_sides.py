"""On which side of lines, circles and parts a ball starts."""

import math

from bounce_env.engine.compile.jit import Record, Table, function
from bounce_env.engine.memory.lookup import is_dragged
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.dragged_wall import line_at
from bounce_env.engine.motion.fields import gravity_of
from bounce_env.engine.motion.instant import since
from bounce_env.engine.tolerances import PRESSING, ULPS_OF_SPEED


@function
def take_sides(state: State, w: int, k: int) -> None:
    """The ball's sides at its start: on a line itself the one it moves to, at rest the one gravity presses it from."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    gx, gy = gravity_of(state.gravity, scene)
    _side_with_lines(ball, state.faces, head.faces, state.face_sides, w, k, scene, gx, gy)
    _side_with_lines(ball, state.sensors, head.sensors, state.sensor_sides, w, k, scene, gx, gy)
    _side_with_lines(ball, state.edges, head.fields, state.edge_sides, w, k, scene, gx, gy)
    _side_with_arcs(ball, state.arcs, head.arcs, state.arc_sides, w, k, scene, gx, gy)
    _side_with_parts(ball, state.parts, head.parts, state.motions, state.ends, state.part_sides, w, k, scene, gx, gy)
    _side_with_rings(ball, state.rings, head.rings, state.ring_sides, w, k, scene, gx, gy)


@function
def _side_with_lines(
    ball: Record, lines: Table, count: int, sides: Table, w: int, k: int, scene: int, gx: float, gy: float
) -> None:
    if lines is None or sides is None:
        return
    for i in range(count):
        line = lines[scene, i]
        nx, ny = -line.uy, line.ux
        lean = (ball.x - line.x) * nx + (ball.y - line.y) * ny
        if abs(lean) <= ball.slack:
            lean = _lean(ball, nx, ny, gx, gy)
        sides[w, k, i] = 1 if lean >= 0.0 else -1


@function
def _side_with_parts(
    ball: Record, parts: Table, count: int, motions: Table, all_ends: Table, sides: Table, w: int, k: int, scene: int,
    gx: float, gy: float,
) -> None:  # fmt: skip
    if parts is None or motions is None or all_ends is None or sides is None:
        return
    for m in range(count):
        motion, ends = motions[w, m], all_ends[w, m]
        sides[w, k, m] = 0
        if is_dragged(ends, parts[scene, m]):
            x, y, ux, uy, _ = line_at(ends, since(ball.hi, ball.lo, motion.hi, motion.lo))
            lean = (ball.y - y) * ux - (ball.x - x) * uy
            if abs(lean) <= ball.slack:
                lean = _lean(ball, -uy, ux, gx, gy)
            sides[w, k, m] = 1 if lean >= 0.0 else -1


@function
def _side_with_arcs(
    ball: Record, arcs: Table, count: int, sides: Table, w: int, k: int, scene: int, gx: float, gy: float
) -> None:
    if arcs is None or sides is None:
        return
    for i in range(count):
        arc = arcs[scene, i]
        sides[w, k, i] = _side_of_circle(ball, arc.x, arc.y, arc.outer, gx, gy)


@function
def _side_with_rings(
    ball: Record, rings: Table, count: int, sides: Table, w: int, k: int, scene: int, gx: float, gy: float
) -> None:
    if rings is None or sides is None:
        return
    for i in range(count):
        ring = rings[scene, i]
        sides[w, k, i] = _side_of_circle(ball, ring.x, ring.y, ring.radius, gx, gy)


@function
def _side_of_circle(ball: Record, x: float, y: float, radius: float, gx: float, gy: float) -> int:
    dx, dy = ball.x - x, ball.y - y
    distance = math.sqrt(dx * dx + dy * dy)
    lean = distance - radius
    if abs(lean) <= ball.slack:
        lean = _lean(ball, dx / distance, dy / distance, gx, gy)
    return 1 if lean >= 0.0 else -1


@function
def _lean(ball: Record, nx: float, ny: float, gx: float, gy: float) -> float:
    """To which side of a line that it is on the ball moves, or else is pulled from; 0 where it does neither.

    Less than rounding is nothing: a ball sent along a turned wall is on the left of it, as along any other.
    """
    lean = ball.vx * nx + ball.vy * ny
    if abs(lean) > ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy)):
        return lean
    press = -(gx * nx + gy * ny)
    return press if abs(press) > PRESSING * (abs(gx) + abs(gy)) else 0.0
