"""How balls that lie on each other go on: with what accelerations, whether they rest, and for how long that is known.

Forces between balls are taken to be constant for as long as the gaps that they hold closed stay so within a tolerance;
then, or when anything happens to one of the balls, they are found anew. A cluster at rest has no such end: it sleeps.
"""

import math

from bounce_env.engine.compile.jit import Record, function
from bounce_env.engine.contact.cluster_places import close_gaps
from bounce_env.engine.contact.projection import project
from bounce_env.engine.contact.sides import update_crossing_sides
from bounce_env.engine.contact.touching import keep_beside
from bounce_env.engine.detect.pairs import plan_pairs
from bounce_env.engine.detect.schedule import schedule_resolve, schedule_rest, schedule_standing
from bounce_env.engine.memory.ledger import Surface, append_contact
from bounce_env.engine.memory.records import (
    CONTACT_BEGINS,
    CONTACT_ENDS,
    CRUSHED,
    HELD,
    LEANS,
    ON_BALLS,
    RESOLVE,
    RIDING,
)
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import CLUSTER_GAP, DEPENDENT, PRESSING, ULP, ULPS_OF_LENGTH, ULPS_OF_SPEED

LONGEST = 0.0625  # [s] before forces are found anew


@function
def go_on(state: State, w: int, count: int) -> None:
    """Let the members of a cluster go on from velocities that close on nothing."""
    soft = _accelerate(state, w, count)
    _keep_closed(state, w, count)
    close_gaps(state, w, count)
    _find_leaning(state, w, count, soft)
    seconds = _seconds_known(state, w, count)
    if seconds <= LONGEST:
        _turn_forces(state, w, count, 0.5 * seconds)
    for i in range(state.members.shape[1]):
        if state.members[w, i].inside and state.balls[w, i].status != CRUSHED and state.members[w, i].leans:
            _bear(state, w, i, count)
    for i in range(state.members.shape[1]):
        if state.members[w, i].inside and state.balls[w, i].status != CRUSHED:
            _plan(state, w, i, seconds)


@function
def is_driven(contact: Record) -> bool:
    """Return whether a surface itself moves into the ball."""
    drive = contact.ux * contact.nx + contact.uy * contact.ny
    return contact.other < 0 and drive > ULPS_OF_SPEED * (abs(contact.ux) + abs(contact.uy))


@function
def _relative_velocity(state: State, w: int, contact: Record) -> tuple[float, float]:
    """Return how a contact's gap opens [m/s], and how fast [m/s] it moves along, counter-clockwise positive."""
    one = state.balls[w, contact.one]
    vx, vy = one.vx - contact.ux, one.vy - contact.uy
    if contact.other >= 0:
        vx, vy = one.vx - state.balls[w, contact.other].vx, one.vy - state.balls[w, contact.other].vy
    return vx * contact.nx + vy * contact.ny, vy * contact.nx - vx * contact.ny


@function
def _accelerate(state: State, w: int, count: int) -> float:
    """Set the members' accelerations: the nearest to those of gravity and fields that let no contact close.

    A contact `keeps` from then on if that takes a force. Returns the speed [m/s] of hops that rise above no tolerance.
    """
    pull, fastest = 0.0, 0.0
    for i in range(state.members.shape[1]):
        member, ball = state.members[w, i], state.balls[w, i]
        if member.inside:
            member.x0, member.y0 = ball.gx, ball.gy
            pull, fastest = max(pull, abs(ball.gx) + abs(ball.gy)), max(fastest, abs(ball.vx) + abs(ball.vy))
            if member.fixed:
                member.x0, member.y0 = 0.0, 0.0
    for p in range(count):
        _, along = _relative_velocity(state, w, state.contacts[w, p])
        pull = max(pull, abs(state.contacts[w, p].curvature) * along * along)
    soft = math.sqrt(2.0 * pull * CLUSTER_GAP * state.scenes[state.worlds[w].scene].extent)
    for p in range(count):
        contact = state.contacts[w, p]
        contact.keeps, contact.target = 0, -math.inf
        opening, along = _relative_velocity(state, w, contact)
        if contact.least == 0.0 and opening <= soft + ULPS_OF_SPEED * fastest:
            contact.target = -contact.curvature * along * along
    slack, most = PRESSING * pull, 0.0
    project(state, w, count, slack)
    for p in range(count):
        contact = state.contacts[w, p]
        contact.keeps = 1 if contact.force > slack else 0
        contact.bears = contact.force if contact.keeps else 0.0
        most = max(most, contact.bears)
    for i in range(state.members.shape[1]):
        member, ball = state.members[w, i], state.balls[w, i]
        if member.inside:
            ball.ax, ball.ay = member.x, member.y
            if abs(ball.ax) + abs(ball.ay) <= 64.0 * slack + 16.0 * ULP * most:
                ball.ax, ball.ay = 0.0, 0.0
    return soft


