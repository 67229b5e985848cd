"""When a ball may come into contact, what it then does, and how small bounces end: in a corner, on a curve, on a wall.

Of the ledger checker: plain Python, no code of the engine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

from tests.reference.ledger_law import Rules, Surface, is_friction, is_soft, pressing, split
from tests.reference.ledger_touch import Bearing, Vector

PRESSING = 2.0**-40  # share of the acceleration: pressed less than this, friction holds nothing
ALIGNED = 1e-9  # by how much the normals that carry a ball may miss the direction of what they carry
CORNER = 64.0  # times as high as a hop that is none: so much is none between several surfaces
SWING, BALANCE = 1e-3, 1e-4  # of sqrt(pull rho): the speeds at which a ball rests in a hollow, and on top of a curve
FASTEST_ESCAPE = 64.0  # no ball is squeezed out faster than so many times the fastest surface
SLOW = 4e-14  # share of the speed below which nothing closes or leaves


class Settling(NamedTuple):
    """The last bounces on a wall: they end after `seconds`; until then the ball is shown at this velocity."""

    seconds: float
    vx: float
    vy: float
    slides: bool  # under the tangential acceleration as well


def closing_on(bearing: Bearing, v: Vector) -> float:
    return -((v[0] - bearing.ux) * bearing.nx + (v[1] - bearing.uy) * bearing.ny)


def press_on(bearing: Bearing, v: Vector, a: Vector) -> float:
    """Acceleration [m/s^2] with which a ball is pressed on a surface."""
    along = (v[1] - bearing.uy) * bearing.nx - (v[0] - bearing.ux) * bearing.ny
    return -(a[0] * bearing.nx + a[1] * bearing.ny) - bearing.curvature * along * along


def slow(v: Vector) -> float:
    return SLOW * (abs(v[0]) + abs(v[1]))


def is_carried(a: Vector, bearings: Sequence[Bearing]) -> bool:
    """Whether one or two of the touched normals can hold a ball that stands."""
    noise = ALIGNED * (abs(a[0]) + abs(a[1]))
    if noise == 0.0:
        return False
    standing = [b for b in bearings if b.ux == b.uy == 0.0 and not b.moves]
    for one in standing:
        if abs(a[0] * one.ny - a[1] * one.nx) <= noise and a[0] * one.nx + a[1] * one.ny < 0.0:
            return True
        for other in standing:
            turn = one.nx * other.ny - one.ny * other.nx
            if abs(turn) <= ALIGNED:
                continue
            of_one, of_other = (a[1] * other.nx - a[0] * other.ny) / turn, (a[0] * one.ny - a[1] * one.nx) / turn
            if of_one >= -noise and of_other >= -noise:
                return True
    return False


def is_standing(v: Vector, a: Vector, rules: Rules) -> bool:
    """Whether what moves so slowly is taken to stand."""
    return v[0] ** 2 + v[1] ** 2 <= 2.0 * math.hypot(*a) * CORNER * rules.soft_hop * (1.0 + ALIGNED)


def swings_out(bearing: Bearing, v: Vector, a: Vector, rules: Rules) -> bool:
    """Whether a ball moves so slowly through the foot of a hollow, or over the top of a curve, that it rests."""
    pull = math.hypot(*a)
    if bearing.curvature == 0.0 or a[0] * bearing.nx + a[1] * bearing.ny >= 0.0:
        return False
    rate, across = v[1] * bearing.nx - v[0] * bearing.ny, a[0] * bearing.ny - a[1] * bearing.nx
    speed = math.sqrt(rate**2 + across**2 / (abs(bearing.curvature) * pull))
    natural = math.sqrt(pull / abs(bearing.curvature))
    limit = BALANCE * natural if bearing.curvature > 0.0 else max(rules.rest_speed, SWING * natural)
    return speed <= limit * (1.0 + ALIGNED)


def is_over(bearings: Sequence[Bearing], v: Vector, a: Vector, rules: Rules, kicks: Sequence[float]) -> bool:
    """Whether bounces in a corner are over: the fastest approach is as slow as a touch. `kicks`: above which speeds."""
    if len(bearings) < 2:
        return False
    k = max(range(len(bearings)), key=lambda i: closing_on(bearings[i], v))
    closing, press = closing_on(bearings[k], v), press_on(bearings[k], v, a)
    return (
        press > 0.0 and closing <= kicks[k] and (closing < rules.rest_speed or is_soft(rules, closing, CORNER * press))
    )


def projections(bearings: Sequence[Bearing], v: Vector) -> Iterator[Vector]:
    """What may be left of a velocity in a corner: along one of the surfaces where the others allow it, else nothing.

    Where parts close on the ball it may keep just ahead of two of them; where friction alone drives it in, it stands.
    """
    allowed = False
    for one in bearings:
        closing = closing_on(one, v)
        if closing > 0.0:
            left = (v[0] + closing * one.nx, v[1] + closing * one.ny)
            if _closes_on_none(bearings, left, v):
                allowed = True
                yield left
    if allowed:
        return
    fastest = max(bearings, key=lambda b: closing_on(b, v))
    yield fastest.ux, fastest.uy
    if any(b.ux or b.uy for b in bearings):
        yield 0.0, 0.0
        for ahead in _squeezed_out(bearings):
            if _closes_on_none(bearings, ahead, v):
                yield ahead


def _closes_on_none(bearings: Sequence[Bearing], v: Vector, before: Vector) -> bool:
    return all(closing_on(b, v) <= slow(v) + slow(before) + slow((b.ux, b.uy)) for b in bearings)


def _squeezed_out(bearings: Sequence[Bearing]) -> Iterator[Vector]:
    """The velocities at which a ball keeps just ahead of two surfaces."""
    for one, other in combinations(bearings, 2):
        turn = one.nx * other.ny - one.ny * other.nx
        if abs(turn) > ALIGNED:
            a, b = one.ux * one.nx + one.uy * one.ny, other.ux * other.nx + other.uy * other.ny
            yield (a * other.ny - b * one.ny) / turn, (b * one.nx - a * other.nx) / turn


def along(bearing: Bearing, v: Vector) -> Vector:
    """A velocity without what is across a surface, seen from that."""
    rate = (v[0] - bearing.ux) * bearing.ny - (v[1] - bearing.uy) * bearing.nx
    return bearing.ux + rate * bearing.ny, bearing.uy - rate * bearing.nx


def after_contact(
    bearing: Bearing, bearings: Sequence[Bearing], v: Vector, a: Vector, f: float, rules: Rules
) -> Iterator[Vector]:
    """The velocities that a ball may have in contact with a surface, if it comes to it with `v`."""
    if bearing.moves:
        return
    press = press_on(bearing, v, a)
    pressed = press > 0.0
    held = is_friction(f, rules) and press > PRESSING * (abs(a[0]) + abs(a[1]))
    rests = pressed and (held or swings_out(bearing, v, a, rules))
    stands = rests or (is_standing(v, a, rules) and is_carried(a, bearings))
    if stands:
        yield bearing.ux, bearing.uy
    if bearing.straight and pressed:
        for other in bearings:
            if is_carrier(other):
                yield from _squeezed_out([bearing, other])
    # Where something else moves into the ball, friction does not hold it; nor does what it only nearly touches.
    if pressed and bearing.straight and (not rests or any(b.ux or b.uy for b in bearings)):
        yield along(bearing, v)


def is_carrier(bearing: Bearing) -> bool:
    """Whether a surface translates: it may carry a ball along another one."""
    return not bearing.moves and bool(bearing.ux or bearing.uy)


def is_pushed_along(bearing: Bearing, bearings: Sequence[Bearing], v: Vector) -> bool:
    """Whether a ball that has this velocity moves along a surface just as fast as another one comes."""
    for other in bearings:
        if is_carrier(other) and other.element != bearing.element and not (bearing.ux or bearing.uy):
            for ux, uy in _squeezed_out([bearing, other]):
                if math.hypot(v[0] - ux, v[1] - uy) <= slow(v):
                    return True
    return False


def gets_away(bearings: Sequence[Bearing], max_speed: float) -> bool:
    """Whether some velocity that the ball may have closes on none of these surfaces."""
    fastest = min(max_speed, FASTEST_ESCAPE * max((math.hypot(b.ux, b.uy) for b in bearings), default=0.0))
    ways = [(0.0, 0.0), *_squeezed_out(bearings)]
    for b in bearings:
        drive = b.ux * b.nx + b.uy * b.ny
        ways.append((drive * b.nx, drive * b.ny))
    return any(math.hypot(*v) <= fastest and _closes_on_none(bearings, v, v) for v in ways)


def settling(surface: Surface, rules: Rules, v: Vector) -> Settling | None:
    """The end of bounces on a wall after one that leaves the ball with velocity `v`; None where they go on.

    Hops of durations tau, b tau, b^2 tau ...: docs/physics.md, "Infinitely many bounces".
    """
    s = surface
    closing, slid = split(s, *v)
    press, rebound = pressing(s, slid), -closing
    if s.curvature != 0.0 or rules.rest_speed > 0.0 or not 0.0 < s.b < 1.0 or press <= 0.0 or rebound <= 0.0:
        return None
    if not is_soft(rules, rebound, press):
        return None
    tau, b, f = 2.0 * rebound / press, s.b, s.f
    seconds = tau / (1.0 - b)
    if f < 1.0:
        pull = s.ay * s.nx - s.ax * s.ny
        way = slid * tau / (1.0 - f * b) + pull * tau**2 * (1.0 + f * b) / (2.0 * (1.0 - f * b) * (1.0 - b**2))
        slid = way / seconds
    return Settling(seconds, s.ux - slid * s.ny, s.uy + slid * s.nx, f == 1.0)
