"""Scenes at random in which parts move and balls meet: a closed box, and commands at random instants."""

import math
from typing import Any

import numpy as np

from bounce_env import Ball, Bumper, Flipper, Paddle, Scene, Wall
from bounce_env.engine.placement import part_cores_at_start, place_clear, separate_placed_balls
from bounce_env.engine.world import World

MAX_SPEED = 250.0  # m/s, more than any part's surface


def moving_scene(rng: np.random.Generator, *, point: bool = False) -> Scene:
    """A unit box with up to three flippers, two paddles, two dragged walls, a bumper on a rail, and standing things."""
    pull = 0.0 if rng.random() < 0.2 else 10.0 ** rng.uniform(-1.0, 2.0)
    angle = rng.choice([0.0, 0.0, 0.5, rng.uniform(0.0, 2.0)]) * math.pi
    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    walls = [Wall(p, q, **_material(rng)) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)]
    parts = [
        *(_flipper(rng, f"flipper {i}") for i in range(rng.integers(0, 4))),
        *(_paddle(rng, f"paddle {i}") for i in range(rng.integers(0, 3))),
        *(_shuttle(rng, f"shuttle {i}") for i in range(rng.integers(0, 2))),
        *(_dragged(rng, f"dragged {i}") for i in range(rng.integers(0, 3))),
    ]
    standing = [_standing(rng) for _ in range(rng.integers(0, 4))]
    radius = 0.0 if point else float(10.0 ** rng.uniform(-2.5, -1.3))
    return Scene(
        gravity=(pull * math.sin(angle), -pull * math.cos(angle)),
        ball=Ball(radius=radius, b=float(rng.choice([1.0, 0.9, 0.5]))),
        rest_speed=0.0 if rng.random() < 0.5 else float(10.0 ** rng.uniform(-3.0, -0.5)),
        max_speed=MAX_SPEED,
        elements=(*walls, *parts, *standing),
    )


def start(rng: np.random.Generator, world: World, balls: int) -> bool:
    """Put the balls of a world where there is room; False where there is hardly any."""
    scene, places = world.scene, list[tuple[float, float]]()
    radius = scene.ball.radius
    for _ in range(400):
        try:
            place = place_clear(scene, part_cores_at_start(scene), *rng.uniform(radius, 1.0 - radius, 2).tolist())
            separate_placed_balls(scene, np.array([*places, place]))
        except ValueError:
            continue
        places.append(place)
        if len(places) == balls:
            speeds = rng.choice([0.0, 0.1, 1.0, 10.0], balls)[:, None] * _directions(rng, balls)
            world.reset(position=places, velocity=speeds)
            return True
    return False


def command_at_random(rng: np.random.Generator, world: World) -> None:
    """Tell one of the parts to move otherwise, if there is any."""
    parts = world.scene.parts
    if not parts:
        return
    _, part = parts[rng.integers(len(parts))]
    if isinstance(part, Flipper):
        world.command(part.name, bool(rng.random() < 0.5))
    elif isinstance(part, Wall):
        world.command(part.name, _end_speeds(rng))
    else:
        fastest = part.max_speed if isinstance(part, Paddle) else part.speed
        world.command(part.name, float(rng.choice([-1.0, 0.0, 1.0, rng.uniform(-1.0, 1.0)])) * fastest)


def _end_speeds(rng: np.random.Generator) -> np.ndarray:
    """Velocities of a wall's two ends: both at rest, alike, one of them, or each its own."""
    speeds = 10.0 ** rng.uniform(-2.0, 2.0) * rng.uniform(-1.0, 1.0, (2, 2))
    match rng.integers(5):
        case 0:
            return np.zeros((2, 2))
        case 1:
            return np.stack([speeds[0], speeds[0]])
        case 2:
            return speeds * [[1.0], [0.0]]
    return speeds


def _directions(rng: np.random.Generator, count: int) -> np.ndarray:
    angles = rng.uniform(0.0, 2.0 * math.pi, count)
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _material(rng: np.random.Generator) -> dict[str, Any]:
    return {
        "b": float(rng.choice([0.0, 0.5, 0.9, 1.0, rng.uniform(0.0, 1.2)])),
        "f": float(rng.choice([0.0, 0.9, 1.0, 1.0, rng.uniform(0.0, 1.0)])),
        "kick": float(rng.choice([0.0, 0.0, 0.0, rng.uniform(0.0, 2.0)])),
    }


def _place(rng: np.random.Generator) -> tuple[float, float]:
    x, y = rng.uniform(0.15, 0.85, 2).tolist()
    return x, y


def _flipper(rng: np.random.Generator, name: str) -> Flipper:
    length, rest = rng.uniform(0.03, 0.14), rng.uniform(0.0, 2.0 * math.pi)
    stroke = float(rng.choice([-1.0, 1.0])) * rng.uniform(0.1, 3.0)
    up, down = (10.0 ** rng.uniform(-0.5, 2.3, 2)).tolist()
    return Flipper(
        _place(rng), length, radius=float(rng.uniform(0.003, 0.02)), rest_angle=rest, active_angle=rest + stroke,
        up_speed=up, down_speed=down, name=name, **_material(rng),
    )  # fmt: skip


def _paddle(rng: np.random.Generator, name: str) -> Paddle:
    start, end = _place(rng), _place(rng)
    shape = {"half_width": float(rng.choice([0.0, rng.uniform(0.01, 0.1)])), "radius": float(rng.uniform(0.005, 0.03))}
    return Paddle(start, end, max_speed=float(10.0 ** rng.uniform(-1.0, 2.0)), name=name, **shape, **_material(rng))


def _dragged(rng: np.random.Generator, name: str) -> Wall:
    start, end = _place(rng), _place(rng)
    shortest = None if rng.random() < 0.5 else float(rng.uniform(0.01, 1.0)) * math.dist(start, end)
    box = ((0.1, 0.1), (0.9, 0.9)) if rng.random() < 0.7 else None
    return Wall(start, end, draggable=True, min_length=shortest, reach=box, name=name, **_material(rng))


def _shuttle(rng: np.random.Generator, name: str) -> Bumper:
    radius, speed = float(rng.uniform(0.01, 0.08)), float(10.0 ** rng.uniform(-1.0, 1.0))
    return Bumper(_place(rng), radius, rail_end=_place(rng), speed=speed, name=name, **_material(rng))


def _standing(rng: np.random.Generator) -> Wall | Bumper:
    if rng.random() < 0.5:
        return Bumper(_place(rng), float(rng.uniform(0.02, 0.08)), **_material(rng))
    return Wall(_place(rng), _place(rng), **_material(rng))
