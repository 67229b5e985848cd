"""On which side of lines, circles and parts a ball starts."""

import math

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.dragged_wall import dragged_wall_line_at
from bounce_env.engine.motion.fields import gravity_of
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.parts import is_dragged_part, moving_part
from bounce_env.engine.tolerances import PRESSING, ULPS_OF_SPEED

Vector = tuple[float, float]


@function
def set_initial_sides(state: State, w: int, k: int) -> None:
    """Set the ball's sides: on a line itself the one it moves to, at rest the one gravity presses it from."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head, gravity = state.scenes[scene], gravity_of(state, scene)
    _set_line_sides(ball, gravity, state.faces, state.face_sides, head.faces, w, k, scene)
    _set_line_sides(ball, gravity, state.sensors, state.sensor_sides, head.sensors, w, k, scene)
    _set_line_sides(ball, gravity, state.field_edges, state.field_edge_sides, head.fields, w, k, scene)
    _set_arc_sides(state, w, k)
    _set_part_sides(state, w, k)
    _set_circle_sensor_sides(state, w, k)


@function
def _set_line_sides(
    ball: Record, gravity: Vector, lines: Table, sides: Table, count: int, w: int, k: int, scene: int
) -> None:
    """One loop for walls, sensors and borders of fields: `lines` and `sides` are those of one of them."""
    if lines is None or sides is None:
        return
    for i in range(count):
        line = lines[scene, i]
        nx, ny = -line.uy, line.ux
        height = (ball.x - line.x) * nx + (ball.y - line.y) * ny
        sides[w, k, i] = _initial_side(ball, gravity, height, nx, ny)


@where("part_sides")
def _set_part_sides(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for m in range(state.scenes[scene].parts):
        part = moving_part(state, w, m)
        state.part_sides[w, k, m] = 0
        if is_dragged_part(part):
            x, y, ux, uy, _ = dragged_wall_line_at(part.ends, since(ball.hi, ball.lo, part.motion.hi, part.motion.lo))
            height = (ball.y - y) * ux - (ball.x - x) * uy
            state.part_sides[w, k, m] = _initial_side(ball, gravity_of(state, scene), height, -uy, ux)


@where("arc_sides")
def _set_arc_sides(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for i in range(state.scenes[scene].arcs):
        arc = state.arcs[scene, i]
        state.arc_sides[w, k, i] = _initial_side_of_circle(ball, gravity_of(state, scene), arc.x, arc.y, arc.outer)


@where("circle_sensors")
def _set_circle_sensor_sides(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    for i in range(state.scenes[scene].circle_sensors):
        ring = state.circle_sensors[scene, i]
        state.circle_sensor_sides[w, k, i] = _initial_side_of_circle(
            ball, gravity_of(state, scene), ring.x, ring.y, ring.radius
        )


@function
def _initial_side_of_circle(ball: Record, gravity: Vector, x: float, y: float, radius: float) -> int:
    dx, dy = ball.x - x, ball.y - y
    distance = math.sqrt(dx * dx + dy * dy)
    return _initial_side(ball, gravity, distance - radius, dx / distance, dy / distance)


@function
def _initial_side(ball: Record, gravity: Vector, height: float, nx: float, ny: float) -> int:
    if abs(height) <= ball.tolerance:
        height = _initial_lean(ball, gravity, nx, ny)
    return 1 if height >= 0.0 else -1


@function
def _initial_lean(ball: Record, gravity: Vector, nx: float, ny: float) -> float:
    """Return to which side of a line that it is on the ball moves, or else is pulled from; 0 where it does neither.

    Less than rounding is nothing: a ball sent along a turned wall is on the left of it, as along any other.
    """
    lean = ball.vx * nx + ball.vy * ny
    if abs(lean) > ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy)):
        return lean
    gx, gy = gravity
    press = -(gx * nx + gy * ny)
    return press if abs(press) > PRESSING * (abs(gx) + abs(gy)) else 0.0
