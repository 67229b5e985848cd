"""A second engine, naive and slow, that shares no code and no method with the kernels.

Plain Python over a number type (`float` or `mpmath.mpf`). Every gap between ball and surface is a polynomial
in time of degree four or less; its real roots are isolated between those of its derivative and bracketed.
After a bounce the root at zero is divided out, so the same surface can be searched at once. No tolerance
takes part, except that hits closer in time than `same_instant` count as simultaneous.

For scenes of walls (one-way, too), bumpers, arcs, at most one paddle, flippers at rest, and sensors; one ball; no
resting contact: `Run.soft` tells when that would begin.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import mpmath

from bounce_env.report.reference.polynomials import Num, Poly, add, derivative, evaluate, multiply, roots
from bounce_env.scene import Arc, Bumper, Flipper, Paddle, Scene, Sensor, Wall

BOUNCE, SENSOR, PART_STOPS = 0, 3, 4

Pair = tuple[Num, Num]


class Event(NamedTuple):
    time: Num
    element: int
    kind: int
    x: Num
    y: Num
    vx: Num  # after the event
    vy: Num
    before: Pair = (0, 0)  # of a bounce: velocity before, normal, velocity of the surface
    normal: Pair = (0, 0)
    surface: Pair = (0, 0)


class Run(NamedTuple):
    events: list[Event]
    time: Num
    position: Pair
    velocity: Pair
    out: bool
    soft: Num | None  # when first something was struck more slowly than the scene's rest_speed


class Surface(NamedTuple):
    """A line (`normal` given) or a circle that the ball's centre must not cross, moving at `velocity`."""

    key: tuple[int, str]
    origin: Pair  # a point of the line, or the centre; now
    velocity: Pair
    radius: Num  # of the circle; distance of the offset line along `normal`
    normal: Pair | None
    along: Pair | None  # unit direction of the line
    length: Num
    inside: bool = False  # of a circle: the ball is inside of it
    span: tuple[Num, Num] | None = None  # of an arc: the angle at which it starts, and how far it goes on


def dot(a: Pair, b: Pair) -> Num:
    return a[0] * b[0] + a[1] * b[1]


