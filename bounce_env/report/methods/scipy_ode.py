"""An ODE solver with an event for each surface, started anew after each bounce; and one that is told the contact."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy
from scipy.integrate import solve_ivp

from bounce_env.report.methods import solids
from bounce_env.report.methods.base import Ball, Method, Player, Setting
from bounce_env.report.methods.solids import gap_to, is_behind_gate, solids_of, timelines_of
from bounce_env.report.problems import Problem
from bounce_env.report.truths import FRAMES, Start
from bounce_env.scene import Arc

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
        self._frame = self._found = 0
        self._kicked: dict[int, float] = {}
        self._given_up = False

    def go(self, frames: int) -> None:
        """Integrate from impact to impact."""
        self._frame += frames
        end = self._frame / FRAMES
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
        if approach <= 0.0 or is_behind_gate(row, nx, ny):
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
        if self.struck is not None:
            self.struck.append(element)

    def ball(self) -> Ball:
        """Return the ball; NaN where it was given up."""
        if self._given_up:
            return (math.nan,) * 4
        x, y, vx, vy = self._ball.tolist()
        return x, y, vx, vy


class Scipy(Method):
    """scipy's `solve_ivp`."""

    name, label = "scipy", f"scipy {scipy.__version__} with events"
    settings, quick = TOLERANCES, (TOLERANCES[2],)
    note = f"DOP853, no step longer than the ball's radius at the greatest speed, given up after {MOST_EVENTS} impacts"
    slower = 4000

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready."""
        return ScipyPlayer(problem, setting.value, top_speed)


class ByHandPlayer(Player):
    """The angle on the circle as an ODE; where the ball lets go, its parabola."""

    def __init__(self, problem: Problem, tolerance: float) -> None:
        (arc,) = problem.scene.elements
        assert isinstance(arc, Arc)
        self._radius, self._pull = arc.radius - problem.scene.ball.radius, -problem.scene.gravity[1]
        self._tolerance, self._lets_go = tolerance, arc.closed

    def begin(self, start: Start) -> None:
        """Put the ball at its start."""
        x, y = start.position
        self._state = np.array([math.atan2(x, -y), start.velocity[0] / self._radius])
        self._flight: Ball | None = None

    def watch(self) -> None:
        """Note nothing: it strikes nothing."""

    def go(self, frames: int) -> None:
        """Integrate the angle; once the ball has let go, fly on."""
        seconds = frames / FRAMES
        if self._flight is None:
            seconds -= self._slide(seconds)
        if self._flight is not None:
            x, y, vx, vy = self._flight
            fall = self._pull * seconds
            self._flight = (x + vx * seconds, y + (vy - 0.5 * fall) * seconds, vx, vy - fall)

    def _slide(self, seconds: float) -> float:
        """Slide on for so long, or until the circle does not press any more; returns for how long."""
        r, g = self._radius, self._pull

        def press(t: float, y: Floats) -> float:
            return float(r * y[1] * y[1] + g * math.cos(y[0]))

        press.terminal, press.direction = True, -1.0  # type: ignore[attr-defined]
        run: Any = solve_ivp(
            lambda t, y: (y[1], -g / r * math.sin(y[0])), (0.0, seconds), self._state, method="DOP853",
            rtol=self._tolerance, atol=self._tolerance, events=press if self._lets_go else None,
        )  # fmt: skip
        self._state = run.y[:, -1]
        if self._lets_go and len(run.t_events[0]):
            self._flight = self._on_circle()
        return float(run.t[-1])

    def _on_circle(self) -> Ball:
        (angle, rate), r = self._state.tolist(), self._radius
        return (
            r * math.sin(angle),
            -r * math.cos(angle),
            r * rate * math.cos(angle),
            r * rate * math.sin(angle),
        )

    def ball(self) -> Ball:
        """Return the ball."""
        return self._on_circle() if self._flight is None else self._flight


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
