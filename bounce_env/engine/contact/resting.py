"""What bears a ball after its bounces at one instant: a surface on which it rests, or slides.

A contact is a constraint, not a series of tiny bounces. On a wall, and on a part in its frame, the ball slides in
closed form under the tangential part of its acceleration; on a circle or arc, in its frame, like a pendulum.
"""

import math

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.contact.carrying import carry, runs_off_end
from bounce_env.engine.contact.restitution import (
    along_speed,
    forces_on_both,
    gap_trend,
    is_holding,
    is_leaving,
    is_sliding_curve,
    is_standing,
    load_noise,
    normal_load,
    slow_speed,
)
from bounce_env.engine.memory.records import HELD, ON_CURVE, RIDING
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.curve_slide import new_curve_slide
from bounce_env.engine.tolerances import ALIGNED, CORNER, PRESSING, ULPS_OF_LENGTH, ULPS_OF_SPEED


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
    i = carry(state, w, k)
    if i >= 0:
        return i
    for i in range(ball.touched):
        touch = state.touches[w, i]
        if touch.moves or is_leaving(ball, touch) or not _is_pressed(ball, touch):
            continue
        if not _lets_hold(ball, state.touches, w, i):
            continue
        if is_holding(state.elements[scene, touch.element].f, head.rest_speed):
            return _stop_by_friction(ball, touch, i)
        if _is_balanced_on_curve(ball, touch):
            return _hold(ball, touch, i)
    if (ball.gx != 0.0 or ball.gy != 0.0) and is_slow(ball, head.extent):
        i = _carrier(ball, state.touches, w)
        if i >= 0:
            return _hold(ball, state.touches[w, i], i)
    for i in range(ball.touched):
        if _slides_on(state, w, k, i):
            return i
    return -1


@function
def _is_pressed(ball: Record, touch: Record) -> bool:
    """Return whether a touched surface, that the ball does not leave, is to hold it back."""
    return gap_trend(ball, touch) < 0 if is_sliding_curve(touch) else normal_load(ball, touch) > 0.0


@function
def _stop_by_friction(ball: Record, touch: Record, i: int) -> int:
    """Hold a ball that friction stops on a surface, or let it fly where that lets go of it; return which.

    Under a ceiling that curves only its speed presses a ball: friction takes of that what it can, or all where the
    ball moves on to where it would be pressed again.
    """
    off = ball.gx * touch.nx + ball.gy * touch.ny
    if not (is_sliding_curve(touch) and off > load_noise(ball, touch)):
        return _hold(ball, touch, i)
    speed = math.copysign(math.sqrt(off / -touch.curvature), along_speed(ball, touch))
    ball.vx, ball.vy = touch.ux - speed * touch.ny, touch.uy + speed * touch.nx
    if gap_trend(ball, touch) < 0:
        ball.vx, ball.vy = touch.ux, touch.uy
    return i


@function
def _is_balanced_on_curve(ball: Record, touch: Record) -> bool:
    """Return whether a ball is at rest in the lowest point of a hollow, or on the highest of a curve.

    As far as it swings to and fro, or is off that point, by no more than the tolerance of lengths.
    """
    pull = math.sqrt(ball.gx * ball.gx + ball.gy * ball.gy)
    if not is_sliding_curve(touch) or pull == 0.0:
        return False
    along, across = along_speed(ball, touch), ball.gx * touch.ny - ball.gy * touch.nx
    way = across / pull * touch.radius
    return along * along * touch.radius / pull + way * way <= ball.tolerance * ball.tolerance


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
        if not is_sliding_curve(touches[w, i]) and _carries_alone(ball, touches[w, i]):
            return i
    for i in range(ball.touched):
        for j in range(i):
            of_one, of_other = _shares(ball, touches[w, i], touches[w, j])
            if of_one >= 0.0 and of_other >= 0.0:
                return i if of_one > of_other else j
    return -1


@function
def _carries_alone(ball: Record, touch: Record) -> bool:
    """Whether a surface is level beneath a ball that moves neither away nor along: its bounces are summed instead."""
    level = abs(ball.gx * touch.ny - ball.gy * touch.nx) <= ALIGNED * (abs(ball.gx) + abs(ball.gy))
    beneath = ball.gx * touch.nx + ball.gy * touch.ny < 0.0
    stays = not is_leaving(ball, touch) and along_speed(ball, touch) == 0.0
    return level and beneath and is_standing(touch) and stays


