"""A grid of starts in contact: scenes in which a ball begins on a surface, moving along it, off it or not at all.

Surfaces: the inside and the outside of circles, arcs with ends, walls, and joints of walls and arcs (tangent or at a
corner, with the first going on beneath or not). Angles are whole multiples of a step, so that the special ones
(level, upright, the rim, top and bottom) are among them; speeds include none, next to none, and that of zero press.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

from bounce_env import Arc, Ball, Bumper, Scene, Wall

G = 9.81
ROOM = 2.5  # [m] half the side of the box around everything
B, F = (0.0, 0.5, 0.9, 0.99, 1.0, 1.5), (0.0, 0.5, 1.0)
RADII = (0.0, 0.05)
SPEEDS = (0.0, 1e-9, 0.3, "press", "loop", 5.0)


class Start(NamedTuple):
    """A scene and how its ball begins; `name` tells them apart."""

    name: str
    scene: Scene
    position: tuple[float, float]
    velocity: tuple[float, float]
    closed: bool  # whether it is on a closed circle of radius 1 about the origin


def starts(step: int) -> Iterator[Start]:
    """Return all of the grid, on circles every `step` degrees."""
    for r in RADII:
        for b in B:
            for f in F:
                for rest_speed in (0.0, 0.05):
                    yield from _on_circles(r, b, f, rest_speed, step)
                    yield from _at_joints(r, b, f, rest_speed)


def _scene(r: float, rest_speed: float, elements: tuple[object, ...]) -> Scene:
    corners = ((-ROOM, -ROOM), (ROOM, -ROOM), (ROOM, ROOM), (-ROOM, ROOM))
    box = tuple(Wall(corners[i], corners[(i + 1) % 4]) for i in range(4))
    return Scene(
        gravity=(0.0, -G), ball=Ball(radius=r), rest_speed=rest_speed, max_speed=20.0, elements=(*box, *elements)
    )


def _speed(kind: float | str, rho: float, cosine: float) -> float:
    """Return a speed [m/s]; cosine: of the angle from the highest point."""
    if kind == "press":
        return math.sqrt(G * rho * abs(cosine))
    if kind == "loop":
        return math.sqrt(G * rho * max(3.0 + 2.0 * -cosine, 0.0))
    return float(kind)


def _on_circles(r: float, b: float, f: float, rest_speed: float, step: int) -> Iterator[Start]:
    for inside in (True, False):
        rho = 1.0 - r if inside else 1.0 + r
        for degrees in range(0, 360, step):
            a = math.radians(degrees)
            nx, ny = math.sin(a), math.cos(a)
            closed = Arc((0, 0), 1.0, 0.0, 2 * math.pi, b=b, f=f) if inside else Bumper((0, 0), 1.0, b=b, f=f)
            for kind in SPEEDS:
                speed = _speed(kind, rho, ny)
                for sign in (1.0, -1.0) if speed > 0.0 else (1.0,):
                    name = f"r={r} b={b} f={f} rs={rest_speed} inside={inside} {degrees} deg speed={kind} {sign:+.0f}"
                    scene = _scene(r, rest_speed, (closed,))
                    velocity = (sign * speed * ny, -sign * speed * nx)
                    yield Start(name, scene, (rho * nx, rho * ny), velocity, True)


def _at_joints(r: float, b: float, f: float, rest_speed: float) -> Iterator[Start]:
    """A floor that goes on as an arc, tangent to it or not, split where it begins, going on beneath or ending."""
    radius = 0.5
    for beneath in ("split", "whole", "ends"):
        for tilt in (0.0, 0.5):
            start = -0.5 * math.pi + tilt
            center = (-radius * math.cos(start), -radius * math.sin(start))  # the arc begins at the origin
            arc = Arc(center, radius, start, start + 0.75 * math.pi, b=b, f=f)
            floors = {
                "split": (Wall((-2, 0), (0, 0), b=b, f=f), Wall((0, 0), (1, 0), b=b, f=f)),
                "whole": (Wall((-2, 0), (1, 0), b=b, f=f),),
                "ends": (Wall((-2, 0), (0, 0), b=b, f=f),),
            }[beneath]
            for x in (-0.25, 0.0):
                for speed in (0.0, 1e-9, 0.5, 3.0):
                    name = f"r={r} b={b} f={f} rs={rest_speed} floor {beneath}, arc {tilt}, x={x} speed={speed}"
                    yield Start(name, _scene(r, rest_speed, (*floors, arc)), (x, r), (speed, 0.0), False)
