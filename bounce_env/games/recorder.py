"""One world of a batch, recorded: episode after episode, of which the last two are kept."""

import math
from collections.abc import Iterator
from dataclasses import fields
from typing import Any, NamedTuple

import numpy as np

from bounce_env.engine.memory.state import Recording, State, taken
from bounce_env.engine.recorded import Change, Recorded, recorded_of, with_present_moment
from bounce_env.scene import Scene

ROWS, MOMENTS = 16_384, 16_384
"""Room for the events of one step. What finds none in a step is missing, and `Episode.lost` says how many."""


class Step(NamedTuple):
    """What a player has seen of a step: when it was over, since its episode began [s], its reward, the score then."""

    time: float
    reward: float
    score: float


class Stretch(NamedTuple):
    """A part of an episode in which the world's clock goes on: from `begin` [s] of the episode, in a scene."""

    begin: float
    scene: Scene
    pages: list[Recording]


class Origin(NamedTuple):
    """Where an episode comes from: a world's stream of episodes, and its number in it, from 1 on.

    seed: from which its user has the stream; None where that is not known.
    """

    world_seed: int
    number: int
    seed: int | None


class Episode:
    """An episode as far as it has been played."""

    def __init__(self, origin: Origin, scene: Scene) -> None:
        self.origin = origin
        self.stretches = [Stretch(0.0, scene, [])]
        self.steps: list[Step] = []
        self.lost = 0  # rows and moments that found no room


class Recorder:
    """Keeps what happens in one world of a batch, from the next episode on that begins in it.

    origin: of the episode that is played when it is made.
    """

    def __init__(self, world: int, origin: Origin) -> None:
        self.world = world
        self.present: Episode | None = None
        self.last: Episode | None = None
        self.origin: Origin | None = origin  # of the episode that is played; None: one is about to begin
        self._instant = math.inf  # of the last moment

    def begin(self, state: State) -> None:
        """Get ready for an episode that begins by a reset."""
        taken(state.recording)
        self.origin, self._instant = None, math.inf

    def interrupt(self, state: State, origin: Origin) -> None:
        """Wait for the next episode: the world goes on from another state, to which nothing recorded leads.

        origin: of the episode that goes on.
        """
        taken(state.recording)
        self.last, self.present = self.present or self.last, None
        self.origin, self._instant = origin, math.inf

    def take(self, state: State, scene: Scene, origin: Origin, step: Step | None) -> None:
        """Take over what has happened.

        scene, origin: of the episode that is played now. step: what the last step gave, where there was one; an episode
        that has begun in it began after it.

        A game that begins anew within an episode sets the world's clock back, and may play trials before it does: what
        lies between the first time and the last that it was set back has never been shown.
        """
        page = with_present_moment(taken(state.recording), state, self.world)
        before, after = _around_restarts(page, self._instant)
        self._instant = float(page.moments[-1]["hi"])
        if self.present is not None:
            self.present.stretches[-1].pages.append(before)
            if step is not None:
                self.present.steps.append(step)
        if origin != self.origin:
            self.last, self.present, self.origin = self.present or self.last, Episode(origin, scene), origin
            self.present.stretches[-1].pages.append(after)
        elif self.present is not None and len(after.moments):
            self.present.stretches.append(Stretch(step.time if step else 0.0, scene, [after]))
        if self.present is not None:
            self.present.lost += int(page.head[0]["lost"])


def _around_restarts(page: Recording, instant: float) -> tuple[Recording, Recording]:
    """Return what a page holds up to the first time that the clock was set back, and from the last time on.

    instant: of the last moment before the page [s]. All of the page, and nothing, where the clock went on.
    """
    (back,) = np.nonzero(np.diff(page.moments["hi"], prepend=instant) < 0.0)
    first, last = (int(back[0]), int(back[-1])) if len(back) else (len(page.moments),) * 2
    return _part_of(page, 0, first), _part_of(page, last, len(page.moments))


def _part_of(page: Recording, first: int, last: int) -> Recording:
    """Return what a page holds of some of its moments, with the rows of the ledger that lead to them."""
    rows = [0, *page.moments["rows"].tolist()]
    kept: list[Any] = [None if array is None else array[first:last] for array in page[2:]]
    return Recording(page.head, page.ledger[rows[first] : rows[last]], *kept)


def run_of(episode: Episode, state: State, world: int) -> Recorded:
    """Return the run of an episode; times are since it began."""
    end = episode.steps[-1].time if episode.steps else 0.0
    runs = [
        _later(recorded_of(stretch.scene, state, stretch.pages, world, end), stretch.begin)
        for stretch in episode.stretches
    ]
    changes = [*_moved(episode), *(change for run in runs for change in run.changes)]
    return Recorded(
        scene=episode.stretches[0].scene,
        ledger=np.concatenate([run.ledger for run in runs]),
        balls=tuple(sum(paths, ()) for paths in zip(*(run.balls for run in runs), strict=True)),
        parts=tuple(sum(paths, ()) for paths in zip(*(run.parts for run in runs), strict=True)),
        changes=tuple(sorted(changes, key=lambda change: change.time)),
        end=end,
    )


def _later(run: Recorded, begin: float) -> Recorded:
    """Return a run with its times since the episode began."""
    ledger = run.ledger.copy()
    ledger["time"] += begin
    return run._replace(
        ledger=ledger,
        balls=tuple(tuple(path._replace(begin=path.begin + begin) for path in paths) for paths in run.balls),
        parts=tuple(tuple(path._replace(begin=path.begin + begin) for path in paths) for paths in run.parts),
        changes=tuple(change._replace(time=change.time + begin) for change in run.changes),
    )


def _moved(episode: Episode) -> Iterator[Change]:
    """Return in what the scenes of an episode's stretches differ."""
    before = episode.stretches[0].scene
    for begin, scene, _ in episode.stretches[1:]:
        for index, (old, new) in enumerate(zip(before.elements, scene.elements, strict=True)):
            for field in fields(new):
                value = getattr(new, field.name)
                if value != getattr(old, field.name):
                    yield Change(begin, index, field.name, value)
        before = scene
