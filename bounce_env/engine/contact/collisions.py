"""Balls that hit each other: what comes of it."""

import math

from bounce_env.engine.compile.jit import Record, function, where
from bounce_env.engine.contact.arrival import end_flight
from bounce_env.engine.contact.bounces import take_vague
from bounce_env.engine.contact.cluster import resolve_cluster, touch_others
from bounce_env.engine.contact.restitution import capped
from bounce_env.engine.contact.touching import collect_touches, keep_beside
from bounce_env.engine.detect.pairs import (
    is_pressed_by_balls,
    pair_noise,
    pair_weight,
    plan_pairs,
    slowest_pair_rebound,
)
from bounce_env.engine.detect.schedule import schedule_resolve
from bounce_env.engine.memory.ledger import Surface, append_contact
from bounce_env.engine.memory.records import BOUNCE, CRUSHED
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import flight_of
from bounce_env.engine.motion.instant import since
from bounce_env.engine.tolerances import CLUSTER_GAP, PRESSING, SEARCH_ENDS, ULPS_OF_LENGTH


@where("pairs", inline=False)
def collide(state: State, w: int, k: int, j: int, hi: float, lo: float) -> None:
    """Let balls `k` > `j` hit each other at the instant (hi, lo); both then bounce from what else they touch.

    Equal masses exchange (1 + b^2) / 2 of the speed at which they close; friction does not act. Balls that lie on each
    other are resolved as one.
    """
    one, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    head = state.scenes[world.scene]
    end_flight(state, w, k, since(hi, lo, one.hi, one.lo), hi, lo)
    end_flight(state, w, j, since(hi, lo, other.hi, other.lo), hi, lo)
    dx, dy = one.x - other.x, one.y - other.y
    distance = math.sqrt(dx * dx + dy * dy)
    room = SEARCH_ENDS * head.ball_radius + CLUSTER_GAP * head.extent
    if distance > 2.0 * head.ball_radius + room:  # the search ended before a hit
        for ball in (one, other):
            if ball.status != CRUSHED:
                schedule_resolve(ball)
        return
    nx, ny = dx / distance, dy / distance
    apart = 0.5 * (2.0 * head.ball_radius - distance)
    one.x, one.y = one.x + apart * nx, one.y + apart * ny
    other.x, other.y = other.x - apart * nx, other.y - apart * ny
    if abs(apart) > ULPS_OF_LENGTH * head.extent:
        keep_beside(state, w, k)
        keep_beside(state, w, j)
    for i in (k, j):
        state.members[w, i].meets += 1
    if _lie_on_each_other(state, w, k, j, nx, ny, distance):
        resolve_cluster(state, w, k)
        return
    _exchange_speeds(state, w, k, j, nx, ny, distance)
    for ball in (one, other):
        if ball.status != CRUSHED:
            schedule_resolve(ball)
    plan_pairs(state, w, k)
    plan_pairs(state, w, j)


@function
def _lie_on_each_other(state: State, w: int, k: int, j: int, nx: float, ny: float, distance: float) -> bool:
    """Return whether two balls that touch, and close slowly, are pressed on each other or touch others, too.

    Where hits have no room any more any speed will do. Elastic hits of balls in a row end by themselves.
    """
    one, other = state.balls[w, k], state.balls[w, j]
    slowest = slowest_pair_rebound(state, w, k, j)
    if -((one.vx - other.vx) * nx + (one.vy - other.vy) * ny) > slowest:
        return False
    if slowest == math.inf or is_pressed_by_balls(state, w, k) or is_pressed_by_balls(state, w, j):
        return True
    if state.scenes[state.worlds[w].scene].ball_b < 1.0 and (
        touch_others(state, w, k, j) or touch_others(state, w, j, k)
    ):
        return True
    along = (one.vx - other.vx) * ny - (one.vy - other.vy) * nx
    turn = along * along / distance  # what it takes to keep to the other one
    off = (one.ax - other.ax) * nx + (one.ay - other.ay) * ny + turn
    return off < -PRESSING * (pair_weight(one, other) + turn)


@function
def _exchange_speeds(state: State, w: int, k: int, j: int, nx: float, ny: float, distance: float) -> None:
    """Bounce ball `k` and ball `j` off each other, whose centres are `distance` [m] apart along (nx, ny)."""
    one, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    head = state.scenes[world.scene]
    closing = -((one.vx - other.vx) * nx + (one.vy - other.vy) * ny)
    if closing <= 0.0:
        return
    noise = pair_noise(one, other, flight_of(state, one), flight_of(state, other), head)
    vx, vy, ux, uy = one.vx, one.vy, other.vx, other.vy
    # What is left of faster hits at this instant has no rebound: in between others it would go to and fro for ever.
    gain = closing + (0.0 if closing <= noise else head.ball_b * head.ball_b * closing)
    share = 1.0 if other.status == CRUSHED else (0.0 if one.status == CRUSHED else 0.5)
    one.vx, one.vy = vx + share * gain * nx, vy + share * gain * ny
    other.vx, other.vy = ux - (1.0 - share) * gain * nx, uy - (1.0 - share) * gain * ny
    # A ball may be crushed against another one, too.
    _cap_pair_speed(one, other, nx, ny, head.max_speed, world)
    _cap_pair_speed(other, one, -nx, -ny, head.max_speed, world)
    world.bounces += 1
    append_contact(state, w, k, BOUNCE, Surface(head.elements + j, nx, ny, ux, uy), vx, vy)
    append_contact(state, w, j, BOUNCE, Surface(head.elements + k, -nx, -ny, vx, vy), ux, uy)
    # The push may miss its direction by as much: it does not bounce the ball from what else it touches.
    vague = gain if closing <= noise else gain * (one.tolerance + other.tolerance) / distance
    for i in (k, j):
        collect_touches(state, w, i)
        take_vague(state.balls[w, i], state.touches, w, vague)


@function
def _cap_pair_speed(ball: Record, other: Record, nx: float, ny: float, max_speed: float, world: Record) -> None:
    ball.vx, ball.vy, over = capped(ball.vx, ball.vy, nx, ny, other.vx, other.vy, max_speed)
    world.speed_capped += over
