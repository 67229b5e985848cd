"""The tutorial's stepper, compiled: `engine/tutorial.py` to the bit, in both of its versions.

For scenes of walls only. A disc is played as a point among walls that are moved in by its radius, which is the same
where no end of a wall sticks out.
"""

import math

import numba
import numpy as np
import numpy.typing as npt

from bounce_env.report.methods.base import QUICK_STEPS, STEPS, Method, Player, Setting
from bounce_env.report.methods.base import Ball as Moving
from bounce_env.report.problems import Problem
from bounce_env.report.truths import FRAMES, Start
from bounce_env.scene import Ball, Scene, Wall

Floats = npt.NDArray[np.float64]
Point = tuple[float, float]

ROUNDING = 32 * 2.0**-52
MOST_BOUNCES = 10_000
_MOST_STRIKES = 100_000


@numba.njit(cache=True)
def _distance(wall: Floats, x: float, y: float) -> float:
    length = math.sqrt((wall[2] - wall[0]) * (wall[2] - wall[0]) + (wall[3] - wall[1]) * (wall[3] - wall[1]))
    vx, vy = wall[2] - wall[0], wall[3] - wall[1]
    return ((x - wall[0]) * vy + (y - wall[1]) * -vx) / length


@numba.njit(cache=True)
def _tolerance(wall: Floats, x: float, y: float) -> float:
    largest = max(abs(x), abs(y), abs(wall[0]), abs(wall[1]), abs(wall[2]), abs(wall[3]))
    return ROUNDING * largest


@numba.njit(cache=True)
def set_sides(walls: Floats, x: float, y: float, sides: Floats) -> None:
    """Set the side of each wall that a point is on; within rounding of the wall it stays as it is."""
    for i in range(walls.shape[0]):
        distance = _distance(walls[i], x, y)
        if abs(distance) > _tolerance(walls[i], x, y):
            sides[i] = 1.0 if distance > 0 else -1.0


@numba.njit(cache=True)
def ticks(
    walls: Floats, numbers: Floats, ball: Floats, sides: Floats, count: int, recheck: bool, struck: Floats
) -> int:
    """Take `count` ticks; returns how many strikes are in `struck`, or -1 where a tick has no end.

    walls: (n, 6) start, end, b and f. numbers: length of a tick, gravity x, y, and b and f of the ball. ball: x, y, vx,
    vy. sides: (n,).
    """
    dt, gx, gy, ball_b, ball_f = numbers[0], numbers[1], numbers[2], numbers[3], numbers[4]
    strikes = 0
    for _ in range(count):
        vx, vy = ball[2] + gx * dt, ball[3] + gy * dt
        x, y, mx, my = ball[0], ball[1], vx * dt, vy * dt
        end_x, end_y = x + mx, y + my
        left, bounces, over = 1.0, 0, False
        while not over:
            if bounces and not recheck:
                break
            if bounces == MOST_BOUNCES:
                return -1
            set_sides(walls, x, y, sides)
            nearest, best, at_x, at_y = -1, 0.0, 0.0, 0.0
            way = math.sqrt(mx * mx + my * my)
            for i in range(walls.shape[0]):
                wx, wy = walls[i, 2] - walls[i, 0], walls[i, 3] - walls[i, 1]
                length = math.sqrt(wx * wx + wy * wy)
                towards = -sides[i] * (mx * wy + my * -wx) / length
                if towards <= ROUNDING * way:
                    continue
                share = max(0.0, sides[i] * _distance(walls[i], x, y) / towards)
                if share > left or (nearest >= 0 and share >= best):
                    continue
                px, py = x + share * mx, y + share * my
                along = (px - walls[i, 0]) * (wx / length) + (py - walls[i, 1]) * (wy / length)
                slack = _tolerance(walls[i], px, py)
                if -slack <= along <= length + slack:
                    nearest, best, at_x, at_y = i, share, px, py
            if nearest < 0:
                over = True
                continue
            mx, my = _bounced(walls[nearest], mx, my, ball_b, ball_f)
            x, y = at_x, at_y
            left -= best
            end_x, end_y = x + left * mx, y + left * my
            vx, vy = mx / dt, my / dt
            if strikes < struck.shape[0]:
                struck[strikes] = nearest
                strikes += 1
            bounces += 1
        ball[0], ball[1], ball[2], ball[3] = end_x, end_y, vx, vy
    return strikes


@numba.njit(cache=True)
def _bounced(wall: Floats, mx: float, my: float, ball_b: float, ball_f: float) -> tuple[float, float]:
    wx, wy = wall[2] - wall[0], wall[3] - wall[1]
    length = math.sqrt(wx * wx + wy * wy)
    dx, dy, lx, ly = wx / length, wy / length, wy / length, -wx / length
    dp1 = mx * dx + my * dy
    dp2 = mx * lx + my * ly
    f, b = ball_f * wall[5], ball_b * wall[4]
    return f * (dp1 * dx) + b * -(dp2 * lx), f * (dp1 * dy) + b * -(dp2 * ly)


