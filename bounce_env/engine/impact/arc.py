"""Time of impact with an arc: from outside, where the distance falls to a radius, and from inside, where it rises.

Coordinates are relative to the arc's centre. A crossing of the full circle counts where its direction lies in the
arc's span; the others go through its opening.
"""

import math
from typing import Any

from bounce_env.engine.compile.jit import Feature, Record, function, routine
from bounce_env.engine.impact.quartic import (
    distance_polynomial,
    monotone_borders,
    root_between,
    value,
    without_root_at_zero,
)
from bounce_env.engine.memory.records import CLOSED, MINOR
from bounce_env.engine.motion.flight import bending, grazes, moved, slow_on_circle, sped
from bounce_env.engine.tolerances import PRESSING, WEIGHTLESS


@function
def in_span(arc: Any, dx: float, dy: float, slack: float) -> bool:
    """Whether the point at (dx, dy) [m] from the centre lies beside the arc, its ends included within `slack` [m].

    `arc` is an ARC, or None for a circle that is no arc.
    """
    if arc is None:
        return True
    if arc.span == CLOSED:
        return True
    from_start = arc.sx * dy - arc.sy * dx
    to_end = dx * arc.ey - dy * arc.ex
    if arc.span == MINOR:
        return from_start >= -slack and to_end >= -slack
    # Of a span of more than half a turn the opening is the smaller part.
    return not (to_end < -slack and from_start < -slack)


@function
def arc_time(
    arc: Record,
    x: float,
    y: float,
    vx: float,
    vy: float,
    ax: Feature,
    ay: Feature,
    side: int,
    inside_only: bool,
    slack: float,
    horizon: float,
) -> float:
    """The earlier hit of the arc's two sides before `horizon` [s], or inf.

    `side` is where a ball of no radius is while it touches: 1 outside, -1 inside; 0 for a disc, whose centre tells.
    """
    t = math.inf
    if not inside_only:
        t = crossing_time(arc, arc.outer, -1.0, x, y, vx, vy, ax, ay, side != -1, slack, -1.0, horizon)
    if arc.inner > 0.0:
        end = min(t, horizon)
        t = min(t, crossing_time(arc, arc.inner, 1.0, x, y, vx, vy, ax, ay, side != 1, slack, -1.0, end))
    return t


@function
def entry_time(
    x: float, y: float, vx: float, vy: float, ax: Feature, ay: Feature, radius: float, outside: bool,
    slack: float, after: float, horizon: float,
) -> float:  # fmt: skip
    """When a point next enters a circle about the origin, later than `after` [s] and before `horizon`, or inf."""
    return crossing_time(None, radius, -1.0, x, y, vx, vy, ax, ay, outside, slack, after, horizon)


@routine
def crossing_time(
    arc: Any,
    reach: float,
    sense: float,
    x: float,
    y: float,
    vx: float,
    vy: float,
    ax: Feature,
    ay: Feature,
    armed: bool,
    slack: float,
    after: float,
    horizon: float,
) -> float:
    """When the distance from the centre next crosses `reach` beside the arc: rising if `sense` is 1, falling if -1.

    Later than `after` [s] and before `horizon`; inf if it does not. `armed` says that a ball that touches is on the
    side from which that is a hit.
    """
    distance = math.sqrt(x * x + y * y)
    gap = -sense * (distance - reach)
    touching = abs(gap) <= slack
    approach = sense * (x * vx + y * vy)
    slow = slow_on_circle(vx, vy, reach, slack) * distance
    if touching and armed and approach > slow and after < 0.0 and in_span(arc, x, y, slack):
        wait = _until_nearest(sense, x, y, vx, vy, ax, ay, slack)
        return wait if wait > 0.0 else max(gap, 0.0) * distance / approach
    still = touching and abs(approach) <= slow
    if still and armed and after < 0.0 and _sinks(sense, x, y, vx, vy, ax, ay) and in_span(arc, x, y, slack):
        return 0.0
    if ax is None:
        return _straight(arc, reach, sense, x, y, vx, vy, touching, still, slack, after, horizon)
    if abs(ax) + abs(ay) < WEIGHTLESS:
        return _straight(arc, reach, sense, x, y, vx, vy, touching, still, slack, after, horizon)
    return _curved(arc, reach, sense, x, y, vx, vy, ax, ay, touching, still, slack, after, horizon)


