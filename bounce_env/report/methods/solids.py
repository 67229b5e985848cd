"""The scene as distance functions, for the steppers: its own small geometry, compiled, and none of the engine's.

A solid is a row of numbers: a capsule (a wall, a bumper, a part: `kind` 0) or the line of an arc (`kind` 1). How the
parts move does not depend on the ball, so that it is known beforehand: a table of instants from which on a part is at
some distance on its way and moves at a rate.
"""

import math
from typing import Any

import numba
import numpy as np
import numpy.typing as npt

from bounce_env.report.truths import FRAMES, Command
from bounce_env.scene import Arc, Bumper, Field, Flipper, Scene, Sensor, Wall

Floats = npt.NDArray[np.float64]

CHORDS = 1440
"""How many straight pieces a whole circle is made of, for engines that have no hollow one."""

CAPSULE, ARC = 0.0, 1.0
FIXED, SLIDING, TURNING = 0.0, 1.0, 2.0

KIND, AX, AY, BX, BY, RADIUS, MOTION, UX, UY, TIMELINE, B, KICK, KICK_OVER, COOLDOWN, ONE_WAY, ELEMENT = range(16)
"""Columns. Of an arc AX, AY is its centre, BX, BY are its angles, UX its radius. What slides does so along x; of what
turns AX, AY is the pivot, BX the length, BY the angle at rest, UX the sense."""


def solids_of(scene: Scene) -> Floats:
    """Return the bouncing elements as rows, shape (n, 16)."""
    rows, part = [], 0
    for index, e in enumerate(scene.elements):
        if isinstance(e, Sensor | Field):
            continue
        moving = index in dict(scene.parts)
        line = float(part) if moving else -1.0
        part += moving
        tail = (line, e.b * scene.ball.b, e.kick, e.kick_threshold, e.cooldown)
        one_way = isinstance(e, Wall) and e.one_way
        rows.append((*_shape(e, moving=moving), *tail, float(one_way), float(index)))
    return np.array(rows, np.float64).reshape(-1, 16)


def _shape(e: Any, *, moving: bool) -> tuple[float, ...]:
    match e:
        case Wall():
            return (CAPSULE, *e.start, *e.end, 0.0, SLIDING if moving else FIXED, 0.0, 0.0)
        case Bumper():
            return (CAPSULE, *e.center, *e.center, e.radius, FIXED, 0.0, 0.0)
        case Arc():
            return (ARC, *e.center, e.start_angle, e.end_angle, 0.0, FIXED, e.radius, 0.0)
        case Flipper():
            sense = 1.0 if e.active_angle > e.rest_angle else -1.0
            return (CAPSULE, *e.pivot, e.length, e.rest_angle, e.radius, TURNING, sense, 0.0)
    raise ValueError(f"the steppers of the report know no {type(e).__name__}")


def chords(arc: Arc, whole: int) -> list[tuple[float, float]]:
    """Return points on an arc, so many on a whole circle."""
    count = max(2, math.ceil(whole * (arc.end_angle - arc.start_angle) / (2.0 * math.pi)) + 1)
    angles = np.linspace(arc.start_angle, arc.end_angle, count)
    x, y = arc.center
    return [(x + arc.radius * math.cos(a), y + arc.radius * math.sin(a)) for a in angles.tolist()]


def timelines_of(scene: Scene, commands: tuple[Command, ...]) -> Floats:
    """Return how the parts move: shape (parts, instants, 3): from which time on [s], where on its way, at what rate."""
    tables = [_timeline(part, [c for c in commands if c[1] == part.name]) for _, part in scene.parts]
    longest = max(map(len, tables), default=1)
    filled = [[*table, *[(math.inf, 0.0, 0.0)] * (longest - len(table))] for table in tables]
    return np.array(filled, np.float64).reshape(-1, longest, 3)


def _timeline(part: Any, commands: list[Command]) -> list[tuple[float, float, float]]:
    """Return the pieces of a flipper's way, or of a wall's that is dragged without turning (its direction is x)."""
    table, at, since, rate = [(0.0, 0.0, 0.0)], 0.0, 0.0, 0.0
    for frame, _, value in commands:
        now = frame / FRAMES
        at, at_stop = _moved(part, at, rate, now - since)
        if at_stop is not None and rate != 0.0:
            table.append((since + at_stop, at, 0.0))
        rate = (part.up_speed if value else -part.down_speed) if isinstance(part, Flipper) else value[0][0]
        since = now
        table.append((now, at, rate))
    _, at_stop = _moved(part, at, rate, math.inf)
    if at_stop is not None and rate != 0.0:
        table.append((since + at_stop, _moved(part, at, rate, math.inf)[0], 0.0))
    return table


