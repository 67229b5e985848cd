"""A ball that a part which translates pushes along what stands (docs/physics.md, "Pushed along").

It moves as both ask for: between two straight surfaces uniformly, between a straight and a round one as
`motion.carried` tells.
"""

import math

from bounce_env.engine.compile.jit import Record, Table, function, routine, where
from bounce_env.engine.contact.restitution import (
    ahead_of_both,
    along_speed,
    closing_speed,
    forces_on_both,
    is_holding,
    is_standing,
    slow_speed,
    surface_speed,
)
from bounce_env.engine.memory.records import CARRIED_ALONG
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.carried import (
    Carried,
    carried_acceleration,
    carried_direction,
    carried_of,
    carried_top_speed,
)
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.parts import moving_part, part_core_at, part_stop_instant
from bounce_env.engine.tolerances import ALIGNED, BRACKETING_STEPS, PRESSING

# Pieces in which the end of what presses a ball is looked for.
PIECES = 64


@where("parts", otherwise=-1)
def carry(state: State, w: int, k: int) -> int:
    """Let a part push the ball along a touched surface that stands, if it does; return which, -1 for none."""
    ball, found = state.balls[w, k], -1
    for i in range(ball.touched if ball.touched > 1 else 0):
        for j in range(ball.touched):
            if found < 0 and _is_carried_between(state, w, k, i, j):
                found = i
    return found


@routine
def _is_carried_between(state: State, w: int, k: int, i: int, j: int) -> bool:
    """Let part `j` push the ball along surface `i`, which stands, if it does.

    Where the surface stops the ball by friction, that takes all of its speed but for what the part gives it.
    """
    ball, touches = state.balls[w, k], state.touches
    wall, part = touches[w, i], touches[w, j]
    turn = wall.nx * part.ny - wall.ny * part.nx
    if part.part < 0 or part.moves or is_standing(part) or abs(turn) <= ALIGNED:
        return False
    if wall.part >= 0 or (wall.curvature != 0.0 and part.curvature != 0.0):
        return False
    holds = _stops(state, w, ball, wall)
    slow = slow_speed(ball, wall) + slow_speed(ball, part)
    if abs(closing_speed(ball, wall)) > slow or not (holds or abs(closing_speed(ball, part)) <= slow):
        return False
    if holds and state.elements[state.worlds[w].scene, part.element].kick > 0.0:
        return False
    vx, vy = ball.vx, ball.vy
    ball.vx, ball.vy = ahead_of_both(wall, part, turn)
    straight = (wall.curvature == 0.0 or _stays_on(ball, wall)) and (part.curvature == 0.0 or _stays_on(ball, part))
    if _closes_on_no_other(ball, touches, w, i, j):
        if straight and wall.face >= 0 and _is_pressed_on_both(ball, wall, part, turn, holds):
            ball.contact, ball.rides, ball.support, ball.ax, ball.ay = wall.face, part.part, wall.element, 0.0, 0.0
            return True
        if not straight and _begins(state, w, k, i, j, 0.0 if holds else _press_noise(ball, turn), holds):
            return True
    ball.vx, ball.vy = vx, vy
    return False


@function
def _stops(state: State, w: int, ball: Record, wall: Record) -> bool:
    """Return whether friction of a surface that stands stops the ball, which gravity presses on it."""
    scene = state.worlds[w].scene
    pressed = ball.gx * wall.nx + ball.gy * wall.ny < -PRESSING * (abs(ball.gx) + abs(ball.gy))
    return pressed and is_holding(state.elements[scene, wall.element].f, state.scenes[scene].rest_speed)


@function
def _stays_on(ball: Record, touch: Record) -> bool:
    """Return whether a ball that touches something round stays at one point of it."""
    return abs(along_speed(ball, touch)) <= slow_speed(ball, touch)


@function
def _is_pressed_on_both(ball: Record, wall: Record, part: Record, turn: float, holds: bool) -> bool:
    """Return whether it takes two straight surfaces to keep a ball in uniform motion: neither pulls.

    Where friction stops the ball, the part must come towards it.
    """
    if holds:
        return surface_speed(part) > 0.0
    return min(forces_on_both(ball, wall, part, turn)) >= -_press_noise(ball, turn)


@function
def _press_noise(ball: Record, turn: float) -> float:
    """Return what of the forces (per mass, m/s^2) along two normals is rounding; turn: the sine between these."""
    return PRESSING * (abs(ball.gx) + abs(ball.gy)) / abs(turn)


@function
def _closes_on_no_other(ball: Record, touches: Table, w: int, i: int, j: int) -> bool:
    """Return whether a ball that moves along two surfaces goes on along them, and closes on no other."""
    for n in range(ball.touched):
        touch = touches[w, n]
        if n in (i, j):
            if runs_off_end(ball, touch):
                return False
        elif closing_speed(ball, touch) > slow_speed(ball, touch):
            return False
    return True


