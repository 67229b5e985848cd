"""Slides on circles in closed form: the ball moves like a pendulum (docs/physics.md, "Slides on curves").

The angle theta is counted counter-clockwise from the circle's lowest point, where "down" is along the acceleration of
gravity and fields. With S = sin(theta / 2) and C = cos(theta / 2) a pendulum that swings has S = S_max sn(u), one that
goes round has S = sn(u), and u grows uniformly in time. Points are told by S and C, never by heights: these lose digits
next to the lowest and the highest point.
"""

import math
from typing import NamedTuple

from bounce_env.engine.compile.jit import Record, function, routine
from bounce_env.engine.motion.elliptic import carlson_rf, jacobi_sn_cn_dn, quarter_period


class CurveSlide(NamedTuple):
    """A slide on a circle: the columns of `CURVE_SLIDE` that tell of its motion, in the frame of the circle."""

    x: float  # [m] the circle's centre, when it began
    y: float
    radius: float  # [m] of the path
    down_x: float  # unit vector from the centre to the lowest point
    down_y: float
    sense: float  # 1.0 begins counter-clockwise, -1.0 clockwise: mirror images have the same phases
    swings: bool  # to and fro, or goes round
    complement: float  # 1 - m of its elliptic functions
    lowest_speed: float  # [m/s] that it has, or would have, in the lowest point
    rate: float  # [1/s] of the phase u
    phase: float  # u when it began
    ux: float  # [m/s] velocity of the circle
    uy: float


@function
def curve_slide_of(slide: Record) -> CurveSlide:
    """Return the motion that a row of `CURVE_SLIDE` holds."""
    return CurveSlide(
        slide.x, slide.y, slide.radius, slide.down_x, slide.down_y, slide.sense, slide.swings != 0, slide.complement,
        slide.lowest_speed, slide.rate, slide.phase, slide.ux, slide.uy,
    )  # fmt: skip


@function
def half_angle(sine: float, cosine: float) -> tuple[float, float]:
    """Return sine and cosine of half an angle in (-pi, pi], the larger of them first, so that nothing cancels."""
    if cosine >= 0.0:
        c = math.sqrt(0.5 * (1.0 + cosine))
        return 0.5 * sine / c, c
    s = math.copysign(math.sqrt(0.5 * (1.0 - cosine)), sine)
    return s, 0.5 * sine / s


@function
def half_angle_from_lowest(slide: CurveSlide, nx: float, ny: float) -> tuple[float, float]:
    """Return S and C of the point of a slide's circle in the direction (nx, ny) from its centre."""
    sine = slide.down_x * ny - slide.down_y * nx
    return half_angle(sine, slide.down_x * nx + slide.down_y * ny)


@function
def direction_from_lowest(slide: CurveSlide, s: float, c: float) -> tuple[float, float]:
    """Return the direction from the centre to the point of a slide's circle with these S and C."""
    sine, cosine = 2.0 * s * c, (c - s) * (c + s)
    return slide.down_x * cosine - slide.down_y * sine, slide.down_y * cosine + slide.down_x * sine


@routine
def new_curve_slide(
    x: float, y: float, radius: float, nx: float, ny: float, speed: float, gx: float, gy: float, ux: float, uy: float
) -> CurveSlide:
    """Return the slide on a circle about (x, y) that begins in the direction (nx, ny) from there at `speed` [m/s].

    speed: relative to the circle, counter-clockwise positive. (gx, gy): acceleration of gravity and fields [m/s^2].
    Either is not 0, and the ball does not stand on the highest point. (ux, uy): velocity of the circle [m/s].
    """
    pull = math.sqrt(gx * gx + gy * gy)
    down_x, down_y = (gx / pull, gy / pull) if pull > 0.0 else (nx, ny)
    slide = CurveSlide(x, y, radius, down_x, down_y, 1.0, False, 1.0, 0.0, 0.0, 0.0, ux, uy)
    s, c = half_angle_from_lowest(slide, nx, ny)
    to_top = 4.0 * pull * radius  # the square of the speed that it takes from the lowest to the highest point
    square = speed * speed + to_top * s * s
    at_top = speed * speed - to_top * c * c
    lowest_speed = math.sqrt(square)
    swings = at_top < 0.0
    if swings:
        complement, rate = -at_top / to_top, math.sqrt(pull / radius)
    else:
        complement, rate = max(at_top / square, _LEAST_COMPLEMENT), 0.5 * lowest_speed / radius
    # A ball that stands in a turning point on the right will go on clockwise.
    sense = 1.0 if speed > 0.0 or (speed == 0.0 and s < 0.0) else -1.0
    slide = CurveSlide(x, y, radius, down_x, down_y, sense, swings, complement, lowest_speed, rate, 0.0, ux, uy)
    phase = _phase_at(slide, s, c, speed * speed / square)
    return CurveSlide(x, y, radius, down_x, down_y, sense, swings, complement, lowest_speed, rate, phase, ux, uy)


