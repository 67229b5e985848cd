"""Bounces in a corner, of several surfaces at one instant: from two at once, how many there may be, how they end."""

import math

from bounce_env.engine.compile.jit import Record, Table, function
from bounce_env.engine.contact.hits import count_corner, rebound_from
from bounce_env.engine.contact.restitution import (
    ahead_of_both,
    capped,
    closing_speed,
    is_soft,
    is_standing,
    normal_load,
    push_off,
    slow_speed,
    surface_speed,
)
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import (
    ALIGNED,
    BOUNCES_AT_ONE_EVENT,
    BOUNCES_AT_ONE_INSTANT,
    CORNER,
    ULPS_OF_SPEED,
)


@function
def bounce_off_both(state: State, w: int, k: int, i: int, noise: float) -> bool:
    """Bounce from touched surface `i` and one that is closed on alike, as one; returns whether there is such a one.

    v' = P(v) - e (v - P(v)), where P(v), the nearest velocity that closes on neither, is 0 between two that stand. One
    after the other they would send a ball that comes straight into a wedge off to one side.
    """
    ball, one = state.balls[w, k], state.touches[w, i]
    j = _closed_on_alike(state, w, k, i)
    if j < 0:
        return False
    other = state.touches[w, j]
    closing = closing_speed(ball, one)
    rebound, _ = rebound_from(state, w, k, i, closing)
    e = rebound / closing
    vx0, vy0 = ball.vx, ball.vy
    vx, vy = -e * vx0, -e * vy0
    if abs(vx) + abs(vy) <= noise:
        vx, vy = 0.0, 0.0
    vx, vy, over = capped(vx, vy, one.nx, one.ny, 0.0, 0.0, state.scenes[state.worlds[w].scene].max_speed)
    state.worlds[w].speed_capped += over
    # What each of them adds: the velocity changes by both together.
    turn = one.nx * other.ny - one.ny * other.nx
    share = ((vx - vx0) * other.ny - (vy - vy0) * other.nx) / turn
    ball.vx, ball.vy = vx0 + share * one.nx, vy0 + share * one.ny
    count_corner(state, w, k, one, vx0, vy0)
    vx0, vy0, ball.vx, ball.vy = ball.vx, ball.vy, vx, vy
    count_corner(state, w, k, other, vx0, vy0)
    return True


@function
def _closed_on_alike(state: State, w: int, k: int, i: int) -> int:
    """Return another touched surface that is closed on as fast as surface `i`, and rebounds alike; -1 if none is."""
    ball, one = state.balls[w, k], state.touches[w, i]
    closing, slow = closing_speed(ball, one), slow_speed(ball, one)
    if not _may_be_one_of_two(state, w, one, closing):
        return -1
    rebound, _ = rebound_from(state, w, k, i, closing)
    for j in range(ball.touched):
        other = state.touches[w, j]
        if abs(one.nx * other.ny - one.ny * other.nx) <= ALIGNED or abs(closing_speed(ball, other) - closing) > slow:
            continue
        as_fast, _ = rebound_from(state, w, k, j, closing)
        if _may_be_one_of_two(state, w, other, closing) and abs(as_fast - rebound) <= slow:
            return j
    return -1


@function
def _may_be_one_of_two(state: State, w: int, touch: Record, closing: float) -> bool:
    """Return whether a touched surface stands, and gives no kick."""
    material = state.elements[state.worlds[w].scene, touch.element]
    return is_standing(touch) and not (material.kick > 0.0 and closing > material.kick_threshold)


@function
def most_bounces(ball: Record, touches: Table, w: int) -> int:
    """Return how many bounces at one instant end a ball's stay in a corner.

    Between two walls that stand a ball that loses nothing leaves after pi / angle of them at most, as its path mirrored
    in each wall is a straight line; the angle's sine is a little less than it.
    """
    most = 0.0
    for i in range(ball.touched):
        for j in range(i):
            one, other = touches[w, i], touches[w, j]
            turn, along = one.nx * other.ny - one.ny * other.nx, one.nx * other.nx + one.ny * other.ny
            if along < 0.0 and abs(turn) > ALIGNED and is_standing(one) and is_standing(other):
                most = max(most, math.pi / abs(turn))
    return BOUNCES_AT_ONE_EVENT + int(min(4.0 * math.ceil(most), float(BOUNCES_AT_ONE_INSTANT)))


