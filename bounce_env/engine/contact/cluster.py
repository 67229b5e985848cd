"""Balls that lie on each other: who belongs to a cluster, what touches what in it, and what it does as one.

Hits obey the bounce law. Where a ball is pressed on another and a hit is too slow to rebound (`slowest_rebound`), or
hits have no room any more, all balls that touch are resolved as one (docs/physics.md, "Clusters of balls"): three
projections give their velocities, their places, and with what accelerations they go on.
"""

import math

from bounce_env.engine.compile.jit import Record, Table, function, where
from bounce_env.engine.contact.arrival import end_flight
from bounce_env.engine.contact.bounces import bounce_off_fast, fastest_closing
from bounce_env.engine.contact.carrying import runs_off_end
from bounce_env.engine.contact.cluster_motion import go_on, is_driven
from bounce_env.engine.contact.projection import project
from bounce_env.engine.contact.restitution import is_holding
from bounce_env.engine.contact.touching import collect_touches
from bounce_env.engine.detect.pairs import has_no_room, slowest_pair_rebound, slowest_rebound
from bounce_env.engine.detect.schedule import schedule_nothing, schedule_resolve
from bounce_env.engine.memory.ledger import Surface, append_contact
from bounce_env.engine.memory.records import ABSORBED, CRUSHED, OUT
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.path import motion_after
from bounce_env.engine.tolerances import ALIGNED, CLUSTER_GAP, PRESSING, ULPS_OF_SPEED


@where("pairs", inline=False)
def resolve_cluster(state: State, w: int, k: int) -> None:
    """Resolve all balls that touch ball `k`, or each other, at its present instant, as one.

    Where something in it still closes fast that is first: it bounces by the law, and the cluster is resolved again.
    """
    ball = state.balls[w, k]
    _gather(state, w, k, ball.hi, ball.lo)
    surfaces, hits = 0, False
    for i in range(state.members.shape[1]):
        if state.members[w, i].inside:
            surfaces = _list_surfaces(state, w, i, i == k, surfaces)
            hits = hits or state.members[w, i].hits
    if state.parts is not None and ball.status == CRUSHED and not state.members[w, k].fixed:
        _resolve_others(state, w, k)
        return
    count, closing = _list_pairs(state, w, surfaces)
    if hits or closing:
        _wait_for_hits(state, w, surfaces, count, ball.hi, ball.lo)
        return
    _hold(state, w, surfaces)
    if _close_nowhere(state, w, count):
        go_on(state, w, count)
    else:
        _wait_for_hits(state, w, surfaces, count, math.inf, 0.0)


@function
def _resolve_others(state: State, w: int, k: int) -> None:
    """Let the members be resolved anew once ball `k` has been crushed."""
    for i in range(state.members.shape[1]):
        if i != k and state.members[w, i].inside and state.balls[w, i].status != CRUSHED:
            schedule_resolve(state.balls[w, i])


@function
def _gather(state: State, w: int, k: int, hi: float, lo: float) -> None:
    """Find the members of ball `k`'s cluster at the instant (hi, lo), and end their flights there."""
    for i in range(state.members.shape[1]):
        state.members[w, i].inside = 0
    _include(state, w, k, hi, lo)
    found = True
    while found:
        found = False
        for i in range(state.members.shape[1]):
            if state.members[w, i].inside != 1:
                continue
            state.members[w, i].inside = 2
            for j in range(state.members.shape[1]):
                if not state.members[w, j].inside and _belong_together(state, w, i, j):
                    _include(state, w, j, hi, lo)
                    found = True


@function
def _include(state: State, w: int, k: int, hi: float, lo: float) -> None:
    ball, member = state.balls[w, k], state.members[w, k]
    end_flight(state, w, k, since(hi, lo, ball.hi, ball.lo), hi, lo)
    ball.tolerance = CLUSTER_GAP * state.scenes[state.worlds[w].scene].extent
    member.inside, member.fixed = 1, 1 if ball.status == CRUSHED else 0


