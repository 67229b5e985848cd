"""Players of the pinball game that learn nothing."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from agents.look_ahead import LookAhead
from agents.task import Player, Task
from bounce_env.games.episode import FPS
from bounce_env.games.pinball.observe import REFERENCE_SPEED
from bounce_env.games.pinball.setup import LEFT, RIGHT, outline, word_of
from bounce_env.scene import Flipper, Scene

UP, DOWN = 3, 5  # steps that a flailing flipper is up and down
CLEARANCE = 0.004  # m: a ball that will be so near to a flipper is struck
STRIKE = (0.3, 1.1)  # shares of a flipper's length from its pivot on: where it is struck
PRESSED = 4  # steps that a plan holds its buttons
DELAYS = (0, 1, 2, 3, 4, 5, 6, 8, 10, 13, 17, 22)  # steps that a plan waits before it presses them
HORIZON = 45  # steps that a plan looks ahead


def as_actions(task: Task, codes: npt.NDArray[np.int64]) -> npt.NDArray[Any]:
    """Actions from the buttons that are pressed, LEFT + RIGHT, (n,)."""
    if task.resolved_kwargs["action"] == "discrete":
        return codes
    buttons = 4 if task.resolved_kwargs["nudge"] else 2
    return (codes[:, None] >> np.arange(buttons) & 1).astype(np.int8)


def nothing(task: Task) -> Player:
    """No button, ever."""
    return lambda observations: as_actions(task, np.zeros(len(observations), np.int64))


def hold(task: Task) -> Player:
    """Both flippers up, for ever."""
    return lambda observations: as_actions(task, np.full(len(observations), LEFT + RIGHT))


def flail(task: Task) -> Player:
    """Both flippers up and down, for ever, as the clock says: a player that is asked about some worlds only, too."""
    steps = 0

    def act(observations: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        nonlocal steps
        steps += 1
        return as_actions(task, np.full(len(observations), LEFT + RIGHT if steps % (UP + DOWN) < UP else 0))

    return act


@dataclass(frozen=True)
class Timed:
    """Strikes a ball that comes near to a flipper at rest, and waits until the flipper is down again."""

    task: Task

    def __call__(self, observations: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        scene = self.task.scene
        left, below, right, above = outline(scene)
        seen = observations.astype(np.float64)
        vx, vy = seen[:, 2] * REFERENCE_SPEED, seen[:, 3] * REFERENCE_SPEED
        seconds = self.task.resolved_kwargs["frame_skip"] / FPS
        x = left + (seen[:, 0] + 1.0) / 2.0 * (right - left) + vx * seconds
        y = below + (seen[:, 1] + 1.0) / 2.0 * (above - below) + vy * seconds
        codes = np.zeros(len(seen), np.int64)
        flippers = [part for _, part in scene.parts if isinstance(part, Flipper)]
        for flipper in flippers:
            near = near_flipper(scene, flipper, x, y) & (vy <= 0.0)
            codes |= np.where(near, LEFT if word_of(flipper.name) == "flipper_left" else RIGHT, 0)
        return as_actions(self.task, codes)


def near_flipper(
    scene: Scene, flipper: Flipper, x: npt.NDArray[np.float64], y: npt.NDArray[np.float64]
) -> npt.NDArray[np.bool_]:
    """Return whether balls at (x, y) [m], (n,), are where a flipper at rest would strike them well."""
    ux, uy = math.cos(flipper.rest_angle), math.sin(flipper.rest_angle)
    rx, ry = x - flipper.pivot[0], y - flipper.pivot[1]
    along, away = (rx * ux + ry * uy) / flipper.length, np.abs(rx * uy - ry * ux)
    reach = flipper.radius + scene.ball.radius + CLEARANCE
    return (along >= STRIKE[0]) & (along <= STRIKE[1]) & (away <= reach)


def timed(task: Task) -> Player:
    """See `Timed`."""
    return Timed(task)


def look_ahead(task: Task) -> LookAhead:
    """Tries out, before every step, to press either button or both, now or later, and does what paid most.

    Budget: 37 plans of 45 steps (1.5 s) for each step. It knows the launches to come.
    """
    plans = np.zeros((1 + 3 * len(DELAYS), HORIZON), np.int64)
    for k, (code, delay) in enumerate((code, delay) for code in (LEFT, RIGHT, LEFT + RIGHT) for delay in DELAYS):
        plans[1 + k, delay : delay + PRESSED] = code
    return LookAhead(task, np.stack([as_actions(task, plan) for plan in plans]))
