"""The bounce law: the tutorial's reflection in the frame of the surface, and the cap."""

import math

from bounce_env.engine.compile.jit import function


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
