"""Paddles and bumpers on rails: strikes, rides, stops, and balls that they crush."""

import math

from bounce_env.report.stability.case import ULP, Case, at, between, count, going, last_time, of_row, resting, when
from bounce_env.scene import Ball, Bumper, Paddle, Scene, Wall

R = 0.125  # the ball's radius [m]
NEAR = 1e-12
FREE = (0.0, 0.0)
DOWN = (0.0, -1.0)


def tell(name: str, value: float | bool) -> tuple[str, str, float | bool]:
    return ("command", name, value)


def disc(**material: float) -> Paddle:
    """A disc on a rail along x, in whose middle it starts."""
    return Paddle((-2, 0), (2, 0), half_width=0.0, radius=0.125, max_speed=1.0, name="p", **material)


def plank(**material: float) -> Paddle:
    """A capsule 1.25 m long on the same rail; a ball on top of it is at a height of 0.25 m."""
    return Paddle((-2, 0), (2, 0), half_width=0.5, radius=0.125, max_speed=1.0, name="p", **material)


def scene(*elements, gravity=FREE, ball=None, **rules: float) -> Scene:
    return Scene(gravity=gravity, ball=ball or Ball(radius=R), elements=elements, **rules)


_SHUTTLE = Bumper((0, 0), 0.25, rail_end=(1, 0), speed=0.5, name="m")
_CLOSING = scene(disc(), Wall((2.25, -1), (2.25, 1), name="wall"))
_RUN, _RISE = math.sqrt(0.75), 0.5
_E = 0.5
_FALL = math.sqrt(2.0 * 0.5)  # s from 0.5 m above the plank

