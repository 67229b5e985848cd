"""Seeded random scenes and starts for the reference tests."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from bounce_env.scene import Arc, Ball, Bumper, Element, Paddle, Scene, Sensor, Wall

Point = tuple[float, float]


class Case(NamedTuple):
    scene: Scene
    position: Point
    velocity: Point
    commands: tuple[tuple[float, float], ...] = ()  # (time, speed) of the paddle, at dyadic times


def polygon(corners: list[Point], surfaces: list[dict[str, float]] | None = None) -> tuple[Wall, ...]:
    """Walls from corner to corner and back to the first, with `surfaces[k]` as keywords of wall k."""
    n = len(corners)
    return tuple(
        Wall(corners[k], corners[(k + 1) % n], **(surfaces[k] if surfaces else {}), name=f"side {k}") for k in range(n)
    )


def box(width: float, height: float, angle: float = 0.0, surfaces: list[dict[str, float]] | None = None):
    """Four walls, counter-clockwise from the floor, turned by `angle` about the lower left corner."""
    c, s = math.cos(angle), math.sin(angle)
    corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
    return polygon([(x * c - y * s, x * s + y * c) for x, y in corners], surfaces)


def direction(rng: np.random.Generator, speed: float) -> Point:
    angle = rng.uniform(0, 2 * math.pi)
    return speed * math.cos(angle), speed * math.sin(angle)


def distance_to_segment(p: Point, a: Point, b: Point) -> float:
    along = np.subtract(b, a)
    share = np.clip(np.dot(np.subtract(p, a), along) / np.dot(along, along), 0, 1)
    return float(np.linalg.norm(np.subtract(p, a) - share * along))


def clearance(p: Point, element: Element) -> float:
    """Distance of a point from an element [m]; of a paddle, from all that it can reach."""
    if isinstance(element, Bumper):
        return math.dist(p, element.center) - element.radius
    if isinstance(element, Paddle):
        return distance_to_segment(p, element.rail_start, element.rail_end) - element.half_width - element.radius
    if isinstance(element, Arc):
        return abs(math.dist(p, element.center) - element.radius)
    if isinstance(element, Sensor) and element.circle is not None:
        return abs(math.dist(p, element.circle[0]) - element.circle[1])
    return distance_to_segment(p, element.start, element.end)


def free_point(rng: np.random.Generator, low: Point, high: Point, elements: tuple[Element, ...], gap: float) -> Point:
    """A point of the rectangle from `low` to `high` that is more than `gap` away from every element."""
    for _ in range(10_000):
        p = (float(rng.uniform(low[0], high[0])), float(rng.uniform(low[1], high[1])))
        if all(clearance(p, element) > gap for element in elements):
            return p
    raise AssertionError("no free point found")


def walls_only(seed: int, *, gravity: Point = (0.0, 0.0), lossy: bool = True) -> Case:
    """A point in a turned box with three short walls standing in it."""
    rng = np.random.default_rng(seed)

    def surface() -> dict[str, float]:
        return {"b": rng.uniform(0.9, 1.05), "f": rng.uniform(0.95, 1.0)} if lossy else {}

    width, height, angle = rng.uniform(0.8, 2), rng.uniform(0.8, 2), rng.uniform(0, 2 * math.pi)
    outside = box(width, height, angle, [surface() for _ in range(4)])
    c, s = math.cos(angle), math.sin(angle)

    def turned(p: Point) -> Point:
        return p[0] * c - p[1] * s, p[0] * s + p[1] * c

    def inner() -> Wall:
        middle = (rng.uniform(0.3, 0.7) * width, rng.uniform(0.3, 0.7) * height)
        half = direction(rng, 0.1)
        ends = [turned((middle[0] + k * half[0], middle[1] + k * half[1])) for k in (-1, 1)]
        return Wall(ends[0], ends[1], **surface())

    elements = (*outside, *(inner() for _ in range(3)))
    p = turned((rng.uniform(0.05, 0.15) * width, rng.uniform(0.05, 0.95) * height))
    ball = Ball(b=rng.uniform(0.95, 1), f=rng.uniform(0.98, 1)) if lossy else Ball()
    scene = Scene(gravity=gravity, ball=ball, max_speed=1e6, elements=elements)
    return Case(scene, p, direction(rng, rng.uniform(0.5, 3)))


def curves(rng: np.random.Generator) -> list[Element]:
    """A cup, an arch of more than half a turn, a one-way wall and a circular sensor, for `table`."""
    start, wide = rng.uniform(3.0, 3.4), rng.uniform(-0.6, 0.2)
    return [
        Arc((0.2, 0.7), rng.uniform(0.1, 0.15), start, start + rng.uniform(2.0, 3.0), b=0.95, name="cup"),
        Arc((0.72, 0.72), rng.uniform(0.12, 0.2), wide, wide + rng.uniform(3.3, 4.5), f=0.97, name="arch"),
        Wall((0.35, 0.5), (0.6, 0.5 + rng.uniform(-0.05, 0.05)), b=0.9, one_way=True, name="gate"),
        Sensor(center=(0.5, rng.uniform(0.3, 0.9)), radius=0.15, name="ring"),
    ]


def table(
    seed: int,
    *,
    gravity: bool,
    radius: float,
    paddle: bool = False,
    kick: bool = False,
    drain: bool = False,
    curved: bool = False,
) -> Case:
    """A field of 1.0 m x 1.4 m with bumpers, a slanted wall, sensors; on request paddle, kicks, cap, curves."""
    rng = np.random.default_rng(seed)
    elements: list[Element] = list(
        box(1.0, 1.4, surfaces=[{"b": rng.uniform(0.85, 1), "f": rng.uniform(0.9, 1)} for _ in range(4)])
    )
    elements.append(Wall((0.15, 0.45), (0.25, 0.35 + rng.uniform(0, 0.05)), b=0.9, name="slant"))
    for x, y in ((0.25, 1.0), (0.75, 1.0), (0.5, 1.2), (0.5, 0.8)):
        center = (x + rng.uniform(-0.05, 0.05), y + rng.uniform(-0.05, 0.05))
        more = {"b": 1.1, "kick": rng.uniform(0.2, 1.5), "kick_threshold": rng.uniform(0, 1)} if kick else {}
        elements.append(Bumper(center, rng.uniform(0.04, 0.08), **more))
    elements.append(Sensor((0.1, 0.65), (0.9, 0.55 + rng.uniform(0, 0.1)), name="line"))
    elements.append(Sensor((0.5, 0.3), (0.6, 1.35), name="upright"))
    if curved:
        elements += curves(rng)
    if drain:
        elements.append(Sensor((0.3, 0.2), (0.7, 0.25), drain=True, name="drain"))
    commands: tuple[tuple[float, float], ...] = ()
    if paddle:
        elements.append(
            Paddle(
                (0.2, 0.12), (0.8, 0.12), half_width=0.1, radius=0.02, max_speed=1.5, b=0.95, f=0.7,
                kick=0.5 if kick else 0.0, kick_threshold=0.05, name="paddle",
            )
        )  # fmt: skip
        instants = np.sort(rng.choice(np.arange(1, 64 * 4), size=12, replace=False)) / 64
        # odd speeds, so that a stop is never reached at the very instant of a command
        speeds = [-1.5, 0.0, 1.5, *rng.uniform(-1.5, 1.5, size=3)]
        commands = tuple((float(t), float(rng.choice(speeds))) for t in instants)
    scene = Scene(
        gravity=(rng.uniform(-0.3, 0.3), -1.5) if gravity else (0.0, 0.0),
        ball=Ball(radius=radius, b=0.98, f=0.99),
        max_speed=2.5 if kick else None,
        elements=tuple(elements),
    )
    p = free_point(rng, (0, 0.3), (1, 1.4), scene.elements, 1.5 * radius + 0.01)
    return Case(scene, p, direction(rng, rng.uniform(1, 2)), commands)
