"""What a ball does after its bounces at one instant: it flies, slides along a wall, or rests.

A contact is a constraint, not a series of tiny bounces. On a wall that stands the ball slides in closed form under the
tangential part of its acceleration; ever smaller bounces that lead there are summed in closed form (the geometric
series of anchors/numerics.md, check 2). On curves there is none: there the ball rests, or rolls by small hops.
"""

import math

from bounce_env.engine.arrive import face_crossings
from bounce_env.engine.jit import Record, Table, function
from bounce_env.engine.layout import (
    CONTACT_BEGINS,
    CONTACT_ENDS,
    CRUSHED,
    FLYING,
    HELD,
    RESOLVE,
    RIDING,
    SETTLES,
    STANDS,
    State,
    Tables,
)
from bounce_env.engine.pairs import plan_pairs
from bounce_env.engine.resolve import (
    along_speed,
    bounce_from_all,
    closing_speed,
    count_bounce,
    fastest_closing,
    is_soft,
    log,
    press_of,
    rolling_speed,
    slow_speed,
    take_vague,
    towards,
)
from bounce_env.engine.search import plan_rest, plan_standing
from bounce_env.engine.tolerances import (
    ALIGNED,
    BALANCE,
    CLEARANCE,
    CORNER,
    PRESSING,
    STANDING,
    SWING,
    ULPS_OF_LENGTH,
    ULPS_OF_SPEED,
    WEIGHTLESS,
)
from bounce_env.engine.touch import collect_touches


@function
def resolve(state: State, tables: Tables, w: int, k: int, at_once: bool, ledger: Table) -> None:
    """Bounce a ball from all that it touches, decide what it does next, and plan that.

    at_once: whether its flight has ended where it began, by something that it was to hit.
    """
    ball = state.balls[w, k]
    if ball.settling == STANDS:
        duration = _stand(ball, tables.scenes[state.worlds[w].scene], state.worlds[w])
    else:
        duration = _bounce_and_go(state, tables, w, k, at_once, ledger)
        if ball.status == CRUSHED:
            return
    if duration >= 0.0:
        ball.hit_kind, ball.hit_after, ball.end_after = RESOLVE, duration, duration
    plan_rest(state, tables, w, k)
    plan_pairs(state, tables, state.pairs, w, k)


@function
def _stand(ball: Record, head: Record, world: Record) -> float:
    """Let a ball that others keep hitting stand for as long as it takes to move by a clearance: a duration [s]."""
    ball.settling = 0
    way, g = CLEARANCE * head.extent, math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
    falling = math.sqrt(2.0 * way / g) if g > WEIGHTLESS else math.inf
    return min(falling, way / max(world.meet_speed, STANDING))


@function
def _bounce_and_go(state: State, tables: Tables, w: int, k: int, at_once: bool, ledger: Table) -> float:
    """Bounce a ball from all that it touches, let it fly, slide or rest, and search what stands in its way.

    Returns after how long [s] it is to be looked at again because its last bounces are summed up to then, otherwise -1.
    """
    ball, bounces = state.balls[w, k], state.worlds[w].bounces
    if abs(ball.vx) + abs(ball.vy) < STANDING:
        ball.vx, ball.vy = 0.0, 0.0
    extent = tables.scenes[state.worlds[w].scene].extent
    if tables.gravity is not None and _is_slow(ball, extent):
        # Between several surfaces the last bounces go to and fro: what lies within their reach counts as touched.
        ball.slack = max(ball.slack, CORNER * ULPS_OF_LENGTH * extent)
    contact, support, settling = ball.contact, ball.support, ball.settling
    ball.settling = 0
    collect_touches(state, tables, w, k)
    if ball.vague > 0.0:
        take_vague(ball, state.touches, w)
    single, corner, vx0, vy0 = bounce_from_all(state, tables, w, k, ledger)
    if ball.status == CRUSHED:
        return -1.0
    _let_go(ball)
    if tables.gravity is not None:
        if settling:
            contact, support = FLYING, -1  # that contact had not begun yet
        # Told at once of a hit of something that it does not close on, a riding ball would be so for ever: it hops off.
        again = contact == RIDING and at_once and state.worlds[w].bounces == bounces
        i = _change_contact(state, tables, w, k, contact, support, again, vx0, vy0, ledger)
        corner = corner if i < 0 else -1
    if corner >= 0:
        count_bounce(state, w, k, state.touches[w, corner], vx0, vy0, ledger)
    if ball.contact == FLYING:
        _hop(state, tables, w, k, at_once, bounces, ledger)
    face_crossings(state, tables, w, k)
    vx, vy, duration = ball.vx, ball.vy, -1.0
    if tables.gravity is not None and single >= 0 and ball.contact == FLYING:
        duration = _settle(state, tables, w, k, single)
    for _ in range(2):
        plan_standing(state, tables, w, k)
        if duration < 0.0 or ball.hit_after > duration:
            break
        # Something comes before the bounces are over: they go on one by one.
        _let_go(ball)
        ball.vx, ball.vy, ball.settling, duration = vx, vy, 0, -1.0
    return duration


