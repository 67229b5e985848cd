"""The frames that agents see: those of a whole batch are drawn in one call."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.memory.records import OUT
from bounce_env.engine.motion.readout import view_worlds
from bounce_env.games.batch import Batch
from bounce_env.render.raster import Scenery, Seen, draw, in_grey, scenery_of

Pixels = npt.NDArray[np.uint8]

_MOST_SCENERIES = 256
"""Levels of which what stands is kept."""


class ObservedFrames:
    """Frames of the worlds of a batch, of one size in pixels, in red, green and blue or in grey.

    frames: (worlds, height, width, 3), or of grey (worlds, height, width, 1); overwritten by `draw`.
    """

    def __init__(self, batch: Batch, width: int, height: int, *, grey: bool) -> None:
        self.frames: Pixels = np.zeros((batch.worlds, height, width, 1 if grey else 3), np.uint8)
        self._batch = batch
        self._grey = grey
        self._sceneries: dict[int, Scenery] = {}

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_sceneries": {}}

    def draw(self, worlds: npt.NDArray[np.intp]) -> None:
        """Draw some worlds, (n,) in order, as they are now."""
        levels = self._batch.episodes["level"][worlds]
        for level in np.unique(levels).tolist():
            rows = worlds[levels == level]
            draw(self._scenery_on(level, int(rows[0])), self._seen(rows), rows, self.frames)

    def show(self, world: int, picture: Pixels) -> None:
        """Let a world's frame be a picture (height, width, 3) that was drawn elsewhere."""
        self.frames[world] = in_grey(picture) if self._grey else picture

    def _seen(self, worlds: npt.NDArray[np.intp]) -> Seen:
        batch = self._batch
        state, game = batch.state, batch.game
        elements, parts = len(game.scenes[0].elements), len(game.scenes[0].parts)
        balls, cores = np.empty((len(worlds), state.balls.shape[1], 4)), np.empty((len(worlds), parts, 4))
        view_worlds(batch.bound_state, worlds, balls, cores)
        hits = state.hits[worlds, :elements] > 0
        if batch.memory is not None:
            lit = game.lamps(batch.memory[worlds, None])
            hits = hits if lit is None else hits | lit
        return Seen(balls, state.balls["status"][worlds] != OUT, cores, hits, batch.target_places(worlds))

    def _scenery_on(self, level: int, world: int) -> Scenery:
        if level not in self._sceneries:
            while len(self._sceneries) >= _MOST_SCENERIES:
                del self._sceneries[next(iter(self._sceneries))]
            game, (_, height, width, _) = self._batch.game, self.frames.shape
            self._sceneries[level] = scenery_of(
                self._batch.scene(world), width, height, grey=self._grey, targets=game.targets, hidden=game.hidden
            )
        return self._sceneries[level]
