"""A second engine for parts that move and balls that meet: naive, slow, and sharing nothing with the kernels.

Where the next hit lies is found by creeping up to it in floats, never further than the gap allows at the greatest speed
in play (and in microseconds while the gap is next to nothing); when it is, by bisection and secants at 50 digits.
For walls (standing or dragged), bumpers (standing or on a rail), paddles, flippers and discs; no contact: it is told
where balls come so softly that the engine's rules for rolling begin.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import mpmath
from mpmath import mpf

from bounce_env.scene import Bumper, Flipper, Paddle, Scene, Wall

NEAR = 1e-7  # [m] from here on the hit is looked for between two instants
CREEP = 1e-6  # [s]
SOFT = 0.06  # [m/s] slower hits may be the engine's small hops

_ANYWHERE = ((-1e9, -1e9), (1e9, 1e9))

Num = Any
Pair = tuple[Num, Num]


class Hit(NamedTuple):
    """One ledger row: of a bounce of `ball` from `element`, or of a stop (ball -1)."""

    time: Num
    ball: int
    element: int
    numbers: tuple[Num, ...]  # x, y, vx1, vy1, vx0, vy0, nx, ny, ux, uy of a bounce
    soft: bool


class Ball(NamedTuple):
    time: Num
    x: Num
    y: Num
    vx: Num
    vy: Num


def dot(a: Pair, b: Pair) -> Num:
    return a[0] * b[0] + a[1] * b[1]


def sin_cos(angle: Num) -> Pair:
    return (mpmath.sin(angle), mpmath.cos(angle)) if isinstance(angle, mpf) else (math.sin(angle), math.cos(angle))


def root(value: Num) -> Num:
    return mpmath.sqrt(value) if isinstance(value, mpf) else math.sqrt(value)


@dataclass
class Part:
    """An element, and how it moves from `since` on: numbers `at` that change at the rates `rates`."""

    index: int
    element: Any
    since: Num = 0
    at: list[Num] = field(default_factory=list)
    rates: list[Num] = field(default_factory=list)
    shadow: tuple[float, list[float], list[float]] = (0.0, [], [])  # the same in floats

    def __post_init__(self) -> None:
        e = self.element
        if isinstance(e, Wall):
            self.at = [mpf(c) for c in (*e.start, *e.end)]
        elif isinstance(e, Paddle):
            self.at = [self.span / 2]
        else:
            self.at = [mpf(0)]
        self.rates = [mpf(0)] * len(self.at)
        if isinstance(e, Bumper) and e.rail_end is not None:
            self.rates = [mpf(e.speed)]
        self.cast()

    def cast(self) -> None:
        self.shadow = (float(self.since), [*map(float, self.at)], [*map(float, self.rates)])

    @property
    def radius(self) -> float:
        return 0.0 if isinstance(self.element, Wall) else float(self.element.radius)

    @property
    def span(self) -> Num:
        e = self.element
        if isinstance(e, Flipper):
            return abs(mpf(e.active_angle) - mpf(e.rest_angle))
        a, b = (e.rail_start, e.rail_end) if isinstance(e, Paddle) else (e.center, e.rail_end)
        return mpmath.hypot(mpf(b[0]) - mpf(a[0]), mpf(b[1]) - mpf(a[1]))

    def now(self, t: Num) -> tuple[list[Num], list[Num]]:
        since, at, rates = (self.since, self.at, self.rates) if isinstance(t, mpf) else self.shadow
        return [a + r * (t - since) for a, r in zip(at, rates, strict=True)], rates

    def core(self, t: Num) -> tuple[Pair, Pair, Pair, Pair]:
        """The two ends of the core and their velocities."""
        at, rates = self.now(t)
        e, number = self.element, type(t)
        if isinstance(e, Wall):
            return (at[0], at[1]), (at[2], at[3]), (rates[0], rates[1]), (rates[2], rates[3])
        still = (number(0), number(0))
        if isinstance(e, Flipper):
            sign = 1 if e.active_angle > e.rest_angle else -1
            s, c = sin_cos(number(e.rest_angle) + sign * at[0])
            x, y, length, turn = number(e.pivot[0]), number(e.pivot[1]), number(e.length), sign * rates[0]
            return (x, y), (x + length * c, y + length * s), still, (-turn * length * s, turn * length * c)
        if isinstance(e, Bumper) and e.rail_end is None:
            middle = (number(e.center[0]), number(e.center[1]))
            return middle, middle, still, still
        a, b = (e.rail_start, e.rail_end) if isinstance(e, Paddle) else (e.center, e.rail_end)
        dx, dy = number(b[0]) - number(a[0]), number(b[1]) - number(a[1])
        length = root(dx * dx + dy * dy)
        ux, uy = dx / length, dy / length
        half = number(e.half_width) if isinstance(e, Paddle) else number(0)
        x, y, v = number(a[0]) + at[0] * ux, number(a[1]) + at[0] * uy, (rates[0] * ux, rates[0] * uy)
        return (x - half * ux, y - half * uy), (x + half * ux, y + half * uy), v, v

    def stop(self) -> tuple[Num, list[Num]]:
        """How long the part moves on as it does, and its rates from then on."""
        e = self.element
        if not any(self.rates):
            return mpmath.inf, []
        if not isinstance(e, Wall):
            room = (self.span - self.at[0]) if self.rates[0] > 0 else self.at[0]
            return room / abs(self.rates[0]), [-self.rates[0] if isinstance(e, Bumper) else mpf(0)]
        (low_x, low_y), (high_x, high_y) = e.reach or _ANYWHERE
        best, after = mpmath.inf, list[Num]()
        for k, (low, high) in enumerate([(low_x, high_x), (low_y, high_y)] * 2):
            if self.rates[k]:
                t = ((mpf(high) if self.rates[k] > 0 else mpf(low)) - self.at[k]) / self.rates[k]
                if t < best:
                    best, after = t, [mpf(0) if j == k else r for j, r in enumerate(self.rates)]
        d, v = ((b[2] - b[0], b[3] - b[1]) for b in (self.at, self.rates))
        a, b, c = dot(v, v), dot(d, v), dot(d, d) - mpf(e.shortest) ** 2
        if b < 0 and b * b >= a * c and (-b - mpmath.sqrt(b * b - a * c)) / a < best:
            best, after = (-b - mpmath.sqrt(b * b - a * c)) / a, [mpf(0)] * 4
        return best, after

    def go(self, t: Num, rates: Sequence[Num]) -> None:
        self.at, _ = self.now(t)
        self.since, self.rates = t, list(rates)
        if isinstance(self.element, Wall) and self.element.draggable:
            self._hold()
        elif not isinstance(self.element, Wall):
            at_start, at_end = abs(self.at[0]) < 1e-30, abs(self.at[0] - self.span) < 1e-30
            if (at_start and self.rates[0] < 0) or (at_end and self.rates[0] > 0):
                self.rates = [mpf(0)]
        self.cast()

    def _hold(self) -> None:
        (low_x, low_y), (high_x, high_y) = self.element.reach or _ANYWHERE
        for k, (low, high) in enumerate([(low_x, high_x), (low_y, high_y)] * 2):
            if (self.at[k] - low < 1e-30 and self.rates[k] < 0) or (high - self.at[k] < 1e-30 and self.rates[k] > 0):
                self.rates[k] = mpf(0)
        d, v = ((b[2] - b[0], b[3] - b[1]) for b in (self.at, self.rates))
        if dot(d, d) - mpf(self.element.shortest) ** 2 < 1e-30 and dot(d, v) < 0:
            self.rates = [mpf(0)] * 4


@dataclass
class MovingOracle:
    """`MovingOracle(scene).run(places, speeds, seconds, commands)`, inside `mpmath.workdps(50)`."""

    scene: Scene

    def run(
        self, places: Sequence[Pair], speeds: Sequence[Pair], seconds: float, commands: Sequence[tuple[float, str, Any]]
    ) -> list[Hit]:
        self.now = mpf(0)
        self.balls = [Ball(mpf(0), *map(mpf, p), *map(mpf, v)) for p, v in zip(places, speeds, strict=True)]
        self.parts = [Part(k, e) for k, e in enumerate(self.scene.elements)]
        self.hits: list[Hit] = []
        waiting = list(commands)
        while self.now < seconds:
            until = min(mpf(waiting[0][0]) if waiting else mpf(seconds), mpf(seconds))
            stops = [(part.since + part.stop()[0], part) for part in self.parts]
            stop, stopping = min(stops, key=lambda s: s[0])
            found = self._first_hit(min(until, stop))
            if found is not None:
                self._bounce(*found)
            elif stop < until:
                self._halt(stop, stopping)
            else:
                self.now = until
                while waiting and waiting[0][0] <= until:
                    self._tell(*waiting.pop(0)[1:])
        return self.hits

    def _halt(self, stop: Num, part: Part) -> None:
        self.now = stop
        rates = part.stop()[1]
        part.go(stop, rates)
        rows = 2 if isinstance(part.element, Wall) else 1
        self.hits += [Hit(stop, -1, part.index, (), False)] * rows

    def _tell(self, name: str, value: Any) -> None:
        part = next(p for p in self.parts if p.element.name == name)
        e = part.element
        if isinstance(e, Flipper):
            part.go(self.now, [mpf(e.up_speed) if value else -mpf(e.down_speed)])
        elif isinstance(e, Wall):
            part.go(self.now, [mpf(c) for end in value for c in end])
        else:
            part.go(self.now, [mpf(value)])

    # ---- where the balls are

    def _ball(self, k: int, t: Num) -> tuple[Pair, Pair]:
        ball, number = self.balls[k], type(t)
        s = t - number(ball.time)
        gx, gy = map(number, self.scene.gravity)
        vx, vy = number(ball.vx), number(ball.vy)
        x, y = number(ball.x) + (vx + gx * s / 2) * s, number(ball.y) + (vy + gy * s / 2) * s
        return (x, y), (vx + gx * s, vy + gy * s)

    def _gap(self, k: int, other: int, t: Num) -> tuple[Num, Pair, Pair]:
        """Gap of ball `k` to part `other`, or for -1 - j to ball j; unit normal to ball `k`, velocity of the other."""
        number = type(t)
        p, _ = self._ball(k, t)
        if other < 0:
            q, u = self._ball(-1 - other, t)
            reach = 2 * number(self.scene.ball.radius)
        else:
            part = self.parts[other]
            a, b, va, vb = part.core(t)
            d = (b[0] - a[0], b[1] - a[1])
            square = dot(d, d)
            share = min(max(dot((p[0] - a[0], p[1] - a[1]), d) / square, number(0)), number(1)) if square else number(0)
            q = (a[0] + share * d[0], a[1] + share * d[1])
            u = (va[0] + share * (vb[0] - va[0]), va[1] + share * (vb[1] - va[1]))
            reach = number(part.radius) + number(self.scene.ball.radius)
        w = (p[0] - q[0], p[1] - q[1])
        distance = root(dot(w, w))
        n = (w[0] / distance, w[1] / distance)
        if other >= 0 and isinstance(self.parts[other].element, Flipper):
            # The surface lies off the core, and turns with it.
            turn = self._turn(self.parts[other], t)
            off = number(self.parts[other].radius)
            u = (u[0] - turn * off * n[1], u[1] + turn * off * n[0])
        return distance - reach, n, u

    def _turn(self, part: Part, t: Num) -> Num:
        sign = 1 if part.element.active_angle > part.element.rest_angle else -1
        return sign * part.now(t)[1][0]

    def _rate(self, k: int, other: int, t: Num) -> Num:
        _, n, u = self._gap(k, other, t)
        _, v = self._ball(k, t)
        return (v[0] - u[0]) * n[0] + (v[1] - u[1]) * n[1]

    # ---- the next hit

    def _first_hit(self, until: Num) -> tuple[Num, int, int] | None:
        best: tuple[Num, int, int] | None = None
        for k in range(len(self.balls)):
            for other in (*range(len(self.parts)), *(-1 - j for j in range(k))):
                t = self._hit(k, other, until if best is None else best[0])
                if t is not None:
                    best = (t, k, other)
        return best

    def _hit(self, k: int, other: int, until: Num) -> Num | None:
        t, end = float(self.now), float(until)
        g = math.hypot(*self.scene.gravity)
        before = None  # the last instant with a gap
        while True:
            gap, _, _ = self._gap(k, other, t)
            if gap < 0 and (before is not None or self._rate(k, other, t) < -SOFT):
                return self._root(k, other, self.now if before is None else mpf(before), mpf(t), until)
            if t >= end:
                return None
            if gap > 0:
                before = t
            speeds = [math.hypot(*self._ball(k, t)[1])]
            if other < 0:
                speeds.append(math.hypot(*self._ball(-1 - other, t)[1]))
            else:
                _, _, va, vb = self.parts[other].core(t)
                speeds.append(max(math.hypot(*va), math.hypot(*vb)) * (1 + self.parts[other].radius))
            window = 0.02
            step = gap / (sum(speeds) + 2 * g * window) if gap > NEAR else 0.0
            t = min(t + min(max(step, CREEP), window), end)

    def _root(self, k: int, other: int, low: Num, high: Num, until: Num) -> Num | None:
        for _ in range(30):
            middle = (low + high) / 2
            low, high = (middle, high) if self._gap(k, other, middle)[0] > 0 else (low, middle)
        t = high
        for _ in range(6):
            t -= self._gap(k, other, t)[0] / self._rate(k, other, t)
        return t if self.now < t <= until else None

    # ---- the bounce

    def _bounce(self, t: Num, k: int, other: int) -> None:
        self.now = t
        _, n, u = self._gap(k, other, t)
        p, v = self._ball(k, t)
        w = (v[0] - u[0], v[1] - u[1])
        closing = -dot(w, n)
        soft = closing < SOFT
        b = mpf(self.scene.ball.b)
        if other < 0:
            j = -1 - other
            q, _ = self._ball(j, t)
            half = (1 + b * b) / 2 * closing
            after = (v[0] + half * n[0], v[1] + half * n[1])
            back = (u[0] - half * n[0], u[1] - half * n[1])
            count = len(self.scene.elements)
            self.hits.append(Hit(t, k, count + j, (*p, *after, *v, *n, *u), soft))
            self.hits.append(Hit(t, j, count + k, (*q, *back, *u, -n[0], -n[1], *v), soft))
            self.balls[k], self.balls[j] = Ball(t, *p, *after), Ball(t, *q, *back)
            return
        e = self.parts[other].element
        f = mpf(self.scene.ball.f) * mpf(e.f)
        along = (w[0] + closing * n[0], w[1] + closing * n[1])
        rebound = b * mpf(e.b) * closing
        after = (u[0] + f * along[0] + rebound * n[0], u[1] + f * along[1] + rebound * n[1])
        self.hits.append(Hit(t, k, other, (*p, *after, *v, *n, *u), soft))
        self.balls[k] = Ball(t, *p, *after)
