"""Commands to standing scenes: push, enable, replace."""

import math

from bounce_env.report.stability.case import ULP, Case, at, going, resting, speed, when
from bounce_env.report.stability.cases.drops import C30, NEAR, S30, G, R, floor, on_slope, slope
from bounce_env.scene import Ball, Bumper, Scene, Sensor, Wall

FREE = (0.0, 0.0)
FLOOR = Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(floor(),))
LOWER = Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(floor(-1.0),))


def _on_floor(name: str, why: str, script, rows: str, *expect, scene: Scene = FLOOR, velocity=(0.0, 0.0)) -> Case:
    """From a start on the floor."""
    return Case(
        name=name,
        why=why,
        scene=scene,
        position=(0.0, R),
        velocity=velocity,
        script=script,
        rows=rows,
        expect=expect,
    )


def off(name: str) -> tuple[str, str, bool]:
    return ("enable", name, False)


def on(name: str) -> tuple[str, str, bool]:
    return ("enable", name, True)


COMMANDS = [
    _on_floor(
        "push upwards",
        "leaves with 1 m/s: hop of 1 s, then 0.5 m/s and its peak at 1.25 s",
        (1.0, ("push", (0.0, 1.0)), 1.25),
        "floor begin, floor end, floor bounce",
        when("floor end", 1.0, 0.0),
        when("floor bounce", 2.0, 4 * ULP),
        *at(0.0, R + 0.0625, NEAR),
    ),
    _on_floor(
        "push into the floor",
        "it is hit at once: 0.5 m/s are left, peak after 0.25 s at 0.0625 m",
        (1.0, ("push", (0.0, -1.0)), 0.25),
        "floor begin, (floor end, )?floor bounce(, floor end)?",
        when("floor bounce", 1.0, 0.0),
        *at(0.0, R + 0.0625, NEAR),
        *going(0.0, 0.0, 8 * ULP),
    ),
    _on_floor(
        "push into the floor, b = 0",
        "law: nothing is left of it",
        (1.0, ("push", (0.5, -1.0)), 2.0),
        "floor begin, floor bounce, floor end, floor begin",
        *at(1.0, R, NEAR),
        *going(0.5, 0.0, 0.0),
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0), elements=(floor(),)),
    ),
    _on_floor(
        "push along the floor",
        "slides on, uniformly",
        (1.0, ("push", (0.5, 0.0)), 2.0),
        "floor begin, floor end, floor begin",
        *at(1.0, R, NEAR),
        *going(0.5, 0.0, 0.0),
    ),
    _on_floor(
        "push along the floor, f = 0.5",
        "a pressed contact with f < 1 stops the ball at once",
        (1.0, ("push", (0.5, 0.0)), 2.0),
        "floor begin(, floor end, floor begin)?",
        *resting(0.0, R, NEAR),
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5, f=0.5), elements=(floor(),)),
    ),
    _on_floor(
        "push against the sliding",
        "velocities add: at rest from then on",
        (1.0, ("push", (-0.5, 0.0)), 2.0),
        "floor begin, floor end, floor begin",
        *at(0.5, R, NEAR),
        *going(0.0, 0.0, 0.0),
        velocity=(0.5, 0.0),
    ),
    _on_floor(
        "two pushes at one instant of sliding",
        "velocities add: the ball hits the floor at 1 m/s, and b = 0.5 gives back half",
        (1.0, ("push", (0.0, -1.0)), ("push", (0.25, 0.0)), 0.125),
        "floor begin, floor bounce, floor end",
        *at(0.5 + 0.75 * 0.125, R + 0.5 * 0.125 - 0.125**2, NEAR),
        velocity=(0.5, 0.0),
    ),
    _on_floor(
        "push in the air",
        "velocities add: (0, 0.5) becomes (1, 1.5) at R + 0.5, and a parabola from there",
        (0.5, ("push", (1.0, 1.0)), 0.5),
        "",
        *at(0.5, R + 1.0, NEAR),
        velocity=(0.0, 1.5),
    ),
    _on_floor(
        "push by nothing",
        "changes nothing",
        (1.0, ("push", (0.0, 0.0)), 1.0),
        "floor begin",
        *resting(0.0, R, 0.0),
    ),
    Case(
        name="push by NaN",
        why="contract: a bad command raises before anything moves",
        scene=FLOOR,
        position=(0.0, R),
        script=(("push", (math.nan, 0.0)),),
        refused="finite",
    ),
    Case(
        name="push by infinity",
        why="contract: a bad command raises before anything moves",
        scene=FLOOR,
        position=(0.0, R),
        script=(("push", (0.0, math.inf)),),
        refused="finite",
    ),
    Case(
        name="enable of an unknown name",
        why="contract: a bad command raises before anything moves",
        scene=FLOOR,
        position=(0.0, R),
        script=(off("flipper"),),
        refused="flipper",
    ),
    _on_floor(
        "disable the floor under a resting ball",
        "contact ends at that instant, then free fall",
        (1.0, off("floor"), 2.0),
        "floor begin, floor end",
        when("floor end", 1.0, 0.0),
        *at(0.0, R - 4.0, NEAR),
        *going(0.0, -4.0, 4 * ULP),
    ),
    _on_floor(
        "disable the floor under a sliding ball",
        "contact ends at that instant, then a parabola",
        (1.0, off("floor"), 1.0),
        "floor begin, floor end",
        *at(1.0, R - 1.0, NEAR),
        *going(0.5, -2.0, 4 * ULP),
        velocity=(0.5, 0.0),
    ),
    _on_floor(
        "disable and enable again at once",
        "no time has passed: at rest",
        (1.0, off("floor"), on("floor"), 1.0),
        "floor begin(, floor end, floor begin)?",
        *resting(0.0, R, NEAR),
    ),
    _on_floor(
        "enable the floor under a falling ball",
        "falls 1 m below its line, so it must not be hit from above any more",
        (1.0, off("floor"), 1.0, on("floor"), 1.0),
        "floor begin, floor end",
        *at(0.0, R - 4.0, NEAR),
        *going(0.0, -4.0, 4 * ULP),
    ),
    _on_floor(
        "disable one of two floors in one place",
        "the other carries the ball",
        (1.0, off("floor"), 1.0),
        ".*twin begin",
        *resting(0.0, R, NEAR),
        scene=Scene(
            gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(floor(), Wall((-3, 0), (3, 0), name="twin"))
        ),
    ),
    Case(
        name="disable one wall of a V",
        why="the other wall alone does not hold: slides down it at g sin 45, from rest",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R, b=0.5),
            elements=(Wall((0, 0), (-2, 2), name="left"), Wall((-1, -1), (2, 2), name="right")),
        ),
        position=(0.0, R * math.sqrt(2)),
        script=(1.0, off("left"), 1.0),
        expect=(*at(-0.5, R * math.sqrt(2) - 0.5, 4 * NEAR), speed(math.sqrt(2.0), 32 * ULP)),
    ),
    Case(
        name="disable a bumper on which the ball is balanced",
        why="free fall, through where the bumper was",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(Bumper((0, 0), 0.5, name="bumper"),)),
        position=(0.0, 0.5 + R),
        script=(1.0, off("bumper"), 2.0),
        rows="bumper begin, bumper end",
        expect=(*at(0.0, 0.5 + R - 4.0, NEAR), when("bumper end", 1.0, 0.0)),
    ),
    _on_floor(
        "replace by a lower floor",
        "falls 1 m, to the floor at -1: hit 1 s later",
        (1.0, ("replace", LOWER), 1.5),
        "floor begin(, floor end)?, floor bounce",
        when("floor bounce", 2.0, 4 * ULP),
        *at(0.0, R - 1 + 0.25, NEAR),
    ),
    _on_floor(
        "replace by the same scene",
        "changes nothing",
        (1.0, ("replace", FLOOR), 1.0),
        "floor begin((, floor end)?, floor begin)?",
        *resting(0.0, R, 0.0),
    ),
    Case(
        name="replace by a scene that overlaps the ball",
        why="contract: ValueError, nothing has changed",
        scene=FLOOR,
        position=(0.0, R),
        script=(("replace", Scene(ball=Ball(radius=R, b=0.5), elements=(floor(R),))),),
        refused="overlaps",
    ),
    Case(
        name="glue holds on a slope until it is switched off",
        why="held without a bound in time; then free fall from there",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0, f=0), elements=(slope(),)),
        position=on_slope(-1.5, R),
        script=(100.0, off("slope"), 0.5),
        rows="slope begin, slope end",
        expect=at(on_slope(-1.5, R)[0], on_slope(-1.5, R)[1] - G / 8, NEAR),
    ),
    Case(
        name="push a glued ball",
        why="contract: f = 0 holds under the law, so a push along the slope has no effect; one off it is a flight",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0, f=0), elements=(slope(),)),
        position=on_slope(-1.5, R),
        script=(1.0, ("push", (C30, -S30)), 1.0),
        expect=resting(*on_slope(-1.5, R), NEAR),
    ),
    Case(
        name="push after the drain",
        why="contract: out of play stays out of play, where it was",
        scene=Scene(
            gravity=(0, -2), ball=Ball(radius=R), elements=(floor(), Sensor((-3, 1), (3, 1), drain=True, name="drain"))
        ),
        position=(0.0, 2.0),
        script=(2.0, ("push", (1.0, 1.0)), 1.0, ("enable", "floor", False), 1.0),
        status=("OUT",),
        rows="drain cross",
        expect=at(0.0, 1.0, NEAR),
    ),
]
