"""What bears a ball after its bounces at one instant: a surface on which it rests, or slides.

A contact is a constraint, not a series of tiny bounces. On a wall, and on a part in its frame, the ball slides in
closed form under the tangential part of its acceleration; on curves it may rest.
"""

import math

from bounce_env.engine.compile.jit import Record, Table, function
from bounce_env.engine.contact.restitution import along_speed, closing_speed, is_standing, normal_load, slow_speed
from bounce_env.engine.memory.records import HELD, RIDING
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import ALIGNED, BALANCE, CORNER, PRESSING, SWING, ULPS_OF_LENGTH, ULPS_OF_SPEED


@function
def is_slow(ball: Record, extent: float) -> bool:
    """Whether the ball could not rise above the tolerance of corners."""
    pull = math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
    return ball.vx * ball.vx + ball.vy * ball.vy <= 2.0 * pull * (CORNER * ULPS_OF_LENGTH * extent)


@function
def find_contact(state: State, w: int, k: int) -> int:
    """Hold the ball, or let it slide on a wall, where it is pressed on what it touches; -1 where it flies.

    Returns which touched surface supports it.
    """
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    for i in range(ball.touched):
        touch = state.touches[w, i]
        if touch.moves or closing_speed(ball, touch) < -slow_speed(ball, touch) or normal_load(ball, touch) == 0.0:
            continue
        if not _lets_hold(ball, state.touches, w, i):
            continue
        f = state.elements[scene, touch.element].f
        if f == 0.0 or (f < 1.0 and head.rest_speed == 0.0):
            return _hold(ball, touch, i)
        if _swings_out(ball, touch, head.rest_speed):
            return _hold(ball, touch, i)
    if ball.gx == 0.0 and ball.gy == 0.0:
        return -1
    if is_slow(ball, head.extent):
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
    if touch.curvature == 0.0 or ball.gx * touch.nx + ball.gy * touch.ny >= 0.0:
        return False
    along, across = along_speed(ball, touch), ball.gx * touch.ny - ball.gy * touch.nx
    pull = math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
    speed = math.sqrt(along * along + across * across / (abs(touch.curvature) * pull))
    natural = math.sqrt(pull / abs(touch.curvature))
    return speed <= (max(rest_speed, SWING * natural) if touch.curvature < 0.0 else BALANCE * natural)


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
    return level and beneath and is_standing(touch) and closing_speed(ball, touch) >= -slow_speed(ball, touch)


@function
def _shares(ball: Record, one: Record, other: Record) -> tuple[float, float]:
    """The forces (per mass, m/s^2) along two normals that together hold the ball; negative where there are none."""
    turn = one.nx * other.ny - one.ny * other.nx
    if not is_standing(one) or not is_standing(other) or abs(turn) <= ALIGNED:
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
    if touch.curvature != 0.0 or touch.moves or closing_speed(ball, touch) < -slow or not pressed:
        return False
    ux, uy = touch.ny, -touch.nx
    rate = (ball.vx - touch.ux) * ux + (ball.vy - touch.uy) * uy
    pull = ball.gx * ux + ball.gy * uy
    noise = PRESSING * (abs(ball.gx) + abs(ball.gy))
    lean = rate if abs(rate) > slow else (pull if abs(pull) > noise else 0.0)
    if (touch.along >= touch.length - ball.tolerance and lean > 0.0) or (touch.along <= ball.tolerance and lean < 0.0):
        return False
    ax, ay = pull * ux, pull * uy
    for j in range(ball.touched):
        other = touches[w, j]
        if closing_speed(ball, other) >= -slow_speed(ball, other) and ax * other.nx + ay * other.ny < -noise:
            return False
    bear(ball, touch)
    ball.vx, ball.vy, ball.ax, ball.ay = touch.ux + rate * ux, touch.uy + rate * uy, ax, ay
    if abs(ball.vx) + abs(ball.vy) <= slow:
        ball.vx, ball.vy = 0.0, 0.0  # it stands while the part slides by: the rest is rounding
    return True


@function
def bear(ball: Record, touch: Record) -> None:
    """Let a ball be in contact with what it touches: with a straight side of it that it slides along."""
    ball.contact = touch.face if touch.part < 0 else RIDING
    ball.rides, ball.support = touch.part, touch.element
