"""What is right: places at frames, the order of bounces and the growth of a small error, from the reference solvers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import mpmath
import numpy as np
import numpy.typing as npt
from mpmath import mpf

from bounce_env.report.reference.flights import BOUNCE, Oracle
from bounce_env.report.reference.moving import MovingOracle
from bounce_env.report.reference.pendulum import pendulum_flight
from bounce_env.scene import Arc, Scene, Wall

DIGITS = 50
MORE_DIGITS = 120
MANY_FRAMES = 600
"""From so many frames on a chaotic problem needs more digits: each bounce costs up to one."""

COMPARED = 8
"""How many times places are compared, evenly spaced."""

FRAMES = 60
"""Frames a second. All commands, and all times at which places are compared, are at a frame: steppers come to it."""

_DISPLACED = mpf(2) ** -100

Num = Any
Pair = tuple[Num, Num]
Floats = npt.NDArray[np.float64]


class Start(NamedTuple):
    """Of the ball: place [m] and velocity [m/s]."""

    position: tuple[float, float]
    velocity: tuple[float, float]


Command = tuple[int, str, Any]
"""At which frame, the part, and the value as for `World.command`."""


@dataclass(frozen=True)
class Question:
    """What is to be solved: a scene for so many frames of 1/60 s, with commands.

    ordered: whether bounces are finitely many, so that their order can be told.
    """

    scene: Scene
    frames: int
    commands: tuple[Command, ...]
    ordered: bool


@dataclass(frozen=True)
class Truth:
    """What happens from one start. frames: (n,) when places are compared. places: (n, 2) [m].

    growth: (n,) by how much a small error of the start has grown, at least 1. order: elements struck up to the last
    frame, None where that is not compared. top_speed: the greatest after any bounce [m/s].
    """

    frames: npt.NDArray[np.int64]
    places: Floats
    growth: Floats
    order: tuple[int, ...] | None
    top_speed: float


class _Leg(NamedTuple):
    """Free flight from an instant on, after a hit on `element`."""

    time: Num
    x: Num
    y: Num
    vx: Num
    vy: Num
    element: int


def compared_frames(last: int) -> npt.NDArray[np.int64]:
    """Return the frames at which places are compared, up to and including `last`; fewer where there are not so many."""
    frames = np.unique(np.linspace(0, last, COMPARED + 1).astype(np.int64))
    return frames[frames > 0]


def by_flights(question: Question, start: Start) -> Truth:
    """Solve for what stands: polynomials at 50 digits, up to the first soft hit."""
    with mpmath.workdps(DIGITS if question.frames <= MANY_FRAMES else MORE_DIGITS):
        here, end = _flight_legs(question, start, mpf(0))
        there, _ = _flight_legs(question, start, _DISPLACED)
        return _truth(question, here, there, compared_frames(int(end * FRAMES)))


def _flight_legs(question: Question, start: Start, shift: Num) -> tuple[list[_Leg], Num]:
    x, y = mpf(start.position[0]) + shift, mpf(start.position[1]) + shift / 3
    oracle = Oracle(question.scene, mpf)
    run = oracle.run((x, y), start.velocity, mpf(question.frames) / FRAMES, max_events=100_000)
    legs = [_Leg(e.time, e.x, e.y, e.vx, e.vy, e.element) for e in run.events if e.kind == BOUNCE]
    end = run.time if run.soft is None else run.soft
    return [_first_leg(x, y, start), *legs], end


def _first_leg(x: Num, y: Num, start: Start) -> _Leg:
    vx, vy = map(mpf, start.velocity)
    return _Leg(mpf(0), x, y, vx, vy, -1)


def by_creeping(question: Question, start: Start) -> Truth:
    """Solve for what moves: bisection at 50 digits."""
    with mpmath.workdps(DIGITS):
        here, there = (_creeping_legs(question, start, shift) for shift in (mpf(0), _DISPLACED))
        return _truth(question, here, there, compared_frames(question.frames))


def _creeping_legs(question: Question, start: Start, shift: Num) -> list[_Leg]:
    x, y = mpf(start.position[0]) + shift, mpf(start.position[1]) + shift / 3
    commands = [(mpf(frame) / FRAMES, name, value) for frame, name, value in question.commands]
    hits = MovingOracle(question.scene).run([(x, y)], [start.velocity], mpf(question.frames) / FRAMES, commands)
    legs = []
    for hit in hits:
        if hit.ball == 0:
            hx, hy, vx, vy = hit.numbers[:4]
            legs.append(_Leg(hit.time, hx, hy, vx, vy, hit.element))
    return [_first_leg(x, y, start), *legs]


def _truth(question: Question, here: list[_Leg], there: list[_Leg], frames: npt.NDArray[np.int64]) -> Truth:
    places, growth = [], []
    for frame in frames.tolist():
        x, y = _place(question, here, mpf(frame) / FRAMES)
        other_x, other_y = _place(question, there, mpf(frame) / FRAMES)
        places.append((float(x), float(y)))
        growth.append(max(1.0, float(mpmath.hypot(other_x - x, other_y - y) / _DISPLACED)))
    last = mpf(int(frames[-1])) / FRAMES if len(frames) else mpf(0)
    order = tuple(leg.element for leg in here[1:] if leg.time <= last)
    speed = max(float(mpmath.hypot(leg.vx, leg.vy)) for leg in here)
    return Truth(frames, np.array(places).reshape(-1, 2), np.array(growth), order if question.ordered else None, speed)


def _place(question: Question, legs: Sequence[_Leg], t: Num) -> tuple[Num, Num]:
    leg = next(leg for leg in reversed(legs) if leg.time <= t)
    s, (gx, gy) = t - leg.time, map(mpf, question.scene.gravity)
    return leg.x + (leg.vx + gx * s / 2) * s, leg.y + (leg.vy + gy * s / 2) * s


def of_zeno(question: Question, start: Start) -> Truth:
    """Solve a drop on one wall in closed form: hop after hop up to the accumulation, then a slide without friction."""
    with mpmath.workdps(DIGITS):
        scene = question.scene
        wall = scene.elements[0]
        assert isinstance(wall, Wall)
        dx, dy = (mpf(b) - mpf(a) for a, b in zip(wall.start, wall.end, strict=True))
        length = mpmath.hypot(dx, dy)
        u = dx / length, dy / length
        n = -u[1], u[0]
        if (start.position[0] - wall.start[0]) * n[0] + (start.position[1] - wall.start[1]) * n[1] < 0:
            n = -n[0], -n[1]
        frames = compared_frames(question.frames)
        places = [_zeno_place(question, start, u, n, mpf(f) / FRAMES) for f in frames.tolist()]
        return Truth(frames, np.array(places), np.ones(len(frames)), None, _top_speed_of_zeno(question, start, u, n))


def _zeno_place(question: Question, start: Start, u: Pair, n: Pair, t: Num) -> tuple[float, float]:
    scene, wall = question.scene, question.scene.elements[0]
    assert isinstance(wall, Wall)
    gravity = tuple(map(mpf, scene.gravity))
    off = (mpf(start.position[0]) - mpf(wall.start[0]), mpf(start.position[1]) - mpf(wall.start[1]))
    along, height = (off[0] * d[0] + off[1] * d[1] for d in (u, n))
    speed, rise = (mpf(start.velocity[0]) * d[0] + mpf(start.velocity[1]) * d[1] for d in (u, n))
    pull, press = (gravity[0] * d[0] + gravity[1] * d[1] for d in (u, n))
    height -= mpf(scene.ball.radius)
    e, left = mpf(scene.ball.b) * mpf(wall.b), t
    s = along + speed * t + pull * t * t / 2
    fall = (rise + mpmath.sqrt(rise * rise - 2 * press * height)) / -press
    if left < fall:
        height += rise * left + press * left * left / 2
    else:
        left, rise, height = left - fall, -e * (rise + press * fall), mpf(0)
        whole = -2 * rise / press / (1 - e)
        while left < whole and rise > mpf(10) ** -40:
            hop = -2 * rise / press
            if left < hop:
                height = rise * left + press * left * left / 2
                break
            left, rise, whole = left - hop, e * rise, whole - hop
    height += mpf(scene.ball.radius)
    x, y = (mpf(wall.start[k]) + s * u[k] + height * n[k] for k in (0, 1))
    return float(x), float(y)


def _top_speed_of_zeno(question: Question, start: Start, u: Pair, n: Pair) -> float:
    """Return the speed at the first hit, or at the end of the slide [m/s]."""
    wall = question.scene.elements[0]
    assert isinstance(wall, Wall)
    height = sum((start.position[k] - wall.start[k]) * n[k] for k in (0, 1)) - question.scene.ball.radius
    along, rise = (sum(start.velocity[k] * d[k] for k in (0, 1)) for d in (u, n))
    pull, press = (sum(question.scene.gravity[k] * d[k] for k in (0, 1)) for d in (u, n))
    hit = mpmath.sqrt(rise * rise - 2 * press * height)
    at_hit = along + pull * (rise + hit) / -press
    return float(max(mpmath.hypot(at_hit, hit), abs(along + pull * question.frames / FRAMES)))


def of_bowl(question: Question, start: Start) -> Truth:
    """Solve a slide inside of a circle about the origin that never ends."""
    return _of_slide(question, start, None)


def of_loop(question: Question, start: Start) -> Truth:
    """Solve a slide up to where it lets go, and the flight up to just before it strikes the circle again."""
    return _of_slide(question, start, 0.95)


def _of_slide(question: Question, start: Start, share: float | None) -> Truth:
    (arc,) = question.scene.elements
    assert isinstance(arc, Arc)
    radius, pull = arc.radius - question.scene.ball.radius, -question.scene.gravity[1]
    (x, y), speed = start.position, start.velocity[0]
    place, end = pendulum_flight(radius, x, y, speed, pull, lets_go=share is not None)
    last = question.frames if share is None else min(question.frames, int(share * end * FRAMES))
    frames = compared_frames(last)
    places = np.array([place(mpf(f) / FRAMES) for f in frames.tolist()])
    at_bottom = float(np.sqrt(speed * speed + 2.0 * pull * (y + radius)))
    return Truth(frames, places, np.ones(len(frames)), None, at_bottom)
