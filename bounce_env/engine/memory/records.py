"""The records that scenes and worlds are made of, and the numbers that stand for kinds. Every field has 8 bytes."""

from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[Any]


def record(**fields: str) -> np.dtype[Any]:
    """Return a packed record type from names and formats."""
    # np.record gives attribute access with the compiler switched off, too.
    return np.dtype((np.record, np.dtype(list(fields.items()), align=True)))


SCENE = record(
    # How many rows of each table this scene uses.
    elements="i8", faces="i8", circles="i8", arcs="i8", sensors="i8", circle_sensors="i8", fields="i8", parts="i8",
    extent="f8",  # [m] the scale of round-off, see `packing.scene_extent`
    max_speed="f8",  # [m/s] inf where the scene has no cap
    rest_speed="f8",  # [m/s]
    ball_radius="f8", ball_b="f8",
)  # fmt: skip
ELEMENT = record(
    b="f8", f="f8",  # the ball's times the element's
    kick="f8", kick_threshold="f8",  # [m/s]
    cooldown="f8",  # [s]
)  # fmt: skip
BOX = {"left": "f8", "right": "f8", "below": "f8", "above": "f8"}  # [m] where the ball's centre is while it touches it
FACE = record(x="f8", y="f8", ux="f8", uy="f8", length="f8", offset_radius="f8", **BOX, element="i8")
CIRCLE = record(x="f8", y="f8", offset_radius="f8", element="i8")
ARC = record(
    x="f8", y="f8", outer="f8", inner="f8",  # [m] distances from the centre at which it is struck; inner 0: never
    sx="f8", sy="f8", ex="f8", ey="f8", span="i8",  # unit vectors to start and end; CLOSED, MINOR or MAJOR
    **BOX,
    element="i8",
)  # fmt: skip
SENSOR = record(x="f8", y="f8", ux="f8", uy="f8", length="f8", **BOX, drain="i8", element="i8")
CIRCLE_SENSOR = record(x="f8", y="f8", radius="f8", drain="i8", element="i8")  # a circular sensor
FIELD_EDGE = record(x="f8", y="f8", ux="f8", uy="f8", ax="f8", ay="f8", last="i8")  # of a field, which lies on its left
GRID = record(  # of cells, see `memory.cells`
    x="f8", y="f8", side="f8", inverse="f8", columns="i8", rows="i8",  # [m], 1 / side [1/m]
)  # fmt: skip
CELL_ENTRY = record(**BOX, number="i8")  # of a wall or circle in a cell
PART = record(  # what moves: a capsule that slides along its core or turns about (x, y), or a dragged wall
    x="f8", y="f8", ux="f8", uy="f8",  # [m] where it is at offset 0; unit vector along its core
    back="f8", front="f8",  # [m] where the core begins and ends along that vector
    radius="f8", offset_radius="f8",  # [m] about the core; the same plus the ball's
    span="f8", start="f8",  # [m or rad] from stop to stop, 0 of a dragged wall; offset after a reset
    up_speed="f8", down_speed="f8",  # [m/s or rad/s] the fastest either way
    shuttle="f8",  # [m/s] of a part that turns back at its stops: the speed at which it sets off; otherwise 0
    **BOX,  # of one that turns, wherever it is, and some more: its zone
    element="i8",
)  # fmt: skip
DRAG_LIMITS = record(  # of a dragged wall
    sx="f8", sy="f8", ex="f8", ey="f8",  # [m] where its start and its end are after a reset
    x0="f8", y0="f8", x1="f8", y1="f8",  # [m] the box in which they stay
    shortest="f8",  # [m] the length at which both stop
)  # fmt: skip
WORLD = record(
    time_hi="f8", time_lo="f8",
    scene="u8",
    bounces="i8", speed_capped="i8",  # counts since reset
    events="i8", events_before="i8",  # of the present call or step, and of those before it since reset
    drag_hi="f8", drag_lo="f8",  # when drag acted last
    dirty="i8",  # how often something was struck or crossed in the last step; 0: `hits` has no entries
)  # fmt: skip