# On the separatrix a ball needs infinitely long to the top; next to it this keeps its phase finite.
_LEAST_COMPLEMENT = 1e-280


@function
def largest_half_angle_sine(slide: CurveSlide) -> float:
    """Return the largest S of a slide that swings."""
    return 0.5 * slide.lowest_speed / (slide.rate * slide.radius)


@function
def _phase_at(slide: CurveSlide, s: float, c: float, speed_share: float) -> float:
    """Return the phase, in [-K, K], at the point (s, c) of the path, passed in the direction in which the slide began.

    speed_share: of a slide that swings the square of its speed there over that in the lowest point.
    """
    if not slide.swings:
        return slide.sense * s * carlson_rf(c * c, c * c + slide.complement * s * s, 1.0)
    sn = slide.sense * min(max(s / largest_half_angle_sine(slide), -1.0), 1.0)
    return sn * carlson_rf(min(speed_share, 1.0), c * c, 1.0)


@function
def curve_slide_period(slide: CurveSlide) -> float:
    """Return after how long [s] a slide comes through the same point in the same direction."""
    return (4.0 if slide.swings else 2.0) * quarter_period(slide.complement) / slide.rate


@routine
def curve_slide_time_to(slide: CurveSlide, s: float, c: float, forth: bool) -> float:
    """Return how long [s] after its beginning a slide is at a point of its path, to within whole periods.

    forth: whether it passes that point counter-clockwise. Before its beginning the time is less than 0.
    """
    share = s / largest_half_angle_sine(slide)
    phase = _phase_at(slide, s, c, max((1.0 - share) * (1.0 + share), 0.0))
    if forth != (slide.sense > 0.0):
        phase = 2.0 * quarter_period(slide.complement) - phase
    return (phase - slide.phase) / slide.rate


@routine
def curve_slide_after(slide: CurveSlide, t: float) -> tuple[float, float, float, float]:
    """Return where a slide is after `t` seconds, and its velocity: (x, y, vx, vy) [m, m/s]."""
    sn, cn, dn = jacobi_sn_cn_dn(slide.phase + slide.rate * t, slide.complement)
    s, c, speed = sn, cn, dn
    if slide.swings:
        s, c, speed = sn * largest_half_angle_sine(slide), dn, cn
    s, speed = slide.sense * s, slide.sense * slide.lowest_speed * speed
    nx, ny = direction_from_lowest(slide, s, c)
    x, y = slide.x + slide.ux * t, slide.y + slide.uy * t
    return x + slide.radius * nx, y + slide.radius * ny, slide.ux - speed * ny, slide.uy + speed * nx


@function
def curve_slide_top_speed(slide: CurveSlide) -> float:
    """Return a speed [m/s] that a slide does not exceed."""
    return slide.lowest_speed + math.sqrt(slide.ux * slide.ux + slide.uy * slide.uy)


@function
def curve_slide_acceleration(slide: CurveSlide, gx: float, gy: float) -> float:
    """Return the magnitude [m/s^2] that a slide's acceleration does not exceed."""
    return slide.lowest_speed * slide.lowest_speed / slide.radius + math.sqrt(gx * gx + gy * gy)
