"""Corners: several walls at one instant, and walls twice in the same place."""

import math

from bounce_env.report.stability.case import ULP, Case, Point, at, count, going, last_time, of_row, resting, speed, when
from bounce_env.report.stability.cases.drops import CORNER, NEAR, G, R, floor, rest_time
from bounce_env.scene import Arc, Ball, Bumper, Scene, Wall

HALF = math.sqrt(0.5)


def left_out(g: float, pull: float, e: float) -> float:
    """How much [s] of the last hops may be left out in a corner, where no accumulation is jumped to.

    Bounces are followed while v^2 > 2 g CORNER; then there are hops of 2 v / pull, shorter by e each.
    """
    return 1.01 * 2 * math.sqrt(2 * g * CORNER) / pull / (1 - e)


def documented_order(v: Point, surfaces: list[tuple[Point, float]]) -> Point:
    """Fastest closing first, two alike as one, until none closes: bounces off (normal, b), f = 1, at one instant."""
    for _ in range(32):
        closing = [(round(-v[0] * n[0] - v[1] * n[1], 12), -k) for k, (n, _) in enumerate(surfaces)]
        best, k = max(closing)
        if best <= 1e-12:
            break
        if [c for c, _ in closing] == [best, best] and surfaces[0][1] == surfaces[1][1]:
            v = (-surfaces[0][1] * v[0], -surfaces[0][1] * v[1])
            continue
        n, b = surfaces[-k]
        v = (v[0] + (1 + b) * best * n[0], v[1] + (1 + b) * best * n[1])
    return v


def _wall_and_bumper(vx: float, b_floor: float, b_bumper: float, order: int) -> Case:
    """A disc reaches floor and bumper at t = 1; their normals are (0, 1) and (-0.6, 0.8)."""
    elements = (floor(b=b_floor), Bumper((0.6 * 0.75, 0.25 - 0.8 * 0.75), 0.5, b=b_bumper, name="bumper"))
    surfaces: list[tuple[Point, float]] = [((0.0, 1.0), b_floor), ((-0.6, 0.8), b_bumper)]
    v = documented_order((vx, -1.0), surfaces[::order])
    return Case(
        name=f"wall b={b_floor} and bumper b={b_bumper} at one instant, vx={vx}, order {order}",
        why="contract: fastest closing first, two alike as one, until none closes; computed here by the law",
        scene=Scene(gravity=(0, 0), ball=Ball(radius=0.25), max_speed=1e3, elements=elements[::order]),
        position=(-vx, 1.25),
        velocity=(vx, -1.0),
        script=(1.5,),
        rows="((floor|bumper) bounce, )*(floor|bumper) bounce",
        expect=(*going(*v, 16 * ULP), *at(0.5 * v[0], 0.25 + 0.5 * v[1], NEAR)),
    )


def _corner(off: float, r: float, b: tuple[float, float]) -> Case:
    """Floor and upright wall, hit on the diagonal or a little off it."""
    return Case(
        name=f"corner {off:g} off the diagonal, b={b}, r={r}",
        why="upright to each other: each wall turns its own component, in either order",
        scene=Scene(
            gravity=(0, 0), ball=Ball(radius=r), elements=(floor(b=b[0]), Wall((-3, 0), (-3, 3), b=b[1], name="wall"))
        ),
        position=(-2 + r, 1 + r + off),
        velocity=(-1.0, -1.0),
        script=(2.0,),
        rows="floor bounce, wall bounce|wall bounce, floor bounce",
        expect=(*at(-3 + r + b[1], r + b[0], NEAR + 2 * abs(off)), *going(b[1], b[0], 4 * ULP)),
    )


