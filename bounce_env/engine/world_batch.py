"""WorldBatch: many worlds side by side, without the games: for measuring, tests, and whoever needs only the physics."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.binding import bind
from bounce_env.engine.compile.jit import kernel
from bounce_env.engine.events.flights import place
from bounce_env.engine.events.loop import DONE, clear_hits, restart, resume, run
from bounce_env.engine.memory.records import Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import later
from bounce_env.engine.motion.readout import view
from bounce_env.engine.packing import pack
from bounce_env.engine.placement import part_cores_at_start, place_clear
from bounce_env.scene import Scene

Floats = npt.NDArray[np.float64]


@kernel
def _reset(state: State, position: Floats, velocity: Floats) -> None:
    for w in range(position.shape[0]):
        restart(state, w)
        place(state, w, 0, position[w, 0], position[w, 1], velocity[w, 0], velocity[w, 1])


@kernel
def _advance(state: State, seconds: float, max_events: int) -> int:
    unfinished = 0
    for w in range(state.worlds.shape[0]):
        clear_hits(state, w)
        resume(state, w)
        hi, lo = later(state.worlds[w].time_hi, state.worlds[w].time_lo, seconds)
        unfinished += run(state, w, hi, lo, max_events, None) != DONE
    return unfinished


class WorldBatch:
    """One world per entry of `scene_of`, each with one ball, in one of `scenes`.

    All scenes run through the kernel of the features that any of them has; the result is that of `World`, to the bit.
    Raises ValueError where scenes cannot share a batch (`engine.packing.pack`).
    """

    def __init__(self, scenes: Sequence[Scene], scene_of: npt.ArrayLike) -> None:
        self.scenes = tuple(scenes)
        index = np.asarray(scene_of, np.int64)
        if index.ndim != 1 or index.size == 0 or index.min() < 0 or index.max() >= len(self.scenes):
            raise ValueError(f"scene_of: must be one index from 0 to {len(self.scenes) - 1} per world")
        self.state = pack(self.scenes, index.size)
        self._bound = bind(self.state)
        self.state.worlds["scene"] = index

    def reset(self, position: npt.ArrayLike, velocity: npt.ArrayLike) -> None:
        """Time 0, a ball in each world at `position` (worlds, 2) [m] with `velocity` (worlds, 2) [m/s].

        Raises ValueError as `World.reset` does.
        """
        at, speed = np.array(position, np.float64), np.array(velocity, np.float64)
        for name, rows in (("position", at), ("velocity", speed)):
            if rows.shape != (len(self.state.worlds), 2) or not np.isfinite(rows).all():
                raise ValueError(f"{name}: must be finite and of shape ({len(self.state.worlds)}, 2)")
        for row, s in zip(at, self.state.worlds["scene"].tolist(), strict=True):
            scene = self.scenes[s]
            row[:] = place_clear(scene, part_cores_at_start(scene), float(row[0]), float(row[1]))
        _reset(self._bound, at, speed)

    def advance(self, seconds: float, max_events: int = 1_000_000) -> int:
        """Let `seconds` pass in every world; returns how many ran out of `max_events` before."""
        return int(_advance(self._bound, float(seconds), max_events))

    @property
    def balls(self) -> Floats:
        """x, y [m], vx, vy [m/s] of every world's ball now, shape (worlds, 4)."""
        rows = np.empty((len(self.state.worlds), 4))
        for w in range(len(rows)):
            view(self._bound, w, rows[w : w + 1], np.empty((0, 4)))
        return rows

    @property
    def status(self) -> Array:
        """The `Status` of every world's ball, shape (worlds,)."""
        return self.state.balls["status"][:, 0].copy()

    @property
    def bounces(self) -> Array:
        """How often every world's ball has bounced since reset, shape (worlds,)."""
        return self.state.worlds["bounces"].copy()
