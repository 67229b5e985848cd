"""What a world that goes on in another scene takes along: its clock, its counts, and where its parts are."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import from_python
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.parts import part_offset_at
from bounce_env.scene import Part, Wall

Parts = Sequence[tuple[int, Part]]  # as `Scene.parts`

CLOCK_AND_COUNTS = ("time_hi", "time_lo", "bounces", "speed_capped", "events", "events_before", "drag_hi", "drag_lo")

_offset_at = from_python(part_offset_at)


def carry_over(old: State, old_parts: Parts, old_cores: npt.NDArray[np.float64], new: State, parts: Parts) -> None:
    """Let a new state go on at the clock of an old one, with parts of the same name and kind where those are.

    They are at rest, with their commands: `World.replace` says which keep their places. old_cores: where the old parts
    are now, (parts, 4) [m].
    """
    for name in CLOCK_AND_COUNTS:
        new.worlds[0][name] = old.worlds[0][name]
    if new.motions is None or new.parts is None:
        return
    known = {part.name: m for m, (_, part) in enumerate(old_parts) if part.name}
    for m, (_, part) in enumerate(parts):
        motion, row = new.motions[0, m], new.parts[0, m]
        motion.offset, motion.command = row.start, row.shuttle
        motion.hi, motion.lo = new.worlds[0].time_hi, new.worlds[0].time_lo
        before = known.get(part.name)
        was = None if before is None else old_parts[before][1]
        if isinstance(part, Wall):
            assert new.ends is not None
            assert new.drag_limits is not None
            ends, limits = new.ends[0, m], new.drag_limits[0, m]
            ends.x0, ends.y0, ends.x1, ends.y1 = limits.sx, limits.sy, limits.ex, limits.ey
            if isinstance(was, Wall) and (was.start, was.end, was.reach) == (part.start, part.end, part.reach):
                assert old.ends is not None
                _keep_ends(ends, old.ends[0, before], old_cores[before])
        elif type(was) is type(part):
            assert old.motions is not None
            there = old.motions[0, before]
            motion.offset = min(max(_offset_at(there, motion.hi, motion.lo), 0.0), float(row.span))
            motion.command = min(max(float(there.command), -float(row.down_speed)), float(row.up_speed))


def _keep_ends(ends: Any, old_ends: Any, old_core: npt.NDArray[np.float64]) -> None:
    ends.x0, ends.y0, ends.x1, ends.y1 = old_core
    for name in ("cx0", "cy0", "cx1", "cy1"):
        ends[name] = old_ends[name]
