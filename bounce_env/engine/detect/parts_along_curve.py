"""What a ball that slides on a curve meets among what moves: parts, by bounded-acceleration advancement.

The distance from a part is convex, so that in the frame of the part the gap f(t) has f'' >= -A, with A what the ball's
acceleration there does not exceed: on its circle v^2 / radius + G, v the speed in the lowest point.
"""

import math

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.impact.advancement import advancement_step, advancement_to_closing
from bounce_env.engine.impact.stretching_wall import stretching_wall_bound
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.curve_slide import curve_slide_of, curve_slide_period
from bounce_env.engine.motion.flight import Flight
from bounce_env.engine.motion.instant import later, since
from bounce_env.engine.motion.parts import (
    Core,
    MovingPart,
    is_dragged_part,
    moving_part,
    nearest_on_core,
    part_core_at,
    part_spin,
    part_stop_instant,
    part_surface_velocity,
)
from bounce_env.engine.motion.path import acceleration_bound, is_bent_and_moving, motion_after, top_speed_bound
from bounce_env.engine.tolerances import SEARCH_STEPS, ULPS_OF_LENGTH, ULPS_OF_SPEED


@where("curve_slides", otherwise=(math.inf, 0.0), inline=False)
def meet_part_along_curve(state: State, w: int, k: int, m: int, side: int, leaves_after: float) -> tuple[float, float]:
    """Return the instant at which a ball that slides on a curve hits part `m`: (hi, lo), inf if it does not.

    As `detect.parts`. Where they neither come closer nor part for very long the search ends before a hit.
    """
    ball, part, top_speed = state.balls[w, k], moving_part(state, w, m), top_speed_bound(state, w, k)
    motion, shape, extent = part.motion, part.shape, state.scenes[state.worlds[w].scene].extent
    t = max(since(motion.hi, motion.lo, ball.hi, ball.lo), 0.0)
    stop_hi, stop_lo = part_stop_instant(motion, shape)
    horizon = min(ball.end_after, leaves_after, since(stop_hi, stop_lo, ball.hi, ball.lo))
    if motion.velocity == 0.0 and not is_bent_and_moving(state, w, k):
        period = curve_slide_period(curve_slide_of(state.curve_slides[w, k]))
        horizon = min(horizon, t + 1.001 * period)  # what it has not met by then it never will
    if not horizon >= t:
        return math.inf, 0.0
    tolerance = ULPS_OF_LENGTH * (extent + top_speed * t)
    pull, away = acceleration_bound(state, w, k), 0.0
    for step in range(16 * SEARCH_STEPS):
        now_hi, now_lo = later(ball.hi, ball.lo, t)
        core = part_core_at(part, now_hi, now_lo)
        x, y, vx, vy = motion_after(state, w, k, t)
        nx, ny, distance, nearest = nearest_on_core(core, x, y, side, tolerance)
        ux, uy = part_surface_velocity(part, core, nearest * core.ux, nearest * core.uy)
        rate = (vx - ux) * nx + (vy - uy) * ny
        if step == 0 and distance - shape.offset_radius <= tolerance and rate > 0.0:
            away = distance - shape.offset_radius  # what is left of a gap after a bounce is rounding
        gap = distance - shape.offset_radius - away
        seen = Flight(x - core.x, y - core.y, vx, vy, None, None)
        window, bound = _advancement_bound(part, core, seen, pull, top_speed, horizon - t)
        if gap <= tolerance:
            if rate < -ULPS_OF_SPEED * (abs(vx) + abs(vy) + abs(ux) + abs(uy)):
                t += advancement_to_closing(gap, rate, bound)
                return later(ball.hi, ball.lo, t) if t <= horizon else (math.inf, 0.0)
            rate, gap = max(rate, 0.0), max(gap, 0.0)
        reached = t
        t += min(advancement_step(gap, rate, bound), window)
        if rate >= 0.0:
            # Along the surface no step is shorter than that in which a gap changes by what counts as touching.
            t = max(t, reached + math.sqrt(2.0 * tolerance / bound))
        if t > horizon or reached == horizon:
            return math.inf, 0.0
    return later(ball.hi, ball.lo, t)


@function
def _bound_beside_capsule(
    part: MovingPart, core: Core, seen: Flight, pull: float, top_speed: float, horizon: float
) -> tuple[float, float]:
    spin, _ = part_spin(part, core)
    if spin == 0.0:
        return horizon, pull
    # How far from the pivot it comes before it is looked at again.
    distance = math.sqrt(seen.x * seen.x + seen.y * seen.y) + core.front
    window = min(horizon, distance / top_speed)
    return window, pull + abs(spin) * (2.0 * top_speed + abs(spin) * (distance + top_speed * window))


@where("ends", otherwise=_bound_beside_capsule)
def _advancement_bound(
    part: MovingPart, core: Core, seen: Flight, pull: float, top_speed: float, horizon: float
) -> tuple[float, float]:
    """Return what the gap's second derivative stays above, with a minus: (duration [s] for which, A [m/s^2]).

    seen: the ball from where the core's (x, y) is now. pull: a bound of its acceleration [m/s^2].
    """
    if not is_dragged_part(part):
        return _bound_beside_capsule(part, core, seen, pull, top_speed, horizon)
    ends = part.ends
    dx, dy, ex, ey = core.front * core.ux, core.front * core.uy, ends.vx1 - ends.vx0, ends.vy1 - ends.vy0
    if ex == 0.0 and ey == 0.0:
        return horizon, pull
    spread = math.sqrt(ex * ex + ey * ey)
    moving = Flight(seen.x, seen.y, seen.vx - ends.vx0, seen.vy - ends.vy0, None, None)
    speed = math.sqrt(moving.vx * moving.vx + moving.vy * moving.vy)
    size = math.sqrt(seen.x * seen.x + seen.y * seen.y) + core.front
    window = min(horizon, 0.5 * size / (speed + spread + math.sqrt(pull * size)))
    return window, stretching_wall_bound(moving, pull, dx, dy, ex, ey, window)
