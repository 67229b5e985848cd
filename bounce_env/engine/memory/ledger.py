"""The ledger, and the counts of hits: what a world tells of its events."""

from bounce_env.engine.compile.jit import Record, Table, function
from bounce_env.engine.memory.state import State


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
