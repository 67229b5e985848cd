"""The packed layout: what a scene and a world are in memory. Every field has 8 bytes.

A batch has `n` worlds. What never changes (`Tables`) is padded over the scenes of the batch, and each world holds the
index of its scene; what moves (`State`) is padded likewise. A member that no scene of the batch needs is None, and
the kernel is compiled without it: the set of members that are not None is the set of features.
"""

from typing import NamedTuple

import numpy as np

from bounce_env.engine.compile.jit import borrow, function
from bounce_env.engine.memory.records import BALL, COOLING, ENDS, MOTION, PAIR, TOUCH, TOUCHES, WORLD, ZONE, Array


class Tables(NamedTuple):
    """Scenes of a batch, padded; first axis scenes, second axis rows. None: no scene has any."""

    scenes: Array
    elements: Array
    gravity: Array | None  # (scenes, 2) m/s^2; there as well where a scene has a field
    faces: Array | None
    gates: Array | None  # (scenes, faces) int8: 1 for a one-way wall; None: no scene has one
    circles: Array | None
    arcs: Array | None
    sensors: Array | None
    rings: Array | None
    edges: Array | None  # of fields
    parts: Array | None
    turns: Array | None  # (scenes, parts) int8: 1 or -1, which way a part turns; 0 slides; None: no scene has any
    guides: Array | None  # (scenes, parts) GUIDE; None: no scene has a wall that is dragged
    drags: Array | None  # (scenes,) factor on the velocity at each instant of a command; None: no scene has any


class State(NamedTuple):
    """Worlds of a batch; first axis worlds. None where `Tables` has none of what it goes with."""

    worlds: Array
    balls: Array  # (worlds, balls)
    motions: Array | None  # (worlds, parts)
    ends: Array | None  # (worlds, parts) ENDS; None where nothing is dragged
    zones: Array | None  # (worlds, balls, parts)
    face_sides: Array | None  # (worlds, balls, faces) int8; only for a ball of no radius
    arc_sides: Array | None  # (worlds, balls, arcs) int8; only for a ball of no radius
    part_sides: Array | None  # (worlds, balls, parts) int8; only for a ball of no radius, where walls are dragged
    sensor_sides: Array | None  # (worlds, balls, sensors) int8
    ring_sides: Array | None  # (worlds, balls, rings) int8: 1 outside, -1 inside
    edge_sides: Array | None  # (worlds, balls, edges) int8: 1 on the field's side
    pairs: Array | None  # (worlds, balls, balls) PAIR, by the later and the earlier ball; None for one ball, and points
    touches: Array  # (worlds, TOUCHES) TOUCH: what a ball touches at the instant that is resolved
    disabled: Array | None  # (worlds, elements) int8; None where nothing can be switched off
    cooling: Array | None  # (worlds, elements) COOLING; None where no scene has a cooldown
    hits: Array  # (worlds, elements) int64: how often each was struck or crossed in the last step


def new_state(tables: Tables, worlds: int, balls: int, point: bool, switches: bool = False) -> State:
    """Zeroed state for `worlds` worlds of `balls` balls each.

    point: whether the balls have no radius. switches: whether elements can be disabled.
    """
    elements = (worlds, tables.elements.shape[1])

    def sides(table: Array | None) -> Array | None:
        return None if table is None else np.zeros((worlds, balls, table.shape[1]), np.int8)

    return State(
        worlds=np.zeros(worlds, WORLD),
        balls=np.zeros((worlds, balls), BALL),
        motions=None if tables.parts is None else np.zeros((worlds, tables.parts.shape[1]), MOTION),
        ends=None if tables.guides is None else np.zeros((worlds, tables.guides.shape[1]), ENDS),
        zones=None if tables.parts is None else np.zeros((worlds, balls, tables.parts.shape[1]), ZONE),
        face_sides=sides(tables.faces) if point else None,
        arc_sides=sides(tables.arcs) if point else None,
        part_sides=sides(tables.guides) if point else None,
        sensor_sides=sides(tables.sensors),
        ring_sides=sides(tables.rings),
        edge_sides=sides(tables.edges),
        pairs=None if point or balls == 1 else np.zeros((worlds, balls, balls), PAIR),
        touches=np.zeros((worlds, TOUCHES), TOUCH),
        disabled=np.zeros(elements, np.int8) if switches else None,
        cooling=np.zeros(elements, COOLING) if tables.elements["cooldown"].any() else None,
        hits=np.zeros(elements, np.int64),
    )


@function
def borrow_state(state: State) -> State:
    """The same state, borrowed; see `engine.compile.jit.borrow`."""
    return State(
        borrow(state.worlds),
        borrow(state.balls),
        borrow(state.motions),
        borrow(state.ends),
        borrow(state.zones),
        borrow(state.face_sides),
        borrow(state.arc_sides),
        borrow(state.part_sides),
        borrow(state.sensor_sides),
        borrow(state.ring_sides),
        borrow(state.edge_sides),
        borrow(state.pairs),
        borrow(state.touches),
        borrow(state.disabled),
        borrow(state.cooling),
        borrow(state.hits),
    )


@function
def borrow_tables(tables: Tables) -> Tables:
    """The same tables, borrowed."""
    return Tables(
        borrow(tables.scenes),
        borrow(tables.elements),
        borrow(tables.gravity),
        borrow(tables.faces),
        borrow(tables.gates),
        borrow(tables.circles),
        borrow(tables.arcs),
        borrow(tables.sensors),
        borrow(tables.rings),
        borrow(tables.edges),
        borrow(tables.parts),
        borrow(tables.turns),
        borrow(tables.guides),
        borrow(tables.drags),
    )
