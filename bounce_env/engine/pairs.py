"""Balls that hit each other: when they do, and what comes of it.

Seen from one ball the other one flies under the difference of their accelerations: on a straight line where both are
under the same gravity, so that the hit is that of a circle of twice the radius, in closed form.
"""

import math

from bounce_env.engine.arrive import end_flight
from bounce_env.engine.flight import magnitude, moved, sped, touch_tolerance
from bounce_env.engine.impact import circle_time
from bounce_env.engine.instant import before, later, since
from bounce_env.engine.jit import Feature, Record, Table, function, function_of_feature, routine
from bounce_env.engine.law import capped
from bounce_env.engine.layout import BOUNCE, CRUSHED, FLYING, JAMMED, OUT, SETTLES, State, Tables
from bounce_env.engine.resolve import log
from bounce_env.engine.search import pull, resolve_next
from bounce_env.engine.squeeze import is_caught, take_opposed
from bounce_env.engine.tolerances import (
    CLEARANCE,
    CORNER,
    MEETINGS_AFTER_STANDING,
    MEETINGS_AT_ONE_INSTANT,
    MEETINGS_IN_A_CLEARANCE,
    PRESSING,
    ROLLING,
    SQUEEZES,
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
def _leaving(x: float, y: float, gx: Feature, gy: Feature, reach: float) -> float:
    """Acceleration [m/s^2] that draws a ball at (x, y) off another one at the origin; < 0: it presses it on it."""
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
    if x * x + y * y <= (reach + slack) * (reach + slack) and abs(x * (ux - vx) + y * (uy - vy)) <= noise * reach:
        # They touch, and neither close on each other nor come apart by more than rounding.
        leaving = _leaving(x, y, gx, gy, reach)
        if leaving >= 0.0:
            return math.inf, 0.0
        if leaving < -2.0 * PRESSING * _weight(one, other):
            return hi, lo  # a search would not find a hit of balls that are a little deep in each other
    after = circle_time(x, y, ux - vx, uy - vy, gx, gy, reach, slack, horizon)
    if not after <= horizon or after == math.inf:
        return math.inf, 0.0
    return later(hi, lo, after)


@function
def _weight(one: Record, other: Record) -> float:
    """The larger of the accelerations [m/s^2] that two balls are under."""
    return max(magnitude(one.gx, one.gy), magnitude(other.gx, other.gy))


@function
def _noise(one: Record, other: Record, vx: float, vy: float, ux: float, uy: float, head: Record) -> float:
    """Two balls that close slower than this [m/s] do not hit each other: rounding, or next to nothing under gravity."""
    return ULPS_OF_SPEED * (abs(vx) + abs(vy) + abs(ux) + abs(uy) + math.sqrt(_weight(one, other) * head.ball_radius))


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
def forget_meetings(pairs: Table, w: int) -> None:
    """No two balls have hit each other yet."""
    if pairs is None:
        return
    for k in range(pairs.shape[1]):
        for j in range(k):
            pair = pairs[w, k, j]
            pair.meets, pair.way, pair.last_hi, pair.last_lo, pair.speed = 0, 0.0, 0.0, 0.0, 0.0


@routine
def collide(
    state: State, tables: Tables, pairs: Table, w: int, k: int, j: int, hi: float, lo: float, ledger: Table
) -> None:
    """Let balls `k` > `j` hit each other at the instant (hi, lo); both then bounce from what else they touch.

    Equal masses exchange (1 + b^2) / 2 of the speed at which they close; friction does not act. A ball that lies on
    another one leaves it with a smallest rebound, as it would a curve.
    """
    if pairs is None:
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
    _count(world, one, other, head, hi, lo)
    _count_of_pair(pair, one, other, head, hi, lo)
    _exchange(state, tables, w, k, j, nx, ny, distance, ledger)
    world.meet_speed = max(world.meet_speed, _speeds(one, other))
    pair.speed = _speeds(one, other)
    if world.meets > MEETINGS_AT_ONE_INSTANT or pair.meets > MEETINGS_IN_A_CLEARANCE:
        _jam(state, tables, w, k, j, nx, ny, ledger)
        _jam(state, tables, w, j, k, -nx, -ny, ledger)
    for ball in (one, other):
        if ball.status != CRUSHED:
            resolve_next(ball)
    plan_pairs(state, tables, pairs, w, k)
    plan_pairs(state, tables, pairs, w, j)


@function
def _count(world: Record, one: Record, other: Record, head: Record, hi: float, lo: float) -> None:
    """Count the hits of balls at one instant, and keep the fastest speed of any: what is left of it may be rounding.

    Instants in between which no ball moves by more than the gaps of a corner are one, and so is a row of such.
    """
    t = since(hi, lo, world.meet_hi, world.meet_lo)
    if not _longest_way(one, other, world.meet_speed, t) <= CORNER * ULPS_OF_LENGTH * head.extent or t < 0.0:
        world.meets, world.meet_speed = 0, 0.0
    world.meet_hi, world.meet_lo = hi, lo
    world.meets += 1
    world.meet_speed = max(world.meet_speed, _speeds(one, other))


@function
def _count_of_pair(pair: Record, one: Record, other: Record, head: Record, hi: float, lo: float) -> None:
    """Count the hits of these two within a clearance."""
    t = since(hi, lo, pair.last_hi, pair.last_lo)
    pair.way += _longest_way(one, other, max(pair.speed, _speeds(one, other)), t)
    if pair.way > CLEARANCE * head.extent:
        stood = pair.meets > MEETINGS_IN_A_CLEARANCE
        pair.meets, pair.way = MEETINGS_IN_A_CLEARANCE - MEETINGS_AFTER_STANDING if stood else 0, 0.0
    pair.meets, pair.last_hi, pair.last_lo = pair.meets + 1, hi, lo


@function
def _longest_way(one: Record, other: Record, speed: float, t: float) -> float:
    """No shorter than what [m] two balls move in `t` seconds that are no faster [m/s] than this between their hits."""
    return (speed + _weight(one, other) * t) * t


@function
def _speeds(one: Record, other: Record) -> float:
    return abs(one.vx) + abs(one.vy) + abs(other.vx) + abs(other.vy)


@function
def _jam(state: State, tables: Tables, w: int, k: int, j: int, nx: float, ny: float, ledger: Table) -> None:
    """Stop ball `k`, which ball `j` and others keep hitting at one instant; where a part has it caught, that is to
    crush it.
    """
    ball, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    if ball.status == CRUSHED:
        return
    if is_caught(ball, tables.scenes[world.scene]) and ball.squeezes < SQUEEZES:
        ball.squeezes = SQUEEZES
        return
    if ball.settling == SETTLES:
        ball.contact, ball.support = FLYING, -1  # that contact does not begin
    vx, vy = ball.vx, ball.vy
    ball.vx, ball.vy, ball.settling = 0.0, 0.0, JAMMED
    log(ledger, world, ball, k, tables.scenes[world.scene].elements + j, BOUNCE, nx, ny, vx, vy, other.vx, other.vy)


@function
def _exchange(
    state: State, tables: Tables, w: int, k: int, j: int, nx: float, ny: float, distance: float, ledger: Table
) -> None:
    """The bounce of ball `k` and ball `j`, whose centres are `distance` [m] apart along (nx, ny)."""
    one, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    head = tables.scenes[world.scene]
    closing = -((one.vx - other.vx) * nx + (one.vy - other.vy) * ny)
    noise = max(_noise(one, other, one.vx, one.vy, other.vx, other.vy, head), ULPS_OF_SPEED * world.meet_speed)
    least = _least_rebound(one, other, nx, ny, head)
    if least == 0.0 and closing <= 0.0:
        return
    vx, vy, ux, uy = one.vx, one.vy, other.vx, other.vy
    # What is left of faster hits at this instant has no rebound: in between others it would go to and fro for ever.
    gain = closing + max(head.ball_b * head.ball_b * closing if closing > noise else 0.0, least)
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
def _least_rebound(one: Record, other: Record, nx: float, ny: float, head: Record) -> float:
    """The slowest [m/s] that one of two balls leaves the other one which it is pressed on; 0 where it is not."""
    g = _weight(one, other)
    if (one.ax - other.ax) * nx + (one.ay - other.ay) * ny >= -PRESSING * g:
        return 0.0
    return max(head.rest_speed, ROLLING * math.sqrt(g * 2.0 * head.ball_radius))


@function
def _cap(ball: Record, other: Record, nx: float, ny: float, max_speed: float, world: Record) -> None:
    ball.vx, ball.vy, over = capped(ball.vx, ball.vy, nx, ny, other.vx, other.vy, max_speed)
    world.speed_capped += over
