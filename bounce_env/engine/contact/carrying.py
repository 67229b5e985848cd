"""A ball that a part which translates pushes along a wall: between two straight surfaces it moves uniformly."""

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.contact.restitution import (
    ahead_of_both,
    along_speed,
    closing_speed,
    is_standing,
    slow_speed,
    surface_speed,
)
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import ALIGNED, PRESSING


@where("parts", otherwise=False)
def carry(state: State, w: int, k: int, i: int, holds: bool) -> bool:
    """Let a part push the ball along touched surface `i`, a wall that it is pressed on, if it does; return whether.

    holds: whether the wall stops the ball by friction, which takes all of its speed but for what the part gives it.
    """
    ball, wall = state.balls[w, k], state.touches[w, i]
    for j in range(ball.touched if wall.face >= 0 else 0):
        part = state.touches[w, j]
        turn = wall.nx * part.ny - wall.ny * part.nx
        if part.part < 0 or part.moves or is_standing(part) or abs(turn) <= ALIGNED:
            continue
        if not (_pushes_on(state, w, part) if holds else _presses_on(ball, wall, part, turn)):
            continue
        vx, vy = ball.vx, ball.vy
        ball.vx, ball.vy = ahead_of_both(wall, part, turn)
        if _stays_between(ball, state.touches, w, i, j):
            ball.contact, ball.rides, ball.support, ball.ax, ball.ay = wall.face, part.part, wall.element, 0.0, 0.0
            return True
        ball.vx, ball.vy = vx, vy
    return False


@function
def _pushes_on(state: State, w: int, part: Record) -> bool:
    """Return whether a part comes towards a ball that is held, without a kick."""
    return surface_speed(part) > 0.0 and state.elements[state.worlds[w].scene, part.element].kick == 0.0


@function
def _presses_on(ball: Record, wall: Record, part: Record, turn: float) -> bool:
    """Return whether a ball moves along both, and gravity does not take it off the part."""
    pull = (ball.gx * wall.ny - ball.gy * wall.nx) / turn  # what the part has to take of gravity
    level = PRESSING * (abs(ball.gx) + abs(ball.gy)) / abs(turn)
    return abs(closing_speed(ball, part)) <= slow_speed(ball, part) and pull >= -level


@function
def _stays_between(ball: Record, touches: Table, w: int, i: int, j: int) -> bool:
    """Return whether a ball that moves uniformly along two surfaces goes on along them, and closes on no other.

    Along the round end of a part it does where it stays at one point of it.
    """
    part = touches[w, j]
    bends = part.curvature != 0.0 and abs(along_speed(ball, part)) > slow_speed(ball, part)
    if bends or runs_off_end(ball, touches[w, i]) or (part.curvature == 0.0 and runs_off_end(ball, part)):
        return False
    for n in range(ball.touched):
        if n not in (i, j) and closing_speed(ball, touches[w, n]) > slow_speed(ball, touches[w, n]):
            return False
    return True


@function
def runs_off_end(ball: Record, touch: Record) -> bool:
    """Return whether a ball at the end of a surface moves off it."""
    if touch.along < touch.length - ball.tolerance and touch.along > ball.tolerance:
        return False
    rate, pull = -along_speed(ball, touch), ball.gx * touch.ny - ball.gy * touch.nx
    lean = rate if abs(rate) > slow_speed(ball, touch) else 0.0
    if lean == 0.0 and abs(pull) > PRESSING * (abs(ball.gx) + abs(ball.gy)):
        lean = pull
    return (touch.along >= touch.length - ball.tolerance and lean > 0.0) or (
        touch.along <= ball.tolerance and lean < 0.0
    )
