"""What begins a new flight of a ball from outside of it: it is placed, pushed, or slowed down by drag."""

from bounce_env.engine.compile.jit import Table, function, routine
from bounce_env.engine.contact.arrival import end_flight
from bounce_env.engine.contact.sides import arrive, face_crossings
from bounce_env.engine.contact.start_sides import take_sides
from bounce_env.engine.detect.pairs import plan_pairs
from bounce_env.engine.detect.schedule import resolve_next
from bounce_env.engine.memory.lookup import pull
from bounce_env.engine.memory.records import CRUSHED, FLYING, OK, OUT, RESOLVE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.fields import accelerate
from bounce_env.engine.motion.flight import touch_tolerance
from bounce_env.engine.motion.instant import since


@routine
def place(state: State, w: int, k: int, x: float, y: float, vx: float, vy: float) -> None:
    """Put ball `k` into flight at (x, y) [m] with velocity (vx, vy) [m/s] at the world's present time."""
    ball, world = state.balls[w, k], state.worlds[w]
    head = state.scenes[world.scene]
    ball.x, ball.y, ball.vx, ball.vy = x, y, vx, vy
    ball.hi, ball.lo = world.time_hi, world.time_lo
    ball.status = OK
    ball.contact, ball.rides, ball.support, ball.settling, ball.rolling = FLYING, -1, -1, 0, -1
    ball.struck, ball.squeezes, ball.vague = -1, 0, 0.0
    ball.confined, ball.strayed, ball.legs = 0, 0.0, 0
    ball.slack = touch_tolerance(head.extent, 0.0, 0.0, None, None, 0.0)
    take_sides(state, w, k)
    accelerate(state, w, k)
    ball.ax, ball.ay = ball.gx, ball.gy
    _enter_zones(state.zones, w, k)
    resolve_next(ball)
    plan_pairs(state, state.pairs, w, k)


@function
def _enter_zones(zones: Table, w: int, k: int) -> None:
    """Until its first flight is planned a ball may be anywhere."""
    if zones is not None:
        for m in range(zones.shape[2]):
            zones[w, k, m].inside = 1


@routine
def disturb(state: State, w: int, k: int, drag: float, dvx: float, dvy: float) -> None:
    """Let a new flight of ball `k` begin now, at `drag` times its velocity plus (dvx, dvy) [m/s].

    It first bounces from what it touches, or comes into contact with it, or goes on as it was.
    """
    ball, world = state.balls[w, k], state.worlds[w]
    if ball.status in (OUT, CRUSHED):
        return
    gx, gy = pull(state.gravity, ball)
    t = since(world.time_hi, world.time_lo, ball.hi, ball.lo)
    x0, y0, vx0, vy0 = ball.x, ball.y, ball.vx, ball.vy
    end_flight(ball, state, world.scene, gx, gy, t, world.time_hi, world.time_lo)
    ball.hit_kind = RESOLVE
    arrive(state, w, k, x0, y0, vx0, vy0, t)
    face_crossings(state, w, k)
    ball.vx, ball.vy = drag * ball.vx + dvx, drag * ball.vy + dvy
    resolve_next(ball)


@function
def slow_down(state: State, drags: Table, w: int) -> None:
    """Let drag act on every ball: once at each instant at which a command is given, however many are."""
    if drags is None:
        return
    world = state.worlds[w]
    if drags[world.scene] == 1.0 or (world.drag_hi == world.time_hi and world.drag_lo == world.time_lo):
        return
    world.drag_hi, world.drag_lo = world.time_hi, world.time_lo
    for k in range(state.balls.shape[1]):
        disturb(state, w, k, drags[world.scene], 0.0, 0.0)
