"""What happens in the tail of an accumulation of bounces, at hand-overs and edges: the places where one rule ends."""

import math

import mpmath

from bounce_env.report.stability.case import ULP, Case, at, between, count, going, last_time, of_row, resting, when
from bounce_env.report.stability.cases.drops import C30, LAST_HOPS, NEAR, REST, S30, G, R, floor, on_slope
from bounce_env.scene import Ball, Field, Scene, Sensor, Wall

DROP = Scene(gravity=(0, -G), ball=Ball(radius=R, b=0.5), elements=(floor(),))


def _in_the_tail(name: str, before: float, commands: tuple, rows: str, *expect) -> Case:
    """A drop from 1 m with b = 0.5, interrupted `before` seconds before it rests: in the hops that are summed."""
    return Case(
        name=name,
        why="hops no higher than 1e-14 m are left: what is done to the ball finds it on the floor, as good as at rest",
        scene=DROP,
        position=(0.0, 1 + R),
        script=(REST - before, *commands),
        rows=rows,
        expect=expect,
    )


def _off_the_end(name: str, off: float) -> Case:
    """Bounces down a slope whose end comes `off` m before (< 0: behind) the place where they would accumulate.

    From the slope itself with v_n = 1.5, v_t = 0.75 m/s, b = 0.5, f = 1: hit k at T_k = tau (1 - b^k) / (1 - b), at
    v_t T + g_t T^2 / 2 down the slope. The last hit before the end is followed by a flight past it.
    """
    b, vn, vt = mpmath.mpf(0.5), 1.5, 0.75
    with mpmath.workdps(40):
        g_n, g_t = G * mpmath.mpf(C30), G * mpmath.mpf(S30)
        tau = 2 * vn / g_n
        rest = tau / (1 - b)

        def way(t):
            return vt * t + g_t * t * t / 2

        end = float(way(rest) - off)
        hits = [tau * (1 - b**k) / (1 - b) for k in range(1, 60)]
        last = max(t for t in hits if way(t) < end) if off > 0 else rest
        n = sum(way(t) < end for t in hits)
        now = last + mpmath.mpf(0.25)
        s = float(way(now))
        v_left = vn * b**n if off > 0 else mpmath.mpf(0)
        flown = now - last if off > 0 else now - (mpmath.sqrt(vt * vt + 2 * g_t * end) - vt) / g_t
        y = float(v_left * flown - g_n * flown**2 / 2)
    top = on_slope(-1.5, 0.0)
    return Case(
        name=f"bounces down a slope that ends {name} they accumulate",
        why="the series of check 2, cut off where the wall ends: then a flight from the last hit, or from the end",
        scene=Scene(
            gravity=(0, -G), ball=Ball(b=0.5), elements=(Wall(on_slope(-2.5, 0), on_slope(end - 1.5, 0), name="slope"),)
        ),
        position=top,
        velocity=(vt * C30 + vn * S30, -vt * S30 + vn * C30),
        script=(float(now),),
        rows="(slope bounce, )+slope bounce" if off > 0 else "(slope bounce, )+slope begin, slope end",
        expect=(
            *at(*on_slope(s - 1.5, y), 4 * NEAR if off > 1e-6 else 2 * LAST_HOPS),
            *((count("slope bounce", n),) if off > 1e-6 else ()),
        ),
    )


def _tail_and_field(name: str, x: float) -> Case:
    """A field's border is reached at (1 + x) of the rest time; in it gravity is half."""
    half = Field(((1, -1), (3, -1), (3, 2), (1, 2)), (0.0, G / 2), name="field")
    return Case(
        name=f"hops on a floor end {name} a field begins",
        why="rest time of the drop; the field's weaker gravity can only lengthen what is left of the last hops",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0.5), elements=(floor(), half)),
        position=(1 - REST * (1 + x), 1 + R),
        velocity=(1.0, 0.0),
        script=(REST + 1.0,),
        rows="(floor bounce, )+floor begin",
        expect=(
            when("floor begin", REST, 1e-12 if x > 0 else 8 * LAST_HOPS),
            *at(1 - REST * (1 + x) + REST + 1, R, NEAR),
            *going(1.0, 0.0, 4 * ULP),
        ),
    )


