"""From where a person points to an action: a paddle that follows, an end of a wall that is drawn."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from bounce_env.games.episode import FPS
from bounce_env.games.walls.setup import WALL_SPEED
from bounce_env.scene import Paddle, Scene, Wall


def pointed(
    space: spaces.Space[Any], scene: Scene, cores: npt.NDArray[np.float64], to: Sequence[float], end: int
) -> Any:
    """Return the action for a frame that brings a part toward a place [m]; None where the game has no such action.

    end: of a wall, 0 or 1.
    """
    parts = [(part, core) for (_, part), core in zip(scene.parts, cores, strict=True)]
    for part, core in parts:
        if isinstance(part, Paddle) and isinstance(space, spaces.Box | spaces.Discrete):
            return _paddle(space, part, core, to)
        if isinstance(part, Wall) and isinstance(space, spaces.Box):
            action = np.zeros(4, np.float32)
            away = np.array(to) - core[2 * end : 2 * end + 2]
            action[2 * end : 2 * end + 2] = np.clip(away * FPS / WALL_SPEED, -1.0, 1.0)
            return action
    return None


def _paddle(space: spaces.Space[Any], part: Paddle, core: npt.NDArray[np.float64], to: Sequence[float]) -> Any:
    along = np.subtract(part.rail_end, part.rail_start)
    along /= np.linalg.norm(along)
    away = float(np.dot(np.array(to) - 0.5 * (core[:2] + core[2:]), along))
    share = min(max(away * FPS / part.max_speed, -1.0), 1.0)
    if isinstance(space, spaces.Discrete):
        return 1 + (share > 0.5) - (share < -0.5)
    return np.array([share], np.float32)
