"""A hit of one surface: the bounce law, what gravity and a kick make of it, and its row in the ledger."""

from bounce_env.engine.compile.jit import Record, function, where
from bounce_env.engine.contact.restitution import (
    bounce,
    capped,
    is_soft,
    is_standing,
    normal_load,
)
from bounce_env.engine.memory.ledger import Surface, append_contact, count_hit
from bounce_env.engine.memory.records import BOUNCE, CORNER_BOUNCE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import before, later
from bounce_env.engine.tolerances import WEIGHTLESS


@function
def bounce_off(state: State, w: int, k: int, i: int, closing: float, noise: float) -> bool:
    """Bounce from one touched surface; returns whether it gave a kick. A speed up to `noise` [m/s] left is none."""
    ball, world, touch = state.balls[w, k], state.worlds[w], state.touches[w, i]
    head, material = state.scenes[world.scene], state.elements[world.scene, touch.element]
    rebound, f = rebound_from(state, w, k, i, closing)
    keeps_speed = touch.curvature != 0.0 and is_standing(touch) and rebound == closing and f == 1.0
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
    elif keeps_speed and not kicked:
        vx, vy = _with_speed_of(vx, vy, vx0, vy0)
    ball.vx, ball.vy, over = capped(vx, vy, touch.nx, touch.ny, touch.ux, touch.uy, head.max_speed)
    world.speed_capped += over
    count_bounce(state, w, k, touch, vx0, vy0)
    return kicked


@function
def _with_speed_of(vx: float, vy: float, vx0: float, vy0: float) -> tuple[float, float]:
    """Return the velocity (vx, vy) [m/s] with the magnitude of (vx0, vy0), from which rounding makes it differ.

    Each time a ball comes to the same point of a curve the rounding of its normal is the same, and would add up. One
    step of Newton for the root of the squares' ratio.
    """
    square = vx * vx + vy * vy
    if square < WEIGHTLESS:
        return vx, vy  # it may have lost digits
    change = 0.5 * ((vx0 - vx) * (vx0 + vx) + (vy0 - vy) * (vy0 + vy)) / square
    return vx + change * vx, vy + change * vy


@function
def rebound_from(state: State, w: int, k: int, i: int, closing: float) -> tuple[float, float]:
    """Return how fast [m/s] a ball rebounds from touched surface `i`, without a kick, and the friction factor."""
    ball, scene, touch = state.balls[w, k], state.worlds[w].scene, state.touches[w, i]
    head, material = state.scenes[scene], state.elements[scene, touch.element]
    rebound, f = material.b * closing, material.f
    if touch.moves and closing <= touch.least:
        rebound, f = max(rebound, touch.least), (1.0 if head.rest_speed > 0.0 and f > 0.0 else f)
    elif state.gravity is not None or touch.curvature < 0.0:
        rebound, f = _softened_bounce(ball, touch, head, material, closing, rebound, f)
    return rebound, f


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
    # Hops that lose nothing have no end, and these show in no place of the ball: it slides.
    ends = touch.curvature == 0.0 and material.b == 1.0 and is_soft(closing, press, head.extent)
    return (0.0 if ends else rebound), f


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
def count_bounce(state: State, w: int, k: int, touch: Record, vx0: float, vy0: float) -> None:
    """Count a bounce from a touched surface, and log it."""
    _count_as(state, w, k, touch, BOUNCE, vx0, vy0)


@function
def count_corner(state: State, w: int, k: int, touch: Record, vx0: float, vy0: float) -> None:
    """Count a touched surface's share in a bounce from several at once, and log it."""
    _count_as(state, w, k, touch, CORNER_BOUNCE, vx0, vy0)


@function
def _count_as(state: State, w: int, k: int, touch: Record, kind: int, vx0: float, vy0: float) -> None:
    state.worlds[w].bounces += 1
    count_hit(state, w, touch.element)
    append_contact(state, w, k, kind, surface_of(touch), vx0, vy0)


@function
def surface_of(touch: Record) -> Surface:
    """Return what the ledger tells of a touched surface."""
    return Surface(touch.element, touch.nx, touch.ny, touch.ux, touch.uy)
