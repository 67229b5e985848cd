"""Closed rooms that nothing may leave, whatever corner it is thrown into, and traps as wide as the ball."""

import math
import random
from typing import Any

from bounce_env.report.stability.case import ULP, Case, Expect, Point, Run, at, between, going, resting, speed
from bounce_env.report.stability.cases.drops import NEAR, R
from bounce_env.scene import Arc, Ball, Bumper, Element, Scene, Wall

FREE = (0.0, 0.0)


def polygon(corners: list[Point], **surface: Any) -> tuple[Wall, ...]:
    pairs = zip(corners, [*corners[1:], corners[0]], strict=True)
    return tuple(Wall(p, q, name=f"w{k}", **surface) for k, (p, q) in enumerate(pairs))


def regular(sides: int, turn: float = 0.1) -> list[Point]:
    angles = [turn + math.tau * k / sides for k in range(sides)]
    return [(math.cos(a), math.sin(a)) for a in angles]


def star(points: int) -> list[Point]:
    """Corners alternately 1 m and 0.4 m from the origin: every other one is reflex."""
    angles = [0.1 + math.pi * k / points for k in range(2 * points)]
    return [((1.0, 0.4)[k % 2] * math.cos(a), (1.0, 0.4)[k % 2] * math.sin(a)) for k, a in enumerate(angles)]


def inside(corners: list[Point]) -> Expect:
    """Even-odd rule: 1 if the ball's centre is in the polygon."""

    def seen(run: Run) -> float:
        x, y = run.position
        odd = False
        for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], corners[0]], strict=True):
            if (y1 > y) != (y2 > y) and x < (x2 - x1) * (y - y1) / (y2 - y1) + x1:
                odd = not odd
        return float(odd)

    return Expect("inside", seen, 1.0, 0.0)


def _at_corner(name: str, corners: list[Point], k: int, start: Point, r: float) -> Case:
    """From `start` exactly (as far as floats go) at corner `k`."""
    dx, dy = corners[k][0] - start[0], corners[k][1] - start[1]
    length = math.hypot(dx, dy)
    return Case(
        name=f"{name}, r={r}, at corner {k}",
        why="elastic and closed: speed is conserved, and the ball is inside for ever",
        scene=Scene(gravity=FREE, ball=Ball(radius=r), elements=polygon(corners)),
        position=start,
        velocity=(dx / length, dy / length),
        script=(length - 0.25, 0.5, 20.0 + math.pi),
        rows=r"(w\d+ bounce, )+w\d+ bounce",
        expect=(inside(corners), speed(1.0, 400 * ULP)),
    )


def _stadium(r: float, start: Point, velocity: Point, gravity: Point) -> Case:
    """Bunimovich's stadium: straight sides from -1 to 1, half circles of 1 m at both ends, joined smoothly."""
    elements: tuple[Element, ...] = (
        Wall((-1, -1), (1, -1), name="low"),
        Arc((1, 0), 1, -math.pi / 2, math.pi / 2, name="right"),
        Wall((1, 1), (-1, 1), name="high"),
        Arc((-1, 0), 1, math.pi / 2, 1.5 * math.pi, name="left"),
    )
    energy = math.hypot(*velocity) ** 2 / 2 - gravity[1] * start[1]

    def reach(run: Run) -> float:
        x, y = run.position
        return math.hypot(max(abs(x) - 1.0, 0.0), y) + r

    return Case(
        name=f"stadium, r={r}, from {start} with {velocity}, gravity {gravity[1]}",
        why="elastic and closed: energy is conserved, and the ball is inside for ever; the joints are smooth",
        scene=Scene(gravity=gravity, ball=Ball(radius=r), elements=elements),
        position=start,
        velocity=velocity,
        script=(500.0,),
        rows=r"((low|right|high|left) bounce, )+(low|right|high|left) bounce",
        expect=(
            between("reach", reach, 0.0, 1.0 + NEAR),
            between(
                "energy",
                lambda run: math.hypot(*run.velocity) ** 2 / 2 - gravity[1] * run.position[1],
                energy - 2000 * 8 * ULP * (energy + 2 * abs(gravity[1])),
                energy + 2000 * 8 * ULP * (energy + 2 * abs(gravity[1])),
            ),
        ),
    )


_LENS = (
    Arc((-0.6, 0), 1, -math.acos(0.6), math.acos(0.6), name="right"),
    Arc((0.6, 0), 1, math.pi - math.acos(0.6), math.pi + math.acos(0.6), name="left"),
)  # their ends meet at (0, +-0.8)


def _lens(r: float, aim: Point) -> Case:
    length = math.hypot(aim[0], aim[1] + 0.1)
    return Case(
        name=f"lens of two arcs, r={r}, at {aim}",
        why="elastic and closed: speed is conserved, and the ball is inside for ever",
        scene=Scene(gravity=FREE, ball=Ball(radius=r), elements=_LENS),
        position=(0.0, -0.1),
        velocity=(aim[0] / length, (aim[1] + 0.1) / length),
        script=(20.0,),
        expect=(
            speed(1.0, 2000 * ULP),
            between("reach", lambda run: math.hypot(abs(run.position[0]) + 0.6, run.position[1]) + r, 0.0, 1.0 + NEAR),
        ),
    )


