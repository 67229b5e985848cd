"""World: the engine's Python face, one world at a time."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.instant import later
from bounce_env.engine.jit import kernel
from bounce_env.engine.layout import LEDGER, OUT, State, Tables, borrow_state, borrow_tables, new_state
from bounce_env.engine.loop import (
    LEDGER_FULL,
    clear_hits,
    command,
    disturb,
    place,
    restart,
    resume,
    run,
)
from bounce_env.engine.overlap import cleared, rail_middles, rail_points
from bounce_env.engine.pack import pack, switch_ends
from bounce_env.engine.snapshot import from_bytes, to_bytes
from bounce_env.engine.view import view
from bounce_env.scene import Field, Paddle, Scene, Sensor

Floats = npt.NDArray[np.float64]

MAX_EVENTS = 1_000_000
_LEDGER_ROWS = 1024


@kernel
def _reset(state: State, tables: Tables, position: Floats, velocity: Floats) -> None:
    state, tables = borrow_state(state), borrow_tables(tables)
    restart(state, tables, 0)
    for k in range(position.shape[0]):
        place(state, tables, 0, k, position[k, 0], position[k, 1], velocity[k, 0], velocity[k, 1])


@kernel
def _begin(state: State, seconds: float) -> tuple[float, float]:
    """Begin a call of `advance`: the instant it goes to."""
    clear_hits(state, 0)
    resume(state, 0)
    target: tuple[float, float] = later(state.worlds[0].time_hi, state.worlds[0].time_lo, seconds)
    return target


@kernel
def _advance(state: State, tables: Tables, hi: float, lo: float, max_events: int, ledger: Any) -> int:
    state, tables = borrow_state(state), borrow_tables(tables)
    code: int = run(state, tables, 0, hi, lo, max_events, ledger)
    return code


@kernel
def _push(state: State, tables: Tables, k: int, dvx: float, dvy: float) -> None:
    state, tables = borrow_state(state), borrow_tables(tables)
    disturb(state, tables, 0, k, 1.0, dvx, dvy)


@kernel
def _place(state: State, tables: Tables, k: int, x: float, y: float, vx: float, vy: float) -> None:
    state, tables = borrow_state(state), borrow_tables(tables)
    place(state, tables, 0, k, x, y, vx, vy)


@kernel
def _command(state: State, tables: Tables, paddle: int, velocity: float) -> None:
    state, tables = borrow_state(state), borrow_tables(tables)
    command(state, tables, state.paddles, tables.rails, 0, paddle, velocity)


class World:
    """One ball in one scene, advanced exactly from event to event.

    scene: what the world is made of. balls: how many balls; 1 in this release (balls do not yet meet each other).
    Before the first `reset` there is no ball in play, and every other method raises RuntimeError.

    Not part of this release: contact with moving parts. A ball that comes to lie on a paddle rolls on it in small hops;
    one squeezed between closing parts ends with status BUDGET.
    """

    def __init__(self, scene: Scene, balls: int = 1) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene: must be a Scene, not {scene!r}; load_scene reads one from a file")
        if balls != 1:
            raise ValueError(f"balls = {balls!r}: must be 1 in this release")
        self.scene = scene
        self._tables, self._state = _new(scene)
        self._paddles = [i for i, e in enumerate(scene.elements) if isinstance(e, Paddle)]
        self._started = False

    def reset(self, *, position: npt.ArrayLike, velocity: npt.ArrayLike) -> None:
        """Time 0, parts at rest in the middle of their rails, the ball at `position` [m] with `velocity` [m/s].

        Both are (x, y) or an array of shape (1, 2). A ball that overlaps an element by no more than round-off is moved
        to its surface. Raises ValueError for another shape, for NaN or infinity, and where the ball overlaps an element
        (which it names); the world is then as before.
        """
        at, speed = _rows("position", position), _rows("velocity", velocity)
        at[0] = cleared(self.scene, rail_middles(self.scene), float(at[0, 0]), float(at[0, 1]))
        _reset(self._state, self._tables, at, speed)
        self._switch_ends()
        self._started = True

    def advance(self, seconds: float, *, ledger: bool = False, max_events: int = MAX_EVENTS) -> npt.NDArray[Any] | None:
        """Let `seconds` >= 0 pass, or up to `max_events` >= 1 events (then `status` is BUDGET, `time` is that of the
        last event, and the next call goes on from there). Sensor crossings and stops of parts are events, too.

        All that happens to a ball at one instant is one event of the budget.

        Returns the ledger of this call if asked for: a structured array (fields: `engine.layout.LEDGER`), one row an
        event in order of time; design.md, "Ledger". Raises ValueError for arguments that are not allowed.
        """
        self._check_started()
        if not (math.isfinite(seconds) and seconds >= 0.0):
            raise ValueError(f"seconds = {seconds!r}: must be finite and >= 0")
        if max_events < 1:
            raise ValueError(f"max_events = {max_events!r}: must be >= 1")
        world = self._state.worlds[0]
        hi, lo = _begin(self._state, float(seconds))
        if not ledger:
            _advance(self._state, self._tables, hi, lo, max_events, None)
            return None
        pages: list[npt.NDArray[Any]] = []
        page = np.zeros(_LEDGER_ROWS, LEDGER)
        code = LEDGER_FULL
        while code == LEDGER_FULL:
            world.rows = 0
            code = _advance(self._state, self._tables, hi, lo, max_events, page)
            pages.append(page[: world.rows].copy())
        return np.concatenate(pages)

    def command(self, name: str, value: float) -> None:
        """Let the paddle `name` move along its rail at `value` m/s from now until the next command.

        Raises ValueError for a name that no paddle has, for NaN and infinity, and beyond the paddle's `max_speed`.
        """
        self._check_started()
        names = {self.scene.elements[i].name: m for m, i in enumerate(self._paddles)}
        if name not in names or not name:
            raise ValueError(f"command: {name!r} must be one of the scene's paddles: {sorted(filter(None, names))}")
        paddle = self.scene.elements[self._paddles[names[name]]]
        assert isinstance(paddle, Paddle)
        if not (math.isfinite(value) and abs(value) <= paddle.max_speed):
            raise ValueError(
                f"command {name!r} = {value!r}: must be finite and at most {paddle.max_speed!r} m/s either way"
            )
        _command(self._state, self._tables, names[name], float(value))

    def enable(self, name: str, on: bool) -> None:
        """Switch an element on or off: one that is off is not hit, and a ball that it supports falls. On after `reset`.

        Raises ValueError for a name that no bouncing element has, for anything but True and False, and where the ball
        overlaps what is to be switched on; the world is then as before.
        """
        self._check_started()
        bouncing = {
            e.name: i for i, e in enumerate(self.scene.elements) if e.name and not isinstance(e, Sensor | Field)
        }
        if name not in bouncing:
            raise ValueError(f"enable: {name!r} must be one of the scene's bouncing elements: {sorted(bouncing)}")
        if not isinstance(on, bool | np.bool_):
            raise ValueError(f"enable {name!r} = {on!r}: must be True or False")
        disabled = self._state.disabled
        assert disabled is not None
        index = bouncing[name]
        if bool(disabled[0, index]) != on:
            return
        balls, paddles = self._now()
        if on and self._state.balls[0, 0].status != OUT:
            others = set(range(len(self.scene.elements))) - {index}
            centres = {i: (float(x), float(y)) for i, (x, y) in zip(self._paddles, paddles, strict=True)}
            cleared(self.scene, centres, float(balls[0, 0]), float(balls[0, 1]), disabled=others)
        disabled[0, index] = not on
        self._switch_ends()
        _push(self._state, self._tables, 0, 0.0, 0.0)

    def push(self, change: npt.ArrayLike) -> None:
        """Add (dvx, dvy) [m/s] to the velocity of every ball in play, now. Raises ValueError for NaN and infinity."""
        self._check_started()
        ((dvx, dvy),) = _rows("push", change)
        _push(self._state, self._tables, 0, float(dvx), float(dvy))

    def replace(self, scene: Scene) -> None:
        """Go on in another scene: time, ball and its velocity stay; a paddle of the same name keeps place and command.

        The place is the distance along its rail, as far as the new one reaches. All elements are on. Raises ValueError
        where the ball has another size or overlaps an element of the new scene; the world is then as before.
        """
        self._check_started()
        if not isinstance(scene, Scene):
            raise TypeError(f"scene: must be a Scene, not {scene!r}")
        if scene.ball.radius != self.scene.ball.radius:
            raise ValueError(f"ball.radius = {scene.ball.radius!r}: must be {self.scene.ball.radius!r} as before")
        tables, state = _new(scene)
        old, new = self._state.worlds[0], state.worlds[0]
        for name in ("time_hi", "time_lo", "bounces", "speed_capped", "drag_hi", "drag_lo"):
            new[name] = old[name]
        paddles = [i for i, e in enumerate(scene.elements) if isinstance(e, Paddle)]
        commands = self._move_paddles(scene, paddles, state, tables)
        (x, y, vx, vy), ball = self._now()[0][0], self._state.balls[0, 0]
        if ball.status != OUT:
            centres = rail_points(scene, {i: float(state.paddles[0, m].offset) for m, i in enumerate(paddles)})  # type: ignore[index]
            x, y = cleared(scene, centres, float(x), float(y))
        _place(state, tables, 0, x, y, vx, vy)
        if ball.status == OUT:
            state.balls[0, 0] = ball
        for m, command_of in commands.items():
            _command(state, tables, m, command_of)
        self.scene, self._tables, self._state, self._paddles = scene, tables, state, paddles

    def _move_paddles(self, scene: Scene, paddles: list[int], state: State, tables: Tables) -> dict[int, float]:
        """Put the paddles of a new scene where those of the same name are; returns what is to be commanded."""
        commands: dict[int, float] = {}
        if state.paddles is None or tables.rails is None:
            return commands
        known = {self.scene.elements[i].name: m for m, i in enumerate(self._paddles) if self.scene.elements[i].name}
        for m, i in enumerate(paddles):
            paddle, rail = state.paddles[0, m], tables.rails[0, m]
            paddle.offset = 0.5 * rail.span
            paddle.hi, paddle.lo = state.worlds[0].time_hi, state.worlds[0].time_lo
            before = known.get(scene.elements[i].name)
            if before is not None and self._state.paddles is not None and self._tables.rails is not None:
                was, on = self._state.paddles[0, before], self._tables.rails[0, before]
                cx, cy = self._now()[1][before]
                offset = (cx - on.x) * on.ux + (cy - on.y) * on.uy
                paddle.offset = min(max(float(offset), 0.0), float(rail.span))
                commands[m] = min(max(float(was.command), -float(rail.max_speed)), float(rail.max_speed))
        return commands

    def snapshot(self) -> bytes:
        """The full state as bytes; `restore` goes on from it, bit for bit."""
        self._check_started()
        return to_bytes(self.scene, self._state)

    def restore(self, data: bytes) -> None:
        """Go on from a snapshot of a world of an equal scene.

        Raises ValueError where the bytes are no snapshot, truncated or changed, of another version or another scene;
        the world is then as before.
        """
        from_bytes(data, self.scene, self._state)
        self._switch_ends()
        self._started = True

    @property
    def time(self) -> float:
        """Seconds since reset."""
        return float(self._state.worlds[0].time_hi)

    @property
    def position(self) -> Floats:
        """Centres of the balls now, shape (1, 2), metres. A drained ball stays where it crossed the drain."""
        return self._now()[0][:, :2].copy()

    @property
    def velocity(self) -> Floats:
        """Velocities of the balls now, shape (1, 2), m/s."""
        return self._now()[0][:, 2:].copy()

    @property
    def paddles(self) -> Floats:
        """Centres of the paddles now, shape (paddles, 2), metres, in the order of the scene."""
        return self._now()[1]

    @property
    def status(self) -> npt.NDArray[np.int64]:
        """One of OK, BUDGET, CRUSHED, OUT (`engine.layout`) for each ball, shape (1,)."""
        self._check_started()
        return np.array([ball.status for ball in self._state.balls[0]], np.int64)

    def _switch_ends(self) -> None:
        """An end that several elements share is, when the first of them is switched off, that of the next one."""
        assert self._state.disabled is not None
        switch_ends(self._tables, self.scene, np.flatnonzero(self._state.disabled[0]).tolist())

    def _now(self) -> tuple[Floats, Floats]:
        self._check_started()
        balls, paddles = np.empty((1, 4)), np.empty((len(self._paddles), 2))
        view(self._state, self._tables, 0, balls, paddles)
        return balls, paddles

    def _check_started(self) -> None:
        if not self._started:
            raise RuntimeError("reset the world before anything else")


def _new(scene: Scene) -> tuple[Tables, State]:
    tables = pack([scene])
    return tables, new_state(tables, 1, 1, point=scene.ball.radius == 0.0, switches=True)


def _rows(name: str, value: npt.ArrayLike) -> Floats:
    rows = np.array(value, np.float64, ndmin=2)
    if rows.shape != (1, 2):
        raise ValueError(f"{name} = {value!r}: must be (x, y) or one row of it for each of 1 balls")
    if not np.isfinite(rows).all():
        raise ValueError(f"{name} = {value!r}: must be finite")
    return rows
