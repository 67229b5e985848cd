"""Pack validated scenes into the state that kernels read. Uses sqrt only: the same bits on every machine."""

import math
from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any

import numpy as np

from bounce_env.engine.compile.jit import from_python
from bounce_env.engine.memory.cells import Cells, Grid, cells_of, padded_cells
from bounce_env.engine.memory.records import (
    ARC,
    CIRCLE,
    CIRCLE_SENSOR,
    CLOSED,
    DRAG_LIMITS,
    ELEMENT,
    FACE,
    FIELD_EDGE,
    MAJOR,
    MINOR,
    PART,
    SCENE,
    SENSOR,
    Array,
)
from bounce_env.engine.memory.state import State, new_state
from bounce_env.engine.motion.sincos import sin_cos as compiled_sin_cos
from bounce_env.engine.tolerances import ZONE_MARGIN
from bounce_env.scene import Arc, Bumper, Feature, Field, Flipper, Part, Scene, Sensor, Wall, moves
from bounce_env.scene.features import checked_features

sin_cos = from_python(compiled_sin_cos)
Row = tuple[float, ...]
Point = tuple[float, float]

_NO_CELLS = {"grids": None, "cell_starts": None, "cell_circles": None, "cell_entries": None}
_NO_BOX = (0.0, 0.0, 0.0, 0.0)
_ANGLE_MARGIN = 1e-9  # in a box an angle is taken to be reached that is missed by so little [rad, or turns]


def pack(
    scenes: Sequence[Scene],
    worlds: int = 1,
    balls: int = 1,
    *,
    features: frozenset[Feature] = frozenset(),
    own_rows: bool = False,
) -> State:
    """Return the state of a batch whose worlds play `scenes`; a feature that none of them has is left out.

    features: forced on besides. own_rows: each world has a row of every table for itself, all of them of the one scene.
    Raises ValueError when some scenes have point balls and others discs: those are different kernels.
    """
    present = features_of_worlds(scenes, balls) | features
    if own_rows:  # who moves what stands would have to sort it anew
        present -= {Feature.CELLS}
    tables = _packed_tables(scenes, present)
    if own_rows:
        tables = {name: None if t is None else np.repeat(t, worlds, axis=0) for name, t in tables.items()}
    state = new_state(tables, worlds, balls, present)
    if own_rows:
        state.worlds["scene"] = np.arange(worlds)
    return state


def features_of_worlds(scenes: Sequence[Scene], balls: int) -> frozenset[Feature]:
    """Return the features of worlds with so many balls: those that any of the scenes has, and of several balls."""
    if len({scene.ball.radius == 0.0 for scene in scenes}) > 1:
        raise ValueError("scenes of one batch must all have a ball of radius 0, or all of radius > 0")
    present = frozenset[Feature]().union(*(scene.features for scene in scenes))
    if balls > 1 and Feature.BALL_RADIUS in present:
        present |= {Feature.SEVERAL_BALLS}
        if Feature.ARCS in present:
            # Balls that lie on each other inside of an arc are accelerated by that alone.
            present |= {Feature.GRAVITY}
    return present


def forced_features(scene: Scene, names: Iterable[str]) -> frozenset[Feature]:
    """Return the features to force on worlds of a scene, by their names; points do not meet whatever is asked for."""
    forced = checked_features(names)
    return forced if scene.ball.radius > 0.0 else forced - {Feature.SEVERAL_BALLS}


