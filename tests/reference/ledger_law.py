"""What a bounce may do to the velocity: the tutorial's law, absorption, smallest rebound, kick, cap.

Of the ledger checker: plain Python, no code of the engine. Where a number lies so close to a threshold that round-off
decides, both outcomes are lawful.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

Vector = tuple[float, float]

CLOSE = 1e-9  # share of the speed within which a comparison with a threshold may go either way
HOP_ULPS = 16.0 * 2.0**-52  # of the scene's extent: a hop no higher than this is none
LEAST = 0.01  # of sqrt(acceleration size): the smallest rebound from what has no closed form for a contact


class Surface(NamedTuple):
    """What the ball strikes, and how it is pressed there."""

    nx: float
    ny: float
    ux: float
    uy: float
    curvature: float  # [1/m] 0 straight, > 0 bulging towards the ball
    ax: float  # acceleration of the ball
    ay: float
    b: float  # products of ball's and element's
    f: float
    kick: float
    kick_threshold: float
    moves: bool = False  # it is a part that turns or stretches
    least: float = 0.0  # [m/s] the smallest rebound from it, if it is a part


class Rules(NamedTuple):
    rest_speed: float
    max_speed: float
    soft_hop: float  # [m] what a hop may rise and still be no hop


class Outcome(NamedTuple):
    vx: float
    vy: float
    kicked: bool


def split(s: Surface, vx: float, vy: float) -> tuple[float, float]:
    """Closing speed and speed along the surface, both relative to it; along is positive to the left of the normal."""
    wx, wy = vx - s.ux, vy - s.uy
    return -(wx * s.nx + wy * s.ny), wy * s.nx - wx * s.ny


def pressing(s: Surface, along: float) -> float:
    """Acceleration [m/s^2] with which the ball is pressed on the surface; < 0 where it would lift off."""
    return -(s.ax * s.nx + s.ay * s.ny) - s.curvature * along * along


def outcomes(s: Surface, rules: Rules, vx: float, vy: float, may_kick: bool, must_not: bool) -> Iterator[Outcome]:
    """All velocities that the bounce may leave. `may_kick`, `must_not`: as the cooldown has it; both if it is close."""
    closing, along = split(s, vx, vy)
    near = CLOSE * (abs(closing) + abs(along))
    choices = []
    if s.kick > 0.0 and may_kick and closing > s.kick_threshold - near:
        choices.append(s.kick)
    if s.kick == 0.0 or must_not or closing <= s.kick_threshold + near:
        choices.append(0.0)
    for away, slid in _without_kick(s, rules, closing, along, near):
        for kick in choices:
            yield _capped(s, rules, away + kick, slid, kick > 0.0)


def _without_kick(s: Surface, rules: Rules, closing: float, along: float, near: float) -> Iterator[tuple[float, float]]:
    """Speeds away from the surface and along it."""
    if s.moves and closing <= s.least + near:
        yield max(s.b * closing, s.least), along if rules.rest_speed > 0.0 and s.f > 0.0 else s.f * along
        if closing < s.least - near:
            return
    press = pressing(s, along)
    scale = CLOSE * (math.hypot(s.ax, s.ay) + abs(s.curvature) * along * along)
    law = (s.b * closing, s.f * along)
    if press <= scale:
        yield law
    if press < -scale:
        return
    press = max(press, 0.0)
    if s.curvature != 0.0:
        yield from _off_curve(s, rules, closing, along, near, press <= scale)
        return
    if closing <= rules.rest_speed + near and rules.rest_speed > 0.0:
        yield 0.0, along if s.f > 0.0 else 0.0
    if closing >= rules.rest_speed - near:
        yield law


def _off_curve(
    s: Surface, rules: Rules, closing: float, along: float, near: float, loose: bool
) -> Iterator[tuple[float, float]]:
    """What is round: the law, but where gravity presses. `loose`: nothing may press the ball."""
    by_gravity, scale = -(s.ax * s.nx + s.ay * s.ny), CLOSE * math.hypot(s.ax, s.ay)
    if by_gravity > -scale and closing <= rules.rest_speed + near:
        yield 0.0, along if s.f > 0.0 else 0.0
    if by_gravity <= scale or closing >= rules.rest_speed - near or loose:
        yield s.b * closing, s.f * along


def least_rebound(rest_speed: float, pull: float, spin: float, size: float) -> float:
    """The smallest rebound [m/s] from what has no closed form for a contact: it keeps the bounces finite."""
    return max(rest_speed, LEAST * math.sqrt((pull + spin * spin * size) * size))


def is_friction(f: float, rules: Rules) -> bool:
    """Whether a surface that a ball is pressed on holds it by friction."""
    return f == 0.0 or (f < 1.0 and rules.rest_speed == 0.0)


def is_soft(rules: Rules, closing: float, press: float) -> bool:
    """Whether a hop at this speed would not rise above what counts as touching; True also where it is close."""
    return closing * closing <= 2.0 * press * rules.soft_hop * (1.0 + CLOSE)


def _capped(s: Surface, rules: Rules, away: float, along: float, kicked: bool) -> Outcome:
    """Back from the surface's frame to the world's, at no more than the greatest speed."""
    vx, vy = s.ux + away * s.nx - along * s.ny, s.uy + away * s.ny + along * s.nx
    return Outcome(*capped((vx, vy), (s.nx, s.ny), (s.ux, s.uy), rules.max_speed), kicked)


def capped(v: Vector, n: Vector, u: Vector, max_speed: float) -> Vector:
    """A velocity shrunk to the greatest speed, but never so that it closes on what moves at `u`."""
    speed = math.hypot(*v)
    if speed <= max_speed:
        return v
    share = max_speed / speed
    if (share * v[0] - u[0]) * n[0] + (share * v[1] - u[1]) * n[1] >= 0.0:
        return share * v[0], share * v[1]
    normal = min(v[0] * n[0] + v[1] * n[1], max_speed)
    tangent = math.copysign(math.sqrt(max_speed**2 - normal**2), v[1] * n[0] - v[0] * n[1])
    return normal * n[0] - tangent * n[1], normal * n[1] + tangent * n[0]