@function
def _keep_closed(state: State, w: int, count: int) -> None:
    """Take from the members' velocities what opens the contacts that forces keep closed: these would undo it."""
    fastest = 0.0
    for i in range(state.members.shape[1]):
        member, ball = state.members[w, i], state.balls[w, i]
        if member.inside:
            member.x0, member.y0 = ball.vx, ball.vy
            fastest = max(fastest, abs(ball.vx) + abs(ball.vy))
    for p in range(count):
        contact = state.contacts[w, p]
        contact.target = contact.ux * contact.nx + contact.uy * contact.ny
        if contact.least > 0.0:
            contact.target = -math.inf
    project(state, w, count, ULPS_OF_SPEED * fastest)
    for i in range(state.members.shape[1]):
        member, ball = state.members[w, i], state.balls[w, i]
        if member.inside:
            ball.vx, ball.vy = member.x, member.y
            if abs(ball.vx) + abs(ball.vy) <= 4.0 * ULPS_OF_SPEED * fastest:
                ball.vx, ball.vy = 0.0, 0.0


@function
def _find_leaning(state: State, w: int, count: int, soft: float) -> None:
    """Find out which members lie on others, up to a speed `soft` [m/s], and which rest, with all that they lie on."""
    for i in range(state.members.shape[1]):
        member, ball = state.members[w, i], state.balls[w, i]
        member.leans = 0
        member.awake = 1 if ball.vx != 0.0 or ball.vy != 0.0 or ball.ax != 0.0 or ball.ay != 0.0 else 0
        for j in range(i if member.inside else 0):
            if state.members[w, j].inside:
                state.pairs[w, i, j].pressed = 0
    for p in range(count):
        contact = state.contacts[w, p]
        if contact.other >= 0 and _relative_velocity(state, w, contact)[0] <= soft:
            state.members[w, contact.one].leans = state.members[w, contact.other].leans = 1
            state.pairs[w, contact.one, contact.other].pressed = 1
    changed = True
    while changed:
        changed = False
        for p in range(count):
            contact = state.contacts[w, p]
            if contact.other < 0 or not state.pairs[w, contact.one, contact.other].pressed:
                continue
            one, other = state.members[w, contact.one], state.members[w, contact.other]
            if one.awake != other.awake:
                one.awake, other.awake, changed = 1, 1, True


@function
def _seconds_known(state: State, w: int, count: int) -> float:
    """Return for how long [s] constant forces keep all gaps closed, up to a quarter of the tolerance; inf if for ever.

    Of a gap with first and second derivative 0 the third and fourth are, at the centre distance d of a circle,
    3 v_t a_t / d and 3 (a_t^2 + v_t^4 / d^2) / d, with what is along it: docs/physics.md, "Leave, hit or stay".
    """
    allowed, seconds = 0.25 * CLUSTER_GAP * state.scenes[state.worlds[w].scene].extent, math.inf
    for p in range(count):
        contact = state.contacts[w, p]
        if not state.members[w, contact.one].leans or (
            contact.other >= 0 and not state.members[w, contact.other].leans
        ):
            continue
        one, bend = state.balls[w, contact.one], abs(contact.curvature)
        opening, along = _relative_velocity(state, w, contact)
        ax, ay = one.ax, one.ay
        if contact.other >= 0:
            ax, ay = ax - state.balls[w, contact.other].ax, ay - state.balls[w, contact.other].ay
        opens = ax * contact.nx + ay * contact.ny + contact.curvature * along * along
        if opening < 0.0 or opens < 0.0:
            # Where next to no room is left for any force, or by rounding.
            root = math.sqrt(opening * opening + 2.0 * allowed * max(-opens, 0.0))
            seconds = min(seconds, 2.0 * allowed / (root + max(-opening, 0.0)))
        if contact.curvature == 0.0:
            continue
        pull, turn = ay * contact.nx - ax * contact.ny, along * along * bend
        # A force that is turned, see `_turn_forces`, pushes on what else its ball touches.
        third = 3.0 * abs(along * pull) * bend + 3.0 * contact.bears * bend * abs(along)
        fourth = 3.0 * (pull * pull + turn * turn) * bend
        if fourth > 0.0:
            seconds = min(seconds, LONGEST)
            while (third / 6.0 + fourth * seconds / 24.0) * (seconds * seconds * seconds) > allowed:
                seconds *= 0.5
    return seconds


@function
def _turn_forces(state: State, w: int, count: int, seconds: float) -> None:
    """Turn forces to the directions that they have in the middle of that time, so that they do no work of their own."""
    for p in range(count):
        contact = state.contacts[w, p]
        if contact.bears > 0.0 and contact.curvature != 0.0:
            _, along = _relative_velocity(state, w, contact)
            turn = contact.bears * contact.curvature * along * seconds
            ax, ay = -turn * contact.ny, turn * contact.nx
            _add_acceleration(state, w, contact.one, ax, ay)
            if contact.other >= 0:
                _add_acceleration(state, w, contact.other, -ax, -ay)


