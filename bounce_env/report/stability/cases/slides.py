"""Sliding: along chains of walls, over joints of every angle, off ends, up ramps."""

import math
from itertools import pairwise

from bounce_env.report.stability.case import ULP, Case, at, between, count, going, resting, when
from bounce_env.report.stability.cases.drops import C30, NEAR, S30, G, R, floor
from bounce_env.scene import Arc, Ball, Bumper, Scene, Sensor, Wall

HALF = math.sqrt(0.5)


def chain(pieces: int) -> tuple[Wall, ...]:
    """Collinear walls down a slope of 30 degrees, 6 m in all; joints are rounded, so they bend by round-off."""
    joints = [(6 * k / pieces - 3) for k in range(pieces + 1)]
    points = [(s * C30, -s * S30) for s in joints]
    return tuple(Wall(p, q, b=0.5, name=f"w{k}") for k, (p, q) in enumerate(pairwise(points)))


def _chain(r: float, rest_speed: float) -> Case:
    """From rest 2.75 m up the slope; passes all joints but the first."""
    t = 1.25
    s = -2.95 + G / 4 * t * t
    hand_over = r"(, w\d+ (begin|end))*"
    return Case(
        name=f"down a chain of 30 collinear walls, r={r}, rest_speed={rest_speed}",
        why="one straight line: slides at g / 2, and no joint is felt (no bounce in the ledger)",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=r), rest_speed=rest_speed, elements=chain(30)),
        position=(-2.95 * C30 + r * S30, 2.95 * S30 + r * C30),
        script=(t,),
        rows="w0 begin" + hand_over,
        expect=(
            *at(s * C30 + r * S30, -s * S30 + r * C30, 4 * NEAR),
            *going(G / 2 * t * C30, -G / 2 * t * S30, 4 * NEAR),
            count(f"w{int((s + 3) * 5)} begin", 1),
        ),
    )


def _skim(r: float) -> Case:
    """Without gravity a ball along a chain of walls touches them all and hits none; r = 0 is on the line itself."""
    walls = tuple(Wall((3 * k - 3, k - 1), (3 * k, k), name=f"w{k}") for k in range(2))
    u, n = (3 / math.sqrt(10), 1 / math.sqrt(10)), (-1 / math.sqrt(10), 3 / math.sqrt(10))
    return Case(
        name=f"along two collinear walls without gravity, r={r}",
        why="the normal speed is zero but for round-off: uniform motion, no row",
        scene=Scene(gravity=(0, 0), ball=Ball(radius=r), elements=walls),
        position=(-2.4 + r * n[0], -0.8 + r * n[1]),
        velocity=(2 * u[0], 2 * u[1]),
        script=(2.0,),
        rows="",
        expect=(*at(-2.4 + r * n[0] + 4 * u[0], -0.8 + r * n[1] + 4 * u[1], NEAR), *going(2 * u[0], 2 * u[1], 8 * ULP)),
    )


def _table_end(r: float) -> Case:
    """v^2 > g r: gravity cannot bend the path around the end, so the ball flies off as soon as it is past it."""
    return Case(
        name=f"off the end of a table, r={r}",
        why="leaves with v at the wall's end, then a parabola; v^2 > g r, so it never meets the end again",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=r), elements=(Wall((-3, 1), (0, 1), name="table"),)),
        position=(-2.0, 1 + r),
        velocity=(2.0, 0.0),
        script=(2.0,),
        rows="table begin, table end",
        expect=(when("table end", 1.0, 4 * ULP), *at(2.0, r, NEAR), *going(2.0, -2.0, 4 * ULP)),
    )