PADDLES = [
    Case(
        name="paddle overtakes the ball",
        why="numerics.md: 2u - v. They close by 0.75 m at 0.75 m/s; the paddle stops after 2 m",
        scene=scene(disc()),
        position=(1.0, 0.0),
        velocity=(0.25, 0.0),
        script=(tell("p", 1.0), 4.0),
        rows="p bounce, p stop",
        expect=(when("p bounce", 1.0, 4 * ULP), when("p stop", 2.0, 0.0), *going(1.75, 0.0, NEAR), *at(6.5, 0.0, NEAR)),
    ),
    Case(
        name="paddle at the ball's speed",
        why="numerics.md: no hit",
        scene=scene(disc()),
        position=(0.25, 0.0),
        velocity=(0.5, 0.0),
        script=(tell("p", 0.5), 8.0),
        rows="p stop",
        expect=(when("p stop", 4.0, 0.0), *at(4.25, 0.0, NEAR)),
    ),
    Case(
        name="paddle that the ball is faster than",
        why="v' = 2u - v in a head-on hit: -1 - 2 * 0.5; closing 0.75 m at 1.5 m/s",
        scene=scene(disc()),
        position=(1.0, 0.0),
        velocity=(-1.0, 0.0),
        script=(tell("p", 0.5), 1.0),
        rows="p bounce",
        expect=(when("p bounce", 0.5, 4 * ULP), *going(2.0, 0.0, NEAR)),
    ),
    Case(
        name="paddle closes on a wall",
        why="numerics.md, result 6: v grows by 2u a hit, L (v + u) is constant, all is over at L / u = 7.5 s; crushed",
        scene=_CLOSING,
        position=(0.25, 0.0),
        velocity=(1.0, 0.0),
        script=(tell("p", 0.25), 8.0),
        rows="(wall bounce, p bounce, )+p crush, p stop",
        status=("CRUSHED",),
        max_events=100_000,
        expect=(
            of_row("p bounce", "vx1", 6.0, 1e-11, n=9),
            when("p bounce", (1.875 - 1.40625 / (6.0 - 0.5 + 0.25)) / 0.25, 1e-10, n=9),
            between("time of the last row", lambda run: float(run.ledger["time"][-1]), 7.499, 7.5),
            *going(0.0, 0.0, 0.0),
        ),
    ),
    Case(
        name="crushed ball is freed when the paddle goes back",
        why="a command that opens the gap lets it go; without gravity and with no speed it stays where it is",
        scene=scene(disc(b=0.5), Wall((2.25, -1), (2.25, 1), name="wall")),
        position=(1.0, 0.0),
        script=(tell("p", 1.0), 4.0, tell("p", 0.5), 1.0, tell("p", -1.0), 1.0),
        rows="p bounce, .*p crush, p stop, p end",
        expect=(count("p crush", 1), *at(2.125, 0.0, 1e-3), *going(0.0, 0.0, 0.0)),
    ),
    Case(
        name="paddle slides away beneath a ball",
        why="f = 1: nothing moves the ball. The straight side passes it after 1 s",
        scene=scene(plank(b=0.5), gravity=DOWN),
        position=(0.0, 0.25),
        script=(tell("p", 0.5), 0.9375),
        rows="p begin",
        expect=(*at(0.0, 0.25, NEAR), *going(0.0, 0.0, NEAR)),
    ),
    Case(
        name="ball comes off the end of a paddle that slides away",
        why="the straight side passes it after 1 s; then it leaves the round end and falls",
        scene=scene(plank(b=0.5), gravity=DOWN),
        position=(0.0, 0.25),
        script=(tell("p", 0.5), 3.0),
        rows="p begin, p end(, p bounce)*",
        expect=(when("p end", 1.0, 1e-9), between("y", lambda run: run.position[1], -2.0, -0.5)),
    ),
    Case(
        name="friction takes a ball along",
        why="f < 1 stops a pressed contact, in the paddle's frame: from 1 s on it goes at 0.5 m/s, and stops with it",
        scene=scene(plank(b=0.5, f=0.5), gravity=DOWN),
        position=(0.0, 0.25),
        script=(1.0, tell("p", 0.5), 6.0),
        rows="p begin, p end, p begin, p stop, p end, p begin",
        expect=(when("p stop", 5.0, 0.0), *resting(2.0, 0.25, NEAR)),
    ),
    Case(
        name="drop on a paddle that slides",
        why="numerics.md, check 1, in the paddle's frame: sqrt(2h/g) (1 + e)/(1 - e), wherever it slides; f = 1",
        scene=scene(plank(b=_E), gravity=DOWN),
        position=(0.25, 0.75),
        script=(tell("p", 0.125), 3.75),
        rows="p bounce(, p bounce)*, p begin",
        expect=(
            last_time(_FALL * (1 + _E) / (1 - _E), 1e-12),
            *at(0.25, 0.25, NEAR),
            *going(0.0, 0.0, NEAR),
        ),
    ),
    Case(
        name="slope that moves along itself",
        why="f = 1: it gives the ball no speed; s = g sin 30 t^2 / 2 as on one that stands",
        scene=scene(
            Paddle(
                (-1.0, -math.sqrt(1 / 3)),
                (1.0, math.sqrt(1 / 3)),
                half_width=1.0,
                radius=0.125,
                max_speed=1.0,
                name="p",
            ),
            gravity=DOWN,
        ),
        position=(-0.125, 0.25 * math.sqrt(0.75)),
        script=(tell("p", 0.25), 1.0),
        rows="p begin",
        expect=at(-0.125 - 0.25 * math.sqrt(0.75), 0.25 * math.sqrt(0.75) - 0.125, NEAR),
    ),
    Case(
        name="bumper on a rail strikes a ball",
        why="0.875 m at 0.5 m/s; v' = 2u; it turns back after 2 s and again after 4 s",
        scene=scene(_SHUTTLE),
        position=(1.25, 0.0),
        script=(4.5,),
        rows="m bounce, m stop, m stop",
        expect=(
            when("m bounce", 1.75, 4 * ULP),
            when("m stop", 2.0, 0.0),
            when("m stop", 4.0, 0.0, n=1),
            of_row("m stop", "vx1", -0.5, 0.0),
            *going(1.0, 0.0, NEAR),
        ),
    ),
    Case(
        name="bumper on a rail is told to stand",
        why="it stands at 0.5 m from 1 s on, and the ball meets it there: 0.625 m at 0.5 m/s",
        scene=scene(_SHUTTLE),
        position=(1.5, 0.0),
        velocity=(0.0, 0.0),
        script=(1.0, tell("m", 0.0), ("push", (-0.5, 0.0)), 2.0),
        rows="m bounce",
        expect=(when("m bounce", 2.25, 4 * ULP), *going(0.5, 0.0, NEAR)),
    ),
    Case(
        name="point and paddle",
        why="a ball of no radius meets a disc of 0.125 m: 0.875 m at 1.5 m/s",
        scene=scene(disc(), ball=Ball()),
        position=(1.0, 0.0),
        velocity=(-1.0, 0.0),
        script=(tell("p", 0.5), 1.0),
        rows="p bounce",
        expect=(when("p bounce", 0.875 / 1.5, 4 * ULP), *going(2.0, 0.0, NEAR)),
    ),
    Case(
        name="command for a speed that it cannot reach",
        why="refused before anything moves",
        scene=scene(disc()),
        position=(1.0, 0.0),
        script=(tell("p", 1.5), 1.0),
        refused="command 'p' = 1.5: must be finite and at most 1.0 m/s",
    ),
]
