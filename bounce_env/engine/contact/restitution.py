"""The bounce law and its cap, and how a ball and a surface that it touches come together.

How fast they close, how hard the ball is pressed on the surface, and what is too slow to count. The law is the
tutorial's reflection in the frame of the surface (docs/physics.md, "Bounce law").
"""

import math

from bounce_env.engine.compile.jit import Record, function
from bounce_env.engine.tolerances import PRESSING, ULP, ULPS_OF_LENGTH, ULPS_OF_SPEED


@function
def bounce(
    vx: float, vy: float, nx: float, ny: float, ux: float, uy: float, rebound: float, f: float
) -> tuple[float, float]:
    """Velocity [m/s] after a hit, v' = u + f w_t + rebound n, with w = v - u; by the law `rebound` is b times -w.n.

    Tutorial, "Real bounce and friction": project on the wall and on its normal, scale by friction and bounciness,
    reverse, add. Unit vectors throughout: the tutorial's printed projections divide by the wall's length once where
    they must divide twice. `n` points from the element to the ball, `u` is the surface's velocity at the contact
    point; b and f are the products of ball's and element's.
    """
    wx, wy = vx - ux, vy - uy
    along = f * (wy * nx - wx * ny)
    return ux + (rebound * nx - along * ny), uy + (rebound * ny + along * nx)


@function
def capped(
    vx: float, vy: float, nx: float, ny: float, ux: float, uy: float, max_speed: float
) -> tuple[float, float, bool]:
    """Velocity shrunk to `max_speed` (vx, vy, whether it was): never so that the ball closes on the surface.

    If shrinking both components would leave the ball slower than the surface that pushes it, the normal one stays and
    the tangential one shrinks.
    """
    square = vx * vx + vy * vy
    if square <= max_speed * max_speed:
        return vx, vy, False
    shrink = max_speed / math.sqrt(square)
    sx, sy = vx * shrink, vy * shrink
    if (sx - ux) * nx + (sy - uy) * ny >= 0.0:
        return sx, sy, True
    normal = min(vx * nx + vy * ny, max_speed)
    along = vy * nx - vx * ny
    along = math.copysign(math.sqrt(max(max_speed * max_speed - normal * normal, 0.0)), along)
    return normal * nx - along * ny, normal * ny + along * nx, True


@function
def slow_speed(ball: Record, touch: Record) -> float:
    """Return the speed [m/s] below which closing is no hit: the rounding of velocities, and of a curve's normal."""
    speed = abs(ball.vx) + abs(ball.vy) + (abs(touch.ux) + abs(touch.uy))
    return (ULPS_OF_SPEED + ball.tolerance * abs(touch.curvature)) * speed


@function
def closing_speed(ball: Record, touch: Record) -> float:
    """Return how fast [m/s] the ball and a surface that it touches come closer."""
    return -((ball.vx - touch.ux) * touch.nx + (ball.vy - touch.uy) * touch.ny)


@function
def is_leaving(ball: Record, touch: Record) -> bool:
    """Return whether the ball leaves a surface that it touches, by more than rounding."""
    return closing_speed(ball, touch) < -slow_speed(ball, touch)


@function
def along_speed(ball: Record, touch: Record) -> float:
    """Return the speed [m/s] of the ball along a surface that it touches, counter-clockwise about it positive."""
    return (ball.vy - touch.uy) * touch.nx - (ball.vx - touch.ux) * touch.ny


@function
def surface_speed(touch: Record) -> float:
    """Return how fast [m/s] a touched surface itself moves towards the ball; 0 where it stands or slides along it."""
    speed = touch.ux * touch.nx + touch.uy * touch.ny
    return speed if abs(speed) > ULPS_OF_SPEED * (abs(touch.ux) + abs(touch.uy)) else 0.0


@function
def is_holding(f: float, rest_speed: float) -> bool:
    """Return whether friction stops a ball that is pressed on a surface (docs/physics.md, "Contact")."""
    return f == 0.0 or (f < 1.0 and rest_speed == 0.0)


