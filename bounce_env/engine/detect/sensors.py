"""What a ball's centre crosses next without bouncing: sensors of both shapes and the borders of fields."""

import math

from bounce_env.engine.compile.jit import Feature, Record, Table, function
from bounce_env.engine.impact.arc import entry_time
from bounce_env.engine.impact.line import facing_time, line_time
from bounce_env.engine.memory.records import FIELD_EDGE, LINE, RING_ENTRY
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import ULP

Crossing = tuple[float, int, int]  # duration [s] from the flight's start, kind and row of what is crossed


@function
def next_crossing(
    state: State, w: int, k: int, gx: Feature, gy: Feature, after: float, kind: int, index: int
) -> Crossing:
    """Earliest crossing later than the crossing (after, kind, index), up to the flight's end; inf if none.

    Crossings at one instant come in the order of kinds (lines, circles, borders of fields), and in that of elements.
    """
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    best = (math.inf, LINE, -1)
    best = _lines(best, ball, state.sensors, head.sensors, state.sensor_sides, w, k, scene, gx, gy, after, kind, index)
    best = _rings(best, ball, state.rings, head.rings, state.ring_sides, w, k, scene, gx, gy, after, kind, index)
    return _edges(best, ball, state.edges, head.fields, state.edge_sides, w, k, scene, gx, gy, after, kind, index)


@function
def _follows(t: float, kind: int, index: int, after: float, last_kind: int, last_index: int) -> bool:
    return t > after or (t == after and (kind > last_kind or (kind == last_kind and index > last_index)))


@function
def _lines(
    best: Crossing, ball: Record, sensors: Table, count: int, sides: Table, w: int, k: int, scene: int,
    gx: Feature, gy: Feature, after: float, kind: int, index: int,
) -> Crossing:  # fmt: skip
    if sensors is None:
        return best
    for i in range(count):
        sensor = sensors[scene, i]
        x, y = ball.x - sensor.x, ball.y - sensor.y
        for facing in (1.0, -1.0):
            t = facing_time(
                x, y, ball.vx, ball.vy, gx, gy, sensor.ux, sensor.uy, sensor.length, 0.0,
                facing, sides[w, k, i], ball.slack, ball.end_after,
            )  # fmt: skip
            if t < best[0] and _follows(t, LINE, i, after, kind, index):
                best = (t, LINE, i)
    return best


@function
def _rings(
    best: Crossing, ball: Record, rings: Table, count: int, sides: Table, w: int, k: int, scene: int,
    gx: Feature, gy: Feature, after: float, kind: int, index: int,
) -> Crossing:  # fmt: skip
    if rings is None:
        return best
    for i in range(count):
        ring = rings[scene, i]
        # A ball may enter a circle twice in one flight: what came before is no answer.
        tie = _follows(after, RING_ENTRY, i, after, kind, index)
        t = entry_time(
            ball.x - ring.x, ball.y - ring.y, ball.vx, ball.vy, gx, gy, ring.radius,
            sides[w, k, i] > 0, ball.slack, after - abs(after) * ULP if tie else after, ball.end_after,
        )  # fmt: skip
        if t < best[0] and _follows(t, RING_ENTRY, i, after, kind, index):
            best = (t, RING_ENTRY, i)
    return best


@function
def _edges(
    best: Crossing, ball: Record, edges: Table, count: int, sides: Table, w: int, k: int, scene: int,
    gx: Feature, gy: Feature, after: float, kind: int, index: int,
) -> Crossing:  # fmt: skip
    if edges is None:
        return best
    for i in range(count):
        edge = edges[scene, i]
        x, y = ball.x - edge.x, ball.y - edge.y
        for facing in (1.0, -1.0):
            t = line_time(
                x, y, ball.vx, ball.vy, gx, gy, edge.ux, edge.uy, 0.0, facing, sides[w, k, i], ball.slack
            )  # fmt: skip
            if t <= ball.end_after and t < best[0] and _follows(t, FIELD_EDGE, i, after, kind, index):
                best = (t, FIELD_EDGE, i)
    return best
