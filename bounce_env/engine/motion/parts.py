"""Moving parts: where they are and how fast, and when they stop.

A part is a capsule. It slides along its core (a paddle, a bumper on a rail) or turns about one end of it (a flipper),
at a speed that is constant between commands and stops; or it is a wall, both ends of which are dragged
(`motion.dragged_wall`).
"""

import math

from bounce_env.engine.compile.jit import Record, function
from bounce_env.engine.memory.lookup import is_dragged
from bounce_env.engine.motion.dragged_wall import line_at, velocity_on
from bounce_env.engine.motion.instant import later, since
from bounce_env.engine.motion.sincos import sin_cos


@function
def offset_at(motion: Record, hi: float, lo: float) -> float:
    """Where on its way [m or rad] a part is at an instant of its present motion."""
    return motion.offset + motion.velocity * since(hi, lo, motion.hi, motion.lo)


@function
def kept_offset(motion: Record, part: Record, hi: float, lo: float) -> float:
    """The same, without the rounding by which it may lie beyond a stop."""
    return min(max(offset_at(motion, hi, lo), 0.0), part.span)


@function
def surface_velocity(
    motion: Record, part: Record, turn: int, ends: Record, ux: float, uy: float, front: float, rx: float, ry: float
) -> tuple[float, float]:
    """Velocity [m/s] of a point of a part, at (rx, ry) [m] from where `core_at` says that it is.

    The core lies along u, up to `front` [m].
    """
    if ends is not None and is_dragged(ends, part):
        return velocity_on(ends, min(max((rx * ux + ry * uy) / front, 0.0), 1.0))
    if turn != 0:
        spin = turn * motion.velocity
        return -spin * ry, spin * rx
    return motion.velocity * ux, motion.velocity * uy


@function
def spin_of(
    motion: Record, part: Record, turn: int, ends: Record, ux: float, uy: float, front: float
) -> tuple[float, bool]:
    """How fast [rad/s] a part turns now, and whether it turns or stretches: its surface does not move as one.

    The core lies along u, up to `front` [m].
    """
    if ends is not None and is_dragged(ends, part):
        spin = ((ends.vy1 - ends.vy0) * ux - (ends.vx1 - ends.vx0) * uy) / front
        return spin, ends.vx0 != ends.vx1 or ends.vy0 != ends.vy1
    return turn * motion.velocity, turn != 0 and motion.velocity != 0.0


@function
def core_at(
    part: Record, motion: Record, turn: int, ends: Record, hi: float, lo: float
) -> tuple[float, float, float, float, float, float]:
    """Where a part is at an instant of its present motion.

    A point (x, y) [m], the unit vector along its core, and where [m] the core begins and ends along that, from (x, y).
    """
    if ends is not None and is_dragged(ends, part):
        x, y, ux, uy, length = line_at(ends, since(hi, lo, motion.hi, motion.lo))
        return x, y, ux, uy, 0.0, length
    offset = offset_at(motion, hi, lo)
    if turn != 0:
        s, c = sin_cos(turn * offset)
        return part.x, part.y, part.ux * c - part.uy * s, part.ux * s + part.uy * c, part.back, part.front
    return part.x + offset * part.ux, part.y + offset * part.uy, part.ux, part.uy, part.back, part.front


@function
def stop_instant(motion: Record, part: Record) -> tuple[float, float]:
    """Instant at which the part's present motion ends at a stop: (hi, lo), inf if it stands."""
    if motion.velocity == 0.0:
        return math.inf, 0.0
    room = part.span - motion.offset if motion.velocity > 0.0 else motion.offset
    return later(motion.hi, motion.lo, room / abs(motion.velocity))
