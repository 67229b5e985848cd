"""Moving parts: where they are and how fast, and when they stop.

A part is a capsule. It slides along its core (a paddle, a bumper on a rail) or turns about one end of it (a flipper),
at a speed that is constant between commands and stops; or it is a wall, both ends of which are dragged
(`motion.dragged_wall`).
"""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import Record, function, unfolded, where
from bounce_env.engine.memory.lookup import ends_of, turn_of
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.dragged_wall import dragged_wall_line_at, velocity_on_dragged_wall
from bounce_env.engine.motion.instant import later, since
from bounce_env.engine.motion.sincos import sin_cos
from bounce_env.engine.tolerances import UNSURE


class MovingPart(NamedTuple):
    """A part of one world: what it is, its present motion, and what only flippers and dragged walls have."""

    shape: Record  # PART
    motion: Record  # MOTION
    turn: int  # which way it turns, 1 or -1; 0 where it slides or is dragged
    ends: Record  # ENDS; None: nothing is dragged in any scene


class Core(NamedTuple):
    """Where a part is: from (x, y) [m] its core runs from `back` to `front` [m] along the unit vector (ux, uy)."""

    x: float
    y: float
    ux: float
    uy: float
    back: float
    front: float


@unfolded
def moving_part(state: State, w: int, m: int) -> MovingPart:
    """Return part `m` of world `w`, for what is compiled only where there are parts."""
    scene = state.worlds[w].scene
    return MovingPart(state.parts[scene, m], state.motions[w, m], turn_of(state, scene, m), ends_of(state, w, m))


@where("ends", otherwise=False)
def is_dragged_part(part: MovingPart) -> bool:
    """Return whether a part is a wall that is dragged by its ends."""
    return part.shape.span == 0.0


@function
def part_offset_at(motion: Record, hi: float, lo: float) -> float:
    """Return where on its way [m or rad] a part is at an instant of its present motion."""
    return motion.offset + motion.velocity * since(hi, lo, motion.hi, motion.lo)


@function
def kept_part_offset(motion: Record, shape: Record, hi: float, lo: float) -> float:
    """Return the same, without the rounding by which it may lie beyond a stop."""
    return min(max(part_offset_at(motion, hi, lo), 0.0), shape.span)


@function
def _part_capsule_velocity(part: MovingPart, core: Core, rx: float, ry: float) -> tuple[float, float]:
    if part.turn != 0:
        spin = part.turn * part.motion.velocity
        return -spin * ry, spin * rx
    return part.motion.velocity * core.ux, part.motion.velocity * core.uy


@where("ends", otherwise=_part_capsule_velocity)
def part_surface_velocity(part: MovingPart, core: Core, rx: float, ry: float) -> tuple[float, float]:
    """Return the velocity [m/s] of a point of a part, at (rx, ry) [m] from the (x, y) of its core."""
    if is_dragged_part(part):
        return velocity_on_dragged_wall(part.ends, min(max((rx * core.ux + ry * core.uy) / core.front, 0.0), 1.0))
    return _part_capsule_velocity(part, core, rx, ry)


@function
def _part_capsule_spin(part: MovingPart, core: Core) -> tuple[float, bool]:
    return part.turn * part.motion.velocity, part.turn != 0 and part.motion.velocity != 0.0


@where("ends", otherwise=_part_capsule_spin)
def part_spin(part: MovingPart, core: Core) -> tuple[float, bool]:
    """Return how fast [rad/s] a part turns, and whether it turns or stretches: its surface does not move as one."""
    if is_dragged_part(part):
        ends = part.ends
        spin = ((ends.vy1 - ends.vy0) * core.ux - (ends.vx1 - ends.vx0) * core.uy) / core.front
        return spin, ends.vx0 != ends.vx1 or ends.vy0 != ends.vy1
    return _part_capsule_spin(part, core)


@function
def _part_capsule_core(part: MovingPart, hi: float, lo: float) -> Core:
    shape, offset = part.shape, part_offset_at(part.motion, hi, lo)
    if part.turn != 0:
        s, c = sin_cos(part.turn * offset)
        ux, uy = shape.ux * c - shape.uy * s, shape.ux * s + shape.uy * c
        return Core(shape.x, shape.y, ux, uy, shape.back, shape.front)
    x, y = shape.x + offset * shape.ux, shape.y + offset * shape.uy
    return Core(x, y, shape.ux, shape.uy, shape.back, shape.front)


@where("ends", otherwise=_part_capsule_core)
def part_core_at(part: MovingPart, hi: float, lo: float) -> Core:
    """Return where a part is at an instant of its present motion."""
    if is_dragged_part(part):
        x, y, ux, uy, length = dragged_wall_line_at(part.ends, since(hi, lo, part.motion.hi, part.motion.lo))
        return Core(x, y, ux, uy, 0.0, length)
    return _part_capsule_core(part, hi, lo)


@function
def part_stop_instant(motion: Record, shape: Record) -> tuple[float, float]:
    """Return the instant at which a part's present motion ends at a stop: (hi, lo), inf if it stands."""
    if motion.velocity == 0.0:
        return math.inf, 0.0
    room = shape.span - motion.offset if motion.velocity > 0.0 else motion.offset
    return later(motion.hi, motion.lo, room / abs(motion.velocity))


@function
def part_moves_until(motion: Record, shape: Record, hi: float, lo: float) -> bool:
    """Return whether the part surely comes to no stop up to an instant: most are told so without a division.

    The margin covers the rounding of the two ways; within it the stop's instant decides. Asked of both stops alike,
    since which one lies ahead is a coin's toss to the processor.
    """
    margin = UNSURE * shape.span
    return motion.velocity == 0.0 or margin < part_offset_at(motion, hi, lo) < shape.span - margin


@function
def nearest_on_core(core: Core, x: float, y: float, side: int, tolerance: float) -> tuple[float, float, float, float]:
    """Return how a capsule's core lies to the point (x, y) [m]: unit normal, distance [m], and the nearest point.

    As (nx, ny, distance, nearest), the last along the core; distances are taken from the core's own (x, y).
    side: on which side a ball of no radius is of a core without thickness, whose ends count up to the tolerance, and to
    which the normal points; the distance is negative on the other one. Otherwise 0.
    """
    dx, dy = x - core.x, y - core.y
    along, more = dx * core.ux + dy * core.uy, tolerance if side != 0 else 0.0
    if core.back - more <= along <= core.front + more:
        height = dy * core.ux - dx * core.uy
        facing = 1.0 if (height >= 0.0 if side == 0 else side > 0) else -1.0
        return -facing * core.uy, facing * core.ux, facing * height, along
    nearest = core.front if along > core.front else core.back
    dx, dy = dx - nearest * core.ux, dy - nearest * core.uy
    distance = math.sqrt(dx * dx + dy * dy)
    return dx / distance, dy / distance, distance, nearest
