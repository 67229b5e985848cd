"""When balls hit each other.

Seen from one ball the other one flies under the difference of their accelerations: on a straight line where both are
under the same gravity, so that the hit is that of a circle of twice the radius, in closed form.
"""

import math

from bounce_env.engine.compile.jit import Feature, Record, Table, function, function_of_feature, routine
from bounce_env.engine.impact.circle import circle_time
from bounce_env.engine.memory.lookup import pull
from bounce_env.engine.memory.records import OUT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import magnitude, moved, sped, touch_tolerance
from bounce_env.engine.motion.instant import before, later, since
from bounce_env.engine.tolerances import (
    CORNER,
    LEFT_OVER,
    MEETINGS_AT_ONE_INSTANT,
    PRESSING,
    ULPS_OF_LENGTH,
    ULPS_OF_SPEED,
)


def _no_difference(ax: Feature, ay: Feature, bx: Feature, by: Feature) -> tuple[None, None]:
    return None, None


@function_of_feature(absent=_no_difference)
def difference(ax: Feature, ay: Feature, bx: Feature, by: Feature) -> tuple[Feature, Feature]:
    """Difference of two vectors; (None, None) where there is no gravity."""
    return ax - bx, ay - by


@function
def _drawn_off(x: float, y: float, gx: Feature, gy: Feature, reach: float) -> float:
    """The acceleration [m/s^2] that draws a ball at (x, y) off one at the origin which it touches; < 0: on it."""
    if gx is None:
        return 0.0
    return (x * gx + y * gy) / reach


@routine
def plan_pairs(state: State, pairs: Table, w: int, k: int) -> None:
    """Set when ball `k` hits each other ball, as long as both keep to their present flights."""
    if pairs is None:
        return
    for j in range(state.balls.shape[1]):
        if j != k:
            pair = pairs[w, max(j, k), min(j, k)]
            pair.hi, pair.lo = _meeting(state, w, max(j, k), min(j, k))


@function
def _meeting(state: State, w: int, k: int, j: int) -> tuple[float, float]:
    one, other = state.balls[w, k], state.balls[w, j]
    if OUT in (one.status, other.status):
        return math.inf, 0.0
    hi, lo = one.hi, one.lo
    if before(hi, lo, other.hi, other.lo):
        hi, lo = other.hi, other.lo
    s, t = since(hi, lo, one.hi, one.lo), since(hi, lo, other.hi, other.lo)
    ax, ay = pull(state.gravity, one)
    bx, by = pull(state.gravity, other)
    gx, gy = difference(ax, ay, bx, by)
    horizon = min(one.end_after - s, other.end_after - t)
    head = state.scenes[state.worlds[w].scene]
    slack = touch_tolerance(head.extent, one.vx, one.vy, ax, ay, s)
    slack = max(slack, touch_tolerance(head.extent, other.vx, other.vy, bx, by, t))
    x = moved(one.x, one.vx, ax, s) - moved(other.x, other.vx, bx, t)
    y = moved(one.y, one.vy, ay, s) - moved(other.y, other.vy, by, t)
    ux, uy, vx, vy = sped(one.vx, ax, s), sped(one.vy, ay, s), sped(other.vx, bx, t), sped(other.vy, by, t)
    reach, noise = 2.0 * head.ball_radius, pair_noise(one, other, ux, uy, vx, vy, head)
    wx, wy = ux - vx, uy - vy
    closing = -(x * wx + y * wy) / reach
    if x * x + y * y <= (reach + slack) * (reach + slack):
        if abs(closing) <= noise:
            # They neither close on each other nor come apart by more than rounding.
            off, turn = _drawn_off(x, y, gx, gy, reach), (wx * wx + wy * wy) / reach
            if off >= 0.0:
                return math.inf, 0.0
            # Of balls that are a little deep in each other a search would find no hit. Pressed for sure, though one
            # moves along the other: `_least_rebound` is to find so, too, or it would be told of for ever.
            if off + turn < -2.0 * PRESSING * (weight_of(one, other) + turn):
                return hi, lo
        elif closing > 0.0 and may_wait(state.worlds[w], closing, hi, lo):
            after = CORNER * ULPS_OF_LENGTH * head.extent / closing
            return later(hi, lo, after) if after <= horizon else (math.inf, 0.0)
    after = circle_time(x, y, wx, wy, gx, gy, reach, slack, horizon)
    if not after <= horizon or after == math.inf:
        return math.inf, 0.0
    return later(hi, lo, after)


@function
def pair_noise(one: Record, other: Record, vx: float, vy: float, ux: float, uy: float, head: Record) -> float:
    """Two balls that close slower than this [m/s] do not hit each other: rounding, or next to nothing under gravity."""
    return ULPS_OF_SPEED * (abs(vx) + abs(vy) + abs(ux) + abs(uy) + math.sqrt(weight_of(one, other) * head.ball_radius))


@function
def first_pair(pairs: Table, w: int, until_hi: float, until_lo: float) -> tuple[float, float, int, int]:
    """The earliest hit of two balls up to an instant: (hi, lo) and the two, the higher first; -1 if there is none."""
    hi, lo, one, other = math.inf, 0.0, -1, -1
    if pairs is None:
        return hi, lo, one, other
    for k in range(pairs.shape[1]):
        for j in range(k):
            pair = pairs[w, k, j]
            if not before(until_hi, until_lo, pair.hi, pair.lo) and before(pair.hi, pair.lo, hi, lo):
                hi, lo, one, other = pair.hi, pair.lo, k, j
    return hi, lo, one, other


@function
def may_wait(world: Record, closing: float, hi: float, lo: float) -> bool:
    """Whether a hit at the instant (hi, lo) of touching balls that close [m/s] on each other may wait until they are as
    deep in each other as the gaps of a corner: so slow a one is left of many faster ones at this instant.
    """
    at_once = world.meets > MEETINGS_AT_ONE_INSTANT and hi == world.meet_hi and lo == world.meet_lo
    return at_once and closing <= LEFT_OVER * world.meet_speed


@function
def weight_of(one: Record, other: Record) -> float:
    """The larger of the accelerations [m/s^2] that two balls are under."""
    return max(magnitude(one.gx, one.gy), magnitude(other.gx, other.gy))
