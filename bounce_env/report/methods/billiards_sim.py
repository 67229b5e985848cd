"""PyPI's `billiards`: exact and event-driven, without gravity and restitution. GPL-3: no extra of ours names it."""

import billiards

from bounce_env.report.methods.base import Ball, Method, Player, Setting
from bounce_env.report.problems import Problem
from bounce_env.report.truths import FRAMES, Start
from bounce_env.scene import Bumper, Wall, moves


class BilliardsPlayer(Player):
    """billiards on one problem."""

    def __init__(self, problem: Problem) -> None:
        self._scene = problem.scene

    def begin(self, start: Start) -> None:
        """Make a new billiard; its walls are lines without ends, struck from the left."""
        elements = self._scene.elements
        obstacles = [
            billiards.InfiniteWall(e.start, e.end) if isinstance(e, Wall) else billiards.Disk(e.center, e.radius)
            for e in elements
            if isinstance(e, Wall | Bumper)
        ]
        self._index = {id(obstacle): index for index, obstacle in enumerate(obstacles)}
        self._billiard = billiards.Billiard(obstacles)
        self._billiard.add_ball(start.position, start.velocity, self._scene.ball.radius)

        self._frame = 0

    def go(self, frames: int) -> None:
        """Evolve in one call."""
        self._frame += frames
        rows = self._billiard.evolve(self._frame / FRAMES)
        if self.struck is not None:
            self.struck += [self._index[id(obstacle)] for _, _, obstacle in rows]

    def ball(self) -> Ball:
        """Return the ball."""
        return (*self._billiard.balls_position[0].tolist(), *self._billiard.balls_velocity[0].tolist())


class Billiards(Method):
    """billiards."""

    name, label = "billiards", f"billiards {billiards.__version__}"
    settings = quick = (Setting("exact"),)
    note = "no setting"

    def why_not(self, problem: Problem) -> str | None:
        """Return what of the scene it does not know."""
        scene = problem.scene
        if any(scene.gravity):
            return "not applicable: it has no gravity"
        if not all(isinstance(e, Wall | Bumper) and e.b == 1.0 and not moves(e) for e in scene.elements):
            return "not applicable: it has standing walls and discs with b = 1 only"
        return None

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready."""
        return BilliardsPlayer(problem)
