"""Balls that hit each other: what comes of it."""

import math

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.contact.arrival import end_flight
from bounce_env.engine.contact.jams import are_stuck, count_meeting, have_no_room, note_speed, stop
from bounce_env.engine.contact.restitution import capped
from bounce_env.engine.contact.squeeze import take_opposed
from bounce_env.engine.detect.pairs import pair_noise, pair_weight, plan_pairs
from bounce_env.engine.detect.schedule import schedule_resolve
from bounce_env.engine.memory.ledger import Surface, append_contact
from bounce_env.engine.memory.records import BOUNCE, CRUSHED
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import flight_of
from bounce_env.engine.motion.instant import since
from bounce_env.engine.tolerances import PRESSING, ROLLING, SEARCH_ENDS, ULPS_OF_SPEED


@where("pairs", inline=False)
def collide(state: State, w: int, k: int, j: int, hi: float, lo: float, ledger: Table) -> None:
    """Let balls `k` > `j` hit each other at the instant (hi, lo); both then bounce from what else they touch.

    Equal masses exchange (1 + b^2) / 2 of the speed at which they close; friction does not act. A ball that lies on
    another one leaves it with a smallest rebound, as it would a curve.
    """
    one, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    head = state.scenes[world.scene]
    end_flight(state, w, k, since(hi, lo, one.hi, one.lo), hi, lo)
    end_flight(state, w, j, since(hi, lo, other.hi, other.lo), hi, lo)
    dx, dy = one.x - other.x, one.y - other.y
    distance = math.sqrt(dx * dx + dy * dy)
    if distance > (2.0 + SEARCH_ENDS) * head.ball_radius:  # the search ended before a hit
        for ball in (one, other):
            if ball.status != CRUSHED:
                schedule_resolve(ball)
        return
    nx, ny = dx / distance, dy / distance
    apart = 0.5 * (2.0 * head.ball_radius - distance)
    one.x, one.y = one.x + apart * nx, one.y + apart * ny
    other.x, other.y = other.x - apart * nx, other.y - apart * ny
    pair = state.pairs[w, k, j]
    count_meeting(world, pair, one, other, head.extent, hi, lo)
    _exchange_speeds(state, w, k, j, nx, ny, distance, have_no_room(world, pair), ledger)
    if are_stuck(world, pair, one, other):
        stop(state, w, k, j, nx, ny, ledger)
        stop(state, w, j, k, -nx, -ny, ledger)
    note_speed(world, one, other)
    for ball in (one, other):
        if ball.status != CRUSHED:
            schedule_resolve(ball)
    plan_pairs(state, w, k)
    plan_pairs(state, w, j)


@function
def _exchange_speeds(
    state: State, w: int, k: int, j: int, nx: float, ny: float, distance: float, dead: bool, ledger: Table
) -> None:
    """Bounce ball `k` and ball `j` off each other, whose centres are `distance` [m] apart along (nx, ny).

    dead: without rebound but the smallest.
    """
    one, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    head = state.scenes[world.scene]
    closing = -((one.vx - other.vx) * nx + (one.vy - other.vy) * ny)
    noise = pair_noise(one, other, flight_of(state, one), flight_of(state, other), head)
    noise = max(noise, ULPS_OF_SPEED * world.meet_speed)
    least = _least_pair_rebound(one, other, nx, ny, distance, head)
    if least == 0.0 and closing <= 0.0:
        return
    vx, vy, ux, uy = one.vx, one.vy, other.vx, other.vy
    # What is left of faster hits at this instant has no rebound: in between others it would go to and fro for ever.
    gain = closing + max(0.0 if dead or closing <= noise else head.ball_b * head.ball_b * closing, least)
    share = 1.0 if other.status == CRUSHED else (0.0 if one.status == CRUSHED else 0.5)
    # A small hop does not bounce the ball from what else it touches.
    one.vague = other.vague = gain if closing <= noise else gain * (one.tolerance + other.tolerance) / distance
    one.vx, one.vy = vx + share * gain * nx, vy + share * gain * ny
    other.vx, other.vy = ux - (1.0 - share) * gain * nx, uy - (1.0 - share) * gain * ny
    # A ball may be crushed against another one, too.
    take_opposed(one, head, nx, ny)
    take_opposed(other, head, -nx, -ny)
    _cap_pair_speed(one, other, nx, ny, head.max_speed, world)
    _cap_pair_speed(other, one, -nx, -ny, head.max_speed, world)
    world.bounces += 1
    append_contact(ledger, world, one, k, BOUNCE, Surface(head.elements + j, nx, ny, ux, uy), vx, vy)
    append_contact(ledger, world, other, j, BOUNCE, Surface(head.elements + k, -nx, -ny, vx, vy), ux, uy)


@function
def _least_pair_rebound(one: Record, other: Record, nx: float, ny: float, distance: float, head: Record) -> float:
    """Return the slowest [m/s] that one of two balls leaves the other one which it is pressed on; 0 where it is not."""
    g = pair_weight(one, other)
    along = (one.vx - other.vx) * ny - (one.vy - other.vy) * nx
    turn = along * along / distance  # what it takes to keep to the other one
    if (one.ax - other.ax) * nx + (one.ay - other.ay) * ny + turn >= -PRESSING * (g + turn):
        return 0.0
    return max(head.rest_speed, ROLLING * math.sqrt(g * 2.0 * head.ball_radius))


@function
def _cap_pair_speed(ball: Record, other: Record, nx: float, ny: float, max_speed: float, world: Record) -> None:
    ball.vx, ball.vy, over = capped(ball.vx, ball.vy, nx, ny, other.vx, other.vy, max_speed)
    world.speed_capped += over
