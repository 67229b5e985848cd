"""A time stepper for infinitely many impacts: Moreau's midpoint rule with Newton's law of impact (Jean 1999), compiled.

At the middle of each step the gaps decide what is touched; one solve for the velocity then makes it close on none of
that, each rebounding by its own b. It knows no instant of impact, and so neither misses a pile of them nor resolves
any: the honest opponent where bounces accumulate.
"""

import math

import numba
import numpy as np
import numpy.typing as npt

from bounce_env.report.methods import solids
from bounce_env.report.methods.base import QUICK_STEPS, STEPS, Ball, Method, Player, Setting
from bounce_env.report.methods.solids import gap_to, is_behind_gate, solids_of, timelines_of
from bounce_env.report.problems import Problem
from bounce_env.report.truths import FRAMES, Start

Floats = npt.NDArray[np.float64]

SWEEPS = 50
_MOST_STRIKES = 100_000


@numba.njit(cache=True)
def advance(
    rows: Floats, timelines: Floats, numbers: Floats, ball: Floats, last: Floats, step: int, steps: int, struck: Floats
) -> int:
    """Take `steps` steps from step number `step` on; returns how many strikes are in `struck`.

    numbers: length of a step, gravity x, y, ball radius, cap. ball: x, y, vx, vy. last: per solid, the step in which it
    was touched last, and when it kicked.
    """
    h, gx, gy, radius, cap = numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]
    n = rows.shape[0]
    touched = np.empty((n, 6))
    count = 0
    for k in range(step, step + steps):
        middle_x, middle_y = ball[0] + 0.5 * h * ball[2], ball[1] + 0.5 * h * ball[3]
        vx, vy = ball[2] + h * gx, ball[3] + h * gy
        active = 0
        for i in range(n):
            gap, nx, ny, ux, uy = gap_to(rows[i], timelines, middle_x, middle_y, radius, (k + 0.5) * h)
            if gap > 0.0:
                continue
            before = (ball[2] - ux) * nx + (ball[3] - uy) * ny
            if is_behind_gate(rows[i], nx, ny):
                continue
            rebound = max(-rows[i, solids.B] * before, 0.0)
            cold = (k * h - last[i, 1]) >= rows[i, solids.COOLDOWN]
            if rows[i, solids.KICK] > 0.0 and -before > rows[i, solids.KICK_OVER] and cold:
                rebound += rows[i, solids.KICK]
                last[i, 1] = k * h
            touched[active, 0], touched[active, 1] = nx, ny
            touched[active, 2] = ux * nx + uy * ny + rebound
            touched[active, 3], touched[active, 4] = 0.0, float(i)
            active += 1
        for _ in range(SWEEPS if active > 1 else active):
            for a in range(active):
                missing = touched[a, 2] - (vx * touched[a, 0] + vy * touched[a, 1])
                push = max(touched[a, 3] + missing, 0.0)
                vx += (push - touched[a, 3]) * touched[a, 0]
                vy += (push - touched[a, 3]) * touched[a, 1]
                touched[a, 3] = push
        for a in range(active):
            i = int(touched[a, 4])
            if touched[a, 3] > 0.0:
                if last[i, 0] < k - 1 and count < struck.shape[0]:
                    struck[count] = rows[i, solids.ELEMENT]
                    count += 1
                last[i, 0] = k
        speed = math.sqrt(vx * vx + vy * vy)
        if active > 0 and speed > cap:
            vx, vy = vx * cap / speed, vy * cap / speed
        ball[0], ball[1], ball[2], ball[3] = middle_x + 0.5 * h * vx, middle_y + 0.5 * h * vy, vx, vy
    return count


class MoreauPlayer(Player):
    """The stepper on one problem."""

    def __init__(self, problem: Problem, per_second: int) -> None:
        scene = problem.scene
        self._rows, self._timelines = solids_of(scene), timelines_of(scene, problem.commands)
        cap = math.inf if scene.max_speed is None else scene.max_speed
        self._numbers = np.array([1.0 / per_second, *scene.gravity, scene.ball.radius, cap])
        self._each = per_second // FRAMES
        self._ball, self._last = np.zeros(4), np.zeros((len(self._rows), 2))
        self._strikes = np.zeros(_MOST_STRIKES)

    def begin(self, start: Start) -> None:
        """Put the ball at its start."""
        self._ball[:] = *start.position, *start.velocity
        self._last[:] = -2, -math.inf

        self._step = 0

    def go(self, frames: int) -> None:
        """Take all steps in one compiled call."""
        steps, ways = frames * self._each, (self._rows, self._timelines, self._numbers, self._ball, self._last)
        count = advance(*ways, self._step, steps, self._strikes)
        self._step += steps
        if self.struck is not None:
            self.struck += self._strikes[:count].astype(int).tolist()

    def ball(self) -> Ball:
        """Return the ball."""
        x, y, vx, vy = self._ball.tolist()
        return x, y, vx, vy


class Moreau(Method):
    """Moreau's stepper."""

    name, label = "moreau", "Moreau-Jean stepper"
    settings, quick = STEPS, QUICK_STEPS
    slower = 10
    note = f"compiled, {SWEEPS} sweeps of Gauss-Seidel where two or more are touched"

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready."""
        return MoreauPlayer(problem, setting.value)
