"""Fields: a slide or a flight into one, and what happens at its border."""

import math

from bounce_env.report.stability.case import ULP, Case, at, going, resting, when
from bounce_env.report.stability.cases.drops import NEAR, R, floor
from bounce_env.scene import Ball, Field, Scene, Wall


def box(x0: float, y0: float, x1: float, y1: float, acceleration: tuple[float, float], name: str = "field") -> Field:
    return Field(((x0, y0), (x1, y0), (x1, y1), (x0, y1)), acceleration, name=name)


def _lift(up: float) -> Case:
    """Slides into a region where the field pulls up by `up`, under gravity 2 m/s^2, with nothing above."""
    net = up - 2.0
    t = 0.5
    return Case(
        name=f"sliding into a field that lifts with {up} m/s^2",
        why="contact ends where the field no longer lets gravity press; then a parabola under what is left",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(floor(), box(0, -1, 2, 2, (0.0, up)))),
        position=(-1.0, R),
        velocity=(1.0, 0.0),
        script=(1.0 + t,),
        rows="floor begin, floor end",
        expect=(
            when("floor end", 1.0, 4 * ULP),
            *at(t, R + net * t * t / 2, NEAR),
            *going(1.0, net * t, 4 * ULP),
        ),
    )


FIELDS = [
    *(_lift(up) for up in (4.0, 2.5)),
    Case(
        name="sliding through a field that cancels gravity",
        why="inside nothing presses: uniform along the floor; behind it gravity presses again, without a bounce",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(floor(), box(0, -1, 1, 1, (0.0, 2.0)))),
        position=(-1.0, R),
        velocity=(1.0, 0.0),
        script=(3.0,),
        rows="floor begin, floor end, floor begin",
        expect=(
            when("floor end", 1.0, 4 * ULP),
            when("floor begin", 2.0, 8 * ULP, 1),
            *at(2.0, R, NEAR),
            *going(1.0, 0.0, 4 * ULP),
        ),
    ),
    *(
        Case(
            name=f"sliding into a field that brakes with 1 m/s^2, {name}",
            why="v^2 = v0^2 - 2 s in the field: out behind it with 2^(1/2) from 2, or back out of it",
            scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(floor(), box(0, -1, 1, 1, (-1.0, 0.0)))),
            position=(-1.0, R),
            velocity=(v, 0.0),
            script=(4.0,) if v == 1.0 else (1.5,),
            rows="floor begin",
            expect=expect,
        )
        for name, v, expect in (
            ("turns back", 1.0, (*at(-1.0, R, NEAR), *going(-1.0, 0.0, 8 * ULP))),
            (
                "passes",
                2.0,
                (
                    *at(1 + (1.0 - (2 - math.sqrt(2))) * math.sqrt(2), R, NEAR),
                    *going(math.sqrt(2), 0.0, 8 * ULP),
                ),
            ),
        )
    ),
    Case(
        name="slanted gravity made upright by a field",
        why="the field takes away the tangential part of gravity: uniform sliding",
        scene=Scene(
            gravity=(-3.0, -4.0),
            ball=Ball(radius=R, b=0.5),
            elements=(floor(), box(-3, -1, 3, 2, (3.0, 0.0))),
        ),
        position=(-1.0, R),
        velocity=(0.5, 0.0),
        script=(4.0,),
        rows="floor begin",
        expect=(*at(1.0, R, NEAR), *going(0.5, 0.0, 8 * ULP)),
    ),
    Case(
        name="oscillation about a field's border",
        why="down with g above it, up with g in it: four equal quarters of sqrt(2 h / g) = 1 s, for ever",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R), elements=(floor(-3.0), box(-3, -2, 3, 0, (0.0, 4.0)))),
        position=(0.0, 1.0),
        script=(401.0,),
        rows="",
        expect=(*at(0.0, 0.0, 400 * NEAR), *going(0.0, -2.0, 400 * NEAR)),
    ),
    Case(
        name="at rest on a field's border, pulled to it from both sides",
        why="no solution but to stay (Filippov): no NaN, no endless loop; the budget may say so",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R), elements=(floor(-3.0), box(-3, -2, 3, 0, (0.0, 4.0)))),
        position=(0.0, 0.0),
        script=(1.0,),
        max_events=1000,
        status=("OK", "BUDGET"),
        expect=at(0.0, 0.0, NEAR),
    ),
    Case(
        name="two fields that overlap",
        why="their accelerations add: 2 + 3 m/s^2 down, then 5 up in both, closed form piece by piece",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R),
            elements=(
                floor(-3.0),
                box(-3, -2.5, 3, 0, (0.0, 4.0), "low"),
                box(-3, -2.5, 3, 0, (1.0, 0.0), "sideways"),
            ),
        ),
        position=(0.0, 1.0),
        script=(2.0,),
        rows="",
        expect=(*at(0.5, -1.0, NEAR), *going(1.0, 0.0, 8 * ULP)),
    ),
    *(
        Case(
            name=f"pressed on an upright wall by a field, f={f}",
            why="the fall along the wall has no contact until a field presses: then it slides on or (f < 1) stands",
            scene=Scene(
                gravity=(0, -2),
                ball=Ball(radius=R, b=0.5, f=f),
                elements=(Wall((1, -3), (1, 3), name="wall"), box(0, -3, 2, 1, (1.0, 0.0))),
            ),
            position=(1 - R, 2.0),
            script=(1.75,),
            rows="wall begin",
            expect=(when("wall begin", 1.0, 4 * ULP), *end),
        )
        for f, end in (
            (1.0, (*at(1 - R, 2 - 1.75**2, NEAR), *going(0.0, -3.5, 8 * ULP))),
            (0.5, resting(1 - R, 1.0, NEAR)),
        )
    ),
    Case(
        name="in a field that is stronger than gravity, at rest on a ceiling",
        why="the sum of gravity and field presses it up: numerics.md, check 1, upside down",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(floor(2.0), box(-3, -1, 3, 3, (0.0, 10.0)))),
        position=(0.0, 1 - R),
        script=(3.0,),
        rows="(floor bounce, )+floor begin",
        expect=(when("floor begin", 1.5, 1e-12), *resting(0.0, 2 - R, NEAR)),
    ),
]