def _convex(r: float) -> Case:
    """From a floor over an edge, from which a wall goes down by 45 degrees.

    A point is a projectile on a slope of 45 degrees: it lands after 2 v / g. A disc leaves when its centre is above the
    edge, at a distance r above the floor; relative to its landing line, r / cos 45 above the edge, it starts lower by
    r (1 / cos 45 - 1), and lands after the positive root of g t^2 / 2 - v t + r (1 / cos 45 - 1) = 0 in the frame in
    which the line falls by v t: r - g t^2 / 2 = r / cos 45 - v t.
    """
    v, g = 2.0, 2.0
    lead = r * (math.sqrt(2) - 1)
    t = (v + math.sqrt(v * v - 2 * g * lead)) / g
    lands = 1.0 + t
    along = (v + g * t) * HALF
    later = 0.5
    s = along * later + g * HALF * later**2 / 2
    x, y = v * t + s * HALF, r - g * t * t / 2 - s * HALF
    return Case(
        name=f"over a convex joint of 45 degrees, r={r}",
        why="projectile on a slope, closed form; b = 0 keeps the speed along the slope, then it slides at g sin 45",
        scene=Scene(
            gravity=(0, -g),
            ball=Ball(radius=r, b=0),
            elements=(Wall((-3, 0), (0, 0), name="floor"), Wall((0, 0), (7.5, -7.5), name="ramp")),
        ),
        position=(-v, r),
        velocity=(v, 0.0),
        script=(lands + later,),
        rows="floor begin, floor end, ramp bounce, ramp begin",
        expect=(when("ramp begin", lands, 16 * ULP), *at(x, y, 4 * NEAR)),
    )


def _concave(r: float, b: float) -> Case:
    """From a floor up a ramp of 45 degrees with b = 0: v cos 45 is left, and again when it comes back to the floor."""
    v, g = 2.0, 2.0
    foot = r * math.tan(math.pi / 8)  # how far from the corner the disc touches floor and ramp
    arrives = 1.0
    up = v * HALF
    back = arrives + 2 * up / (g * HALF)
    out = up * HALF
    rows = r"floor begin, ramp bounce(, (floor|ramp) (begin|end|bounce))*"
    return Case(
        name=f"up a ramp of 45 degrees and back, b = 0, r={r}",
        why="each passage of the joint leaves v cos 45 (law with b = 0); in between constant acceleration",
        scene=Scene(
            gravity=(0, -g),
            ball=Ball(radius=r, b=b),
            elements=(floor(), Wall((0, 0), (2.5, 2.5), name="ramp")),
        ),
        position=(-foot - v, r),
        velocity=(v, 0.0),
        script=(back + 1.0,),
        rows=rows,
        expect=(
            when("ramp bounce", arrives, 8 * ULP),
            when("floor begin", back, 64 * ULP, 1),
            *at(-foot - out, r, 4 * NEAR),
            *going(-out, 0.0, 16 * ULP),
        ),
    )


def _post(r: float, b: float) -> Case:
    """A T: a wall stands on the floor that the ball slides along."""
    return Case(
        name=f"against a post on the floor, r={r}, b={b}",
        why="law at the post: v' = -b v; the floor is never left",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=r),
            elements=(floor(b=0.5), Wall((1, 0), (1, 2), b=b, name="post")),
        ),
        position=(-1.0 - r, r),
        velocity=(2.0, 0.0),
        script=(2.0,),
        rows="floor begin, post bounce(, floor end, floor begin)?",
        expect=(when("post bounce", 1.0, 4 * ULP), *at(1 - r - 2 * b, r, NEAR), *going(-2 * b, 0.0, 8 * ULP)),
    )


def _below(r: float) -> Case:
    """A T upside down: a wall hangs from the floor, its end in the floor's line."""
    return Case(
        name=f"over a wall that hangs under the floor, r={r}",
        why="nothing stands out of the floor: it slides on",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=r),
            elements=(Wall((0.5, 0), (0.5, -2), name="hanging"), floor(b=0.5), Wall((1, 0), (1.5, -1), name="strut")),
        ),
        position=(-1.0, r),
        velocity=(1.0, 0.0),
        script=(3.0,),
        rows="floor begin",
        expect=(*at(2.0, r, NEAR), *going(1.0, 0.0, 4 * ULP)),
    )


