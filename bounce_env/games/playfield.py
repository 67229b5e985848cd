"""The field that a game is played on, as an agent sees it: from -1 to 1 along x and along y."""

import math

from bounce_env.engine.compile.jit import Record, function


@function
def place_seen(field: Record, x: float, y: float) -> tuple[float, float]:
    """Return a place [m] as it is observed. field: with its lower left corner x, y [m], and x_scale, y_scale [1/m]."""
    return (x - field.x) * field.x_scale - 1.0, (y - field.y) * field.y_scale - 1.0


def speed_bound(fastest: float, gravity: tuple[float, float], width: float, height: float) -> float:
    """The fastest [m/s] that a ball is seen: the cap acts at bounces, and it may fall through the field after one."""
    gx, gy = gravity
    return math.sqrt(fastest**2 + 2.0 * (abs(gx) * width + abs(gy) * height))
