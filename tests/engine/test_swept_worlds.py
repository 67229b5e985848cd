"""Parts that sweep over a ball in a world: every hit is there, once, and as strong as the formula says.

A part is looked at as what it is: a line between two points that move, with all that is nearer to it than its radius.
Where it is comes from long doubles, and whether the ball keeps out of it from dense samples; both only here.
"""

import math
from collections import Counter
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest

from bounce_env import Ball, Flipper, Paddle, Scene, Wall
from bounce_env.report.stability.case import new_world
from tests.conftest import soak_count

pytestmark = pytest.mark.slow

SAMPLES = 500  # between two hits
HITS = 4  # of one sweep that are looked at
Ends = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


class Sweep(NamedTuple):
    """A part about `size` long that moves as it is told for `seconds`, its surface `radius` off its core."""

    part: Flipper | Paddle | Wall
    order: Any
    ends: Callable[[np.ndarray], Ends]  # of its core at an instant
    surface: Callable[[float, np.ndarray, float], np.ndarray]  # velocity at an instant, a place, a share of the core
    radius: float
    size: float
    seconds: float
    spin: float  # rad/s, at most


def flipper(rng: np.random.Generator, radius: float, **material: float) -> Sweep:
    length, angle = 10.0 ** rng.uniform(-1.5, 0.0), rng.uniform(0.0, 2.0 * math.pi)
    spin = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-1.0, math.log10(200.0)))
    seconds = float(rng.uniform(0.1, 3.0) / abs(spin))
    radius *= length
    part = Flipper(
        (0.0, 0.0), length, radius=radius, rest_angle=angle, active_angle=angle + 1.01 * spin * seconds,
        up_speed=abs(spin), down_speed=1.0, name="part", **material,
    )  # fmt: skip

    def ends(t):
        turned = np.longdouble(angle) + np.longdouble(spin) * t
        return 0.0 * t, 0.0 * t, length * np.cos(turned), length * np.sin(turned)

    return Sweep(part, True, ends, lambda t, r, share: spin * np.array([-r[1], r[0]]), radius, length, seconds, spin)


def paddle(rng: np.random.Generator, radius: float, **material: float) -> Sweep:
    half, angle = 10.0 ** rng.uniform(-1.5, 0.0), rng.uniform(0.0, 2.0 * math.pi)
    u = np.array([math.cos(angle), math.sin(angle)])
    speed = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-2.0, 2.0))
    seconds = float(rng.uniform(0.5, 3.0) * half / abs(speed))
    radius *= half
    rail = 1.01 * abs(speed) * seconds * u
    part = Paddle(
        tuple((-rail).tolist()), tuple(rail.tolist()), half_width=half, radius=radius, max_speed=abs(speed),
        name="part", **material,
    )  # fmt: skip

    def ends(t):
        (ux, uy), way = map(np.longdouble, u), np.longdouble(speed) * t
        return (way - half) * ux, (way - half) * uy, (way + half) * ux, (way + half) * uy

    return Sweep(part, speed, ends, lambda t, r, share: speed * u, radius, half, seconds, 0.0)


def wall(rng: np.random.Generator, radius: float, **material: float) -> Sweep:
    length, angle = 10.0 ** rng.uniform(-1.5, 0.0), rng.uniform(0.0, 2.0 * math.pi)
    tip = length * np.array([math.cos(angle), math.sin(angle)])
    fastest = float(min(100.0, 200.0 * length) * 10.0 ** rng.uniform(-3.0, 0.0))
    speeds = rng.uniform(-1.0, 1.0, (2, 2)) * fastest / math.sqrt(2.0)
    change, seconds = speeds[1] - speeds[0], float(rng.uniform(0.1, 3.0) * length / fastest)
    # It ends before the wall is as short as a twentieth of its length.
    nearest = min(max(float(-(tip @ change) / (change @ change)), 0.0), seconds)
    shortest = math.hypot(*(tip + nearest * change))
    if shortest < 0.05 * length:
        seconds, shortest = 0.9 * nearest, math.hypot(*(tip + 0.9 * nearest * change))
    end, least = tuple(tip.tolist()), 0.04 * length
    part = Wall((0.0, 0.0), end, draggable=True, min_length=least, name="part", **material)

    def ends(t):
        (ax, ay), (bx, by) = (p[:, None] * t for p in speeds.astype(np.longdouble))
        return ax, ay, tip[0] + bx, tip[1] + by

    def surface(t, r, share):
        return (1.0 - share) * speeds[0] + share * speeds[1]

    turn = math.hypot(*change) / shortest
    return Sweep(part, tuple(map(tuple, speeds.tolist())), ends, surface, 0.0, length, seconds, turn)


