"""V's and wedges in which a ball comes to rest, or out of which it comes again."""

import math
from typing import Any

from bounce_env.report.stability.case import ULP, Case, Point, at, between, going, last_time, resting, speed, when
from bounce_env.report.stability.cases.corners import HALF, left_out
from bounce_env.report.stability.cases.drops import CORNER, NEAR, G, R, rest_time
from bounce_env.scene import Ball, Scene, Wall

# In a V: which of the two walls a ball at rest is in contact with is left open, and a contact that goes on has no row.
SETTLES = "((left|right) (bounce|begin|end), )+(left|right) (bounce|begin)"


def v_walls(left: float, right: float, length: float = 2.5, **surface: Any) -> tuple[Wall, Wall]:
    """Two walls up from the origin, `left` and `right` radians from the upright."""
    return (
        Wall((0, 0), (-length * math.sin(left), length * math.cos(left)), name="left", **surface),
        Wall((0, 0), (length * math.sin(right), length * math.cos(right)), name="right", **surface),
    )


def v_bottom(left: float, right: float, r: float) -> Point:
    """Where a disc touches both walls: on the bisector, r / sin(half the opening) from the vertex."""
    half, tilt = (left + right) / 2, (right - left) / 2
    return r / math.sin(half) * math.sin(tilt), r / math.sin(half) * math.cos(tilt)


def _v(left: int, right: int, b: float, r: float, seconds: float) -> Case:
    """Dropped above the bottom: down the middle where the V is symmetrical."""
    a, c = math.radians(left), math.radians(right)
    x, y = v_bottom(a, c, r)
    height = 0.25 if right > 60 else 0.75  # so that the walls are higher than what the ball's energy can reach
    aside = 0.125 if r == left == 0 else 0.0  # a point must not start in an upright wall
    return Case(
        name=f"V of {left} + {right} degrees, b={b}, r={r}",
        why="static: the two normals carry the weight where the disc touches both walls; energy can only fall",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=r, b=b), elements=v_walls(a, c)),
        position=(x + aside, y + height),
        script=(seconds,),
        rows=SETTLES,
        expect=resting(x, y, NEAR + CORNER / min(math.sin((a + c) / 2), math.cos((a + c) / 2))),
    )


def _v_slides(left: int, r: float) -> Case:
    """Obtuse and b = 0: the ball slides up one wall, back, and up the other; each passage leaves cos(180 - 2 left).

    It begins at the bottom with v up one wall; a slide with v lasts 2 v / (g cos(left)).
    """
    a, v = math.radians(left), 1.5
    x, y = v_bottom(a, a, r)
    share = -math.cos(2 * a)
    rest = 2 * v / (G * math.cos(a)) / (1 - share)
    return Case(
        name=f"V of {left} + {left} degrees, b=0: slides from side to side, r={r}",
        why="law at each passage and constant acceleration in between: a geometric series of slides",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=r, b=0), elements=v_walls(a, a)),
        position=(x, y),
        velocity=(-v * math.sin(a), v * math.cos(a)),
        script=(rest + 1.0,),
        rows=SETTLES,
        expect=(last_time(rest, left_out(G, G * math.cos(a), share)), *resting(x, y, NEAR + CORNER / math.cos(a))),
    )


def _v_start(left: int, right: int, r: float) -> Case:
    a, c = math.radians(left), math.radians(right)
    x, y = v_bottom(a, c, r)
    return Case(
        name=f"start at rest in a V of {left} + {right} degrees, r={r}",
        why="static",
        scene=Scene(gravity=(0, -G), ball=Ball(radius=r, b=0.75), elements=v_walls(a, c)),
        position=(x, y),
        script=(100.0,),
        rows=r"((left|right) (begin|end), )*(left|right) begin",
        expect=resting(x, y, 4 * NEAR / math.sin((a + c) / 2)),
    )


def _wedge(q_left: float, q_right: float, e: float, r: float) -> Case:
    """A right angle: along each wall's normal a drop of its own under g / sqrt 2, and each has its own rest time.

    Each of the two normal distances is the way along the other wall, so the ball rests when the later one does.
    """
    pull = G * HALF
    ends = [rest_time(q, e, pull) for q in (q_left, q_right)]
    last_hops = left_out(G, pull, e)
    first = "left" if q_left < q_right else "right"
    x, y = (q_left - q_right) * HALF, (q_left + q_right + 2 * r) * HALF
    return Case(
        name=f"right angle, e={e}, r={r}, {q_left} and {q_right} m from its walls",
        why="separable: two drops under g / sqrt 2 with the law's e; rest at the later of their rest times",
        scene=Scene(
            gravity=(0, -G),
            ball=Ball(radius=r, b=e),
            elements=(Wall((0, 0), (-2, 2), name="left"), Wall((0, 0), (2, 2), name="right")),
        ),
        position=(x, y),
        script=(max(ends) + 1.0,),
        rows=SETTLES,
        expect=(
            last_time(max(ends), last_hops),
            *(() if q_left == q_right else (when(f"{first} begin", min(ends), last_hops),)),
            *resting(0.0, r * math.sqrt(2), NEAR + CORNER / HALF),
        ),
        exact_scaling=r > 0.0,  # a point comes so near to the origin that its coordinates are denormal
    )


_ONE = math.radians(1.0)


WEDGES = [
    *(
        _v(*sides, b, r, 60.0)
        for sides in ((45, 45), (15, 15), (75, 75), (0, 45), (20, 50))
        for b in (0.0, 0.5)
        for r in (0.0, R)
    ),
    *(_v(*sides, 0.99, R, 2000.0) for sides in ((45, 45), (15, 15), (75, 75), (20, 50))),
    *(_v_slides(left, r) for left in (60, 75) for r in (0.0, R)),
    *(_v_start(*sides, r) for sides in ((45, 45), (75, 75), (20, 50)) for r in (0.0, R)),
    _v_start(0, 45, R),
    *(_wedge(q, p, e, r) for q, p in ((0.25, 1.0), (1.0, 0.25), (0.5, 0.5)) for e in (0.1, 0.5, 0.9) for r in (0.0, R)),
    Case(
        name="one-degree wedge, point",
        why="unfolding: a straight line at 0.016 m from the vertex meets 179 images of the walls (at most 180)",
        scene=Scene(
            gravity=(0, 0),
            elements=(
                Wall((0, 0), (3, 0), name="floor"),
                Wall((0, 0), (3 * math.cos(_ONE), 3 * math.sin(_ONE)), name="roof"),
            ),
        ),
        position=(2.0, 0.016),
        velocity=(-1.0, 0.0),
        script=(3.5,),
        rows="(roof bounce, floor bounce, ){89}roof bounce",
        expect=(*at(1.5, 0.016, 179 * 8 * ULP), *going(1.0, 0.0, 179 * 4 * ULP)),
    ),
    Case(
        name="one-degree wedge, disc",
        why="at most 180 bounces; energy is conserved and the ball comes out again",
        scene=Scene(
            gravity=(0, 0),
            ball=Ball(radius=0.01),
            elements=(
                Wall((0, 0), (3, 0), name="floor"),
                Wall((0, 0), (3 * math.cos(_ONE), 3 * math.sin(_ONE)), name="roof"),
            ),
        ),
        position=(2.0, 0.0125),
        velocity=(-1.0, 1e-3),
        script=(2.0,),
        expect=(
            speed(math.hypot(1.0, 1e-3), 360 * ULP),
            between("bounces", lambda run: len(run.tokens()), 2, 180),
            between("vx", lambda run: run.velocity[0], 0.9, 1.0),
        ),
    ),
]