def _packed_tables(scenes: Sequence[Scene], present: frozenset[Feature]) -> dict[str, Array | None]:
    """Return the tables of the scenes, by their names in `State`; None for a feature that is not present."""
    row_makers = {
        Feature.WALLS: ("faces", FACE, _pack_faces),
        Feature.CIRCLES: ("circles", CIRCLE, _pack_circles),
        Feature.ARCS: ("arcs", ARC, _pack_arcs),
        Feature.LINE_SENSORS: ("sensors", SENSOR, _pack_sensors),
        Feature.CIRCLE_SENSORS: ("circle_sensors", CIRCLE_SENSOR, _pack_circle_sensors),
        Feature.FIELDS: ("field_edges", FIELD_EDGE, _pack_field_edges),
        Feature.MOVING_PARTS: ("parts", PART, _pack_parts),
    }
    heads = [
        (
            len(s.elements),
            *(len(rows_of(s)) for _, _, rows_of in row_makers.values()),
            scene_extent(s),
            _max_speed(s),
            s.rest_speed,
            s.ball.radius,
            s.ball.b,
        )
        for s in scenes
    ]
    others: dict[Feature, tuple[str, Callable[[], Array]]] = {
        Feature.GRAVITY: ("gravity", lambda: np.array([scene.gravity for scene in scenes], np.float64)),
        Feature.ONE_WAY_WALLS: ("one_way", lambda: _pack_one_way(scenes)),
        Feature.FLIPPERS: ("turns", lambda: _pack_turns(scenes)),
        Feature.DRAGGED_WALLS: ("drag_limits", lambda: _pack_drag_limits(scenes)),
        Feature.DRAG: ("drags", lambda: np.array([scene.drag for scene in scenes])),
    }
    return {
        "scenes": np.array(heads, SCENE),
        "elements": _padded_table(ELEMENT, scenes, _pack_materials),
        **{
            name: _padded_table(dtype, scenes, rows_of) if feature in present else None
            for feature, (name, dtype, rows_of) in row_makers.items()
        },
        **{name: table() if feature in present else None for feature, (name, table) in others.items()},
        **(padded_cells([_cells(scene) for scene in scenes]) if Feature.CELLS in present else _NO_CELLS),
    }


def _cells(scene: Scene, disabled: Collection[int] = (), grid: Grid | None = None) -> Cells:
    faces, circles = np.array(_pack_faces(scene), FACE), np.array(_pack_circles(scene, disabled), CIRCLE)
    return cells_of(faces, circles, scene_extent(scene), grid)


def scene_extent(scene: Scene) -> float:
    """Return the scale of round-off [m]: the largest coordinate that the elements occupy plus the ball's radius.

    Rounded up to a power of two, so that no digit of it depends on how a bounding box was computed.
    """
    largest = max(abs(c) for c in scene.bounds)
    # Distances to an arc are taken from its centre, which may lie far outside of what it occupies.
    circles = (max(map(abs, e.center)) + e.radius for e in scene.elements if isinstance(e, Arc))
    largest = max(largest, *circles, 0.0) + scene.ball.radius
    return math.ldexp(1.0, math.frexp(largest)[1])