# What a step without events reads comes first: it lies together in memory.
BALL = record(
    x="f8", y="f8", vx="f8", vy="f8", hi="f8", lo="f8",  # the last event: state and instant; the flight starts here
    ax="f8", ay="f8",  # acceleration in this flight: in contact what the wall leaves of gravity and fields
    next_hi="f8", next_lo="f8", next_kind="i8",  # the ball's next event
    status="i8",
    gx="f8", gy="f8",  # acceleration: gravity and fields
    contact="i8",  # the face that the ball slides on, FLYING, HELD, RIDING, ON_CURVE ...
    rides="i8",  # the part that carries it, sliding or held; otherwise -1
    support="i8",  # the element that it is in contact with, -1 in free flight
    settling="i8",  # SETTLES while the last bounces before a contact are summed, LEANS on balls, or 0
    nx="f8", ny="f8",  # normal of that contact, to the ball
    tolerance="f8",  # [m] what counts as touching at that instant
    touched="i8",  # how many surfaces it touched when it was last resolved
    confined="i8",  # how often it has bounced since it last flew any way to speak of, see BOUNCES_WITHOUT_ROOM
    hit_after="f8", hit_kind="i8", hit_index="i8",  # duration to the next hit of a standing element
    end_after="f8",  # duration after which nothing is met in this flight: that hit, or having left the scene
    sensor_after="f8", sensor_kind="i8", sensor_index="i8",
    zone_after="f8",  # duration to the next entry into or exit from a zone that a part can reach
    part_hi="f8", part_lo="f8", part_index="i8",  # next hit of a moving part, as far as its velocity is known
    struck="i8",  # the part that crushed it, or -1
)  # fmt: skip
CURVE_SLIDE = record(  # of a ball that slides on a circle or an arc, see `motion.curve_slide`
    x="f8", y="f8", radius="f8", down_x="f8", down_y="f8",
    sense="f8", swings="i8", complement="f8", lowest_speed="f8", rate="f8", phase="f8",
    ux="f8", uy="f8",  # [m/s] velocity of the curve
    facing="f8", arc="i8",  # 1.0 outside, -1.0 inside; the arc, or -1 of a circle
)  # fmt: skip
CARRIED = record(  # of a ball between a straight surface and a round one that pass by each other, see `motion.carried`
    x="f8", y="f8", ux="f8", uy="f8", radius="f8", mx="f8", my="f8",
    share="f8", rate="f8", turn="f8", least="f8",
    end="f8",  # [s] when one of the two no longer presses it, or ends
    sx="f8", sy="f8",  # [m/s] velocity of the straight one
    face="i8", arc="i8",  # the face and the arc of which they are; otherwise -1
)  # fmt: skip
TOUCH = record(
    nx="f8", ny="f8", ux="f8", uy="f8",  # unit normal to the ball, velocity of the surface [m/s]
    gap="f8",  # [m] to it: next to nothing, but for rounding
    curvature="f8",  # [1/m] curvature: 0 of a wall, > 0 where the ball is outside of a circle, < 0 inside
    along="f8", length="f8",  # [m] where on it the ball is, with the normal on its left; of an arc the ways to its ends
    cx="f8", cy="f8", radius="f8", arc="i8",  # of a curve: centre [m], radius of the path about it [m], the arc or -1
    least="f8",  # [m/s] the smallest rebound from a part, where there is one
    moves="i8",  # 1 of a part that turns or stretches: there is no closed form for a contact with it
    element="i8", face="i8", part="i8",  # the face of a wall's straight part, the part; otherwise -1
)  # fmt: skip
PAIR = record(  # of two balls
    hi="f8",
    lo="f8",  # when they hit each other while both keep to their flights
    pressed="i8",  # 1 while they are pressed on each other
)
CONTACT = record(  # between a ball and a surface, or another ball, of a cluster that is resolved
    one="i8",
    other="i8",  # the ball that the normal points to; the other ball, or -1
    nx="f8",
    ny="f8",
    ux="f8",
    uy="f8",  # unit normal; velocity of the surface [m/s]
    gap="f8",
    curvature="f8",  # [m], and [1/m] as in TOUCH; of two balls that of one of twice the radius
    least="f8",  # [m/s] the smallest rebound from what turns or stretches, otherwise 0
    target="f8",
    force="f8",  # what is projected onto n.x >= target, and the multiple of n that it takes
    keeps="i8",
    bears="f8",  # 1: n.x == target; the force per mass [m/s^2] that it takes to keep it closed
    slot="i8",  # its row among the active ones, or -1
    opposes="i8",  # 1 of one of those that nothing obeys together
    holds="i8",  # 1 of a surface whose friction stops what it presses
    element="i8",
    face="i8",
    part="i8",
)
MEMBER = record(  # what a ball among others has beside BALL
    meets="i8",
    strayed="f8",  # hits of other balls without room, and the way [m] since: see ROOM_TO_MEET
    doomed="i8",  # 1: the part that it is `struck` by crushes it at its next event, see `contact.cluster`
    # Of the cluster that is resolved:
    inside="i8",  # 0: it is not of the cluster
    fixed="i8",  # 1: nothing moves it
    hits="i8",  # 1: it closes fast on a surface
    x="f8",
    y="f8",
    x0="f8",
    y0="f8",  # what is projected, and what it was before
    leans="i8",
    awake="i8",  # 1: pressed on another ball; such a one, or one that it moves with, is not at rest
)
ACTIVE = record(  # a row of the active set of a projection
    contact="i8", product="f8", step="f8",
    was="i8", force="f8",  # the contact in this row before the last one was added, and its force
)  # fmt: skip
COOLING = record(hi="f8", lo="f8")  # until when an element gives no kick
ZONE = record(inside="i8", after="f8")  # whether the ball is where a part can reach, and when that changes
MOTION = record(  # of a part, at the instant of its last command or stop
    # [m, m/s] along the rail, or [rad, rad/s] of the stroke; of a dragged wall that moves the time to its next stop,
    # [s] below 0, and 1
    offset="f8", velocity="f8", hi="f8", lo="f8",
    command="f8",  # as asked for; `velocity` is 0 where a stop or a crushed ball holds the part against it
)  # fmt: skip
ENDS = record(  # of a dragged wall, at the instant of its last command or stop
    x0="f8", y0="f8", x1="f8", y1="f8", vx0="f8", vy0="f8", vx1="f8", vy1="f8",  # [m], [m/s]
    cx0="f8", cy0="f8", cx1="f8", cy1="f8",  # [m/s] as asked for
)  # fmt: skip
LEDGER = record(
    time="f8", ball="i8", element="i8", kind="i8", x="f8", y="f8", nx="f8", ny="f8",
    vx0="f8", vy0="f8", vx1="f8", vy1="f8", ux="f8", uy="f8",
)  # fmt: skip
"""The columns of a ledger: `World.advance` explains them."""

