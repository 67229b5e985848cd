"""Balls that hit each other: when they do, and what comes of it.

Seen from one ball the other one flies under the difference of their accelerations: on a straight line where both are
under the same gravity, so that the hit is that of a circle of twice the radius, in closed form.
"""

import math

from bounce_env.engine.arrive import end_flight
from bounce_env.engine.flight import moved, sped, touch_tolerance
from bounce_env.engine.impact import circle_time
from bounce_env.engine.instant import before, later, since
from bounce_env.engine.jams import are_stuck, count_meeting, have_no_room, may_wait, note_speed, stop, weight_of
from bounce_env.engine.jit import Feature, Record, Table, function, function_of_feature, routine
from bounce_env.engine.law import capped
from bounce_env.engine.layout import BOUNCE, CRUSHED, OUT, State, Tables
from bounce_env.engine.resolve import log
from bounce_env.engine.search import pull, resolve_next
from bounce_env.engine.squeeze import take_opposed
from bounce_env.engine.tolerances import CORNER, PRESSING, ROLLING, ULPS_OF_LENGTH, ULPS_OF_SPEED


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
def plan_pairs(state: State, tables: Tables, pairs: Table, w: int, k: int) -> None:
    """Set when ball `k` hits each other ball, as long as both keep to their present flights."""
    if pairs is None:
        return
    for j in range(state.balls.shape[1]):
        if j != k:
            pair = pairs[w, max(j, k), min(j, k)]
            pair.hi, pair.lo = _meeting(state, tables, w, max(j, k), min(j, k))


@function
def _meeting(state: State, tables: Tables, w: int, k: int, j: int) -> tuple[float, float]:
    one, other = state.balls[w, k], state.balls[w, j]
    if OUT in (one.status, other.status):
        return math.inf, 0.0
    hi, lo = one.hi, one.lo
    if before(hi, lo, other.hi, other.lo):
        hi, lo = other.hi, other.lo
    s, t = since(hi, lo, one.hi, one.lo), since(hi, lo, other.hi, other.lo)
    ax, ay = pull(tables.gravity, one)
    bx, by = pull(tables.gravity, other)
    gx, gy = difference(ax, ay, bx, by)
    horizon = min(one.end_after - s, other.end_after - t)
    head = tables.scenes[state.worlds[w].scene]
    slack = touch_tolerance(head.extent, one.vx, one.vy, ax, ay, s)
    slack = max(slack, touch_tolerance(head.extent, other.vx, other.vy, bx, by, t))
    x = moved(one.x, one.vx, ax, s) - moved(other.x, other.vx, bx, t)
    y = moved(one.y, one.vy, ay, s) - moved(other.y, other.vy, by, t)
    ux, uy, vx, vy = sped(one.vx, ax, s), sped(one.vy, ay, s), sped(other.vx, bx, t), sped(other.vy, by, t)
    reach, noise = 2.0 * head.ball_radius, _noise(one, other, ux, uy, vx, vy, head)
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
def _noise(one: Record, other: Record, vx: float, vy: float, ux: float, uy: float, head: Record) -> float:
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


