"""Players of the game of walls that learn nothing."""

import math
from dataclasses import dataclass, fields
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt

from agents.look_ahead import LookAhead
from agents.task import Player, Task
from bounce_env.games.episode import FPS
from bounce_env.games.walls.setup import CONTROLS, REFERENCE_SPEED, WALL_SPEED, dragged_wall, field_of, longest
from bounce_env.scene import Scene

Floats = npt.NDArray[np.float64]

FLIGHTS = np.linspace(0.1, 1.6, 31)  # s: ways to the target that are thought of
COMING = np.linspace(0.02, 1.2, 60)  # s: instants at which the ball may be met
HALF = 0.1  # m, of the length at which the player keeps the wall

HORIZON = 45  # steps that a plan looks ahead
MOVES = (1, 2, 3, 5, 8, 12, 17, 23, 30)  # steps after which it goes on otherwise
TURNS = (-1.0, 0.0, 1.0)


def nothing(task: Task) -> Player:
    """Leave the wall where it is."""
    return lambda observations: np.zeros((len(observations), CONTROLS), np.float32)


@dataclass(frozen=True)
class Seen:
    """What an observation tells, each (n,): metres and m/s."""

    x: Floats
    y: Floats
    vx: Floats
    vy: Floats
    x0: Floats
    y0: Floats
    x1: Floats
    y1: Floats
    tx: Floats
    ty: Floats

    @classmethod
    def of(cls, scene: Scene, observations: npt.NDArray[np.float32]) -> "Seen":
        """From observations (n, size)."""
        x, y, width, height = field_of(scene)
        low, size = np.array((x, y)), np.array((width, height))
        numbers = observations[:, : len(fields(cls))].astype(np.float64)
        places = low + (numbers.reshape(len(numbers), -1, 2) + 1.0) / 2.0 * size
        places[:, 1] = numbers[:, 2:4] * REFERENCE_SPEED
        return cls(*places.reshape(len(numbers), -1).T)


@dataclass(frozen=True)
class Guide:
    """Meets the falling ball with the wall where and at the slope at which it goes to the target from there.

    It knows of the standing walls as little as of friction: its flights are parabolas from the ball to the wall, and
    from there to the target.
    """

    task: Task

    def __call__(self, observations: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        scene = self.task.scene
        gravity, wall = np.array(scene.gravity), dragged_wall(scene)
        seen = Seen.of(scene, observations)
        seconds = self.task.resolved_kwargs["frame_skip"] / FPS
        reach = wall.reach or ((-math.inf, -math.inf), (math.inf, math.inf))
        half = min(HALF, longest(wall) / 2.0)
        met, normal = meeting(seen, gravity, scene.ball.b * wall.b, np.sort(np.array(reach), axis=0), half)
        middle = met - scene.ball.radius * normal
        along = np.stack([normal[:, 1], -normal[:, 0]], axis=1) * half
        now = np.stack([seen.x0, seen.y0, seen.x1, seen.y1], axis=1)
        wanted = np.concatenate([middle - along, middle + along], axis=1)
        return np.clip((wanted - now) / (WALL_SPEED * seconds), -1.0, 1.0).astype(np.float32)


def meeting(
    seen: Seen, gravity: Floats, bounce: float, reach: Floats, half: float
) -> tuple[Floats, Floats]:  # fmt: skip
    """Return where the ball's centre is to be met, and the normal that the wall must have there, (n, 2) each.

    Of all instants and flights to the target that which asks least of the wall: to be fast, and to be elsewhere soon.
    """
    ball, velocity, target = (
        np.stack(pair, axis=1) for pair in ((seen.x, seen.y), (seen.vx, seen.vy), (seen.tx, seen.ty))
    )
    t, u = COMING[:, None], FLIGHTS[:, None]
    met = ball[:, None] + velocity[:, None] * t + gravity * t * t / 2.0  # (n, instants, 2)
    speed = velocity[:, None] + gravity * t
    way = target[:, None] - met
    leaving = (way[:, :, None] - gravity * u * u / 2.0) / u  # (n, instants, flights, 2)
    change = leaving - speed[:, :, None]
    size = np.linalg.norm(change, axis=3)
    normal = change / np.maximum(size, 1e-9)[..., None]
    closing = -(speed[:, :, None] * normal).sum(axis=3)
    # A wall that stands gives (1 + b) times the closing speed; what is missing or too much it has to move by.
    push = np.abs(size / (1.0 + bounce) - closing)
    low, high = reach[0] + half, reach[1] - half
    outside = np.maximum(low - met, met - high).max(axis=2) > 0.0
    middle = np.stack([seen.x0 + seen.x1, seen.y0 + seen.y1], axis=1) / 2.0
    late = np.maximum(np.abs(met - middle[:, None]).max(axis=2) / WALL_SPEED - t[:, 0], 0.0)
    cost = push + (4.0 * late + 100.0 * outside)[..., None] + 100.0 * (normal[..., 1] < 0.2)
    best = cost.reshape(len(cost), -1).argmin(axis=1)
    rows, (instant, flight) = np.arange(len(cost)), np.unravel_index(best, cost.shape[1:])
    return met[rows, instant], normal[rows, instant, flight]


def guide(task: Task) -> Player:
    """See `Guide`."""
    return Guide(task)


def look_ahead(task: Task) -> LookAhead:
    """Tries out, before every step, to move and turn the wall for a while and then otherwise, and does what paid most.

    Budget: 469 plans of 45 steps (1.5 s) for each step. It knows what comes next.
    """
    ways = [motion(x, y, turn) for x, y, turn in product(TURNS, TURNS, TURNS)]
    still = np.zeros(CONTROLS)
    plans = [np.tile(still, (HORIZON, 1))]
    later = (still, motion(0.0, 1.0, 0.0))
    for way, steps, then in product([way for way in ways if way.any()], MOVES, later):
        plans.append(np.where(np.arange(HORIZON)[:, None] < steps, way, then))
    return LookAhead(task, np.array(plans, np.float32))


def motion(x: float, y: float, turn: float) -> Floats:
    """Return the action that moves the wall's middle by (x, y), and turns a level wall about it."""
    return np.clip(np.array((x, y - turn, x, y + turn)), -1.0, 1.0)
