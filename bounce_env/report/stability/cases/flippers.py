"""Flippers: strikes, stops, strokes in part, balls that they hold, drop and crush."""

import math

from bounce_env.report.stability.case import Case, at, between, count, going, last_time, of_row, resting, when
from bounce_env.scene import Ball, Flipper, Scene, Wall

R = 0.0135  # the ball's radius [m]
ON_TOP = R + 0.01  # height of a ball on a level flipper
LENGTH = 0.08
G = 1.11  # m/s^2 along a table
NEAR = 1e-12


def press(on: bool = True) -> tuple[str, str, bool]:
    return ("command", "left", on)


def flipper(rest: float = 0.0, active: float = 0.8, up: float = 35.0, down: float = 17.5, **material: float) -> Flipper:
    return Flipper(
        (0, 0), LENGTH, radius=0.01, rest_angle=rest, active_angle=active, up_speed=up, down_speed=down, name="left",
        **material,
    )  # fmt: skip


def table(*elements, radius: float = R, rest_speed: float = 0.02, **ball: float) -> Scene:
    return Scene(
        gravity=(0, -G), ball=Ball(radius=radius, **ball), rest_speed=rest_speed, max_speed=100.0, elements=elements
    )


def _struck(b: float, w: float, rho: float = 0.05, radius: float = R) -> Case:
    """A ball at rest on the level flipper, at `rho` from the pivot, is struck from below."""
    return Case(
        name=f"flipper at {w:g} rad/s strikes a resting ball of {radius:g} m, b={b}",
        why="numerics.md, result 8: it leaves with (1 + e) w rho",
        scene=table(flipper(b=b, up=w), radius=radius),
        position=(rho, radius + 0.01),
        script=(0.5, press(), 0.001),
        rows="left begin, left bounce(, .*)?",
        expect=(of_row("left bounce", "vy1", (1 + b) * w * rho, 1e-9 * w * rho), count("left begin", 1)),
    )


def _dropped(height: float, e: float) -> Case:
    return Case(
        name=f"drop on a flipper that stands, e={e}",
        why="a part at rest is a wall: sqrt(2h/g) (1 + e)/(1 - e)",
        scene=table(flipper(b=e), rest_speed=0.0),
        position=(0.04, ON_TOP + height),
        script=(16.0,),
        rows="left bounce(, left bounce)*, left begin",
        expect=(last_time(math.sqrt(2 * height / G) * (1 + e) / (1 - e), 1e-12), *resting(0.04, ON_TOP, NEAR)),
    )


def _sloped(angle: float) -> tuple[float, float]:
    """A place on a flipper at `angle`, 0.06 m from the pivot."""
    c, s = math.cos(angle), math.sin(angle)
    return 0.06 * c - ON_TOP * s, 0.06 * s + ON_TOP * c


_TO_STOP = 0.8 / 35.0
_ALONG = 35.0 * (0.02 * math.sinh(0.8) + ON_TOP * math.cosh(0.8) - ON_TOP)
_CARRIED = math.hypot(_ALONG, 35.0 * (0.02 * math.cosh(0.8) + ON_TOP * math.sinh(0.8)))
_CRADLE = table(flipper(0.5, -0.5, b=0.3), Wall((-0.0135, -0.2), (-0.0135, 0.3), b=0.3, name="wall"))

