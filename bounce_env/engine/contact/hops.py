"""Small hops: how a ball goes on along what it is pressed on, where there is no closed form for a contact."""

from bounce_env.engine.compile.jit import Table, function, where
from bounce_env.engine.contact.bounces import fastest_closing
from bounce_env.engine.contact.hits import count_bounce
from bounce_env.engine.contact.restitution import (
    closing_speed,
    normal_load,
    push_off,
    rolling_speed,
    slow_speed,
    surface_speed,
)
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import BOUNCES_BEFORE_STANDING


@function
def hop_on(state: State, w: int, k: int, at_once: bool, bounces: int, ledger: Table) -> None:
    """Let a ball that flies go on in small hops along what it is pressed on, where that is no wall or the like.

    bounces: how many there had been when the ball came here, at once or not.
    """
    if state.gravity is not None:
        _roll(state, w, k, ledger)
    # Where something closes on it, a ball without room is bounced from a corner at once, for ever.
    if at_once and (state.worlds[w].bounces == bounces or state.balls[w, k].confined > BOUNCES_BEFORE_STANDING):
        _leave_part(state, w, k, ledger)


@where("parts")
def _roll(state: State, w: int, k: int, ledger: Table) -> None:
    """Let a ball that flies along the round end of a part, pressed on it, leave it with the smallest rebound.

    What else it touches was not closed on without the hop: where it would be now, the ball leaves along that.
    """
    ball = state.balls[w, k]
    best, index = 0.0, -1
    for i in range(ball.touched):
        touch = state.touches[w, i]
        leaving = closing_speed(ball, touch) < -slow_speed(ball, touch)
        if touch.curvature != 0.0 and touch.part >= 0 and not leaving and normal_load(ball, touch) > best:
            best, index = normal_load(ball, touch), i
    if index < 0:
        return
    touch = state.touches[w, index]
    extent = state.scenes[state.worlds[w].scene].extent
    hop = rolling_speed(ball, touch, best, extent) + closing_speed(ball, touch)
    vx0, vy0 = ball.vx, ball.vy
    push_off(ball, touch, hop)
    count_bounce(state, w, k, touch, vx0, vy0, ledger)
    _keep_off(state, w, k, ledger)


@function
def _keep_off(state: State, w: int, k: int, ledger: Table) -> None:
    """After a small hop: let the ball leave along what the hop closes on."""
    ball = state.balls[w, k]
    other, closing = fastest_closing(ball, state.touches, w, 0.0)
    if other >= 0:
        touch, vx0, vy0 = state.touches[w, other], ball.vx, ball.vy
        push_off(ball, touch, closing)
        count_bounce(state, w, k, touch, vx0, vy0, ledger)


@where("parts")
def _leave_part(state: State, w: int, k: int, ledger: Table) -> None:
    """Let a ball leave a part that it touches with the smallest rebound: one small hop, as along a curve.

    Between a part that moves and something else it may be pressed on both and close on neither. What it leaves already
    is not what it was told of.
    """
    ball, index = state.balls[w, k], -1
    for i in range(ball.touched):
        touch = state.touches[w, i]
        leaving = closing_speed(ball, touch) < -slow_speed(ball, touch)
        if (
            touch.part >= 0
            and not leaving
            and (index < 0 or surface_speed(touch) > surface_speed(state.touches[w, index]))
        ):
            index = i
    if index < 0:
        return
    touch = state.touches[w, index]
    vx0, vy0 = ball.vx, ball.vy
    # Without gravity there is no smallest rebound, but rounding, which had told it of the hit.
    push_off(ball, touch, max(touch.least, 2.0 * slow_speed(ball, touch)))
    count_bounce(state, w, k, touch, vx0, vy0, ledger)
    _keep_off(state, w, k, ledger)
