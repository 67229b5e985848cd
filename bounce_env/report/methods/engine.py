"""This engine: at one call, at one call a frame, and in a batch."""

from collections.abc import Callable, Collection
from functools import partial

import numpy as np

from bounce_env.engine import EventKind, World, WorldBatch
from bounce_env.report.methods.base import Ball, Method, Player, Setting
from bounce_env.report.problems import Problem
from bounce_env.report.truths import FRAMES, Start

STRIKES = (EventKind.BOUNCE, EventKind.ABSORBED, EventKind.CORNER_BOUNCE)
BATCH = 256
UNLIMITED = 2**62


class EnginePlayer(Player):
    """A world or a batch, advanced in the calls that the commands need at least, or in one a frame."""

    def __init__(self, problem: Problem, world: World | WorldBatch, *, by_frame: bool) -> None:
        self._commands, self._world, self._by_frame = problem.commands, world, by_frame

    def begin(self, start: Start) -> None:
        """Reset, every world of a batch alike."""
        at, speed = (np.tile(pair, (self.worlds, 1)) for pair in (start.position, start.velocity))
        self._world.reset(position=at, velocity=speed)
        self._frame, self._waiting = 0, list(self._commands)

    def go(self, frames: int) -> None:
        """Advance, with the commands on the way."""
        end = self._frame + frames
        for frame in range(self._frame + 1, end + 1) if self._by_frame else (end,):
            while self._waiting and self._waiting[0][0] < frame:
                at, name, value = self._waiting.pop(0)
                if at > self._frame:
                    self._advance_to(at)
                self._world.command(name, value)
            self._advance_to(frame)

    def _advance_to(self, frame: int) -> None:
        self.advance((frame - self._frame) / FRAMES)
        self._frame = frame

    def advance(self, seconds: float) -> None:
        """Advance what is played."""
        self._world.advance(seconds, max_events=UNLIMITED)

    def ball(self) -> Ball:
        """Return the ball of the world, or of the last one."""
        x, y = self._world.position.reshape(-1, 2)[-1].tolist()
        vx, vy = self._world.velocity.reshape(-1, 2)[-1].tolist()
        return x, y, vx, vy


class OneWorld(EnginePlayer):
    """A World."""

    def __init__(self, problem: Problem, features: Collection[str], *, by_frame: bool) -> None:
        self._one = World(problem.scene, features=features)
        super().__init__(problem, self._one, by_frame=by_frame)

    def advance(self, seconds: float) -> None:
        """Advance; where strikes are watched, with the ledger."""
        if self.struck is None:
            super().advance(seconds)
            return
        rows = self._one.advance(seconds, ledger=True, max_events=UNLIMITED)
        assert rows is not None
        self.struck += rows["element"][np.isin(rows["kind"], STRIKES)].tolist()


class ManyWorlds(EnginePlayer):
    """A WorldBatch in which every world plays the same start."""

    worlds = BATCH

    def __init__(self, problem: Problem, features: Collection[str]) -> None:
        super().__init__(problem, WorldBatch(problem.scene, BATCH, features=features), by_frame=False)

    def watch(self) -> None:
        """Note nothing: a batch has no ledger."""


class Engine(Method):
    """This engine. play: makes a player."""

    def __init__(self, name: str, label: str, note: str, slower: int, play: Callable[[Problem], Player]) -> None:
        self.name, self.label, self.note, self.slower, self._play = name, label, note, slower, play
        self.settings = self.quick = (Setting("exact"),)

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready, which compiles where the kernels are not on disk."""
        return self._play(problem)


def engine_methods(features: Collection[str] = ()) -> tuple[Method, ...]:
    """Return the engine's three lines. features: forced on, so that all problems share one kernel."""
    one, each_frame = (partial(OneWorld, features=features, by_frame=by_frame) for by_frame in (False, True))
    many = partial(ManyWorlds, features=features)
    return (
        Engine("engine", "bounce_env, one call", "no setting", 1, one),
        Engine("engine_frames", "bounce_env, a call a frame", "no setting", 1000, each_frame),
        Engine("engine_batch", "bounce_env, in a batch", f"no setting; {BATCH} worlds, the time of one", 0, many),
    )