@function
def _belong_together(state: State, w: int, i: int, j: int) -> bool:
    """Return whether ball `j` touches ball `i` where its flight has ended, or was pressed on it."""
    if state.balls[w, j].status == OUT:
        return False
    return state.pairs[w, max(i, j), min(i, j)].pressed == 1 or _touch(state, w, i, j)


@function
def _touch(state: State, w: int, i: int, j: int) -> bool:
    """Return whether ball `j` touches ball `i` at the instant of the latter's last event."""
    one, other, head = state.balls[w, i], state.balls[w, j], state.scenes[state.worlds[w].scene]
    x, y, _, _ = motion_after(state, w, j, since(one.hi, one.lo, other.hi, other.lo))
    dx, dy = one.x - x, one.y - y
    reach = 2.0 * head.ball_radius + CLUSTER_GAP * head.extent
    return dx * dx + dy * dy <= reach * reach


@function
def touch_others(state: State, w: int, k: int, but: int) -> bool:
    """Return whether balls in play, but for ball `but`, touch ball `k` at the instant of its last event."""
    for j in range(state.balls.shape[1]):
        if j not in (k, but) and state.balls[w, j].status != OUT and _touch(state, w, k, j):
            return True
    return False


@function
def _list_surfaces(state: State, w: int, i: int, first: bool, count: int) -> int:
    """List what member `i` touches as contacts from `count` on; return how many there are then.

    The ball whose event this is (`first`) bounces by the law from what it closes on fast; of another one it is noted.
    """
    ball, scene, member = state.balls[w, i], state.worlds[w].scene, state.members[w, i]
    collect_touches(state, w, i)
    slowest = math.inf if has_no_room(state, w, i) else slowest_rebound(state, w, ball)
    fast, _ = fastest_closing(ball, state.touches, w, slowest)
    member.hits = 0
    if fast >= 0 and ball.status != CRUSHED:
        if first:
            bounce_off_fast(state, w, i, slowest)
        else:
            member.hits = 1
    for n in range(ball.touched if ball.status != CRUSHED else 0):
        touch = state.touches[w, n]
        if count == state.contacts.shape[1]:
            break
        if _passes_to_round_end(ball, state.touches, w, n):
            continue
        contact, material = state.contacts[w, count], state.elements[scene, touch.element]
        contact.one, contact.other, contact.nx, contact.ny, contact.gap = i, -1, touch.nx, touch.ny, touch.gap
        contact.ux, contact.uy, contact.curvature = touch.ux, touch.uy, touch.curvature
        contact.least = touch.least if touch.moves else 0.0
        contact.holds = 1 if is_holding(material.f, state.scenes[scene].rest_speed) else 0
        contact.element, contact.face, contact.part, contact.keeps = touch.element, touch.face, touch.part, 0
        count += 1
    return count


@function
def _passes_to_round_end(ball: Record, touches: Table, w: int, n: int) -> bool:
    """Return whether a ball at the end of a straight side moves off it on to a round end, which it touches, too."""
    side = touches[w, n]
    if side.curvature != 0.0 or not runs_off_end(ball, side):
        return False
    for m in range(ball.touched):
        end = touches[w, m]
        if end.curvature > 0.0 and end.nx * side.nx + end.ny * side.ny >= 1.0 - ALIGNED:
            return True
    return False


