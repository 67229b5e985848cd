"""The state: all that kernels read and write, one tuple of arrays for a batch of worlds.

What never changes, the scenes, is padded over the scenes of the batch, and each world holds the index of its scene;
what moves is padded likewise. A member that no scene of the batch needs is None, and kernels are compiled without it:
the set of members that are not None is the set of features.
"""

from typing import Any, NamedTuple

import numpy as np

from bounce_env.engine.compile.jit import Table
from bounce_env.engine.memory.records import (
    ACTIVE,
    BALL,
    CARRIED,
    CONTACT,
    CONTACTS_OF_BALL,
    COOLING,
    CURVE_SLIDE,
    ENDS,
    LEDGER,
    MEMBER,
    MOMENT,
    MOTION,
    NO_WORLD,
    PAIR,
    RECORDING,
    STRUCK,
    TOUCH,
    TOUCHES,
    WORLD,
    ZONE,
    Array,
)
from bounce_env.scene import Feature


class Recording(NamedTuple):
    """What is kept of one world's events, as long as it is recorded: see `memory.ledger`.

    A moment is the state from which balls and parts go on at one instant: copies of these members of `State`.
    """

    head: Array  # (1,) RECORDING
    ledger: Array  # (rows,) LEDGER
    moments: Array  # (moments,) MOMENT
    balls: Array  # (moments, balls)
    curve_slides: Table  # (moments, balls); None as in `State`, as those that follow
    carried: Table
    motions: Table  # (moments, parts)
    ends: Table
    disabled: Table  # (moments, elements)


class State(NamedTuple):
    """Scenes and worlds of a batch; None: no scene of the batch has any."""

    # The scenes: first axis scenes, second axis rows.
    scenes: Array
    elements: Array
    gravity: Table  # (scenes, 2) m/s^2; there as well where a scene has a field
    faces: Table
    one_way: Table  # (scenes, faces) int8: 1 for a one-way wall
    circles: Table
    arcs: Table
    grids: Table  # (scenes,) GRID; these four None where no scene has very many walls and circles, see `memory.cells`
    cell_starts: Table  # (scenes, cells + 1) int64
    cell_circles: Table  # (scenes, cells) int64
    cell_entries: Table  # (scenes, n) CELL_ENTRY
    sensors: Table
    circle_sensors: Table
    field_edges: Table  # of fields
    parts: Table
    turns: Table  # (scenes, parts) int8: 1 or -1, which way a part turns; 0 slides
    drag_limits: Table  # (scenes, parts) DRAG_LIMITS; None: no scene has a wall that is dragged
    drags: Table  # (scenes,) factor on the velocity at each instant of a command
    recording: Recording  # of one of the worlds, or of none
    # The worlds: first axis worlds.
    worlds: Array
    balls: Array  # (worlds, balls)
    motions: Table  # (worlds, parts)
    ends: Table  # (worlds, parts) ENDS; None where nothing is dragged
    zones: Table  # (worlds, balls, parts)
    face_sides: Table  # (worlds, balls, faces) int8; only for a ball of no radius
    arc_sides: Table  # (worlds, balls, arcs) int8; only for a ball of no radius
    part_sides: Table  # (worlds, balls, parts) int8; only for a ball of no radius, where walls are dragged
    sensor_sides: Table  # (worlds, balls, sensors) int8
    circle_sensor_sides: Table  # (worlds, balls, rings) int8: 1 outside, -1 inside
    field_edge_sides: Table  # (worlds, balls, edges) int8: 1 on the field's side
    curve_slides: Table  # (worlds, balls) CURVE_SLIDE; None where nothing round can hold a ball
    carried: Table  # (worlds, balls) CARRIED; None where no part moves by what is round
    pairs: Table  # (worlds, balls, balls) PAIR, by the later and the earlier ball; None for one ball, and points
    touches: Array  # (worlds, TOUCHES) TOUCH: what a ball touches at the instant that is resolved
    members: Table  # (worlds, balls) MEMBER: what balls among others have beside; these four None as `pairs`
    contacts: Table  # (worlds, TOUCHES + CONTACTS_OF_BALL balls) CONTACT: between them and what they touch
    actives: Table  # (worlds, 2 balls) ACTIVE: those that a projection has found to act
    factors: Table  # (worlds, 2 balls, 2 balls) the Cholesky factor of their products
    disabled: Table  # (worlds, elements) int8; None where nothing can be switched off
    cooling: Table  # (worlds, elements) COOLING; None where no scene has a cooldown
    hits: Array  # (worlds, elements) int64: how often each was struck or crossed in the last step
    struck: Array  # (worlds, STRUCK) int64: the first of them, `dirty` of them, one that was struck again as well


