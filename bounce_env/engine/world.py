"""World: the engine's Python face, one world at a time."""

from collections.abc import Collection
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
from bounce_env.engine.carried_over import carry_over
from bounce_env.engine.compile.binding import bind
from bounce_env.engine.events.loop import ANY_BOUNCES, PAGE_FULL
from bounce_env.engine.memory.records import NO_WORLD, OUT, Counts
from bounce_env.engine.memory.state import Recording, State, taken, with_recording
from bounce_env.engine.motion.readout import view
from bounce_env.engine.packing import features_of_worlds, forced_features, pack, switch_round_ends
from bounce_env.engine.placement import Core, part_cores_at_start, place_clear, separate_placed_balls
from bounce_env.engine.recorded import Recorded, recorded_of, with_present_moment
from bounce_env.engine.snapshot import restore_bytes, snapshot_bytes
from bounce_env.engine.world_kernels import (
    GO_ON,
    world_advance,
    world_command_part,
    world_command_wall,
    world_place_ball,
    world_push_balls,
    world_reset,
    world_resolve_all,
    world_resume_part,
)
from bounce_env.scene import Feature, Field, Scene, Sensor
from bounce_env.wording import nearest, numbers, real, shown, whole

Floats = npt.NDArray[np.float64]

_LEDGER_ROWS, _MOMENTS = 1024, 1024