@function
def _list_pairs(state: State, w: int, count: int) -> tuple[int, bool]:
    """List the members that touch each other as contacts from `count` on.

    Return how many there are then, and whether any two close too fast on each other to be resolved as one.
    """
    head, hits = state.scenes[state.worlds[w].scene], False
    reach = 2.0 * head.ball_radius
    for i in range(state.members.shape[1]):
        for j in range(i if state.members[w, i].inside else 0):
            if not (state.members[w, j].inside and count < state.contacts.shape[1]):
                continue
            one, other, contact = state.balls[w, i], state.balls[w, j], state.contacts[w, count]
            dx, dy = one.x - other.x, one.y - other.y
            distance = math.sqrt(dx * dx + dy * dy)
            if distance > reach + CLUSTER_GAP * head.extent:
                continue
            contact.one, contact.other, contact.nx, contact.ny = i, j, dx / distance, dy / distance
            contact.ux, contact.uy, contact.least, contact.holds, contact.keeps = 0.0, 0.0, 0.0, 0, 0
            contact.gap, contact.curvature = distance - reach, 1.0 / reach
            contact.element, contact.face, contact.part = head.elements + j, -1, -1
            hits = hits or _is_hit(state, w, contact)
            count += 1
    return count, hits


@function
def _is_hit(state: State, w: int, contact: Record) -> bool:
    """Return whether two balls in contact close so fast on each other that they bounce by the law."""
    one, other = state.balls[w, contact.one], state.balls[w, contact.other]
    closing = -((one.vx - other.vx) * contact.nx + (one.vy - other.vy) * contact.ny)
    return closing > slowest_pair_rebound(state, w, contact.one, contact.other)


@function
def _wait_for_hits(state: State, w: int, first: int, count: int, hi: float, lo: float) -> None:
    """Let members that close fast on something hit it now, or get crushed, and the others do nothing until then."""
    for i in range(state.members.shape[1]):
        if state.members[w, i].inside and state.members[w, i].hits:
            schedule_resolve(state.balls[w, i])
        elif state.members[w, i].inside:
            schedule_nothing(state.balls[w, i])
    for p in range(first, count):
        contact = state.contacts[w, p]
        pair = state.pairs[w, contact.one, contact.other]
        pair.pressed, pair.hi, pair.lo = 1, math.inf, 0.0
        if _is_hit(state, w, contact):
            pair.hi, pair.lo = hi, lo


@function
def _close_nowhere(state: State, w: int, count: int) -> bool:
    """Change the members' velocities by as little as lets them close on nothing, and log what that takes.

    Returns whether nothing is crushed by that.
    """
    fastest, pull = 0.0, 0.0
    for i in range(state.members.shape[1]):
        if state.members[w, i].inside:
            ball, member = state.balls[w, i], state.members[w, i]
            member.x0, member.y0 = ball.vx, ball.vy
            fastest = max(fastest, abs(ball.vx) + abs(ball.vy))
            pull = max(pull, abs(ball.gx) + abs(ball.gy))
    for p in range(count):
        contact = state.contacts[w, p]
        drive = contact.ux * contact.nx + contact.uy * contact.ny
        fastest = max(fastest, abs(contact.ux) + abs(contact.uy))
        contact.target = drive
        if contact.least > 0.0 and _opening(state, w, contact) <= 0.0:
            contact.target = drive + contact.least
    slack = ULPS_OF_SPEED * fastest
    possible = project(state, w, count, slack) or (_slip(state, w) and project(state, w, count, slack))
    if not possible and _squeeze(state, w, count):
        return False
    # Less than what lifts a ball by the tolerance only keeps closed what was.
    least = 4.0 * slack + math.sqrt(2.0 * pull * CLUSTER_GAP * state.scenes[state.worlds[w].scene].extent)
    for p in range(count):
        if state.contacts[w, p].force > least:
            _log_push(state, w, state.contacts[w, p])
    for i in range(state.members.shape[1]):
        if state.members[w, i].inside:
            ball, member = state.balls[w, i], state.members[w, i]
            ball.vx, ball.vy = member.x, member.y
    _absorb_rounding(state, w, count, slack)
    return True


