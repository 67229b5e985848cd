"""The ledger, and the counts of hits: what a world tells of its events. Nothing else writes rows."""

from typing import NamedTuple

from bounce_env.engine.compile.jit import Record, Table, function
from bounce_env.engine.memory.records import CROSSING, PART_STOPS
from bounce_env.engine.memory.state import State


class Surface(NamedTuple):
    """What a row tells of the element: its index, the unit normal from it to the ball, its velocity [m/s] there."""

    element: int
    nx: float
    ny: float
    ux: float
    uy: float


class Row(NamedTuple):
    """A row of the ledger, column by column; see `LEDGER`."""

    time: float
    ball: int
    element: int
    kind: int
    x: float
    y: float
    nx: float
    ny: float
    vx0: float
    vy0: float
    vx1: float
    vy1: float
    ux: float
    uy: float


@function
def append_row(ledger: Table, world: Record, row: Row) -> None:
    """Write a row into the ledger, where there is one."""
    if ledger is None:
        return
    out = ledger[world.rows]
    out.time, out.ball, out.element, out.kind = row.time, row.ball, row.element, row.kind
    out.x, out.y, out.nx, out.ny = row.x, row.y, row.nx, row.ny
    out.vx0, out.vy0, out.vx1, out.vy1 = row.vx0, row.vy0, row.vx1, row.vy1
    out.ux, out.uy = row.ux, row.uy
    world.rows += 1


@function
def append_contact(
    ledger: Table, world: Record, ball: Record, k: int, kind: int, surface: Surface, vx0: float, vy0: float
) -> None:
    """Write that ball `k`, of velocity (vx0, vy0) [m/s] before, is where it is and has its present velocity now."""
    s = surface
    append_row(
        ledger,
        world,
        Row(
            ball.hi, k, s.element, kind, ball.x, ball.y, s.nx, s.ny, vx0, vy0, ball.vx, ball.vy, s.ux, s.uy,
        ),
    )  # fmt: skip


@function
def append_crossing(
    ledger: Table, world: Record, ball: Record, k: int, surface: Surface, x: float, y: float, vx: float, vy: float
) -> None:
    """Write that ball `k` crosses an element at (x, y) [m], at its next event."""
    s = surface
    append_row(ledger, world, Row(ball.next_hi, k, s.element, CROSSING, x, y, s.nx, s.ny, vx, vy, vx, vy, s.ux, s.uy))


@function
def append_stop(
    ledger: Table, world: Record, element: int, time: float, place: tuple[float, float],
    before: tuple[float, float], after: tuple[float, float],
) -> None:  # fmt: skip
    """Write that a part stops or turns back: a place on it [m], and that place's velocity [m/s] before and after."""
    (x, y), (vx0, vy0), (vx1, vy1) = place, before, after
    append_row(ledger, world, Row(time, -1, element, PART_STOPS, x, y, 0.0, 0.0, vx0, vy0, vx1, vy1, 0.0, 0.0))


@function
def count_hit(state: State, w: int, element: int) -> None:
    """Count a bounce from, or a crossing of, an element in this step."""
    state.hits[w, element] += 1
    state.worlds[w].dirty = 1