RECORDING = record(
    world="i8",  # that is recorded, or NO_WORLD
    rows="i8", moments="i8", lost="i8",  # of the ledger and of the moments in use; how many found no room
)  # fmt: skip
MOMENT = record(hi="f8", lo="f8", rows="i8")  # an instant, as a sum of two floats [s]; rows of the ledger up to it
NO_WORLD = -1

# Surfaces that one ball can touch at one instant; more than these are not seen.
TOUCHES = 16

# Elements struck in a step of which a list is kept; where there are more, all of them are gone through.
STRUCK = 8

# Contacts of a cluster, by the number of its balls: in the plane no ball touches more than six others.
CONTACTS_OF_BALL = 8


class Status(IntEnum):
    """How a ball is after a call; docs/physics.md, "Order, budget, status".

    - OK (0): in play, at the time that was asked for.
    - BUDGET (1): in play, but the call ran out of events: the next one goes on from the last event.
    - CRUSHED (2): caught between a closing part and what opposes it; both stand until a command moves the part away
      (docs/physics.md, "Crushed").
    - OUT (3): out of play: it has crossed a drain.
    """

    OK = 0
    BUDGET = 1
    CRUSHED = 2
    OUT = 3


class Counts(NamedTuple):
    """How much has happened since `reset`; of a batch each member has shape (worlds,)."""

    events: Any
    """All that is planned for: bounces, ends of contacts, sensors crossed, stops of parts."""
    bounces: Any
    speed_capped: Any
    """Bounces that `max_speed` has slowed down."""


class EventKind(IntEnum):
    """What a row of the ledger tells of; docs/physics.md, "Ledger".

    - BOUNCE (0): a ball bounced from an element, or from another ball.
    - CONTACT_BEGINS (1): from now on the ball slides or rests on the element.
    - CONTACT_ENDS (2): it no longer does.
    - SENSOR (3): the ball's centre crossed a sensor.
    - PART_STOPS (4): a part came to a stop, turned back, or was blocked; `ball` is -1.
    - CRUSHED (5): a closing part crushed the ball.
    - ABSORBED (6): as a bounce, of balls that lie on each other: too slow to rebound.
    - CORNER_BOUNCE (7): an element's share in a bounce from several of them at once.
    """

    BOUNCE = 0
    CONTACT_BEGINS = 1
    CONTACT_ENDS = 2
    SENSOR = 3
    PART_STOPS = 4
    CRUSHED = 5
    ABSORBED = 6
    CORNER_BOUNCE = 7

    @property
    def words(self) -> str:
        """Return the kind as people read it: part stops."""
        return self.name.lower().replace("_", " ")


OK, BUDGET, CRUSHED, OUT = map(int, Status)
"""The members of `Status` as plain numbers, for kernels: OUT is that of a ball that has crossed a drain."""

BOUNCE, CONTACT_BEGINS, CONTACT_ENDS, CROSSING, PART_STOPS, CRUSH, ABSORBED, CORNER_BOUNCE = map(int, EventKind)


# Kinds of standing obstacles.
ON_FACE, ON_CIRCLE, ON_ARC, OFF_END, RESOLVE, OFF_PART, OFF_CURVE, ON_JOINT = 0, 1, 2, 3, 4, 5, 6, 7

# Kinds of sensors.
LINE_SENSOR, CIRCLE_ENTRY, FIELD_BORDER = 0, 1, 2

# Spans of arcs: 2 pi, up to pi, more.
CLOSED, MINOR, MAJOR = 0, 1, 2

# `contact` of a ball that is in flight, of one that rests, of one that slides on a part, on a circle or arc, of one
# that other balls bear, and no straight surface, and of one that a straight surface and a round one carry between them.
FLYING, HELD, RIDING, ON_CURVE, ON_BALLS, CARRIED_ALONG = -1, -2, -3, -4, -5, -6

# `settling`
SETTLES, LEANS = 1, 2

# Kinds of a ball's next event.
NEXT_HIT, NEXT_PART, NEXT_SENSOR, NEXT_ZONE = 0, 1, 2, 3
