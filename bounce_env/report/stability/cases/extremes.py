"""Grazes, huge and tiny speeds, walls' ends, places and times far away."""

import math

import mpmath

from bounce_env.report.stability.case import ULP, Case, at, between, count, going, of_row, resting, speed, when
from bounce_env.report.stability.cases.drops import NEAR, G, R, floor, rest_time
from bounce_env.scene import Ball, Bumper, Scene, Wall

FREE = (0.0, 0.0)
FAR = 1e8


def _graze(side: int, r: float) -> Case:
    """Past a bumper at its radius +- 1e-12; a hit at the offset s turns by pi - 2 asin(s / rho)."""
    rho = 1 + r
    y = rho + side * 1e-12
    hit = side < 0
    with mpmath.workdps(40):
        alpha = mpmath.asin(mpmath.mpf(y) / rho) if hit else 0
        vx, vy = (float(-mpmath.cos(2 * alpha)), float(mpmath.sin(2 * alpha))) if hit else (1.0, 0.0)
    # The angle to the tangent is sqrt(2 d / rho), d known to two units in the last place of rho.
    within = 4 * ULP * rho / math.sqrt(2e-12 / rho)
    return Case(
        name=f"graze by {side * 1e-12:g}, r={r}",
        why="law at the angle asin(s / rho), computed with 40 digits; outside of the radius there is no hit",
        scene=Scene(gravity=FREE, ball=Ball(radius=r), elements=(Bumper((0, 0), 1, name="bumper"),)),
        position=(-3.0, y),
        velocity=(1.0, 0.0),
        script=(4.0,),
        rows="bumper bounce" if hit else "",
        expect=(*going(vx, vy, within if hit else 0.0), between("x", lambda run: run.position[0], 0.9, 1 + 1e-12)),
    )


def _graze_under_gravity(side: int) -> Case:
    """The peak of a parabola at the lowest point of a bumper, 1e-12 short of it or beyond it."""
    g, r, rise = 2.0, R, 1.0
    y = -1 - r - rise + side * 1e-12
    return Case(
        name=f"peak {side * 1e-12:g} m into a bumper" if side > 0 else f"peak {-side * 1e-12:g} m below a bumper",
        why="hit or missed by a thousand units of round-off; a hit turns the remaining 2e-6 m/s and little else",
        scene=Scene(gravity=(0, -g), ball=Ball(radius=r), elements=(Bumper((0, 0), 1, name="bumper"),)),
        position=(0.0, y),
        velocity=(0.0, 2.0),
        script=(2.0,),
        rows="bumper bounce" if side > 0 else "",
        # v at the hit is sqrt(2 g 1e-12) = 2e-6, so the ball is back earlier by twice its time to the peak.
        expect=(*at(0.0, y, 1e-5 if side > 0 else NEAR), going(0.0, -2.0, 1e-5 if side > 0 else NEAR)[1]),
    )


def _far(r: float) -> Case:
    """At x = 1e8 a position has steps of 1.5e-8 m across, but the drop is along y."""
    rest = rest_time(1.0, 0.5)
    wall = Wall((FAR - 3, 0), (FAR + 3, 0), name="floor")
    return Case(
        name=f"drop at x = 1e8, r={r}",
        why="numerics.md, check 1: the offset plays no part in y",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=r, b=0.5), elements=(wall,)),
        position=(FAR, 1 + r),
        script=(rest + 1,),
        rows="(floor bounce, )+floor begin",
        expect=(when("floor begin", rest, 1e-12 * rest), *resting(FAR, r, NEAR)),
        exact_scaling=False,  # at the edge of the numbers that a scene may have
    )


