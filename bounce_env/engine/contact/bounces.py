"""What happens at the instant of a hit: the ball is put on the surface, and all that it touches is bounced from.

Of several elements touched at once the one closed on fastest is bounced from first, ties by element order, until none
is closed on. So a corner is right from either side, and mirror images stay mirror images. What the ball does then
(whether it flies, slides or rests) is decided in `engine.contact.resolve`.
"""

from bounce_env.engine.compile.jit import Record, Table, function, routine, where
from bounce_env.engine.contact.restitution import (
    along_speed,
    bounce,
    capped,
    closing_speed,
    is_soft,
    normal_load,
    push_off,
    rolling_speed,
    slow_speed,
    surface_speed,
)
from bounce_env.engine.contact.squeeze import is_crushed, note_strike
from bounce_env.engine.memory.ledger import Surface, append_contact, count_hit
from bounce_env.engine.memory.records import BOUNCE, CRUSHED
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import before, later
from bounce_env.engine.tolerances import ALIGNED, BOUNCES_AT_ONE_INSTANT, CORNER, OPPOSED, ULPS_OF_SPEED


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
def bounce_from_all(state: State, w: int, k: int, ledger: Table) -> tuple[int, int, float, float]:
    """Bounce from everything that the ball touches and closes on, fastest first.

    Where bounces in a corner are taken to be over, what closes is taken from the velocity. Returns (single, corner, vx,
    vy): the touched surface that was bounced from if it was just one, without a kick; the one that led to the end of
    bounces in a corner; -1 where there is none; and the velocity [m/s] before the latter, which is not yet logged.
    """
    ball = state.balls[w, k]
    noise = ULPS_OF_SPEED * (abs(ball.vx) + abs(ball.vy))
    for _ in range(BOUNCES_AT_ONE_INSTANT):
        i, closing = fastest_closing(ball, state.touches, w, 0.0)
        if i < 0:
            return -1, -1, ball.vx, ball.vy
        if ball.touched > 1 and _is_bounce_damped(state, w, k, i, closing):
            break
        kicked = _bounce_from(state, w, k, i, closing, noise, ledger)
        if state.parts is not None and is_crushed(ball, state.touches[w, i], state.scenes[state.worlds[w].scene]):
            ball.status = CRUSHED
            return -1, -1, ball.vx, ball.vy
        if ball.touched == 1:
            return (-1 if kicked else i), -1, ball.vx, ball.vy
    i, _ = fastest_closing(ball, state.touches, w, 0.0)
    vx, vy = ball.vx, ball.vy
    if i >= 0 and not _project_bounces(ball, state.touches, w, i):
        ball.status, ball.vx, ball.vy = CRUSHED, vx, vy
    elif i >= 0:
        _keep_ahead(ball, state.touches, w)
    return -1, i, vx, vy


@routine
def bounce_off_fast(state: State, w: int, k: int, slowest: float, ledger: Table) -> None:
    """Bounce from what a ball touches and closes on faster than `slowest` [m/s], fastest first; it may get crushed."""
    ball = state.balls[w, k]
    for _ in range(BOUNCES_AT_ONE_INSTANT):
        i, closing = fastest_closing(ball, state.touches, w, slowest)
        if i < 0:
            return
        _bounce_from(state, w, k, i, closing, 0.0, ledger)
        if state.parts is not None and is_crushed(ball, state.touches[w, i], state.scenes[state.worlds[w].scene]):
            ball.status = CRUSHED
            return


@function
def _is_bounce_damped(state: State, w: int, k: int, i: int, closing: float) -> bool:
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
def _bounce_from(state: State, w: int, k: int, i: int, closing: float, noise: float, ledger: Table) -> bool:
    """Bounce from one touched surface; returns whether it gave a kick. A speed up to `noise` [m/s] left is none."""
    ball, world, touch = state.balls[w, k], state.worlds[w], state.touches[w, i]
    head, material = state.scenes[world.scene], state.elements[world.scene, touch.element]
    rebound, f = material.b * closing, material.f
    if touch.moves and closing <= touch.least:
        rebound, f = max(rebound, touch.least), (1.0 if head.rest_speed > 0.0 and f > 0.0 else f)
    elif state.gravity is not None or touch.curvature < 0.0:
        rebound, f = _softened_bounce(ball, touch, head, material, closing, rebound, f)
    kicked = material.kick > 0.0 and closing > material.kick_threshold
    if kicked and _is_kick_ready(state, w, k, touch.element, material.cooldown):
        rebound += material.kick
    else:
        kicked = False
    vx0, vy0 = ball.vx, ball.vy
    vx, vy = bounce(vx0, vy0, touch.nx, touch.ny, touch.ux, touch.uy, rebound, f)
    if abs(vx) + abs(vy) <= noise:
        # All that the bounces at this instant have left is rounding, and would go to and fro in a corner.
        vx, vy = 0.0, 0.0
    ball.vx, ball.vy, over = capped(vx, vy, touch.nx, touch.ny, touch.ux, touch.uy, head.max_speed)
    world.speed_capped += over
    count_bounce(state, w, k, touch, vx0, vy0, ledger)
    return kicked


