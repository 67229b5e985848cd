"""What a method is: something that plays a problem, at settings that trade time for accuracy."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.report.problems import Problem
from bounce_env.report.truths import FRAMES, Start

Floats = npt.NDArray[np.float64]
Ball = tuple[float, float, float, float]
"""x, y [m], vx, vy [m/s]."""


@dataclass(frozen=True)
class Trace:
    """What a method did from one start.

    places: (n, 2) [m] at the frames asked for. order: elements struck, one after the other; None where it is not known.
    velocity: at the last of the frames [m/s].
    """

    places: Floats
    order: tuple[int, ...] | None
    velocity: tuple[float, float]


class Player(ABC):
    """A method that is ready to play one problem at one setting."""

    worlds = 1
    """How many worlds `go` plays."""

    struck: list[int] | None = None
    """What has been struck since `begin`, where that is watched; None where it is not, and nothing is noted."""

    @abstractmethod
    def begin(self, start: Start) -> None:
        """Put the ball at its start; not timed."""

    @abstractmethod
    def go(self, frames: int) -> None:
        """Play so many frames further: what is timed."""

    @abstractmethod
    def ball(self) -> Ball:
        """Return where the ball is now; NaN where the method has given up."""

    def watch(self) -> None:
        """From the start on, note in `struck` what is struck."""
        self.struck = []

    def trace(self, start: Start, frames: npt.NDArray[np.int64]) -> Trace:
        """Play from a start, and tell the places at these frames and the order of bounces."""
        self.begin(start)
        self.watch()
        now, balls = 0, list[Ball]()
        for frame in frames.tolist():
            self.go(frame - now)
            now = frame
            balls.append(self.ball())
        order, self.struck = self.struck, None
        _, _, vx, vy = balls[-1]
        return Trace(np.array(balls)[:, :2], None if order is None else tuple(order), (vx, vy))


@dataclass(frozen=True)
class Setting:
    """One point on a method's line. label: as the tables show it. value: steps a second, a tolerance, or None."""

    label: str
    value: Any = None


class Method(ABC):
    """One line of the diagrams."""

    name: str
    label: str
    settings: tuple[Setting, ...]
    quick: tuple[Setting, ...]
    note: str
    """Its best settings, for the table of methods."""

    slower = 1000
    """By how much fewer bounces it makes in a long run, which would take it hours; 0 where another's run tells its."""

    def why_not(self, problem: Problem) -> str | None:
        """Return why it cannot play the problem, in words for the table; None where it can."""
        return None

    @abstractmethod
    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready. top_speed: the greatest speed of the truths [m/s]."""


def steps_of(per_second: int) -> Setting:
    """Return a setting of a time stepper."""
    return Setting(f"1/{per_second} s", per_second)


STEPS = tuple(steps_of(FRAMES * 4**k) for k in range(5))
"""1/60 to 1/15360 s."""
QUICK_STEPS = (STEPS[1], STEPS[2])