@function
def _change_contact(
    state: State, tables: Tables, w: int, k: int, contact: int, support: int, off: bool, vx: float, vy: float,
    ledger: Table,
) -> int:  # fmt: skip
    """Find the ball's contact, if it is not to fly `off`; log the end of the one that it had, the beginning of another.

    (vx, vy): its velocity [m/s] before. Returns which touched surface a new contact is with, -1 if there is none.
    """
    ball = state.balls[w, k]
    i = -1 if off else _find_contact(state, tables, w, k)
    stopped = ball.contact == HELD and (vx != ball.vx or vy != ball.vy)  # held again, after a push
    if ball.contact == contact and ball.support == support and not stopped:
        return -1
    if support >= 0:
        _log_end(state, w, k, support, vx, vy, ledger)
    if i >= 0:
        touch = state.touches[w, i]
        ball.nx, ball.ny = touch.nx, touch.ny
        log(
            ledger, state.worlds[w], ball, k, touch.element, CONTACT_BEGINS,
            touch.nx, touch.ny, vx, vy, touch.ux, touch.uy,
        )  # fmt: skip
    return i


@function
def _is_slow(ball: Record, extent: float) -> bool:
    """Whether the ball could not rise above the tolerance of corners."""
    pull = math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
    return ball.vx * ball.vx + ball.vy * ball.vy <= 2.0 * pull * (CORNER * ULPS_OF_LENGTH * extent)


@function
def _let_go(ball: Record) -> None:
    ball.contact, ball.rides, ball.support = FLYING, -1, -1
    ball.ax, ball.ay = ball.gx, ball.gy


@function
def _find_contact(state: State, tables: Tables, w: int, k: int) -> int:
    """Hold the ball, or let it slide on a wall, where it is pressed on what it touches; -1 where it flies.

    Returns which touched surface supports it.
    """
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = tables.scenes[scene]
    for i in range(ball.touched):
        touch = state.touches[w, i]
        if touch.moves or closing_speed(ball, touch) < -slow_speed(ball, touch) or press_of(ball, touch) == 0.0:
            continue
        if not _lets_hold(ball, state.touches, w, i):
            continue
        f = tables.elements[scene, touch.element].f
        if f == 0.0 or (f < 1.0 and head.rest_speed == 0.0):
            return _hold(ball, touch, i)
        if _swings_out(ball, touch, head.rest_speed):
            return _hold(ball, touch, i)
    if ball.gx == 0.0 and ball.gy == 0.0:
        return -1
    if _is_slow(ball, head.extent):
        i = _carrier(ball, state.touches, w)
        if i >= 0:
            return _hold(ball, state.touches[w, i], i)
    for i in range(ball.touched):
        if _slides_on(ball, state.touches, w, i):
            return i
    return -1


@function
def _swings_out(ball: Record, touch: Record, rest_speed: float) -> bool:
    """Whether a ball in the hollow of a curve, or on top of one, moves so little to and fro that it is taken to rest.

    Told by the speed at which it comes, or came, through the point where the normal alone carries it.
    """
    if touch.bend == 0.0 or ball.gx * touch.nx + ball.gy * touch.ny >= 0.0:
        return False
    along, across = along_speed(ball, touch), ball.gx * touch.ny - ball.gy * touch.nx
    pull = math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
    speed = math.sqrt(along * along + across * across / (abs(touch.bend) * pull))
    natural = math.sqrt(pull / abs(touch.bend))
    return speed <= (max(rest_speed, SWING * natural) if touch.bend < 0.0 else BALANCE * natural)


@function
def _lets_hold(ball: Record, touches: Table, w: int, i: int) -> bool:
    """Whether nothing else that the ball touches moves into it where it is held by one surface."""
    held = touches[w, i]
    for j in range(ball.touched):
        other = touches[w, j]
        away = (held.ux - other.ux) * other.nx + (held.uy - other.uy) * other.ny
        if away < -ULPS_OF_SPEED * (abs(held.ux) + abs(held.uy) + abs(other.ux) + abs(other.uy)):
            return False
    return True


