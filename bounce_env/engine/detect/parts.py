"""The zone that each moving part can reach, and what a ball meets there."""

import math

from bounce_env.engine.compile.jit import Feature, Record, Table, function, routine
from bounce_env.engine.impact.arc import crossing_time
from bounce_env.engine.impact.capsule import capsule_time
from bounce_env.engine.impact.line import face_time
from bounce_env.engine.impact.rotating_capsule import turning_time
from bounce_env.engine.impact.stretching_wall import stretching_time
from bounce_env.engine.memory.lookup import ends_of, is_dragged, is_off, side_of_part, turn_of
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import dot, moved, sped, swept, touch_tolerance
from bounce_env.engine.motion.instant import before, later, since
from bounce_env.engine.motion.parts import core_at, stop_instant, surface_velocity
from bounce_env.engine.motion.roots import falling_time

# The zone of a part is wider than its reach by this share: it keeps rounding of the border from hiding a hit.
ZONE_MARGIN = 1.01


@function
def strip_change(height: float, rate: float, pull: Feature, border: float, inside: bool, after: float) -> float:
    """When |height + rate t + pull t^2 / 2| next passes `border`, from the flight's start, no earlier than `after`."""
    best = math.inf
    for facing in (1.0, -1.0):
        gap = facing * height - border
        if inside:
            t = falling_time(-gap, gap > 0.0, -facing * rate, dot(pull, 0.0, -facing, 0.0))
        else:
            t = falling_time(gap, gap < 0.0, facing * rate, dot(pull, 0.0, facing, 0.0))
        if t >= after:
            best = min(best, t)
    return best


@routine
def plan_zones(
    ball: Record, state: State, zones: Table, parts: Table, w: int, k: int, scene: int,
    gx: Feature, gy: Feature, now: float,
) -> None:  # fmt: skip
    """Bring the ball's zones up to `now` seconds into its flight, and set when the next of them changes.

    The zone of a part is where it can be met: of one that slides the strip along its rail, of one that turns the circle
    about its pivot, of a dragged wall everything. It is a static sensor of the engine's own: passing its border neither
    re-bases the flight nor shows in the ledger.
    """
    ball.zone_after = math.inf
    if parts is None or zones is None:
        return
    for m in range(state.scenes[scene].parts):
        part, zone, turn = parts[scene, m], zones[w, k, m], turn_of(state.turns, scene, m)
        if is_dragged(ends_of(state.ends, w, m), part):
            zone.inside, zone.after = 1, math.inf
            continue
        if now == 0.0:
            zone.inside, zone.after = 1 if _in_zone(ball, part, turn) else 0, 0.0
        elif zone.after <= now:
            zone.inside = 1 - zone.inside
        if zone.after <= now:
            zone.after = _zone_change(ball, part, turn, gx, gy, zone.inside == 1, now)
            if zone.after > ball.end_after:
                zone.after = math.inf
        ball.zone_after = min(ball.zone_after, zone.after)


@function
def _in_zone(ball: Record, part: Record, turn: int) -> bool:
    x, y = ball.x - part.x, ball.y - part.y
    if turn != 0:
        border = ZONE_MARGIN * (part.front + part.reach)
        return x * x + y * y <= border * border
    return abs(y * part.ux - x * part.uy) <= ZONE_MARGIN * part.reach


@function
def _zone_change(ball: Record, part: Record, turn: int, gx: Feature, gy: Feature, inside: bool, after: float) -> float:
    """When the ball next passes the border of a part's zone, from the flight's start, no earlier than `after`."""
    x, y = ball.x - part.x, ball.y - part.y
    if turn != 0:
        border, sense = ZONE_MARGIN * (part.front + part.reach), 1.0 if inside else -1.0
        return crossing_time(
            None, border, sense, x, y, ball.vx, ball.vy, gx, gy, after == 0.0, ball.slack, after, ball.end_after
        )
    rate = ball.vy * part.ux - ball.vx * part.uy
    pull = dot(gx, gy, -part.uy, part.ux)
    return strip_change(y * part.ux - x * part.uy, rate, pull, ZONE_MARGIN * part.reach, inside, after)


@function
def meet_part(
    ball: Record, motion: Record, part: Record, turn: int, ends: Record, side: int, leaves_after: float, extent: float,
    gx: Feature, gy: Feature,
) -> tuple[float, float]:  # fmt: skip
    """Instant at which the ball hits a part while both keep their present motion: (hi, lo), inf if not.

    side: on which side of a dragged wall a ball of no radius is while it touches it, otherwise 0.
    leaves_after: duration [s] after which, from the flight's start, the ball is out of the part's reach.
    In the frame of a part that slides the ball flies as ever, and the part is a standing capsule.
    """
    if before(ball.hi, ball.lo, motion.hi, motion.lo):
        hi, lo = motion.hi, motion.lo
    else:
        hi, lo = ball.hi, ball.lo
    t = since(hi, lo, ball.hi, ball.lo)
    stop_hi, stop_lo = stop_instant(motion, part)
    horizon = min(min(ball.end_after, leaves_after) - t, since(stop_hi, stop_lo, hi, lo))
    x, y, ux, uy, back, front = core_at(part, motion, turn, ends, hi, lo)
    px, py = moved(ball.x, ball.vx, gx, t) - x, moved(ball.y, ball.vy, gy, t) - y
    vx, vy = sped(ball.vx, gx, t), sped(ball.vy, gy, t)
    slack = touch_tolerance(extent, ball.vx, ball.vy, gx, gy, t)
    if is_dragged(ends, part):
        after = meet_wall(px, py, vx, vy, gx, gy, ends, ux, uy, front, part.reach, side, slack, horizon)
    elif turn != 0 and motion.velocity != 0.0:
        rate = turn * motion.velocity
        after = turning_time(px, py, vx, vy, gx, gy, ux, uy, part.front, part.reach, rate, slack, horizon)
    else:
        if turn == 0:
            vx, vy = vx - motion.velocity * ux, vy - motion.velocity * uy
        after = capsule_time(px, py, vx, vy, gx, gy, ux, uy, back, front, part.reach, slack, horizon)
    if after == math.inf:
        return math.inf, 0.0
    return later(hi, lo, after)


