"""When two balls hit each other of which one at least slides on a curve: by bounded-acceleration advancement."""

import math

from bounce_env.engine.compile.jit import function, routine
from bounce_env.engine.impact.advancement import advancement_step, advancement_to_closing
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import before, later, since
from bounce_env.engine.motion.path import acceleration_bound, acceleration_in, motion_after, path_length_bound
from bounce_env.engine.tolerances import CLUSTER_GAP, PRESSING, SEARCH_STEPS, ULPS_OF_LENGTH, ULPS_OF_SPEED

# [s] as long as balls that touch are not looked at again, at most.
LONGEST_LOOK = 64.0


@function
def time_to_press(second: float, third: float, extent: float) -> float:
    """Return after how long [s] two balls that touch and neither close nor open are to be resolved; inf: never.

    second, third: derivatives [m/s^2, m/s^3] of their gap. What they overlap by then is a part of what a cluster may.
    """
    if second >= 0.0 and third >= 0.0:
        return math.inf
    seconds, second, third = LONGEST_LOOK, max(-second, 0.0), max(-third, 0.0)
    while (0.5 * second + third / 6.0 * seconds) * (seconds * seconds) > 0.25 * CLUSTER_GAP * extent:
        seconds *= 0.5
    return seconds


@routine
def meeting_along_curve(state: State, w: int, k: int, j: int) -> tuple[float, float]:
    """Return when balls `k` and `j` hit each other, if both keep to their paths: (hi, lo); inf if they do not.

    Where they neither come closer nor part for very long the search ends before a hit.
    """
    one, other, head = state.balls[w, k], state.balls[w, j], state.scenes[state.worlds[w].scene]
    hi, lo = one.hi, one.lo
    if before(hi, lo, other.hi, other.lo):
        hi, lo = other.hi, other.lo
    s, t = since(hi, lo, one.hi, one.lo), since(hi, lo, other.hi, other.lo)
    horizon = min(one.end_after - s, other.end_after - t)
    way = max(path_length_bound(state, w, k, s), path_length_bound(state, w, j, t))
    tolerance, border = ULPS_OF_LENGTH * (head.extent + way), 2.0 * head.ball_radius
    bound, after, away = acceleration_bound(state, w, k) + acceleration_bound(state, w, j), 0.0, 0.0
    for step in range(16 * SEARCH_STEPS):
        of_one, of_other = motion_after(state, w, k, s + after), motion_after(state, w, j, t + after)
        x, y, vx, vy = (
            of_one[0] - of_other[0],
            of_one[1] - of_other[1],
            of_one[2] - of_other[2],
            of_one[3] - of_other[3],
        )
        distance = math.sqrt(x * x + y * y)
        rate = (x * vx + y * vy) / distance
        slow = ULPS_OF_SPEED * (abs(of_one[2]) + abs(of_one[3]) + abs(of_other[2]) + abs(of_other[3]))
        if step == 0 and distance - border <= tolerance:
            if abs(rate) <= slow + ULPS_OF_SPEED * math.sqrt(bound * head.ball_radius):
                ax, ay = acceleration_in(state, w, k, s + after, of_one)
                bx, by = acceleration_in(state, w, j, t + after, of_other)
                turn = (vx * vx + vy * vy) / border
                opens = (x * (ax - bx) + y * (ay - by)) / distance + turn
                if opens < -2.0 * PRESSING * (bound + turn):
                    after = time_to_press(opens, 0.0, head.extent)  # the one lies on the other
                    return later(hi, lo, after) if after <= horizon else (math.inf, 0.0)
                rate = 0.0
            away = max(distance - border, 0.0) if rate >= 0.0 else 0.0
        gap = distance - border - away
        if gap <= tolerance:
            if rate < -slow:
                after += advancement_to_closing(gap, rate, bound)
                return later(hi, lo, after) if after <= horizon else (math.inf, 0.0)
            rate, gap = max(rate, 0.0), max(gap, 0.0)
        length = advancement_step(gap, rate, bound)
        after += length if rate < 0.0 else max(length, math.sqrt(2.0 * tolerance / bound))
        if not after <= horizon:
            return math.inf, 0.0
    return later(hi, lo, after)
