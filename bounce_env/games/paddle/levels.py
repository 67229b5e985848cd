"""Levels of the paddle game: the bumpers of a scene, each level with them in other places.

A level is a number; where its bumpers are follows from the number alone. In a batch each world has a row of the tables
for itself, into which the kernel writes the level's bumpers when an episode begins: levels cost nothing while they are
played, there may be as many as there are numbers, and one kernel plays them side by side.
"""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from bounce_env.engine.compile.jit import Record, from_python, function, where
from bounce_env.engine.memory.records import Array, record
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.readout import offset_now
from bounce_env.games.observed import Observed, place_of, velocity_of
from bounce_env.games.options import END_OF_LEVELS
from bounce_env.games.playfield import place_seen
from bounce_env.games.streams import LAYOUTS, LEVELS, uniform
from bounce_env.scene import Bumper, Scene, moves

MOVING_FROM = 10
"""Below this level the bumpers on rails stand still."""

RAIL = (0.1, 0.3)  # of a field's width: how far a bumper travels
SPEED = (0.1, 0.4)  # m/s, of its way
LOWEST = 0.48  # of a field's height: the lowest that a bumper's centre may be, well above where a ball is launched
GAP = 2.5  # ball radii between two bumpers and to the walls, so that a ball always passes
FASTEST = SPEED[1]  # m/s; the speed of a bumper that is observed as 1
NONE = -1  # levels
TRIES = 16  # places for each bumper, until a layout is given up
NUMBERS = 5  # that are drawn for one

# Layouts that may be begun for a level: of a scene that may have levels, few must do; then many always do.
FEW, MANY = 4, 1_000_000

BUMPER = record(
    x0="f8", y0="f8", x1="f8", y1="f8",  # [m] its centre's way there and back, which is parallel to an axis
    speed="f8",  # [m/s]
    radius="f8",  # [m]
    circle="i8", part="i8",  # its row among the circles, or the parts; otherwise -1
)  # fmt: skip


class Levels(NamedTuple):
    """What the kernel needs to know of the levels."""

    bumpers: Array  # (scenes, n) BUMPER: those an agent is told of
    area: Array  # (4,) x_min, y_min, x_max, y_max [m] of the field: where bumpers may be, but for their size
    gap: float  # [m] between bumpers and to the walls
    number: int  # how many levels there are, 0 for all; NONE: the bumpers stay where the scene has them
    first: int  # the number of the first


def levels_of(scene: Scene, field: tuple[float, float, float, float], count: int | None, first: int) -> Levels:
    """Return of a scene, for one world; without levels (`count` None) an agent is told only of bumpers that move.

    field: lower left corner and size (x, y, width, height) [m]. Raises ValueError where a scene cannot have levels.
    """
    still = [e for e in scene.elements if isinstance(e, Bumper) and not moves(e)]
    parts = [e for _, e in scene.parts]
    told = [e for e in scene.elements if isinstance(e, Bumper) and (count is not None or moves(e))]
    rows = []
    for bumper in told:
        circle, part = (-1, parts.index(bumper)) if moves(bumper) else (still.index(bumper), -1)
        way = (*bumper.center, *(bumper.rail_end or bumper.center))
        rows.append((*way, bumper.speed, bumper.radius, circle, part))
    bumpers = np.array(rows, BUMPER)[None]
    x, y, width, height = field
    if count is not None and scene.max_speed is not None and scene.max_speed <= SPEED[1]:
        raise ValueError(f"max_speed = {scene.max_speed!r}: must be > {SPEED[1]}, the fastest of a level's bumpers")
    area = np.array((x, y + LOWEST * height, x + width, y + height))
    levels = Levels(bumpers, area, GAP * scene.ball.radius, NONE if count is None else count, first)
    if count is not None:
        _check(levels)
    return levels


def _check(levels: Levels) -> None:
    if not all(_arranged(levels.bumpers.copy(), levels, 0, level, FEW) for level in range(20)):
        raise ValueError(
            f"num_levels = {levels.number}: a scene for levels must have fewer or smaller bumpers, so that they can be "
            f"arranged anew in the upper half of the field with gaps of {levels.gap:g} m"
        )


def level_scene(scene: Scene, levels: Levels, level: int) -> Scene:
    """Return the scene of a level: `scene` with its bumpers where the kernel puts them."""
    bumpers = levels.bumpers[:1].copy()
    _arranged(bumpers, levels, 0, level, MANY)
    rows = iter(bumpers[0])
    elements = tuple(_moved(e, next(rows)) if isinstance(e, Bumper) else e for e in scene.elements)
    return replace(scene, elements=elements)


def _moved(bumper: Bumper, row: Any) -> Bumper:
    x0, y0, x1, y1, speed = (float(row[name]) for name in ("x0", "y0", "x1", "y1", "speed"))
    if not moves(bumper):
        return replace(bumper, center=(x0, y0))
    return replace(bumper, center=(x0, y0), rail_end=(x1, y1), speed=speed)


@function
def drawn_level(levels: Levels, seed: Any) -> int:
    """Return the level of the episode with this seed: each as likely."""
    count = levels.number if levels.number > 0 else END_OF_LEVELS - levels.first
    return levels.first + int(uniform(seed, LEVELS, 0) * count)


@function
def enter_level(levels: Levels, state: State, scene: int, level: int) -> None:
    """Write the bumpers of a level into the tables of a scene."""
    arrange(levels.bumpers, levels, scene, level, MANY)
    for j in range(levels.bumpers.shape[1]):
        bumper = levels.bumpers[scene, j]
        _put_circle(state, scene, bumper)
        _put_part(state, scene, bumper)