def _far_corner() -> Case:
    """Elastic in a box of 2 m at x = y = 1e8, without gravity: 100 hits."""
    low, high = FAR, FAR + 2
    corners = ((low, low), (high, low), (high, high), (low, high))
    walls = tuple(
        Wall(p, q, name=f"w{k}") for k, (p, q) in enumerate(zip(corners, (*corners[1:], corners[0]), strict=True))
    )
    return Case(
        name="box at x = y = 1e8",
        why="unfolding: triangle waves in x and y; each hit may round the place by the steps of 1e8 (1.5e-8 m)",
        scene=Scene(gravity=FREE, ball=Ball(radius=R), elements=walls),
        position=(FAR + 1, FAR + 1),
        velocity=(0.875, 1.75),
        script=(64.0,),
        expect=(  # ways of 56 and 112 m, folded at 1.75 m: 32 and 64 times
            *at(FAR + 1, FAR + 1, 100 * math.ulp(FAR)),
            *going(0.875, 1.75, 0.0),
        ),
        exact_scaling=False,
    )


def _thin(r: float, v: float) -> Case:
    """A wall has no thickness; the ball passes its place in 1e-9 s or less."""
    return Case(
        name=f"{v:g} m/s at a thin wall, r={r}",
        why="the hit is computed, not sampled: turned back at the wall",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=r), elements=(Wall((0, -3), (0, 3), name="wall"),)),
        position=(-1.0 - r, 0.0),
        velocity=(v, 0.0),
        script=(2.0 / v,),
        rows="wall bounce",
        expect=(
            when("wall bounce", 1 / v, 4 * ULP / v),
            *at(-1 - r, 0.0, max(NEAR, G * 2 / v**2)),
            *going(-v, 0.0, 20 / v),
        ),
    )


_SLOW = 2.0**-20


