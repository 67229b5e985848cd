"""Random starts of a ball anywhere in a scene."""

import math
from collections.abc import Iterator
from itertools import islice

import numpy as np
import numpy.typing as npt

from bounce_env.engine.placement import element_gaps, part_cores_at_start
from bounce_env.scene import Scene
from bounce_env.scenecheck.inside import Inside

Floats = npt.NDArray[np.float64]

AT_ONCE = 1000
"""Places that are drawn at a time."""

TRIES = 10 * AT_ONCE
"""Places in a row that are tried in vain before the scene counts as full."""


class NoRoomError(ValueError):
    """A scene in which no place was found for a ball."""


def random_starts(scene: Scene, inside: Inside | None, balls: int, seed: int) -> Floats:
    """Starts of `balls` balls, (balls, 4): x, y [m], vx, vy [m/s].

    Places are uniform over the inside of a table, or over the scene's bounds where there is none, as far as the ball
    overlaps nothing; directions are uniform, speeds uniform up to `fastest`. Raises NoRoomError.
    """
    generator = np.random.default_rng(seed)
    speed, angle = generator.uniform(0.0, fastest(scene), balls), generator.uniform(0.0, 2.0 * math.pi, balls)
    places = list(islice(_places(scene, inside, generator), balls))
    return np.column_stack([np.array(places), speed * np.cos(angle), speed * np.sin(angle)])


def _places(scene: Scene, inside: Inside | None, generator: np.random.Generator) -> Iterator[tuple[float, float]]:
    left, bottom, right, top = scene.bounds
    cores = part_cores_at_start(scene)
    missed = 0
    while missed < TRIES:
        for x, y in generator.uniform((left, bottom), (right, top), (AT_ONCE, 2)).tolist():
            missed += 1
            within = inside is None or inside.holds(x, y)
            if within and all(gap >= 0.0 for _, gap in element_gaps(scene, cores, x, y)):
                missed = 0
                yield x, y
    raise NoRoomError(
        f"ball.radius = {scene.ball.radius!r}: no room for the ball in {missed} random places of the scene"
    )


def fastest(scene: Scene) -> float:
    """Up to what speed balls start [m/s].

    The scene's `max_speed`; without one, what a fall through the whole scene gives; without gravity, what crosses it in
    a second.
    """
    if scene.max_speed is not None:
        return scene.max_speed
    left, bottom, right, top = scene.bounds
    across = math.hypot(right - left, top - bottom)
    pull = math.hypot(*scene.gravity)
    return math.sqrt(2.0 * pull * across) if pull > 0.0 else across