@function
def _hold(ball: Record, touch: Record, i: int) -> int:
    ball.contact, ball.rides, ball.support = HELD, touch.part, touch.element
    ball.vx, ball.vy, ball.ax, ball.ay = touch.ux, touch.uy, 0.0, 0.0
    return i


@function
def _carrier(ball: Record, touches: Table, w: int) -> int:
    """Which touched surface holds a ball of next to no speed, alone or with another one; -1 if they do not hold it."""
    for i in range(ball.touched):
        if _carries_alone(ball, touches[w, i]):
            return i
    for i in range(ball.touched):
        for j in range(i):
            of_one, of_other = _shares(ball, touches[w, i], touches[w, j])
            if of_one >= 0.0 and of_other >= 0.0:
                return i if of_one > of_other else j
    return -1


@function
def _carries_alone(ball: Record, touch: Record) -> bool:
    """Whether a surface is level beneath the ball, which does not move away: its bounces there are summed instead."""
    level = abs(ball.gx * touch.ny - ball.gy * touch.nx) <= ALIGNED * (abs(ball.gx) + abs(ball.gy))
    beneath = ball.gx * touch.nx + ball.gy * touch.ny < 0.0
    return level and beneath and _stands(touch) and closing_speed(ball, touch) >= -slow_speed(ball, touch)


@function
def _stands(touch: Record) -> bool:
    """Whether a touched surface does not move now."""
    return not touch.moves and touch.ux == 0.0 and touch.uy == 0.0


@function
def _shares(ball: Record, one: Record, other: Record) -> tuple[float, float]:
    """The forces (per mass, m/s^2) along two normals that together hold the ball; negative where there are none."""
    turn = one.nx * other.ny - one.ny * other.nx
    if not _stands(one) or not _stands(other) or abs(turn) <= ALIGNED:
        return -1.0, -1.0
    noise = ALIGNED * (abs(ball.gx) + abs(ball.gy))
    of_one = (ball.gy * other.nx - ball.gx * other.ny) / turn
    of_other = (ball.gx * one.ny - ball.gy * one.nx) / turn
    return of_one + noise, of_other + noise


@function
def _slides_on(ball: Record, touches: Table, w: int, i: int) -> bool:
    """Let the ball slide along what it touches, if that is straight, the ball is pressed on it and stays beside it.

    On a part that slides itself it does so in the part's frame.
    """
    touch = touches[w, i]
    slow = slow_speed(ball, touch)
    # However little it is pressed: what is not constrained would sink in by and by.
    pressed = ball.gx * touch.nx + ball.gy * touch.ny < 0.0
    if touch.bend != 0.0 or touch.moves or closing_speed(ball, touch) < -slow or not pressed:
        return False
    ux, uy = touch.ny, -touch.nx
    rate = (ball.vx - touch.ux) * ux + (ball.vy - touch.uy) * uy
    pull = ball.gx * ux + ball.gy * uy
    noise = PRESSING * (abs(ball.gx) + abs(ball.gy))
    lean = rate if abs(rate) > slow else (pull if abs(pull) > noise else 0.0)
    if (touch.along >= touch.length - ball.slack and lean > 0.0) or (touch.along <= ball.slack and lean < 0.0):
        return False
    ax, ay = pull * ux, pull * uy
    for j in range(ball.touched):
        other = touches[w, j]
        if closing_speed(ball, other) >= -slow_speed(ball, other) and ax * other.nx + ay * other.ny < -noise:
            return False
    _support(ball, touch)
    ball.vx, ball.vy, ball.ax, ball.ay = touch.ux + rate * ux, touch.uy + rate * uy, ax, ay
    return True


@function
def _support(ball: Record, touch: Record) -> None:
    """Let a ball be in contact with what it touches: with a straight side of it that it slides along."""
    ball.contact = touch.face if touch.part < 0 else RIDING
    ball.rides, ball.support = touch.part, touch.element


@function
def _hop(state: State, tables: Tables, w: int, k: int, at_once: bool, bounces: int, ledger: Table) -> None:
    """Let a ball that flies go on in small hops along what it is pressed on, where that is no wall or the like.

    bounces: how many there had been when the ball came here, at once or not.
    """
    if tables.gravity is not None or tables.arcs is not None:
        _roll(state, tables, w, k, ledger)
    if at_once and state.worlds[w].bounces == bounces:
        _leave_part(state, tables.parts, w, k, ledger)


