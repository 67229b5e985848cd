"""Players of the paddle game that learn nothing: they go where they want to be at the paddle's full speed."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from agents.command import Refused
from agents.look_ahead import LookAhead
from agents.task import Player, Task
from bounce_env.games.episode import FPS
from bounce_env.games.paddle.setup import REFERENCE_SPEED, field_of
from bounce_env.scene import Paddle, Scene, Wall

Floats = npt.NDArray[np.float64]
HORIZON = 60  # steps that a plan looks ahead
MOVES = (1, 2, 3, 5, 7, 10, 14, 19, 25)  # steps after which it goes on otherwise
MAX_BOUNCES = 64
"""A ball that has bounced so often without landing never does."""


@dataclass(frozen=True)
class Table:
    """What a scene of the paddle game looks like to the centre of its ball. Metres, seconds."""

    x: float  # lower left corner and size of the field
    y: float
    width: float
    height: float
    left: float  # where the centre is stopped by the side walls and the top
    right: float
    top: float
    contact: float  # height of the centre where the ball lands on the paddle
    side_bounce: tuple[float, float]  # share of the speed (along the normal, along the wall) that a bounce leaves
    top_bounce: tuple[float, float]
    gravity: float  # downwards
    rail: tuple[float, float]  # x of the paddle's centre at its stops
    speed: float  # of the paddle

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """Raises Refused where the field is not a box with a level rail under a vertical gravity."""
        x, y, width, height = field_of(scene)
        walls = [e for e in scene.elements if isinstance(e, Wall)]
        paddle = next(e for e in scene.elements if isinstance(e, Paddle))
        side = min(walls, key=lambda wall: wall.bounds[0])
        other = max(walls, key=lambda wall: wall.bounds[2])
        top = max(walls, key=lambda wall: wall.bounds[1])
        needs = {
            "vertical side walls": all(wall.start[0] == wall.end[0] for wall in (side, other)),
            "side walls of one b and one f": (side.b, side.f) == (other.b, other.f),
            "a level top wall": top.start[1] == top.end[1],
            "a level rail": paddle.rail_start[1] == paddle.rail_end[1],
            "gravity that points down": scene.gravity[0] == 0.0 and scene.gravity[1] <= 0.0,
        }
        missing = [need for need, met in needs.items() if not met]
        if missing:
            raise Refused(f"the baselines need {', '.join(missing)}: the scene has none")
        ball = scene.ball
        stops = sorted((paddle.rail_start[0], paddle.rail_end[0]))
        return cls(
            x, y, width, height,
            left=side.start[0] + ball.radius,
            right=other.start[0] - ball.radius,
            top=top.start[1] - ball.radius,
            contact=paddle.rail_start[1] + paddle.radius + ball.radius,
            side_bounce=(ball.b * side.b, ball.f * side.f),
            top_bounce=(ball.b * top.b, ball.f * top.f),
            gravity=-scene.gravity[1],
            rail=(stops[0], stops[1]),
            speed=paddle.max_speed,
        )  # fmt: skip

    def ball(self, observations: npt.NDArray[np.float32]) -> tuple[Floats, Floats, Floats, Floats]:
        """x, y [m], vx, vy [m/s] of the balls, each (n,)."""
        seen = observations.astype(np.float64)
        x = self.x + (seen[:, 0] + 1.0) / 2.0 * self.width
        y = self.y + (seen[:, 1] + 1.0) / 2.0 * self.height
        return x, y, seen[:, 2] * REFERENCE_SPEED, seen[:, 3] * REFERENCE_SPEED

    def paddle(self, observations: npt.NDArray[np.float32]) -> Floats:
        """x [m] of the paddles' centres, (n,)."""
        low, high = self.rail
        return low + (observations[:, 4].astype(np.float64) + 1.0) / 2.0 * (high - low)


