"""Draggable walls: they carry, strike, drop and crush balls; their ends stop where they must."""

import math
from typing import Any

from bounce_env.report.stability.case import ULP, Case, Expect, at, between, count, going, of_row, when
from bounce_env.report.stability.cases.paddles import DOWN, FREE, NEAR, R, scene
from bounce_env.scene import Ball, Wall

POINT = Ball()
Ends = tuple[tuple[float, float], tuple[float, float]]


def drag(start: tuple[float, float], end: tuple[float, float] | None = None) -> tuple[str, str, Ends]:
    """Velocities of the two ends; of both the same where one is given."""
    return ("command", "w", (start, start if end is None else end))


def floor(**more: Any) -> Wall:
    return Wall((-2, 0), (2, 0), draggable=True, name="w", **more)


def upright(**more: Any) -> Wall:
    return Wall((0, -1), (0, 1), draggable=True, name="w", **more)


_SIN, _COS = 0.5, math.sqrt(0.75)
_SLOPE = Wall((-2 * _COS, -2 * _SIN), (2 * _COS, 2 * _SIN), draggable=True, b=0.0, name="w")
_SHUT = Wall((1, -1), (1, 1), b=0.5, name="wall")
_TIED = Wall((0, 0), (2, 0), draggable=True, b=0.5, name="w")


def stopped(seconds: float, *ends: tuple[float, float, float, float]) -> tuple[Expect, ...]:
    """When the wall stops, and of each of its ends where it is then and how fast it goes on: x, y, vx, vy."""
    found = [when("w stop", seconds, 0.0)]
    for n, end in enumerate(ends):
        found += [
            of_row("w stop", name, value, 0.0, n) for name, value in zip(("x", "y", "vx1", "vy1"), end, strict=True)
        ]
    return tuple(found)


def _carried(radius: float) -> Case:
    return Case(
        name=f"floor rises under a ball of {radius:g} m",
        why="b = 0: the ball takes the floor's speed, and keeps to it",
        scene=scene(floor(b=0.0), gravity=DOWN, ball=Ball(radius=radius)),
        position=(0.0, radius),
        script=(0.5, drag((0.0, 0.25)), 2.0),
        rows="w begin, w bounce, w end, w begin",
        expect=(*at(0.0, radius + 0.5, NEAR), *going(0.0, 0.25, NEAR)),
    )


def _thrown(radius: float) -> Case:
    return Case(
        name=f"floor that rises under a ball of {radius:g} m stops",
        why="0.5 m at 0.25 m/s; the ball flies on: 0.25 t - t^2 / 2",
        scene=scene(floor(b=0.0, reach=((-2, -2), (2, 0.5))), gravity=DOWN, ball=Ball(radius=radius)),
        position=(0.0, radius),
        script=(0.5, drag((0.0, 0.25)), 2.25),
        rows="w begin, w bounce, w end, w begin, w stop, w stop, w end",
        expect=(when("w stop", 2.5, 4 * ULP), when("w end", 2.5, 4 * ULP, n=1), *at(0.0, radius + 0.53125, NEAR)),
    )


def _lowered(radius: float) -> Case:
    return Case(
        name=f"floor sinks beneath a ball of {radius:g} m",
        why="t^2 / 2 = 0.25 t: after 0.5 s the ball has it back; b = 0",
        scene=scene(floor(b=0.0), gravity=DOWN, ball=Ball(radius=radius)),
        position=(0.0, radius),
        script=(0.5, drag((0.0, -0.25)), 2.0),
        rows="w begin, w end, w bounce, w begin",
        expect=(when("w bounce", 1.0, 4 * ULP), *at(0.0, radius - 0.5, NEAR), *going(0.0, -0.25, NEAR)),
    )


def _struck(w: float, b: float, radius: float) -> Case:
    return Case(
        name=f"wall that turns at {w:g} rad/s strikes a ball of {radius:g} m, b={b}",
        why="numerics.md, result 8: half-way to the end, which moves at 2 w, the ball leaves with (1 + b) w",
        scene=scene(
            Wall((0, 0), (2, 0), draggable=True, b=b, name="w"), gravity=DOWN, ball=Ball(radius=radius), max_speed=1e3
        ),
        position=(1.0, radius),
        script=(0.5, drag((0.0, 0.0), (0.0, 2 * w)), 0.0009765625),
        expect=(of_row("w bounce", "vy1", (1 + b) * w, 1e-9 * w), count("w begin", 1)),
    )


