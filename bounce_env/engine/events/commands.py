"""Commands: from now until the next one a part is to move so. Repeating the current command changes no bit."""

from bounce_env.engine.compile.jit import routine, where
from bounce_env.engine.events.crushing import hold_or_free_crushed
from bounce_env.engine.events.flights import apply_drag
from bounce_env.engine.events.part_stops import end_rides, replan_part, resume_part, set_part_off
from bounce_env.engine.memory.state import State


@where("parts")
def command(state: State, w: int, m: int, velocity: float) -> None:
    """Let part `m` of world `w` move at `velocity` [m/s or rad/s]."""
    apply_drag(state, w)
    if velocity != state.motions[w, m].command:
        state.motions[w, m].command = velocity
        _obey_command(state, w, m)


@where("ends")
def command_ends(state: State, w: int, m: int, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Let the ends of the dragged wall `m` move at these velocities [m/s], as far as they may."""
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


@where("parts", otherwise=True)
def command_unwatched(state: State, w: int, m: int, velocity: float) -> bool:
    """Command a part that no ball is near, as `command` does; otherwise return False with nothing done."""
    if state.drags is not None:
        return False
    motion, world = state.motions[w, m], state.worlds[w]
    if velocity == motion.command:
        return True
    for k in range(state.zones.shape[1]):
        if state.zones[w, k, m].inside:
            return False
    set_part_off(motion, state.parts[world.scene, m], world, velocity)
    return True


@where("parts", otherwise=0.0)
def full_speed(state: State, w: int, m: int) -> float:
    """Return the greatest speed [m/s or rad/s] of part `m`, forwards."""
    return state.parts[state.worlds[w].scene, m].up_speed


@where("parts")
def command_flipper(state: State, w: int, m: int, pressed: bool) -> None:
    """Let flipper `m` turn to its active angle at full speed while it is pressed, and back while it is not."""
    part = state.parts[state.worlds[w].scene, m]
    command(state, w, m, part.up_speed if pressed else -part.down_speed)


@where("drag_limits", otherwise=(0.0, 0.0, 0.0, 0.0))
def reach_box(state: State, w: int, m: int) -> tuple[float, float, float, float]:
    """Return the box in which the ends of dragged wall `m` stay: x_min, y_min, x_max, y_max [m]."""
    limits = state.drag_limits[state.worlds[w].scene, m]
    return limits.x0, limits.y0, limits.x1, limits.y1