def _joint(gap: float, r: float) -> Case:
    """Two walls of one floor whose ends miss each other by `gap` (< 0: overlap), a few units in the last place."""
    return Case(
        name=f"sliding over a joint that gapes by {gap:g}, r={r}",
        why="what is no more than round-off is no gap: one floor",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=r),
            elements=(Wall((-3, 0), (0.3, 0), b=0.5, name="left"), Wall((0.3 + gap, 0), (3, 0), b=0.5, name="right")),
        ),
        position=(-0.7, r),
        velocity=(1.0, 0.0),
        script=(3.0,),
        rows="left begin, left end, right begin",
        expect=(*at(2.3, r, NEAR), *going(1.0, 0.0, 4 * ULP)),
    )


def _hardly(name: str, angle: float, seconds: float) -> Case:
    """A slope at a tiny angle from level or upright."""
    c, s = math.cos(angle), math.sin(angle)
    return Case(
        name=f"slide on a slope that is nearly {name}",
        why="g sin(angle) along the wall, whatever the angle",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R, b=0.5),
            elements=(Wall((-3 * c, 3 * s), (3 * c, -3 * s), name="slope"),),
        ),
        position=(-2.5 * c + R * s, 2.5 * s + R * c),
        script=(seconds,),
        rows="slope begin",
        expect=at((s * seconds**2 - 2.5) * c + R * s, (2.5 - s * seconds**2) * s + R * c, NEAR + 4 * ULP * seconds**2),
    )


def roof(slope: float = 1.0) -> tuple[Wall, Wall]:
    return Wall((-2, -2 * slope), (0, 0), name="left"), Wall((0, 0), (2, -2 * slope), name="right")


