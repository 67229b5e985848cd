"""A scene in Box2D 2.3 (pybox2d): fixed steps, continuous collision, 5 mm of slop. Needs Box2D, an extra."""

import math
import warnings
from collections import Counter
from typing import Any

from bounce_env.report.methods.base import QUICK_STEPS, STEPS, Ball, Method, Player, Setting
from bounce_env.report.methods.solids import CHORDS, chords, comes_from_left, rates_in_step, timelines_of
from bounce_env.report.problems import Problem
from bounce_env.report.truths import FRAMES, Start
from bounce_env.scene import Arc, Bumper, Field, Flipper, Paddle, Scene, Sensor, Wall, moves

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # Python warns of SWIG's types while they are made; as an error that would crash it
    import Box2D

LONGEST_WAY = 1.6
"""Scaled way of the fastest ball in a step [m]: Box2D moves nothing further than 2 m."""

FASTEST = 1600.0
"""Scaled speed [m/s] beyond which a larger scale gains nothing: floats of 32 bits end."""


def best_scale(top_speed: float, per_second: int) -> float:
    """Return by how much lengths are multiplied: the more, the less the slop of 5 mm is."""
    return min(LONGEST_WAY * per_second, FASTEST) / top_speed


class Box2DScene:
    """A world with the scene's elements and its ball, all lengths times `scale`.

    world: b2World. ball: its body. parts: bodies of the parts, in the order of `scene.parts`. Slop (5 mm) and the speed
    below which nothing rebounds (1 m/s) are compiled into Box2D: a large scale makes them small. Skins are taken off.
    Sensors and `f` are left out: its friction is Coulomb's. Raises ValueError where the scene has a field.
    """

    def __init__(self, scene: Scene, scale: float) -> None:
        self.scene, self.scale = scene, scale
        gx, gy = scene.gravity
        self.world = Box2D.b2World(gravity=(gx * scale, gy * scale), doSleep=False, contactListener=_Listener(self))
        self.parts: list[Any] = []
        self.begun: list[tuple[int, float, float, float]] = []
        self.strikes: list[int] | None = None
        self.touched: Counter[int] = Counter()  # an arc is many shapes
        self._last_kick: dict[int, float] = {}
        self._kicks: list[tuple[float, float, float]] = []
        self.touching = 0
        self.ended = False
        for index, element in enumerate(scene.elements):
            if not isinstance(element, Sensor):
                self._add(index, element)
        self.ball = self.world.CreateDynamicBody(bullet=True, fixedRotation=True, linearDamping=0.0)
        disc = Box2D.b2CircleShape(radius=scene.ball.radius * scale)
        self.ball.CreateFixture(shape=disc, density=1.0, friction=0.0, restitution=0.0)

    def _add(self, index: int, element: Any) -> None:
        if isinstance(element, Field):
            raise ValueError(f"elements[{index}]: Box2D has no fields")
        moving = moves(element)
        body = self.world.CreateKinematicBody() if moving else self.world.CreateStaticBody()
        if moving:
            self.parts.append(body)
        # Box2D takes the larger of the two restitutions: the ball has none, so that it is the product.
        b = element.b * self.scene.ball.b
        for shape in self._shapes(body, element):
            body.CreateFixture(shape=shape, friction=0.0, restitution=b, userData=index)

    def _shapes(self, body: Any, e: Any) -> list[Any]:
        s = self.scale
        match e:
            case Wall():
                return [_edge(e.start, e.end, s)]
            case Bumper():
                return [Box2D.b2CircleShape(pos=(e.center[0] * s, e.center[1] * s), radius=e.radius * s)]
            case Arc():
                points = [(x * s, y * s) for x, y in chords(e, CHORDS)]
                # A chain knows its neighbours: no bump where two pieces join.
                vertices = {"vertices_loop": points[:-1]} if e.closed else {"vertices_chain": points}
                chain = Box2D.b2ChainShape(**vertices)
                chain.radius = 0.0
                return [chain]
            case Paddle():
                (x0, y0), (x1, y1) = e.rail_start, e.rail_end
                body.position, body.angle = (0.5 * s * (x0 + x1), 0.5 * s * (y0 + y1)), math.atan2(y1 - y0, x1 - x0)
                return _capsule(-e.half_width * s, e.half_width * s, e.radius * s)
            case Flipper():
                body.position, body.angle = (e.pivot[0] * s, e.pivot[1] * s), e.rest_angle
                return _capsule(0.0, e.length * s, e.radius * s)
        raise TypeError(f"Box2D is not given a {type(e).__name__}")

    def place(self, position: tuple[float, float], velocity: tuple[float, float]) -> None:
        """Put the ball there [m], [m/s], unscaled."""
        self.ball.position = (position[0] * self.scale, position[1] * self.scale)
        self.ball.linearVelocity = (velocity[0] * self.scale, velocity[1] * self.scale)

    def now(self) -> Ball:
        """Return the ball, unscaled."""
        (x, y), (vx, vy), s = self.ball.position, self.ball.linearVelocity, self.scale
        return x / s, y / s, vx / s, vy / s

    def _give_kicks(self) -> None:
        """Give a kick as soon as the ball has rebounded, which may be a step after it began to touch."""
        waiting = []
        for nx, ny, kick in self._kicks:
            vx, vy = self.ball.linearVelocity
            if vx * nx + vy * ny > 0.0:
                self.ball.linearVelocity = (float(vx + nx * kick), float(vy + ny * kick))
            else:
                waiting.append((nx, ny, kick))
        self._kicks = waiting

    def step(self, dt: float, now: float) -> None:
        """Take one step, then give the kicks and cut the speed as the scene asks."""
        self.begun.clear()
        self.world.Step(dt, 8, 3)
        for index, nx, ny, approach in self.begun:
            if self.strikes is not None:
                if not self.touched[index]:
                    self.strikes.append(index)
                self.touched[index] += 1
            e: Any = self.scene.elements[index]
            cold = now - self._last_kick.get(index, -math.inf) >= e.cooldown
            if e.kick > 0.0 and approach > e.kick_threshold and cold:
                self._last_kick[index] = now
                self._kicks.append((nx, ny, e.kick * self.scale))
        self._give_kicks()
        rebounds = bool(self.touching or self.begun or self.ended)
        self.ended = False
        cap = self.scene.max_speed
        if cap is not None and rebounds:  # a flight is not capped
            vx, vy = self.ball.linearVelocity
            speed = math.hypot(vx, vy)
            if speed > cap * self.scale:
                share = float(cap * self.scale / speed)
                self.ball.linearVelocity = (vx * share, vy * share)


