"""Drops in every direction, slopes, and accumulating bounces. G is gravity, R the disc's radius."""

import math
from typing import Any

import mpmath

from bounce_env.report.stability.case import ULP, Case, at, between, count, going, of_row, resting, when
from bounce_env.scene import Ball, Scene, Wall

G, R = 9.81, 0.125
SIZE = 4.0  # [m] extent of the scenes here, rounded up to a power of two
TOUCH = 16 * ULP * SIZE  # [m] a hop no higher than this is not followed any more
CORNER = 64 * TOUCH  # [m] the same in corners and hollows; what is no further away then counts as touched
NEAR = 64 * ULP * SIZE  # [m] some ten roundings of a length
LAST_HOPS = 1.01 * math.sqrt(8 * TOUCH / G)  # [s] duration of the highest hop that is not followed, and a little

C30, S30 = math.sqrt(0.75), 0.5


def floor(y: float = 0.0, **surface: Any) -> Wall:
    return Wall((-3, y), (3, y), name="floor", **surface)


def slope(**surface: Any) -> Wall:
    """Down to the right by 30 degrees, 7 m long, through the origin; turned exactly as its ends are rounded."""
    return Wall((-3.5 * C30, 3.5 * S30), (3.5 * C30, -3.5 * S30), name="slope", **surface)


def on_slope(along: float, off: float) -> tuple[float, float]:
    """The point `along` m down the slope from its middle and `off` m above it."""
    return along * C30 + off * S30, -along * S30 + off * C30


def rest_time(h: float, e: float, g: float = G) -> float:
    return math.sqrt(2 * h / g) * (1 + e) / (1 - e)


def hops(h: float, e: float) -> int:
    """How many bounces a drop from `h` makes until a hop rises no higher than TOUCH."""
    return math.ceil(math.log(TOUCH / h) / (2 * math.log(e)))


def _drop(e: float, r: float) -> Case:
    rest = rest_time(1.0, e)
    return Case(
        name=f"drop e={e} r={r}",
        why="geometric series, rest at sqrt(2 h / g) (1 + e) / (1 - e), hop n rises h e^(2n)",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=r, b=e), elements=(floor(),)),
        position=(0.25, 1 + r),
        script=(rest + 1.0,),
        rows="(floor bounce, )+floor begin",
        expect=(
            when("floor begin", rest, 1e-12 * rest),
            count("floor bounce", hops(1.0, e), 1),
            *resting(0.25, r, NEAR),
        ),
    )


def _drop_that_does_not_rest(seconds: float, e: float) -> Case:
    """Bounce n at t1 (1 + 2 e (1 - e^(n-1)) / (1 - e)); written with 30 digits, since 1 - e cancels."""
    with mpmath.workdps(30):
        e_, t1 = mpmath.mpf(e), mpmath.sqrt(2 / mpmath.mpf(G))
        n = 1 + int(mpmath.log(1 - (seconds / t1 - 1) * (1 - e_) / (2 * e_)) / mpmath.log(e_))
        last = float(t1 * (1 + 2 * e_ * (1 - e_ ** (n - 1)) / (1 - e_)))
    return Case(
        name=f"drop e={e} does not rest early",
        why="geometric series: rest only after 9e5 s",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=e), elements=(floor(),)),
        position=(0.0, 1 + R),
        script=(seconds,),
        rows="(floor bounce, )+floor bounce",
        expect=(count("floor bounce", n), when("floor bounce", last, seconds * 4 * n * ULP, -1)),
    )


def _elastic(bounces: int) -> Case:
    h = 0.7
    period = 2 * math.sqrt(2 * h / G)
    return Case(
        name=f"{bounces} elastic bounces",
        why="energy is conserved: v^2 / 2 + g y is g h, so the peak is h",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R), elements=(floor(),)),
        position=(0.0, h + R),
        script=(period * (bounces + 0.25),),
        keep_ledger=False,
        expect=(
            between("peak", lambda run: run.position[1] - R + run.velocity[1] ** 2 / (2 * G), h - 1e-10, h + 1e-10),
        ),
        max_events=10 * bounces,
    )


def _sideways(name: str, gravity: tuple[float, float]) -> Case:
    """A drop of 1 m in another direction and another strength of gravity."""
    g = math.hypot(*gravity)
    down = (gravity[0] / g, gravity[1] / g)
    wall = Wall((-2 * down[1], 2 * down[0]), (2 * down[1], -2 * down[0]), name="floor")
    rest = rest_time(1.0, 0.5, g)
    return Case(
        name=f"drop under gravity {name}",
        why="the same along any direction",
        scene=Scene(gravity=gravity, ball=Ball(radius=R, b=0.5), elements=(wall,)),
        position=(-(1 + R) * down[0], -(1 + R) * down[1]),
        script=(2 * rest,),
        rows="(floor bounce, )+floor begin",
        expect=(when("floor begin", rest, 1e-12 * rest), *at(-R * down[0], -R * down[1], NEAR)),
    )