def landing(table: Table, x: Floats, y: Floats, vx: Floats, vy: Floats) -> Floats:
    """x [m] of the balls' centres, (n,), when they come down to the paddle's height; bumpers and kicks are ignored.

    Exact: parabolas from wall to wall, with the law of the bounce at each. A ball that does not land (it is below that
    height, or bounces on and on without gravity) gives its present x. x, y [m] and vx, vy [m/s]: (n,).
    """
    now = x
    x, y, vx, vy = (np.array(a, np.float64) for a in (x, y, vx, vy))
    flying = np.flatnonzero((y >= table.contact) | np.isfinite(time_to_land(table, x, y, vx, vy)))
    for _ in range(MAX_BOUNCES):
        state = x[flying], y[flying], vx[flying], vy[flying]
        times = np.stack([time_to_land(table, *state), time_to_top(table, *state), time_to_side(table, *state)])
        first, t = times.argmin(axis=0), times.min(axis=0)
        x[flying[t == np.inf]] = now[flying[t == np.inf]]
        flying, first, t = flying[t < np.inf], first[t < np.inf], t[t < np.inf]
        x[flying] += vx[flying] * t
        y[flying] += (vy[flying] - table.gravity * t / 2.0) * t
        vy[flying] -= table.gravity * t
        top, side = flying[first == 1], flying[first == 2]
        x[side] = np.where(vx[side] > 0.0, table.right, table.left)
        vx[side], vy[side] = -table.side_bounce[0] * vx[side], table.side_bounce[1] * vy[side]
        y[top] = table.top
        vx[top], vy[top] = table.top_bounce[1] * vx[top], -table.top_bounce[0] * vy[top]
        flying = flying[first != 0]
        if not len(flying):
            break
    x[flying] = now[flying]
    return x


def time_to_land(table: Table, x: Floats, y: Floats, vx: Floats, vy: Floats) -> Floats:
    """Seconds until the height of contact is passed downwards; infinite for never."""
    drop = y - table.contact
    square = vy**2 + 2.0 * table.gravity * drop
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(square)
        t = np.where(vy > 0.0, (vy + root) / table.gravity, 2.0 * drop / (root - vy))
    return np.where((square >= 0.0) & (t >= 0.0), t, np.inf)


def time_to_top(table: Table, x: Floats, y: Floats, vx: Floats, vy: Floats) -> Floats:
    """Seconds until the top wall is reached; infinite for never."""
    rise = table.top - y
    square = vy**2 - 2.0 * table.gravity * rise
    with np.errstate(invalid="ignore", divide="ignore"):
        t = 2.0 * rise / (vy + np.sqrt(square))
    return np.where((vy > 0.0) & (square >= 0.0), t, np.inf)


def time_to_side(table: Table, x: Floats, y: Floats, vx: Floats, vy: Floats) -> Floats:
    """Seconds until a side wall is reached; infinite for never."""
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.where(vx > 0.0, table.right - x, table.left - x) / vx
    return np.where(vx != 0.0, np.maximum(t, 0.0), np.inf)


def look_ahead(task: Task) -> LookAhead:
    """Tries out, before every step, to move for a while and then otherwise, and does what paid most.

    Budget: 185 plans of 60 steps (2 s) for each step.
    """
    speeds, later = (-1.0, -0.5, 0.5, 1.0), (-1.0, -0.5, 0.0, 0.5, 1.0)
    plans = [np.full(HORIZON, speed) for speed in (0.0, *speeds)]
    for first in speeds:
        for steps in MOVES:
            plans += [np.where(np.arange(HORIZON) < steps, first, second) for second in later]
    if task.resolved_kwargs["action"] == "discrete":
        return LookAhead(task, 1 + np.sign(plans).astype(np.int64))
    return LookAhead(task, np.array(plans, np.float32)[:, :, None])


class Mover:
    """A player that names a place for the paddle and goes there at full speed.

    `target` maps a table and observations (n, size) to x [m], (n,).
    """

    def __init__(self, task: Task, target: Callable[[Table, npt.NDArray[np.float32]], Floats]) -> None:
        kwargs = task.resolved_kwargs
        self.table = Table.of(task.scene)
        self.reach = self.table.speed * kwargs["frame_skip"] / FPS  # m that the paddle can move in one step
        self.discrete = kwargs["action"] == "discrete"
        self.target = target

    def __call__(self, observations: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        target = np.clip(self.target(self.table, observations), *self.table.rail)
        steps = (target - self.table.paddle(observations)) / self.reach
        if self.discrete:
            return 1 + np.where(np.abs(steps) > 0.5, np.sign(steps), 0.0).astype(np.int64)
        return np.clip(steps, -1.0, 1.0).astype(np.float32)[:, None]


def nothing(task: Task) -> Player:
    """Stay where the paddle is."""
    return Mover(task, lambda table, observations: table.paddle(observations))


def follow(task: Task) -> Player:
    """Stay under the ball."""
    return Mover(task, lambda table, observations: table.ball(observations)[0])


def predictor(task: Task) -> Player:
    """Go to where the ball will land."""
    return Mover(task, lambda table, observations: landing(table, *table.ball(observations)))
