"""Tar, glue and rest_speed; ceilings: what holds a ball, what lets it slide, what lets it fall."""

from bounce_env.report.stability.case import ULP, Case, at, going, of_row, resting, speed, when
from bounce_env.report.stability.cases.drops import HIT, NEAR, G, R, floor, on_slope, slope
from bounce_env.scene import Ball, Scene, Wall

HOLDS = [
    Case(
        name="tar: b = 0, f = 0.5",
        why="contract: with rest_speed = 0 a pressed contact with f < 1 stops the ball where it hit",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0, f=0.5), elements=(floor(),)),
        position=(-1.0, 1 + R),
        velocity=(3.0, 0.0),
        script=(5.0,),
        rows="floor bounce, floor begin",
        expect=(when("floor begin", HIT, 4 * ULP), *resting(-1 + 3 * HIT, R, NEAR)),
    ),
    Case(
        name="tar on a slope holds",
        why="contract: stopped by friction, also where the tangential part of gravity pulls",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0, f=0.5), elements=(slope(),)),
        position=(on_slope(-1.5, R)[0], on_slope(-1.5, R)[1] + 1),
        script=(1e3,),
        rows="slope bounce, slope begin",
        expect=resting(*on_slope(-1.5, R), NEAR),
    ),
    Case(
        name="tar on an upright wall does not hold",
        why="nothing presses: v_t' = f v_t once, then free fall along the wall",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0, f=0.5), elements=(Wall((1, -3), (1, 3), name="wall"),)),
        position=(0.5 - R, 1.0),
        velocity=(0.5, 2.0),
        script=(1.0, 0.5),
        rows="wall bounce",
        expect=(*at(1 - R, 2.0 - 0.25, NEAR), *going(0.0, -1.0, 4 * ULP)),
    ),
    *(
        Case(
            name=f"glue: b = f = 0, rest_speed = {rest_speed}",
            why="contract: f = 0 holds the ball under both rest speeds",
            scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0, f=0), rest_speed=rest_speed, elements=(slope(),)),
            position=(on_slope(-1.5, R)[0], on_slope(-1.5, R)[1] + 1),
            velocity=(0.5, 0.0),
            script=(100.0,),
            rows="slope bounce, slope begin",
            expect=(*going(0.0, 0.0, 0.0), of_row("slope begin", "vx1", 0.0, 0.0)),
        )
        for rest_speed in (0.0, 0.25)
    ),
    *(
        Case(
            name=f"f = 0 and a soft touch, rest_speed = {rest_speed}",
            why="contract: f = 0 holds the ball under both rest speeds, also when the touch is absorbed",
            scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5, f=0), rest_speed=rest_speed, elements=(floor(),)),
            position=(-1.0, 1.0 + R),
            velocity=(0.5, 0.0),
            script=(8.0,),
            rows=rows,
            expect=(when("floor begin", begins, 8 * ULP), *resting(-0.5, R, NEAR)),
        )
        for rest_speed, begins, rows in (
            (0.0, 3.0, "(floor bounce, )+floor begin"),
            (3.0, 1.0, "floor bounce, floor begin"),
        )
    ),
    Case(
        name="closing at exactly rest_speed bounces",
        why="v = g t is 2 exactly; absorbed is what is slower: law and f at t = 1, then 1 m/s is absorbed",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5, f=0.5), rest_speed=2.0, elements=(floor(),)),
        position=(-2.0, 1 + R),
        velocity=(1.0, 0.0),
        script=(4.0,),
        rows="floor bounce, floor bounce, floor begin",
        expect=(
            when("floor bounce", 1.0, 2 * ULP),
            when("floor begin", 2.0, 4 * ULP),
            *at(0.5, R, NEAR),
            *going(0.5, 0.0, 4 * ULP),
        ),
    ),
    Case(
        name="closing a little slower than rest_speed is absorbed",
        why="contract: normal speed to 0, f does not act on so soft a touch",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, f=0.5), rest_speed=2.0 + 2.0**-40, elements=(floor(),)),
        position=(-2.0, 1 + R),
        velocity=(0.5, 0.0),
        script=(4.0,),
        rows="floor bounce, floor begin",
        expect=(when("floor begin", 1.0, 2 * ULP), *at(0.0, R, NEAR), *going(0.5, 0.0, 4 * ULP)),
    ),
    Case(
        name="elastic above rest_speed for ever",
        why="no bounce is slower than rest_speed: at t = 16 the ball is at its peak again",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R), rest_speed=1.0, elements=(floor(),)),
        position=(0.0, 1 + R),
        script=(16.0,),
        rows="(floor bounce, ){7}floor bounce",
        expect=(*at(0.0, 1 + R, NEAR), *going(0.0, 0.0, NEAR)),
    ),
    Case(
        name="rest_speed rolls down a slope, f = 0.5",
        why="contract: with rest_speed > 0 a soft touch has no friction, and the ball slides at g / 2",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0.5, f=0.5), rest_speed=0.25, elements=(slope(),)),
        position=on_slope(-1.5, R),
        script=(0.75,),
        rows="slope begin",
        expect=at(*on_slope(-1.5 + G / 4 * 0.75**2, R), NEAR),
    ),
    Case(
        name="tar with rest_speed slides on",
        why="the hit is by the law (v_t' = f v_t); rest_speed > 0 then lets the ball slide",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0, f=0.5), rest_speed=0.25, elements=(floor(),)),
        position=(-2.0, 1 + R),
        velocity=(1.0, 0.0),
        script=(3.0,),
        rows="floor bounce, floor begin",
        expect=(*at(0.0, R, NEAR), *going(0.5, 0.0, 4 * ULP)),
    ),
    Case(
        name="ceiling with b = 0",
        why="no adhesion: one hit at v = 1, f acts, then free fall from there",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0, f=0.5), elements=(floor(2.0),)),
        position=(-1.0, 2 - R - 0.75),
        velocity=(1.0, 2.0),
        script=(1.5,),
        rows="floor bounce",
        expect=(*at(0.0, 2 - R - 1.0, NEAR), *going(0.5, -2.0, 8 * ULP)),
    ),
    Case(
        name="no gravity: b = 0 flies on along the wall",
        why="law: normal speed gone, v_t' = f v_t; nothing presses, so there is no contact",
        scene=Scene(gravity=(0, 0), ball=Ball(radius=R, b=0, f=0.5), elements=(floor(),)),
        position=(-1.0, 1 + R),
        velocity=(1.0, -1.0),
        script=(3.0,),
        rows="floor bounce",
        expect=(*at(1.0, R, NEAR), *going(0.5, 0.0, 0.0), speed(0.5, 0.0)),
    ),
]
