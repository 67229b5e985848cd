"""Bumpers and arcs: billiards in circles, whispering galleries, scattering, ends, cusps."""

import math
from collections.abc import Callable

import mpmath

from bounce_env.report.stability.case import ULP, Case, Expect, Run, at, between, count, going, of_row, speed, when
from bounce_env.report.stability.cases.drops import NEAR, G, R, floor
from bounce_env.scene import Arc, Ball, Bumper, Scene, Wall

TURN = 2 * math.pi
# A ball that slides off a circle of 1 m from theta = 0.1 leaves it at cos(theta) = 2/3 cos(0.1), v^2 = g cos(theta).
SLID = math.sqrt(G) * (2 / 3 * math.cos(0.1)) ** 1.5  # [m/s] its vx from then on
FREE = (0.0, 0.0)
DOWN = (0.0, -G)


def ring(start: float = 0.0, **surface: float) -> Arc:
    """A closed circle of 1 m about the origin; `start` is where its seam would be."""
    return Arc((0, 0), 1, start, start + TURN, name="ring", **surface)


def spin(value: float, within: float) -> Expect:
    """Angular momentum about the origin, per mass [m^2/s]."""
    return Expect(
        "spin", lambda run: run.position[0] * run.velocity[1] - run.position[1] * run.velocity[0], value, within
    )


def energy(g: float) -> Callable[[Run], float]:
    """Energy per mass [J/kg] under gravity g downwards, from the origin's height."""
    return lambda run: math.hypot(*run.velocity) ** 2 / 2 + g * run.position[1]


def off_centre(x: float, y: float) -> Callable[[Run], float]:
    return lambda run: math.dist(run.position, (x, y))


def _circle(r: float, alpha: float, hits: int, seam: float) -> Case:
    """Elastic in a ring, from its point at angle 0, with `alpha` to the inward normal: chords of 2 rho cos(alpha)."""
    rho = 1.0 - r
    with mpmath.workdps(30):
        chord = 2 * mpmath.mpf(rho) * mpmath.cos(alpha)
        turn = mpmath.pi - 2 * mpmath.mpf(alpha)
        seconds = float(chord * (hits + mpmath.mpf(0.5)))
        a, b = (mpmath.mpf(rho) * mpmath.expj(turn * k) for k in (hits, hits + 1))
        way = (b - a) / chord
        end = a + (seconds - hits * chord) * way
    # A rounding of the speed along the ring changes alpha, the more the flatter it is, and with it all later chords.
    within = 16 * ULP * (hits + 10) ** 2 / math.cos(alpha)
    return Case(
        name=f"circle billiard r={r} alpha={alpha:.4f}, {hits} hits, seam at {seam}",
        why="numerics.md, check 4: phi_n = phi_0 + n (pi - 2 alpha), and the spin is conserved; no seam is felt",
        scene=Scene(gravity=FREE, ball=Ball(radius=r), elements=(ring(seam),)),
        position=(rho, 0.0),
        velocity=(-math.cos(alpha), math.sin(alpha)),
        script=(seconds,),
        rows="(ring bounce, )+ring bounce",
        expect=(
            count("ring bounce", hits),
            *at(float(end.real), float(end.imag), within),
            *going(float(way.real), float(way.imag), within / rho),
            spin(rho * math.sin(alpha), 4 * ULP * (hits + 10)),
        ),
    )


