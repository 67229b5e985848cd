"""The nearest vectors that obey all contacts: what balls of equal mass do that press on each other and on surfaces.

Each ball has a vector x in the plane (a displacement, a velocity or an acceleration), each contact asks for
n.(x_one - x_other) >= target. The nearest ones to the x0 given are unique; they are x0 + sum of force n, with forces
that push only (>= 0) and only where the contact holds exactly. So momentum is kept whatever the forces.

Found by the dual active-set method of Goldfarb and Idnani ("A numerically stable dual method for solving strictly
convex quadratic programs", Mathematical Programming 27, 1983): finite, exact up to rounding, and it tells where nothing
obeys all. The products of the active contacts are kept as a Cholesky factor; one that depends on these is not in it.
"""

import math

from bounce_env.engine.compile.jit import function, routine
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import DEPENDENT


@routine
def project(state: State, w: int, count: int, slack: float) -> bool:
    """Move the members' x from x0 so that all of the first `count` contacts are obeyed, each up to `slack`.

    Returns whether that is possible; where it is not, those that cannot be are left out, and all that together leave no
    way `opposes`.
    """
    for i in range(state.members.shape[1]):
        state.members[w, i].x, state.members[w, i].y = state.members[w, i].x0, state.members[w, i].y0
    for p in range(count):
        state.contacts[w, p].force, state.contacts[w, p].slot, state.contacts[w, p].opposes = 0.0, -1, 0
    active, possible = 0, True
    for p in range(count):
        if state.contacts[w, p].keeps:
            now = _enforce(state, w, p, active)
            possible = possible and (now >= 0 or abs(_rate(state, w, p) - state.contacts[w, p].target) <= slack)
            active = max(now, active)
    for _ in range(16 * count):
        p = _most_violated(state, w, count, slack)
        if p < 0:
            break
        now = _enforce(state, w, p, active)
        if now < 0:
            state.contacts[w, p].slot, possible = -2, False
            now = -1 - now
        active = now
    for p in range(count):
        state.contacts[w, p].slot = max(state.contacts[w, p].slot, -1)
    _sum_forces(state, w, count)
    return possible


@function
def _most_violated(state: State, w: int, count: int, slack: float) -> int:
    """Return the contact that is missed by most, -1 where none is by more than `slack`."""
    worst, index = -slack, -1
    for p in range(count):
        contact = state.contacts[w, p]
        if contact.slot == -1 and not contact.keeps:
            miss = _rate(state, w, p) - contact.target
            if miss < worst:
                worst, index = miss, p
    return index


@function
def _rate(state: State, w: int, p: int) -> float:
    """Return n.(x_one - x_other)."""
    contact = state.contacts[w, p]
    one = state.members[w, contact.one]
    x, y = one.x, one.y
    if contact.other >= 0:
        other = state.members[w, contact.other]
        x, y = x - other.x, y - other.y
    rate: float = x * contact.nx + y * contact.ny
    return rate


@function
def _shift(state: State, w: int, p: int, amount: float) -> None:
    """Let contact `p` push with another `amount`."""
    contact = state.contacts[w, p]
    one = state.members[w, contact.one]
    if not one.fixed:
        one.x, one.y = one.x + amount * contact.nx, one.y + amount * contact.ny
    if contact.other >= 0:
        other = state.members[w, contact.other]
        if not other.fixed:
            other.x, other.y = other.x - amount * contact.nx, other.y - amount * contact.ny


@function
def _product(state: State, w: int, p: int, q: int) -> float:
    """Return how much the rate of contact `p` changes when contact `q` pushes with 1."""
    one, other = state.contacts[w, p], state.contacts[w, q]
    weight = 0.0
    if one.one == other.one and not state.members[w, one.one].fixed:
        weight += 1.0
    if one.other >= 0 and one.other == other.other and not state.members[w, one.other].fixed:
        weight += 1.0
    if one.other == other.one and not state.members[w, other.one].fixed:
        weight -= 1.0
    if one.one == other.other and not state.members[w, one.one].fixed:
        weight -= 1.0
    product: float = weight * (one.nx * other.nx + one.ny * other.ny)
    return product


