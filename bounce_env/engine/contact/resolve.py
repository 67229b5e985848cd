"""What a ball does at an instant: it bounces from all that it touches, then it flies, slides or rests.

Ever smaller bounces that lead to a contact with a straight surface are summed in closed form (docs/physics.md,
"Infinitely many bounces").
"""

from bounce_env.engine.compile.jit import Record, function
from bounce_env.engine.contact.bounces import GOES_ON, bounce_from_all, take_soft
from bounce_env.engine.contact.cluster import resolve_cluster
from bounce_env.engine.contact.hits import count_bounce, surface_of
from bounce_env.engine.contact.resting import bear, find_contact, is_slow
from bounce_env.engine.contact.restitution import (
    along_speed,
    closing_speed,
    is_sliding_curve,
    is_soft,
    normal_load,
    push_off,
    slow_speed,
)
from bounce_env.engine.contact.sides import update_crossing_sides
from bounce_env.engine.contact.smallest_rebound import leave_part
from bounce_env.engine.contact.touching import collect_touches, keep_outside_touched
from bounce_env.engine.detect.pairs import is_pressed_by_balls, plan_pairs
from bounce_env.engine.detect.schedule import schedule_resolve, schedule_rest, schedule_standing
from bounce_env.engine.memory.ledger import Surface, append_contact
from bounce_env.engine.memory.lookup import is_doomed
from bounce_env.engine.memory.records import (
    CARRIED_ALONG,
    CONTACT_BEGINS,
    CONTACT_ENDS,
    CRUSHED,
    FLYING,
    HELD,
    NEXT_PART,
    ON_CURVE,
    RESOLVE,
    RIDING,
    SETTLES,
)
from bounce_env.engine.memory.state import State
from bounce_env.engine.tolerances import (
    BOUNCES_WITHOUT_ROOM,
    CORNER,
    STANDING,
    ULPS_OF_LENGTH,
)

NOT_PLANNED = -2.0


@function
def resolve(state: State, w: int, k: int, at_once: bool) -> None:
    """Bounce a ball from all that it touches, decide what it does next, and plan that.

    at_once: whether its flight has ended where it began, by something that it was to hit.
    """
    ball = state.balls[w, k]
    if is_doomed(state, w, k):
        ball.status = CRUSHED
        return
    if is_pressed_by_balls(state, w, k):
        resolve_cluster(state, w, k)
        return
    if abs(ball.vx) + abs(ball.vy) < STANDING:
        ball.vx, ball.vy = 0.0, 0.0
    extent = state.scenes[state.worlds[w].scene].extent
    if ball.confined > BOUNCES_WITHOUT_ROOM or (state.gravity is not None and is_slow(ball, extent)):
        # Between several surfaces the last bounces go to and fro: what lies within their reach counts as touched.
        ball.tolerance = max(ball.tolerance, CORNER * ULPS_OF_LENGTH * extent)
    contact, support, settling = ball.contact, ball.support, ball.settling
    ball.settling = 0
    collect_touches(state, w, k)
    if state.parts is not None:
        keep_outside_touched(ball, state.touches, w)
    if settling == SETTLES:
        contact, support = FLYING, -1  # that contact had not begun yet
    duration = _resolve_bounces(state, w, k, contact, support, at_once)
    if duration == NOT_PLANNED:
        return
    if duration >= 0.0:
        ball.hit_kind, ball.hit_after, ball.end_after = RESOLVE, duration, duration
    schedule_rest(state, w, k)
    plan_pairs(state, w, k)


@function
def _resolve_bounces(state: State, w: int, k: int, contact: int, support: int, at_once: bool) -> float:
    """Bounce a ball from all that it touches, let it fly, slide or rest, and search what stands in its way.

    contact, support: those that it came with.
    Returns after how long [s] it is to be looked at again because its last bounces are summed up to then, otherwise -1;
    NOT_PLANNED where it is crushed, or goes on bouncing at this instant.
    """
    ball, bounces = state.balls[w, k], state.worlds[w].bounces
    if at_once and state.gravity is not None:
        take_soft(ball, state.touches, w, state.scenes[state.worlds[w].scene].extent)
    single, corner, vx0, vy0 = bounce_from_all(state, w, k)
    if corner == GOES_ON:
        schedule_resolve(ball)
    if corner == GOES_ON or ball.status == CRUSHED:
        return NOT_PLANNED
    _resolve_release(ball)
    if state.gravity is not None or state.arcs is not None:
        # Told at once of a hit of something that it does not close on, a ball that rides on a part, or slides into one,
        # would be so for ever: it leaves with the smallest rebound.
        slides_in = (contact >= 0 or contact == ON_CURVE) and ball.next_kind == NEXT_PART
        rides = contact in (RIDING, CARRIED_ALONG)
        again = (rides or slides_in) and at_once and state.worlds[w].bounces == bounces
        vx, vy = ball.vx, ball.vy
        _end_hops_on_curves(state, w, k)
        i = _resolve_contact(state, w, k, contact, support, again, vx0, vy0)
        if i < 0 and ball.contact == FLYING:
            ball.vx, ball.vy = vx, vy
        corner = corner if i < 0 else -1
    if corner >= 0:
        count_bounce(state, w, k, state.touches[w, corner], vx0, vy0)
    # Where something closes on it, a ball without room is bounced from a corner at once, for ever.
    met_nothing = state.worlds[w].bounces == bounces or ball.confined > BOUNCES_WITHOUT_ROOM
    if ball.contact == FLYING:
        leave_part(state, w, k, at_once and met_nothing)
    update_crossing_sides(state, w, k)
    vx, vy, duration = ball.vx, ball.vy, -1.0
    if state.gravity is not None and single >= 0 and ball.contact == FLYING:
        duration = _resolve_settling(state, w, k, single)
    for _ in range(2):
        schedule_standing(state, w, k)
        if duration < 0.0 or ball.hit_after > duration:
            break
        # Something comes before the bounces are over: they go on one by one.
        _resolve_release(ball)
        ball.vx, ball.vy, ball.settling, duration = vx, vy, 0, -1.0
    return duration


