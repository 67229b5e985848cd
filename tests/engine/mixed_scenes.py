"""Scenes at random that mix all standing elements in a closed box."""

import math
from typing import Any

import numpy as np

from bounce_env import Arc, Ball, Bumper, Field, Scene, Sensor, Wall
from bounce_env.engine.placement import place_clear

MAX_SPEED = 20.0  # m/s


def mixed_scene(rng: np.random.Generator, radius: float) -> Scene:
    """A unit box with up to twelve elements of any kind and material inside; b 0 to 3, f 0 to 1, gravity 0 to 1000."""
    pull = 0.0 if rng.random() < 0.2 else 10.0 ** rng.uniform(-1.0, 3.0)
    angle = rng.choice([0.0, 0.5, 1.0, 1.5]) * math.pi if rng.random() < 0.5 else rng.uniform(0.0, 2.0 * math.pi)
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    walls = [Wall(p, q, **_material(rng)) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)]
    inside = [_element(rng) for _ in range(rng.integers(0, 13))]
    return Scene(
        gravity=(pull * math.sin(angle), -pull * math.cos(angle)),
        ball=Ball(radius=radius, b=float(rng.choice([1.0, 0.9])), f=float(rng.choice([1.0, 0.95]))),
        rest_speed=0.0 if rng.random() < 0.5 else 10.0 ** rng.uniform(-4.0, -0.5),
        max_speed=MAX_SPEED,
        elements=(*walls, *inside),
    )


def start_in(rng: np.random.Generator, scene: Scene) -> tuple[tuple[float, float], tuple[float, float]] | None:
    """A place free of overlap and a velocity of 0 to 10 m/s; None where there is hardly any room."""
    for _ in range(200):
        x, y = rng.uniform(scene.ball.radius, 1.0 - scene.ball.radius, 2).tolist()
        try:
            place = place_clear(scene, {}, x, y)
        except ValueError:
            continue
        angle, speed = rng.uniform(0.0, 2.0 * math.pi), rng.choice([0.0, 0.1, 1.0, 10.0])
        return place, (speed * math.cos(angle), speed * math.sin(angle))
    return None


def _material(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "b": float(rng.choice([0.0, 0.5, 0.9, 0.99, 1.0, rng.uniform(0.0, 3.0)])),
        "f": float(rng.choice([0.0, 0.9, 1.0, 1.0, rng.uniform(0.0, 1.0)])),
        "kick": float(rng.choice([0.0, 0.0, 0.0, rng.uniform(0.0, 2.0)])),
        "kick_threshold": float(rng.uniform(0.0, 0.2)),
        "cooldown": float(rng.choice([0.0, 0.1])),
    }


def _element(rng: np.random.Generator) -> Wall | Bumper | Arc | Sensor | Field:
    at = rng.uniform(0.1, 0.9, 2)
    kind = rng.integers(0, 8)
    if kind <= 2:
        end = at + rng.uniform(-0.3, 0.3, 2)
        return Wall(at.tolist(), end.tolist(), one_way=bool(rng.random() < 0.2), **_material(rng))
    if kind == 3:
        return Bumper(at.tolist(), float(rng.uniform(0.02, 0.15)), **_material(rng))
    if kind <= 5:
        start = rng.uniform(0.0, 2.0 * math.pi)
        span = 2.0 * math.pi if rng.random() < 0.1 else rng.uniform(0.1, 6.0)
        return Arc(at.tolist(), float(rng.uniform(0.12, 0.4)), start, start + span, **_material(rng))
    if kind == 6:
        if rng.random() < 0.5:
            return Sensor(center=at.tolist(), radius=float(rng.uniform(0.02, 0.2)))
        return Sensor(at.tolist(), (at + rng.uniform(-0.3, 0.3, 2)).tolist())
    size = rng.uniform(0.05, 0.2)
    corners = [(at[0] + size * c, at[1] + size * s) for c, s in ((1.0, 0.1), (-0.2, 0.9), (-0.8, -0.7))]
    return Field(tuple(corners), rng.uniform(-20.0, 20.0, 2).tolist())
