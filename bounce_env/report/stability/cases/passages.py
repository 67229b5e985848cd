"""What a ball passes through: one-way walls and sensors."""

import math
from typing import Any

from bounce_env.report.stability.case import ULP, Case, at, going, resting, when
from bounce_env.report.stability.cases.drops import NEAR, G, R, floor, rest_time
from bounce_env.scene import Ball, Scene, Sensor, Wall

FREE = (0.0, 0.0)


def gate(**surface: Any) -> Wall:
    """Bounces from above (its left), lets through from below."""
    return Wall((-3, 0), (3, 0), one_way=True, name="gate", **surface)


def _gate(r: float, from_left: bool) -> Case:
    vy = -1.0 if from_left else 1.0
    return Case(
        name=f"one-way wall from its {'left' if from_left else 'right'}, r={r}",
        why="contract: bounces a ball that comes from the left of start -> end, lets the other pass",
        scene=Scene(gravity=FREE, ball=Ball(radius=r), elements=(gate(),)),
        position=(0.0, -vy * (1 + r)),
        velocity=(0.5, vy),
        script=(2.0,),
        rows="gate bounce" if from_left else "",
        expect=(*at(1.0, 1 + r if from_left else 1 - r, NEAR), *going(0.5, 1.0, 0.0)),
    )


def _half_way(r: float, peak: float) -> Case:
    """Thrown up from below so that its centre turns `peak` above the gate; g = 2, so up and down 1 m takes 2 s."""
    back = peak <= r
    start = peak - 1
    fall = math.sqrt(peak - r) if not back else 0.0
    rows = "" if back else "gate bounce"
    t = 2.0 if back else 1 + 2 * fall
    return Case(
        name=f"up to {peak} m above a one-way wall and back, r={r}",
        why="contract: only a gap that falls through zero from above is a hit; half-way it has never been above zero",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=r), elements=(gate(),)),
        position=(0.0, start),
        velocity=(0.0, 2.0),
        script=(t,),
        rows=rows,
        expect=(
            *at(0.0, start if back else peak, NEAR),
            *going(0.0, -2.0 if back else 0.0, NEAR),
            *(() if back else (when("gate bounce", 1 + fall, 8 * ULP),)),
        ),
    )


def _ring(offset: float, r: float) -> Case:
    """A straight path at 0.5 + offset from the centre of a circular sensor of 0.5 m."""
    s = 0.5 + offset
    inside = offset < 0
    half = math.sqrt(-offset * (1.0 + offset)) if inside else 0.0  # nothing cancels
    within = 4 * ULP * (1 + 1 / half) if inside else 0.0
    return Case(
        name=f"circular sensor passed at {offset:g} m from its line, r={r}",
        why="contract: reports that the centre comes in; touching is none",
        scene=Scene(gravity=FREE, ball=Ball(radius=r), elements=(Sensor(center=(0, 0), radius=0.5, name="ring"),)),
        position=(-2.0, s),
        velocity=(1.0, 0.0),
        script=(4.0,),
        rows="ring cross" if inside else "",
        expect=(*at(2.0, s, 0.0), *((when("ring cross", 2 - half, within),) if inside else ())),
    )