@routine
def _enforce(state: State, w: int, p: int, active: int) -> int:
    """Let contact `p` push until it is obeyed, those in its way let go; return how many are active then.

    -1 minus that number where nothing obeys it and the active ones.
    """
    contact, before = state.contacts[w, p], active
    own = _product(state, w, p, p)
    for i in range(active):
        row = state.actives[w, i]
        row.was, row.force = row.contact, state.contacts[w, row.contact].force
    while True:
        free = _solve_against(state, w, p, active, own)
        t = math.inf
        if free > DEPENDENT * own and active < state.actives.shape[1]:
            t = (contact.target - _rate(state, w, p)) / free
        full, blocking = t, -1
        for i in range(active):
            row = state.actives[w, i]
            other = state.contacts[w, row.contact]
            if not other.keeps and row.step > DEPENDENT and other.force < t * row.step:
                t, blocking = other.force / row.step, i
        if t == math.inf:
            contact.opposes = 1
            for i in range(active):
                if state.actives[w, i].step < -DEPENDENT:
                    state.contacts[w, state.actives[w, i].contact].opposes = 1
            _restore(state, w, p, before, active)
            return -1 - before
        contact.force += t
        for i in range(active):
            row = state.actives[w, i]
            state.contacts[w, row.contact].force -= t * row.step
            if full != math.inf:
                _shift(state, w, row.contact, -t * row.step)
        if full != math.inf:
            _shift(state, w, p, t)
        if blocking < 0:
            _append(state, w, p, active, free)
            return active + 1
        _drop(state, w, blocking, active)
        active -= 1


@function
def _restore(state: State, w: int, p: int, before: int, active: int) -> None:
    """Let forces be again as they were before contact `p` was tried, if others have had to let go for it."""
    if before == active:
        return
    state.contacts[w, p].force = 0.0
    for i in range(before):
        row = state.actives[w, i]
        other = state.contacts[w, row.was]
        other.force = row.force
        free = _solve_against(state, w, row.was, i, _product(state, w, row.was, row.was))
        _append(state, w, row.was, i, free)


@function
def _solve_against(state: State, w: int, p: int, active: int, own: float) -> float:
    """Solve how the active contacts give way where `p` pushes with 1, and return what is left free of its rate."""
    free = own
    for i in range(active):
        total = _product(state, w, state.actives[w, i].contact, p)
        for j in range(i):
            total -= state.factors[w, i, j] * state.actives[w, j].product
        product = total / state.factors[w, i, i]
        state.actives[w, i].product = product
        free -= product * product
    for n in range(active):
        i = active - 1 - n
        total = state.actives[w, i].product
        for j in range(i + 1, active):
            total -= state.factors[w, j, i] * state.actives[w, j].step
        state.actives[w, i].step = total / state.factors[w, i, i]
    return free


@function
def _append(state: State, w: int, p: int, active: int, free: float) -> None:
    for i in range(active):
        state.factors[w, active, i] = state.actives[w, i].product
    state.factors[w, active, active] = math.sqrt(free)
    state.actives[w, active].contact, state.contacts[w, p].slot = p, active


@function
def _drop(state: State, w: int, slot: int, active: int) -> None:
    """Take the contact in a slot out of the active ones, and factor those behind it anew."""
    gone = state.contacts[w, state.actives[w, slot].contact]
    gone.force, gone.slot = 0.0, -1
    for i in range(slot, active - 1):
        p = state.actives[w, i + 1].contact
        free = _solve_against(state, w, p, i, _product(state, w, p, p))
        _append(state, w, p, i, free)


@function
def _sum_forces(state: State, w: int, count: int) -> None:
    """Set x to x0 plus what all forces together give: what could not be obeyed may have taken over a part of them."""
    for i in range(state.members.shape[1]):
        state.members[w, i].x, state.members[w, i].y = state.members[w, i].x0, state.members[w, i].y0
    for p in range(count):
        if state.contacts[w, p].force != 0.0:
            _shift(state, w, p, state.contacts[w, p].force)