class _Listener(Box2D.b2ContactListener):  # type: ignore[misc]
    """Notes what begins to be touched, and lets balls through gates from the right."""

    def __init__(self, scene: Box2DScene) -> None:
        super().__init__()
        self._scene = scene

    def BeginContact(self, contact: Any) -> None:
        """Note the element, the normal to the ball and how fast it came."""
        fixture, nx, ny = self._surface(contact)
        vx, vy = self._scene.ball.linearVelocity
        approach = -(vx * nx + vy * ny) / self._scene.scale
        self._scene.touching += 1
        self._scene.begun.append((fixture.userData, nx, ny, approach))

    def EndContact(self, contact: Any) -> None:
        """Forget the touch."""
        self._scene.touching -= 1
        self._scene.ended = True
        self._scene.touched[self._surface(contact)[0].userData] -= 1

    def PreSolve(self, contact: Any, old: Any) -> None:
        """Switch off the contact with a gate that the ball does not come to from the left."""
        fixture, _, _ = self._surface(contact)
        wall: Any = self._scene.scene.elements[fixture.userData]
        if getattr(wall, "one_way", False):
            contact.enabled = comes_from_left(wall, *self._scene.now())

    def _surface(self, contact: Any) -> tuple[Any, float, float]:
        manifold = contact.worldManifold  # kept: its normal is a view of it
        nx, ny = manifold.normal.x, manifold.normal.y
        if contact.fixtureA.body is self._scene.ball or contact.fixtureA.userData is None:
            return contact.fixtureB, -nx, -ny
        return contact.fixtureA, nx, ny


def _edge(p: tuple[float, float], q: tuple[float, float], scale: float) -> Any:
    edge = Box2D.b2EdgeShape(vertices=[(p[0] * scale, p[1] * scale), (q[0] * scale, q[1] * scale)])
    edge.radius = 0.0
    return edge


def _capsule(start: float, end: float, radius: float) -> list[Any]:
    box = Box2D.b2PolygonShape(vertices=[(start, -radius), (end, -radius), (end, radius), (start, radius)])
    box.radius = 0.0
    return [box, *(Box2D.b2CircleShape(pos=(x, 0.0), radius=radius) for x in (start, end))]


class Box2DPlayer(Player):
    """Box2D on one problem."""

    def __init__(self, problem: Problem, per_second: int, top_speed: float) -> None:
        self._scene, self._scale = problem.scene, best_scale(top_speed, per_second)
        self._each, self._dt = per_second // FRAMES, 1.0 / per_second
        self._timelines = timelines_of(self._scene, problem.commands) if problem.commands else None

    def begin(self, start: Start) -> None:
        """Make a new world: Box2D keeps impulses from step to step."""
        self._peer = Box2DScene(self._scene, self._scale)
        self._peer.place(start.position, start.velocity)
        self._step = 0

    def watch(self) -> None:
        """Note what begins to be touched."""
        self._peer.strikes = self.struck = []

    def go(self, frames: int) -> None:
        """Step in a Python loop, as its users do."""
        for _ in range(frames * self._each):
            now = self._step * self._dt
            if self._timelines is not None:
                self._steer(rates_in_step(self._scene, self._timelines, now, self._dt))
            self._peer.step(self._dt, now)
            self._step += 1

    def _steer(self, rates: list[tuple[bool, float]]) -> None:
        for body, (turns, rate) in zip(self._peer.parts, rates, strict=True):
            if turns:
                body.angularVelocity = rate
            else:
                body.linearVelocity = (rate * self._scale, 0.0)

    def ball(self) -> Ball:
        """Return the ball."""
        return self._peer.now()


class Box2DMethod(Method):
    """Box2D."""

    name, label = "box2d", f"Box2D {Box2D.__version__}"
    settings, quick = STEPS, QUICK_STEPS
    note = (
        "8 velocity and 3 position iterations, bullet, no skins; scaled so that the fastest ball goes "
        f"{LONGEST_WAY} m in a step, at most {FASTEST:g} m/s; "
        f"arcs of {CHORDS} chords a circle"
    )

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Get ready."""
        return Box2DPlayer(problem, setting.value, top_speed)