PASSAGES = [
    *(_gate(r, from_left) for r in (0.0, R) for from_left in (True, False)),
    _half_way(R, R / 2),
    _half_way(R, R - 2.0**-40),
    _half_way(R, R + 2.0**-8),
    _half_way(R, 0.75),
    _half_way(0.0, 0.25),
    _half_way(0.0, -0.25),
    Case(
        name="through a one-way wall, then at rest on it",
        why="from above it is a wall: numerics.md, check 1, from a peak of 1 m",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0.5), elements=(gate(),)),
        position=(0.0, R - 1.0),
        velocity=(0.0, math.sqrt(4 * G)),
        script=(10.0,),
        rows="(gate bounce, )+gate begin",
        expect=(
            when("gate begin", math.sqrt(4 / G) + rest_time(1.0, 0.5), 1e-12),
            *resting(0.0, R, NEAR),
        ),
    ),
    *(
        Case(
            name=f"past the end of a one-way wall from above, {name}",
            why="contract: its ends never bounce; the wall ends where its line does",
            scene=Scene(gravity=FREE, ball=Ball(radius=R), elements=(gate(),)),
            position=(3 + x, 1.0),
            velocity=(0.0, -1.0),
            script=(2.0,),
            rows="gate bounce" if x < 0 else "",
            expect=at(3 + x, 1 + 2 * R if x < 0 else -1.0, NEAR),
        )
        for name, x in (("0.0625 m outside", 0.0625), ("0.0625 m inside", -0.0625))
    ),
    Case(
        name="onto the end of a one-way wall along its line",
        why="contract: its ends never bounce, and along its line the ball closes on neither side",
        scene=Scene(gravity=FREE, ball=Ball(radius=R), elements=(gate(),)),
        position=(-4.0, 0.0),
        velocity=(1.0, 0.0),
        script=(9.0,),
        rows="",
        expect=(*at(5.0, 0.0, NEAR), *going(1.0, 0.0, 0.0)),
    ),
    Case(
        name="sliding through a one-way wall that stands on the floor",
        why="it comes from the right: passed on the way there, a wall on the way back",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R),
            elements=(
                floor(b=0.5),
                Wall((0, 1), (0, 0), one_way=True, name="gate"),  # its left is where x > 0
                Wall((1, 0), (1, 1), name="post"),
            ),
        ),
        position=(-1.0, R),
        velocity=(1.0, 0.0),
        script=(4.0,),
        rows="floor begin, post bounce, gate bounce, post bounce",
        expect=(
            when("post bounce", 2 - R, 8 * ULP),
            when("gate bounce", 3 - 3 * R, 8 * ULP),
            when("post bounce", 4 - 5 * R, 8 * ULP, 1),
            *at(1 - R - 5 * R, R, NEAR),
        ),
    ),
    Case(
        name="off the end of a one-way wall",
        why="slides to the end of the line, then a parabola: the end has no cap to roll over",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(gate(),)),
        position=(2.0, R),
        velocity=(0.25, 0.0),
        script=(5.0,),
        rows="gate begin, gate end",
        expect=(when("gate end", 4.0, 8 * ULP), *at(3.25, R - 1.0, NEAR), *going(0.25, -2.0, 8 * ULP)),
    ),
    *(_ring(offset, r) for r in (0.0, R) for offset in (0.0, 1e-9, -1e-9, -0.5)),
    Case(
        name="start inside of a circular sensor",
        why="contract: entry only; the ball leaves, is turned back by the wall, and enters once",
        scene=Scene(
            gravity=FREE, elements=(Sensor(center=(0, 0), radius=0.5, name="ring"), Wall((2, -3), (2, 3), name="wall"))
        ),
        position=(0.25, 0.0),
        velocity=(1.0, 0.0),
        script=(5.0,),
        rows="wall bounce, ring cross",
        expect=(when("ring cross", 3.25, 8 * ULP),),
    ),
    Case(
        name="wall that touches a circular sensor from outside",
        why="the centre touches the circle at the bounce and turns back: no entry (point ball)",
        scene=Scene(
            gravity=FREE,
            elements=(Sensor(center=(0, 0), radius=0.5, name="ring"), Wall((0.5, -3), (0.5, 3), name="wall")),
        ),
        position=(2.0, 0.0),
        velocity=(-1.0, 0.0),
        script=(3.0,),
        rows="wall bounce",
        expect=at(2.0, 0.0, NEAR),
    ),
    Case(
        name="sensors crossed at the instant of a bounce",
        why="contract: bounces first, then the sensors that the ball is on the other side of after it",
        scene=Scene(
            gravity=FREE,
            ball=Ball(radius=R),
            elements=(
                Sensor((-3, R), (3, R), name="touched"),
                Sensor((0, -3), (0, 3), name="passed"),
                floor(),
            ),
        ),
        position=(-1.0, 1 + R),
        velocity=(1.0, -1.0),
        script=(2.0,),
        rows="floor bounce, passed cross",
        expect=(when("passed cross", 1.0, 2 * ULP), *at(1.0, 1 + R, NEAR)),
    ),
    Case(
        name="drain at the end of a drop",
        why="out of play at the crossing, where it then stays: y = h - g t^2 / 2 at 0.5 m",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R),
            elements=(floor(), Sensor((-3, 0.5), (3, 0.5), drain=True, name="drain")),
        ),
        position=(0.0, 1.5),
        script=(10.0,),
        status=("OUT",),
        rows="drain cross",
        expect=(when("drain cross", 1.0, 2 * ULP), *at(0.0, 0.5, NEAR)),
    ),
]