def _swept(radius: float) -> Case:
    return Case(
        name=f"wall at 100 m/s sweeps a resting ball of {radius:g} m",
        why="struck, never passed: 2u",
        scene=scene(upright(), ball=Ball(radius=radius)),
        position=(1.0, 0.0),
        script=(drag((100.0, 0.0)), 0.015625),
        rows="w bounce",
        expect=(when("w bounce", (1.0 - radius) / 100.0, 4 * ULP), *going(200.0, 0.0, 200 * NEAR)),
    )


def _shut_in(radius: float) -> Case:
    return Case(
        name=f"wall crushes a ball of {radius:g} m against another wall",
        why="it stops at the clearance, and the ball stays in between",
        scene=scene(Wall((-1, -1), (-1, 1), draggable=True, b=0.5, name="w"), _SHUT, ball=Ball(radius=radius)),
        position=(0.0, 0.0),
        velocity=(1.0, 0.0),
        script=(drag((0.25, 0.0)), 16.0),
        status=("CRUSHED",),
        expect=(
            count("w crush", 1),
            count("w stop", 2),
            between("x", lambda run: run.position[0], 1.0 - radius - 2.0**-11, 1.0 - radius),
            *going(0.0, 0.0, 0.0),
        ),
    )


def _let_go(radius: float) -> Case:
    case = _shut_in(radius)
    return Case(
        name=f"wall lets a crushed ball of {radius:g} m go",
        why="a command opens the gap: the ball is free, at rest",
        scene=case.scene,
        position=case.position,
        velocity=case.velocity,
        script=(*case.script, drag((-0.25, 0.0)), 1.0),
        expect=(between("x", lambda run: run.position[0], 1.0 - radius - 2.0**-11, 1.0 - radius),),
    )


