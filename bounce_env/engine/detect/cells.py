"""What a flight meets first of very many walls and circles: it goes from cell to cell of a grid, see `memory.cells`."""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.detect.surfaces import circle_hit, face_hit, first_one_by_one
from bounce_env.engine.impact.swept_box import Box, are_apart, box_entry_time, box_leaving_time, box_of, is_in_box
from bounce_env.engine.memory.cells import STRIDE
from bounce_env.engine.memory.lookup import column_at, row_at
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import (
    Flight,
    acceleration_magnitude,
    flight_after,
    flight_place_after,
)
from bounce_env.engine.tolerances import BOX_MARGIN, CELL_MARGIN


class Hit(NamedTuple):
    """The earliest hit: duration [s]; which shape, by its number in the cells' lists, -1 for none."""

    after: float
    shape: int


@where("grids", otherwise=first_one_by_one)
def first_face_or_circle(
    state: State, w: int, k: int, flight: Flight, nx: float, ny: float, horizon: float
) -> tuple[float, int, int]:
    """Return the earliest hit of a wall's straight part, a bumper or an end before `horizon` [s].

    As (duration, face, circle), -1 for none. (nx, ny) is the normal of what the ball slides on, (0, 0) in flight.
    """
    scene = state.worlds[w].scene
    grid, faces = state.grids[scene], state.scenes[scene].faces
    box = Box(grid.x, grid.x + grid.columns * grid.side, grid.y, grid.y + grid.rows * grid.side)
    hit, t = Hit(horizon, -1), 0.0
    while t < hit.after:
        x, y = flight_place_after(flight, t)
        if not is_in_box(box, x, y):
            t = box_entry_time(flight, box, t)
            if t >= hit.after:
                break
        # A little longer than it is in the grid, so that it is out of it then.
        leaves = box_leaving_time(flight, box, t)
        hit, t = _first_on_the_way(state, w, k, flight, nx, ny, t, leaves + BOX_MARGIN * leaves, hit)
    if hit.shape < faces:
        return hit.after, hit.shape, -1
    return hit.after, -1, hit.shape - faces


@function
def _time_through_cell(flight: Flight, size: float) -> float:
    """Return a duration [s] in which a flight comes no further than `size` [m]."""
    speed, pull = abs(flight.vx) + abs(flight.vy), acceleration_magnitude(flight.ax, flight.ay)
    root = math.sqrt(speed * speed + 4.0 * pull * size)
    return 2.0 * size / (speed + root) if speed + root > 0.0 else math.inf


@function
def _first_on_the_way(
    state: State, w: int, k: int, flight: Flight, nx: float, ny: float, t: float, until: float, hit: Hit
) -> tuple[Hit, float]:
    """Go from cell to cell from `t` on, up to a hit or to `until` [s]; returns the earliest hit, and up to when."""
    scene = state.worlds[w].scene
    grid, margin = state.grids[scene], CELL_MARGIN * state.scenes[scene].extent
    pull = acceleration_magnitude(flight.ax, flight.ay)
    x, y = flight_place_after(flight, t)
    if not until > t:  # on the border, where it leaves at once: a little is searched, so that time goes on
        until = t + _time_through_cell(flight_after(flight, t), grid.side)
    while t < min(until, hit.after):
        through = _time_through_cell(flight_after(flight, t), STRIDE * grid.side)
        if through == math.inf:  # it stands
            return hit, math.inf
        end = min(t + through, until, hit.after)
        if not end > t:
            end = min(until, hit.after)
        x1, y1 = flight_place_after(flight, end)
        # So far a parabola bends away from its chord, at most.
        wide = margin + 0.125 * pull * (end - t) * (end - t)
        swept = Box(min(x, x1) - wide, max(x, x1) + wide, min(y, y1) - wide, max(y, y1) + wide)
        hit = _first_in_cells(state, w, k, flight, nx, ny, swept, hit)
        t, x, y = end, x1, y1
    return hit, t


@function
def _first_in_cells(state: State, w: int, k: int, flight: Flight, nx: float, ny: float, swept: Box, hit: Hit) -> Hit:
    """Search what is listed in the cells that a box touches, as far as its own box does."""
    scene = state.worlds[w].scene
    grid, faces = state.grids[scene], state.scenes[scene].faces
    i0, j0 = column_at(grid, swept.left), row_at(grid, swept.below)
    i1, j1 = column_at(grid, swept.right), row_at(grid, swept.above)
    for j in range(j0, j1 + 1):
        row = j * grid.columns
        # The lists of neighbours in a row follow each other.
        for at in range(state.cell_starts[scene, row + i0], state.cell_starts[scene, row + i1 + 1]):
            entry = state.cell_entries[scene, at]
            if are_apart(swept, box_of(entry)):
                continue
            shape = entry.number
            if shape < faces:
                after = face_hit(state, w, k, flight, nx, ny, shape, hit.after)
            else:
                after = circle_hit(state, w, k, flight, nx, ny, shape - faces, hit.after)
            # At one instant the first one is struck, as where they are searched one by one.
            if after < hit.after or (after == hit.after and shape < hit.shape):
                hit = Hit(after, shape)
    return hit
