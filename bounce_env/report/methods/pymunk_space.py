"""A scene in pymunk (Chipmunk): fixed steps, overlap and push-out. Needs pymunk, an extra."""

import math
from collections import Counter
from collections.abc import Callable
from typing import Any

import pymunk

from bounce_env.report.methods.base import QUICK_STEPS, STEPS, Ball, Method, Player, Setting
from bounce_env.report.methods.solids import CHORDS, chords, comes_from_left, rates_in_step, timelines_of
from bounce_env.report.problems import Problem
from bounce_env.report.truths import FRAMES, Start
from bounce_env.scene import Arc, Bumper, Field, Flipper, Paddle, Scene, Sensor, Wall, moves

BALL, SURFACE = 1, 2


class PymunkScene:
    """A space with the scene's elements and its ball.

    space: pymunk.Space. ball: its body. parts: bodies of the parts, in the order of `scene.parts`, which stand until
    their velocities are set. element_of: index in `scene.elements` by shape. Without slop and bias: no overlap is
    tolerated, and none is left after a step. Sensors and `f` are left out: Chipmunk's friction is Coulomb's.
    Raises ValueError where the scene has a field, which pymunk does not.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.space = pymunk.Space()
        self.space.gravity = scene.gravity
        self.space.collision_slop = 0.0
        self.space.collision_bias = 0.0
        self.parts: list[pymunk.Body] = []
        self.element_of: dict[pymunk.Shape, int] = {}
        for index, element in enumerate(scene.elements):
            if not isinstance(element, Sensor):
                self._add(index, element)
        self.ball = pymunk.Body(1.0, math.inf)  # no spin
        disc = pymunk.Circle(self.ball, scene.ball.radius)
        disc.elasticity, disc.collision_type = scene.ball.b, BALL
        self.space.add(self.ball, disc)
        self._now = 0.0
        self._heed_kicks_gates_and_cap()

    def _add(self, index: int, element: Any) -> None:
        if isinstance(element, Field):
            raise ValueError(f"elements[{index}]: pymunk has no fields")
        body = self.space.static_body
        if moves(element):
            body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
            self.space.add(body)
            self.parts.append(body)
        for shape in _shapes(body, element):
            shape.elasticity, shape.collision_type = element.b, SURFACE
            self.element_of[shape] = index
            self.space.add(shape)

    def watch(self, strike: Callable[[int], None]) -> None:
        """Let `strike` be called with the index of each element that the ball begins to touch."""
        touched: Counter[int] = Counter()  # an arc is many shapes

        def begin(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            element = self.element_of[arbiter.shapes[1]]
            if not touched[element]:
                strike(element)
            touched[element] += 1

        def separate(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            for shape in arbiter.shapes:  # when a space is thrown away, in any order
                if shape in self.element_of:
                    touched[self.element_of[shape]] -= 1

        self.space.on_collision(BALL, SURFACE, begin=begin, separate=separate)

    def step(self, dt: float) -> None:
        """Take one step [s]."""
        self._now += dt
        self.space.step(dt)

    def _heed_kicks_gates_and_cap(self) -> None:
        elements: tuple[Any, ...] = self.scene.elements
        gates = {shape: elements[i] for shape, i in self.element_of.items() if getattr(elements[i], "one_way", False)}
        kicks = {shape: elements[i] for shape, i in self.element_of.items() if elements[i].kick > 0.0}
        cap = self.scene.max_speed
        last_kick: dict[int, float] = {}
        approach: dict[pymunk.Shape, float] = {}

        def pre_solve(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            shape = arbiter.shapes[1]
            if shape in gates:
                arbiter.process_collision = comes_from_left(gates[shape], *self.ball.position, *self.ball.velocity)
            approach[shape] = self.ball.velocity.dot(arbiter.normal)

        def post_solve(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            shape = arbiter.shapes[1]
            element = kicks.get(shape)
            if element is not None and arbiter.is_first_contact and approach[shape] > element.kick_threshold:
                index = self.element_of[shape]
                if self._now - last_kick.get(index, -math.inf) >= element.cooldown:
                    last_kick[index] = self._now
                    self.ball.velocity -= element.kick * arbiter.normal
            if cap is not None and self.ball.velocity.length > cap:
                self.ball.velocity = self.ball.velocity.scale_to_length(cap)

        if gates or kicks or cap is not None:
            self.space.on_collision(BALL, SURFACE, pre_solve=pre_solve, post_solve=post_solve)


def _shapes(body: pymunk.Body, e: Any) -> list[pymunk.Shape]:
    match e:
        case Wall():
            return [pymunk.Segment(body, e.start, e.end, 0.0)]
        case Bumper():
            return [pymunk.Circle(body, e.radius, e.center)]
        case Arc():
            points = chords(e, CHORDS)
            around = [points[-2], *points, points[1]] if e.closed else [points[0], *points, points[-1]]
            segments = []
            for before, p, q, after in zip(around, points, points[1:], around[3:], strict=False):
                segments.append(pymunk.Segment(body, p, q, 0.0))
                segments[-1].set_neighbors(before, after)  # no bump where two of them join
            return segments
        case Paddle():
            (x0, y0), (x1, y1) = e.rail_start, e.rail_end
            body.position, body.angle = (0.5 * (x0 + x1), 0.5 * (y0 + y1)), math.atan2(y1 - y0, x1 - x0)
            return [pymunk.Segment(body, (-e.half_width, 0.0), (e.half_width, 0.0), e.radius)]
        case Flipper():
            body.position, body.angle = e.pivot, e.rest_angle
            return [pymunk.Segment(body, (0.0, 0.0), (e.length, 0.0), e.radius)]
    raise TypeError(f"pymunk is not given a {type(e).__name__}")


class PymunkPlayer(Player):
    """pymunk on one problem."""

    def __init__(self, problem: Problem, per_second: int) -> None:
        self._problem, self._scene = problem, problem.scene
        self._each, self._dt = per_second // FRAMES, 1.0 / per_second
        self._timelines = timelines_of(self._scene, problem.commands) if problem.commands else None

    def begin(self, start: Start) -> None:
        """Make a new space: Chipmunk keeps impulses from step to step."""
        self._peer = PymunkScene(self._scene)
        self._peer.ball.position, self._peer.ball.velocity = start.position, start.velocity
        self._step = 0

    def watch(self) -> None:
        """Note what begins to be touched."""
        self.struck = []
        self._peer.watch(self.struck.append)

    def go(self, frames: int) -> None:
        """Step in a Python loop, as its users do."""
        step, dt, steer = self._peer.step, self._dt, self._timelines is not None
        for _ in range(frames * self._each):
            if steer:
                self._steer()
            step(dt)

    def _steer(self) -> None:
        """Give each part the velocity with which it is at the step's end where it has to be."""
        assert self._timelines is not None
        rates = rates_in_step(self._scene, self._timelines, self._step * self._dt, self._dt)
        self._step += 1
        for body, (turns, rate) in zip(self._peer.parts, rates, strict=True):
            if turns:
                body.angular_velocity = rate
            else:
                body.velocity = (rate, 0.0)

    def ball(self) -> Ball:
        """Return the ball."""
        return (*self._peer.ball.position, *self._peer.ball.velocity)


class Pymunk(Method):
    """pymunk."""

    name, label = "pymunk", f"pymunk {pymunk.version}"
    settings, quick = STEPS, QUICK_STEPS
    note = f"collision_slop 0, collision_bias 0, no friction; arcs of {CHORDS} chords a circle"

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready."""
        return PymunkPlayer(problem, setting.value)
