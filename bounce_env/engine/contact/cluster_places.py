"""The places of balls that lie on each other: what presses touches exactly, and nothing overlaps."""

import math

from bounce_env.engine.compile.jit import function
from bounce_env.engine.contact.projection import project
from bounce_env.engine.contact.touching import collect_touches
from bounce_env.engine.memory.records import OUT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.path import motion_after
from bounce_env.engine.tolerances import CLUSTER_GAP, ULPS_OF_LENGTH


@function
def close_gaps(state: State, w: int, count: int) -> None:
    """Move members so that what presses touches exactly, and nothing overlaps: a gap's tolerance is never used up.

    Where there is no room for that only overlaps are undone, as far as there is.
    """
    head, off = state.scenes[state.worlds[w].scene], 0.0
    slack = ULPS_OF_LENGTH * head.extent
    for p in range(count):
        contact = state.contacts[w, p]
        contact.target = -contact.gap
        off = max(off, abs(contact.gap) if contact.keeps else -contact.gap)
    if off <= slack:
        return
    for i in range(state.members.shape[1]):
        state.members[w, i].x0, state.members[w, i].y0 = 0.0, 0.0
    if not (project(state, w, count, 0.5 * slack) and _have_room(state, w)):
        for p in range(count):
            state.contacts[w, p].keeps = 0
        project(state, w, count, 0.5 * slack)
        if not _have_room(state, w):
            return
    for i in range(state.members.shape[1]):
        if state.members[w, i].inside:
            ball, member = state.balls[w, i], state.members[w, i]
            ball.x, ball.y = ball.x + member.x, ball.y + member.y


@function
def _have_room(state: State, w: int) -> bool:
    """Return whether members can be moved so: a little way, of which contacts know, or one at whose end nothing is.

    A row that fills a gap may ask for the square root of the tolerance; its square is the error of that.
    """
    head = state.scenes[state.worlds[w].scene]
    room = CLUSTER_GAP * head.extent
    longest = 2.0 * room * head.ball_radius
    for i in range(state.members.shape[1]):
        member = state.members[w, i]
        square = member.x * member.x + member.y * member.y if member.inside else 0.0
        if square > longest or (square > 4.0 * room * room and not _is_free(state, w, i, room, math.sqrt(longest))):
            return False
    return True


@function
def _is_free(state: State, w: int, i: int, room: float, longest: float) -> bool:
    """Return whether a member, where it would be moved to, overlaps nothing by more than `room` [m]."""
    ball, member, tolerance = state.balls[w, i], state.members[w, i], state.balls[w, i].tolerance
    x, y, free = ball.x, ball.y, True
    ball.x, ball.y, ball.tolerance = x + member.x, y + member.y, 2.0 * longest
    collect_touches(state, w, i)
    for n in range(ball.touched):
        free = free and state.touches[w, n].gap >= -room
    least = 2.0 * state.scenes[state.worlds[w].scene].ball_radius - room
    for j in range(state.balls.shape[1]):
        other, moved = state.balls[w, j], state.members[w, j]
        ox, oy, _, _ = motion_after(state, w, j, since(ball.hi, ball.lo, other.hi, other.lo))
        if moved.inside:
            ox, oy = other.x + moved.x, other.y + moved.y
        dx, dy = ball.x - ox, ball.y - oy
        free = free and (j == i or other.status == OUT or dx * dx + dy * dy >= least * least)
    ball.x, ball.y, ball.tolerance = x, y, tolerance
    return free
