"""Where a ball comes to rest on curves, or rolls: domes, bowls, pegs, pockets."""

import math

from bounce_env.report.stability.case import Case, between, going, last_time, resting
from bounce_env.report.stability.cases.curves import DOWN, TURN, energy, off_centre, ring
from bounce_env.report.stability.cases.drops import CORNER, LAST_HOPS, NEAR, G, R, rest_time
from bounce_env.scene import Arc, Ball, Bumper, Element, Scene, Wall

REBOUND = 0.01  # times sqrt(press * size) [m/s]: the speed of the smallest hop on a curve


def _tops() -> dict[str, tuple[Element, float, tuple[float, ...]]]:
    """Shapes with a place to balance on: element, height of the place, radii of balls."""
    return {
        "bumper": (Bumper((0.25, 0), 0.5, name="top"), 0.5, (0.0, R)),
        "dome": (Arc((0.25, 0), 0.5, 0.25, 2.75, name="top"), 0.5, (0.0, R)),
        "wall's end": (Wall((0.25, 0.5), (0.25, -2), name="top"), 0.5, (R,)),
        "arc's end": (Arc((1.25, 0.5), 1, math.pi, 4, name="top"), 0.5, (R,)),
        "bowl": (Arc((0.25, 1), 1, math.pi, TURN, name="top"), 0.0, (0.0, R)),
        "ring with its seam at the bottom": (
            Arc((0.25, 1), 1, -TURN / 4, TURN * 0.75, name="top"),
            0.0,
            (0.0, R),
        ),
    }


def _balanced(shape: str, b: float, r: float, height: float) -> Case:
    """Dropped on the very middle: upright bounces as on a floor, so the drop's own formula.

    With b = 0 the ball has no speed along the curve either, and the smallest rebound is that of a slow ball: a few hops
    no higher than some TOUCH. Hops no higher than TOUCH are left out.
    """
    element, top, _ = _tops()[shape]
    rest = rest_time(height, b) if height else 0.0
    return Case(
        name=f"{shape}: exactly on its middle from {height} m, b={b}, r={r}",
        why="one normal that is parallel to gravity holds the ball; upright bounces until then, summed in closed form",
        scene=Scene(gravity=DOWN, ball=Ball(radius=r, b=b), elements=(element,)),
        position=(0.25, top + r + height),
        script=(rest + 5.0,),
        rows="(top bounce, )+top begin" if height else "top begin",
        expect=(last_time(rest, 16 * LAST_HOPS if height else 0.0), *resting(0.25, top + r, NEAR)),
    )


def _pegs(name: str, dx: float, height: float, b: float, seconds: float) -> Case:
    """Pegs of 0.2 m at +-0.3 m, a disc of 0.125 m: it touches both at 0.125 m (5, 12, 13); 0.2 m more lead out."""
    return Case(
        name=f"on two pegs, {name}, b={b}",
        why="static: the two normals carry the weight where the disc touches both pegs",
        scene=Scene(
            gravity=DOWN,
            ball=Ball(radius=R, b=b),
            elements=(Bumper((-0.3, 0), 0.2, name="left"), Bumper((0.3, 0), 0.2, name="right")),
        ),
        position=(dx, 0.125 + height),
        script=(seconds,),
        rows="((left|right) (bounce|begin|end), )*(left|right) begin",
        expect=resting(0.0, 0.125, NEAR + CORNER / (5 / 13)),  # the sine of the angle between the two surfaces, halved
    )


def _pocket(height: float, b: float) -> Case:
    """Between an upright wall at 0 and a bumper: the centre 0.195 m beside and 0.26 m above the bumper's (3, 4, 5)."""
    return Case(
        name=f"between a bumper and a wall, from {height} m, b={b}",
        why="static: the two normals carry the weight where the disc touches both",
        scene=Scene(
            gravity=DOWN,
            ball=Ball(radius=R, b=b),
            elements=(Wall((0, -1), (0, 2), name="wall"), Bumper((0.32, 0), 0.2, name="bumper")),
        ),
        position=(R + height / 5, 0.26 + height),
        script=(60.0,),
        rows="((wall|bumper) (bounce|begin|end), )*(wall|bumper) begin",
        expect=resting(R, 0.26, NEAR + CORNER / math.sqrt(0.2)),  # as above: cos = 0.6 between the normals
    )