def _gallery(r: float, vn: float) -> Case:
    """b = 0 inside of a ring, no gravity: pressed by v_t^2 / rho, the ball goes round by small hops.

    f = 1 keeps v_t. A hop at v_n = v_t tan(phi) turns by phi / (sin phi cos phi) more than the circle would: a first
    one by 2 phi - sin(2 phi), those of the smallest rebound, phi <= 0.01, by less than 1e-4 of the way.
    """
    rho, vt, seconds = 1.0 - r, 2.0, 2.5
    phi = math.atan(vn / vt)
    angle = vt * seconds / rho + 2 * phi - math.sin(2 * phi)
    return Case(
        name=f"whispering gallery, b = 0, r={r}, vn={vn}",
        why="spin is conserved by f = 1; the way round is v_t t / rho, and the chords of the hops shorten it by < 1e-4",
        scene=Scene(gravity=FREE, ball=Ball(radius=r, b=0), elements=(ring(),)),
        position=(0.0, -rho),
        velocity=(vt, vn),
        script=(seconds,),
        expect=(
            spin(rho * vt, 1e-11),
            between("speed", lambda run: math.hypot(*run.velocity), vt * (1 - 1e-12), vt * (1 + 1e-4)),
            between("distance from the centre", off_centre(0, 0), rho * (1 - 1e-4), rho + NEAR),
            between(
                "angle", lambda run: math.atan2(run.position[0], -run.position[1]) % TURN, angle - 1e-9, angle * 1.0001
            ),
        ),
    )


_ROUND: dict[str, Bumper | Arc] = {
    "bumper": Bumper((0, 0), 1, name="round"),
    "ring": Arc((0, 0), 1, 0, TURN, name="round"),
    "ring with its seam in front": Arc((0, 0), 1, math.pi, 3 * math.pi, name="round"),
    "left half": Arc((0, 0), 1, math.pi / 2, 1.5 * math.pi, name="round"),
}


def _scatter(shape: str, offset: float, b: float, r: float) -> Case:
    """A straight path at `offset` from the middle of a circle, from outside; no gravity."""
    rho = 1.0 + r
    s = offset * rho
    alpha = math.asin(offset)
    hit = 3 - rho * math.cos(alpha)
    n, t = (-math.cos(alpha), math.sin(alpha)), (math.sin(alpha), math.cos(alpha))
    vx, vy = (b * math.cos(alpha) * n[k] + math.sin(alpha) * t[k] for k in (0, 1))
    left = 3.0 - hit
    return Case(
        name=f"{shape} from outside at {offset} of its radius, b={b}, r={r}",
        why="law at the angle asin(offset / radius); an arc struck from outside is a bumper",
        scene=Scene(gravity=FREE, ball=Ball(radius=r, b=b), elements=(_ROUND[shape],)),
        position=(-3.0, s),
        velocity=(1.0, 0.0),
        script=(3.0,),
        rows="round bounce",
        expect=(
            when("round bounce", hit, 16 * ULP),
            *at(-rho * math.cos(alpha) + vx * left, s + vy * left, NEAR),
            *going(vx, vy, 16 * ULP),
        ),
    )


def _edge(r: float) -> float:
    """vx of a ball that slides off a circle of 1 m under 2 m/s^2, with 0.5 m/s at its top."""
    size = 1 + r
    cosine = 2 / 3 + 0.25 / (3 * 2 * size)
    return math.sqrt(2 * size * cosine) * cosine


