"""This engine: at one call, at one call a frame, and in a batch."""

from collections.abc import Callable, Collection
from functools import partial

import numpy as np
import numpy.typing as npt

from bounce_env.engine import EventKind, World, WorldBatch
from bounce_env.report.methods.base import FRAMES, Method, Player, Setting, Trace
from bounce_env.report.problems import Problem
from bounce_env.report.truths import Command, Start

STRIKES = (EventKind.BOUNCE, EventKind.ABSORBED, EventKind.CORNER_BOUNCE)
BATCH = 256
UNLIMITED = 2**62


class OneWorld(Player):
    """A World. by_frame: whether it is called once a frame, as an environment does, or once for all."""

    def __init__(self, problem: Problem, features: Collection[str], *, by_frame: bool) -> None:
        self._world = World(problem.scene, features=features)
        self._commands, self._by_frame = problem.commands, by_frame

    def begin(self, start: Start) -> None:
        """Reset the world."""
        self._world.reset(position=start.position, velocity=start.velocity)

    def go(self, frames: int) -> None:
        """Advance, in the calls that its commands need at least."""
        steps = range(1, frames + 1) if self._by_frame else (frames,)
        _advance(self._world, self._commands, steps, partial(self._world.advance, max_events=UNLIMITED))

    def trace(self, start: Start, frames: npt.NDArray[np.int64]) -> Trace:
        """Advance in the same calls, with the ledger."""
        self.begin(start)
        struck: list[int] = []
        places: list[tuple[float, float]] = []

        def advance(seconds: float) -> None:
            rows = self._world.advance(seconds, ledger=True, max_events=UNLIMITED)
            assert rows is not None
            struck.extend(rows["element"][np.isin(rows["kind"], STRIKES)].tolist())

        def look() -> None:
            x, y = self._world.position[0].tolist()
            places.append((x, y))

        wanted = set(frames.tolist())
        steps = range(1, max(wanted, default=0) + 1) if self._by_frame else frames.tolist()
        _advance(self._world, self._commands, steps, advance, lambda frame: look() if frame in wanted else None)
        vx, vy = self._world.velocity[0].tolist()
        return Trace(np.array(places).reshape(-1, 2), tuple(struck), (vx, vy))


def _advance(
    world: World | WorldBatch,
    commands: tuple[Command, ...],
    frames: Collection[int] | range,
    advance: Callable[[float], object],
    look: Callable[[int], None] | None = None,
) -> None:
    """Advance to one frame after the other, with the commands on the way, and look at each."""
    now, waiting = 0, list(commands)
    for frame in frames:
        while waiting and waiting[0][0] < frame:
            at, name, value = waiting.pop(0)
            if at > now:
                advance((at - now) / FRAMES)
                now = at
            world.command(name, value)
        advance((frame - now) / FRAMES)
        now = frame
        if look is not None:
            look(frame)


class ManyWorlds(Player):
    """A WorldBatch in which every world plays the same start."""

    worlds = BATCH

    def __init__(self, problem: Problem, features: Collection[str]) -> None:
        self._batch = WorldBatch(problem.scene, BATCH, features=features)
        self._commands = problem.commands

    def begin(self, start: Start) -> None:
        """Reset the batch."""
        at, speed = (np.tile(pair, (BATCH, 1)) for pair in (start.position, start.velocity))
        self._batch.reset(position=at, velocity=speed)

    def go(self, frames: int) -> None:
        """Advance all worlds."""
        _advance(self._batch, self._commands, (frames,), self._batch.advance)

    def trace(self, start: Start, frames: npt.NDArray[np.int64]) -> Trace:
        """Advance from frame to frame; the last world's places, and no order, for a batch has no ledger."""
        self.begin(start)
        places: list[npt.NDArray[np.float64]] = []
        _advance(
            self._batch,
            self._commands,
            frames.tolist(),
            self._batch.advance,
            lambda _: places.append(self._batch.position[-1, 0]),
        )
        return Trace(np.array(places).reshape(-1, 2), None)


class Engine(Method):
    """This engine. features: forced on, so that all problems share one kernel."""

    def __init__(self, name: str, label: str, features: Collection[str]) -> None:
        self.name, self.label = name, label
        self.settings = self.quick = (Setting("exact"),)
        self.note = f"no setting; {BATCH} worlds, the time of one" if name == "engine_batch" else "no setting"
        self._features = features

    def why_not(self, problem: Problem) -> str | None:
        """Return None: it plays all."""
        return None

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready, which compiles where the kernels are not on disk."""
        if self.name == "engine_batch":
            return ManyWorlds(problem, self._features)
        return OneWorld(problem, self._features, by_frame=self.name == "engine_frames")


def engine_methods(features: Collection[str] = ()) -> tuple[Method, ...]:
    """Return the engine's three lines."""
    return (
        Engine("engine", "bounce_env, one call", features),
        Engine("engine_frames", "bounce_env, a call a frame", features),
        Engine("engine_batch", "bounce_env, in a batch", features),
    )