@function
def _roll(state: State, tables: Tables, w: int, k: int, ledger: Table) -> None:
    """Let a ball that flies along a curve which it is pressed on leave it with the smallest rebound: one small hop.

    What else it touches was not closed on without the hop: where it would be now, the ball leaves along that.
    """
    ball = state.balls[w, k]
    best, index = 0.0, -1
    for i in range(ball.touched):
        touch = state.touches[w, i]
        leaving = closing_speed(ball, touch) < -slow_speed(ball, touch)
        if touch.bend != 0.0 and not leaving and press_of(ball, touch) > best:
            best, index = press_of(ball, touch), i
    if index < 0:
        return
    touch = state.touches[w, index]
    extent = tables.scenes[state.worlds[w].scene].extent
    hop = rolling_speed(ball, touch, best, extent) + closing_speed(ball, touch)
    ball.rolling = touch.element
    vx0, vy0 = ball.vx, ball.vy
    ball.vx, ball.vy = vx0 + hop * touch.nx, vy0 + hop * touch.ny
    count_bounce(state, w, k, touch, vx0, vy0, ledger)
    _keep_off(state, w, k, ledger)


@function
def _keep_off(state: State, w: int, k: int, ledger: Table) -> None:
    """After a small hop: let the ball leave along what the hop closes on."""
    ball = state.balls[w, k]
    other, closing = fastest_closing(ball, state.touches, w)
    if other >= 0:
        touch, vx0, vy0 = state.touches[w, other], ball.vx, ball.vy
        ball.vx, ball.vy = vx0 + closing * touch.nx, vy0 + closing * touch.ny
        count_bounce(state, w, k, touch, vx0, vy0, ledger)


@function
def _leave_part(state: State, parts: Table, w: int, k: int, ledger: Table) -> None:
    """Let a ball leave a part that it touches with the smallest rebound: one small hop, as along a curve.

    Between a part that moves and something else it may be pressed on both and close on neither.
    """
    if parts is None:
        return
    ball, index = state.balls[w, k], -1
    for i in range(ball.touched):
        touch = state.touches[w, i]
        if touch.part >= 0 and (index < 0 or towards(touch) > towards(state.touches[w, index])):
            index = i
    if index < 0:
        return
    touch = state.touches[w, index]
    vx0, vy0 = ball.vx, ball.vy
    ball.vx, ball.vy = vx0 + touch.least * touch.nx, vy0 + touch.least * touch.ny
    count_bounce(state, w, k, touch, vx0, vy0, ledger)
    _keep_off(state, w, k, ledger)


@function
def _settle(state: State, tables: Tables, w: int, k: int, single: int) -> float:
    """Sum the bounces still to come on a wall, if they rise above no tolerance; returns how long they take [s], or -1.

    With hops of durations tau, b tau, b^2 tau ... they end after tau / (1 - b); meanwhile the ball is on the wall. With
    f = 1 it slides as ever. With f < 1 it comes to stand; until then it is shown in uniform motion to where.
    """
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head, touch = tables.scenes[scene], state.touches[w, single]
    material = tables.elements[scene, touch.element]
    press, rebound, b, f = press_of(ball, touch), -closing_speed(ball, touch), material.b, material.f
    if touch.bend != 0.0 or touch.moves or head.rest_speed > 0.0 or not 0.0 < b < 1.0:
        return -1.0
    if press == 0.0 or not is_soft(rebound, press, head.extent):
        return -1.0
    ux, uy = touch.ny, -touch.nx
    hop = 2.0 * rebound / press
    duration = hop / (1.0 - b)
    speed = (ball.vx - touch.ux) * ux + (ball.vy - touch.uy) * uy
    pull = ball.gx * ux + ball.gy * uy
    if f < 1.0:
        way = speed * hop / (1.0 - f * b)
        way += pull * hop * hop * (1.0 + f * b) / (2.0 * (1.0 - f * b) * (1.0 - b * b))
        speed, pull = way / duration, 0.0
    ball.vx, ball.vy, ball.ax, ball.ay = touch.ux + speed * ux, touch.uy + speed * uy, pull * ux, pull * uy
    _support(ball, touch)
    ball.nx, ball.ny, ball.settling = touch.nx, touch.ny, SETTLES
    return duration


@function
def _log_end(state: State, w: int, k: int, support: int, vx: float, vy: float, ledger: Table) -> None:
    """The end of a contact changes no velocity: what does so has rows of its own."""
    ball = state.balls[w, k]
    new_vx, new_vy, ux, uy = ball.vx, ball.vy, 0.0, 0.0
    for i in range(ball.touched):
        if state.touches[w, i].element == support:
            ux, uy = state.touches[w, i].ux, state.touches[w, i].uy
    ball.vx, ball.vy = vx, vy
    log(ledger, state.worlds[w], ball, k, support, CONTACT_ENDS, ball.nx, ball.ny, vx, vy, ux, uy)
    ball.vx, ball.vy = new_vx, new_vy