@function
def _until_nearest(
    sense: float, x: float, y: float, vx: float, vy: float, ax: Feature, ay: Feature, slack: float
) -> float:
    """How long [s] until a point that touches a circle is nearest, if it does so in passing (see `grazes`); else 0."""
    distance = math.sqrt(x * x + y * y)
    closing = sense * (x * vx + y * vy) / distance
    opening = -sense * bending(x, y, vx, vy, ax, ay)
    if closing > 0.0 and opening > 0.0 and grazes(closing * closing, opening, slack):
        return closing / opening
    return 0.0


@function
def _touches_at(
    arc: Any, reach: float, x: float, y: float, vx: float, vy: float, ax: float, ay: float, t: float, slack: float
) -> bool:
    """Whether a ball touches after `t` seconds, beside the arc."""
    px, py = moved(x, vx, ax, t), moved(y, vy, ay, t)
    return abs(math.sqrt(px * px + py * py) - reach) <= slack and in_span(arc, px, py, slack)


@function
def _sinks(sense: float, x: float, y: float, vx: float, vy: float, ax: Feature, ay: Feature) -> bool:
    """Whether a point that moves along the circle is about to cross it: the second derivative of its distance tells."""
    square = vx * vx + vy * vy
    if ax is None:
        return sense > 0.0 and square > 0.0
    return sense * (square + x * ax + y * ay) > PRESSING * (square + abs(x * ax) + abs(y * ay))


@function
def _straight(
    arc: Any, reach: float, sense: float, x: float, y: float, vx: float, vy: float,
    touching: bool, still: bool, slack: float, after: float, horizon: float,
) -> float:  # fmt: skip
    """On a straight flight: the smaller root is where the distance falls, the larger where it rises."""
    square = vx * vx + vy * vy
    half = x * vx + y * vy
    if still:
        return math.inf
    cross = x * vy - y * vx
    inner = square * reach * reach - cross * cross
    if inner <= 0.0:
        return math.inf
    root = math.sqrt(inner)
    distance = math.sqrt(x * x + y * y)
    rest = 0.0 if touching else (distance - reach) * (distance + reach)
    # Each root is taken from the form that adds two terms of one sign.
    if sense > 0.0:
        t = (root - half) / square if half < 0.0 else -rest / (root + half)
    else:
        t = rest / (root - half) if half < 0.0 else -(root + half) / square
    if touching and t * square <= root:  # the root at the start, of which the touch has been told
        return math.inf
    t += _until_nearest(sense, x + vx * t, y + vy * t, vx, vy, None, None, slack)
    if t < 0.0 or t <= after or t > horizon or not in_span(arc, x + vx * t, y + vy * t, slack):
        return math.inf
    return t


@function
def _curved(
    arc: Any, reach: float, sense: float, x: float, y: float, vx: float, vy: float, ax: float, ay: float,
    touching: bool, still: bool, slack: float, after: float, horizon: float,
) -> float:  # fmt: skip
    """On a parabola: all crossings in order, up to the first beside the arc."""
    c = distance_polynomial(x, y, vx, vy, ax, ay, reach)
    if touching:
        # What is left of a gap is no way to go: the hit is where the ball is as near again.
        c, reach = without_root_at_zero(c), math.sqrt(x * x + y * y)
    if still:
        c = without_root_at_zero(c)
    borders = monotone_borders(c, horizon)
    for i in range(4):
        start, end = borders[i], borders[i + 1]
        if not (sense * value(c, start) < 0.0 <= sense * value(c, end)):
            turns = sense < 0.0 and not touching and start < end < horizon and end > after
            if turns and _touches_at(arc, reach, x, y, vx, vy, ax, ay, end, slack):
                return end
            continue
        t = root_between(c, start, end)
        px, py, qx, qy = moved(x, vx, ax, t), moved(y, vy, ay, t), sped(vx, ax, t), sped(vy, ay, t)
        distance = math.sqrt(px * px + py * py)
        rate = (px * qx + py * qy) / distance
        wait = _until_nearest(sense, px, py, qx, qy, ax, ay, slack)
        if wait > 0.0:
            t += wait
        elif sense * rate > 0.0:
            # The polynomial knows the gap through its square only; a step on the distance itself mends the last digits.
            # Where the distance bends within the step there are none to mend: the gap is rounding, the rate next to it.
            step = (distance - reach) / rate
            if abs(step * bending(px, py, qx, qy, ax, ay)) <= abs(rate):
                t = min(max(t - step, start), end)
        if t > after and in_span(arc, moved(x, vx, ax, t), moved(y, vy, ay, t), slack):
            return t
    return math.inf