@function
def _absorb_rounding(state: State, w: int, count: int, slack: float) -> None:
    """Take from the velocities what closes on a surface by no more than `slack` [m/s].

    To a slow member the rounding of faster ones is a speed with which it would hit again.
    """
    for p in range(count):
        contact = state.contacts[w, p]
        if contact.other < 0 and not state.members[w, contact.one].fixed:
            ball = state.balls[w, contact.one]
            rest = contact.target - (ball.vx * contact.nx + ball.vy * contact.ny)
            if 0.0 < rest <= slack:
                ball.vx, ball.vy = ball.vx + rest * contact.nx, ball.vy + rest * contact.ny


@where("parts", otherwise=False)
def _squeeze(state: State, w: int, count: int) -> bool:
    """Let the parts that close on members crush these, where nothing lets them get away; return whether one does."""
    crushed = False
    for p in range(count):
        contact = state.contacts[w, p]
        if contact.opposes and contact.part >= 0 and contact.ux * contact.nx + contact.uy * contact.ny > 0.0:
            ball = state.balls[w, contact.one]
            member = state.members[w, contact.one]
            ball.struck, member.doomed, member.hits, crushed = contact.part, 1, 1, True
    return crushed


@function
def _hold(state: State, w: int, count: int) -> None:
    """Let friction stop the members that gravity presses on surfaces which hold them, unless a part moves into any."""
    for p in range(count):
        if is_driven(state.contacts[w, p]):
            return
    for p in range(count):
        contact = state.contacts[w, p]
        ball, member = state.balls[w, contact.one], state.members[w, contact.one]
        pressed = ball.gx * contact.nx + ball.gy * contact.ny < -PRESSING * (abs(ball.gx) + abs(ball.gy))
        slow = abs(_opening(state, w, contact)) <= slowest_rebound(state, w, ball)
        if contact.holds and pressed and slow and not member.fixed and contact.least == 0.0:
            vx, vy = ball.vx, ball.vy
            ball.vx, ball.vy, member.fixed = contact.ux, contact.uy, 1
            if vx != ball.vx or vy != ball.vy:
                surface = Surface(contact.element, contact.nx, contact.ny, contact.ux, contact.uy)
                append_contact(state, w, contact.one, ABSORBED, surface, vx, vy)


@function
def _slip(state: State, w: int) -> bool:
    """Let the members go that friction holds: held, they close on something. Returns whether there are any."""
    any_held = False
    for i in range(state.members.shape[1]):
        member = state.members[w, i]
        if member.inside and member.fixed and state.balls[w, i].status != CRUSHED:
            member.fixed, any_held = 0, True
    return any_held


@function
def _opening(state: State, w: int, contact: Record) -> float:
    """Return how fast [m/s] a member leaves a surface."""
    ball = state.balls[w, contact.one]
    opening: float = (ball.vx - contact.ux) * contact.nx + (ball.vy - contact.uy) * contact.ny
    return opening


@function
def _log_push(state: State, w: int, contact: Record) -> None:
    """Change the velocities of those in contact by its force, and log that."""
    world, one = state.worlds[w], state.balls[w, contact.one]
    vx, vy, ux, uy = one.vx, one.vy, contact.ux, contact.uy
    if contact.other >= 0:
        ux, uy = state.balls[w, contact.other].vx, state.balls[w, contact.other].vy
    if not state.members[w, contact.one].fixed:
        one.vx, one.vy = vx + contact.force * contact.nx, vy + contact.force * contact.ny
    surface = Surface(contact.element, contact.nx, contact.ny, ux, uy)
    append_contact(state, w, contact.one, ABSORBED, surface, vx, vy)
    if contact.other < 0:
        return
    other = state.balls[w, contact.other]
    if not state.members[w, contact.other].fixed:
        other.vx, other.vy = ux - contact.force * contact.nx, uy - contact.force * contact.ny
    surface = Surface(state.scenes[world.scene].elements + contact.one, -contact.nx, -contact.ny, vx, vy)
    append_contact(state, w, contact.other, ABSORBED, surface, ux, uy)
