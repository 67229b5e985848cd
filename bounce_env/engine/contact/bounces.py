"""What happens at the instant of a hit: the ball is put on the surface, and all that it touches is bounced from.

Of several elements touched at once the one closed on fastest is bounced from first, until none is closed on; two that
are closed on alike are bounced from as one. So a corner is right from either side, and mirror images stay mirror
images. What the ball does then (whether it flies, slides or rests) is decided in `engine.contact.resolve`.
"""

from bounce_env.engine.compile.jit import Record, Table, function, routine
from bounce_env.engine.contact.corners import (
    bounce_off_both,
    is_bounce_damped,
    keep_ahead,
    most_bounces,
    project_bounces,
)
from bounce_env.engine.contact.hits import bounce_off, count_bounce
from bounce_env.engine.contact.restitution import closing_speed, is_soft, normal_load, push_off, slow_speed
from bounce_env.engine.contact.room import fastest_escape, is_crushed_by
from bounce_env.engine.memory.records import CRUSHED
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import BOUNCES_AT_ONE_EVENT, ULPS_OF_SPEED

GOES_ON = -2  # instead of a surface: what happens at this instant needs another event


@function
def take_vague(ball: Record, touches: Table, w: int, vague: float) -> None:
    """Take from the velocity what closes on a surface only since another ball's push missed its direction.

    vague: by how much [m/s] it may have.
    """
    for i in range(ball.touched):
        touch = touches[w, i]
        closing = closing_speed(ball, touch)
        if 0.0 < closing <= vague:
            push_off(ball, touch, closing)


@function
def take_soft(ball: Record, touches: Table, w: int, extent: float) -> None:
    """Take from the velocity what leaves a surface that the ball is pressed on in a hop that rises above no tolerance.

    Such a hop may last less than the clock can tell: the ball would be told of its end for ever.
    """
    for i in range(ball.touched):
        touch = touches[w, i]
        closing, press = closing_speed(ball, touch), normal_load(ball, touch)
        if closing < 0.0 < press and is_soft(-closing, press, extent):
            push_off(ball, touch, closing)


@function
def fastest_closing(ball: Record, touches: Table, w: int, slowest: float) -> tuple[int, float]:
    """Return of the touched surfaces the one closed on fastest, ties by element: (index, speed), -1 if none is.

    Closing no faster than `slowest` [m/s], or than rounding, is none.
    """
    best, index, element = 0.0, -1, -1
    for i in range(ball.touched):
        touch = touches[w, i]
        closing = closing_speed(ball, touch)
        slow = slow_speed(ball, touch)
        if closing <= max(slow, slowest):
            continue
        # Alike but for rounding is a tie.
        if closing > best + slow or (closing >= best - slow and touch.element < element):
            best, index, element = closing, i, touch.element
    return index, best


@function
def bounce_from_all(state: State, w: int, k: int) -> tuple[int, int, float, float]:
    """Bounce from everything that the ball touches and closes on, fastest first.

    Where bounces in a corner are taken to be over, what closes is taken from the velocity. Returns (single, corner, vx,
    vy): the touched surface that was bounced from if it was just one, without a kick; the one that led to the end of
    bounces in a corner, or GOES_ON where there are more than one event has room for; -1 where there is none; and the
    velocity [m/s] before the latter, which is not yet logged.
    """
    ball = state.balls[w, k]
    noise = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    damped = False
    for _ in range(BOUNCES_AT_ONE_EVENT):
        i, closing = fastest_closing(ball, state.touches, w, 0.0)
        if i < 0:
            return -1, -1, ball.vx, ball.vy
        damped = ball.touched > 1 and is_bounce_damped(state, w, k, i, closing)
        if damped:
            break
        if ball.touched > 1 and bounce_off_both(state, w, k, i, noise):
            continue
        kicked = bounce_off(state, w, k, i, closing, noise)
        if is_crushed_by(state, w, k, i):
            ball.status = CRUSHED
            return -1, -1, ball.vx, ball.vy
        if ball.touched == 1:
            return (-1 if kicked else i), -1, ball.vx, ball.vy
    if not damped and BOUNCES_AT_ONE_EVENT * (ball.confined + 1) < most_bounces(ball, state.touches, w):
        return -1, GOES_ON, ball.vx, ball.vy
    vx, vy = ball.vx, ball.vy
    return -1, _end_bounces(state, w, k), vx, vy


@function
def _end_bounces(state: State, w: int, k: int) -> int:
    """Take from the velocity what closes, or crush the ball; return the surface closed on fastest, -1 for none."""
    ball = state.balls[w, k]
    i, _ = fastest_closing(ball, state.touches, w, 0.0)
    vx, vy = ball.vx, ball.vy
    fastest = fastest_escape(ball, state.touches, w, state.scenes[state.worlds[w].scene])
    if i >= 0 and not project_bounces(ball, state.touches, w, i, fastest):
        ball.status, ball.vx, ball.vy = CRUSHED, vx, vy
    elif i >= 0:
        keep_ahead(ball, state.touches, w)
    return i


@routine
def bounce_off_fast(state: State, w: int, k: int, slowest: float) -> None:
    """Bounce from what a ball touches and closes on faster than `slowest` [m/s], fastest first; it may get crushed."""
    ball = state.balls[w, k]
    for _ in range(BOUNCES_AT_ONE_EVENT):
        i, closing = fastest_closing(ball, state.touches, w, slowest)
        if i < 0:
            return
        bounce_off(state, w, k, i, closing, 0.0)
        if is_crushed_by(state, w, k, i):
            ball.status = CRUSHED
            return
    if BOUNCES_AT_ONE_EVENT * (ball.confined + 1) < most_bounces(ball, state.touches, w):
        return
    vx, vy = ball.vx, ball.vy
    i = _end_bounces(state, w, k)
    if i >= 0 and ball.status != CRUSHED:
        count_bounce(state, w, k, state.touches[w, i], vx, vy)
