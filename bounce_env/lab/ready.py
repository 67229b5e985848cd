"""Which kernels somebody waits for."""

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

from bounce_env.scene import Scene


class Wanted(NamedTuple):
    """Kernels of worlds ("point", "disc") or of a game, by its id; scene: the path of one of its own."""

    what: str
    scene: str = ""


POINT, DISC = Wanted("point"), Wanted("disc")
"""Balls without a radius, and with one, have kernels of their own."""

Ready: TypeAlias = Callable[[Wanted], None]
"""Returns when kernels are on disk, or cannot be."""


def at_once(wanted: Wanted) -> None:
    """Wait for nothing: who needs a kernel compiles it."""


def wanted_for(scene: Scene) -> Wanted:
    """Return what a world of a scene needs."""
    return POINT if scene.ball.radius == 0.0 else DISC
