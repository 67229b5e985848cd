"""What kernels look up in the state, where a batch may have none of it."""

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.memory.records import ON_BALLS, RIDING
from bounce_env.engine.memory.state import State


@where("disabled", otherwise=False)
def is_off(state: State, w: int, element: int) -> bool:
    """Return whether an element of world `w` is switched off."""
    return state.disabled[w, element] != 0


@where("one_way", otherwise=False)
def is_one_way(state: State, scene: int, i: int) -> bool:
    """Return whether face `i` is that of a one-way wall, which is struck from the left only."""
    return state.one_way[scene, i] != 0


@where("turns", otherwise=0)
def turn_of(state: State, scene: int, m: int) -> int:
    """Return which way part `m` turns, 1 or -1; 0 where it slides or is dragged."""
    return state.turns[scene, m]


@where("ends")
def ends_of(state: State, w: int, m: int) -> Record:
    """Return the record of the ends of part `m`; None where nothing is dragged in any scene."""
    return state.ends[w, m]


@where("part_sides", otherwise=0)
def side_of_part(state: State, w: int, k: int, m: int) -> int:
    """Return on which side, 1 or -1, of dragged wall `m` a ball of no radius is; 0 for a disc and other parts."""
    return state.part_sides[w, k, m]


@function
def side_on(sides: Table, w: int, k: int, i: int) -> int:
    """Return on which side, 1 or -1, of surface `i` a ball of no radius is; 0 for a disc, whose centre tells."""
    if sides is None:
        return 0
    return sides[w, k, i]


@function
def is_sliding(ball: Record) -> bool:
    """Return whether a ball moves along a wall, the straight side of a part, or what it and others lie on."""
    return ball.contact >= 0 or ball.contact in (RIDING, ON_BALLS)


@where("members", otherwise=False)
def is_doomed(state: State, w: int, k: int) -> bool:
    """Return whether a part is to crush the ball at its next event."""
    return bool(state.members[w, k].doomed)


@function
def let_off(state: State, w: int, k: int) -> None:
    """Forget the part that has struck a ball, and was to crush it."""
    state.balls[w, k].struck = -1
    _undoom(state, w, k)


@where("members")
def _undoom(state: State, w: int, k: int) -> None:
    state.members[w, k].doomed = 0


@function
def column_at(grid: Record, x: float) -> int:
    """Return the column of a grid in which x [m] lies; of what lies outside the nearest one."""
    return int(min(max((x - grid.x) * grid.inverse, 0.0), grid.columns - 1.0))


@function
def row_at(grid: Record, y: float) -> int:
    """Return the row of a grid in which y [m] lies; of what lies outside the nearest one."""
    return int(min(max((y - grid.y) * grid.inverse, 0.0), grid.rows - 1.0))


@function
def _every_face(state: State, scene: int, x: float, y: float) -> tuple[int, int]:
    return 0, state.scenes[scene].faces


@function
def _cell_at(state: State, scene: int, x: float, y: float) -> int:
    grid = state.grids[scene]
    cell: int = row_at(grid, y) * grid.columns + column_at(grid, x)
    return cell


@where("grids", otherwise=_every_face)
def faces_near(state: State, scene: int, x: float, y: float) -> tuple[int, int]:
    """Return from which number to before which to ask `face_near` for the walls that a ball at (x, y) [m] may touch."""
    cell = _cell_at(state, scene, x, y)
    return state.cell_starts[scene, cell], state.cell_circles[scene, cell]


def _same_number(state: State, scene: int, at: int) -> int:
    return at


@where("grids", otherwise=_same_number)
def face_near(state: State, scene: int, at: int) -> int:
    """Return a face by its number from `faces_near`."""
    return state.cell_entries[scene, at].number


@function
def _every_circle(state: State, scene: int, x: float, y: float) -> tuple[int, int]:
    return 0, state.scenes[scene].circles


@where("grids", otherwise=_every_circle)
def circles_near(state: State, scene: int, x: float, y: float) -> tuple[int, int]:
    """Return the same for circles and `circle_near`."""
    cell = _cell_at(state, scene, x, y)
    return state.cell_circles[scene, cell], state.cell_starts[scene, cell + 1]


@where("grids", otherwise=_same_number)
def circle_near(state: State, scene: int, at: int) -> int:
    """Return a circle by its number from `circles_near`."""
    return state.cell_entries[scene, at].number - state.scenes[scene].faces
