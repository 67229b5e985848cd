"""Balls that keep hitting each other without room for it: from when on they lose speed in that, and when they stand.

A kick, or a part that has been stopped, may drive balls to and fro in a gap of next to nothing: time would stand still.
"""

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.contact.squeeze import is_caught
from bounce_env.engine.detect.pairs import pair_weight
from bounce_env.engine.memory.ledger import Surface, append_contact
from bounce_env.engine.memory.records import BOUNCE, CRUSHED, FLYING, HELD, JAMMED, SETTLES
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import since
from bounce_env.engine.tolerances import (
    CORNER,
    HITS_BEFORE_STANDING,
    MEETINGS_AT_ONE_INSTANT,
    MEETINGS_WITHOUT_ROOM,
    SQUEEZES,
    ULPS_OF_LENGTH,
)


@where("pairs")
def forget_meetings(state: State, w: int) -> None:
    """No two balls have hit each other yet."""
    for k in range(state.pairs.shape[1]):
        for j in range(k):
            state.pairs[w, k, j].meets = 0


@function
def count_meeting(world: Record, pair: Record, one: Record, other: Record, extent: float, hi: float, lo: float) -> None:
    """Count a hit of two balls at the instant (hi, lo), before it is resolved.

    Instants in between which no ball moves by more than the gaps of a corner are one, and so is a row of such. Of all
    hits then the fastest speed is kept: what is left of it may be rounding.
    """
    t = since(hi, lo, world.meet_hi, world.meet_lo)
    longest_way = (world.meet_speed + pair_weight(one, other) * t) * t
    if not longest_way <= CORNER * ULPS_OF_LENGTH * extent or t < 0.0:
        world.meets, world.meet_speed = 0, 0.0
    world.meet_hi, world.meet_lo = hi, lo
    world.meets += 1
    note_speed(world, one, other)
    if one.legs + other.legs != pair.legs:
        pair.meets, pair.legs = 0, one.legs + other.legs
    pair.meets += 1


@function
def note_speed(world: Record, one: Record, other: Record) -> None:
    """Note how fast two balls leave each other."""
    world.meet_speed = max(world.meet_speed, _speeds(one, other))


@function
def have_no_room(world: Record, pair: Record) -> bool:
    """Whether two balls hit each other so often without room that their hits have no rebound."""
    return world.meets > MEETINGS_AT_ONE_INSTANT or pair.meets > MEETINGS_WITHOUT_ROOM


@function
def are_stuck(world: Record, pair: Record, one: Record, other: Record) -> bool:
    """Whether that has not ended it, and something holds one of them: in free flight they go on together."""
    at_once = world.meets > HITS_BEFORE_STANDING * MEETINGS_AT_ONE_INSTANT
    without_room = pair.meets > HITS_BEFORE_STANDING * MEETINGS_WITHOUT_ROOM
    return (at_once or without_room) and (_is_held(one) or _is_held(other))


@function
def _is_held(ball: Record) -> bool:
    return ball.touched > 0 or ball.contact == HELD or ball.status == CRUSHED


@function
def stop(state: State, w: int, k: int, j: int, nx: float, ny: float, ledger: Table) -> None:
    """Stop ball `k`, which ball `j` keeps hitting; where a part has it caught, that is to crush it first."""
    ball, other, world = state.balls[w, k], state.balls[w, j], state.worlds[w]
    if ball.status == CRUSHED:
        return
    if is_caught(ball, state.scenes[world.scene]) and ball.squeezes < SQUEEZES:
        ball.squeezes = SQUEEZES
        return
    if ball.settling == SETTLES:
        ball.contact, ball.support = FLYING, -1  # that contact does not begin
    vx, vy = ball.vx, ball.vy
    ball.vx, ball.vy, ball.settling = 0.0, 0.0, JAMMED
    surface = Surface(state.scenes[world.scene].elements + j, nx, ny, other.vx, other.vy)
    append_contact(ledger, world, ball, k, BOUNCE, surface, vx, vy)


@function
def _speeds(one: Record, other: Record) -> float:
    return abs(one.vx) + abs(one.vy) + abs(other.vx) + abs(other.vy)