def _incline(f: float, e: float) -> Case:
    """First hop tau = 2 v_n / g_n from the slope itself; docs/physics.md, "Infinitely many bounces"."""
    vn, vt, g_n, g_t = 3 * (1 - e), 0.75, G * C30, G * S30
    tau = 2 * vn / g_n
    rest = tau / (1 - e)
    path = vt * tau / (1 - f * e) + g_t * tau**2 * (1 + f * e) / (2 * (1 - f * e) * (1 - e**2))
    later = 0.25
    v = vt + g_t * rest if f == 1 else 0.0
    end = path + (v * later + g_t * later**2 / 2 if f == 1 else 0.0)
    final = v + g_t * later if f == 1 else 0.0
    return Case(
        name=f"Zeno on a slope e={e} f={f}",
        why="sum of a geometric series; then it slides at g / 2 (f = 1) or is held (f < 1)",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=e, f=f), elements=(slope(),)),
        position=on_slope(-1.5, R),
        velocity=(vt * C30 + vn * S30, -vt * S30 + vn * C30),
        script=(rest + later,),
        rows="(slope bounce, )+slope begin",
        expect=(
            when("slope begin", rest, 1e-13 * rest),
            *at(*on_slope(end - 1.5, R), NEAR),
            *going(final * C30, -final * S30, NEAR),
        ),
    )


REST = rest_time(1.0, 0.5)  # [s] of a drop from 1 m
HIT = math.sqrt(2 / G)  # [s] its first hit
FALL = math.sqrt(20 / G)  # [s] of a fall of 10 m


DROPS = [
    *(_drop(e, r) for e in (0.1, 0.5, 0.9, 0.99) for r in (0.0, R)),
    _drop_that_does_not_rest(1000.0, 0.999999),
    _elastic(1_000_000),
    *(
        _sideways(name, gravity)
        for name, gravity in (
            ("to the left", (-G, 0.0)),
            ("upwards", (0.0, G)),
            ("askew", (3.0, -4.0)),
            ("of 1e3", (0.0, -1e3)),
            ("of 1e-6", (1e-6, 0.0)),
        )
    ),
    *(_incline(f, e) for f, e in ((1.0, 0.5), (0.75, 0.5), (1.0, 0.9), (0.5, 0.1))),
    Case(
        name="b = 0 from 10 m",
        why="law: the normal speed is gone at the first hit, at sqrt(2 h / g); f = 1 slides on",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0), elements=(floor(),)),
        position=(-1.0, 10 + R),
        velocity=(0.5, 0.0),
        script=(FALL + 1.0,),
        rows="floor bounce, floor begin",
        expect=(
            when("floor begin", FALL, 4 * ULP),
            *at(-1 + 0.5 * (FALL + 1), R, NEAR),
            *going(0.5, 0.0, 4 * ULP),
        ),
    ),
    Case(
        name="b = 0 on a slope of 30 degrees from rest",
        why="slides at g sin 30 = g / 2",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0), elements=(slope(),)),
        position=on_slope(-1.5, R),
        script=(0.75,),
        rows="slope begin",
        expect=(
            *at(*on_slope(-1.5 + G / 4 * 0.75**2, R), NEAR),
            *going(G / 2 * 0.75 * C30, -G / 2 * 0.75 * S30, NEAR),
        ),
    ),
    Case(
        name="b = 0 dropped on a slope of 30 degrees",
        why="the hit leaves v sin 30 along the slope, then it slides at g / 2",
        scene=Scene(gravity=(0, -G), ball=Ball(b=0), elements=(slope(),)),
        position=(on_slope(-1.5, 0)[0], on_slope(-1.5, 0)[1] + 1),
        script=(HIT + 0.25,),
        rows="slope bounce, slope begin",
        expect=at(*on_slope(-1.5 + S30 * G * HIT * 0.25 + G / 4 * 0.25**2, 0.0), NEAR),
    ),
    Case(
        name="Zeno on the way to a wall",
        why="floor and wall are upright to each other: rest time as if alone, way along the floor folded at the wall",
        scene=Scene(
            gravity=(0, -G),
            ball=Ball(radius=R),
            elements=(floor(b=0.5), Wall((1, 0), (1, 3), name="wall")),
        ),
        position=(0.0, 1 + R),
        velocity=(1.0, 0.0),
        script=(2.0,),
        rows="(floor bounce, )+wall bounce, (floor bounce, )*floor begin",
        expect=(when("floor begin", REST, 1e-12), *at(2 * (1 - R) - 2.0, R, NEAR), *going(-1.0, 0.0, 8 * ULP)),
    ),
    *(
        Case(
            name=f"Zeno ends {name} the ball is at a wall",
            why="as above, with the wall met at (1 + x) of the rest time",
            scene=Scene(
                gravity=(0, -G),
                ball=Ball(radius=R),
                elements=(floor(b=0.5), Wall((1, 0), (1, 3), name="wall")),
            ),
            position=(1 - R - REST * (1 + x), 1 + R),
            velocity=(1.0, 0.0),
            script=(2.0,),
            # A bounce between the last hop that is followed and the accumulation may be before it or after it.
            rows="(floor (bounce|begin|end), |wall bounce, )+(floor begin|wall bounce)",
            expect=(
                count("wall bounce", 1),
                when("wall bounce", REST * (1 + x), 1e-13),
                when("floor begin", REST, 1e-12 + LAST_HOPS, -1),
                *at(2 * (1 - R) - (1 - R - REST * (1 + x) + 2.0), R, NEAR),
            ),
        )
        for name, x in (("just after", -1e-9), ("just before", 1e-9), ("when", 0.0), ("a little after", -1e-5))
    ),
    Case(
        name="b = 2 floor up to the cap",
        why="law, then cap: v 2^n, and 100 m/s from then on",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, b=2), max_speed=100.0, elements=(floor(),)),
        position=(0.0, 1 + R),
        script=(1000.0,),
        rows="(floor bounce, )+floor bounce",
        expect=(
            *(of_row("floor bounce", "vy1", min(2.0 ** (n + 2), 100.0), 1e-12, n) for n in range(8)),
            of_row("floor bounce", "vy1", 100.0, 1e-12, -1),
        ),
    ),
]
