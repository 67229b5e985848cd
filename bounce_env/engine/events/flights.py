"""What begins a new flight of a ball from outside of it: it is placed, pushed, or slowed down by drag."""

from bounce_env.engine.compile.jit import routine, where
from bounce_env.engine.contact.arrival import end_flight
from bounce_env.engine.contact.sides import update_crossing_sides, update_sides
from bounce_env.engine.contact.start_sides import set_initial_sides
from bounce_env.engine.detect.pairs import forget_meetings, plan_pairs
from bounce_env.engine.detect.schedule import schedule_resolve
from bounce_env.engine.memory.lookup import let_off
from bounce_env.engine.memory.records import CRUSHED, FLYING, OK, OUT, RESOLVE
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.fields import accelerate
from bounce_env.engine.motion.flight import flight_of
from bounce_env.engine.motion.instant import since
from bounce_env.engine.tolerances import ULPS_OF_LENGTH


@routine
def place(state: State, w: int, k: int, x: float, y: float, vx: float, vy: float) -> None:
    """Put ball `k` into flight at (x, y) [m] with velocity (vx, vy) [m/s] at the world's present time."""
    ball, world = state.balls[w, k], state.worlds[w]
    let_go(state, w, k)
    ball.x, ball.y, ball.vx, ball.vy = x, y, vx, vy
    ball.hi, ball.lo = world.time_hi, world.time_lo
    ball.status = OK
    ball.contact, ball.rides, ball.support, ball.settling = FLYING, -1, -1, 0
    ball.confined = 0
    let_off(state, w, k)
    forget_meetings(state, w, k)
    ball.tolerance = ULPS_OF_LENGTH * state.scenes[world.scene].extent
    set_initial_sides(state, w, k)
    accelerate(state, w, k)
    ball.ax, ball.ay = ball.gx, ball.gy
    _enter_zones(state, w, k)
    schedule_resolve(ball)
    plan_pairs(state, w, k)


@where("zones")
def _enter_zones(state: State, w: int, k: int) -> None:
    """Until its first flight is planned a ball may be anywhere."""
    for m in range(state.zones.shape[2]):
        state.zones[w, k, m].inside = 1


@routine
def disturb(state: State, w: int, k: int, drag: float, dvx: float, dvy: float) -> None:
    """Let a new flight of ball `k` begin now, at `drag` times its velocity plus (dvx, dvy) [m/s].

    It first bounces from what it touches, or comes into contact with it, or goes on as it was.
    """
    ball, world = state.balls[w, k], state.worlds[w]
    if ball.status in (OUT, CRUSHED):
        return
    start, t = flight_of(state, ball), since(world.time_hi, world.time_lo, ball.hi, ball.lo)
    end_flight(state, w, k, t, world.time_hi, world.time_lo)
    ball.hit_kind = RESOLVE
    update_sides(state, w, k, start, t)
    update_crossing_sides(state, w, k)
    ball.vx, ball.vy = drag * ball.vx + dvx, drag * ball.vy + dvy
    schedule_resolve(ball)


@where("pairs", inline=False)
def let_go(state: State, w: int, k: int) -> None:
    """Resolve the balls that ball `k` has been pressed on anew: it is no longer there."""
    for j in range(state.balls.shape[1]):
        if j != k and state.pairs[w, max(j, k), min(j, k)].pressed:
            state.pairs[w, max(j, k), min(j, k)].pressed = 0
            disturb(state, w, j, 1.0, 0.0, 0.0)


@where("drags")
def apply_drag(state: State, w: int) -> None:
    """Let drag act on every ball: once at each instant at which a command is given, however many are."""
    world = state.worlds[w]
    drag = state.drags[world.scene]
    if drag == 1.0 or (world.drag_hi == world.time_hi and world.drag_lo == world.time_lo):
        return
    world.drag_hi, world.drag_lo = world.time_hi, world.time_lo
    for k in range(state.balls.shape[1]):
        disturb(state, w, k, drag, 0.0, 0.0)
