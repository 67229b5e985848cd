"""The smallest rebound: how a ball goes on along a part where a contact has no closed form.

So it does along what turns or stretches, and between two round surfaces, or two parts.
"""

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.contact.bounces import fastest_closing
from bounce_env.engine.contact.hits import count_bounce
from bounce_env.engine.contact.restitution import is_leaving, normal_load, push_off, slow_speed, surface_speed
from bounce_env.engine.memory.state import State


@where("parts")
def leave_part(state: State, w: int, k: int, told: bool) -> None:
    """Let a ball that flies leave a part with the smallest rebound: of those that it touches, the fastest.

    Only one that it does not leave already, where something round presses the ball, or it was told at once of a hit.
    Between a part that moves and something else it may be pressed on both and close on neither.
    """
    ball, index, called = state.balls[w, k], -1, told
    for i in range(ball.touched):
        touch = state.touches[w, i]
        called = called or (touch.curvature != 0.0 and not is_leaving(ball, touch) and normal_load(ball, touch) > 0.0)
    for i in range(ball.touched if called else 0):
        touch = state.touches[w, i]
        if touch.part < 0 or is_leaving(ball, touch):
            continue
        if index < 0 or surface_speed(touch) > surface_speed(state.touches[w, index]):
            index = i
    if index < 0:
        return
    touch = state.touches[w, index]
    vx0, vy0 = ball.vx, ball.vy
    # Without gravity there is no smallest rebound, but rounding, which had told it of the hit.
    rebound = max(touch.least, 2.0 * slow_speed(ball, touch))
    push_off(ball, touch, rebound)
    count_bounce(state, w, k, touch, vx0, vy0)
    _keep_off(state, w, k, index, rebound)


@function
def _keep_off(state: State, w: int, k: int, index: int, rebound: float) -> None:
    """After a `rebound` [m/s] from touched surface `index`: let the ball leave along what that closes on.

    If that is round, it leaves it, too, as far as it does not close on the first again: of a flight along a round one,
    pressed on it, no hit would be found.
    """
    ball = state.balls[w, k]
    other, closing = fastest_closing(ball, state.touches, w, 0.0)
    if other < 0:
        return
    first, touch, vx0, vy0 = state.touches[w, index], state.touches[w, other], ball.vx, ball.vy
    opposed = -(first.nx * touch.nx + first.ny * touch.ny)
    more = 0.0
    if touch.curvature != 0.0:
        left = rebound - closing * opposed  # how fast it then still leaves the first
        more = rebound if opposed <= 0.0 else min(max(0.5 * left / opposed, 0.0), rebound)
    push_off(ball, touch, closing + more)
    count_bounce(state, w, k, touch, vx0, vy0)
