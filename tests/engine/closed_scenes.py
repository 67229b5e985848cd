"""Closed scenes at random: whatever is thrown into them must stay inside."""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from bounce_env import Ball, Bumper, Scene, Wall, WorldBatch
from bounce_env.engine.placement import place_clear

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Closed:
    """A scene inside a polygon of walls."""

    scene: Scene
    corners: list[tuple[float, float]]

    def holds(self, x: float, y: float) -> bool:
        """Whether a point is inside the polygon (even-odd rule)."""
        inside = False
        for (x1, y1), (x2, y2) in zip(self.corners, self.corners[1:] + self.corners[:1], strict=True):
            if (y1 > y) != (y2 > y) and x < (x2 - x1) * (y - y1) / (y2 - y1) + x1:
                inside = not inside
        return inside

    def starts(self, rng: np.random.Generator, count: int) -> tuple[Floats, Floats] | None:
        """Places free of overlap (100 different ones at most) and `count` velocities of 0.1 to 10 m/s.

        None where there is hardly any room.
        """
        different = min(count, 100)
        places: list[tuple[float, float]] = []
        for _ in range(60 * different):
            x, y = rng.uniform(-1.6, 1.6, 2).tolist()
            if self.holds(x, y):
                try:
                    places.append(place_clear(self.scene, {}, x, y))
                except ValueError:
                    continue
            if len(places) == different:
                angle, speed = rng.uniform(0.0, 2.0 * np.pi, count), 10.0 ** rng.uniform(-1.0, 1.0, count)
                return np.resize(places, (count, 2)), np.c_[speed * np.cos(angle), speed * np.sin(angle)]
        return None


def closed_scene(rng: np.random.Generator, radius: float, gravity: tuple[float, float]) -> Closed:
    """An irregular polygon, convex or not, with bumpers and walls inside that may cross; everything elastic."""
    sides = int(rng.integers(3, 9))
    while True:
        angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, sides))
        gaps = np.diff(np.append(angles, angles[0] + 2.0 * np.pi))
        if gaps.min() > 0.35 and gaps.max() < 2.5:
            break
    reach = rng.uniform(0.5, 1.5, sides)
    corners = [(float(r * math.cos(a)), float(r * math.sin(a))) for r, a in zip(reach, angles, strict=True)]
    walls = [Wall(p, q) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)]
    for _ in range(rng.integers(0, 4)):
        start = rng.uniform(-0.5, 0.5, 2)
        walls.append(Wall(start.tolist(), (start + rng.uniform(-0.3, 0.3, 2)).tolist()))
    bumpers = [
        Bumper(rng.uniform(-0.4, 0.4, 2).tolist(), float(rng.uniform(0.02, 0.1))) for _ in range(rng.integers(0, 6))
    ]
    return Closed(Scene(gravity=gravity, ball=Ball(radius=radius), elements=(*walls, *bumpers)), corners)


def rows_of(worlds: WorldBatch) -> Floats:
    """x, y, vx, vy of every world's ball."""
    return np.concatenate((worlds.position[:, 0], worlds.velocity[:, 0]), axis=1)
