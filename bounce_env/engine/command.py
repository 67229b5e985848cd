"""Commands: from now until the next one a part is to move so. The command that it has changes no bit."""

from bounce_env.engine.crush import mind_crushed
from bounce_env.engine.disturb import slow_down
from bounce_env.engine.drive import end_rides, replan_part, set_off
from bounce_env.engine.ends import set_ends_off
from bounce_env.engine.jit import Record, Table, function
from bounce_env.engine.layout import State, Tables


@function
def command(state: State, tables: Tables, motions: Table, parts: Table, w: int, m: int, velocity: float) -> None:
    """Let part `m` of world `w` move at `velocity` [m/s or rad/s] from now on. The command it has changes no bit."""
    if motions is None or parts is None:
        return
    motion, world = motions[w, m], state.worlds[w]
    slow_down(state, tables, tables.drags, w)
    if velocity == motion.command:
        return
    end_rides(state, tables, w, m)
    set_off(motion, parts[world.scene, m], world, velocity)
    mind_crushed(state, tables, motions, parts, w, m)
    replan_part(state, tables, state.zones, w, m)


@function
def command_ends(
    state: State, tables: Tables, motions: Table, parts: Table, all_ends: Table, guides: Table, w: int, m: int,
    vx0: float, vy0: float, vx1: float, vy1: float,
) -> None:  # fmt: skip
    """Let the ends of the dragged wall `m` move at these velocities [m/s] from now on, as far as they may."""
    if motions is None or parts is None or all_ends is None or guides is None:
        return
    motion, ends, world = motions[w, m], all_ends[w, m], state.worlds[w]
    slow_down(state, tables, tables.drags, w)
    if vx0 == ends.cx0 and vy0 == ends.cy0 and vx1 == ends.cx1 and vy1 == ends.cy1:
        return
    end_rides(state, tables, w, m)
    ends.cx0, ends.cy0, ends.cx1, ends.cy1 = vx0, vy0, vx1, vy1
    set_ends_off(motion, ends, guides[world.scene, m], world.time_hi, world.time_lo)
    mind_crushed(state, tables, motions, parts, w, m)
    replan_part(state, tables, state.zones, w, m)


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
