"""The event loop of one world: the earliest event of its balls and parts, one after the other, up to an instant.

A step in which nothing happens costs one comparison per ball and part. At one instant balls come before pairs of balls,
these before parts, and each in its order.
"""

import math

from bounce_env.engine.compile.jit import Record, function, where
from bounce_env.engine.contact.arrival import end_flight, snap_to_hit
from bounce_env.engine.contact.collisions import collide
from bounce_env.engine.contact.resolve import resolve
from bounce_env.engine.contact.sides import update_sides
from bounce_env.engine.detect.pairs import first_pair, let_all_go
from bounce_env.engine.detect.parts import plan_part_zones
from bounce_env.engine.detect.schedule import schedule_parts
from bounce_env.engine.events.crossings import cross_next
from bounce_env.engine.events.crushing import crush, meet_crushed
from bounce_env.engine.events.part_stops import reset_parts, stop_part
from bounce_env.engine.memory.ledger import is_page_full, keep_moment
from bounce_env.engine.memory.records import BUDGET, CRUSHED, FLYING, NEXT_HIT, NEXT_SENSOR, NEXT_ZONE, OK, RESOLVE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.flight import flight_of
from bounce_env.engine.motion.instant import before, later, since
from bounce_env.engine.motion.parts import part_moves_until, part_stop_instant
from bounce_env.engine.tolerances import BOUNCES_AT_ONE_EVENT, ULPS_OF_SPEED

DONE, BUDGET_SPENT, PAGE_FULL, BOUNCED = 0, 1, 2, 3
"""How a run of the loop ends: DONE, at the instant that was asked for; the others before it."""

ANY_BOUNCES = 2**62
"""More than there ever are."""

# What comes next.
NOTHING, OF_BALL, OF_PAIR, OF_PART = -1, 0, 1, 2

# Of one ball: bounces, the end of a contact and the beginning of another, a small hop and what is in its way, a crush,
# and the stop of a wall's two ends.
ROWS_AT_ONE_EVENT = BOUNCES_AT_ONE_EVENT + 7


@function
def run(
    state: State,
    w: int,
    until_hi: float,
    until_lo: float,
    max_events: int,
    bounces: int = ANY_BOUNCES,
    paged: bool = False,
) -> int:
    """Process the events of world `w` up to and including an instant; DONE, BUDGET_SPENT, PAGE_FULL or BOUNCED.

    until_hi, until_lo: the instant, seconds since reset, as the sum of two floats. At most `max_events` events are
    processed since `resume`, and no more where there have been `bounces` since reset. paged: stop where the recording
    of this world has no room for another event, which is otherwise left out of it. Unless DONE, the world's time is
    that of its last event, and the next call goes on from there.
    """
    world = state.worlds[w]
    keep_moment(state, w)
    while True:
        if world.bounces >= bounces:
            return BOUNCED
        hi, lo, what, i, j = _next_event(state, w, until_hi, until_lo)
        if what == NOTHING:
            world.time_hi, world.time_lo = until_hi, until_lo
            return DONE
        if world.events >= max_events:
            _stop_for_budget(state, w)
            return BUDGET_SPENT
        if paged and is_page_full(state, w, _rows_at_one_event(state)):
            return PAGE_FULL
        world.time_hi, world.time_lo = hi, lo
        if what == OF_BALL:
            world.events += _ball_event(state, w, i)
        elif what == OF_PAIR:
            collide(state, w, i, j, hi, lo)
            world.events += 1
        else:
            stop_part(state, w, i)
            world.events += 1
        keep_moment(state, w)


@where("pairs", otherwise=ROWS_AT_ONE_EVENT)
def _rows_at_one_event(state: State) -> int:
    """Return how many rows one event may have: of a cluster two for each contact and three for each ball besides."""
    return ROWS_AT_ONE_EVENT + 2 * state.contacts.shape[1] + 3 * state.balls.shape[1]


@function
def _next_event(state: State, w: int, until_hi: float, until_lo: float) -> tuple[float, float, int, int, int]:
    hi, lo, what, i, j = math.inf, 0.0, NOTHING, -1, -1
    for k in range(state.balls.shape[1]):
        b = state.balls[w, k]
        if not before(until_hi, until_lo, b.next_hi, b.next_lo) and before(b.next_hi, b.next_lo, hi, lo):
            hi, lo, what, i = b.next_hi, b.next_lo, OF_BALL, k
    pair_hi, pair_lo, one, other = first_pair(state, w, until_hi, until_lo)
    if before(pair_hi, pair_lo, hi, lo):
        hi, lo, what, i, j = pair_hi, pair_lo, OF_PAIR, one, other
    m, stop_hi, stop_lo = _first_part_stop(state, w, until_hi, until_lo)
    if before(stop_hi, stop_lo, hi, lo):
        hi, lo, what, i = stop_hi, stop_lo, OF_PART, m
    return hi, lo, what, i, j


@where("parts", otherwise=(-1, math.inf, 0.0))
def _first_part_stop(state: State, w: int, until_hi: float, until_lo: float) -> tuple[int, float, float]:
    """Return the part that first comes to a stop up to an instant, and when: (part, hi, lo), part -1 if none does."""
    scene = state.worlds[w].scene
    hi, lo, first = math.inf, 0.0, -1
    for m in range(state.motions.shape[1]):
        motion, shape = state.motions[w, m], state.parts[scene, m]
        if part_moves_until(motion, shape, until_hi, until_lo):
            continue
        stop_hi, stop_lo = part_stop_instant(motion, shape)
        if not before(until_hi, until_lo, stop_hi, stop_lo) and before(stop_hi, stop_lo, hi, lo):
            hi, lo, first = stop_hi, stop_lo, m
    return first, hi, lo