def nearest(ends: Ends, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """From the nearest point of a line to (x, y), and at which share of the line it is."""
    ax, ay, bx, by = ends
    dx, dy = bx - ax, by - ay
    share = np.clip(((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy), np.longdouble(0), np.longdouble(1))
    return x - ax - share * dx, y - ay - share * dy, share


@pytest.mark.parametrize("draw", [flipper, paddle, wall])
def test_swept_worlds(draw: Callable[..., Sweep]) -> None:
    """Soak: 10^5 sweeps of each kind, at up to 200 rad/s and 100 m/s."""
    seen: Counter[str] = Counter()
    seed, count = -1, soak_count(150, 100_000)
    while seen["swept"] < count:
        seed += 1
        if seed % 5000 == 0:
            print(draw.__name__, dict(seen), flush=True)  # noqa: T201
        rng = np.random.default_rng([seed, 3])
        b, f = float(rng.choice([1.0, 0.7])), float(rng.choice([1.0, 0.5]))
        share = 10.0 ** rng.uniform(-2.0, 0.0)
        sweep = draw(rng, share * rng.uniform(0.05, 0.95), b=b, f=f)
        radius = max(share * sweep.size - sweep.radius, 0.01 * sweep.size)
        place = rng.uniform(-1.5, 1.5, 2) * (sweep.size + sweep.radius + radius)
        way, tilt = rng.uniform(0.0, 2.0 * math.pi, 2)
        velocity = rng.choice([0.0, 1e-3, 1.0, 10.0, 100.0]) * np.array([math.cos(way), math.sin(way)])
        pull = rng.choice([0.0, 1.0, 10.0, 1000.0]) * np.array([math.cos(tilt), math.sin(tilt)])
        gx, gy, _ = nearest(sweep.ends(np.zeros(1, np.longdouble)), *place)
        if math.hypot(gx[0], gy[0]) < 1.001 * (sweep.radius + radius):
            continue
        seen["swept"] += 1
        watch(sweep, radius, place, velocity, pull, b, f, seen, seed)
    print(draw.__name__, dict(seen))  # noqa: T201
    assert 0.1 * count < seen["hits"]
    assert seen["strikes measured"] > 0.05 * count


def watch(
    sweep: Sweep, radius: float, place: np.ndarray, velocity: np.ndarray, pull: np.ndarray, b: float, f: float,
    seen: Counter[str], seed: int,
) -> None:  # fmt: skip
    """Play one sweep, and look at its hits and at the flights between them."""
    seconds = min(
        sweep.seconds, 30.0 * sweep.size / max(math.hypot(*velocity), 1e-9),
        math.sqrt(30.0 * sweep.size / max(math.hypot(*pull), 1e-9)),
    )  # fmt: skip
    far = 200.0 * (sweep.size + radius)
    frame = (Wall((-far, -far), (far, -far)), Wall((-far, far), (far, far)))
    world = new_world(Scene(gravity=tuple(pull), ball=Ball(radius=radius), elements=(sweep.part, *frame)))
    world.reset(position=place, velocity=velocity)
    world.command("part", sweep.order)
    rows = world.advance(seconds, ledger=True, max_events=4 * HITS)
    hits = [row for row in rows if row["kind"] < 3]
    time, tolerance = 0.0, 1e-9 * (sweep.size + radius)
    for n in range(HITS + 1):
        until = float(hits[n]["time"]) if n < len(hits) else min(world.time, seconds)
        t = np.linspace(np.longdouble(time), np.longdouble(until), SAMPLES)
        x, y = (p + (t - time) * (v + (t - time) * g / 2) for p, v, g in zip(place, velocity, pull, strict=True))
        off = np.hypot(*nearest(sweep.ends(t), x, y)[:2]) - (sweep.radius + radius)
        assert off.min() >= -tolerance, (seed, n, "missed")
        if n >= len(hits) or n == HITS or hits[n]["kind"] != 0 or hits[n]["element"] != 0:
            return
        row = hits[n]
        assert abs(off[-1]) <= tolerance, (seed, n, "invented")
        assert until > time or n == 0, (seed, n, "twice")
        place, old = np.array([row["x"], row["y"]]), np.array([row["vx0"], row["vy0"]])
        velocity, time = np.array([row["vx1"], row["vy1"]]), until
        strike(sweep, row, radius, place, old, velocity, pull, b, f, seen, (seed, n))


def strike(
    sweep: Sweep, row: Any, radius: float, place: np.ndarray, old: np.ndarray, new: np.ndarray, pull: np.ndarray,
    b: float, f: float, seen: Counter[str], label: tuple[int, int],
) -> None:  # fmt: skip
    """What a hit did: by the surface's velocity where it was hit."""
    seen["hits"] += 1
    dx, dy, share = nearest(sweep.ends(np.array([row["time"]], np.longdouble)), *place)
    n = np.array([dx[0], dy[0]], float) / math.hypot(dx[0], dy[0])
    u = sweep.surface(float(row["time"]), place - radius * n, float(share[0]))
    scale = math.hypot(*u) + math.hypot(*old)
    assert math.hypot(row["ux"] - u[0], row["uy"] - u[1]) <= 1e-9 * scale, label
    closing = -float((old - u) @ n)
    assert closing > -1e-9 * scale, label
    assert (new - u) @ n >= b * closing - 1e-9 * scale, label
    # Slower ones may get the smallest rebound of a part that turns.
    reach = 2.0 * (sweep.size + sweep.radius) + 3.0 * sweep.size * abs(sweep.spin) * sweep.seconds
    if closing > 0.02 * math.sqrt((math.hypot(*pull) + sweep.spin**2 * reach) * reach):
        along = old - u + closing * n
        right = u + f * along + b * closing * n
        assert math.hypot(*(new - right)) <= 1e-9 * scale, label
        seen["strikes measured"] += 1