CURVES = [
    *(
        _circle(r, alpha, hits, seam)
        for r, alpha, hits, seam in (
            (0.0, 0.3, 200, 0.0),
            (R, 1.2, 200, 1.0),
            (0.0, math.pi / 2 - 1e-3, 1000, 0.0),
            (R, math.pi / 2 - 1e-3, 1000, -2.0),
            (R, 0.0, 200, 0.0),
            (0.999, 1.0, 100, 0.5),
        )
    ),
    # A point that starts on the circle along its tangent is as good as outside of it.
    *(_gallery(r, vn) for r, vn in ((0.0, 2.0**-20), (0.0, 0.5), (R, 0.0), (R, 0.5))),
    *(
        _scatter(shape, offset, b, r)
        for shape in _ROUND
        for offset, b, r in ((0.0, 1.0, 0.0), (-0.3, 1.0, R), (0.6, 0.5, 0.0), (0.8, 0.0, R))
    ),
    Case(
        name="inside of a half circle",
        why="law on the inside, at the angle asin(offset / radius), then out through the opening",
        scene=Scene(gravity=FREE, ball=Ball(radius=R), elements=(_ROUND["left half"],)),
        position=(2.0, 0.3 * (1 - R)),
        velocity=(-1.0, 0.0),
        script=(5.0,),
        rows="round bounce",
        expect=going(math.cos(2 * math.asin(0.3)), -math.sin(2 * math.asin(0.3)), 16 * ULP),
    ),
    Case(
        name="end of an arc, dead centre",
        why="the end's normal is against the velocity: straight back",
        scene=Scene(gravity=FREE, ball=Ball(radius=R), elements=(Arc((0, 0), 1, 0, math.pi, name="arch"),)),
        position=(1.0, -1 - R),
        velocity=(0.0, 1.0),
        script=(2.0,),
        rows="arch bounce",
        expect=(when("arch bounce", 1.0, 4 * ULP), *at(1.0, -1 - R, NEAR), *going(0.0, -1.0, 8 * ULP)),
    ),
    Case(
        name="elastic in a ring under gravity",
        why="energy is conserved",
        scene=Scene(gravity=DOWN, ball=Ball(radius=R), elements=(ring(),)),
        position=(0.1, 0.3),
        velocity=(1.0, 0.5),
        script=(1000.0,),
        rows="(ring bounce, )+ring bounce",
        expect=(between("energy", energy(G), 0.625 + 0.3 * G - 1e-11, 0.625 + 0.3 * G + 1e-11),),
    ),
    Case(
        name="slides off a bumper from rest",
        why="numerics.md, check 9: leaves where cos(theta) = 2/3 of the start's, then vx stays; hops cost 1 %",
        scene=Scene(gravity=DOWN, ball=Ball(b=0), elements=(Bumper((0, 0), 1, name="bumper"),)),
        position=(math.sin(0.1), math.cos(0.1)),
        script=(5.0,),
        expect=(between("vx", lambda run: run.velocity[0], 0.99 * SLID, 1.01 * SLID),),
    ),
    Case(
        name="point into the cusp between a floor and a circle on it",
        why="energy is conserved, and the closing walls turn the ball around: v_y times the gap is about constant",
        scene=Scene(gravity=FREE, elements=(floor(), Bumper((0, 1), 1, name="bumper"))),
        position=(0.5, 0.0625),
        velocity=(-1.0, -(2.0**-10)),
        script=(2.0,),
        expect=(
            speed(math.hypot(1.0, 2.0**-10), 1e-12),
            between("x", lambda run: run.position[0], 0.0, 3.0),
            between("vx", lambda run: run.velocity[0], 0.0, 1.0),
        ),
    ),
    Case(
        name="disc along the floor into the cusp under a bumper",
        why="energy is conserved; the bumper is met where x = 2 sqrt(r R), and the ball comes out again",
        scene=Scene(gravity=FREE, ball=Ball(radius=R), elements=(floor(), Bumper((0, 1), 1, name="bumper"))),
        position=(2.0, R),
        velocity=(-1.0, 0.0),
        script=(3.0,),
        expect=(
            when("bumper bounce", 2.0 - 2 * math.sqrt(R), 32 * ULP),
            speed(1.0, 64 * ULP),
            between("vx", lambda run: run.velocity[0], 0.0, 1.0),
        ),
    ),
    *(
        Case(
            name=f"over a rounded edge, r={r}",
            why="numerics.md, check 9, with a speed: leaves at cos(theta) = 2/3 + v^2 / (3 g R); hops cost 1 %",
            scene=Scene(
                gravity=(0, -2),
                ball=Ball(radius=r, b=0),
                elements=(
                    Wall((-3, 0), (0, 0), name="floor"),
                    Arc((0, -1), 1, 0, math.pi / 2, name="edge"),
                    Wall((1, -1), (1, -3), name="side"),
                ),
            ),
            position=(-1.0, r),
            velocity=(0.5, 0.0),
            script=(3.75,),
            expect=(
                of_row("floor end", "time", 2.0, 8 * ULP),
                between("vx", lambda run: run.velocity[0], 0.99 * _edge(r), 1.01 * _edge(r)),
            ),
        )
        for r in (0.0, R)
    ),
]