CORNERS = [
    *(_corner(off, r, b) for off in (0.0, 1e-15, -1e-15) for r in (0.0, R) for b in ((1.0, 1.0), (0.5, 0.25))),
    *(
        _wall_and_bumper(vx, *b, order)
        for vx in (0.5, 2.0, 1 / 3)
        for b in ((1.0, 1.0), (0.5, 2.0), (0.0, 1.0))
        for order in (1, -1)
    ),
    Case(
        name="duplicated floor",
        why="a tie: the first element bounces, then the second is not closed on; rest as on one floor",
        scene=Scene(
            gravity=(0, -G),
            ball=Ball(radius=R),
            elements=(floor(b=0.5), Wall((-3, 0), (3, 0), b=0.25, name="twin")),
        ),
        position=(0.5, 1 + R),
        script=(10.0,),
        rows="(floor bounce, )+(floor|twin) begin(, (floor|twin) begin)?",
        expect=(last_time(rest_time(1.0, 0.5), left_out(G, G, 0.5)), *resting(0.5, R, NEAR)),
    ),
    Case(
        name="duplicated floor, turned around",
        why="as above: the same wall written from its other end",
        scene=Scene(
            gravity=(0, -G),
            ball=Ball(),
            elements=(floor(b=0.5), Wall((3, 0), (-3, 0), b=0.25, name="twin")),
        ),
        position=(0.5, 1.0),
        velocity=(0.25, 0.0),
        script=(3.0,),
        rows="(floor bounce, )+(floor|twin) begin(, (floor|twin) begin)?",
        expect=(*at(1.25, 0.0, NEAR), *going(0.25, 0.0, 8 * ULP)),
    ),
    Case(
        name="slot as wide as the ball",
        why="static: floor and two walls touched at once",
        scene=Scene(
            gravity=(0.0, -G),
            ball=Ball(radius=R),
            elements=(floor(b=0.5), Wall((-R, 0), (-R, 2), name="left"), Wall((R, 0), (R, 2), name="right")),
        ),
        position=(0.0, 1 + R),
        script=(10.0,),
        rows="(floor bounce, )+floor begin",
        expect=(last_time(rest_time(1.0, 0.5), left_out(G, G, 0.5)), *resting(0.0, R, NEAR)),
    ),
    *(
        Case(
            name=f"pressed into a right corner by slanted gravity, wall b={e}",
            why="separable: drops of their own under gx and gy, rest when the later one rests",
            scene=Scene(
                gravity=(-2.0, -8.0),
                ball=Ball(radius=R),
                elements=(floor(b=0.5), Wall((-3, 0), (-3, 3), b=e, name="wall")),
            ),
            position=(-2 + R, 1 + R),
            script=(10.0,),
            rows="((floor|wall) (bounce|begin|end), )+(floor|wall) (bounce|begin)",
            expect=(
                when("floor begin", rest_time(1.0, 0.5, 8.0), left_out(math.hypot(2, 8), 8.0, 0.5)),
                last_time(rest_time(1.0, e, 2.0), left_out(math.hypot(2, 8), 2.0, e)),
                *resting(-3 + R, R, NEAR),
            ),
        )
        for e in (0.3, 0.25)  # 0.25: the wall is hit at the very instant at which the hops on the floor end
    ),
    Case(
        name="b = 0 corner takes all",
        why="law at both walls: nothing is left of the velocity; no gravity, so no contact",
        scene=Scene(gravity=(0, 0), ball=Ball(radius=R, b=0), elements=(floor(), Wall((-3, 0), (-3, 3), name="wall"))),
        position=(-2 + R, 1 + R),
        velocity=(-1.0, -1.0),
        script=(3.0,),
        rows="floor bounce, wall bounce|wall bounce, floor bounce",
        expect=resting(-3 + R, R, NEAR),
    ),
    Case(
        name="two ends with their normals at a right angle",
        why="both ends turn the component along their own normal: exactly back",
        scene=Scene(
            gravity=(0, 0),
            ball=Ball(radius=0.25),
            elements=(
                Arc((0, 2), 2 - 0.25 * HALF, -math.pi / 2, 0, name="upper"),
                Wall((0, -0.25 * HALF), (0, -3), name="lower"),
            ),
        ),
        position=(-1 - 0.25 * HALF, 0.0),
        velocity=(1.0, 0.0),
        script=(2.0,),
        rows="(upper|lower) bounce, (upper|lower) bounce",
        expect=(*at(-1 - 0.25 * HALF, 0.0, 4 * NEAR), *going(-1.0, 0.0, 32 * ULP)),
    ),
    Case(
        name="speed cap in a corner",
        why="b = 2 at both, struck as one: (2, 2) is longer than 2, the cap shrinks it; each wall turns its component",
        scene=Scene(
            gravity=(0, 0),
            ball=Ball(radius=R, b=2),
            max_speed=2.0,
            elements=(floor(), Wall((-3, 0), (-3, 3), name="wall")),
        ),
        position=(-2 + R, 1 + R),
        velocity=(-1.0, -1.0),
        script=(1.0,),
        rows="floor bounce, wall bounce",
        expect=(speed(2.0, 8 * ULP), of_row("floor bounce", "vy1", math.sqrt(2), 8 * ULP), count("wall bounce", 1)),
    ),
]
