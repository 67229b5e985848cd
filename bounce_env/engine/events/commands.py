"""Commands: from now until the next one a part is to move so. The command that it has changes no bit."""

from bounce_env.engine.compile.jit import Record, Table, function, routine
from bounce_env.engine.events.crushing import mind_crushed
from bounce_env.engine.events.flights import slow_down
from bounce_env.engine.events.part_stops import end_rides, replan_part, resume_part, set_off
from bounce_env.engine.memory.state import State


@function
def command(state: State, motions: Table, parts: Table, w: int, m: int, velocity: float) -> None:
    """Let part `m` of world `w` move at `velocity` [m/s or rad/s]."""
    if motions is None or parts is None:
        return
    slow_down(state, state.drags, w)
    if velocity != motions[w, m].command:
        motions[w, m].command = velocity
        _move_otherwise(state, motions, parts, w, m)


@function
def command_ends(state: State, all_ends: Table, w: int, m: int, vx0: float, vy0: float, vx1: float, vy1: float) -> None:
    """Let the ends of the dragged wall `m` move at these velocities [m/s], as far as they may."""
    if all_ends is None:
        return
    ends = all_ends[w, m]
    slow_down(state, state.drags, w)
    if vx0 != ends.cx0 or vy0 != ends.cy0 or vx1 != ends.cx1 or vy1 != ends.cy1:
        ends.cx0, ends.cy0, ends.cx1, ends.cy1 = vx0, vy0, vx1, vy1
        _move_otherwise(state, state.motions, state.parts, w, m)


@routine
def _move_otherwise(state: State, motions: Table, parts: Table, w: int, m: int) -> None:
    """Let part `m` move as it has now been commanded to."""
    end_rides(state, w, m)
    resume_part(state, motions, parts, w, m)
    mind_crushed(state, motions, parts, w, m)
    replan_part(state, state.zones, w, m)


@function
def command_unwatched(
    world: Record, motions: Table, parts: Table, zones: Table, drags: Table, w: int, m: int, velocity: float
) -> bool:
    """As `command`, where no ball is concerned; otherwise it does nothing and returns False."""
    if motions is None or parts is None or zones is None:
        return True
    if drags is not None:
        return False
    motion = motions[w, m]
    if velocity == motion.command:
        return True
    for k in range(zones.shape[1]):
        if zones[w, k, m].inside:
            return False
    set_off(motion, parts[world.scene, m], world, velocity)
    return True