EXTREMES = [
    *(
        Case(
            name=f"along the line of a wall onto its end, point, gravity {g}",
            why="a point has no width and a wall's end no side: it flies on (falls on) along the wall",
            scene=Scene(
                gravity=(0, -g), elements=(Wall((0, -3), (0, 0), name="wall"), Wall((-3, 3), (3, 3), name="roof"))
            ),
            position=(0.0, 2.0),
            velocity=(0.0, -1.0),
            script=(3.0,),
            rows="",
            expect=at(0.0, -1.0 - 4.5 * g, NEAR),
        )
        for g in (0.0, 0.25)
    ),
    Case(
        name="segment end dead centre, disc",
        why="the end's normal is against the velocity: straight back",
        scene=Scene(gravity=FREE, ball=Ball(radius=R), elements=(Wall((0, -3), (0, 0), name="wall"),)),
        position=(0.0, 1 + R),
        velocity=(0.0, -1.0),
        script=(3.0,),
        rows="wall bounce",
        expect=(when("wall bounce", 1.0, 2 * ULP), *at(0.0, 2 + R, NEAR), *going(0.0, 1.0, 0.0)),
    ),
    Case(
        name="segment end from the side, point",
        why="the end belongs to the wall",
        scene=Scene(gravity=FREE, elements=(Wall((0, -3), (0, 0), name="wall"),)),
        position=(-1.0, 0.0),
        velocity=(1.0, 0.0),
        script=(2.0,),
        rows="wall bounce",
        expect=(*at(-1.0, 0.0, NEAR), *going(-1.0, 0.0, 0.0)),
    ),
    *(_graze(side, r) for side in (1, -1) for r in (0.0, R)),
    *(_graze_under_gravity(side) for side in (1, -1)),
    *(_thin(r, v) for r in (0.0, R) for v in (1e6, 1e9)),
    Case(
        name="1e-9 m/s",
        why="uniform: 1e-6 m takes 1000 s",
        scene=Scene(gravity=FREE, ball=Ball(radius=R), elements=(floor(),)),
        position=(0.0, R + 1e-6),
        velocity=(0.0, -1e-9),
        script=(1500.0,),
        rows="floor bounce",
        # R + 1e-6 is known to a unit in the last place of R, which is 1e-10 of the way.
        expect=(when("floor bounce", 1000.0, 1e9 * ULP), *at(0.0, R + 5e-7, NEAR), *going(0.0, 1e-9, 0.0)),
    ),
    *(_far(r) for r in (0.0, R)),
    _far_corner(),
    Case(
        name="1e9 s between two walls",
        why="unfolding: 2 m there and back in 2^21 s, without drift; 476 whole rounds and 0.837 of one",
        scene=Scene(
            gravity=FREE,
            ball=Ball(radius=R),
            elements=(Wall((-1 - R, -3), (-1 - R, 3), name="left"), Wall((1 + R, -3), (1 + R, 3), name="right")),
        ),
        position=(-1.0, 0.0),
        velocity=(2 * _SLOW, 0.0),
        script=(1e9,),
        rows="(right bounce, left bounce, ){476}right bounce",
        expect=(*at(-1 + 4 - (1e9 * 2 * _SLOW) % 4, 0.0, 1000 * NEAR), *going(-2 * _SLOW, 0.0, 0.0)),
    ),
    Case(
        name="1e9 s at rest, then a hop",
        why="static; then v t - g t^2 / 2 from the push, to the last digits although the clock shows 1e9 s",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=0.5), elements=(floor(),)),
        position=(0.0, R),
        script=(1e9, ("push", (0.25, 1.0)), 0.75),
        rows="floor begin, floor end",
        expect=(*at(0.1875, R + 0.1875, NEAR), *going(0.25, -0.5, 4 * ULP)),
    ),
    Case(
        name="1e9 s of an elastic drop in slow motion",
        why="dyadic: hits at odd multiples of 2^20 s, so at 952 x 2^20 s the ball is at its peak",
        scene=Scene(gravity=(0, -(2.0**-39)), ball=Ball(radius=R), elements=(floor(),)),
        position=(0.0, 1 + R),
        script=(952 * 2.0**20,),
        rows="(floor bounce, ){475}floor bounce",
        expect=(*at(0.0, 1 + R, NEAR), *going(0.0, 0.0, 1e-9 * NEAR)),
    ),
    Case(
        name="tiny ball in a large scene",
        why="numerics.md, check 1, with a disc of 2e-6 of the scene's size",
        scene=Scene(
            gravity=(0, -G), ball=Ball(radius=1e-5, b=0.5), elements=(floor(), Wall((-3, 0), (-3, 3), name="wall"))
        ),
        position=(0.5, 1 + 1e-5),
        script=(10.0,),
        rows="(floor bounce, )+floor begin",
        expect=(when("floor begin", rest_time(1.0, 0.5), 1e-12), *resting(0.5, 1e-5, NEAR)),
    ),
    Case(
        name="two walls that speed the ball up",
        why="numerics.md, check 7: blow-up at (d / v) b / (b - 1) = 3 s, kept finite by the cap",
        scene=Scene(
            gravity=FREE,
            max_speed=1e3,
            elements=(Wall((-0.5, -3), (-0.5, 3), b=1.5, name="left"), Wall((0.5, -3), (0.5, 3), b=1.5, name="right")),
        ),
        position=(-0.5, 0.0),
        velocity=(1.0, 0.0),
        script=(2.9,),
        expect=(
            *(when("right bounce", 3 * (1 - 1.5 ** -(2 * n + 1)), 64 * ULP, n) for n in range(4)),
            count("right bounce", 4),  # hit n at 3 (1 - 1.5^-n) s: eight until 2.9 s
            speed(1.5**8, 1e-12),
        ),
    ),
    Case(
        name="b = 1e9",
        why="law, then cap",
        scene=Scene(gravity=(0, -2), max_speed=1e9, elements=(floor(b=1e9),)),
        position=(0.0, 1.0),
        velocity=(0.0, 0.0),
        script=(1.5,),
        rows="floor bounce",
        expect=(of_row("floor bounce", "vy1", 1e9, 1e-6),),
        exact_scaling=False,
    ),
]