@function
def _add_acceleration(state: State, w: int, k: int, ax: float, ay: float) -> None:
    if state.members[w, k].leans and not state.members[w, k].fixed:
        state.balls[w, k].ax += ax
        state.balls[w, k].ay += ay


@function
def _bear(state: State, w: int, k: int, count: int) -> None:
    """Note what bears a member that is pressed on others, and log when that is something else than before."""
    ball, vx, vy = state.balls[w, k], state.members[w, k].x0, state.members[w, k].y0
    support, surface, most, still = -1, -1, 0.0, False
    elements = state.scenes[state.worlds[w].scene].elements
    for p in range(count):
        contact = state.contacts[w, p]
        if contact.bears == 0.0 or k not in (contact.one, contact.other):
            continue
        element = contact.element if contact.one == k else elements + contact.one
        still = still or element == ball.support
        if contact.other < 0 and (surface < 0 or contact.bears > state.contacts[w, surface].bears):
            surface = p
        if contact.bears > most:
            support, most = p, contact.bears
    if still or support < 0:
        _set_contact(state, w, k, surface, count)
        return
    contact, own = state.contacts[w, support], ball.support
    sign = 1.0 if contact.one == k else -1.0
    new_vx, new_vy = ball.vx, ball.vy
    if own >= 0:
        ball.vx, ball.vy = vx, vy
        append_contact(state, w, k, CONTACT_ENDS, Surface(own, ball.nx, ball.ny, 0.0, 0.0), vx, vy)
        ball.vx, ball.vy = new_vx, new_vy
    ball.support = contact.element if contact.one == k else elements + contact.one
    ux, uy = contact.ux, contact.uy
    if contact.other >= 0:
        other = state.balls[w, contact.other if contact.one == k else contact.one]
        ux, uy = other.vx, other.vy
    tells = Surface(ball.support, sign * contact.nx, sign * contact.ny, ux, uy)
    append_contact(state, w, k, CONTACT_BEGINS, tells, vx, vy)
    _set_contact(state, w, k, surface, count)


@function
def _set_contact(state: State, w: int, k: int, surface: int, count: int) -> None:
    """Let a member slide on the surface that bears most of it, if that is straight, or be borne by balls.

    Between two surfaces that stand it stays exactly where it is; two that translate carry it in one uniform motion.
    """
    ball = state.balls[w, k]
    ball.contact, ball.rides, ball.nx, ball.ny = ON_BALLS, -1, 0.0, 0.0
    if surface >= 0:
        contact = state.contacts[w, surface]
        ball.nx, ball.ny, ball.rides = contact.nx, contact.ny, contact.part
        if contact.part >= 0 and contact.curvature == 0.0:
            ball.contact = RIDING
        elif contact.face >= 0:
            ball.contact = contact.face
            ball.vx, ball.vy = _along(ball.vx, ball.vy, contact)
            ball.ax, ball.ay = _along(ball.ax, ball.ay, contact)
        other = _other_bearer(state, w, k, surface, count)
        if other >= 0:
            two = state.contacts[w, other]
            if contact.ux == contact.uy == two.ux == two.uy == 0.0:
                ball.vx, ball.vy, ball.contact = 0.0, 0.0, HELD
            if ball.contact == HELD or contact.curvature == two.curvature == 0.0:
                ball.ax, ball.ay = 0.0, 0.0
    if not state.members[w, k].awake:
        ball.contact = HELD


@function
def _along(x: float, y: float, contact: Record) -> tuple[float, float]:
    """Return what of a vector lies along a surface."""
    rate = y * contact.nx - x * contact.ny
    return -rate * contact.ny, rate * contact.nx


@function
def _other_bearer(state: State, w: int, k: int, surface: int, count: int) -> int:
    """Return another surface that bears a member, at an angle to the one that bears most of it; -1 if none does."""
    one = state.contacts[w, surface]
    for p in range(count):
        contact = state.contacts[w, p]
        turn = contact.nx * one.ny - contact.ny * one.nx
        if contact.one == k and contact.other < 0 and contact.bears > 0.0 and turn * turn > DEPENDENT:
            return p
    return -1


@function
def _plan(state: State, w: int, k: int, seconds: float) -> None:
    """Plan what a member meets next; one that is pressed on no other ball is resolved by itself."""
    ball, member = state.balls[w, k], state.members[w, k]
    ball.tolerance = ULPS_OF_LENGTH * state.scenes[state.worlds[w].scene].extent
    ball.settling = 0
    if not member.leans:
        keep_beside(state, w, k)
        schedule_resolve(ball)
        plan_pairs(state, w, k)
        return
    ball.settling = LEANS
    update_crossing_sides(state, w, k)
    schedule_standing(state, w, k)
    if member.awake and seconds < ball.hit_after:
        ball.hit_kind, ball.hit_after, ball.end_after = RESOLVE, seconds, seconds
    schedule_rest(state, w, k)
    plan_pairs(state, w, k)