@function
def _end_hops_on_curves(state: State, w: int, k: int) -> None:
    """Take from the velocity of a ball what leaves a curve that presses it in hops which rise above no tolerance.

    Where friction acts on each of them they go on until they are no way along the curve, either.
    """
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = state.scenes[scene]
    for i in range(ball.touched):
        touch = state.touches[w, i]
        material, leaving, press = state.elements[scene, touch.element], -closing_speed(ball, touch), 0.0
        if is_sliding_curve(touch) and leaving > slow_speed(ball, touch):
            press = normal_load(ball, touch)
        if press > 0.0 and is_soft(leaving, press, head.extent):
            way = abs(along_speed(ball, touch)) * 2.0 * leaving / press
            if material.f == 1.0 or head.rest_speed > 0.0 or way <= (1.0 - material.b * material.f) * ball.tolerance:
                push_off(ball, touch, -leaving)


@function
def _resolve_contact(
    state: State, w: int, k: int, contact: int, support: int, off: bool, vx: float, vy: float,
) -> int:  # fmt: skip
    """Find the ball's contact, if it is not to fly `off`; log the end of the one that it had, the beginning of another.

    (vx, vy): its velocity [m/s] before. Returns which touched surface a new contact is with, -1 if there is none.
    """
    ball = state.balls[w, k]
    i = -1 if off else find_contact(state, w, k)
    stopped = ball.contact == HELD and (vx != ball.vx or vy != ball.vy)  # held again, after a push
    let_go = i >= 0 and ball.contact == FLYING  # friction has taken all that pressed it
    if ball.contact == contact and ball.support == support and not (stopped or let_go):
        return -1
    if support >= 0:
        _log_end(state, w, k, support, vx, vy)
    if i >= 0:
        touch = state.touches[w, i]
        ball.nx, ball.ny = touch.nx, touch.ny
        append_contact(state, w, k, CONTACT_BEGINS, surface_of(touch), vx, vy)
        if let_go:
            _log_end(state, w, k, touch.element, ball.vx, ball.vy)
    return i


@function
def _resolve_release(ball: Record) -> None:
    ball.contact, ball.rides, ball.support = FLYING, -1, -1
    ball.ax, ball.ay = ball.gx, ball.gy


@function
def _resolve_settling(state: State, w: int, k: int, single: int) -> float:
    """Sum the bounces still to come on a wall, if they rise above no tolerance; returns how long they take [s], or -1.

    With hops of durations tau, b tau, b^2 tau ... they end after tau / (1 - b); meanwhile the ball is on the wall. With
    f = 1 it slides as ever. With f < 1 it comes to stand; until then it is shown in uniform motion to where.
    """
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head, touch = state.scenes[scene], state.touches[w, single]
    material = state.elements[scene, touch.element]
    press, rebound, b, f = normal_load(ball, touch), -closing_speed(ball, touch), material.b, material.f
    if touch.curvature != 0.0 or touch.moves or head.rest_speed > 0.0 or not 0.0 < b < 1.0:
        return -1.0
    if press == 0.0 or not is_soft(rebound, press, head.extent):
        return -1.0
    ux, uy = touch.ny, -touch.nx
    hop = 2.0 * rebound / press
    duration = hop / (1.0 - b)
    speed = (ball.vx - touch.ux) * ux + (ball.vy - touch.uy) * uy
    pull = ball.gx * ux + ball.gy * uy
    if f < 1.0:
        way = speed * hop / (1.0 - f * b)
        way += pull * hop * hop * (1.0 + f * b) / (2.0 * (1.0 - f * b) * (1.0 - b * b))
        speed, pull = way / duration, 0.0
    ball.vx, ball.vy, ball.ax, ball.ay = touch.ux + speed * ux, touch.uy + speed * uy, pull * ux, pull * uy
    bear(ball, touch)
    ball.nx, ball.ny, ball.settling = touch.nx, touch.ny, SETTLES
    return duration


@function
def _log_end(state: State, w: int, k: int, support: int, vx: float, vy: float) -> None:
    """The end of a contact changes no velocity: what does so has rows of its own."""
    ball = state.balls[w, k]
    new_vx, new_vy, ux, uy = ball.vx, ball.vy, 0.0, 0.0
    for i in range(ball.touched):
        if state.touches[w, i].element == support:
            ux, uy = state.touches[w, i].ux, state.touches[w, i].uy
    ball.vx, ball.vy = vx, vy
    append_contact(state, w, k, CONTACT_ENDS, Surface(support, ball.nx, ball.ny, ux, uy), vx, vy)
    ball.vx, ball.vy = new_vx, new_vy
