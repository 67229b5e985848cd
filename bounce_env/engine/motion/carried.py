"""A ball that a straight surface and a circle carry between them while one passes the other, in closed form.

It touches both: the directions of the line and of the circle to it tell where it is, forces do not matter. With e the
unit vector from the circle's centre to the ball, and m the straight surface's normal, e.m grows uniformly in time
(docs/physics.md, "Pushed along").
"""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import Record, function


class Carried(NamedTuple):
    """The motion of a ball between two surfaces: the columns of `CARRIED` that tell of it."""

    x: float  # [m] the circle's centre, when it began
    y: float
    ux: float  # [m/s] its velocity
    uy: float
    radius: float  # [m] of the ball's path about it
    mx: float  # unit normal of the straight surface, to the ball
    my: float
    share: float  # e.m when it began
    rate: float  # [1/s] how fast e.m grows
    turn: float  # 1.0 where e is on the left of m, -1.0 on the right
    least: float  # what the magnitude of m x e does not fall below


@function
def carried_of(row: Record) -> Carried:
    """Return the motion that a row of `CARRIED` holds."""
    return Carried(
        row.x, row.y, row.ux, row.uy, row.radius, row.mx, row.my, row.share, row.rate, row.turn, row.least
    )  # fmt: skip


@function
def carried_direction(carried: Carried, t: float) -> tuple[float, float]:
    """Return e.m and m x e after `t` seconds."""
    share = carried.share + carried.rate * t
    return share, carried.turn * math.sqrt(max((1.0 - share) * (1.0 + share), 0.0))


@function
def carried_after(carried: Carried, t: float) -> tuple[float, float, float, float]:
    """Return where the ball is after `t` seconds, and its velocity: (x, y, vx, vy) [m, m/s]."""
    share, across = carried_direction(carried, t)
    ex, ey = share * carried.mx - across * carried.my, share * carried.my + across * carried.mx
    # It moves about the centre at right angles to e, by `rate` along m.
    speed = -carried.radius * carried.rate / across
    x, y = carried.x + carried.ux * t, carried.y + carried.uy * t
    return x + carried.radius * ex, y + carried.radius * ey, carried.ux - speed * ey, carried.uy + speed * ex


@function
def carried_acceleration(carried: Carried, across: float) -> tuple[float, float]:
    """Return the ball's acceleration [m/s^2], which lies along the straight surface, where m x e is `across`."""
    along = -carried.radius * carried.rate * carried.rate / (across * across * across)
    return -along * carried.my, along * carried.mx


@function
def carried_top_speed(carried: Carried) -> float:
    """Return a speed [m/s] that the ball does not exceed."""
    of_circle = math.sqrt(carried.ux * carried.ux + carried.uy * carried.uy)
    return of_circle + carried.radius * abs(carried.rate) / carried.least


@function
def carried_acceleration_bound(carried: Carried) -> float:
    """Return the magnitude [m/s^2] that the ball's acceleration does not exceed."""
    least = carried.least
    return carried.radius * carried.rate * carried.rate / (least * least * least)