@function
def meet_wall(
    px: float, py: float, vx: float, vy: float, gx: Feature, gy: Feature, ends: Record, ux: float, uy: float,
    length: float, reach: float, side: int, slack: float, horizon: float,
) -> float:  # fmt: skip
    """Hit of a dragged wall that runs `length` [m] along u from the origin now: a duration [s], or inf.

    (px, py) [m] is where the ball is from there, (vx, vy) [m/s] its velocity in the world.
    """
    if ends is None:
        return math.inf
    vx, vy = vx - ends.vx0, vy - ends.vy0
    ex, ey = ends.vx1 - ends.vx0, ends.vy1 - ends.vy0
    if ex != 0.0 or ey != 0.0:
        if not _is_near(px, py, vx, vy, gx, gy, length * ux, length * uy, ex, ey, reach + slack, horizon):
            return math.inf
        return stretching_time(px, py, vx, vy, gx, gy, length * ux, length * uy, ex, ey, reach, side, slack, horizon)
    if reach > 0.0:
        return capsule_time(px, py, vx, vy, gx, gy, ux, uy, 0.0, length, reach, slack, horizon)
    return face_time(px, py, vx, vy, gx, gy, ux, uy, length, reach, side, slack, horizon)


@function
def _is_near(
    px: float, py: float, vx: float, vy: float, gx: Feature, gy: Feature, dx: float, dy: float, ex: float, ey: float,
    reach: float, horizon: float,
) -> bool:  # fmt: skip
    """Whether the boxes that a ball and a wall from the origin along (dx, dy), changing by (ex, ey), sweep meet.

    Most walls are rejected by that alone. Written so that infinite or undefined borders reject nothing.
    """
    left, right = swept(px, vx, gx, horizon)
    below, above = swept(py, vy, gy, horizon)
    sx, sy = dx + ex * horizon, dy + ey * horizon
    apart = left > max(dx, sx, 0.0) + reach or right < min(dx, sx, 0.0) - reach
    return not (apart or below > max(dy, sy, 0.0) + reach or above < min(dy, sy, 0.0) - reach)


@function
def plan_meetings(
    ball: Record, state: State, motions: Table, parts: Table, zones: Table, w: int, k: int, scene: int,
    gx: Feature, gy: Feature,
) -> None:  # fmt: skip
    """Search the parts in whose zone the ball is, and set which one it hits first, and when."""
    ball.part_hi, ball.part_lo, ball.part_index = math.inf, 0.0, -1
    if parts is None or motions is None or zones is None:
        return
    head = state.scenes[scene]
    for m in range(head.parts):
        if m == ball.rides or not zones[w, k, m].inside or is_off(state.disabled, w, parts[scene, m].element):
            continue
        turn, ends = turn_of(state.turns, scene, m), ends_of(state.ends, w, m)
        side, leaves_after = side_of_part(state.part_sides, w, k, m), zones[w, k, m].after
        hi, lo = meet_part(ball, motions[w, m], parts[scene, m], turn, ends, side, leaves_after, head.extent, gx, gy)
        if before(hi, lo, ball.part_hi, ball.part_lo):
            ball.part_hi, ball.part_lo, ball.part_index = hi, lo, m


@function
def way_off_part(
    ball: Record, motions: Table, parts: Table, turns: Table, all_ends: Table, w: int, scene: int, gx: Feature,
    gy: Feature,
) -> float:  # fmt: skip
    """Duration after which a ball that slides on a part comes to an end of its straight side; inf if it does not."""
    if motions is None or parts is None:
        return math.inf
    part, motion = parts[scene, ball.rides], motions[w, ball.rides]
    turn, ends = turn_of(turns, scene, ball.rides), ends_of(all_ends, w, ball.rides)
    x, y, ux, uy, back, front = core_at(part, motion, turn, ends, ball.hi, ball.lo)
    rx, ry = ball.x - x, ball.y - y
    sx, sy = surface_velocity(motion, part, turn, ends, ux, uy, front, rx, ry)
    along, rate = rx * ux + ry * uy, (ball.vx - sx) * ux + (ball.vy - sy) * uy
    pull, against = dot(gx, gy, ux, uy), dot(gx, gy, -ux, -uy)
    return min(falling_time(along - back, False, rate, pull), falling_time(front - along, False, -rate, against))