@routine
def collide(
    state: State, tables: Tables, pairs: Table, w: int, k: int, j: int, hi: float, lo: float, ledger: Table
) -> None:
    """Let balls `k` > `j` hit each other at the instant (hi, lo); both then bounce from what else they touch.

    Equal masses exchange (1 + b^2) / 2 of the speed at which they close; friction does not act. A ball that lies on
    another one leaves it with a smallest rebound, as it would a curve.
    """
    if pairs is None:  # which compiles it away for one ball
        return
    one, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    head = tables.scenes[world.scene]
    ax, ay = pull(tables.gravity, one)
    bx, by = pull(tables.gravity, other)
    end_flight(one, tables, world.scene, ax, ay, since(hi, lo, one.hi, one.lo), hi, lo)
    end_flight(other, tables, world.scene, bx, by, since(hi, lo, other.hi, other.lo), hi, lo)
    dx, dy = one.x - other.x, one.y - other.y
    distance = math.sqrt(dx * dx + dy * dy)
    nx, ny = dx / distance, dy / distance
    apart = 0.5 * (2.0 * head.ball_radius - distance)
    one.x, one.y = one.x + apart * nx, one.y + apart * ny
    other.x, other.y = other.x - apart * nx, other.y - apart * ny
    pair = pairs[w, k, j]
    count_meeting(world, pair, one, other, head.extent, hi, lo)
    _exchange(state, tables, w, k, j, nx, ny, distance, have_no_room(world, pair), ledger)
    if are_stuck(world, pair, one, other):
        stop(state, tables, w, k, j, nx, ny, ledger)
        stop(state, tables, w, j, k, -nx, -ny, ledger)
    note_speed(world, one, other)
    for ball in (one, other):
        if ball.status != CRUSHED:
            resolve_next(ball)
    plan_pairs(state, tables, pairs, w, k)
    plan_pairs(state, tables, pairs, w, j)


@function
def _exchange(
    state: State, tables: Tables, w: int, k: int, j: int, nx: float, ny: float, distance: float, dead: bool,
    ledger: Table,
) -> None:  # fmt: skip
    """The bounce of ball `k` and ball `j`, whose centres are `distance` [m] apart along (nx, ny); dead: without rebound
    but the smallest.
    """
    one, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    head = tables.scenes[world.scene]
    closing = -((one.vx - other.vx) * nx + (one.vy - other.vy) * ny)
    noise = max(_noise(one, other, one.vx, one.vy, other.vx, other.vy, head), ULPS_OF_SPEED * world.meet_speed)
    least = _least_rebound(one, other, nx, ny, distance, head)
    if least == 0.0 and closing <= 0.0:
        return
    vx, vy, ux, uy = one.vx, one.vy, other.vx, other.vy
    # What is left of faster hits at this instant has no rebound: in between others it would go to and fro for ever.
    gain = closing + max(0.0 if dead or closing <= noise else head.ball_b * head.ball_b * closing, least)
    share = 1.0 if other.status == CRUSHED else (0.0 if one.status == CRUSHED else 0.5)
    # A small hop does not bounce the ball from what else it touches.
    one.vague = other.vague = gain if closing <= noise else gain * (one.slack + other.slack) / distance
    one.vx, one.vy = vx + share * gain * nx, vy + share * gain * ny
    other.vx, other.vy = ux - (1.0 - share) * gain * nx, uy - (1.0 - share) * gain * ny
    # A ball may be crushed against another one, too.
    take_opposed(one, head, nx, ny)
    take_opposed(other, head, -nx, -ny)
    _cap(one, other, nx, ny, head.max_speed, world)
    _cap(other, one, -nx, -ny, head.max_speed, world)
    world.bounces += 1
    elements = head.elements
    log(ledger, world, one, k, elements + j, BOUNCE, nx, ny, vx, vy, ux, uy)
    log(ledger, world, other, j, elements + k, BOUNCE, -nx, -ny, ux, uy, vx, vy)


@function
def _least_rebound(one: Record, other: Record, nx: float, ny: float, distance: float, head: Record) -> float:
    """The slowest [m/s] that one of two balls leaves the other one which it is pressed on; 0 where it is not."""
    g = weight_of(one, other)
    along = (one.vx - other.vx) * ny - (one.vy - other.vy) * nx
    turn = along * along / distance  # what it takes to keep to the other one
    if (one.ax - other.ax) * nx + (one.ay - other.ay) * ny + turn >= -PRESSING * (g + turn):
        return 0.0
    return max(head.rest_speed, ROLLING * math.sqrt(g * 2.0 * head.ball_radius))


@function
def _cap(ball: Record, other: Record, nx: float, ny: float, max_speed: float, world: Record) -> None:
    ball.vx, ball.vy, over = capped(ball.vx, ball.vy, nx, ny, other.vx, other.vy, max_speed)
    world.speed_capped += over