@where("circles")
def _put_circle(state: State, scene: int, bumper: Record) -> None:
    if bumper.circle >= 0:
        circle = state.circles[scene, bumper.circle]
        circle.x, circle.y = bumper.x0, bumper.y0


@where("parts")
def _put_part(state: State, scene: int, bumper: Record) -> None:
    if bumper.part >= 0:
        part = state.parts[scene, bumper.part]
        dx, dy = bumper.x1 - bumper.x0, bumper.y1 - bumper.y0
        part.x, part.y, part.span = bumper.x0, bumper.y0, abs(dx) + abs(dy)  # one of them is 0
        part.ux, part.uy = dx / part.span, dy / part.span
        part.up_speed = part.down_speed = part.shuttle = bumper.speed


@function
def arrange(bumpers: Array, levels: Levels, scene: int, level: int, layouts: int) -> bool:
    """Find places for the bumpers of a level; False where so many layouts were begun in vain."""
    count = bumpers.shape[1]
    index = 0
    for _ in range(layouts):
        placed = 0
        for _ in range(TRIES * count):
            if placed == count:
                return True
            _throw(bumpers[scene, placed], levels, level, index)
            index += NUMBERS
            placed += _fits(bumpers, levels, scene, placed)
    return False


@function
def _throw(bumper: Record, levels: Levels, level: int, index: int) -> None:
    """Put a bumper anywhere in the area."""
    seed = np.uint64(level)
    inset = bumper.radius + levels.gap
    width = levels.area[2] - levels.area[0]
    bumper.x0 = levels.area[0] + inset + (width - 2.0 * inset) * uniform(seed, LAYOUTS, index)
    height = levels.area[3] - inset - levels.area[1]
    bumper.y0 = levels.area[1] + height * uniform(seed, LAYOUTS, index + 1)
    bumper.x1, bumper.y1, bumper.speed = bumper.x0, bumper.y0, 0.0
    if bumper.part >= 0:
        way = (RAIL[0] + (RAIL[1] - RAIL[0]) * uniform(seed, LAYOUTS, index + 2)) * width
        if uniform(seed, LAYOUTS, index + 3) < 0.5:
            bumper.x1 += way
        else:
            bumper.y1 += way
        if level >= MOVING_FROM:
            bumper.speed = SPEED[0] + (SPEED[1] - SPEED[0]) * uniform(seed, LAYOUTS, index + 4)


@function
def _fits(bumpers: Array, levels: Levels, scene: int, placed: int) -> bool:
    """Return whether a bumper's way keeps clear of the walls and of the bumpers that are placed already."""
    bumper = bumpers[scene, placed]
    inset = bumper.radius + levels.gap
    if bumper.x1 > levels.area[2] - inset or bumper.y1 > levels.area[3] - inset:
        return False
    for j in range(placed):
        other = bumpers[scene, j]
        dx = max(bumper.x0 - other.x1, other.x0 - bumper.x1, 0.0)
        dy = max(bumper.y0 - other.y1, other.y0 - bumper.y1, 0.0)
        least = bumper.radius + other.radius + levels.gap
        if dx * dx + dy * dy < least * least:
            return False
    return True


_arranged = from_python(arrange)


FIELD_ENDS = ("left wall", "right wall", "drain", "top")
"""What is at -1 and 1 along x and along y, as places are observed."""


def observed_bumpers(levels: Levels) -> tuple[Observed, ...]:
    """Return what each number of `observe_bumpers` is."""
    fastest = max(1.0, levels.bumpers["speed"].max(initial=0.0) / FASTEST)
    observed: tuple[Observed, ...] = ()
    for j, bumper in enumerate(levels.bumpers[0]):
        name = f"bumper {j}"
        observed += place_of(name, *FIELD_ENDS)
        if bumper["part"] >= 0:
            observed += velocity_of(name, FASTEST, fastest)
            observed += place_of(f"{name}, first end of its rail,", *FIELD_ENDS)
            observed += place_of(f"{name}, second end of its rail,", *FIELD_ENDS)
    return observed


@function
def observe_bumpers(levels: Levels, state: State, field: Record, w: int, out: Array, i: int) -> None:
    """Into `out[w, i]` and on: each bumper's place now; of one on a rail its velocity and where it turns back, too."""
    scene = state.worlds[w].scene
    for j in range(levels.bumpers.shape[1]):
        bumper = levels.bumpers[scene, j]
        if bumper.part < 0:
            i = _observe_place(field, bumper.x0, bumper.y0, w, out, i)
        else:
            i = _observe_rider(state, field, bumper.part, w, out, i)
            i = _observe_place(field, bumper.x0, bumper.y0, w, out, i)
            i = _observe_place(field, bumper.x1, bumper.y1, w, out, i)


@function
def _observe_place(field: Record, x: float, y: float, w: int, out: Array, i: int) -> int:
    out[w, i], out[w, i + 1] = place_seen(field, x, y)
    return i + 2


def _no_rider(state: State, field: Record, m: int, w: int, out: Array, i: int) -> int:
    return i


@where("parts", otherwise=_no_rider)
def _observe_rider(state: State, field: Record, m: int, w: int, out: Array, i: int) -> int:
    motion, part = state.motions[w, m], state.parts[state.worlds[w].scene, m]
    offset = offset_now(state, w, m)
    i = _observe_place(field, part.x + offset * part.ux, part.y + offset * part.uy, w, out, i)
    out[w, i], out[w, i + 1] = motion.velocity * part.ux / FASTEST, motion.velocity * part.uy / FASTEST
    return i + 2
