"""The acceleration of a ball: gravity, and the fields that it is in."""

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.memory.state import State


@function
def accelerate(state: State, w: int, k: int) -> None:
    """Set a ball's acceleration from gravity and the fields that it is in; a flight that has begun is not changed."""
    ball = state.balls[w, k]
    ball.gx, ball.gy = gravity_of(state, state.worlds[w].scene)
    _add_fields(state, w, k)


@where("gravity", otherwise=(0.0, 0.0))
def gravity_of(state: State, scene: int) -> tuple[float, float]:
    """Return the scene's gravity [m/s^2]."""
    return state.gravity[scene, 0], state.gravity[scene, 1]


@where("field_edges")
def _add_fields(state: State, w: int, k: int) -> None:
    ball, scene = state.balls[w, k], state.worlds[w].scene
    inside = True
    for i in range(state.scenes[scene].fields):
        edge = state.field_edges[scene, i]
        inside = inside and state.field_edge_sides[w, k, i] > 0
        if edge.last:
            if inside:
                ball.gx += edge.ax
                ball.gy += edge.ay
            inside = True
