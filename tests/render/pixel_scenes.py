"""The scene and the measures that the pixel tests share."""

from functools import cache

import numpy as np
import numpy.typing as npt

from bounce_env.render import Picture, Renderer
from bounce_env.render.shapes import ball_look
from bounce_env.scene import Ball, Bumper, Paddle, Scene, Sensor, Wall

TABLE = Scene(
    gravity=(0.0, -1.5),
    ball=Ball(radius=0.02),
    max_speed=3.0,
    elements=(
        Wall((0.0, 0.0), (0.0, 1.4), name="left"),
        Wall((1.0, 0.0), (1.0, 1.4), name="right"),
        Wall((0.0, 1.4), (1.0, 1.4), name="top"),
        Wall((0.15, 0.35), (0.4, 0.5), name="ramp"),
        Bumper((0.25, 1.0), 0.06, b=1.2, name="lively"),
        Bumper((0.75, 1.0), 0.06, name="post"),
        Paddle((0.1, 0.08), (0.9, 0.08), half_width=0.1, radius=0.012, max_speed=1.5, name="paddle"),
        Sensor((0.0, 0.0), (1.0, 0.0), drain=True, name="drain"),
        Sensor((0.6, 0.5), (0.9, 0.5), name="gate"),
    ),
)
"""One of everything, with room between."""


def paddle_at(x: float) -> tuple[tuple[float, float, float, float]]:
    """The core of the table's paddle with its middle at `x`."""
    return ((x - 0.1, 0.08, x + 0.1, 0.08),)


PADDLE = paddle_at(0.5)
"""Where the paddle stands while something else is looked at."""

INDEX = {element.name: i for i, element in enumerate(TABLE.elements)}


@cache
def table_renderer(width: int | None = 400, height: int | None = 560) -> Renderer:
    """The one renderer of `TABLE` of this size: a frame leaves no trace in it, which has a test of its own."""
    return Renderer(TABLE, width, height)


def hits_on(*names: str) -> npt.NDArray[np.int64]:
    """The `hits` of a picture of `TABLE` in which these elements were struck."""
    hits = np.zeros(len(TABLE.elements), np.int64)
    hits[[INDEX[name] for name in names]] = 1
    return hits


def changed(frame: npt.NDArray[np.uint8], other: npt.NDArray[np.uint8]) -> npt.NDArray[np.int64]:
    """How much each pixel differs, summed over the colours, (height, width)."""
    return np.abs(frame.astype(np.int64) - other.astype(np.int64)).sum(axis=2)


def centroid(weights: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    """Pixel coordinates (x, y) of the centre of what is marked."""
    rows, columns = np.nonzero(weights)
    mass = weights[rows, columns]
    return np.array([(columns + 0.5) @ mass, (rows + 0.5) @ mass]) / mass.sum()


def distances(renderer: Renderer, point: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """From each pixel's centre to a point of the scene, in pixels, (height, width)."""
    x, y = renderer.projection.to_pixels(point)
    columns = np.arange(renderer.projection.width) + 0.5
    rows = np.arange(renderer.projection.height)[:, None] + 0.5
    return np.hypot(columns - x, rows - y)


def empty_table(renderer: Renderer) -> npt.NDArray[np.uint8]:
    """A frame of `TABLE` without a ball."""
    return renderer.frame(Picture(balls=(), cores=PADDLE))


def ball_color(renderer: Renderer) -> tuple[int, ...]:
    """The opaque colour of the ball of `TABLE`."""
    return ball_look(TABLE, renderer.projection)[-1].color[:3]