@function
def _softened_bounce(
    ball: Record, touch: Record, head: Record, material: Record, closing: float, rebound: float, f: float
) -> tuple[float, float]:
    """Rebound [m/s] and friction where the ball is pressed on the surface: absorbed, or on a wall too little to see."""
    press = normal_load(ball, touch)
    if press == 0.0:
        return rebound, f
    pressed_by_gravity = ball.gx * touch.nx + ball.gy * touch.ny < 0.0
    if pressed_by_gravity and closing < head.rest_speed:
        return 0.0, (1.0 if f > 0.0 else 0.0)
    if touch.curvature == 0.0:
        # Hops that lose nothing have no end, and these show in no place of the ball: it slides.
        ends = material.b == 1.0 and is_soft(closing, press, head.extent)
        return (0.0 if ends else rebound), f
    if touch.part >= 0:
        return _rolling_bounce(ball, touch, head, material, press, closing, rebound, f)
    return rebound, f


@function
def _rolling_bounce(
    ball: Record, touch: Record, head: Record, material: Record, press: float, closing: float, rebound: float, f: float
) -> tuple[float, float]:
    """Rebound [m/s] and friction on the round end of a part, on which the ball rolls in small hops."""
    smallest = rolling_speed(ball, touch, press, head.extent)
    if closing <= 1.5 * smallest and head.rest_speed > 0.0:
        return 0.0, (1.0 if f > 0.0 else 0.0)
    holds = f == 0.0 or (f < 1.0 and head.rest_speed == 0.0)
    if material.b >= 1.0 or rebound >= smallest or (rebound == 0.0 and holds):
        return rebound, f
    if is_soft(closing, press, head.extent):
        return 0.0, f
    if material.b < 1.0 and abs(along_speed(ball, touch)) <= 2.0 * smallest:
        # Slow on the curve: let the bounces die away, so that a ball between several surfaces comes to touch them.
        smallest = min(smallest, 0.5 * closing)
    return max(rebound, smallest), f


@where("cooling", otherwise=True)
def _is_kick_ready(state: State, w: int, k: int, element: int, cooldown: float) -> bool:
    """Return whether an element gives a kick now; if so it begins to cool down."""
    ball, cool = state.balls[w, k], state.cooling[w, element]
    if before(ball.hi, ball.lo, cool.hi, cool.lo):
        return False
    if cooldown > 0.0:
        cool.hi, cool.lo = later(ball.hi, ball.lo, cooldown)
    return True


@function
def _project_bounces(ball: Record, touches: Table, w: int, first: int) -> bool:
    """Take from the velocity what closes on any touched surface: along one of them where the others allow, else all.

    The one closed on fastest (`first`) is tried first. Returns False where a part closes on the ball and nothing lets
    it get away.
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
            if _bounce_out_of_squeeze(ball, touches[w, i], touches[w, j]) and _is_bounce_allowed(
                ball, touches, w, vx, vy
            ):
                return True
    note_strike(ball, touches[w, striker])
    return False


@function
def _keep_ahead(ball: Record, touches: Table, w: int) -> None:
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
def _bounce_out_of_squeeze(ball: Record, one: Record, other: Record) -> bool:
    """Let the ball keep just ahead of two surfaces, along both; False where they oppose each other too much for it."""
    turn = one.nx * other.ny - one.ny * other.nx
    if one.nx * other.nx + one.ny * other.ny < -OPPOSED or abs(turn) <= ALIGNED:
        return False
    a, b = surface_speed(one), surface_speed(other)
    ball.vx, ball.vy = (a * other.ny - b * one.ny) / turn, (b * one.nx - a * other.nx) / turn
    return True


@function
def count_bounce(state: State, w: int, k: int, touch: Record, vx0: float, vy0: float, ledger: Table) -> None:
    """Count a bounce from a touched surface, and log it."""
    state.worlds[w].bounces += 1
    count_hit(state, w, touch.element)
    append_contact(ledger, state.worlds[w], state.balls[w, k], k, BOUNCE, surface_of(touch), vx0, vy0)


@function
def surface_of(touch: Record) -> Surface:
    """Return what the ledger tells of a touched surface."""
    return Surface(touch.element, touch.nx, touch.ny, touch.ux, touch.uy)
