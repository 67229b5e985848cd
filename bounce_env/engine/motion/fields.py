"""The acceleration of a ball: gravity, and the fields that it is in."""

from bounce_env.engine.compile.jit import Record, Table, function
from bounce_env.engine.memory.state import State


@function
def accelerate(state: State, w: int, k: int) -> None:
    """Set a ball's acceleration from gravity and the fields that it is in; a flight that has begun is not changed."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    ball.gx, ball.gy = gravity_of(state.gravity, scene)
    _add_fields(ball, state.edges, state.edge_sides, state.scenes[scene].fields, w, k, scene)


@function
def gravity_of(gravity: Table, scene: int) -> tuple[float, float]:
    if gravity is None:
        return 0.0, 0.0
    return gravity[scene, 0], gravity[scene, 1]


@function
def _add_fields(ball: Record, edges: Table, sides: Table, count: int, w: int, k: int, scene: int) -> None:
    if edges is None or sides is None:
        return
    inside = True
    for i in range(count):
        edge = edges[scene, i]
        inside = inside and sides[w, k, i] > 0
        if edge.last:
            if inside:
                ball.gx += edge.ax
                ball.gy += edge.ay
            inside = True
