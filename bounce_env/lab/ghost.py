"""The tutorial's own stepper beside the exact engine, so that one sees how its error grows."""

import math
from dataclasses import replace

from bounce_env.engine.tutorial import Pair, State, start, step
from bounce_env.scene import Scene, Wall

TICK = 1 / 60
"""Of the stepper [s]: what games of its time took, a frame."""


class Ghost:
    """A point that the tutorial's algorithm moves in ticks through the same walls.

    scene: with walls alone, else ValueError says what the tutorial lacks.
    """

    def __init__(self, scene: Scene, position: Pair, velocity: Pair) -> None:
        self._state: State = start(_walls_of(scene), position, velocity)
        self._owed = 0.0

    @property
    def position(self) -> Pair:
        """Where the point is after its last tick [m]."""
        return self._state.position

    def advance(self, scene: Scene, seconds: float) -> None:
        """Let ticks pass, with the walls where they are now; raises ValueError and RuntimeError as `tutorial.step`."""
        self._owed += seconds
        while self._owed >= TICK - 1e-12:
            self._owed -= TICK
            self._state = step(_walls_of(scene), self._state, TICK)

    def error(self, position: Pair) -> float:
        """Return how far the point is from a ball that the engine moves [m]."""
        return math.dist(self.position, position)


def _walls_of(scene: Scene) -> Scene:
    """Return the scene with walls that nobody drags; all else stays, for the tutorial to refuse."""
    elements = (
        replace(e, draggable=False, min_length=None, reach=None) if isinstance(e, Wall) else e for e in scene.elements
    )
    return replace(scene, elements=tuple(elements))
