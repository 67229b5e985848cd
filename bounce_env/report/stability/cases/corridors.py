"""Between two walls, and along one that does not press."""

from bounce_env.report.stability.case import ULP, Case, at, count, going
from bounce_env.report.stability.cases.drops import NEAR, G, R, floor
from bounce_env.scene import Ball, Bumper, Scene, Wall


def _corridor(name: str, gap: float, vy: float, hits: int) -> Case:
    """Straight on between two walls, elastic, without gravity: y is a triangle wave of height `gap`."""
    t = 2.0
    travelled = gap / 2 + vy * t  # from the lower end of the gap
    folded = travelled % (2 * gap) if gap else 0.0
    y = min(folded, 2 * gap - folded)
    return Case(
        name=f"corridor {name}",
        why="unfolding: uniform along it, a triangle wave across",
        scene=Scene(
            gravity=(0, 0),
            ball=Ball(radius=R),
            elements=(floor(), Wall((-3, 2 * R + gap), (3, 2 * R + gap), name="roof")),
        ),
        position=(-2.0, R + gap / 2),
        velocity=(1.5, vy),
        script=(t,),
        rows="(roof bounce, floor bounce, )+roof bounce, floor bounce" if hits else "",
        expect=(
            # The gap itself is known to round-off of the walls' places only; each hit moves the phase by as much.
            count("roof bounce", hits // 2, 1),
            *at(1.0, R + y, NEAR * (1 + hits)),
            *going(1.5, vy if travelled % (2 * gap or 1) < gap or not gap else -vy, 16 * ULP),
        ),
    )


CORRIDORS = [
    _corridor("1e-9 wider than the ball", 1e-9, 0.0, 0),
    _corridor("1e-9 wider than the ball, crossed", 1e-9, 2e-7, 400),
    _corridor("1e-3 wider than the ball, crossed", 1e-3, 0.1, 200),
    _corridor("exactly as wide as the ball", 0.0, 0.0, 0),
    Case(
        name="exact corridor under gravity across it",
        why="the lower wall carries the ball, the upper one only touches",
        scene=Scene(
            gravity=(0, -G),
            ball=Ball(radius=R, b=0.5),
            elements=(floor(), Wall((-3, 2 * R), (3, 2 * R), name="roof")),
        ),
        position=(-2.0, R),
        velocity=(1.0, 0.0),
        script=(4.0,),
        rows="floor begin",
        expect=(*at(2.0, R, NEAR), *going(1.0, 0.0, 4 * ULP)),
    ),
    Case(
        name="exact corridor under gravity along it",
        why="no normal force, so no friction: free fall",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R, b=0.5, f=0.5),
            elements=(Wall((0, -3), (0, 3), name="left"), Wall((2 * R, -3), (2 * R, 3), name="right")),
        ),
        position=(R, 2.0),
        script=(1.5,),
        rows="",
        expect=(*at(R, 2.0 - 1.5**2, NEAR), *going(0.0, -3.0, 8 * ULP)),
    ),
    Case(
        name="beside an upright wall with vx = 0 exactly",
        why="gravity along the wall: touching is no hit; the floor is hit at t = 1, then the peak is h / 4",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R),
            elements=(floor(b=0.5), Wall((-1, 0), (-1, 3), f=0.5, name="wall")),
        ),
        position=(-1 + R, 1 + R),
        script=(1.5,),
        rows="floor bounce",
        expect=(*at(-1 + R, 0.25 + R, NEAR), *going(0.0, 0.0, 8 * ULP)),
    ),
    Case(
        name="elastic between two walls along gravity",
        why="separable: uniform across with folds, free fall along",
        scene=Scene(
            gravity=(0, -2),
            ball=Ball(radius=R),
            elements=(Wall((-1 - R, -3), (-1 - R, 3), name="left"), Wall((1 + R, -3), (1 + R, 3), name="right")),
        ),
        position=(0.0, 2.5),
        velocity=(8.0, 0.0),
        script=(2.0,),
        rows="(right bounce, left bounce, ){3}right bounce, left bounce",
        expect=(*at(0.0, 2.5 - 4.0, NEAR), *going(8.0, -4.0, 32 * ULP)),
    ),
    *(
        Case(
            name=f"falls along an upright wall past its end, f={f}",
            why="touching is no hit, neither on the wall nor on its round end: free fall",
            scene=Scene(
                gravity=(0, -2), ball=Ball(radius=R, f=f), elements=(Wall((-1, 1), (-1, 3), name="wall"), floor(-3.0))
            ),
            position=(-1 + R, 2.0),
            script=(2.0,),
            rows="",
            expect=(*at(-1 + R, -2.0, NEAR), *going(0.0, -4.0, 8 * ULP)),
        )
        for f in (1.0, 0.5)
    ),
    Case(
        name="a peak that just touches a bumper from below",
        why="the parabola and the circle touch in one point, where the ball stands still: nothing is closed on",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R), elements=(Bumper((0, 0), 1, name="bumper"),)),
        position=(0.0, -2 - R),
        velocity=(0.0, 2.0),
        script=(2.0,),
        rows="",
        expect=(*at(0.0, -2 - R, NEAR), *going(0.0, -2.0, NEAR)),
    ),
    Case(
        name="a peak that just touches the side of a bumper in passing",
        why="the path's highest point touches the bumper's lowest: nothing is closed on, and vx and vy stay",
        scene=Scene(gravity=(0, -2), ball=Ball(radius=R, f=0.5), elements=(Bumper((0, 0), 1, name="bumper"),)),
        position=(-3.0, -2 - R),
        velocity=(3.0, 2.0),
        script=(2.0,),
        rows="",
        expect=(*at(3.0, -2 - R, NEAR), *going(3.0, -2.0, NEAR)),
    ),
]
