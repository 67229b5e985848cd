"""What a world tells of its events: the ledger, the moments after them, counts of hits. Nothing else writes these."""

from typing import NamedTuple

from bounce_env.engine.compile.jit import Table, function, routine
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


@routine
def append_row(state: State, w: int, row: Row) -> None:
    """Write a row into the ledger, where this world is recorded."""
    ledger, head = state.recording.ledger, state.recording.head[0]
    if not is_recorded(state, w):
        return
    if head.rows == ledger.shape[0]:
        head.lost += 1
        return
    out = ledger[head.rows]
    out.time, out.ball, out.element, out.kind = row.time, row.ball, row.element, row.kind
    out.x, out.y, out.nx, out.ny = row.x, row.y, row.nx, row.ny
    out.vx0, out.vy0, out.vx1, out.vy1 = row.vx0, row.vy0, row.vx1, row.vy1
    out.ux, out.uy = row.ux, row.uy
    head.rows += 1


@function
def append_contact(state: State, w: int, k: int, kind: int, surface: Surface, vx0: float, vy0: float) -> None:
    """Write that ball `k`, of velocity (vx0, vy0) [m/s] before, is where it is and has its present velocity now."""
    ball, s = state.balls[w, k], surface
    append_row(
        state,
        w,
        Row(
            ball.hi, k, s.element, kind, ball.x, ball.y, s.nx, s.ny, vx0, vy0, ball.vx, ball.vy, s.ux, s.uy,
        ),
    )  # fmt: skip


@function
def append_crossing(state: State, w: int, k: int, surface: Surface, x: float, y: float, vx: float, vy: float) -> None:
    """Write that ball `k` crosses an element at (x, y) [m], at its next event."""
    time, s = state.balls[w, k].next_hi, surface
    append_row(state, w, Row(time, k, s.element, CROSSING, x, y, s.nx, s.ny, vx, vy, vx, vy, s.ux, s.uy))


@function
def append_stop(
    state: State, w: int, element: int, time: float, place: tuple[float, float],
    before: tuple[float, float], after: tuple[float, float],
) -> None:  # fmt: skip
    """Write that a part stops or turns back: a place on it [m], and that place's velocity [m/s] before and after."""
    (x, y), (vx0, vy0), (vx1, vy1) = place, before, after
    append_row(state, w, Row(time, -1, element, PART_STOPS, x, y, 0.0, 0.0, vx0, vy0, vx1, vy1, 0.0, 0.0))


@function
def is_recorded(state: State, w: int) -> bool:
    """Return whether what happens in world `w` is recorded."""
    recorded: bool = state.recording.head[0].world == w
    return recorded


@function
def is_page_full(state: State, w: int, rows: int) -> bool:
    """Return whether the recording of world `w` lacks room for `rows` rows and a moment."""
    recording, head = state.recording, state.recording.head[0]
    moments = recording.moments.shape[0]
    return is_recorded(state, w) and (
        head.rows + rows > recording.ledger.shape[0] or (moments > 0 and head.moments == moments)
    )


@routine
def keep_moment(state: State, w: int) -> None:
    """Write from what state the balls and parts of world `w` go on now, where it is recorded with room for moments."""
    recording, head = state.recording, state.recording.head[0]
    if not is_recorded(state, w) or recording.moments.shape[0] == 0:
        return
    if head.moments == recording.moments.shape[0]:
        head.lost += 1
        return
    i, world = head.moments, state.worlds[w]
    moment = recording.moments[i]
    moment.hi, moment.lo, moment.rows = world.time_hi, world.time_lo, head.rows
    _copy_row(recording.balls, i, state.balls, w)
    _copy_row(recording.curve_slides, i, state.curve_slides, w)
    _copy_row(recording.carried, i, state.carried, w)
    _copy_row(recording.motions, i, state.motions, w)
    _copy_row(recording.ends, i, state.ends, w)
    _copy_row(recording.disabled, i, state.disabled, w)
    head.moments += 1


@function
def _copy_row(kept: Table, i: int, rows: Table, w: int) -> None:
    """Copy row `w` to row `i` of `kept`, where there are any."""
    if rows is None:
        return
    for j in range(rows.shape[1]):
        kept[i, j] = rows[w, j]


@function
def count_hit(state: State, w: int, element: int) -> None:
    """Count a bounce from, or a crossing of, an element in this step."""
    world = state.worlds[w]
    state.hits[w, element] += 1
    if world.dirty < state.struck.shape[1]:
        state.struck[w, world.dirty] = element
    world.dirty += 1