def _moved(part: Any, at: float, rate: float, seconds: float) -> tuple[float, float | None]:
    """Return where a part is after some seconds, and after how many it has come to its stop, if it has."""
    if not isinstance(part, Flipper) or rate == 0.0:
        return (at if rate == 0.0 else at + rate * seconds), None
    span = abs(part.active_angle - part.rest_angle)
    room = ((span - at) if rate > 0.0 else at) / abs(rate)
    return (at + rate * seconds, None) if seconds < room else ((span if rate > 0.0 else 0.0), room)


def comes_from_left(wall: Wall, x: float, y: float, vx: float, vy: float) -> bool:
    """Return whether a ball comes to a one-way wall from the side on which it bounces."""
    (x0, y0), (x1, y1) = wall.start, wall.end
    left = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
    closes = (x1 - x0) * vy - (y1 - y0) * vx
    return left > 0.0 and closes < 0.0


def rates_in_step(scene: Scene, timelines: Floats, now: float, dt: float) -> list[tuple[bool, float]]:
    """Return how each part has to move to be at a step's end where it has to be: whether it turns, and how fast.

    [rad/s] counter-clockwise, or [m/s] along x.
    """
    rates = []
    for m, (_, part) in enumerate(scene.parts):
        rate = (offset_at(timelines, m, now + dt)[0] - offset_at(timelines, m, now)[0]) / dt
        turns = isinstance(part, Flipper)
        rates.append((turns, -rate if isinstance(part, Flipper) and part.active_angle < part.rest_angle else rate))
    return rates


@numba.njit(cache=True)
def offset_at(timelines: Floats, part: int, t: float) -> tuple[float, float]:
    """Return where a part is on its way at a time, and its rate."""
    k = 0
    while k + 1 < timelines.shape[1] and timelines[part, k + 1, 0] <= t:
        k += 1
    since, at, rate = timelines[part, k, 0], timelines[part, k, 1], timelines[part, k, 2]
    return at + rate * (t - since), rate


@numba.njit(cache=True)
def gap_to(
    solid: Floats, timelines: Floats, x: float, y: float, ball_radius: float, t: float
) -> tuple[float, float, float, float, float]:
    """Return the gap between a ball and a solid [m], the unit normal to the ball, and the surface's velocity there."""
    if solid[KIND] == ARC:
        dx, dy = x - solid[AX], y - solid[AY]
        turn = (math.atan2(dy, dx) - solid[BX]) % (2.0 * math.pi)
        span = solid[BY] - solid[BX]
        if turn > span:
            turn = span if turn - span < 2.0 * math.pi - turn else 0.0
        px = solid[AX] + solid[UX] * math.cos(solid[BX] + turn)
        py = solid[AY] + solid[UX] * math.sin(solid[BX] + turn)
        nx, ny, distance = _unit(x - px, y - py)
        return distance - ball_radius, nx, ny, 0.0, 0.0
    ax, ay, bx, by = solid[AX], solid[AY], solid[BX], solid[BY]
    offset, rate, angle = 0.0, 0.0, 0.0
    if solid[MOTION] != FIXED:
        offset, rate = offset_at(timelines, int(solid[TIMELINE]), t)
    if solid[MOTION] == SLIDING:
        ax, bx = ax + offset, bx + offset
    elif solid[MOTION] == TURNING:
        angle = solid[BY] + solid[UX] * offset
        bx, by = ax + solid[BX] * math.cos(angle), ay + solid[BX] * math.sin(angle)
    ex, ey = bx - ax, by - ay
    square = ex * ex + ey * ey
    share = 0.0
    if square > 0.0:
        share = min(max(((x - ax) * ex + (y - ay) * ey) / square, 0.0), 1.0)
    nx, ny, distance = _unit(x - ax - share * ex, y - ay - share * ey)
    ux, uy = 0.0, 0.0
    if solid[MOTION] == SLIDING:
        ux = rate
    elif solid[MOTION] == TURNING:
        turning = solid[UX] * rate
        touched_x, touched_y = share * ex + solid[RADIUS] * nx, share * ey + solid[RADIUS] * ny
        ux, uy = -turning * touched_y, turning * touched_x
    return distance - solid[RADIUS] - ball_radius, nx, ny, ux, uy


@numba.njit(cache=True)
def is_behind_gate(solid: Floats, nx: float, ny: float) -> bool:
    """Return whether a ball, with the normal to it, is on the side of a one-way wall that lets it pass."""
    ex, ey = solid[BX] - solid[AX], solid[BY] - solid[AY]
    return solid[ONE_WAY] > 0.0 and nx * -ey + ny * ex <= 0.0


@numba.njit(cache=True)
def _unit(x: float, y: float) -> tuple[float, float, float]:
    length = math.sqrt(x * x + y * y)
    if length == 0.0:
        return 0.0, 1.0, 0.0
    return x / length, y / length, length
