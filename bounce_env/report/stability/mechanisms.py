"""What makes simulators fail: mechanisms, why each is hard, and cases in which it is tried at several magnitudes."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from bounce_env.report.stability.case import Case
from bounce_env.report.stability.cases import CASES
from bounce_env.report.stability.images import Image

SCALES = {"as it is": Image(), "2^-10 as large": Image(length=2.0**-10), "2^19 as large": Image(length=2.0**19)}
"""Other magnitudes of a case in which only lengths differ: a thousandth, and half a million times its size."""


@dataclass(frozen=True)
class Mechanism:
    """One way to fail. kind: stiff, extreme or degenerate. cases: regular expression of names.

    scaled: whether each case is tried at SCALES, too, where its magnitude is not in its name.
    """

    kind: str
    name: str
    why: str
    cases: str
    scaled: bool = False


MECHANISMS = (
    Mechanism(
        "stiff",
        "restitution near 1",
        "A drop bounces a thousand times and more before it rests.",
        r"drop e=0\.9\d* r=.*|drop e=0\.999999 does not rest early",
    ),
    Mechanism(
        "stiff",
        "restitution near 0",
        "Nearly all is lost at the first hit; what is left must not be lost at once.",
        r"drop e=0\.[15] r=.*|b = 0 from 10 m|tar.*|glue.*",
    ),
    Mechanism(
        "stiff",
        "bounces that accumulate on a slope",
        "Infinitely many bounces, and a slide that begins at their sum.",
        r"Zeno on a slope .*|b = 0 (on|dropped on) a slope .*",
    ),
    Mechanism(
        "stiff",
        "bounces that accumulate beside something",
        "What comes first, the sum of the bounces or the wall?",
        r"Zeno (on the way to|ends).*",
    ),
    Mechanism(
        "stiff",
        "bounces that accumulate at an edge",
        "The slope ends a little before, or behind, the sum of the bounces.",
        r"bounces down a slope that ends .*",
    ),
    Mechanism(
        "stiff",
        "b > 1",
        "Each hit gives speed; without a cap the numbers end.",
        r"b = 2 floor up to the cap|b = 1e9|two walls that speed the ball up|speed cap in a corner",
    ),
    Mechanism(
        "stiff",
        "kicks",
        "A kick gives speed to what barely moves; without end where gravity brings it back.",
        r"kick.*|cooldown of .*",
    ),
    Mechanism("stiff", "strong and weak gravity", "The same motion at 10^3 and 10^-6 m/s^2.", r"drop under gravity .*"),
    Mechanism(
        "stiff",
        "soft touches",
        "Slower than rest_speed is absorbed, a little faster is not.",
        r"closing (at exactly|a little slower).*|elastic above rest_speed for ever|"
        r"rest_speed rolls .*|f = 0 and .*",
    ),
    Mechanism(
        "stiff",
        "fast flippers",
        "200 rad/s: from frame to frame it is somewhere else.",
        r"flipper at \d+ rad/s strikes a resting ball .*",
    ),
    Mechanism(
        "stiff",
        "fast walls",
        "What turns or sweeps at 100 m/s must neither miss nor pass the ball.",
        r"wall (at 100 m/s sweeps|that turns at).*",
    ),
    Mechanism(
        "extreme",
        "very fast balls",
        "In one frame the ball is a thousand walls further.",
        r"1e\+0[69] m/s at a thin wall.*",
    ),
    Mechanism(
        "extreme",
        "very slow balls",
        "A motion far below what a tolerance would call one.",
        r"1e-9 m/s|touching with a denormal speed.*",
    ),
    Mechanism("extreme", "long times", "10^9 seconds: adding up steps loses the phase.", r"1e9 s .*"),
    Mechanism(
        "extreme",
        "many bounces",
        "A million bounces, of which none may add energy.",
        r"1000000 elastic bounces|whispering gallery.*",
    ),
    Mechanism(
        "extreme",
        "far from the origin",
        "At 10^8 m a double has eight digits left for a ball of 0.1 m.",
        r"drop at x = 1e8.*|box at x = y = 1e8",
    ),
    Mechanism(
        "extreme",
        "size of the scene",
        "Nothing may depend on a length in metres.",
        r"drop e=0\.5 r=0\.125|corner 0 off the diagonal.*|slides off a bumper from rest",
        scaled=True,
    ),
    Mechanism(
        "extreme",
        "narrow gaps",
        "A corridor as wide as the ball, or 10^-9 wider: no room, but no overlap either.",
        r"corridor .*|exact corridor .*|slot as wide as the ball",
    ),
    Mechanism(
        "degenerate",
        "corners met dead on",
        "Two walls at one instant, or within 10^-15 m of it.",
        r"corner -?(0|1e-15) off the diagonal.*",
    ),
    Mechanism(
        "degenerate",
        "corners that lose energy",
        "All bounces in a corner together, and which rest is left.",
        r"right angle.*|b = 0 corner takes all",
    ),
    Mechanism("degenerate", "wedges", "The narrower, the more bounces in no time.", r"V of \d+ \+ \d+ degrees.*"),
    Mechanism(
        "degenerate",
        "one degree",
        "A wedge of one degree: at most 180 bounces, and all speed back.",
        r"one-degree wedge.*",
        scaled=True,
    ),
    Mechanism(
        "degenerate",
        "two surfaces at one instant",
        "A wall and a bumper with different b: by order, the same seen in a mirror.",
        r"wall b=.* and bumper b=.* at one instant.*",
    ),
    Mechanism(
        "degenerate",
        "ends of walls",
        "The end of a segment dead centre, from the side, along its own line.",
        r"segment end .*|along the line of a wall onto its end.*|wall's end.*",
    ),
    Mechanism(
        "degenerate",
        "joints",
        "Walls that go on into each other must not be felt; not even where they gape by rounding.",
        r"down a chain of 30 collinear walls.*|along two collinear walls .*|sliding over a joint that gapes .*|"
        r"rest on a floor of two walls.*",
    ),
    Mechanism(
        "degenerate",
        "cusps",
        "A floor under a circle: the room ends at an angle of zero.",
        r"point into the cusp .*|disc along the floor into the cusp .*",
        scaled=True,
    ),
    Mechanism(
        "degenerate",
        "grazes",
        "A peak 10^-12 m below a bumper, or into it.",
        r"graze by .*|peak 1e-12 m .*|a peak that just touches .*",
    ),
    Mechanism("degenerate", "circles inside", "A hit inside of a circle nearly along it.", r"circle billiard .*"),
    Mechanism(
        "degenerate",
        "releases",
        "Where does a ball leave the circle that it slides on?",
        r"slides off a bumper from rest|0\.0*1 rad off the top of a bumper.*|over a rounded edge.*",
    ),
    Mechanism(
        "degenerate",
        "tangent ramps",
        "From a lane into an arch, down a fall into a bend: curvature jumps, speed does not.",
        r"lane into an arch.*|fall into a bend.*",
    ),
    Mechanism(
        "degenerate",
        "rest in hollows",
        "Held by two surfaces at once, round or straight.",
        r"start at rest in a V .*|on two pegs.*|on the two ends of a bowl .*|bowl.*",
    ),
    Mechanism(
        "degenerate",
        "starts in contact",
        "On the floor: at rest, along it, upwards, downwards.",
        r"start on the floor .*",
    ),
    Mechanism(
        "degenerate",
        "bad starts",
        "Overlapping by rounding is moved, by more it is refused, and so is what is no number.",
        r"overlapping by .*|start at NaN|infinite time",
    ),
    Mechanism(
        "degenerate",
        "closed rooms",
        "Between surfaces that leave no room at all.",
        r"box as large as the ball|between three bumpers .*|gap between two bumpers .*|regular \d-gon.*",
    ),
    Mechanism(
        "degenerate",
        "crushing",
        "A closing part leaves no room: it stops, and nothing passes through anything.",
        r"paddle closes on a wall|crushed ball .*|flipper crushes .*|wall crushes .*|wall lets a crushed .*",
    ),
    Mechanism(
        "degenerate",
        "floors that move",
        "Rising, sinking, drawn away: a ball is carried, falls, or catches up.",
        r"floor (rises|sinks|that rises) .*|paddle slides away .*",
    ),
    Mechanism(
        "degenerate",
        "one-way walls",
        "Through from one side, off the other, and past the end.",
        r"one-way wall from its .*|past the end of a one-way wall .*|up to .* above a one-way wall and back.*",
    ),
    Mechanism(
        "degenerate",
        "borders of fields",
        "The force changes across a line on which the ball may come to rest.",
        r"sliding into a field .*|oscillation about a field's border|at rest on a field's border.*|"
        r"hops on a floor end .*",
    ),
    Mechanism(
        "degenerate",
        "sensors",
        "Crossed in the tail of a drop, at a bounce, or only touched.",
        r"circular sensor passed .*|sensors? crossed .*|wall that touches a circular sensor .*",
    ),
    Mechanism(
        "degenerate",
        "changes in the tail of a drop",
        "Pushed, or its floor switched off, while its bounces die out.",
        r".* in the tail of a drop.*|disable the floor the moment .*",
    ),
    Mechanism(
        "degenerate",
        "roofs",
        "On the peak of a roof, and slowly over its edge.",
        r".*the peak of a roof.*|slowly over the edge of a roof.*",
    ),
)


def tried_cases(mechanism: Mechanism) -> Iterator[tuple[Case, Image, str]]:
    """Return the cases of a mechanism, each with the image in which it is played, and its magnitude in words."""
    for case in CASES:
        if re.fullmatch(mechanism.cases, case.name):
            if not mechanism.scaled:
                yield case, Image(), case.name
            elif case.exact_scaling and not case.refused:
                for words, image in SCALES.items():
                    yield case, image, f"{case.name}, {words}"
