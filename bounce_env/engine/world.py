"""World: the engine's Python face, one world at a time."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.instant import later
from bounce_env.engine.jit import kernel
from bounce_env.engine.layout import LEDGER, State, Tables, borrow_state, borrow_tables, new_state
from bounce_env.engine.loop import (
    LEDGER_FULL,
    clear_hits,
    command,
    place,
    restart,
    resume,
    run,
)
from bounce_env.engine.overlap import cleared, rail_middles
from bounce_env.engine.pack import pack
from bounce_env.engine.view import view
from bounce_env.scene import Paddle, Scene

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
    target: tuple[float, float] = later(state.worlds[0].time_hi, state.worlds[0].time_lo, seconds)
    return target


@kernel
def _advance(state: State, tables: Tables, hi: float, lo: float, max_events: int, ledger: Any) -> int:
    state, tables = borrow_state(state), borrow_tables(tables)
    resume(state, 0)
    code: int = run(state, tables, 0, hi, lo, max_events, ledger)
    return code


@kernel
def _command(state: State, tables: Tables, paddle: int, velocity: float) -> None:
    state, tables = borrow_state(state), borrow_tables(tables)
    command(state, tables, state.paddles, tables.rails, 0, paddle, velocity)


class World:
    """One ball in one scene, advanced exactly from event to event.

    scene: what the world is made of. balls: how many balls; 1 in this release (balls do not yet meet each other).
    Before the first `reset` there is no ball in play, and every other method raises RuntimeError.

    Not part of this release: contact. A ball that comes to rest or rolls (which needs gravity and b < 1 or a start at
    rest on a surface) bounces ever faster and ends with status BUDGET; so does one squeezed between closing parts.
    """

    def __init__(self, scene: Scene, balls: int = 1) -> None:
        if not isinstance(scene, Scene):
            raise TypeError(f"scene: must be a Scene, not {scene!r}; load_scene reads one from a file")
        if balls != 1:
            raise ValueError(f"balls = {balls!r}: must be 1 in this release")
        self.scene = scene
        self._tables = pack([scene])
        self._state = new_state(self._tables, 1, balls, point=scene.ball.radius == 0.0)
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

    def _now(self) -> tuple[Floats, Floats]:
        self._check_started()
        balls, paddles = np.empty((1, 4)), np.empty((len(self._paddles), 2))
        view(self._state, self._tables, 0, balls, paddles)
        return balls, paddles

    def _check_started(self) -> None:
        if not self._started:
            raise RuntimeError("reset the world before anything else")


def _rows(name: str, value: npt.ArrayLike) -> Floats:
    rows = np.array(value, np.float64, ndmin=2)
    if rows.shape != (1, 2):
        raise ValueError(f"{name} = {value!r}: must be (x, y) or one row of it for each of 1 balls")
    if not np.isfinite(rows).all():
        raise ValueError(f"{name} = {value!r}: must be finite")
    return rows