FLIPPERS = [
    *(_struck(b, w) for b in (0.0, 0.5, 1.0) for w in (35.0, 200.0)),
    _struck(0.5, 200.0, rho=0.02, radius=0.001),
    _struck(0.0, 200.0, rho=0.079, radius=0.001),
    _dropped(0.1, 0.5),
    _dropped(0.2, 0.9),
    Case(
        name="flipper drops away beneath a ball",
        why="it turns down faster than the ball falls: a free fall from rest, g t^2 / 2",
        scene=table(flipper(0.0, -1.0, up=100.0, b=0.5)),
        position=(0.05, ON_TOP),
        script=(0.5, press(), 0.0625),
        rows="left begin, left end, left stop",
        expect=(when("left end", 0.5, 0.0), *at(0.05, ON_TOP - 0.5 * G * 0.0625**2, NEAR)),
    ),
    Case(
        name="flipper released half-way",
        why="up 35 rad/s for 1/128 s, down 17.5 rad/s: twice as long",
        scene=table(flipper(b=0.5)),
        position=(0.05, 0.5),
        script=(press(), 0.0078125, press(False), 0.1),
        rows="left stop",
        expect=(when("left stop", 3 * 0.0078125, 1e-15),),
    ),
    Case(
        name="flipper stops with a ball on it",
        why="b = 0, f = 1: bead on a turning rod, s'' = w^2 s, s0 = 0.02, s0' = w h; hops of 1 % cost it up to 4 %",
        scene=table(flipper(b=0.0)),
        position=(0.02, ON_TOP),
        script=(0.5, press(), 0.0625),
        rows="left begin, left bounce, left end(, left bounce)*, left stop",
        expect=(
            when("left stop", 0.5 + _TO_STOP, 1e-15),
            between("speed", lambda run: math.hypot(*run.velocity), 0.96 * _CARRIED, 1.01 * _CARRIED),
        ),
    ),
    Case(
        name="pressed again is no change",
        why="a command equal to the present one changes no bit: the same as pressed once",
        scene=table(flipper(b=0.5)),
        position=(0.05, ON_TOP),
        script=(0.5, press(), 0.0078125, press(), 0.0078125),
        rows="left begin, left bounce, left end",
        expect=(of_row("left bounce", "vy1", 1.5 * 35.0 * 0.05, 1e-9), *going(0.0, 2.625 - 0.015625 * G, 1e-9)),
    ),
    Case(
        name="ball rolls off a flipper at rest",
        why="g sin(0.4) along it, 0.02 m to the end of the straight side, then round the end of the flipper",
        scene=table(flipper(-0.4, 0.4, b=0.3)),
        position=_sloped(-0.4),
        script=(0.5,),
        rows="left begin, left end, left begin, left end",
        expect=(when("left end", math.sqrt(2 * 0.02 / (G * math.sin(0.4))), 1e-9),),
    ),
    Case(
        name="flipper cradles a ball",
        why="held between the slope of the flipper and a wall it rests: no speed is left, to the bit",
        scene=_CRADLE,
        position=_sloped(0.5),
        script=(60.0,),
        rows="left begin, .*begin",
        expect=(
            *going(0.0, 0.0, 0.0),
            *at(0.0, 0.01 / math.cos(0.5) + R / math.cos(0.5), 1e-9),
        ),
    ),
    Case(
        name="cradled ball is dropped",
        why="the flipper turns away: from rest, along the wall",
        scene=_CRADLE,
        position=_sloped(0.5),
        script=(60.0, press(), 0.03125),
        rows="left begin, .*begin, .*left end, .*",
        expect=(between("vy", lambda run: run.velocity[1], -G * 0.03125 - 1e-9, -0.5 * G * 0.03125),),
    ),
    Case(
        name="flipper crushes a ball on a wall",
        why="there is no room for it beneath: it is caught and stays where it is until the flipper lets go",
        scene=table(
            flipper(0.8, -1.2, b=0.5),
            Wall((0.0, -0.03), (0.2, -0.03), name="floor"),
            Wall((0.09, -0.03), (0.09, 0.3), name="end"),
        ),
        position=(0.06, -0.03 + R),
        script=(0.25, press(), 0.25, press(False), 0.5),
        rows="floor begin, .*left crush, left stop, .*",
        expect=(count("left crush", 1), between("y", lambda run: run.position[1], -0.03 + R - 1e-9, 0.2)),
    ),
    Case(
        name="flipper squeezes a ball out of a wedge",
        why="the wedge is open at its far end: the ball leaves along the floor, faster than the flipper comes",
        scene=table(flipper(0.8, -1.2, b=0.5), Wall((0.0, -0.03), (2.0, -0.03), name="floor")),
        position=(0.06, -0.03 + R),
        script=(0.25, press(), 0.25),
        rows="floor begin, .*left stop.*",
        expect=(count("left crush", 0), between("vx", lambda run: run.velocity[0], 1.0, 50.0)),
    ),
    Case(
        name="point on a flipper",
        why="a ball of no radius rests on its surface and is struck as any other",
        scene=table(flipper(b=0.5), radius=0.0),
        position=(0.05, 0.01),
        script=(0.5, press(), 0.001),
        rows="left begin, left bounce(, .*)?",
        expect=(of_row("left bounce", "vy1", 1.5 * 35.0 * 0.05, 1e-9),),
    ),
    Case(
        name="flipper is told a number",
        why="refused: it is pressed or not",
        scene=table(flipper()),
        position=(0.05, ON_TOP),
        script=(("command", "left", 1.0), 1.0),
        refused="command 'left' = 1.0: must be True",
    ),
]
