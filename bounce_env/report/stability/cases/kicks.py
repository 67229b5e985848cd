"""Kicks with threshold and cooldown."""

from bounce_env.report.stability.case import ULP, Case, at, of_row, when
from bounce_env.report.stability.cases.commands import FREE
from bounce_env.report.stability.cases.drops import NEAR, R, floor
from bounce_env.scene import Ball, Scene, Wall


def _kick(name: str, v: float, v1: float, why: str, **surface: float) -> Case:
    """Straight at a wall without gravity; b = 0.5."""
    return Case(
        name=f"kick {name}",
        why=why,
        scene=Scene(gravity=FREE, ball=Ball(radius=R), max_speed=100, elements=(floor(b=0.5, kick=1.0, **surface),)),
        position=(0.0, 1 + R),
        velocity=(0.25, -v),
        script=(1 / v,),
        rows="floor bounce",
        expect=(of_row("floor bounce", "vy1", v1, 4 * ULP), of_row("floor bounce", "vx1", 0.25, 0.0)),
    )


def _cooldown(cooldown: float, speeds: tuple[float, ...]) -> Case:
    """Between a kicking wall and a plain one, 1 m apart, b = 1: speeds after the kicking wall's hits."""
    return Case(
        name=f"cooldown of {cooldown} s",
        why="hits at 1 s (v = 2), 2 s; then at 3 s or 2 + 2/3 s: a kick of 1 m/s only when cooldown has passed",
        scene=Scene(
            gravity=FREE,
            max_speed=100,
            elements=(
                Wall((0, -3), (0, 3), name="plain"),
                Wall((1, -3), (1, 3), kick=1.0, cooldown=cooldown, name="kicker"),
            ),
        ),
        position=(0.0, 0.0),
        velocity=(1.0, 0.0),
        script=(3.25,),
        expect=tuple(of_row("kicker bounce", "vx1", -v, 8 * ULP, n) for n, v in enumerate(speeds)),
    )


KICKS = [
    _kick("slower than its threshold", 0.75, 0.375, "law only", kick_threshold=1.0),
    _kick(
        "at exactly its threshold",
        1.0,
        0.5,
        "given when the approach is faster than the threshold: not here",
        kick_threshold=1.0,
    ),
    _kick("a little above its threshold", 1 + 2.0**-40, 1.5 + 2.0**-41, "law, then the kick", kick_threshold=1.0),
    _kick("without a threshold", 0.5, 1.25, "law, then the kick"),
    _kick("that does not cool down", 2.0, 2.0, "the first kick needs no cooldown to pass", cooldown=1e6),
    _cooldown(1.5, (2.0, 2.0, 3.0)),
    _cooldown(0.75, (2.0, 3.0, 3.0)),
    _cooldown(0.0, (2.0, 3.0, 4.0)),
    Case(
        name="kick of a touch that rest_speed absorbs",
        why="contract: absorption, law, kick: normal speed 0, then 1 m/s from the kick; hop of 2 v / g = 1 s",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R, b=0.5, f=0.5),
            rest_speed=3.0,
            max_speed=100,
            elements=(floor(kick=1.0, kick_threshold=1.5),),
        ),
        position=(-1.0, 1 + R),
        velocity=(0.5, 0.0),
        script=(4.0,),
        rows="floor bounce, floor bounce, floor begin",
        expect=(
            when("floor bounce", 1.0, 2 * ULP),
            of_row("floor bounce", "vy1", 1.0, 0.0),
            when("floor begin", 2.0, 4 * ULP),
            *at(1.0, R, NEAR),
        ),
    ),
    Case(
        name="kicked for ever",
        why="closing v gives v / 2 + 1, so the speed tends to 2 and the hops to 2 s",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R), max_speed=100, elements=(floor(b=0.5, kick=1.0),)),
        position=(0.0, 4 + R),
        velocity=(0.0, 0.0),
        script=(500.0,),
        rows="(floor bounce, )+floor bounce",
        expect=(
            of_row("floor bounce", "vy1", 3.0, 4 * ULP),
            of_row("floor bounce", "vy1", 2.5, 4 * ULP, 1),
            of_row("floor bounce", "vy1", 2.0, 8 * ULP, -1),
        ),
    ),
]