@function
def is_bounce_damped(state: State, w: int, k: int, i: int, closing: float) -> bool:
    """Return whether a ball in a corner comes so slowly that its bounces there are taken to be over."""
    ball, world = state.balls[w, k], state.worlds[w]
    head = state.scenes[world.scene]
    if state.gravity is None:
        return False
    touch = state.touches[w, i]
    material = state.elements[world.scene, touch.element]
    press = normal_load(ball, touch)
    if touch.moves or surface_speed(touch) != 0.0:
        return False
    if press == 0.0 or (material.kick > 0.0 and closing > material.kick_threshold):
        return False
    return closing < head.rest_speed or is_soft(closing, press, CORNER * head.extent)


@function
def project_bounces(ball: Record, touches: Table, w: int, first: int, fastest: float) -> bool:
    """Take from the velocity what closes on any touched surface: along one of them where the others allow, else all.

    The one closed on fastest (`first`) is tried first. Returns False where a part closes on the ball and nothing lets
    it get away, no faster than `fastest` [m/s].
    """
    vx, vy = ball.vx, ball.vy
    for n in range(ball.touched):
        touch = touches[w, (first + n) % ball.touched]
        ball.vx, ball.vy = vx, vy
        closing = closing_speed(ball, touch)
        push_off(ball, touch, closing)
        if closing > 0.0 and _is_bounce_allowed(ball, touches, w, vx, vy):
            rest = closing_speed(ball, touch)
            if rest > slow_speed(ball, touch):
                # Next to the speed that is left, the rounding of the old one would be another hit.
                push_off(ball, touch, rest)
            return True
    ball.vx, ball.vy = touches[w, first].ux, touches[w, first].uy
    striker = _bounce_striker(ball, touches, w)
    if striker < 0:
        if not _is_bounce_allowed(ball, touches, w, vx, vy):
            # Friction drives it in between: nothing comes towards the ball, so that it may stand.
            ball.vx, ball.vy = 0.0, 0.0
        return True
    for i in range(ball.touched):
        for j in range(i):
            out = _keep_ahead_of_both(ball, touches[w, i], touches[w, j], fastest)
            if out and _is_bounce_allowed(ball, touches, w, vx, vy):
                return True
    ball.struck = touches[w, striker].part
    return False


@function
def keep_ahead(ball: Record, touches: Table, w: int) -> None:
    """Let a ball that has come to keep up with a part that turns or stretches leave it with the smallest rebound.

    Along whatever else it touches: there is no closed form for how it would be pushed along that.
    """
    for i in range(ball.touched):
        part = touches[w, i]
        short = part.least + closing_speed(ball, part)
        if not part.moves or short <= 0.0 or surface_speed(part) <= 0.0:
            continue
        x, y = part.nx, part.ny
        for j in range(ball.touched):
            other = touches[w, j]
            turn = part.nx * other.ny - part.ny * other.nx
            if x * other.nx + y * other.ny < 0.0 and abs(turn) > ALIGNED:
                x, y = other.ny / turn, -other.nx / turn
        ball.vx, ball.vy = ball.vx + short * x, ball.vy + short * y
        return


@function
def _is_bounce_allowed(ball: Record, touches: Table, w: int, vx: float, vy: float) -> bool:
    """Return whether a ball of velocity (vx, vy) [m/s] before closes on nothing that it touches now."""
    allowed = True
    for j in range(ball.touched):
        # Seen from the velocity that the ball had: what is left of it may be all rounding.
        noise = slow_speed(ball, touches[w, j]) + ULPS_OF_SPEED * (abs(vx) + abs(vy))
        allowed = allowed and closing_speed(ball, touches[w, j]) <= noise
    return allowed


@function
def _bounce_striker(ball: Record, touches: Table, w: int) -> int:
    """Return the touched part that moves fastest towards the ball; -1 if none does."""
    best, index = 0.0, -1
    for i in range(ball.touched):
        if surface_speed(touches[w, i]) > best:
            best, index = surface_speed(touches[w, i]), i
    return index


@function
def _keep_ahead_of_both(ball: Record, one: Record, other: Record, fastest: float) -> bool:
    """Let the ball keep just ahead of two surfaces, along both; False where that takes more than `fastest` [m/s]."""
    turn = one.nx * other.ny - one.ny * other.nx
    if abs(turn) <= ALIGNED:
        return False
    ball.vx, ball.vy = ahead_of_both(one, other, turn)
    return math.sqrt(ball.vx * ball.vx + ball.vy * ball.vy) <= fastest
