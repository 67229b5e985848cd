"""Random closed scenes in which several balls fall on each other, and what must hold of them at any time."""

import math
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from bounce_env import Arc, Ball, Bumper, Scene, Wall, World
from bounce_env.engine.packing import scene_extent
from bounce_env.engine.placement import element_gaps
from bounce_env.scene import Element

Floats = npt.NDArray[np.float64]
HEIGHT = 3.0
KINDS = ("box", "wedge", "bowl", "bumpers", "tilted")


def pile_scene(rng: np.random.Generator) -> Scene:
    """Return a shaft of some width with something at its bottom, and balls of some size and material."""
    width, kind, f = float(rng.choice([0.5, 0.7, 1.0])), str(rng.choice(KINDS)), float(rng.choice([1.0, 1.0, 0.9, 0.0]))
    elements: list[Element] = [
        Wall((width, 0.0), (width, HEIGHT)),
        Wall((width, HEIGHT), (0.0, HEIGHT)),
        Wall((0.0, HEIGHT), (0.0, 0.0)),
        Wall((0.0, 0.0), (width, 0.0), f=f),
    ]
    if kind == "wedge":
        elements += [Wall((0.0, 0.4), (width / 2, 0.0), f=f), Wall((width / 2, 0.0), (width, 0.4), f=f)]
    elif kind == "tilted":
        elements.append(Wall((0.0, 0.3), (width, 0.1), f=f))
    elif kind == "bowl":
        elements.append(Arc((width / 2, width / 2 + 0.01), width / 2, math.pi, 2.0 * math.pi, f=f))
    elif kind == "bumpers":
        places = rng.uniform((0.1, 0.1), (width - 0.1, 0.6), (3, 2))
        elements += [Bumper((float(x), float(y)), float(rng.uniform(0.02, 0.1)), f=f) for x, y in places]
    gravity = [(0.0, -9.81), (0.0, -9.81), (1.0, -5.0), (0.0, 0.0)][int(rng.integers(4))]
    ball = Ball(radius=float(rng.choice([0.03, 0.05, 0.08])), b=float(rng.choice([0.0, 0.3, 0.5, 0.9, 1.0])))
    return Scene(gravity=gravity, ball=ball, rest_speed=float(rng.choice([0.0, 0.0, 0.01])), elements=tuple(elements))


def pile_start(rng: np.random.Generator, scene: Scene, balls: int) -> tuple[Floats, Floats] | None:
    """Return places above all that is at the bottom, and speeds; None where that many balls find no room."""
    r, width = scene.ball.radius, max(wall.start[0] for wall in scene.elements if isinstance(wall, Wall))
    places: list[tuple[float, float]] = []
    for _ in range(2000):
        x, y = rng.uniform((r, 1.0), (width - r, HEIGHT - r)).tolist()
        if all(math.dist((x, y), place) > 2.0 * r for place in places):
            places.append((x, y))
        if len(places) == balls:
            return np.array(places), rng.uniform((-1.0, -2.0), (1.0, 1.0), (balls, 2))
    return None


def energy(world: World) -> float:
    """Return the energy per mass [J/kg] of all balls."""
    return float(0.5 * (world.velocity**2).sum() - (world.position @ np.array(world.scene.gravity)).sum())


def faults(world: World) -> Iterator[str]:
    """Tell where balls overlap each other or an element by more than 1e-9 of the scene, or have left it."""
    scene, places = world.scene, world.position
    allowed = 1e-9 * scene_extent(scene)
    if not np.isfinite(places).all():
        yield "not finite"
    apart = np.hypot(*(places[:, None] - places[None]).T) + 9.0 * np.eye(len(places))
    if apart.min() < 2.0 * scene.ball.radius - allowed:
        yield f"balls overlap by {2.0 * scene.ball.radius - apart.min():.3g} m"
    for k, (x, y) in enumerate(places.tolist()):
        for element, gap in element_gaps(scene, {}, x, y):
            if gap < -allowed:
                yield f"ball {k} is {-gap:.3g} m deep in element {element}"
        if not (-allowed <= x <= 1.0 + allowed and -allowed <= y <= HEIGHT + allowed):
            yield f"ball {k} has left the scene"
