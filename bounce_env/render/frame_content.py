"""What one frame shows."""

from dataclasses import dataclass

import numpy.typing as npt


@dataclass(frozen=True, eq=False)
class Picture:
    """A snapshot of all that changes in a scene; a `Renderer` checks it against its scene.

    balls: centres, metres, shape (k, 2). cores: ends of the cores of the scene's moving parts in the order of its
    elements (`World.cores`), x, y, x, y, metres, shape (m, 4). alive: which balls are in play and drawn, shape (k,);
    None for all. hits: how often each element was struck since the last frame, shape (len(scene.elements),): what was
    struck lights up; None for nothing. lit: which elements are lit as lamps are, of the same shape; None for none.
    score: printed at the top; None for no text.
    targets: centres, metres, of the sensors that the renderer was told are targets, shape (n, 2).
    trail: the way that a ball has come, shape (n, 3): x, y [m], and how fresh each point is, from 0, which has faded
    out, to 1, oldest first; None for none.
    """

    balls: npt.ArrayLike
    cores: npt.ArrayLike = ()
    alive: npt.ArrayLike | None = None
    hits: npt.ArrayLike | None = None
    lit: npt.ArrayLike | None = None
    score: float | None = None
    trail: npt.ArrayLike | None = None
    targets: npt.ArrayLike = ()