@function
def ahead_of_both(one: Record, other: Record, turn: float) -> tuple[float, float]:
    """Return the velocity [m/s] that keeps up with two touched surfaces, along both; turn: the sine between normals."""
    a, b = surface_speed(one), surface_speed(other)
    return (a * other.ny - b * one.ny) / turn, (b * one.nx - a * other.nx) / turn


@function
def forces_on_both(ball: Record, one: Record, other: Record, turn: float) -> tuple[float, float]:
    """Return the forces per mass [m/s^2] along two normals that bear a ball; turn: the sine between these."""
    return (ball.gy * other.nx - ball.gx * other.ny) / turn, (ball.gx * one.ny - ball.gy * one.nx) / turn


@function
def is_standing(touch: Record) -> bool:
    """Return whether a touched surface does not move now."""
    return not touch.moves and touch.ux == 0.0 and touch.uy == 0.0


@function
def is_sliding_curve(touch: Record) -> bool:
    """Return whether a ball slides on a touched surface as on a circle: it is one, and stands or translates."""
    return touch.curvature != 0.0 and not touch.moves


@function
def normal_load(ball: Record, touch: Record) -> float:
    """Return the acceleration [m/s^2] that presses the ball on a surface that it moves along; 0 where it does not.

    Gravity's share, and on a curve what it takes to follow it.
    """
    press = -gap_acceleration(ball, touch)
    return press if press > load_noise(ball, touch) else 0.0


@function
def gap_acceleration(ball: Record, touch: Record) -> float:
    """Return the second derivative [m/s^2] of the gap to a touched surface, if only gravity and fields acted."""
    along = along_speed(ball, touch)
    return ball.gx * touch.nx + ball.gy * touch.ny + touch.curvature * along * along


@function
def load_noise(ball: Record, touch: Record) -> float:
    """Return what of a gap's second derivative [m/s^2] is rounding."""
    pull, along = abs(ball.gx) + abs(ball.gy), along_speed(ball, touch)
    if touch.curvature == 0.0:
        return PRESSING * pull
    bend = abs(touch.curvature)
    return pull * (ball.tolerance * bend + 4.0 * ULP) + 8.0 * ULP * bend * along * along


@function
def gap_trend(ball: Record, touch: Record) -> int:
    """Return 1 where the gap to a touched surface opens, -1 where it closes, 0 where it stays: ball and surface go on.

    The first derivative of the gap that is not zero decides (docs/physics.md, "Leave, hit or stay"); zero is what is
    below its rounding.
    """
    rate, slow = -closing_speed(ball, touch), slow_speed(ball, touch)
    if abs(rate) > slow:
        return 1 if rate > 0.0 else -1
    second = gap_acceleration(ball, touch)
    if abs(second) > load_noise(ball, touch):
        return 1 if second > 0.0 else -1
    along, pull = along_speed(ball, touch), ball.gy * touch.nx - ball.gx * touch.ny
    third = 3.0 * touch.curvature * along * pull
    relative = ball.tolerance * abs(touch.curvature) + 8.0 * ULP
    if abs(third) > 3.0 * abs(touch.curvature * along) * (abs(ball.gx) + abs(ball.gy)) * relative:
        return 1 if third > 0.0 else -1
    turn = touch.curvature * along * along
    fourth = touch.curvature * (pull * pull + turn * turn)
    return 1 if fourth > 0.0 else (-1 if fourth < 0.0 else 0)


@function
def is_soft(closing: float, press: float, extent: float) -> bool:
    """Return whether a hop at this speed [m/s] does not rise above the tolerance of lengths."""
    return closing <= soft_speed(press, extent)


@function
def soft_speed(press: float, extent: float) -> float:
    """Return the speed [m/s] of a hop that rises by the tolerance of lengths."""
    return math.sqrt(2.0 * press * (ULPS_OF_LENGTH * extent))


@function
def push_off(ball: Record, touch: Record, speed: float) -> None:
    """Add `speed` [m/s] along a surface's normal to the ball's velocity; less than 0 takes from it."""
    ball.vx, ball.vy = ball.vx + speed * touch.nx, ball.vy + speed * touch.ny
