"""Starts that touch or overlap, at rest and at the smallest speed there is; starts that are refused."""

import math

from bounce_env.report.stability.case import ULP, Case, at, between, going, resting, when
from bounce_env.report.stability.cases.drops import NEAR, TOUCH, G, R, floor
from bounce_env.report.stability.cases.extremes import FREE
from bounce_env.scene import Ball, Scene

TINY = 5e-324  # the smallest number above 0


def _touching(name: str, velocity: tuple[float, float], *, r: float, seconds: float, **more) -> Case:
    """A start exactly on the floor, b = f = 0.5 (more: f=...), under gravity 2 m/s^2."""
    f = more.pop("f", 0.5)
    return Case(
        name=f"start on the floor {name}, r={r}",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=r, b=0.5, f=f), elements=(floor(),)),
        position=(0.0, r),
        velocity=velocity,
        script=(seconds,),
        **more,
    )


def _denormal(b: float, r: float) -> Case:
    """The smallest speed there is: its hops last no time that a float can hold. A point starts on the upper side."""
    return Case(
        name=f"touching with a denormal speed, b={b}, r={r}",
        why="numerics.md: no NaN; the ball stays where it is. Elastic, the hops have no length in time: budget or rest",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=r, b=b), elements=(floor(),)),
        position=(0.0, r),
        velocity=(0.0, -TINY if r else TINY),
        script=(1.0,),
        max_events=1000,
        status=("OK",) if b < 1 else ("OK", "BUDGET"),
        expect=(*at(0.0, r, TOUCH), between("vy", lambda run: run.velocity[1], -1e-300, 1e-300)),
        exact_scaling=False,
    )


STARTS = [
    *(
        case
        for r in (0.0, R)
        for case in (
            _touching(
                "at rest", (0.0, 0.0), r=r, seconds=100.0, why="static", rows="floor begin", expect=resting(0, r, 0.0)
            ),
            _touching(
                "upwards",
                (0.0, 1.0),
                r=r,
                seconds=1.25,
                why="hop of 2 v / g, then b = 0.5: at t = 1.25 the peak of the second hop, v^2 / (2 g) / 4",
                rows="floor bounce",
                expect=(when("floor bounce", 1.0, 2 * ULP), *at(0.0, r + 0.0625, NEAR), *going(0.0, 0.0, 4 * ULP)),
            ),
            _touching(
                "along it, f = 1",
                (1.0, 0.0),
                r=r,
                seconds=2.0,
                f=1.0,
                why="contact from the start: uniform",
                rows="floor begin",
                expect=(*at(2.0, r, NEAR), *going(1.0, 0.0, 0.0)),
            ),
            _touching(
                "along it, f = 0.5",
                (1.0, 0.0),
                r=r,
                seconds=2.0,
                why="contract: a pressed contact with f < 1 stops the ball (rest_speed = 0)",
                rows="floor begin",
                expect=resting(0.0, r, NEAR),
            ),
        )
    ),
    _touching(
        "downwards",
        (0.0, -1.0),
        r=R,
        seconds=0.25,
        why="it is hit at once; at 0.25 s the peak of a hop with 0.5 m/s",
        rows="floor bounce",
        expect=(when("floor bounce", 0.0, 0.0), *at(0.0, R + 0.0625, NEAR), *going(0.0, 0.0, 4 * ULP)),
    ),
    *(_denormal(b, r) for b in (0.0, 0.5, 1.0) for r in (0.0, R)),
    Case(
        name="overlapping by 1e-15",
        why="contract: moved to the surface, then as if it had touched",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0.5), elements=(floor(),)),
        position=(0.0, R - 1e-15),
        script=(1.0,),
        rows="floor begin",
        expect=resting(0.0, R, 0.0),
    ),
    Case(
        name="overlapping by half a radius",
        why="contract: ValueError that names the element",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R), elements=(floor(),)),
        position=(0.0, R / 2),
        script=(1.0,),
        refused="overlaps elements\\[0\\] \\(wall 'floor'\\)",
    ),
    Case(
        name="start at NaN",
        why="contract: a bad command raises before anything moves",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R), elements=(floor(),)),
        position=(math.nan, 1.0),
        script=(1.0,),
        refused="must be finite",
    ),
    Case(
        name="infinite time",
        why="contract: a bad command raises before anything moves",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R), elements=(floor(),)),
        position=(0.0, 1.0),
        script=(math.inf,),
        refused="must be finite",
    ),
    Case(
        name="touching at rest without gravity",
        why="nothing presses: no contact, no row, no motion",
        scene=Scene(gravity=FREE, ball=Ball(radius=R, b=0.5), elements=(floor(),)),
        position=(0.0, R),
        script=(1e9,),
        rows="",
        expect=resting(0.0, R, 0.0),
    ),
]