def points_scene(scene: Scene, position: Point) -> Scene:
    """Return the walls among which a point moves as the disc does: each moved by its radius towards `position`."""
    lines = []
    for wall in scene.elements:
        assert isinstance(wall, Wall)
        dx, dy = wall.end[0] - wall.start[0], wall.end[1] - wall.start[1]
        length = math.sqrt(dx * dx + dy * dy)
        nx, ny = -dy / length, dx / length
        side = math.copysign(scene.ball.radius, (position[0] - wall.start[0]) * nx + (position[1] - wall.start[1]) * ny)
        lines.append(((wall.start[0] + side * nx, wall.start[1] + side * ny), (dx / length, dy / length), wall))
    moved = []
    for at, along, wall in lines:
        ends = []
        for end in (wall.start, wall.end):
            other = next((o for o in lines if o[2] is not wall and end in (o[2].start, o[2].end)), None)
            if other is None or along[0] * other[1][1] == along[1] * other[1][0]:  # or it goes on in the same line
                ends.append((at[0] + end[0] - wall.start[0], at[1] + end[1] - wall.start[1]))
            else:
                ends.append(_crossing(at, along, other[0], other[1]))
        moved.append(Wall(ends[0], ends[1], b=wall.b, f=wall.f))
    return Scene(gravity=scene.gravity, ball=Ball(0.0, scene.ball.b, scene.ball.f), elements=tuple(moved))


def _crossing(p: Point, d: Point, q: Point, e: Point) -> Point:
    share = ((q[0] - p[0]) * e[1] - (q[1] - p[1]) * e[0]) / (d[0] * e[1] - d[1] * e[0])
    return p[0] + share * d[0], p[1] + share * d[1]


class TutorialPoint:
    """The tutorial's point in a scene of walls, a disc among walls moved in from where it is. ball: x, y, vx, vy."""

    def __init__(self, scene: Scene, position: Point, velocity: Point) -> None:
        self._scene = scene if scene.ball.radius == 0.0 else points_scene(scene, position)
        walls = [(*w.start, *w.end, w.b, w.f) for w in self._scene.elements if isinstance(w, Wall)]
        self._walls, self._sides = np.array(walls).reshape(-1, 6), np.ones(len(walls))
        self.ball = np.array([*position, *velocity])
        set_sides(self._walls, *position, self._sides)

    def tick(self, dt: float, count: int, struck: Floats, *, recheck: bool = True) -> int:
        """Take `count` ticks of `dt` seconds; returns how many strikes are in `struck`. NaN where one has no end."""
        numbers = np.array([dt, *self._scene.gravity, self._scene.ball.b, self._scene.ball.f])
        strikes = int(ticks(self._walls, numbers, self.ball, self._sides, count, recheck, struck))
        if strikes < 0:
            self.ball[:] = math.nan
        return max(strikes, 0)


class TutorialPlayer(Player):
    """The stepper on one problem."""

    def __init__(self, problem: Problem, per_second: int, *, recheck: bool) -> None:
        self._scene, self._recheck = problem.scene, recheck
        self._each, self._dt = per_second // FRAMES, 1.0 / per_second
        self._strikes = np.zeros(_MOST_STRIKES)

    def begin(self, start: Start) -> None:
        """Put the point at its start."""
        self._point = TutorialPoint(self._scene, *start)

    def go(self, frames: int) -> None:
        """Take all ticks in one compiled call."""
        count = self._point.tick(self._dt, frames * self._each, self._strikes, recheck=self._recheck)
        if self.struck is not None:
            self.struck += self._strikes[:count].astype(int).tolist()

    def ball(self) -> Moving:
        """Return the point."""
        x, y, vx, vy = self._point.ball.tolist()
        return x, y, vx, vy


class Tutorial(Method):
    """The tutorial's stepper. recheck: its improved version."""

    slower = 10

    def __init__(self, *, recheck: bool) -> None:
        self.name = "tutorial_recheck" if recheck else "tutorial_once"
        self.label = "tutorial, every wall again" if recheck else "tutorial, one bounce a tick"
        self.settings, self.quick = STEPS, QUICK_STEPS
        self.note = "compiled, equal to engine/tutorial.py to the bit"
        self._recheck = recheck

    def why_not(self, problem: Problem) -> str | None:
        """Return what of the scene the tutorial does not know."""
        scene = problem.scene
        if not all(isinstance(e, Wall) and not e.draggable for e in scene.elements):
            return "not applicable: the tutorial has standing walls only"
        return None

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready."""
        return TutorialPlayer(problem, setting.value, recheck=self._recheck)
