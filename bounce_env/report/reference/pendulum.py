"""Slides on circles from elliptic integrals and functions of 40 digits: an independent judge of the engine's.

It knows nothing of Carlson's forms, of half angles or of the engine's phase: the amplitude of mpmath's own functions.
"""

from collections.abc import Callable

import mpmath as mp

DIGITS = 40


def pendulum_place(radius: float, x: float, y: float, speed: float, pull: float, t: mp.mpf) -> tuple[float, float]:
    """Return where a ball on a circle about the origin is after `t` seconds, gravity `pull` downwards.

    (x, y): where it starts, of which only the direction counts. speed: counter-clockwise positive [m/s].
    """
    with mp.workdps(DIGITS):
        theta = mp.atan2(mp.mpf(x), -mp.mpf(y))
        r, v, g = mp.mpf(radius), mp.mpf(speed), mp.mpf(pull)
        if g == 0:
            theta += v / r * t
        else:
            theta = _theta_after(r, theta, v, g, mp.mpf(t))
        return float(r * mp.sin(theta)), float(-r * mp.cos(theta))


def _theta_after(r: mp.mpf, theta: mp.mpf, v: mp.mpf, g: mp.mpf, t: mp.mpf) -> mp.mpf:
    lowest_square = v * v + 4 * g * r * mp.sin(theta / 2) ** 2
    m = lowest_square / (4 * g * r)
    if m < 1:  # it swings
        share = mp.sin(theta / 2) / mp.sqrt(m)
        share = max(min(share, mp.mpf(1)), mp.mpf(-1))
        u = mp.ellipf(mp.asin(share), m)
        u = u if v >= 0 else 2 * mp.ellipk(m) - u
        return 2 * mp.asin(mp.sqrt(m) * mp.ellipfun("sn", u + mp.sqrt(g / r) * t, m=m))
    sense = 1 if v >= 0 else -1
    m = 1 / m
    u = mp.ellipf(sense * theta / 2, m) + mp.sqrt(lowest_square) / (2 * r) * t
    return sense * 2 * mp.atan2(mp.ellipfun("sn", u, m=m), mp.ellipfun("cn", u, m=m))


def release_cosine(radius: float, x: float, y: float, speed: float, pull: float) -> float:
    """Return the height at which the circle no longer presses the ball, as a share of its radius: E / (3 G radius)."""
    with mp.workdps(DIGITS):
        height = mp.mpf(radius) * mp.mpf(y) / mp.hypot(mp.mpf(x), mp.mpf(y))
        return float((mp.mpf(speed) ** 2 + 2 * mp.mpf(pull) * height) / (3 * mp.mpf(pull) * mp.mpf(radius)))


def pendulum_flight(
    radius: float, x: float, y: float, speed: float, pull: float, *, lets_go: bool
) -> tuple[Callable[[mp.mpf], tuple[float, float]], mp.mpf]:
    """Return the place at a time, and when the ball strikes the circle again, of one that slides inside of it.

    lets_go: whether it comes to where the circle no longer presses it (it must be on its way up); otherwise it slides
    for ever, and the second is infinite.
    """
    if not lets_go:
        return lambda t: pendulum_place(radius, x, y, speed, pull, t), mp.inf
    with mp.workdps(DIGITS):
        r, v, g = mp.mpf(radius), mp.mpf(speed), mp.mpf(pull)
        sense = 1 if v >= 0 else -1
        start, height = sense * mp.atan2(mp.mpf(x), -mp.mpf(y)), mp.mpf(radius) * mp.mpf(y) / mp.hypot(x, y)
        end = mp.acos(-(v * v + 2 * g * height) / (3 * g * r))
        release = _time_between(r, start, end, abs(v), g)
        px, py = sense * r * mp.sin(end), -r * mp.cos(end)
        left = mp.sqrt(v * v - 2 * g * (py - height))
        vx, vy = sense * left * mp.cos(end), left * mp.sin(end)
        # Gap, its rate and its second derivative are zero at the release: of the quartic two terms are left.
        again = release + 4 * vy / g

    def place(t: mp.mpf) -> tuple[float, float]:
        if t <= release:
            return pendulum_place(radius, x, y, speed, pull, t)
        s = t - release
        return float(px + vx * s), float(py + vy * s - g * s * s / 2)

    return place, again


def _time_between(r: mp.mpf, start: mp.mpf, end: mp.mpf, v: mp.mpf, g: mp.mpf) -> mp.mpf:
    """Return how long it takes from one angle to another, both ahead of the first turning point."""
    lowest_square = v * v + 4 * g * r * mp.sin(start / 2) ** 2
    m = lowest_square / (4 * g * r)
    if m < 1:
        phases = [mp.ellipf(mp.asin(mp.sin(theta / 2) / mp.sqrt(m)), m) for theta in (start, end)]
        return (phases[1] - phases[0]) / mp.sqrt(g / r)
    phases = [mp.ellipf(theta / 2, 1 / m) for theta in (start, end)]
    return (phases[1] - phases[0]) * 2 * r / mp.sqrt(lowest_square)
