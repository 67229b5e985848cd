"""The packed layout: what a scene and a world are in memory. Every field has 8 bytes.

A batch has `n` worlds. What never changes (`Tables`) is padded over the scenes of the batch, and each world holds the
index of its scene; what moves (`State`) is padded likewise. A member that no scene of the batch needs is None, and
the kernel is compiled without it: the set of members that are not None is the set of features.
"""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bounce_env.engine.jit import borrow, function

Array = npt.NDArray[Any]


def record(**fields: str) -> np.dtype[Any]:
    """A packed record type from names and formats."""
    # np.record gives attribute access with the compiler switched off, too.
    return np.dtype((np.record, np.dtype(list(fields.items()), align=True)))


SCENE = record(
    faces="i8", circles="i8", sensors="i8", paddles="i8",  # how many rows of each table this scene uses
    extent="f8",  # [m] the largest coordinate of the scene plus the ball's radius: the scale of round-off
    max_speed="f8",  # [m/s] inf where the scene has no cap
)  # fmt: skip
ELEMENT = record(
    b="f8", f="f8",  # the ball's times the element's
    kick="f8", kick_threshold="f8",  # [m/s]
)  # fmt: skip
FACE = record(x="f8", y="f8", ux="f8", uy="f8", length="f8", reach="f8", element="i8")
CIRCLE = record(x="f8", y="f8", reach="f8", element="i8")
SENSOR = record(x="f8", y="f8", ux="f8", uy="f8", length="f8", drain="i8", element="i8")
RAIL = record(
    x="f8", y="f8", ux="f8", uy="f8", span="f8",  # the paddle's centre runs `span` metres from (x, y)
    half_width="f8", reach="f8", max_speed="f8", element="i8",
)  # fmt: skip

WORLD = record(
    time_hi="f8", time_lo="f8",
    scene="i8",
    bounces="i8", speed_capped="i8",  # counts since reset
    dirty="i8",  # whether `hits` has entries of the last step
    rows="i8",  # of the ledger in use
)  # fmt: skip
BALL = record(
    x="f8", y="f8", vx="f8", vy="f8", hi="f8", lo="f8",  # the last event: state and instant; the flight starts here
    slack="f8",  # [m] what counts as touching at that instant
    touched="i8",  # how many elements it touched when it was last resolved
    next_hi="f8", next_lo="f8", next_kind="i8",  # the ball's next event
    hit_after="f8", hit_kind="i8", hit_index="i8",  # duration to the next hit of a standing element
    end_after="f8",  # duration after which nothing is met in this flight: that hit, or having left the scene
    sensor_after="f8", sensor_index="i8",
    zone_after="f8",  # duration to the next entry into or exit from a zone that a part can reach
    part_hi="f8", part_lo="f8", part_index="i8",  # next hit of a moving part, as far as its velocity is known
    status="i8",
)  # fmt: skip
ZONE = record(inside="i8", after="f8")  # whether the ball is where a part can reach, and when that changes
PADDLE = record(
    offset="f8", velocity="f8", hi="f8", lo="f8",  # along the rail, at the instant of the last command or stop
    command="f8",  # [m/s] as asked for; `velocity` is 0 where a stop holds the paddle against it
)  # fmt: skip
LEDGER = record(
    time="f8", ball="i8", element="i8", kind="i8", x="f8", y="f8", nx="f8", ny="f8",
    vx0="f8", vy0="f8", vx1="f8", vy1="f8", ux="f8", uy="f8",
)  # fmt: skip

# Ball status.
OK, BUDGET, CRUSHED, OUT = 0, 1, 2, 3
# Kinds of ledger rows.
BOUNCE, CONTACT_BEGINS, CONTACT_ENDS, CROSSING, PART_STOPS, CRUSH = 0, 1, 2, 3, 4, 5
# Kinds of standing obstacles.
ON_FACE, ON_CIRCLE = 0, 1
# Kinds of a ball's next event.
NEXT_HIT, NEXT_PART, NEXT_SENSOR, NEXT_ZONE = 0, 1, 2, 3


class Tables(NamedTuple):
    """Scenes of a batch, padded; first axis scenes, second axis rows. None: no scene has any."""

    scenes: Array
    elements: Array
    gravity: Array | None  # (scenes, 2) m/s^2
    faces: Array | None
    circles: Array | None
    sensors: Array | None
    rails: Array | None


class State(NamedTuple):
    """Worlds of a batch; first axis worlds. None where `Tables` has none of what it goes with."""

    worlds: Array
    balls: Array  # (worlds, balls)
    paddles: Array | None  # (worlds, paddles)
    zones: Array | None  # (worlds, balls, paddles)
    face_sides: Array | None  # (worlds, balls, faces) int8; only for a ball of no radius
    sensor_sides: Array | None  # (worlds, balls, sensors) int8
    hits: Array  # (worlds, elements) int64: how often each was struck or crossed in the last step


def new_state(tables: Tables, worlds: int, balls: int, point: bool) -> State:
    """Zeroed state for `worlds` worlds of `balls` balls each; `point` where the balls have no radius."""

    def sides(table: Array | None) -> Array | None:
        return None if table is None else np.zeros((worlds, balls, table.shape[1]), np.int8)

    return State(
        worlds=np.zeros(worlds, WORLD),
        balls=np.zeros((worlds, balls), BALL),
        paddles=None if tables.rails is None else np.zeros((worlds, tables.rails.shape[1]), PADDLE),
        zones=None if tables.rails is None else np.zeros((worlds, balls, tables.rails.shape[1]), ZONE),
        face_sides=sides(tables.faces) if point else None,
        sensor_sides=sides(tables.sensors),
        hits=np.zeros((worlds, tables.elements.shape[1]), np.int64),
    )


@function
def borrow_state(state: State) -> State:
    """The same state, borrowed; see `engine.jit.borrow`."""
    return State(
        borrow(state.worlds),
        borrow(state.balls),
        borrow(state.paddles),
        borrow(state.zones),
        borrow(state.face_sides),
        borrow(state.sensor_sides),
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
        borrow(tables.circles),
        borrow(tables.sensors),
        borrow(tables.rails),
    )