def segment_direction(start: Point, end: Point) -> tuple[float, float, float]:
    """Unit vector and length [m] of a segment. Scaled first, so that no square under- or overflows."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    scale = max(abs(dx), abs(dy))
    dx, dy = dx / scale, dy / scale
    length = math.sqrt(dx * dx + dy * dy)
    return dx / length, dy / length, length * scale


def _padded_table(dtype: np.dtype[Any], scenes: Sequence[Scene], rows_of: Callable[[Scene], list[Row]]) -> Array:
    rows = [rows_of(scene) for scene in scenes]
    table = np.zeros((len(scenes), max(map(len, rows))), dtype)
    for s, scene_rows in enumerate(rows):
        for i, row in enumerate(scene_rows):
            table[s, i] = row
    return table


def _max_speed(scene: Scene) -> float:
    return math.inf if scene.max_speed is None else scene.max_speed


def _pack_materials(scene: Scene) -> list[Row]:
    ball = scene.ball
    return [
        (0.0, 0.0, 0.0, 0.0, 0.0)
        if isinstance(e, Sensor | Field)
        else (ball.b * e.b, ball.f * e.f, e.kick, e.kick_threshold, e.cooldown)
        for e in scene.elements
    ]


def _standing_walls(scene: Scene) -> Iterable[tuple[int, Wall]]:
    """Return the walls that stand."""
    return ((i, e) for i, e in enumerate(scene.elements) if isinstance(e, Wall) and not moves(e))


def _pack_faces(scene: Scene) -> list[Row]:
    r = scene.ball.radius
    return [
        (*w.start, *segment_direction(w.start, w.end), r, *_box_around((w.start, w.end), r), i)
        for i, w in _standing_walls(scene)
    ]


def _box_around(points: Iterable[Point], radius: float = 0.0) -> Row:
    """Return a BOX around points, wider by a radius [m]."""
    xs, ys = zip(*points, strict=True)
    return min(xs) - radius, max(xs) + radius, min(ys) - radius, max(ys) + radius


def _pack_one_way(scenes: Sequence[Scene]) -> Array:
    """Return which faces belong to one-way walls."""
    flags = [[wall.one_way for _, wall in _standing_walls(scene)] for scene in scenes]
    one_way = np.zeros((len(scenes), max(map(len, flags))), np.int8)
    for s, row in enumerate(flags):
        one_way[s, : len(row)] = row
    return one_way


def switch_round_ends(state: State, scene: Scene, disabled: Collection[int]) -> None:
    """Let the round ends in the tables of one scene be those of the elements that are not `disabled` (indices)."""
    if state.circles is None:
        return
    rows = _pack_circles(scene, disabled)
    state.circles[0, : len(rows)] = rows
    state.scenes[0]["circles"] = len(rows)
    if state.grids is not None:
        cells = _cells(scene, disabled, state.grids[0].item())
        state.cell_starts[0, : len(cells.starts)], state.cell_circles[0, : len(cells.circles)] = cells[1:3]
        state.cell_entries[0, : len(cells.entries)] = cells.entries


def _pack_circles(scene: Scene, disabled: Collection[int] = ()) -> list[Row]:
    radius = scene.ball.radius
    rows: list[Row] = [
        (*e.center, e.radius + radius, i)
        for i, e in enumerate(scene.elements)
        if isinstance(e, Bumper) and not moves(e)
    ]
    if radius > 0.0:
        rows += _pack_round_ends(scene, disabled)
    return rows


def _pack_round_ends(scene: Scene, disabled: Collection[int]) -> list[Row]:
    """Return the round ends of walls and arcs. Of several at one point the first is kept: at a tie it is struck."""
    owner: dict[Point, int] = {}
    for i, element in enumerate(scene.elements):
        if i in disabled:
            continue
        for point in _end_points(element):
            owner.setdefault(point, i)
    return [(*point, scene.ball.radius, i) for point, i in owner.items()]


def _end_points(element: object) -> tuple[Point, ...]:
    if isinstance(element, Wall) and not (element.one_way or moves(element)):
        return element.start, element.end
    if isinstance(element, Arc) and not element.closed:
        (x, y), r = element.center, element.radius
        angles = (element.start_angle, element.end_angle)
        return tuple((x + r * c, y + r * s) for s, c in map(sin_cos, angles))
    return ()


def _pack_arcs(scene: Scene) -> list[Row]:
    rows: list[Row] = []
    radius = scene.ball.radius
    for i, arc in enumerate(scene.elements):
        if isinstance(arc, Arc):
            (sin_start, cos_start), (sin_end, cos_end) = sin_cos(arc.start_angle), sin_cos(arc.end_angle)
            span = MINOR if arc.end_angle - arc.start_angle <= math.pi else MAJOR
            reaches = (arc.radius + radius, max(arc.radius - radius, 0.0))
            span = CLOSED if arc.closed else span
            ends = (cos_start, sin_start), (cos_end, sin_end)
            rows.append((*arc.center, *reaches, *ends[0], *ends[1], span, *_arc_box(arc, reaches, ends), i))
    return rows


def _arc_box(arc: Arc, reaches: tuple[float, float], ends: tuple[Point, Point]) -> Row:
    """Return the BOX of an arc: of its ends at both distances, and of where it is furthest along an axis."""
    (x, y), (outer, inner) = arc.center, reaches
    near = [(x + inner * c, y + inner * s) for c, s in ends]
    far = [(x + outer * c, y + outer * s) for c, s in ends]
    return _box_around([*near, *far, *_furthest_points(arc.center, outer, arc.start_angle, arc.end_angle)])


def _furthest_points(center: Point, radius: float, low: float, high: float) -> Iterable[Point]:
    """Return where a circle is furthest along an axis, of the angles [rad] from `low` to `high`."""
    x, y = center
    for quarter, (c, s) in enumerate(((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))):
        angle = 0.5 * math.pi * quarter
        turns = math.ceil((low - angle) / (2.0 * math.pi) - _ANGLE_MARGIN)
        if angle + 2.0 * math.pi * turns <= high + _ANGLE_MARGIN:
            yield x + radius * c, y + radius * s


def _pack_sensors(scene: Scene) -> list[Row]:
    return [
        (*e.segment[0], *segment_direction(*e.segment), *_box_around(e.segment), int(e.drain), i)
        for i, e in enumerate(scene.elements)
        if isinstance(e, Sensor) and e.segment is not None
    ]


def _pack_circle_sensors(scene: Scene) -> list[Row]:
    return [
        (*e.circle[0], e.circle[1], int(e.drain), i)
        for i, e in enumerate(scene.elements)
        if isinstance(e, Sensor) and e.circle is not None
    ]


def _pack_field_edges(scene: Scene) -> list[Row]:
    """Return the border lines of the fields, counter-clockwise; `last` is 1 on the last edge of each field."""
    rows: list[Row] = []
    for field in scene.elements:
        if isinstance(field, Field):
            points = field.points if _is_counter_clockwise(field.points) else tuple(reversed(field.points))
            for k, point in enumerate(points):
                ux, uy, _ = segment_direction(point, points[(k + 1) % len(points)])
                rows.append((*point, ux, uy, *field.acceleration, int(k + 1 == len(points))))
    return rows


def _is_counter_clockwise(points: Sequence[Point]) -> bool:
    (ax, ay), (bx, by), (cx, cy) = points[:3]
    return (bx - ax) * (cy - by) > (by - ay) * (cx - bx)


def _pack_parts(scene: Scene) -> list[Row]:
    return [(*_pack_part(e, scene.ball.radius), i) for i, e in scene.parts]


def _pack_part(e: Part, ball_radius: float) -> Row:
    """Return a PART but for the index of its element."""
    if isinstance(e, Wall):
        ux, uy, length = segment_direction(e.start, e.end)
        return (*e.start, ux, uy, 0.0, length, 0.0, ball_radius, 0.0, 0.0, 0.0, 0.0, 0.0, *_NO_BOX)
    thick = (e.radius, e.radius + ball_radius)
    if isinstance(e, Flipper):
        s, c = sin_cos(e.rest_angle)
        stroke = abs(e.active_angle - e.rest_angle)
        box = _flipper_box(e, thick[1])
        return (*e.pivot, c, s, 0.0, e.length, *thick, stroke, 0.0, e.up_speed, e.down_speed, 0.0, *box)
    if isinstance(e, Bumper):
        assert e.rail_end is not None
        ux, uy, span = segment_direction(e.center, e.rail_end)
        return (*e.center, ux, uy, 0.0, 0.0, *thick, span, 0.0, e.speed, e.speed, e.speed, *_NO_BOX)
    ux, uy, span = segment_direction(e.rail_start, e.rail_end)
    shape = (-e.half_width, e.half_width, *thick)
    return (*e.rail_start, ux, uy, *shape, span, 0.5 * span, e.max_speed, e.max_speed, 0.0, *_NO_BOX)


def _flipper_box(flipper: Flipper, offset_radius: float) -> Row:
    """Return the zone of a flipper: a box around all places that it can be in, wider by some of its length."""
    (x, y), length = flipper.pivot, flipper.length
    low, high = sorted((flipper.rest_angle, flipper.active_angle))
    ends = [(x + length * c, y + length * s) for s, c in map(sin_cos, (low, high))]
    furthest = _furthest_points(flipper.pivot, length, low, high)
    return _box_around([flipper.pivot, *ends, *furthest], offset_radius + ZONE_MARGIN * (length + offset_radius))


def _pack_turns(scenes: Sequence[Scene]) -> Array:
    """Return which way each part turns: 1, -1, or 0 for one that slides."""
    signs = [
        [(1 if e.active_angle > e.rest_angle else -1) if isinstance(e, Flipper) else 0 for _, e in scene.parts]
        for scene in scenes
    ]
    turns = np.zeros((len(scenes), max(map(len, signs))), np.int8)
    for s, row in enumerate(signs):
        turns[s, : len(row)] = row
    return turns


def _pack_drag_limits(scenes: Sequence[Scene]) -> Array:
    """Return what bounds the way of each dragged wall, by part."""
    drag_limits = np.zeros((len(scenes), max(len(scene.parts) for scene in scenes)), DRAG_LIMITS)
    for s, scene in enumerate(scenes):
        side = scene_extent(scene)
        for m, (_, e) in enumerate(scene.parts):
            if isinstance(e, Wall):
                low, high = e.reach or ((-side, -side), (side, side))
                drag_limits[s, m] = (*e.start, *e.end, *low, *high, e.shortest)
    return drag_limits