WALLS = [
    *(make(radius) for make in (_carried, _thrown, _lowered, _swept, _shut_in, _let_go) for radius in (R, 0.0)),
    *(_struck(w, b, radius) for w, b in ((35.0, 0.5), (200.0, 0.0)) for radius in (R, 0.0)),
    Case(
        name="floor is dragged down faster than the ball falls",
        why="a free fall from rest: t^2 / 2",
        scene=scene(floor(), gravity=DOWN),
        position=(0.0, R),
        script=(0.5, drag((0.0, -4.0)), 0.25),
        rows="w begin, w end",
        expect=(*at(0.0, R - 0.03125, NEAR), *going(0.0, -0.25, NEAR)),
    ),
    Case(
        name="wall overtakes the ball",
        why="numerics.md: 2u - v. They close by 0.875 m at 0.25 m/s",
        scene=scene(Wall((0, -8), (0, 8), draggable=True, name="w")),
        position=(1.0, 0.0),
        velocity=(0.25, 0.0),
        script=(drag((0.5, 0.0)), 4.0),
        rows="w bounce",
        expect=(when("w bounce", 3.5, 4 * ULP), *going(0.75, 0.0, NEAR)),
    ),
    Case(
        name="wall at the ball's speed",
        why="numerics.md: no hit",
        scene=scene(Wall((0, -8), (0, 8), draggable=True, name="w")),
        position=(R, 0.0),
        velocity=(0.5, 0.0),
        script=(drag((0.5, 0.0)), 4.0),
        rows="",
        expect=(*at(R + 2.0, 0.0, NEAR), *going(0.5, 0.0, 0.0)),
    ),
    Case(
        name="floor that is drawn out beneath a resting ball",
        why="it moves along itself, and with f = 1 nothing pulls at the ball, which keeps to it in small hops",
        scene=scene(floor(b=0.5), gravity=DOWN, rest_speed=0.015625),
        position=(0.0, R),
        script=(0.5, drag((-0.25, 0.0), (0.25, 0.0)), 1.0),
        expect=(
            *at(0.0, R, 2.0**-12),
            between("y", lambda run: run.position[1], R, R + 2.0**-12),
        ),
    ),
    Case(
        name="ends close up to the shortest length",
        why="4 m - 0.5 m at 1 m/s",
        scene=scene(floor(min_length=0.5)),
        position=(0.0, 1.0),
        script=(drag((0.5, 0.0), (-0.5, 0.0)), 4.0),
        rows="w stop, w stop",
        expect=stopped(3.5, (-0.25, 0.0, 0.0, 0.0), (0.25, 0.0, 0.0, 0.0)),
    ),
    Case(
        name="an end comes to the border of its box",
        why="1 m at 1 m/s; along the border it goes on",
        scene=scene(floor(reach=((-3, -3), (3, 3)))),
        position=(0.0, -2.0),
        script=(drag((0.0, 0.0), (1.0, 0.5)), 2.0),
        rows="w stop, w stop",
        expect=stopped(1.0, (-2.0, 0.0, 0.0, 0.0), (3.0, 0.5, 0.0, 0.5)),
    ),
    Case(
        name="an end at the border is sent beyond it",
        why="that coordinate stays, the other one moves",
        scene=scene(floor(reach=((-2, -3), (2, 3)))),
        position=(0.0, -2.0),
        script=(drag((-1.0, 0.5), (1.0, 0.5)), 8.0),
        rows="w stop, w stop",
        expect=stopped(6.0, (-2.0, 3.0, 0.0, 0.0), (2.0, 3.0, 0.0, 0.0)),
    ),
    Case(
        name="slope that is lifted along its normal",
        why="in its frame s = g sin 30 t^2 / 2; b = 0",
        scene=scene(_SLOPE, gravity=DOWN),
        position=(-R * _SIN, R * _COS),
        script=(drag((-0.25 * _SIN, 0.25 * _COS)), 1.0),
        rows="w bounce, w begin",
        expect=at(-(R + 0.25) * _SIN - 0.25 * _COS, (R + 0.25) * _COS - 0.25 * _SIN, NEAR),
    ),
    Case(
        name="ball slides off the end of a rising floor",
        why="2 m at 2 m/s, f = 1; then it falls from where it left: v^2 > g R",
        scene=scene(floor(b=0.0), gravity=DOWN),
        position=(0.0, R),
        velocity=(2.0, 0.0),
        script=(drag((0.0, 0.25)), 1.5),
        rows="w bounce, w begin, w end",
        expect=(when("w end", 1.0, 4 * ULP), *at(3.0, R + 0.25 + 0.125 - 0.125, NEAR), *going(2.0, -0.25, NEAR)),
    ),
    Case(
        name="floor is pulled away from beneath a resting ball",
        why="f = 1: it takes no speed; the floor's end is below it after 2 s, and gone before the ball falls on it",
        scene=scene(floor(b=0.0, reach=((-8, -8), (8, 8))), gravity=DOWN),
        position=(0.0, R),
        script=(0.5, drag((1.0, 0.0)), 2.5),
        rows="w begin, w end, w begin, w end",
        expect=(when("w end", 2.5, 4 * ULP, n=1), *at(0.0, R - 0.125, NEAR), *going(0.0, -0.5, NEAR)),
    ),
    Case(
        name="floor with friction takes the ball along",
        why="f = 0.5: held where gravity presses it",
        scene=scene(floor(b=0.0, f=0.5), gravity=DOWN),
        position=(0.0, R),
        script=(0.5, drag((0.25, 0.0)), 2.0),
        expect=(*at(0.5, R, NEAR), *going(0.25, 0.0, NEAR)),
    ),
    Case(
        name="scene is replaced while its floor rises",
        why="the floor of the new one keeps its ends and its command, and carries the ball on",
        scene=scene(floor(b=0.0), gravity=DOWN),
        position=(0.0, R),
        script=(
            drag((0.0, 0.25)),
            1.0,
            ("replace", scene(floor(b=0.0), Wall((-2, 3), (2, 3), name="lid"), gravity=DOWN)),
            1.0,
        ),
        expect=(*at(0.0, R + 0.5, NEAR), *going(0.0, 0.25, NEAR)),
    ),
    Case(
        name="scene is replaced by one whose floor is elsewhere",
        why="it is where the new scene has it: 0.5 m below where the ball is, which falls on: t^2 / 2",
        scene=scene(floor(b=0.0), gravity=DOWN),
        position=(0.0, R),
        script=(
            drag((0.0, 0.5)),
            1.0,
            ("replace", scene(Wall((-2, 0), (2, 0.0625), draggable=True, b=0.0, name="w"), gravity=DOWN)),
            0.25,
        ),
        expect=(*at(0.0, R + 0.5 + 0.125 - 0.03125, NEAR), *going(0.0, 0.25, NEAR)),
    ),
    Case(
        name="a wall is told of velocities that are none",
        why="refused before anything moves",
        scene=scene(_TIED),
        position=(1.0, 1.0),
        script=(drag((0.0, 0.0), (0.0, math.nan)), 1.0),
        refused="command 'w' = .*nan.*: must be .*finite",
    ),
    Case(
        name="a wall is told to be faster than the scene allows",
        why="a cap must exceed the speed of every surface",
        scene=scene(_TIED, gravity=FREE, max_speed=2.0),
        position=(1.0, 1.0),
        script=(drag((0.0, 0.0), (0.0, 2.0)), 1.0),
        refused="each slower than the scene's max_speed, 2.0 m/s",
    ),
]
