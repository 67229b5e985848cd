"""Features: what a scene has that kernels are compiled with, or without where no scene of a batch has it."""

from collections.abc import Iterable, Iterator
from enum import StrEnum

from bounce_env.scene.elements import Arc, Bumper, Element, Flipper, Wall, moves
from bounce_env.scene.regions import Field, Sensor
from bounce_env.wording import shown, unknown_name


class Feature(StrEnum):
    """What costs time, memory and compiling only where it is there; docs/architecture.md says how it is left out.

    Numbers cost nothing of this kind: `b`, `f`, kicks, `rest_speed` and `max_speed` are read at run time.

    - BALL_RADIUS: a disc; a point has sides of walls instead
    - GRAVITY
    - WALLS: that stand
    - ONE_WAY_WALLS
    - CIRCLES: bumpers that stand, and for a disc the ends of walls and arcs
    - ARCS
    - CELLS: so many walls and circles that a flight does not ask them all
    - CURVED_CONTACT: something round that can hold a ball: it slides there
    - LINE_SENSORS
    - CIRCLE_SENSORS
    - FIELDS
    - MOVING_PARTS: paddles, flippers, moving bumpers, draggable walls
    - FLIPPERS
    - DRAGGED_WALLS
    - DRAG
    - COOLDOWN
    - SEVERAL_BALLS: discs; points do not meet
    - SWITCHES: elements can be switched off
    """

    BALL_RADIUS = "ball_radius"
    GRAVITY = "gravity"
    WALLS = "walls"
    ONE_WAY_WALLS = "one_way_walls"
    CIRCLES = "circles"
    ARCS = "arcs"
    CELLS = "cells"
    CURVED_CONTACT = "curved_contact"
    LINE_SENSORS = "line_sensors"
    CIRCLE_SENSORS = "circle_sensors"
    FIELDS = "fields"
    MOVING_PARTS = "moving_parts"
    FLIPPERS = "flippers"
    DRAGGED_WALLS = "dragged_walls"
    DRAG = "drag"
    COOLDOWN = "cooldown"
    SEVERAL_BALLS = "several_balls"
    SWITCHES = "switches"


ALL_FEATURES = frozenset(Feature) - {Feature.BALL_RADIUS}
"""All that can be forced on: with these every scene runs on one kernel for discs and one for points."""

MOST_WITHOUT_CELLS = 256
"""Walls and circles that stand, of a scene of which they are all asked."""

ALL_FOR_ONE_BALL = ALL_FEATURES - {Feature.SEVERAL_BALLS}
"""The same where no scene is played with several balls: what lets balls lie on each other doubles the compiling."""

_BRING = {
    Feature.ONE_WAY_WALLS: (Feature.WALLS,),
    Feature.FIELDS: (Feature.GRAVITY,),
    Feature.FLIPPERS: (Feature.MOVING_PARTS,),
    Feature.DRAGGED_WALLS: (Feature.MOVING_PARTS,),
}


def with_what_they_bring(features: Iterable[Feature]) -> frozenset[Feature]:
    """Return the features and those that they cannot do without."""
    given = frozenset(features)
    return given.union(*(_BRING.get(feature, ()) for feature in given))


def features_of(
    gravity: tuple[float, float], ball_radius: float, drag: float, elements: Iterable[Element]
) -> frozenset[Feature]:
    """Return the features of a scene of these."""
    disc = ball_radius > 0.0
    found = {feature for element in elements for feature in _of_element(element, disc)}
    found |= {Feature.BALL_RADIUS} if disc else set()
    found |= {Feature.GRAVITY} if any(gravity) else set()
    found |= {Feature.DRAG} if drag < 1.0 else set()
    shapes = sum(_standing_shapes(element, disc) for element in elements)
    found |= {Feature.CELLS} if shapes > MOST_WITHOUT_CELLS else set()
    present = with_what_they_bring(found)
    # Without gravity only the inside of an arc holds a ball.
    round_outside = Feature.CIRCLES in present or any(moves(e) and (disc or not isinstance(e, Wall)) for e in elements)
    if Feature.ARCS in present or (Feature.GRAVITY in present and round_outside):
        present |= {Feature.CURVED_CONTACT}
    return present


def _standing_shapes(element: Element, disc: bool) -> int:
    """Return how many walls and circles an element is: for a disc each end is one, which others may share."""
    match element:
        case Wall() if not moves(element):
            return 3 if disc and not element.one_way else 1
        case Arc() if disc and not element.closed:
            return 2
        case Bumper() if not moves(element):
            return 1
    return 0


def _of_element(element: Element, disc: bool) -> Iterator[Feature]:
    match element:
        case Field():
            yield Feature.FIELDS
        case Sensor():
            yield Feature.LINE_SENSORS if element.circle is None else Feature.CIRCLE_SENSORS
        case Flipper():
            yield Feature.FLIPPERS
        case Wall() if moves(element):
            yield Feature.DRAGGED_WALLS
        case Wall():
            yield Feature.ONE_WAY_WALLS if element.one_way else Feature.WALLS
            if disc and not element.one_way:
                yield Feature.CIRCLES
        case Arc():
            yield Feature.ARCS
            if disc and not element.closed:
                yield Feature.CIRCLES
        case Bumper() if not moves(element):
            yield Feature.CIRCLES
        case _:
            yield Feature.MOVING_PARTS
    if not isinstance(element, Sensor | Field) and element.cooldown > 0.0:
        yield Feature.COOLDOWN


def checked_features(features: Iterable[str]) -> frozenset[Feature]:
    """Return features that can be forced on a world, by their names.

    Raises ValueError for an unknown name, and for `ball_radius`: a scene has points or discs.
    """
    if isinstance(features, str):
        raise ValueError(f"features = {shown(features)}: must be a set of names, as ALL_FEATURES")
    found, known = set(), sorted(map(str, ALL_FEATURES))
    for name in features:
        if name not in ALL_FEATURES:
            raise ValueError(f"features: {shown(name)}: {unknown_name(name, known, 'feature')}")
        found.add(Feature(name))
    return with_what_they_bring(found)
