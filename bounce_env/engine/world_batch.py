"""WorldBatch: many worlds side by side, without the games: for measuring, tests, and whoever needs only the physics."""

from collections.abc import Collection, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.arguments import (
    LARGEST,
    MAX_BALLS,
    MAX_EVENTS,
    MOST_EVENTS,
    SECONDS,
    commanded_part,
    commanded_velocities,
    pushed,
)
from bounce_env.engine.compile.binding import bind
from bounce_env.engine.compile.jit import kernel
from bounce_env.engine.events.commands import command, command_ends
from bounce_env.engine.events.flights import disturb, place
from bounce_env.engine.events.loop import BUDGET_SPENT, begin_call, restart, run
from bounce_env.engine.memory.records import Array, Counts
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.readout import view_world
from bounce_env.engine.packing import features_of_worlds, forced_features, pack
from bounce_env.engine.placement import part_cores_at_start, place_clear, separate_placed_balls
from bounce_env.scene import Feature, Scene
from bounce_env.wording import numbers, real, shown, whole

Floats = npt.NDArray[np.float64]


@kernel
def batch_reset(state: State, position: Floats, velocity: Floats) -> None:
    for w in range(position.shape[0]):
        restart(state, w)
        for k in range(position.shape[1]):
            place(state, w, k, position[w, k, 0], position[w, k, 1], velocity[w, k, 0], velocity[w, k, 1])


@kernel
def batch_advance(state: State, seconds: float, max_events: int) -> int:
    unfinished = 0
    for w in range(state.worlds.shape[0]):
        hi, lo = begin_call(state, w, seconds)
        unfinished += run(state, w, hi, lo, max_events) == BUDGET_SPENT
    return unfinished


@kernel
def batch_advance_until(state: State, bounces: int, seconds: float, max_events: int) -> None:
    for w in range(state.worlds.shape[0]):
        hi, lo = begin_call(state, w, seconds)
        run(state, w, hi, lo, max_events, state.worlds[w].bounces + bounces)


@kernel
def batch_command_part(state: State, part: int, velocities: Floats) -> None:
    for w in range(velocities.shape[0]):
        command(state, w, part, velocities[w])


@kernel
def batch_command_wall(state: State, part: int, velocities: Floats) -> None:
    for w in range(velocities.shape[0]):
        start, end = velocities[w, 0], velocities[w, 1]
        command_ends(state, w, part, (start[0], start[1]), (end[0], end[1]))


@kernel
def batch_push(state: State, change: Floats) -> None:
    for w in range(change.shape[0]):
        for k in range(state.balls.shape[1]):
            disturb(state, w, k, 1.0, change[w, 0], change[w, 1])


@kernel
def batch_view(state: State, balls: Floats, cores: Floats) -> None:
    for w in range(balls.shape[0]):
        view_world(state, w, balls[w], cores[w])