_STAR = star(5)


def _along_into_arc(upwards: bool, seed: int) -> Case:
    """Along an upright wall, touching it, into an arc that goes on from it smoothly: up a lane, or down into a bend."""
    rng = random.Random(seed)
    r, way, v = rng.choice((0.0135, 0.125, 0.2)), rng.uniform(0.2, 0.9), rng.uniform(2.0, 5.0)
    side, sign = (1.0, 1.0) if upwards else (-1.0, -1.0)
    elements = (
        Wall((side, 0), (side, -2 * sign), name="wall"),
        Arc((0, 0), 1, 0 if upwards else math.pi, math.pi if upwards else 2 * math.pi, name="arc"),
        Wall((-side, 0), (-side, -2 * sign), name="other"),
    )

    def reach(run: Run) -> float:
        x, y = run.position
        return math.hypot(x, max(y * sign, 0.0)) + r

    return Case(
        name=f"{'lane into an arch' if upwards else 'fall into a bend'}, touching the wall, {seed}",
        why="wall and arc are one smooth surface: the ball is inside of it for ever",
        scene=Scene(gravity=(0, -rng.uniform(1.0, 2.0)), ball=Ball(radius=r, b=0.5), elements=elements),
        position=(side * (1 - r), -way * sign),
        velocity=(0.0, v * sign),
        script=(0.8,),
        expect=(between("reach", reach, 0.0, 1.0 + NEAR),),
    )


ROOMS = [
    *(
        _at_corner(f"regular {sides}-gon", regular(sides), k, (0.0625, -0.03125), r)
        for sides in (3, 5, 7)
        for k in (0, 1)
        for r in (0.0, R)
    ),
    *(_at_corner("star", _STAR, k, (0.0625, -0.03125), r) for k in range(4) for r in (0.0, R / 4)),
    *(
        _stadium(r, start, velocity, gravity)
        for r in (0.0, R)
        for start, velocity, gravity in (
            ((0.0, 0.0), (1.0, 1.0 - r), FREE),  # at the joint of the upper side and the right arc
            ((0.0, 0.0), (0.75, 0.3125), FREE),
            ((0.25, 0.125), (1.0, 0.5), (0.0, -1.0)),
        )
    ),
    *(_along_into_arc(upwards, seed) for upwards in (True, False) for seed in range(12)),
    *(_lens(r, aim) for r in (0.0, R) for aim in ((0.0, 0.8), (0.3, 0.5))),
    Case(
        name="box as large as the ball",
        why="contract: closings that persist at one instant leave what all touched elements allow: nothing",
        scene=Scene(
            gravity=FREE,
            ball=Ball(radius=R),
            elements=polygon([(-R, -R), (R, -R), (R, R), (-R, R)]),
        ),
        position=(0.0, 0.0),
        velocity=(1.0, 0.3125),
        script=(10.0,),
        expect=resting(0.0, 0.0, NEAR),
    ),
    Case(
        name="corridor as wide as the ball, pushed at an angle",
        why="contract: closings that persist at one instant leave what both walls allow: the way along them",
        scene=Scene(
            gravity=FREE,
            ball=Ball(radius=R),
            elements=(Wall((-3, -R), (3, -R), name="floor"), Wall((-3, R), (3, R), name="roof")),
        ),
        position=(-1.0, 0.0),
        velocity=(0.5, 0.25),
        script=(4.0,),
        expect=(*at(1.0, 0.0, NEAR), *going(0.5, 0.0, 8 * ULP)),
    ),
    Case(
        name="gap between two bumpers as wide as the ball",
        why="both are touched only: straight on",
        scene=Scene(
            gravity=FREE,
            ball=Ball(radius=R),
            elements=(Bumper((0, 0.5 + R), 0.5, name="upper"), Bumper((0, -0.5 - R), 0.5, name="lower")),
        ),
        position=(-2.0, 0.0),
        velocity=(1.0, 0.0),
        script=(4.0,),
        rows="",
        expect=(*at(2.0, 0.0, NEAR), *going(1.0, 0.0, 0.0)),
    ),
    Case(
        name="between three bumpers that touch it",
        why="contract: closings that persist at one instant leave what all touched elements allow: nothing",
        scene=Scene(
            gravity=FREE,
            ball=Ball(radius=0.25),
            elements=tuple(
                Bumper((0.75 * math.cos(a), 0.75 * math.sin(a)), 0.5, name=f"b{k}")
                for k, a in enumerate((0.5, 0.5 + math.tau / 3, 0.5 + 2 * math.tau / 3))
            ),
        ),
        position=(0.0, 0.0),
        velocity=(0.5, 0.25),
        script=(10.0,),
        expect=(*at(0.0, 0.0, NEAR), speed(0.0, 1e-9)),
    ),
]