@function
def is_calm(state: State, w: int, until_hi: float, until_lo: float) -> bool:
    """Return whether surely nothing happens in world `w` up to and including an instant."""
    return balls_are_calm(state, w, until_hi, until_lo) and _all_parts_move_until(state, w, until_hi, until_lo)


@function
def balls_are_calm(state: State, w: int, until_hi: float, until_lo: float) -> bool:
    """Return whether surely no ball of world `w` has an event up to and including an instant."""
    for k in range(state.balls.shape[1]):
        if not before(until_hi, until_lo, state.balls[w, k].next_hi, state.balls[w, k].next_lo):
            return False
    return first_pair(state, w, until_hi, until_lo)[2] < 0


@where("parts", otherwise=True)
def _all_parts_move_until(state: State, w: int, until_hi: float, until_lo: float) -> bool:
    for m in range(state.motions.shape[1]):
        if not part_moves_until(state.motions[w, m], state.parts[state.worlds[w].scene, m], until_hi, until_lo):
            return False
    return True


@function
def _stop_for_budget(state: State, w: int) -> None:
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == OK:
            state.balls[w, k].status = BUDGET


@function
def _ball_event(state: State, w: int, k: int) -> int:
    """Process the ball's next event; returns how many events it counts for in the budget."""
    ball = state.balls[w, k]
    if ball.next_kind == NEXT_ZONE:
        plan_part_zones(state, w, k, ball.zone_after)
        schedule_parts(state, w, k)
        return 0
    if ball.next_kind == NEXT_SENSOR:
        cross_next(state, w, k)
        return 1
    if ball.status == CRUSHED:
        meet_crushed(state, w, k, ball.part_index)
        return 1
    planning = ball.next_kind == NEXT_HIT and ball.hit_kind == RESOLVE
    bounces = state.worlds[w].bounces
    _ball_hits(state, w, k)
    # A ball that is only planned anew has met nothing.
    return 0 if planning and state.worlds[w].bounces == bounces and ball.contact == FLYING else 1


@function
def _ball_hits(state: State, w: int, k: int) -> None:
    ball = state.balls[w, k]
    # A kept hit is a duration from the flight's start, so that its own rounding is all there is.
    t = ball.hit_after if ball.next_kind == NEXT_HIT else since(ball.part_hi, ball.part_lo, ball.hi, ball.lo)
    start = flight_of(state, ball)
    end_flight(state, w, k, t, ball.next_hi, ball.next_lo)
    snap_to_hit(state, w, k)
    update_sides(state, w, k, start, t)
    at_once = _is_over_at_once(ball, t) and not (ball.next_kind == NEXT_HIT and ball.hit_kind == RESOLVE)
    bounces = state.worlds[w].bounces
    resolve(state, w, k, at_once)
    ball.confined += state.worlds[w].bounces > bounces
    if ball.status == CRUSHED:
        crush(state, w, k)


@function
def _is_over_at_once(ball: Record, t: float) -> bool:
    """Return whether `t` seconds of flight have changed neither place nor velocity by more than rounding."""
    speed, pull = abs(ball.vx) + abs(ball.vy), abs(ball.gx) + abs(ball.gy)
    return speed * t <= ball.tolerance and pull * t <= ULPS_OF_SPEED * speed


@function
def restart(state: State, w: int) -> None:
    """Set world `w` back to time 0 with its parts where they start; balls are placed after this."""
    world = state.worlds[w]
    world.time_hi, world.time_lo = 0.0, 0.0
    world.bounces, world.speed_capped = 0, 0
    world.events, world.events_before = 0, 0
    world.drag_hi, world.drag_lo = -1.0, 0.0
    let_all_go(state, w)
    clear_hits(state, w)
    _cool_down(state, w)
    _enable_all(state, w)
    reset_parts(state, w)


@where("cooling")
def _cool_down(state: State, w: int) -> None:
    for element in range(state.cooling.shape[1]):
        state.cooling[w, element].hi, state.cooling[w, element].lo = 0.0, 0.0


@where("disabled")
def _enable_all(state: State, w: int) -> None:
    for element in range(state.disabled.shape[1]):
        state.disabled[w, element] = 0


@function
def clear_hits(state: State, w: int) -> None:
    """Forget which elements were struck in the last step; a step without hits pays a comparison."""
    dirty = state.worlds[w].dirty
    if dirty == 0:
        return
    state.worlds[w].dirty = 0
    if dirty > state.struck.shape[1]:
        for element in range(state.hits.shape[1]):
            state.hits[w, element] = 0
    else:
        for j in range(dirty):
            state.hits[w, state.struck[w, j]] = 0


@function
def begin_call(state: State, w: int, seconds: float) -> tuple[float, float]:
    """Begin a call that advances world `w` by `seconds`: forget the last one; returns the instant that it goes to."""
    clear_hits(state, w)
    resume(state, w)
    target: tuple[float, float] = later(state.worlds[w].time_hi, state.worlds[w].time_lo, seconds)
    return target


@function
def resume(state: State, w: int) -> None:
    """Let balls that the event budget stopped go on, with a new budget."""
    state.worlds[w].events_before += state.worlds[w].events
    state.worlds[w].events = 0
    for k in range(state.balls.shape[1]):
        if state.balls[w, k].status == BUDGET:
            state.balls[w, k].status = OK
