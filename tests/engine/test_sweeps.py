"""Parts that sweep over a ball, at any speed: no hit is missed and none is invented, against dense sampling.

The samples are taken in extended precision, and only here: the engine itself never samples.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from bounce_env.engine.compile.jit import from_python
from bounce_env.engine.impact import capsule, rotating_capsule, stretching_wall
from bounce_env.engine.motion.flight import Flight
from bounce_env.engine.motion.parts import Core
from tests.conftest import soak_count

rotating_capsule_time = from_python(rotating_capsule.rotating_capsule_time)
capsule_time = from_python(capsule.capsule_time)
stretching_wall_time = from_python(stretching_wall.stretching_wall_time)

SAMPLES = 4001


def gap(t, ball, angle, spin, drift, back, front, reach):
    """Distance of a ball from a capsule's surface at times `t`, as precise as these are.

    The core runs from `back` to `front` along a line through a point that moves at `drift` and turns at `spin`.
    """
    real = t.dtype.type
    x, y, vx, vy, gx, gy = map(real, ball)
    turned = real(angle) + real(spin) * t
    ux, uy = np.cos(turned), np.sin(turned)
    px = x + (vx - real(drift[0])) * t + gx * t * t / 2
    py = y + (vy - real(drift[1])) * t + gy * t * t / 2
    along = np.clip(px * ux + py * uy, real(back), real(front))
    return np.hypot(px - along * ux, py - along * uy) - real(reach)


def start(rng):
    """A ball near a capsule, and how both move; None where they overlap."""
    front = 10.0 ** rng.uniform(-1.5, 0.0)
    reach = front * 10.0 ** rng.uniform(-2.0, 0.0)
    angle = rng.uniform(0.0, 2.0 * math.pi)
    place = rng.uniform(-1.5, 1.5, 2) * (front + reach)
    heading, speed = rng.uniform(0.0, 2.0 * math.pi), rng.choice([0.0, 1e-3, 1.0, 10.0, 100.0])
    pull = rng.choice([0.0, 1.0, 10.0, 1000.0])
    tilt = rng.uniform(0.0, 2.0 * math.pi)
    ball = (
        *place.tolist(), speed * math.cos(heading), speed * math.sin(heading), pull * math.cos(tilt),
        pull * math.sin(tilt),
    )  # fmt: skip
    return ball, angle, front, reach


def check(found, horizon, gap_at, size, label):
    """No sample before the hit is inside; at the hit the surface is touched, and passed right after.

    Of what doubles show to be far from it no sample is taken in extended precision, too.
    """
    end = found if found < math.inf else horizon
    times = np.linspace(np.longdouble(0), np.longdouble(end), SAMPLES)
    near = times[gap_at(times.astype(float)) < 1e-6 * size]
    assert not near.size or gap_at(near).min() >= -1e-9 * size, label
    if found < math.inf:
        assert abs(gap_at(np.longdouble(found))) <= 1e-9 * size, label
        after = np.longdouble(found) + np.longdouble(horizon) * np.longdouble(10.0) ** np.arange(-12, 1)
        assert gap_at(after).min() < 1e-9 * size, label


class Sweep(NamedTuple):
    """A ball, something `length` long that moves at up to `speed`, and both ways to its surface `reach` away."""

    ball: tuple[float, ...]
    length: float
    reach: float
    speed: float
    horizon: float
    gap_at: Callable[[np.ndarray], np.ndarray]
    found: Callable[[float], float]  # by the engine, from what counts as touching


def hunt(draw: Callable[[np.random.Generator], Sweep]) -> None:
    """Soak: 10^5 sweeps, besides those that begin with an overlap."""
    swept, hits, seed = 0, 0, -1
    count = soak_count(1500, 100_000)
    while swept < count:
        seed += 1
        if seed % 10_000 == 0:
            print(draw.__name__, swept, hits, flush=True)  # noqa: T201
        sweep = draw(np.random.default_rng(seed))
        if sweep.gap_at(np.longdouble(0)) < 1e-6 * sweep.length:
            continue
        swept += 1
        size = 3.0 * (sweep.length + sweep.reach) + (math.hypot(*sweep.ball[2:4]) + sweep.speed) * sweep.horizon
        size += math.hypot(*sweep.ball[4:]) * sweep.horizon**2
        found = sweep.found(2.0**-48 * size)
        check(found, sweep.horizon, sweep.gap_at, size, seed)
        hits += found < math.inf
    print(f"{draw.__name__}: {swept} sweeps, {hits} hits")  # noqa: T201
    assert 0.1 * count < hits < 0.9 * count


def a_rotating_capsule(rng):
    ball, angle, front, reach = start(rng)
    spin = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-1.0, math.log10(200.0)))
    horizon = float(rng.uniform(0.1, 3.0) / abs(spin))
    core = Core(0.0, 0.0, math.cos(angle), math.sin(angle), 0.0, front)
    return Sweep(
        ball, front, reach, 0.0, horizon,
        lambda t: gap(t, ball, angle, spin, (0.0, 0.0), 0.0, front, reach),
        lambda slack: rotating_capsule_time(Flight(*ball), core, reach, spin, slack, horizon),
    )  # fmt: skip


def a_sliding_capsule(rng):
    ball, angle, front, reach = start(rng)
    ux, uy = math.cos(angle), math.sin(angle)
    speed = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-2.0, 2.0))
    drift, back = (speed * ux, speed * uy), -front * float(rng.uniform(0.0, 1.0))
    horizon = float(rng.uniform(0.5, 3.0) * front / abs(speed))
    x, y, vx, vy, gx, gy = ball
    seen = Flight(x, y, vx - drift[0], vy - drift[1], gx, gy)
    core = Core(0.0, 0.0, ux, uy, back, front)
    return Sweep(
        ball, front, reach, abs(speed), horizon,
        lambda t: gap(t, ball, angle, 0.0, drift, back, front, reach),
        lambda slack: capsule_time(seen, core, reach, slack, horizon),
    )  # fmt: skip


def wall_gap(t, ball, ends, speeds, reach):
    """Distance of a ball from a wall, whose two ends start at `ends` and move at `speeds`, at times `t`."""
    real = t.dtype.type
    x, y, vx, vy, gx, gy = map(real, ball)
    ax, ay, bx, by = (p + real(v) * t for p, v in zip(ends.ravel(), speeds.ravel(), strict=True))
    dx, dy = bx - ax, by - ay
    px, py = x + vx * t + gx * t * t / 2 - ax, y + vy * t + gy * t * t / 2 - ay
    share = np.clip((px * dx + py * dy) / (dx * dx + dy * dy), real(0), real(1))
    return np.hypot(px - share * dx, py - share * dy) - real(reach)


def a_stretching_wall(rng):
    ball, angle, length, reach = start(rng)
    ends = np.array([(0.0, 0.0), (length * math.cos(angle), length * math.sin(angle))])
    fastest = float(min(100.0, 200.0 * length) * 10.0 ** rng.uniform(-3.0, 0.0))
    speeds = rng.uniform(-1.0, 1.0, (2, 2)) * fastest
    (ex, ey), (dx, dy) = (speeds[1] - speeds[0]).tolist(), ends[1].tolist()
    horizon = float(rng.uniform(0.1, 3.0) * length / fastest)
    # As by the stop of a wall that may get no shorter: it keeps a twentieth of its length.
    nearest = min(max(-(dx * ex + dy * ey) / (ex * ex + ey * ey), 0.0), horizon)
    if math.hypot(dx + ex * nearest, dy + ey * nearest) < 0.05 * length:
        horizon = 0.9 * nearest
    x, y, vx, vy, gx, gy = ball
    seen = Flight(x, y, vx - float(speeds[0, 0]), vy - float(speeds[0, 1]), gx, gy)
    return Sweep(
        ball, length, reach, 4.0 * fastest, horizon,
        lambda t: wall_gap(t, ball, ends, speeds, reach),
        lambda slack: stretching_wall_time(seen, dx, dy, ex, ey, reach, 0, slack, horizon),
    )  # fmt: skip


def test_rotating_capsules() -> None:
    """Flippers at up to 200 rad/s."""
    hunt(a_rotating_capsule)


def test_sliding_capsules() -> None:
    """Paddles at up to 100 m/s."""
    hunt(a_sliding_capsule)


def test_stretching_walls() -> None:
    """Walls whose ends are dragged at up to 100 m/s, and turn at up to 200 rad/s."""
    hunt(a_stretching_wall)