def _gate_chain() -> Case:
    """Three one-way walls end to end make one floor."""
    gates = tuple(Wall((2 * k - 3, 0), (2 * k - 1, 0), one_way=True, b=0.5, name=f"w{k}") for k in range(3))
    return Case(
        name="along a chain of one-way walls",
        why="from their left they are walls: one floor, no joint is felt",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R), elements=gates),
        position=(-2.5, R),
        velocity=(1.0, 0.0),
        script=(5.0,),
        rows="w0 begin, w0 end, w1 begin, w1 end, w2 begin",
        expect=(*at(2.5, R, NEAR), when("w1 begin", 1.5, 8 * ULP), when("w2 begin", 3.5, 8 * ULP)),
    )


SLIDES = [
    *(_chain(r, rest_speed) for r in (0.0, R) for rest_speed in (0.0, 0.25)),
    *(_skim(r) for r in (0.0, R)),
    *(_table_end(r) for r in (0.0, R)),
    *(_convex(r) for r in (0.0, R)),
    *(_concave(r, 0.0) for r in (0.0, R)),
    *(_post(r, b) for r in (0.0, R) for b in (1.0, 0.5)),
    *(_below(r) for r in (0.0, R)),
    _gate_chain(),
    Case(
        name="a bumper as high as the ball stands on the floor",
        why="the normal at the hit is along the floor: v' = -b v, and the floor is not left",
        scene=Scene(
            gravity=(0, -2), ball=Ball(radius=R), elements=(floor(b=0.5), Bumper((1, R), R, b=0.5, name="bumper"))
        ),
        position=(-2 * R, R),
        velocity=(1.0, 0.0),
        script=(2.0,),
        rows="floor begin, bumper bounce(, floor end, floor begin)?",
        expect=(when("bumper bounce", 1.0, 8 * ULP), *at(1 - 2 * R - 0.5, R, NEAR), *going(-0.5, 0.0, 8 * ULP)),
    ),
    Case(
        name="sliding over sensors",
        why="uniform motion: crossed at the instants at which the centre is there; the one along the way only touches",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R),
            elements=(
                floor(b=0.5),
                Sensor((0, -1), (0, 1), name="upright"),
                Sensor((1, 0), (2, 2 * R), name="slanted"),
                Sensor((-3, R), (3, R), name="along"),
                Sensor(center=(2, R), radius=0.25, name="ring"),
                Sensor((2.5, -1), (2.5, 1), drain=True, name="drain"),
            ),
        ),
        position=(-1.0, R),
        velocity=(1.0, 0.0),
        script=(5.0,),
        status=("OUT",),
        rows="floor begin, upright cross, slanted cross, ring cross, drain cross",
        expect=(
            when("upright cross", 1.0, 4 * ULP),
            when("slanted cross", 2.5, 8 * ULP),
            when("ring cross", 2.75, 8 * ULP),
            when("drain cross", 3.5, 8 * ULP),
            *at(2.5, R, NEAR),
        ),
    ),
    Case(
        name="rest on a floor of two walls, at the joint",
        why="static: both walls are one floor",
        scene=Scene(
            gravity=(0, -G),
            ball=Ball(radius=R),
            elements=(Wall((-3, 0), (0, 0), b=0.5, name="left"), Wall((0, 0), (3, 0), b=0.5, name="right")),
        ),
        position=(0.0, 1 + R),
        script=(10.0,),
        rows="((left|right) (bounce|begin), )+(left|right) begin",
        expect=resting(0.0, R, NEAR),
    ),
    Case(
        name="from a fall onto a floor, smoothly through an arc",
        why="b = f = 1: energy g h is conserved, but for one smallest rebound, 0.01 sqrt(press size)",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R),
            elements=(
                Wall((-1, 1), (-1, 3), name="upright"),
                Arc((0, 1), 1, math.pi, 1.5 * math.pi, name="bend"),
                Wall((0, 0), (3, 0), name="floor"),
            ),
        ),
        position=(-1 + R, 2 + R),
        script=(2.5,),
        expect=(
            between(
                "energy / (g h)",
                lambda run: (math.hypot(*run.velocity) ** 2 / 2 + 2 * run.position[1]) / 4 - R / 2,
                1 - 1e-12,
                1 + 3e-4,
            ),
            between("x", lambda run: run.position[0], 0.0, 3.0),
        ),
    ),
]
