"""The problems of the report: a scene, starts, a script of commands, and the times at which places are compared."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bounce_env.report import truths
from bounce_env.report.truths import Command, Question, Start, Truth
from bounce_env.scene import Bumper, Scene, load_scene

NewStart = Callable[[Scene, np.random.Generator], Start]
"""Draws a start in a scene."""


@dataclass(frozen=True)
class Problem:
    """One scene, and what is asked of every method on it.

    name: of the built-in scene. title: in a reader's words. why: what makes it hard, and where the truth comes from.
    new_start: draws a start. truth: solves it. frames: how many frames of 1/60 s at most. chaotic: errors are divided
    by the growth of a small error. ordered: the bounces are finitely many, so that their order can be compared.
    """

    name: str
    title: str
    why: str
    new_start: NewStart
    truth: Callable[[Question, Start], Truth]
    frames: int
    commands: tuple[Command, ...] = ()
    chaotic: bool = False
    ordered: bool = True

    @cached_property
    def scene(self) -> Scene:
        """The scene."""
        return load_scene(self.name)

    def solve(self, start: Start) -> Truth:
        """Return what happens from a start."""
        return self.truth(Question(self.scene, self.frames, self.commands, self.ordered), start)

    def starts(self, count: int, seed: int) -> list[Start]:
        """Return the starts, the same for every method."""
        rng, found = np.random.default_rng([seed, *self.name.encode()]), list[Start]()
        while len(found) < count:
            start = self.new_start(self.scene, rng)
            if _is_free(self.scene, start):
                found.append(start)
        return found


def _is_free(scene: Scene, start: Start) -> bool:
    """Return whether a ball at its start is clear of the bumpers, by its radius and more."""
    bumpers = [e for e in scene.elements if isinstance(e, Bumper)]
    return all(math.dist(start.position, e.center) > e.radius + 2.0 * scene.ball.radius for e in bumpers)


def _in_the_scene(speed: float) -> NewStart:
    """Draw a start in the box around the scene, not near its sides."""

    def draw(scene: Scene, rng: np.random.Generator) -> Start:
        left, bottom, right, top = scene.bounds
        x, y = (left, bottom) + rng.uniform(0.1, 0.9, 2) * (right - left, top - bottom)
        return Start((float(x), float(y)), _velocity(rng, speed))

    return draw


def _velocity(rng: np.random.Generator, speed: float) -> tuple[float, float]:
    x, y = rng.normal(size=2)
    share = speed / float(np.hypot(x, y))
    return float(x * share), float(y * share)


def _drop(scene: Scene, rng: np.random.Generator) -> Start:
    return Start((float(rng.uniform(-1, 1)), float(rng.uniform(0.3, 0.8))), (float(rng.uniform(-1, 1)), 0.0))


def _drop_on_slope(scene: Scene, rng: np.random.Generator) -> Start:
    return Start((0.0, float(rng.uniform(0.3, 0.8))), (0.0, 0.0))


def _into_wedge(scene: Scene, rng: np.random.Generator) -> Start:
    x = float(rng.uniform(-0.8, 0.8))
    return Start((x, abs(x) + float(rng.uniform(0.3, 1.0))), (float(rng.uniform(-0.5, 0.5)), 0.0))


def _in_circle(scene: Scene, rng: np.random.Generator) -> Start:
    angle, radius = rng.uniform(0, 2 * np.pi), rng.uniform(0.0, 0.8)
    return Start((float(radius * np.cos(angle)), float(radius * np.sin(angle))), _velocity(rng, 3.0))


def _on_bowl(scene: Scene, rng: np.random.Generator) -> Start:
    angle = float(rng.uniform(0.2, 1.4)) * float(rng.choice([-1.0, 1.0]))
    return Start((float(0.95 * np.sin(angle)), float(-0.95 * np.cos(angle))), (0.0, 0.0))


def _at_bottom_of_loop(scene: Scene, rng: np.random.Generator) -> Start:
    # Between 2 g r, where it comes half up, and 5 g r, where it comes around.
    speed = float(np.sqrt(rng.uniform(2.4, 4.6) * 9.81 * 0.95))
    return Start((0.0, -0.95), (speed * float(rng.choice([-1.0, 1.0])), 0.0))


def _above_flipper(scene: Scene, rng: np.random.Generator) -> Start:
    return Start((float(rng.uniform(0.03, 0.07)), float(rng.uniform(0.02, 0.04))), (0.0, 0.0))


def _before_wall(scene: Scene, rng: np.random.Generator) -> Start:
    return Start((float(rng.uniform(0.3, 1.7)), 0.0), (float(rng.choice([-1, 1]) * rng.uniform(0.7, 1.5)), 0.0))


def _on_table(scene: Scene, rng: np.random.Generator) -> Start:
    """Draw a start among the bumpers."""
    return Start((float(rng.uniform(0.12, 0.38)), float(rng.uniform(0.62, 0.8))), _velocity(rng, 1.5))


_FLIGHTS = "Truth: roots of polynomials at 50 digits."

PROBLEMS = (
    Problem(
        "elastic_box", "Elastic box", f"Nothing is lost, nothing is chaotic: an error can only add up. {_FLIGHTS}",
        _in_the_scene(3.0), truths.by_flights, 600,
    ),
    Problem(
        "box", "Sinai box", "Five circles scatter: each hit on one multiplies a small error by about three, and errors "
        f"are divided by that growth. {_FLIGHTS}",
        _in_the_scene(10.0), truths.by_flights, 240, chaotic=True,
    ),
    Problem(
        "gravity_box", "Gravity box", f"Elastic bounces under gravity: energy must neither grow nor shrink. {_FLIGHTS}",
        _in_the_scene(2.0), truths.by_flights, 600,
    ),
    Problem(
        "zeno_drop", "Zeno drop", "Infinitely many bounces in finite time, then a slide. Truth: the geometric series.",
        _drop, truths.of_zeno, 240, ordered=False,
    ),
    Problem(
        "zeno_incline", "Zeno on an incline", "The same on a slope of 37 degrees, down which the ball slides from then "
        "on. Truth: the geometric series.",
        _drop_on_slope, truths.of_zeno, 180, ordered=False,
    ),
    Problem(
        "wedge", "45 degree wedge", "Two slopes, elastic: whoever hits one late hits the other at a wrong place. "
        f"{_FLIGHTS}",
        _into_wedge, truths.by_flights, 480, chaotic=True,
    ),
    Problem(
        "circle", "Circle", f"Elastic bounces inside a circle: grazing ones follow each other fast. {_FLIGHTS}",
        _in_circle, truths.by_flights, 480,
    ),
    Problem(
        "bowl", "Pendulum in a bowl", "A slide on a curve from rest, to and fro. Truth: elliptic functions, 40 digits.",
        _on_bowl, truths.of_bowl, 600, ordered=False,
    ),
    Problem(
        "loop", "Loop and release", "Up the inside of a circle until it no longer presses, then free flight. Truth: "
        "elliptic functions, and a parabola.",
        _at_bottom_of_loop, truths.of_loop, 120, ordered=False,
    ),
    Problem(
        "flipper_strike", "Flipper strike", "A turning capsule strikes a falling ball. Truth: bisection at 50 digits.",
        _above_flipper, truths.by_creeping, 60, commands=((3, "flipper", True), (30, "flipper", False)),
    ),
    Problem(
        "closing_wall", "Closing wall", "The room between two walls shrinks, and the ball gets faster with each "
        "bounce. Truth: bisection at 50 digits.",
        _before_wall, truths.by_creeping, 180, commands=((0, "closing", ((-0.5, 0.0), (-0.5, 0.0))),),
    ),
    Problem(
        "bumper_field", "Bumpers with b = 1.5", "Every hit on a bumper gives speed, up to a cap, and scatters. "
        f"{_FLIGHTS}",
        _in_the_scene(2.0), truths.by_flights, 90, chaotic=True,
    ),
    Problem(
        "pinball", "Pinball table", "The game's table, flippers at rest, up to the first hit too slow to rebound: "
        f"30 walls, an arch, bumpers and slingshots that kick. {_FLIGHTS}",
        _on_table, truths.by_flights, 90, chaotic=True,
    ),
)  # fmt: skip


def problem(name: str) -> Problem:
    """Return the problem of this name; KeyError for an unknown one."""
    return {p.name: p for p in PROBLEMS}[name]