_FIRST_OF_WORLDS = State._fields.index("worlds")


def moving_arrays(state: State) -> tuple[Array, ...]:
    """Return what changes while worlds are played: the arrays with a row for each world."""
    arrays: tuple[Any, ...] = state[_FIRST_OF_WORLDS:]
    return tuple(array for array in arrays if array is not None)


def copy_of_world(state: State, w: int) -> State:
    """Return a copy of world `w` alone, beside the same scenes."""
    worlds = zip(State._fields, state, strict=True)
    rows = {name: array[w : w + 1].copy() for name, array in [*worlds][_FIRST_OF_WORLDS:] if array is not None}
    return with_recording(state._replace(**rows))


def going_on(state: State) -> tuple[Table, ...]:
    """Return those arrays of worlds of which a moment has copies."""
    return state.balls, state.curve_slides, state.carried, state.motions, state.ends, state.disabled


def with_recording(state: State, rows: int = 0, moments: int = 0) -> State:
    """Return the same state with room to record a world: so many rows of the ledger, and so many moments."""
    kept: list[Any] = [None if a is None else np.zeros((moments, *a.shape[1:]), a.dtype) for a in going_on(state)]
    head = np.zeros(1, RECORDING)
    head["world"] = NO_WORLD
    return state._replace(recording=Recording(head, np.zeros(rows, LEDGER), np.zeros(moments, MOMENT), *kept))


def taken(recording: Recording) -> Recording:
    """Return what a recording holds, and empty it."""
    head = recording.head.copy()
    rows, moments = int(head[0]["rows"]), int(head[0]["moments"])
    kept: list[Any] = [None if array is None else array[:moments].copy() for array in recording[2:]]
    for name in ("rows", "moments", "lost"):
        recording.head[name] = 0
    return Recording(head, recording.ledger[:rows].copy(), *kept)


def new_state(tables: dict[str, Any], worlds: int, balls: int, present: frozenset[Feature]) -> State:
    """Return zeroed worlds of `balls` balls each, with the features `present`, beside the scenes' `tables` by name."""
    parts, drag_limits, elements = tables["parts"], tables["drag_limits"], tables["elements"]
    meet, curved = Feature.SEVERAL_BALLS in present, Feature.CURVED_CONTACT in present
    point = Feature.BALL_RADIUS not in present

    def sides(table: Table) -> Array | None:
        return None if table is None else np.zeros((worlds, balls, table.shape[1]), np.int8)

    nothing = np.zeros(0)
    state = State(
        **tables,
        recording=Recording(*[nothing] * len(Recording._fields)),
        worlds=np.zeros(worlds, WORLD),
        balls=np.zeros((worlds, balls), BALL),
        motions=None if parts is None else np.zeros((worlds, parts.shape[1]), MOTION),
        ends=None if drag_limits is None else np.zeros((worlds, drag_limits.shape[1]), ENDS),
        zones=None if parts is None else np.zeros((worlds, balls, parts.shape[1]), ZONE),
        face_sides=sides(tables["faces"]) if point else None,
        arc_sides=sides(tables["arcs"]) if point else None,
        part_sides=sides(drag_limits) if point else None,
        sensor_sides=sides(tables["sensors"]),
        circle_sensor_sides=sides(tables["circle_sensors"]),
        field_edge_sides=sides(tables["field_edges"]),
        curve_slides=np.zeros((worlds, balls), CURVE_SLIDE) if curved else None,
        carried=np.zeros((worlds, balls), CARRIED) if curved and parts is not None else None,
        pairs=np.zeros((worlds, balls, balls), PAIR) if meet else None,
        touches=np.zeros((worlds, TOUCHES), TOUCH),
        members=np.zeros((worlds, balls), MEMBER) if meet else None,
        contacts=np.zeros((worlds, TOUCHES + CONTACTS_OF_BALL * balls), CONTACT) if meet else None,
        actives=np.zeros((worlds, 2 * balls), ACTIVE) if meet else None,
        factors=np.zeros((worlds, 2 * balls, 2 * balls)) if meet else None,
        disabled=np.zeros((worlds, elements.shape[1]), np.int8) if Feature.SWITCHES in present else None,
        cooling=np.zeros((worlds, elements.shape[1]), COOLING) if Feature.COOLDOWN in present else None,
        hits=np.zeros((worlds, elements.shape[1]), np.int64),
        struck=np.zeros((worlds, STRUCK), np.int64),
    )
    return with_recording(state)
