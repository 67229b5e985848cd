"""Commands: from now until the next one a part is to move so. Repeating the current command changes no bit."""

from bounce_env.engine.compile.jit import routine, where
from bounce_env.engine.events.crushing import hold_or_free_crushed
from bounce_env.engine.events.flights import apply_drag
from bounce_env.engine.events.part_stops import end_rides, replan_part, resume_part, set_part_off
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import before
from bounce_env.engine.motion.parts import part_moves_until, part_stop_instant


@where("parts")
def command(state: State, w: int, m: int, velocity: float) -> None:
    """Let part `m` of world `w` move at `velocity` [m/s or rad/s]."""
    apply_drag(state, w)
    if velocity != state.motions[w, m].command:
        state.motions[w, m].command = velocity
        _obey_command(state, w, m)


@where("ends")
def command_ends(state: State, w: int, m: int, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Let the ends of the dragged wall `m` move at the velocities `start` and `end` [m/s], as far as they may."""
    ends, (vx0, vy0), (vx1, vy1) = state.ends[w, m], start, end
    apply_drag(state, w)
    if vx0 != ends.cx0 or vy0 != ends.cy0 or vx1 != ends.cx1 or vy1 != ends.cy1:
        ends.cx0, ends.cy0, ends.cx1, ends.cy1 = vx0, vy0, vx1, vy1
        _obey_command(state, w, m)


@routine
def _obey_command(state: State, w: int, m: int) -> None:
    """Let part `m` move as it has now been commanded to."""
    end_rides(state, w, m)
    resume_part(state, w, m)
    hold_or_free_crushed(state, w, m)
    replan_part(state, w, m)


@where("parts", otherwise=False)
def is_unwatched(state: State, w: int, m: int) -> bool:
    """Return whether no ball is near part `m`: nobody meets what it does until one comes there, which is an event."""
    near = 0
    for k in range(state.zones.shape[1]):
        near += state.zones[w, k, m].inside
    return near == 0


@where("parts", otherwise=True)
def command_unwatched(state: State, w: int, m: int, velocity: float) -> bool:
    """Command a part that no ball is near, as `command` does; otherwise return False with nothing done."""
    if state.drags is not None:
        return False
    motion, world = state.motions[w, m], state.worlds[w]
    if velocity == motion.command:
        return True
    if not is_unwatched(state, w, m):
        return False
    set_part_off(motion, state.parts[world.scene, m], world, velocity)
    return True


@where("parts", otherwise=True)
def goes_on_quietly(state: State, w: int, m: int, hi: float, lo: float) -> bool:
    """Return whether part `m` surely comes to no stop up to an instant."""
    return part_moves_until(state.motions[w, m], state.parts[state.worlds[w].scene, m], hi, lo)


@where("parts", otherwise=True)
def obeys_quietly(state: State, w: int, m: int, velocity: float, hi: float, lo: float) -> bool:
    """Return whether nobody meets part `m` up to an instant if it is commanded so, or it only goes on as it does."""
    goes_on = velocity == state.motions[w, m].command and goes_on_quietly(state, w, m, hi, lo)
    return goes_on or (state.drags is None and is_unwatched(state, w, m))


@where("parts")
def obey_quietly(state: State, w: int, m: int, velocity: float, hi: float, lo: float) -> None:
    """Command part `m`, and let it move, and stop, up to an instant, where `obeys_quietly` says that nobody meets it.

    As `command` and the event loop would, but for what is recorded. It may be a flipper or a paddle.
    """
    motion, world = state.motions[w, m], state.worlds[w]
    shape = state.parts[world.scene, m]
    if velocity != motion.command:
        set_part_off(motion, shape, world, velocity)
    if part_moves_until(motion, shape, hi, lo):
        return
    stop_hi, stop_lo = part_stop_instant(motion, shape)
    if not before(hi, lo, stop_hi, stop_lo):
        motion.offset = shape.span if motion.velocity > 0.0 else 0.0
        motion.hi, motion.lo, motion.velocity = stop_hi, stop_lo, 0.0
        world.events_before += 1


@where("parts", otherwise=0.0)
def pressed_velocity(state: State, w: int, m: int, pressed: bool) -> float:
    """Return how flipper `m` is commanded to turn [rad/s] while it is pressed, or not."""
    part = state.parts[state.worlds[w].scene, m]
    return part.up_speed if pressed else -part.down_speed


@where("parts", otherwise=0.0)
def full_speed(state: State, w: int, m: int) -> float:
    """Return the greatest speed [m/s or rad/s] of part `m`, forwards."""
    return state.parts[state.worlds[w].scene, m].up_speed


@where("parts")
def command_flipper(state: State, w: int, m: int, pressed: bool) -> None:
    """Let flipper `m` turn to its active angle at full speed while it is pressed, and back while it is not."""
    command(state, w, m, pressed_velocity(state, w, m, pressed))


@where("drag_limits", otherwise=(0.0, 0.0, 0.0, 0.0))
def reach_box(state: State, w: int, m: int) -> tuple[float, float, float, float]:
    """Return the box in which the ends of dragged wall `m` stay: x_min, y_min, x_max, y_max [m]."""
    limits = state.drag_limits[state.worlds[w].scene, m]
    return limits.x0, limits.y0, limits.x1, limits.y1
