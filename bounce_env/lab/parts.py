"""Where moving parts are, as pages draw them."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Flipper, Scene, Wall


def parts_of(scene: Scene, cores: npt.NDArray[np.float64]) -> list[list[Any]]:
    """Return [index, [number ...]] of each part of a scene: a flipper's angle, a centre, a wall's ends.

    cores: as `World.cores`, (parts, 4) [m].
    """
    found: list[list[Any]] = []
    for (index, part), (x0, y0, x1, y1) in zip(scene.parts, cores.tolist(), strict=True):
        if isinstance(part, Wall):
            found.append([index, [x0, y0, x1, y1]])
        elif isinstance(part, Flipper):
            found.append([index, [math.atan2(y1 - y0, x1 - x0)]])
        else:
            found.append([index, [0.5 * (x0 + x1), 0.5 * (y0 + y1)]])
    return found
