"""A ball between a closing part and what opposes it: when it is caught there, and when that has crushed it."""

from bounce_env.engine.compile.jit import Record, function
from bounce_env.engine.contact.restitution import surface_speed
from bounce_env.engine.tolerances import CLEARANCE, OPPOSED, SQUEEZES


@function
def is_crushed(ball: Record, touch: Record, head: Record) -> bool:
    """Take note of a bounce, and say whether the ball is caught between a closing part and what opposes it.

    It is when, not having come further than a clearance from where the part first struck it, it has gone to and fro so
    often, and is struck again.
    """
    strikes = touch.part >= 0 and surface_speed(touch) > 0.0
    if take_opposed(ball, head, touch.nx, touch.ny):
        return False
    caught = is_caught(ball, head)
    if caught and strikes and touch.part == ball.struck:
        ball.snx, ball.sny, ball.sux, ball.suy = touch.nx, touch.ny, touch.ux, touch.uy
        return ball.squeezes >= SQUEEZES
    if strikes:
        note_strike(ball, touch)
    elif not caught:
        ball.struck = -1
    return False


@function
def is_caught(ball: Record, head: Record) -> bool:
    """Whether the ball has not come further than a clearance from where a closing part struck it."""
    clearance = CLEARANCE * head.extent
    dx, dy = ball.x - ball.sx, ball.y - ball.sy
    return ball.struck >= 0 and dx * dx + dy * dy <= clearance * clearance


@function
def take_opposed(ball: Record, head: Record, nx: float, ny: float) -> bool:
    """Take note of a bounce with this normal where it throws the ball back on the part that has it caught."""
    opposed = is_caught(ball, head) and nx * ball.snx + ny * ball.sny < -OPPOSED
    if opposed:
        ball.squeezes += 1
    return opposed


@function
def is_to_be_crushed(ball: Record) -> bool:
    """Return whether the next strike of the part that has the ball caught crushes it."""
    return ball.struck >= 0 and ball.squeezes >= SQUEEZES


@function
def doom(ball: Record, touch: Record) -> None:
    """Let the next strike of a part crush a ball that nothing lets get away."""
    note_strike(ball, touch)
    ball.squeezes = SQUEEZES


@function
def note_strike(ball: Record, touch: Record) -> None:
    ball.struck, ball.squeezes, ball.sx, ball.sy = touch.part, 0, ball.x, ball.y
    ball.snx, ball.sny, ball.sux, ball.suy = touch.nx, touch.ny, touch.ux, touch.uy
