"""The tutorial's own algorithm in plain Python: the executable specification of the bounce.

Read it beside the tutorial's chapter "Bounce"; names (`v1`, `v2`, `p0`, `p1`, `ip`, `lx`, `dx`, `len`,
`dp1`, `proj1`, `b`, `f` ...) are the tutorial's. A point moves in ticks; in each tick it checks every wall,
picks the closest intersection point, and spends what is left of the tick in the new direction.

Two versions, as in the text: `recheck=False` bounces off the closest wall only (what is left of the tick is
not checked, so the point may pass through a second wall); `recheck=True` is its improvement 2, "checking of
collision with every wall over after new vector is found", from `ip` on, until nothing is in the way.

Erratum. The printed formulas divide by the wall's length once where they must divide twice: `dp1` and `dp2`
are dot products with the *raw* vectors, of length `len`, while `proj1` and `proj2` scale *unit* vectors, so
every bounce would multiply the speed by `len`. Here both places use the unit vector. The printed `proj2` also
calls `dp2` `dp`.

Where the text is silent:

- Time. A velocity is in m/s; the movement vector of a tick of `dt` seconds is `v1 = velocity * dt`.
  Gravity is stepped as games do: per tick first `velocity += gravity * dt`, then the move. So without
  gravity the result is exact up to round-off, and with it the error is of first order in `dt`.
- "Substracting the value it took to get to the intersection point": a share of the *time*. A point that spent
  30 % of the tick before the wall moves 70 % of the new vector after it, whatever b and f did to its length.
- Which side of a wall the point is on is never read from a sign within rounding: within `ROUNDING` of a
  wall's line it keeps the side from which it came (`State.sides`). A wall is hit only by a movement that goes
  towards it, as seen from that side, by more than the rounding of its speed; after a bounce none does, until
  another wall or gravity turns it. So rounding neither hits a wall twice nor pushes the point through it.
- A point that starts on a wall is on the side to which it moves, so it leaves; if it does not move to either,
  on the side from which gravity presses it.
- Equally close walls: the first of the scene. The others are then found by the recheck, at distance zero.
- There is no resting contact: under gravity a point on a floor with b = 0 hits it every tick, and every hit
  takes its f ("tar or glue").
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import NamedTuple

from bounce_env.scene import Ball, Scene, Wall

__all__ = [
    "MAX_BOUNCES",
    "ROUNDING",
    "Reflection",
    "State",
    "Vector",
    "bounce",
    "meeting",
    "reflect",
    "run",
    "start",
    "step",
]

Pair = tuple[float, float]

ROUNDING = 32 * 2.0**-52
"""Rounding of a distance, relative to the largest coordinate; of a speed along a normal, to the speed."""

MAX_BOUNCES = 10_000
"""Bounces in one tick after which `step` gives up: the point is caught in an ever narrower wedge."""


@dataclass(slots=True)
class Vector:
    """The tutorial's vector object: from `p0` to `p1`, with its length, direction and left-hand normal.

    `vx vy` components [m], `len` length [m], `dx dy` unit direction, `lx ly` normal of length `len` [m]
    (left-hand where y points down, as on the tutorial's screen), `b f` bounciness and friction of its owner.
    """

    p0: Pair
    vx: float
    vy: float
    b: float
    f: float

    @property
    def p1(self) -> Pair:
        return self.p0[0] + self.vx, self.p0[1] + self.vy

    @property
    def len(self) -> float:
        return math.sqrt(self.vx * self.vx + self.vy * self.vy)

    @property
    def dx(self) -> float:
        return self.vx / self.len

    @property
    def dy(self) -> float:
        return self.vy / self.len

    @property
    def lx(self) -> float:
        return self.vy

    @property
    def ly(self) -> float:
        return -self.vx


class State(NamedTuple):
    """A moving point between two ticks."""

    position: Pair
    """[m]"""
    velocity: Pair
    """[m/s]"""
    sides: tuple[int, ...]
    """For each wall the side of its line: +1 where its normal (lx, ly) points, -1 the other."""


class Reflection(NamedTuple):
    """A bounce with all that leads to it, by the tutorial's names: lengths in metres."""

    dp1: float
    proj1: Pair
    """Of the movement on the wall."""
    dp2: float
    proj2: Pair
    """On the wall's normal, before it is reversed."""
    movement: Pair
    """After the bounce."""


def bounce(v1: Vector, v2: Vector) -> Pair:
    """Return the movement vector `v1` after its bounce off the wall `v2` [m]."""
    return reflect(v1, v2).movement


def reflect(v1: Vector, v2: Vector) -> Reflection:
    """Return the bounce of the movement vector `v1` off the wall `v2`.

    Source: the tutorial's "Bounce" and "Real bounce and friction", with unit vectors in both places.
    """
    dp1 = v1.vx * v2.dx + v1.vy * v2.dy
    proj1 = (dp1 * v2.dx, dp1 * v2.dy)

    dp2 = v1.vx * (v2.lx / v2.len) + v1.vy * (v2.ly / v2.len)
    proj2 = (dp2 * (v2.lx / v2.len), dp2 * (v2.ly / v2.len))

    reversed2 = (-proj2[0], -proj2[1])

    movement = (
        v1.f * v2.f * proj1[0] + v1.b * v2.b * reversed2[0],
        v1.f * v2.f * proj1[1] + v1.b * v2.b * reversed2[1],
    )
    return Reflection(dp1, proj1, dp2, proj2, movement)


def meeting(v1: Vector, v2: Vector, radius: float) -> float | None:
    """Return the share of `v1` after which a disc of `radius` [m], at first at `v1.p0`, meets the wall `v2`.

    None where it does not: it moves away or along, is too short, or passes the wall's ends. Only the wall's two
    sides are looked at; its ends are points that the tutorial does not bounce from.
    """
    distance = _tutorial_distance(v2, v1.p0)
    side = 1 if distance >= 0 else -1
    towards = -side * (v1.vx * v2.lx + v1.vy * v2.ly) / v2.len
    if towards <= ROUNDING * v1.len:
        return None
    share = (side * distance - radius) / towards
    x, y = v1.p0[0] + share * v1.vx, v1.p0[1] + share * v1.vy
    along = (x - v2.p0[0]) * v2.dx + (y - v2.p0[1]) * v2.dy
    return share if 0 <= share <= 1 and 0 <= along <= v2.len else None


def start(scene: Scene, position: Pair, velocity: Pair) -> State:
    """Return a point at `position` [m] with `velocity` [m/s], for `step`.

    Raises ValueError for a scene that has more than the tutorial knows (naming the element), and for
    numbers that are not finite.
    """
    walls = _tutorial_walls(scene)
    for name, pair in (("position", position), ("velocity", velocity)):
        if not (math.isfinite(pair[0]) and math.isfinite(pair[1])):
            raise ValueError(f"{name}: {pair} is not allowed, both numbers must be finite")
    p0 = (float(position[0]), float(position[1]))
    velocity = (float(velocity[0]), float(velocity[1]))
    return State(
        p0, velocity, _tutorial_sides(walls, p0, (_tutorial_leaning(v2, velocity, scene.gravity) for v2 in walls))
    )


def step(scene: Scene, state: State, dt: float, recheck: bool = True) -> State:
    """One tick of `dt` seconds.

    Raises ValueError for a `dt` that is not positive and finite, for a scene with more than walls, and
    where a bounce ends faster than the scene's `max_speed` (the tutorial has no such cap); RuntimeError
    after `MAX_BOUNCES` bounces.
    """
    return _tutorial_tick(scene, _tutorial_walls(scene), state, _checked_dt(dt), recheck)


def run(scene: Scene, position: Pair, velocity: Pair, dt: float, steps: int, recheck: bool = True) -> State:
    """`steps` ticks of `dt` seconds from `position` [m] and `velocity` [m/s]; raises as both above."""
    state = start(scene, position, velocity)
    walls = _tutorial_walls(scene)
    dt = _checked_dt(dt)
    for _ in range(steps):
        state = _tutorial_tick(scene, walls, state, dt, recheck)
    return state


def _tutorial_tick(scene: Scene, walls: list[Vector], state: State, dt: float, recheck: bool) -> State:
    gx, gy = scene.gravity
    velocity = (state.velocity[0] + gx * dt, state.velocity[1] + gy * dt)
    v1 = Vector(state.position, velocity[0] * dt, velocity[1] * dt, scene.ball.b, scene.ball.f)
    p1 = v1.p1
    left = 1.0  # share of the tick that is left
    sides = state.sides

    for bounces in range(MAX_BOUNCES):
        if bounces and not recheck:
            break
        sides = _tutorial_sides(walls, v1.p0, sides)
        closest = _tutorial_closest(walls, sides, v1, left)
        if closest is None:
            break
        ip, share, struck = closest
        v1.p0 = ip
        v1.vx, v1.vy = bounce(v1, walls[struck])
        left -= share
        p1 = (ip[0] + left * v1.vx, ip[1] + left * v1.vy)
        velocity = (v1.vx / dt, v1.vy / dt)
        _check_speed(scene, struck, velocity)
    else:
        raise RuntimeError(f"{MAX_BOUNCES} bounces in one tick at {v1.p0}: the point is caught between walls")

    return State(p1, velocity, sides)


def _tutorial_closest(
    walls: list[Vector], sides: tuple[int, ...], v1: Vector, left: float
) -> tuple[Pair, float, int] | None:
    """Return of the walls that the movement `left * v1` hits, the one with the closest intersection point.

    As (intersection point, share of `v1` to get there, index of the wall); None if nothing is in the way.
    """
    closest = None
    for index, v2 in enumerate(walls):
        towards = -sides[index] * (v1.vx * v2.lx + v1.vy * v2.ly) / v2.len
        if towards <= ROUNDING * v1.len:
            continue
        share = max(0.0, sides[index] * _tutorial_distance(v2, v1.p0) / towards)
        if share > left or (closest is not None and share >= closest[1]):
            continue
        ip = (v1.p0[0] + share * v1.vx, v1.p0[1] + share * v1.vy)
        along = (ip[0] - v2.p0[0]) * v2.dx + (ip[1] - v2.p0[1]) * v2.dy
        if -_tutorial_tolerance(v2, ip) <= along <= v2.len + _tutorial_tolerance(v2, ip):
            closest = (ip, share, index)
    return closest


def _tutorial_sides(walls: list[Vector], p0: Pair, before: Iterable[int]) -> tuple[int, ...]:
    """Return on which side of each wall's line `p0` is; within rounding of the line, the side `before`."""
    return tuple(_tutorial_side(v2, p0, side) for v2, side in zip(walls, before, strict=True))


def _tutorial_side(v2: Vector, p0: Pair, before: int) -> int:
    distance = _tutorial_distance(v2, p0)
    if abs(distance) <= _tutorial_tolerance(v2, p0):
        return before
    return 1 if distance > 0 else -1


def _tutorial_leaning(v2: Vector, velocity: Pair, gravity: Pair) -> int:
    """Return the side of a wall to which a point on it moves, or from which gravity presses it if it does not."""
    lean = velocity[0] * v2.lx + velocity[1] * v2.ly or -(gravity[0] * v2.lx + gravity[1] * v2.ly)
    return 1 if lean >= 0 else -1


def _tutorial_distance(v2: Vector, p: Pair) -> float:
    """Distance of `p` from the wall's line [m], positive where its normal points."""
    return ((p[0] - v2.p0[0]) * v2.lx + (p[1] - v2.p0[1]) * v2.ly) / v2.len


def _tutorial_tolerance(v2: Vector, p: Pair) -> float:
    return ROUNDING * max(abs(p[0]), abs(p[1]), *map(abs, v2.p0), *map(abs, v2.p1))


def _tutorial_walls(scene: Scene) -> list[Vector]:
    _refuse_more_than("scene", scene, ("gravity", "ball", "max_speed", "elements"))
    _refuse_more_than("ball", scene.ball, ("b", "f"))
    walls = []
    for index, element in enumerate(scene.elements):
        label = f"element {index} ({element.name or type(element).__name__})"
        if not isinstance(element, Wall):
            raise ValueError(f"{label}: a {type(element).__name__} is not allowed, the tutorial knows only Wall")
        _refuse_more_than(label, element, ("start", "end", "b", "f", "name"))
        (x0, y0), (x1, y1) = element.start, element.end
        walls.append(Vector((x0, y0), x1 - x0, y1 - y0, element.b, element.f))
    return walls


def _refuse_more_than(label: str, spec: Scene | Ball | Wall, known: tuple[str, ...]) -> None:
    for field in fields(spec):
        value = getattr(spec, field.name)
        if field.name not in known and value != field.default:
            raise ValueError(f"{label}: {field.name}={value} is not allowed, the tutorial has only {field.default}")


def _checked_dt(dt: float) -> float:
    if not (math.isfinite(dt) and dt > 0):
        raise ValueError(f"dt: {dt} is not allowed, must be positive and finite [s]")
    return float(dt)


def _check_speed(scene: Scene, index: int, velocity: Pair) -> None:
    cap = scene.max_speed
    if cap is not None and velocity[0] * velocity[0] + velocity[1] * velocity[1] > cap * cap:
        raise ValueError(
            f"element {index}: a bounce ends at {velocity} m/s, faster than max_speed={cap}; "
            "the tutorial has no cap on speed"
        )