class World:
    """Balls in one scene, advanced exactly from event to event: docs/physics.md says what happens, and in which order.

    scene: what the world is made of. balls: how many balls, 1 or more, all alike. features: names of features that its
    kernels are to have besides those of the scene; the motion is the same to the bit. With `ALL_FEATURES` worlds of
    discs all share one kernel, and so do those of points: nothing new is compiled for the next scene.
    Before the first `reset` there is no ball in play, and every other method raises RuntimeError.

    A ball rests and slides on walls, circles and arcs, and on parts that stand or slide; along parts that turn it goes
    in small bounces. Balls may lie on each other, and rest so; those of no radius do not meet.
    """

    def __init__(self, scene: Scene, balls: int = 1, *, features: Collection[str] = ()) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene = {shown(scene)}: must be a Scene; load_scene reads one from a file")
        self.scene = scene
        self._balls = whole("balls", balls, 1, MAX_BALLS)
        self._forced = forced_features(scene, features) | {Feature.SWITCHES}
        self._is_to_be_recorded = False
        self._state = self._packed(scene)
        self._ends_without: list[int] = []  # the elements that were off when the tables of round ends were written
        self._bound = bind(self._state)
        self._parts = scene.parts
        self._started = False
        self._recorded: list[Recording] | None = None

    def reset(self, *, position: npt.ArrayLike, velocity: npt.ArrayLike) -> None:
        """Time 0, parts where they start, the balls at `position` [m] with `velocity` [m/s].

        Both are of shape (balls, 2), or (x, y) for one ball, each number from -1e15 to 1e15; a velocity may exceed the
        scene's `max_speed`, which acts at bounces. A paddle starts in the
        middle of its rail, a flipper at its `rest_angle`, a moving bumper at its `center`, a draggable wall where it is
        in the scene. A ball that overlaps an element by no more than round-off is moved to its surface. Raises
        ValueError for another shape, for NaN, infinity and what is no number, and where a ball overlaps an element
        (which it names) or another ball; the world is then as before.
        """
        at, speed = self._rows("position", position), self._rows("velocity", velocity)
        cores = part_cores_at_start(self.scene)
        for k, (x, y) in enumerate(at.tolist()):
            at[k] = place_clear(self.scene, cores, x, y)
        separate_placed_balls(self.scene, at)
        if self._is_to_be_recorded:
            self._recorded = []
        world_reset(self._bound, at, speed)
        self._switch_ends()
        self._started = True

    def record(self, on: bool = True) -> None:
        """Keep all that happens from the next `reset` on, for `recorded`; with False: no longer.

        `restore` and `replace` end it: what comes then does not follow from what was recorded.
        Recording changes no bit of the motion. Some kilobytes are kept for each event and each call.
        """
        if not isinstance(on, bool | np.bool_):
            raise ValueError(f"on = {shown(on)}: must be True or False")
        self._is_to_be_recorded, self._recorded = bool(on), None
        self._state = self._with_pages(self._state)
        self._bound = bind(self._state)

    def recorded(self) -> Recorded:
        """Return what has happened since the last `reset`, up to now. Raises RuntimeError where it was not recorded."""
        self._check_started()
        if self._recorded is None:
            raise RuntimeError("nothing is recorded: call record(), and then reset()")
        now = with_present_moment(taken(self._state.recording), self._state, 0)
        return recorded_of(self.scene, self._state, [*self._recorded, now], 0, self.time)

    def advance(self, seconds: float, *, ledger: bool = False, max_events: int = MAX_EVENTS) -> npt.NDArray[Any] | None:
        """Let `seconds` pass; return the ledger of this call if asked for, otherwise None.

        seconds: 0 to 1e15. max_events: 1 or more; when so many events have been processed `status` is BUDGET, `time`
        is that of the last event, and the next call goes on from there. All that happens to a ball at one instant is
        one event of the budget; sensor crossings and stops of parts are events, too.

        The ledger is a structured array, one row an event, in order of time:

        | column | what it tells |
        | --- | --- |
        | `time` | seconds since reset |
        | `ball` | index of the ball; -1 where a part stops |
        | `element` | index in `scene.elements`; of another ball len(scene.elements) + its index |
        | `kind` | EventKind: bounce 0, contact begins 1, ends 2, sensor 3, part stop 4, crush 5, absorbed 6, corner 7 |
        | `x`, `y` | centre of the ball, of a part that stops a point on it [m] |
        | `nx`, `ny` | unit normal from the element to the ball; at a sensor, to where the ball came from |
        | `vx0`, `vy0`, `vx1`, `vy1` | velocity before and after [m/s] |
        | `ux`, `uy` | velocity of the surface where it was touched [m/s], before the bounce |

        Two balls that hit each other give two rows; a dragged wall that stops gives one for each end. Asking for the
        ledger changes no bit of the motion. Raises ValueError for arguments that are not allowed, RuntimeError before
        the first reset.
        """
        self._check_started()
        seconds = real("seconds", seconds, 0.0, LARGEST, SECONDS)
        max_events = whole("max_events", max_events, 1, MOST_EVENTS, ">= 1, a whole number")
        if not isinstance(ledger, bool | np.bool_):
            raise ValueError(f"ledger = {shown(ledger)}: must be True or False")
        if not ledger and self._recorded is None:
            world_advance(self._bound, seconds, 0.0, 0.0, max_events, ANY_BOUNCES)
            return None
        pages = self._advance(seconds, max_events, keeps=ledger)
        return np.concatenate([page.ledger for page in pages]) if ledger else None

    def advance_until(self, bounces: int, seconds: float, *, max_events: int = MAX_EVENTS) -> int:
        """Let time pass until the balls have bounced `bounces` times more; return how often they have.

        At most `seconds` [s] pass, and at most `max_events` events (`status` is then BUDGET). All bounces at one
        instant count, so that it may be some more. `time` is then that of the last of them, and velocities
        are those after it. Raises as `advance` does, and ValueError where `bounces` is no whole number >= 1.
        """
        self._check_started()
        bounces = whole("bounces", bounces, 1, MOST_EVENTS, ">= 1, a whole number")
        max_events = whole("max_events", max_events, 1, MOST_EVENTS, ">= 1, a whole number")
        before = self.counts.bounces
        self._advance(real("seconds", seconds, 0.0, LARGEST, SECONDS), max_events, before + bounces)
        return self.counts.bounces - before

    def command(self, name: str, value: float | bool | npt.ArrayLike) -> None:
        """Let the part `name` move otherwise from now until the next command.

        A paddle moves along its rail at `value` m/s. A flipper turns to its `active_angle` while `value` is True, and
        back while it is False. A moving bumper goes on at `value` m/s, and turns back at the ends of its rail as ever.
        The ends of a draggable wall move at `value` = ((vx, vy), (vx, vy)) m/s, the start's and the end's, as far as
        its `reach` and `min_length` let them.

        Raises ValueError for a name that no part has, and for a value that it cannot take.
        """
        self._check_started()
        m = commanded_part(self.scene, name)
        velocity = commanded_velocities(self._parts[m][1], value, self.scene.max_speed)
        if velocity.ndim:
            world_command_wall(self._bound, m, velocity)
        else:
            world_command_part(self._bound, m, float(velocity))

    def enable(self, name: str, on: bool) -> None:
        """Switch an element on or off: one that is off is not hit, and a ball that it supports falls. On after `reset`.

        Raises ValueError for a name that no bouncing element has, for anything but True and False, and where the ball
        overlaps what is to be switched on; the world is then as before.
        """
        self._check_started()
        bouncing = {
            e.name: i for i, e in enumerate(self.scene.elements) if e.name and not isinstance(e, Sensor | Field)
        }
        if not isinstance(name, str) or name not in bouncing:
            known = f"{sorted(bouncing)}{nearest(name, bouncing)}"
            raise ValueError(f"enable: {shown(name)} must be one of the scene's bouncing elements: {known}")
        if not isinstance(on, bool | np.bool_):
            raise ValueError(f"enable {name!r} = {shown(on)}: must be True or False")
        disabled = self._state.disabled
        assert disabled is not None
        index = bouncing[name]
        if bool(disabled[0, index]) != on:
            return
        if on:
            others = set(range(len(self.scene.elements))) - {index}
            for (x, y), status in zip(self.position.tolist(), self.status.tolist(), strict=True):
                if status != OUT:
                    place_clear(self.scene, self._cores(), x, y, disabled=others)
        disabled[0, index] = not on
        self._switch_ends()
        world_resolve_all(self._bound)

    def push(self, change: npt.ArrayLike) -> None:
        """Add `change` = (dvx, dvy) [m/s] to the velocity of every ball in play, now.

        Raises ValueError for NaN, infinity and more than 1e15 either way.
        """
        self._check_started()
        dvx, dvy = pushed(change).tolist()
        world_push_balls(self._bound, dvx, dvy)

    def replace(self, scene: Scene, *, position: npt.ArrayLike | None = None) -> None:
        """Go on in another scene: time, balls and their velocities stay; a part of the same name and kind keeps its
        place and command. position: where balls in play are from now on, (balls, 2), metres; None: where they are.

        The place is the distance or angle from its first stop, as far as the new way reaches; a draggable wall keeps
        its ends where its `start`, `end` and `reach` are as before. All elements are on.
        Raises ValueError where the balls have another size or one overlaps an element of the new scene; the world is
        then as before.
        """
        self._check_started()
        if not isinstance(scene, Scene):
            raise TypeError(f"scene = {shown(scene)}: must be a Scene")
        if scene.ball.radius != self.scene.ball.radius:
            raise ValueError(f"ball.radius = {scene.ball.radius!r}: must be {self.scene.ball.radius!r} as before")
        state = self._packed(scene)
        balls, old_cores = self._now()
        carry_over(self._state, self._parts, old_cores, state, scene.parts)
        cores = np.empty((len(scene.parts), 4))
        bound = bind(state)
        view(bound, 0, np.empty((0, 4)), cores)
        if position is not None:
            balls[:, :2] = self._rows("position", position)
        for k, (x, y, vx, vy) in enumerate(balls.tolist()):
            if self._state.balls[0, k].status != OUT:
                x, y = place_clear(scene, _cores_by_index(scene, cores), x, y)  # noqa: PLW2901
            world_place_ball(bound, k, x, y, vx, vy)
        out = self._state.balls["status"][0] == OUT
        state.balls[0, out] = self._state.balls[0, out]
        for m in range(len(scene.parts)):
            world_resume_part(bound, m)
        self.scene, self._state, self._bound, self._parts = scene, state, bound, scene.parts
        self._ends_without = []
        self._recorded = None

    def _packed(self, scene: Scene) -> State:
        """Return the state of a world of a scene, with pages for what is recorded of it."""
        return self._with_pages(pack([scene], balls=self._balls, features=self._forced))

    def _with_pages(self, state: State) -> State:
        moments = _MOMENTS if self._is_to_be_recorded else 0
        return with_recording(state, rows=_LEDGER_ROWS * self._balls, moments=moments)

    def _advance(
        self, seconds: float, max_events: int, bounces: int = ANY_BOUNCES, *, keeps: bool = False
    ) -> list[Recording]:
        """Let seconds pass; returns what was recorded on the way, page by page, where the world is recorded.

        keeps: it is recorded for this call.
        """
        recording, pages = self._state.recording, []
        head, code, hi, lo = recording.head[0], PAGE_FULL, 0.0, 0.0
        head.world = 0 if keeps or self._recorded is not None else NO_WORLD
        while code == PAGE_FULL:
            code, hi, lo = world_advance(self._bound, seconds, hi, lo, max_events, bounces)
            seconds = GO_ON
            if head.world == 0:
                pages.append(taken(recording))
        head.world = NO_WORLD
        if self._recorded is not None:
            self._recorded += pages
        return pages

    def snapshot(self) -> bytes:
        """Return the full state as bytes; `restore` goes on from it, bit for bit."""
        self._check_started()
        return snapshot_bytes(self.scene, self._state)

    def restore(self, data: bytes) -> None:
        """Go on from `data`, a snapshot of a world of an equal scene.

        Raises ValueError where the bytes are no snapshot, truncated or changed, of another version or another scene;
        the world is then as before.
        """
        restore_bytes(data, self.scene, self._state)
        self._recorded = None
        self._switch_ends()
        self._started = True

    @property
    def time(self) -> float:
        """Seconds since reset."""
        return float(self._state.worlds[0].time_hi)

    @property
    def position(self) -> Floats:
        """Centres of the balls now, shape (balls, 2), metres. A drained ball stays where it crossed the drain."""
        return self._now()[0][:, :2].copy()

    @property
    def velocity(self) -> Floats:
        """Velocities of the balls now, shape (balls, 2), m/s."""
        return self._now()[0][:, 2:].copy()

    @property
    def cores(self) -> Floats:
        """Where the moving parts are now, in the order of the scene, shape (parts, 4): x, y of one end of the part's
        core and of the other, metres. A flipper's first end is its pivot; a bumper's two ends are its centre; those of
        a draggable wall are its start and its end.
        """
        return self._now()[1]

    @property
    def status(self) -> npt.NDArray[np.int64]:
        """The `Status` of each ball, shape (balls,) int64."""
        self._check_started()
        return self._state.balls["status"][0].copy()

    @property
    def counts(self) -> Counts:
        """How much has happened since reset: `events`, `bounces`, and `speed_capped`: bounces slowed by `max_speed`."""
        world = self._state.worlds[0]
        return Counts(int(world.events_before + world.events), int(world.bounces), int(world.speed_capped))

    @property
    def features(self) -> frozenset[Feature]:
        """The features that its kernels are compiled with: of the scene, of several balls, and those forced on."""
        return features_of_worlds([self.scene], self._balls) | self._forced

    def _switch_ends(self) -> None:
        """An end that several elements share is, when the first of them is switched off, that of the next one."""
        assert self._state.disabled is not None
        disabled = np.flatnonzero(self._state.disabled[0]).tolist()
        if disabled != self._ends_without:
            switch_round_ends(self._state, self.scene, disabled)
            self._ends_without = disabled

    def _cores(self) -> dict[int, Core]:
        return _cores_by_index(self.scene, self._now()[1])

    def _now(self) -> tuple[Floats, Floats]:
        self._check_started()
        balls, cores = np.empty((self._balls, 4)), np.empty((len(self._parts), 4))
        view(self._bound, 0, balls, cores)
        return balls, cores

    def _rows(self, name: str, value: npt.ArrayLike) -> Floats:
        given = numbers(value)
        rows = np.empty(0) if given is None else np.array(given, ndmin=2)
        if rows.shape != (self._balls, 2):
            each = "" if self._balls == 1 else f", or one row of it for each of {self._balls} balls"
            raise ValueError(f"{name} = {shown(value)}: must be (x, y), numbers{each}")
        if not (abs(rows) <= LARGEST).all():  # also false for NaN
            raise ValueError(f"{name} = {shown(value)}: must be finite, each from {-LARGEST:g} to {LARGEST:g}")
        return rows

    def _check_started(self) -> None:
        if not self._started:
            raise RuntimeError("reset the world before anything else")


def _cores_by_index(scene: Scene, cores: Floats) -> dict[int, Core]:
    rows = zip(scene.parts, cores.tolist(), strict=True)
    return {index: ((x0, y0), (x1, y1)) for (index, _), (x0, y0, x1, y1) in rows}
