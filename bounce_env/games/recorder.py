"""One world of a batch, recorded: episode after episode, of which the last two are kept."""

import math
from collections.abc import Iterator
from dataclasses import fields
from typing import Any, NamedTuple

import numpy as np

from bounce_env.engine.memory.records import MOMENT, NO_WORLD
from bounce_env.engine.memory.state import Recording, State, going_on, taken
from bounce_env.engine.recorded import Change, Recorded, recorded_of
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


class Episode:
    """An episode as far as it has been played."""

    def __init__(self, scene: Scene) -> None:
        self.stretches = [Stretch(0.0, scene, [])]
        self.steps: list[Step] = []
        self.lost = 0  # rows and moments that found no room


class Recorder:
    """Keeps what happens in one world of a batch from its next reset on."""

    def __init__(self, world: int) -> None:
        self.world = world
        self.present: Episode | None = None
        self.last: Episode | None = None
        self.number = -1  # of the present episode, as the batch counts them
        self._instant = math.inf  # of the last moment

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

        A game that begins anew within an episode sets the world's clock back, and may play trials before it does: what
        lies between the first time and the last that it was set back has never been shown.
        """
        recording = state.recording
        if recording.head[0]["world"] != self.world:
            return
        page = _with_present_moment(taken(recording), state, self.world)
        before, after = _around_restarts(page, self._instant)
        self._instant = float(page.moments[-1]["hi"])
        if self.present is not None:
            self.present.stretches[-1].pages.append(before)
            if step is not None:
                self.present.steps.append(step)
        if self.present is None or number != self.number:
            self.last, self.present, self.number = self.present or self.last, Episode(scene), number
            self.present.stretches[-1].pages.append(after)
        elif len(after.moments):
            self.present.stretches.append(Stretch(step.time if step else 0.0, scene, [after]))
        self.present.lost += int(page.head[0]["lost"])


def _with_present_moment(page: Recording, state: State, world: int) -> Recording:
    """Return a page with the moment now at its end: rules move balls and parts after the events of a step, too."""
    clock = state.worlds[world]
    moment = np.array([(clock["time_hi"], clock["time_lo"], len(page.ledger))], MOMENT)
    now = [moment, *(None if array is None else array[world : world + 1] for array in going_on(state))]
    kept: list[Any] = [
        None if array is None else np.concatenate([array, last]) for array, last in zip(page[2:], now, strict=True)
    ]
    return Recording(page.head, page.ledger, *kept)


def _around_restarts(page: Recording, instant: float) -> tuple[Recording, Recording]:
    """Return what a page holds up to the first time that the clock was set back, and from the last time on.

    instant: of the last moment before the page [s]. All of the page, and nothing, where the clock went on.
    """
    (back,) = np.nonzero(np.diff(page.moments["hi"], prepend=instant) < 0.0)
    first, last = (int(back[0]), int(back[-1])) if len(back) else (len(page.moments),) * 2
    return _moments(page, 0, first), _moments(page, last, len(page.moments))


def _moments(page: Recording, first: int, last: int) -> Recording:
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