HOLLOWS = [
    *(
        _balanced(shape, b, r, height)
        for shape, (*_, radii) in _tops().items()
        for r in radii
        for b, height in ((0.5, 1.0), (0.0, 1.0), (0.5, 0.0), (1.0, 0.0))
    ),
    _pegs("started there", 0.0, 0.0, 0.5, 60.0),
    *(_pegs(f"dropped {dx} off the middle", dx, 0.0625, b, 60.0) for dx in (0.0, 1 / 64) for b in (0.0, 0.5)),
    _pegs("dropped off the middle", 1 / 64, 0.0625, 0.99, 2000.0),
    *(_pocket(height, b) for height, b in ((0.0, 0.5), (0.05, 0.5), (0.05, 0.0), (0.05, 0.9))),
    Case(
        name="on the two ends of a bowl smaller than the ball",
        why="static: the two ends carry it, sqrt(r^2 - 0.1^2) above them",
        scene=Scene(
            gravity=DOWN, ball=Ball(radius=0.25, b=0.5), elements=(Arc((0, 0), 0.1, math.pi, TURN, name="cup"),)
        ),
        position=(1 / 128, math.sqrt(0.0525) + 0.03125),  # of two ends closed on alike, the one that is first is struck
        script=(60.0,),
        rows="(cup (bounce|begin|end), )+cup begin",
        expect=resting(0.0, math.sqrt(0.0525), NEAR + CORNER / 0.4),
    ),
    Case(
        name="bowl with friction",
        why="contract: f < 1 with rest_speed = 0 stops a soft, pressed touch; so it ends at rest somewhere on the bowl",
        scene=Scene(gravity=DOWN, ball=Ball(radius=R, b=0.5, f=0.75), elements=(ring(),)),
        position=(0.25, 0.0),
        script=(60.0,),
        rows="(ring bounce, )+ring begin",
        expect=(between("distance", off_centre(0, 0), 1 - R - NEAR, 1 - R + NEAR), *going(0.0, 0.0, 0.0)),
    ),
    *(
        Case(
            name=f"rolling in a bowl, b={b}, rest_speed={rest_speed}",
            why="f = 1 takes no energy but the hops': at most the start's and one smallest rebound's, never outside",
            scene=Scene(gravity=DOWN, ball=Ball(radius=R, b=b), rest_speed=rest_speed, elements=(ring(),)),
            position=(0.5, -math.sqrt((1 - R) ** 2 - 0.25)),
            script=(10.0,),
            expect=(
                between(
                    "energy above the start's",
                    lambda run: energy(G)(run) + G * math.sqrt((1 - R) ** 2 - 0.25),
                    -G * (1 - R),
                    max(rest_speed, REBOUND * math.sqrt(3 * G * (1 - R))) ** 2 / 2,
                ),
                between("distance", off_centre(0, 0), 0.0, 1 - R + NEAR),
            ),
        )
        for b, rest_speed in ((0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.5, 0.125))
    ),
    Case(
        name="glue on a bumper",
        why="contract: f = 0 holds a pressed ball, here where it hit",
        scene=Scene(gravity=DOWN, ball=Ball(radius=R, b=0, f=0), elements=(Bumper((0, 0), 1, name="bumper"),)),
        position=(0.5, 2.0),
        velocity=(0.0, 0.0),
        script=(100.0,),
        rows="bumper bounce, bumper begin",
        expect=resting(0.5, math.sqrt((1 + R) ** 2 - 0.25), NEAR),
    ),
    Case(
        name="between an upright wall and the side of a bowl",
        why="static: the disc touches the wall (x = R) and the bowl; the two normals carry the weight",
        scene=Scene(gravity=DOWN, ball=Ball(radius=R, b=0.5), elements=(ring(), Wall((0, -1), (0, 1), name="wall"))),
        position=(R + 1 / 64, -math.sqrt((1 - R) ** 2 - R**2) + 1 / 16),
        script=(60.0,),
        rows="((wall|ring) (bounce|begin|end), )*(wall|ring) begin",
        expect=resting(R, -math.sqrt((1 - R) ** 2 - R**2), NEAR + 8 * CORNER),
    ),
    *(
        Case(
            name=f"{angle} rad off the top of a bumper, b={b}",
            why="not balanced: rolls off; energy is the start's and little more, and it falls on one side only",
            scene=Scene(gravity=DOWN, ball=Ball(radius=R, b=b), elements=(Bumper((0, 0), 1, name="bumper"),)),
            position=((1 + R) * math.sin(angle), (1 + R) * math.cos(angle)),
            script=(6.0,),
            max_events=200_000,
            expect=(
                between("x", lambda run: run.position[0], 1.0, 50.0),
                between("energy above the start's", lambda run: energy(G)(run) - G * (1 + R), -0.1, 0.01),
            ),
        )
        for angle in (0.01, 0.001)
        for b in (0.0, 0.5)
    ),
]
