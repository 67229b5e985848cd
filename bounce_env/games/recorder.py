"""One world of a batch, recorded: episode after episode, of which the last two are kept."""

import math
from typing import Any, NamedTuple

import numpy as np

from bounce_env.engine.memory.records import NO_WORLD
from bounce_env.engine.memory.state import Recording, State, taken
from bounce_env.engine.recorded import Recorded, recorded_of
from bounce_env.scene import Scene

ROWS, MOMENTS = 16_384, 16_384
"""Room for the events of one step. What finds none in a step is missing, and `lost` says how many."""


class Step(NamedTuple):
    """What a player has seen of a step: when it was over [s], its reward, and the score after it."""

    time: float
    reward: float
    score: float


class Episode:
    """An episode as far as it has been played. scene: in which it is played."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.pages: list[Recording] = []
        self.steps: list[Step] = []

    @property
    def lost(self) -> int:
        """Return how many rows and moments found no room."""
        return sum(int(page.head[0]["lost"]) for page in self.pages)


class Recorder:
    """Keeps what happens in one world of a batch from its next reset on."""

    def __init__(self, world: int) -> None:
        self.world = world
        self.present: Episode | None = None
        self.last: Episode | None = None
        self._number = -1  # of the present episode, as the batch counts them
        self._instant = 0.0  # of the last moment

    def begin(self, state: State) -> None:
        """Get ready for an episode that begins by a reset."""
        taken(state.recording)
        state.recording.head["world"] = self.world
        self._instant = math.inf

    def interrupt(self, state: State) -> None:
        """Stop until the next reset: the world goes on from another state, to which nothing recorded leads."""
        state.recording.head["world"] = NO_WORLD
        taken(state.recording)
        self.present = None

    def take(self, state: State, scene: Scene, number: int, step: Step | None) -> None:
        """Take over what has happened.

        scene, number: of the episode that is played now. step: what the last step gave, where there was one; an episode
        that has begun in it began after it.
        """
        recording = state.recording
        if recording.head[0]["world"] != self.world:
            return
        page = taken(recording)
        instants = np.concatenate([[self._instant], page.instants[:, 0]])
        self._instant = float(instants[-1])
        if number == self._number and self.present is not None:
            self._append(page, step)
            return
        (back,) = np.nonzero(np.diff(instants) < 0.0)
        before, after = _split(page, int(back[0]) if len(back) else len(page.instants))
        if self.present is not None:
            self._append(before, step)
            self.last = self.present
        self.present, self._number = Episode(scene), number
        self._append(after, None)

    def _append(self, page: Recording, step: Step | None) -> None:
        assert self.present is not None
        self.present.pages.append(page)
        if step is not None:
            self.present.steps.append(step)


def run_of(episode: Episode, state: State, world: int) -> Recorded:
    """Return the run of an episode."""
    end = episode.steps[-1].time if episode.steps else 0.0
    return recorded_of(episode.scene, state, episode.pages, world, end)


def _split(page: Recording, first: int) -> tuple[Recording, Recording]:
    """Return the two parts of a page, of which the second begins at a moment: in the ledger where time goes back."""
    (back,) = np.nonzero(np.diff(page.ledger["time"]) < 0.0)
    row = int(back[0]) + 1 if len(back) else len(page.ledger)
    parts: list[Any] = []
    for rows, moments in ((slice(None, row), slice(None, first)), (slice(row, None), slice(first, None))):
        kept: list[Any] = [None if array is None else array[moments] for array in page[2:]]
        parts.append(Recording(page.head, page.ledger[rows], *kept))
    return parts[0], parts[1]