@dataclass
class Oracle:
    """`Oracle(scene, mpmath.mpf).run(position, velocity, duration)`; run it inside `mpmath.workdps(50)`."""

    scene: Scene
    number: Callable[[float], Num] = float
    same_instant: float = 1e-13
    touching: set[tuple[int, str]] = field(default_factory=set, init=False)

    def __post_init__(self) -> None:
        scene = self.scene
        for element in scene.elements:
            if not isinstance(element, Wall | Bumper | Arc | Paddle | Flipper | Sensor):
                raise ValueError(f"the oracle knows no {type(element).__name__}")
        paddles = [k for k, e in enumerate(scene.elements) if isinstance(e, Paddle)]
        if len(paddles) > 1:
            raise ValueError("the oracle knows one paddle at most")
        self.paddle = paddles[0] if paddles else None
        self.gravity = self.pair(scene.gravity)
        self.elements: tuple[Any, ...] = scene.elements
        self.kicked: dict[int, Num] = {}
        self.soft: Num | None = None

    def pair(self, p: Sequence[float]) -> Pair:
        return self.number(p[0]), self.number(p[1])

    def run(
        self,
        position: Sequence[Num],
        velocity: Sequence[Num],
        duration: Num,
        commands: Iterable[tuple[float, float]] = (),
        *,
        max_events: int = 1000,
        touching: Iterable[int] = (),
    ) -> Run:
        """Events up to `duration` [s], the first `max_events` bounces and crossings, or the first soft hit.

        `commands`: (time, speed along the rail) of the paddle. `touching`: elements that the ball starts on,
        so that the rounded start is taken as exactly touching.
        """
        self.now = self.number(0)
        self.p, self.v = self.pair(position), self.pair(velocity)
        self.events: list[Event] = []
        self.out = False
        self.soft = None
        self.kicked = {}
        self.last_crossing: dict[int, Num] = {}
        self.start_paddle()
        on = [s for s in self.surfaces() if s.key[0] in set(touching) and abs(self.gap(s)[0]) < 1e-9]
        self.touching = set().union(*map(self.keys_of_contact, on))
        end = self.number(duration)
        waiting = [(self.number(t), self.number(s)) for t, s in commands]
        while not self.out and len(self.events) < max_events and self.soft is None:
            while waiting and waiting[0][0] <= self.now:
                self.paddle_speed = waiting.pop(0)[1]
            stop = self.time_of_stop()
            if stop is not None and stop <= self.now:
                self.paddle_speed = self.number(0)
                stop = None
            if self.now >= end:
                break
            until = min(t for t in (end, stop, waiting[0][0] if waiting else None) if t is not None)
            self.fly(until - self.now)
            if stop is not None and self.now == stop and self.paddle is not None:
                self.paddle_at = self.rail_length if self.paddle_speed > 0 else self.number(0)
                self.paddle_speed = self.number(0)
                self.record(self.paddle, PART_STOPS)
        return Run(self.events, self.now, self.p, self.v, self.out, self.soft)

    # ---- paddle

    def start_paddle(self) -> None:
        self.paddle_speed = self.number(0)
        self.paddle_at = self.number(0)
        self.rail: Pair = (self.number(0), self.number(0))
        self.rail_length: Num = self.number(0)
        if self.paddle is not None:
            element = self.elements[self.paddle]
            start, finish = self.pair(element.rail_start), self.pair(element.rail_end)
            self.rail_start = start
            self.rail, self.rail_length = self.direction(start, finish)
            self.paddle_at = self.rail_length / 2

    def time_of_stop(self) -> Num | None:
        if self.paddle_speed > 0:
            return self.now + (self.rail_length - self.paddle_at) / self.paddle_speed
        if self.paddle_speed < 0:
            return self.now - self.paddle_at / self.paddle_speed
        return None

    # ---- geometry

    def direction(self, a: Pair, b: Pair) -> tuple[Pair, Num]:
        d = (b[0] - a[0], b[1] - a[1])
        length = dot(d, d) ** self.number(0.5)
        return (d[0] / length, d[1] / length), length

    def capsule(self, index: int, a: Pair, e: Pair, length: Num, radius: Num, velocity: Pair) -> list[Surface]:
        found = []
        for name, n in (("left", (-e[1], e[0])), ("right", (e[1], -e[0]))):
            found.append(Surface((index, name), a, velocity, radius, n, e, length))
        if radius > 0:
            b = (a[0] + length * e[0], a[1] + length * e[1])
            for name, end in (("start", a), ("end", b)):
                found.append(Surface((index, name), end, velocity, radius, None, None, length))
        return found

    def arc(self, index: int, arc: Arc, ball: Num) -> list[Surface]:
        zero, center, radius = (self.number(0), self.number(0)), self.pair(arc.center), self.number(arc.radius)
        start, end = self.number(arc.start_angle), self.number(arc.end_angle)
        span = None if arc.closed else (start, end - start)
        found = [Surface((index, "outside"), center, zero, radius + ball, None, None, radius, span=span)]
        if radius > ball:
            found.append(Surface((index, "inside"), center, zero, radius - ball, None, None, radius, True, span))
        if ball > 0 and not arc.closed:
            for name, angle in (("start", start), ("end", end)):
                tip = (center[0] + radius * mpmath.cos(angle), center[1] + radius * mpmath.sin(angle))
                found.append(Surface((index, name), tip, zero, ball, None, None, radius))
        return found

    def surfaces(self) -> list[Surface]:
        found: list[Surface] = []
        zero = (self.number(0), self.number(0))
        ball = self.number(self.scene.ball.radius)
        for index, element in enumerate(self.scene.elements):
            if isinstance(element, Wall):
                start = self.pair(element.start)
                sides = self.capsule(index, start, *self.direction(start, self.pair(element.end)), ball, zero)
                found += sides[:1] if element.one_way else sides
            elif isinstance(element, Arc):
                found += self.arc(index, element, ball)
            elif isinstance(element, Bumper):
                radius = self.number(element.radius) + ball
                found.append(Surface((index, "circle"), self.pair(element.center), zero, radius, None, None, radius))
            elif isinstance(element, Flipper):
                e = (mpmath.cos(element.rest_angle), mpmath.sin(element.rest_angle))
                radius = self.number(element.radius) + ball
                found += self.capsule(index, self.pair(element.pivot), e, self.number(element.length), radius, zero)
            elif isinstance(element, Paddle):
                half = self.number(element.half_width)
                e, s, u = self.rail, self.paddle_at, self.paddle_speed
                x, y = (self.rail_start[k] + (s - half) * e[k] for k in (0, 1))
                radius = self.number(element.radius) + ball
                found += self.capsule(index, (x, y), e, 2 * half, radius, (u * e[0], u * e[1]))
        return found

    def relative_path(self, surface: Surface) -> tuple[Poly, Poly]:
        x, y = ([self.p[k] - surface.origin[k], self.v[k] - surface.velocity[k], self.gravity[k] / 2] for k in (0, 1))
        return x, y

    def gap(self, surface: Surface) -> Poly:
        """A polynomial in time that is positive outside of the surface and zero on it."""
        x, y = self.relative_path(surface)
        if surface.normal is None:
            gap = add(multiply(x, x), multiply(y, y))
            gap[0] -= surface.radius * surface.radius
            gap = [-c for c in gap] if surface.inside else gap
        else:
            gap = add([surface.normal[0] * c for c in x], [surface.normal[1] * c for c in y])
            gap[0] -= surface.radius
        return gap

    def keys_of_contact(self, surface: Surface) -> set[tuple[int, str]]:
        if surface.radius == 0:  # a point touches both faces of a wall at once
            return {(surface.key[0], "left"), (surface.key[0], "right")}
        if self.scene.ball.radius == 0 and surface.key[1] in ("outside", "inside"):
            return {(surface.key[0], "outside"), (surface.key[0], "inside")}
        return {surface.key}

    def beside(self, surface: Surface, t: Num) -> bool:
        x, y = self.relative_path(surface)
        if surface.span is not None:
            turn = mpmath.atan2(evaluate(y, t), evaluate(x, t)) - surface.span[0]
            return bool(turn - 2 * mpmath.pi * mpmath.floor(turn / (2 * mpmath.pi)) <= surface.span[1])
        if surface.along is None:
            return True
        along = surface.along[0] * evaluate(x, t) + surface.along[1] * evaluate(y, t)
        return bool(0 <= along <= surface.length)

    def first_hit(self, surface: Surface, end: Num) -> Num | None:
        gap = self.gap(surface)
        if surface.key in self.touching:
            gap = gap[1:]  # the root at zero is the last bounce
            full = [0 * end, *gap]
        else:
            full = gap
        rate = derivative(full)
        for t in roots(gap, end):
            if evaluate(rate, t) < 0 and self.beside(surface, t):
                return t
        return None

    # ---- one flight, up to the first bounce or for `end` seconds

    def fly(self, end: Num) -> None:
        surfaces = self.surfaces()
        times = [(t, s) for s in surfaces if (t := self.first_hit(s, end)) is not None]
        until = min((t for t, _ in times), default=end)
        struck = [s for t, s in times if t - until <= self.same_instant]
        for t, index in self.crossings(until):
            here = self.now + t
            self.last_crossing[index] = here
            x, v = self.at(t)
            self.events.append(Event(here, index, SENSOR, *x, *v))
            if self.elements[index].drain:
                until, struck, self.out = t, [], True
                break
        self.p, self.v = self.at(until)
        self.now += until
        self.paddle_at += self.paddle_speed * until
        if until > 0:
            self.touching = set().union(*map(self.keys_of_contact, struck))
        self.resolve([self.moved(s, until) for s in struck])

    def at(self, t: Num) -> tuple[Pair, Pair]:
        g = self.gravity
        x = tuple(self.p[k] + self.v[k] * t + g[k] * t * t / 2 for k in (0, 1))
        v = tuple(self.v[k] + g[k] * t for k in (0, 1))
        return x, v

    def moved(self, surface: Surface, t: Num) -> Surface:
        x, y = (surface.origin[k] + surface.velocity[k] * t for k in (0, 1))
        return surface._replace(origin=(x, y))

    def crossings(self, until: Num) -> list[tuple[Num, int]]:
        found = []
        for index, sensor in enumerate(self.scene.elements):
            if not isinstance(sensor, Sensor):
                continue
            border = self.border(index, sensor)
            last = self.last_crossing.get(index)
            rate = derivative(self.gap(border))
            for t in roots(self.gap(border), until):
                if last is not None and self.now + t - last <= self.same_instant:
                    continue
                if self.beside(border, t) and (border.along is not None or evaluate(rate, t) < 0):
                    found.append((t, index))
        return sorted(found)

    def border(self, index: int, sensor: Sensor) -> Surface:
        zero, nothing = (self.number(0), self.number(0)), self.number(0)
        if sensor.circle is not None:
            center, radius = sensor.circle
            return Surface((index, "circle"), self.pair(center), zero, self.number(radius), None, None, nothing)
        first, last = sensor.segment or ((0.0, 0.0), (0.0, 0.0))
        start = self.pair(first)
        e, length = self.direction(start, self.pair(last))
        return Surface((index, "line"), start, zero, nothing, (-e[1], e[0]), e, length)

    # ---- the bounce

    def resolve(self, struck: list[Surface]) -> None:
        """Several hits at one instant: fastest-closing first, ties by element order, until none closes."""
        for _ in range(1000):
            closing = []
            for s in struck:
                n = self.normal(s)
                w = (self.v[0] - s.velocity[0], self.v[1] - s.velocity[1])
                closing.append((dot(w, n), s.key[0], s, n))
            closing = [c for c in closing if c[0] < -self.same_instant]
            if not closing:
                return
            _, index, surface, n = min(closing, key=lambda c: c[:2])
            before, self.v = self.v, self.after(index, surface.velocity, n)
            self.record(index, BOUNCE, before, n, surface.velocity)
        raise RuntimeError("the bounces at one instant do not come to an end")

    def normal(self, surface: Surface) -> Pair:
        if surface.normal is not None:
            return surface.normal
        n = self.direction(surface.origin, self.p)[0]
        return (-n[0], -n[1]) if surface.inside else n

    def after(self, index: int, u: Pair, n: Pair) -> Pair:
        """Law, then kick, then cap."""
        element = self.elements[index]
        b = self.number(self.scene.ball.b) * self.number(element.b)
        f = self.number(self.scene.ball.f) * self.number(element.f)
        w = (self.v[0] - u[0], self.v[1] - u[1])
        approach = -dot(w, n)
        rebound = b * approach
        if self.soft is None and approach < self.scene.rest_speed:
            self.soft = self.now
        cold = index not in self.kicked or self.now - self.kicked[index] >= element.cooldown
        if element.kick > 0.0 and approach > self.number(element.kick_threshold) and cold:
            rebound += self.number(element.kick)
            self.kicked[index] = self.now
        v = tuple(u[k] + f * (w[k] + approach * n[k]) + rebound * n[k] for k in (0, 1))
        speed = dot(v, v) ** self.number(0.5)
        if self.scene.max_speed is None or speed <= self.scene.max_speed:
            return v
        cap = self.number(self.scene.max_speed)
        shrunk = (v[0] * cap / speed, v[1] * cap / speed)
        if dot(shrunk, n) >= dot(u, n):
            return shrunk
        vn = dot(v, n)
        t = (v[0] - vn * n[0], v[1] - vn * n[1])
        vn = min(vn, cap)
        share = ((cap * cap - vn * vn) / dot(t, t)) ** self.number(0.5)
        return tuple(vn * n[k] + share * t[k] for k in (0, 1))

    def record(self, index: int, kind: int, *bounce: Pair) -> None:
        self.events.append(Event(self.now, index, kind, *self.p, *self.v, *bounce))