@where("carried", otherwise=False, inline=False)
def _begins(state: State, w: int, k: int, i: int, j: int, noise: float, holds: bool) -> bool:
    """Note how a ball moves between surface `i`, which stands, and part `j`; return whether it comes any way so.

    One of the two is straight, the other round. noise: of what presses it [m/s^2].
    """
    ball, carried = state.balls[w, k], state.carried[w, k]
    curve, straight = state.touches[w, i], state.touches[w, j]
    if curve.curvature == 0.0:
        curve, straight = straight, curve
    facing = 1.0 if curve.curvature > 0.0 else -1.0
    ex, ey = facing * curve.nx, facing * curve.ny
    carried.x, carried.y, carried.radius = curve.cx, curve.cy, curve.radius
    carried.ux, carried.uy, carried.sx, carried.sy = curve.ux, curve.uy, straight.ux, straight.uy
    carried.mx, carried.my = straight.nx, straight.ny
    carried.share = ex * straight.nx + ey * straight.ny
    carried.turn = 1.0 if straight.nx * ey > straight.ny * ex else -1.0
    approach = (curve.ux - straight.ux) * straight.nx + (curve.uy - straight.uy) * straight.ny
    carried.rate, carried.least = -approach / curve.radius, 1.0
    carried.face, carried.arc = straight.face, curve.arc
    if not _press(ball, state, w, k, facing, curve.part >= 0, holds, 0.0) > noise:
        return False
    carried.end, surely = _first_end(state, w, k, state.touches[w, j].part, facing, curve.part >= 0, holds)
    motion = carried_of(carried)
    carried.least = min(abs(carried_direction(motion, 0.0)[1]), abs(carried_direction(motion, surely)[1]))
    if carried_top_speed(motion) * carried.end <= ball.tolerance:
        return False
    ball.contact, ball.rides, ball.support = CARRIED_ALONG, state.touches[w, j].part, state.touches[w, i].element
    ball.ax, ball.ay = carried_acceleration(motion, carried_direction(motion, 0.0)[1])
    return True


@function
def _first_end(state: State, w: int, k: int, m: int, facing: float, moves: bool, holds: bool) -> tuple[float, float]:
    """Return after how long [s] part `m` carries a ball no further, and up to when it surely does.

    What presses it ends, or what is round does. The first is inf where before that the part stops, which ends it, too.
    facing: 1.0 outside of the circle, -1.0 inside; moves: whether the circle does, or the straight surface.
    """
    ball, carried = state.balls[w, k], carried_of(state.carried[w, k])
    part = moving_part(state, w, m)
    stop_hi, stop_lo = part_stop_instant(part.motion, part.shape)
    stop = max(since(stop_hi, stop_lo, ball.hi, ball.lo), 0.0)
    joint = _time_to_joints(state, w, k, m if moves else -1, carried)
    whole = min(stop, joint, (math.copysign(1.0, carried.rate) - carried.share) / carried.rate)
    low, high = 0.0, whole
    for n in range(1, PIECES + 1):
        high = whole * (n / PIECES)
        if not _press(ball, state, w, k, facing, moves, holds, high) > 0.0:
            break
        low = high
    if low == whole:
        return (joint if joint <= whole else math.inf), whole
    for _ in range(BRACKETING_STEPS):
        t = 0.5 * (low + high)
        if not low < t < high:
            break
        if _press(ball, state, w, k, facing, moves, holds, t) > 0.0:
            low = t
        else:
            high = t
    return low, low


@routine
def _press(ball: Record, state: State, w: int, k: int, facing: float, moves: bool, holds: bool, t: float) -> float:
    """Return what is > 0 as long as both surfaces press the ball `t` seconds on."""
    row, carried = state.carried[w, k], carried_of(state.carried[w, k])
    share, across = carried_direction(carried, t)
    ex, ey = share * carried.mx - across * carried.my, share * carried.my + across * carried.mx
    if across == 0.0:
        return -1.0
    if holds:
        if moves:
            towards = facing * (ex * carried.ux + ey * carried.uy)
            return min(towards, -(ball.gx * carried.mx + ball.gy * carried.my))
        speed = carried.rate / across
        held = -facing * (ball.gx * ex + ball.gy * ey + carried.radius * speed * speed)
        return min(row.sx * carried.mx + row.sy * carried.my, held)
    ax, ay = carried_acceleration(carried, across)
    ax, ay = ax - ball.gx, ay - ball.gy
    of_curve = (ay * carried.mx - ax * carried.my) / (facing * across)
    return min(of_curve, ax * carried.mx + ay * carried.my - of_curve * facing * share)


@function
def _time_to_joints(state: State, w: int, k: int, m: int, carried: Carried) -> float:
    """Return after how long [s] a ball comes to where the round end of part `m`, or an arc, ends; inf: it does not."""
    if m >= 0:
        core = part_core_at(moving_part(state, w, m), state.balls[w, k].hi, state.balls[w, k].lo)
        if core.back == core.front:
            return math.inf
        one = _time_to_direction(carried, -core.uy, core.ux)
        return min(one, _time_to_direction(carried, core.uy, -core.ux))
    return _time_to_arc_ends(state, w, k, carried)


@where("arcs", otherwise=math.inf)
def _time_to_arc_ends(state: State, w: int, k: int, carried: Carried) -> float:
    if state.carried[w, k].arc < 0:
        return math.inf
    arc = state.arcs[state.worlds[w].scene, state.carried[w, k].arc]
    return min(_time_to_direction(carried, arc.sx, arc.sy), _time_to_direction(carried, arc.ex, arc.ey))


@function
def _time_to_direction(carried: Carried, x: float, y: float) -> float:
    """Return after how long [s] e points in the direction (x, y), or inf; where it does so now is behind it."""
    t = (x * carried.mx + y * carried.my - carried.share) / carried.rate
    ahead = carried.turn * (carried.mx * y - carried.my * x) > 0.0 and t * abs(carried.rate) > ALIGNED
    return t if ahead else math.inf


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