class WorldBatch:
    """Worlds side by side, one per entry of `scene_of`, each with `balls` balls in one of `scenes`.

    scenes: one Scene, or several. scene_of: how many worlds, where there is one scene; or the index in `scenes` of each
    world's. features: forced on besides those that any of the scenes has, as for a `World`. All worlds run through
    one kernel; what each does is what a `World` of its scene does, to the bit (docs/physics.md).

    Raises ValueError where scenes cannot share a batch: some have point balls and others discs.
    Before the first `reset` every other method raises RuntimeError.
    """

    def __init__(
        self,
        scenes: Scene | Sequence[Scene],
        scene_of: int | npt.ArrayLike,
        balls: int = 1,
        *,
        features: Collection[str] = (),
    ) -> None:
        self.scenes = (scenes,) if isinstance(scenes, Scene) else tuple(scenes)
        if not self.scenes or not all(isinstance(scene, Scene) for scene in self.scenes):
            raise TypeError(f"scenes = {shown(scenes)}: must be a Scene, or some of them")
        index = np.array(scene_of) if np.ndim(scene_of) else np.zeros(whole("scene_of", scene_of, 1), np.int64)
        known = index.ndim == 1 and index.size > 0 and index.dtype.kind in "iu"
        if not known or index.min() < 0 or index.max() >= len(self.scenes):
            raise ValueError(f"scene_of: must be one index from 0 to {len(self.scenes) - 1} per world")
        self._balls = whole("balls", balls, 1, MAX_BALLS)
        self.features: frozenset[Feature] = features_of_worlds(self.scenes, self._balls)
        self.features |= forced_features(self.scenes[0], features)
        self._state = pack(self.scenes, index.size, self._balls, features=self.features)
        self._bound = bind(self._state)
        self._state.worlds["scene"] = index
        self._parts = max(len(scene.parts) for scene in self.scenes)
        self._started = False

    def __len__(self) -> int:
        return len(self._state.worlds)

    def reset(self, *, position: npt.ArrayLike, velocity: npt.ArrayLike) -> None:
        """Time 0, parts where they start, the balls at `position` [m] with `velocity` [m/s].

        Both of shape (worlds, balls, 2), or (worlds, 2) for one ball each. Raises ValueError as `World.reset` does,
        and all worlds are then as before.
        """
        at, speed = self._rows("position", position), self._rows("velocity", velocity)
        cores = [part_cores_at_start(scene) for scene in self.scenes]
        for rows, s in zip(at, self._state.worlds["scene"].tolist(), strict=True):
            for row in rows:
                row[:] = place_clear(self.scenes[s], cores[s], float(row[0]), float(row[1]))
            separate_placed_balls(self.scenes[s], rows)
        batch_reset(self._bound, at, speed)
        self._started = True

    def advance(self, seconds: float, *, max_events: int = MAX_EVENTS) -> int:
        """Let `seconds` pass in every world; return how many ran out of `max_events` (status BUDGET) before."""
        self._check_started()
        max_events = whole("max_events", max_events, 1, MOST_EVENTS)
        return int(batch_advance(self._bound, real("seconds", seconds, 0.0, LARGEST, SECONDS), max_events))

    def advance_until(self, bounces: int, seconds: float, *, max_events: int = MAX_EVENTS) -> Array:
        """Let every world's balls bounce `bounces` times more, at most `seconds` and `max_events` events.

        Returns how often they have, shape (worlds,); the worlds' times then differ. As `World.advance_until`.
        """
        self._check_started()
        bounces = whole("bounces", bounces, 1, MOST_EVENTS)
        max_events = whole("max_events", max_events, 1, MOST_EVENTS)
        before = self._state.worlds["bounces"].copy()
        batch_advance_until(self._bound, bounces, real("seconds", seconds, 0.0, LARGEST, SECONDS), max_events)
        return np.asarray(self._state.worlds["bounces"] - before)

    def command(self, name: str, value: Any) -> None:
        """Let the part `name` of every world move otherwise from now until the next command, as `World.command`.

        value: one for all worlds, or one for each: shape (worlds,), of a draggable wall (worlds, 2, 2). Every scene
        must have the same part `name` at the same place among its parts. Raises ValueError otherwise.
        """
        self._check_started()
        m = commanded_part(self.scenes[0], name)
        _, part = self.scenes[0].parts[m]
        if any([part for _, part in scene.parts[m : m + 1]] != [part] for scene in self.scenes):
            raise ValueError(f"command: {shown(name)} must be the same part in every scene of the batch")
        caps = [scene.max_speed for scene in self.scenes if scene.max_speed is not None]
        velocities = commanded_velocities(part, value, min(caps, default=None), (len(self),))
        (batch_command_part if velocities.ndim == 1 else batch_command_wall)(self._bound, m, velocities)

    def push(self, change: npt.ArrayLike) -> None:
        """Add `change` = (dvx, dvy) [m/s] to the velocity of every ball in play; of shape (2,), or (worlds, 2).

        Raises ValueError for NaN, infinity and more than 1e15 either way.
        """
        self._check_started()
        batch_push(self._bound, pushed(change, (len(self),)))

    @property
    def time(self) -> Floats:
        """Seconds since reset, shape (worlds,)."""
        self._check_started()
        return np.asarray(self._state.worlds["time_hi"].copy())

    @property
    def position(self) -> Floats:
        """Centres of the balls now, shape (worlds, balls, 2), metres."""
        return self._now()[0][:, :, :2].copy()

    @property
    def velocity(self) -> Floats:
        """Velocities of the balls now, shape (worlds, balls, 2), m/s."""
        return self._now()[0][:, :, 2:].copy()

    @property
    def cores(self) -> Floats:
        """Where the moving parts are now, shape (worlds, parts, 4), as `World.cores`; zeros where a scene has fewer."""
        return self._now()[1]

    @property
    def status(self) -> Array:
        """The `Status` of each ball, shape (worlds, balls)."""
        self._check_started()
        return np.asarray(self._state.balls["status"].copy())

    @property
    def counts(self) -> Counts:
        """How much has happened since reset: each of shape (worlds,)."""
        self._check_started()
        worlds = self._state.worlds
        return Counts(
            worlds["events_before"] + worlds["events"], worlds["bounces"].copy(), worlds["speed_capped"].copy()
        )

    def _now(self) -> tuple[Floats, Floats]:
        self._check_started()
        balls, cores = np.empty((len(self), self._balls, 4)), np.zeros((len(self), self._parts, 4))
        batch_view(self._bound, balls, cores)
        return balls, cores

    def _rows(self, name: str, value: npt.ArrayLike) -> Floats:
        rows, shape = numbers(value), (len(self), self._balls, 2)
        if rows is not None and self._balls == 1 and rows.shape == shape[::2]:
            rows = rows[:, None]
        if rows is None or rows.shape != shape or not (abs(rows) <= LARGEST).all():
            raise ValueError(f"{name}: must be finite, each from {-LARGEST:g} to {LARGEST:g}, and of shape {shape}")
        return rows.copy()

    def _check_started(self) -> None:
        if not self._started:
            raise RuntimeError("reset the worlds before anything else")