TAILS = [
    _in_the_tail(
        "stop in the tail of a drop and go on",
        1e-8,
        (1.0,),
        "(floor bounce, )+floor begin",
        when("floor begin", REST, 1e-12),
        *resting(0, R, NEAR),
    ),
    _in_the_tail(
        "push upwards in the tail of a drop",
        1e-8,
        (("push", (0.25, 1.0)), 0.125),
        "(floor bounce, )*floor bounce",
        *at(0.03125, R + 0.125 - G / 128, LAST_HOPS),
        *going(0.25, 1 - G / 8, 4 * LAST_HOPS * G),
    ),
    _in_the_tail(
        "push along the floor in the tail of a drop",
        1e-8,
        (("push", (0.25, 0.0)), 1.0),
        "(floor (bounce|begin|end), )+floor begin",
        last_time(REST, 4 * LAST_HOPS),
        *at(0.25, R, NEAR),
        *going(0.25, 0.0, 0.0),
    ),
    _in_the_tail(
        "disable the floor in the tail of a drop",
        1e-8,
        (("enable", "floor", False), 0.5),
        "(floor bounce, )*floor bounce",
        *at(0.0, R - G / 8, LAST_HOPS),
    ),
    _in_the_tail(
        "disable the floor the moment the ball rests",
        0.0,
        (("enable", "floor", False), 0.5),
        "(floor bounce, )+floor (bounce|begin, floor end)",
        *at(0.0, R - G / 8, LAST_HOPS),
    ),
    _off_the_end("long before", 0.0625),
    _off_the_end("before", 1e-4),
    _off_the_end("just before", 1e-9),
    _off_the_end("just behind where", -1e-9),
    _off_the_end("behind where", -1e-4),
    *(
        _tail_and_field(name, x)
        for name, x in (("just before", 1e-9), ("just after", -1e-9), ("after", -1e-8), ("before", 1e-4))
    ),
    *(_joint(gap, r) for gap in (5.6e-17, -5.6e-17, 4e-16, -4e-16) for r in (0.0, R)),
    _hardly("level", 1e-6, 1000.0),
    _hardly("level, 1e-3", 1e-3, 40.0),
    _hardly("upright", math.pi / 2 - 1e-6, 1.5),
    _hardly("upright, 1e-9", math.pi / 2 - 1e-9, 1.5),
    Case(
        name="sensor crossed in the tail of a drop",
        why="the way along the floor is uniform throughout: crossed 1e-8 s before the rest",
        scene=Scene(
            gravity=(0, -G), ball=Ball(radius=R, b=0.5), elements=(floor(), Sensor((1, -1), (1, 1), name="line"))
        ),
        position=(1 - (REST - 1e-8), 1 + R),
        velocity=(1.0, 0.0),
        script=(REST + 1,),
        rows="(floor bounce, )+line cross, floor begin",
        expect=(when("line cross", REST - 1e-8, 8 * ULP), when("floor begin", REST, 1e-12)),
    ),
    Case(
        name="kick with a threshold above all that comes",
        why="as without a kick: numerics.md, check 1",
        scene=Scene(
            gravity=(0, -G), ball=Ball(radius=R, b=0.5), max_speed=100, elements=(floor(kick=1.0, kick_threshold=10.0),)
        ),
        position=(0.0, 1 + R),
        script=(REST + 1,),
        rows="(floor bounce, )+floor begin",
        expect=(when("floor begin", REST, 1e-12), *resting(0.0, R, NEAR)),
    ),
    Case(
        name="faster than the cap in flight",
        why="contract: the cap is for bounces: hit at 2 (20)^(1/2), leaves with 5, and rises 25 / (2 g)",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R), max_speed=5.0, elements=(floor(),)),
        position=(0.0, 20 + R),
        script=(math.sqrt(20) + 2.5,),
        rows="floor bounce",
        expect=(of_row("floor bounce", "vy0", -2 * math.sqrt(20), 16 * ULP), *at(0.0, 6.25 + R, 8 * NEAR)),
    ),
    *(
        Case(
            name=f"at rest on the peak of a roof, r={r}",
            why="static by symmetry: the normals carry the weight",
            scene=Scene(gravity=(0, -G), ball=Ball(radius=r, b=0.5), elements=roof()),
            position=(0.0, r),
            script=(10.0,),
            rows="(left|right) begin",
            expect=resting(0.0, r, NEAR),
        )
        for r in (0.0, R)
    ),
    Case(
        name="dropped on the peak of a roof",
        why="the normal is upright: numerics.md, check 1; the last hops are left out",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=R, b=0.5), elements=roof()),
        position=(0.0, 1 + R),
        script=(10.0,),
        rows="((left|right) bounce, )+(left|right) begin",
        expect=(last_time(REST, 4 * LAST_HOPS), *resting(0.0, R, NEAR)),
    ),
    *(
        Case(
            name=f"slowly over the edge of a roof, b={b}",
            why="v^2 < g r: rolls around the edge by small hops, then slides: energy is at most the start's",
            scene=Scene(
                gravity=(0, -2), ball=Ball(radius=R, b=b), elements=(Wall((-3, 0), (0, 0), name="left"), roof()[1])
            ),
            position=(-0.5, R),
            velocity=(0.125, 0.0),
            script=(5.5,),
            expect=(
                between("x", lambda run: run.position[0], 0.05, 3.5),
                between(
                    "energy",
                    lambda run: math.hypot(*run.velocity) ** 2 / 2 + 2 * run.position[1],
                    -4.0,
                    (0.125**2 / 2 + 2 * R) * 1.001,
                ),
            ),
        )
        for b in (0.0, 0.5)
    ),
    Case(
        name="enable a wall that the ball is in",
        why="contract: ValueError, nothing has changed",
        scene=Scene(gravity=(0, 0), ball=Ball(radius=R), elements=(floor(), Wall((1, -1), (1, 1), name="gate"))),
        position=(0.0, R),
        velocity=(1.0, 0.0),
        script=(("enable", "gate", False), 1.0, ("enable", "gate", True), 1.0),
        refused="overlaps.*gate",
    ),
    Case(
        name="enable a wall that the ball just touches",
        why="touching is not overlapping: it is a wall from then on, and the ball is turned back at once",
        scene=Scene(gravity=(0, 0), ball=Ball(radius=R), elements=(floor(), Wall((1, -1), (1, 1), name="gate"))),
        position=(0.0, R),
        velocity=(1.0, 0.0),
        script=(("enable", "gate", False), 1.0 - R, ("enable", "gate", True), 0.5),
        rows="gate bounce",
        expect=(*at(0.5 - R, R, NEAR), *going(-1.0, 0.0, 0.0)),
    ),
]