@function
def _shares(ball: Record, one: Record, other: Record) -> tuple[float, float]:
    """The forces (per mass, m/s^2) along two normals that together hold the ball; negative where there are none."""
    turn = one.nx * other.ny - one.ny * other.nx
    if not is_standing(one) or not is_standing(other) or abs(turn) <= ALIGNED:
        return -1.0, -1.0
    noise = ALIGNED * (abs(ball.gx) + abs(ball.gy))
    of_one, of_other = forces_on_both(ball, one, other, turn)
    return of_one + noise, of_other + noise


@function
def _slides_on(state: State, w: int, k: int, i: int) -> bool:
    """Let the ball slide along what it touches, if that presses it and the ball stays beside it.

    On a part that slides itself it does so in the part's frame.
    """
    ball, touch = state.balls[w, k], state.touches[w, i]
    slow, curved = slow_speed(ball, touch), is_sliding_curve(touch)
    if touch.moves or is_leaving(ball, touch):
        return False
    # However little a wall presses it: what is not constrained would sink in by and by.
    if not (gap_trend(ball, touch) < 0 if curved else ball.gx * touch.nx + ball.gy * touch.ny < 0.0):
        return False
    ux, uy = touch.ny, -touch.nx
    rate = (ball.vx - touch.ux) * ux + (ball.vy - touch.uy) * uy
    pull = ball.gx * ux + ball.gy * uy
    if runs_off_end(ball, touch):
        return False
    turn = touch.curvature * rate * rate
    ax, ay = pull * ux - turn * touch.nx, pull * uy - turn * touch.ny
    for j in range(ball.touched):
        if j != i and not _opens_beside(ball, touch, state.touches[w, j], ax, ay):
            return False
    bear(ball, touch)
    ball.vx, ball.vy, ball.ax, ball.ay = touch.ux + rate * ux, touch.uy + rate * uy, ax, ay
    if curved:
        begin_curve_slide(state, w, k, touch, -rate)
    elif abs(ball.vx) + abs(ball.vy) <= slow:
        ball.vx, ball.vy = 0.0, 0.0  # it stands while the part slides by: the rest is rounding
    return True


@function
def _opens_beside(ball: Record, touch: Record, other: Record, ax: float, ay: float) -> bool:
    """Return whether the gap to another surface does not close while the ball slides, at (ax, ay), on one."""
    if is_leaving(ball, other) or runs_off_end(ball, other):
        return True
    along = along_speed(ball, other)
    noise = PRESSING * (abs(ball.gx) + abs(ball.gy)) + load_noise(ball, touch) + load_noise(ball, other)
    return ax * other.nx + ay * other.ny + other.curvature * along * along >= -noise


@where("curve_slides", inline=False)
def begin_curve_slide(state: State, w: int, k: int, touch: Record, speed: float) -> None:
    """Let a ball slide on a curve that it touches at `speed` [m/s] along it, counter-clockwise about it positive.

    Relative to the curve, which stands or translates.
    """
    ball, slide = state.balls[w, k], state.curve_slides[w, k]
    facing = 1.0 if touch.curvature > 0.0 else -1.0
    nx, ny = facing * touch.nx, facing * touch.ny
    ball.x, ball.y = touch.cx + touch.radius * nx, touch.cy + touch.radius * ny
    motion = new_curve_slide(
        touch.cx, touch.cy, touch.radius, nx, ny, facing * speed, ball.gx, ball.gy, touch.ux, touch.uy
    )
    slide.x, slide.y, slide.radius, slide.down_x, slide.down_y = (
        touch.cx,
        touch.cy,
        touch.radius,
        motion.down_x,
        motion.down_y,
    )
    slide.sense, slide.swings, slide.complement = motion.sense, int(motion.swings), motion.complement
    slide.lowest_speed = motion.lowest_speed
    slide.rate, slide.phase, slide.ux, slide.uy = motion.rate, motion.phase, motion.ux, motion.uy
    slide.facing, slide.arc = facing, touch.arc


@function
def bear(ball: Record, touch: Record) -> None:
    """Let a ball be in contact with what it touches: with a straight side or a curve that it slides along."""
    if touch.curvature != 0.0:
        ball.contact = ON_CURVE
    elif touch.part >= 0:
        ball.contact = RIDING
    else:
        ball.contact = touch.face
    ball.rides, ball.support = touch.part, touch.element
