"""An ODE solver with an event for each surface, started anew after each bounce; and one that is told the contact."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy
from scipy.integrate import solve_ivp

from bounce_env.report.methods import solids
from bounce_env.report.methods.base import FRAMES, Method, Player, Setting, Trace
from bounce_env.report.methods.solids import gap_to, solids_of, timelines_of
from bounce_env.report.problems import Problem
from bounce_env.report.truths import Start

Floats = npt.NDArray[np.float64]

MOST_EVENTS = 300
"""Impacts in one run, after which it is given up: they accumulate."""
TOLERANCES = tuple(Setting(f"rtol 1e-{k}", 10.0**-k) for k in (4, 7, 10, 13))


class ScipyPlayer(Player):
    """`solve_ivp` with an event for each solid, started anew after each impact."""

    def __init__(self, problem: Problem, tolerance: float, top_speed: float) -> None:
        scene = problem.scene
        self._scene, self._rows = scene, solids_of(scene)
        self._timelines, self._tolerance = timelines_of(scene, problem.commands), tolerance
        # Events are looked for at the ends of steps: none may be long enough to pass through something.
        self._longest = scene.ball.radius / top_speed
        self._changes = sorted({t for t in self._timelines[:, :, 0].ravel().tolist() if 0.0 < t < math.inf})
        gx, gy = scene.gravity
        self._field = lambda t, y: (y[2], y[3], gx, gy)
        self._events = [self._event(row) for row in self._rows]

    def _event(self, row: Floats) -> Callable[[float, Floats], float]:
        radius = self._scene.ball.radius

        def gap(t: float, y: Floats) -> float:
            return float(gap_to(row, self._timelines, y[0], y[1], radius, t)[0])

        gap.terminal, gap.direction = True, -1.0  # type: ignore[attr-defined]
        return gap

    def begin(self, start: Start) -> None:
        """Put the ball at its start."""
        self._now, self._ball = 0.0, np.array([*start.position, *start.velocity])
        self._struck: list[int] = []
        self._found = 0
        self._kicked: dict[int, float] = {}
        self._given_up = False

    def go(self, frames: int) -> None:
        """Integrate from impact to impact."""
        self._integrate(frames / FRAMES)

    def _integrate(self, end: float) -> None:
        while self._now < end and not self._given_up:
            until = min([end, *(t for t in self._changes if t > self._now)])
            run = solve_ivp(
                self._field, (self._now, until), self._ball, method="DOP853", rtol=self._tolerance,
                atol=self._tolerance, max_step=self._longest, events=self._events,
            )  # fmt: skip
            self._now, self._ball = float(run.t[-1]), run.y[:, -1].copy()
            for row, times in zip(self._rows, run.t_events, strict=True):
                if len(times):
                    self._bounce(row)
                    self._found += 1
            self._given_up = self._found > MOST_EVENTS or not run.success

    def _bounce(self, row: Floats) -> None:
        x, y, vx, vy = self._ball.tolist()
        _, nx, ny, ux, uy = gap_to(row, self._timelines, x, y, self._scene.ball.radius, self._now)
        approach = -((vx - ux) * nx + (vy - uy) * ny)
        ex, ey = row[solids.BX] - row[solids.AX], row[solids.BY] - row[solids.AY]
        if approach <= 0.0 or (row[solids.ONE_WAY] > 0.0 and nx * -ey + ny * ex <= 0.0):
            return
        element = int(row[solids.ELEMENT])
        rebound = row[solids.B] * approach
        cold = self._now - self._kicked.get(element, -math.inf) >= row[solids.COOLDOWN]
        if row[solids.KICK] > 0.0 and approach > row[solids.KICK_OVER] and cold:
            rebound += row[solids.KICK]
            self._kicked[element] = self._now
        velocity = np.array([vx, vy]) + (approach + rebound) * np.array([nx, ny])
        cap, speed = self._scene.max_speed, math.hypot(*velocity.tolist())
        if cap is not None and speed > cap:
            velocity *= cap / speed
        self._ball[2:] = velocity
        self._struck.append(element)

    def trace(self, start: Start, frames: npt.NDArray[np.int64]) -> Trace:
        """Integrate from frame to frame; NaN from where it was given up."""
        self.begin(start)
        places = []
        for frame in frames.tolist():
            self._integrate(frame / FRAMES)
            places.append((math.nan, math.nan) if self._given_up else self._ball[:2].copy())
        _, _, vx, vy = self._ball.tolist()
        return Trace(np.array(places).reshape(-1, 2), tuple(self._struck), (vx, vy))


class Scipy(Method):
    """scipy's `solve_ivp`."""

    name, label = "scipy", f"scipy {scipy.__version__} with events"
    settings, quick = TOLERANCES, (TOLERANCES[2],)
    note = f"DOP853, no step longer than the ball's radius at the greatest speed, given up after {MOST_EVENTS} impacts"

    def why_not(self, problem: Problem) -> str | None:
        """Return None: it plays all."""
        return None

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready."""
        return ScipyPlayer(problem, setting.value, top_speed)


class ByHandPlayer(Player):
    """The angle on the circle as an ODE; where the ball lets go, its parabola."""

    def __init__(self, problem: Problem, tolerance: float) -> None:
        self._radius, self._pull = 1.0 - problem.scene.ball.radius, -problem.scene.gravity[1]
        self._tolerance, self._lets_go = tolerance, problem.name == "loop"

    def begin(self, start: Start) -> None:
        """Put the ball at its start."""
        x, y = start.position
        self._start = (math.atan2(x, -y), start.velocity[0] / self._radius)

    def go(self, frames: int) -> None:
        """Integrate."""
        self._places(np.array([frames]))

    def _places(self, frames: npt.NDArray[np.int64]) -> Floats:
        r, g = self._radius, self._pull

        def press(t: float, y: Floats) -> float:
            return float(r * y[1] * y[1] + g * math.cos(y[0]))

        press.terminal, press.direction = True, -1.0  # type: ignore[attr-defined]
        run: Any = solve_ivp(
            lambda t, y: (y[1], -g / r * math.sin(y[0])), (0.0, frames[-1] / FRAMES), self._start, method="DOP853",
            rtol=self._tolerance, atol=self._tolerance, dense_output=True, events=press if self._lets_go else None,
        )  # fmt: skip
        end, (angle, rate) = run.t[-1], run.y[:, -1]
        vx, vy = r * rate * math.cos(angle), r * rate * math.sin(angle)
        places = []
        for t in (frames / FRAMES).tolist():
            if t <= end:
                angle_then = float(run.sol(t)[0])
                places.append((r * math.sin(angle_then), -r * math.cos(angle_then)))
            else:
                s = t - end
                places.append((r * math.sin(angle) + vx * s, -r * math.cos(angle) + vy * s - 0.5 * g * s * s))
        return np.array(places)

    def trace(self, start: Start, frames: npt.NDArray[np.int64]) -> Trace:
        """Integrate, with the places at the frames."""
        self.begin(start)
        return Trace(self._places(frames), None)


class ByHand(Method):
    """An ODE of the contact that a human has written down."""

    name, label = "by_hand", "scipy, told the contact"
    settings, quick = TOLERANCES, (TOLERANCES[2],)
    note = "DOP853 on the angle; it cannot find the contact, and knows no other scene"

    def why_not(self, problem: Problem) -> str | None:
        """Return why there is nothing to tell it."""
        if problem.name in ("bowl", "loop"):
            return None
        return "not applicable: no slide on a curve that could be written down"

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready."""
        return ByHandPlayer(problem, setting.value)
