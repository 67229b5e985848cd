"""The reach of moving parts, and what a ball meets of them: zones, stops, and the hit while both keep their motion."""

import math

from bounce_env.engine.flight import dot, moved, sped, touch_tolerance
from bounce_env.engine.impact import capsule_time, falling_time
from bounce_env.engine.instant import before, later, since
from bounce_env.engine.jit import Feature, Record, Table, function


@function
def is_off(disabled: Table, w: int, element: int) -> bool:
    """Whether an element of world `w` is switched off."""
    if disabled is None:
        return False
    return disabled[w, element] != 0


@function
def zone_change(height: float, rate: float, pull: Feature, border: float, inside: bool, after: float) -> float:
    """When |height + rate t + pull t^2 / 2| next passes `border`, from the flight's start, no earlier than `after`."""
    best = math.inf
    for facing in (1.0, -1.0):
        gap = facing * height - border
        if inside:
            t = falling_time(-gap, gap > 0.0, -facing * rate, dot(pull, 0.0, -facing, 0.0))
        else:
            t = falling_time(gap, gap < 0.0, facing * rate, dot(pull, 0.0, facing, 0.0))
        if t >= after:
            best = min(best, t)
    return best


@function
def plan_zones(
    ball: Record,
    zones: Table,
    rails: Table,
    count: int,
    w: int,
    k: int,
    scene: int,
    gx: Feature,
    gy: Feature,
    now: float,
) -> None:
    """Bring the ball's zones up to `now` seconds into its flight, and set when the next of them changes.

    The zone of a paddle is the strip along its rail outside which it cannot be met. It is a static sensor of the
    engine's own: passing its border neither re-bases the flight nor shows in the ledger.
    """
    ball.zone_after = math.inf
    if rails is None or zones is None:
        return
    for m in range(count):
        rail, zone = rails[scene, m], zones[w, k, m]
        height = (ball.y - rail.y) * rail.ux - (ball.x - rail.x) * rail.uy
        # The margin keeps rounding of the border from hiding a hit.
        border = 1.01 * rail.reach
        if now == 0.0:
            zone.inside, zone.after = 1 if abs(height) <= border else 0, 0.0
        elif zone.after <= now:
            zone.inside = 1 - zone.inside
        if zone.after <= now:
            rate = ball.vy * rail.ux - ball.vx * rail.uy
            zone.after = zone_change(height, rate, dot(gx, gy, -rail.uy, rail.ux), border, zone.inside == 1, now)
            if zone.after > ball.end_after:
                zone.after = math.inf
        ball.zone_after = min(ball.zone_after, zone.after)


@function
def rail_offset(paddle: Record, hi: float, lo: float) -> float:
    """Where on its rail [m] the paddle is at an instant of its present motion."""
    return paddle.offset + paddle.velocity * since(hi, lo, paddle.hi, paddle.lo)


@function
def stop_instant(paddle: Record, rail: Record) -> tuple[float, float]:
    """Instant at which the paddle's present motion ends at a stop: (hi, lo), inf if it stands."""
    if paddle.velocity == 0.0:
        return math.inf, 0.0
    room = rail.span - paddle.offset if paddle.velocity > 0.0 else paddle.offset
    return later(paddle.hi, paddle.lo, room / abs(paddle.velocity))


@function
def meet_paddle(
    ball: Record, paddle: Record, rail: Record, extent: float, gx: Feature, gy: Feature
) -> tuple[float, float]:
    """Instant at which the ball hits the paddle while both keep their present motion: (hi, lo), inf if not.

    In the paddle's frame the ball flies as ever and the paddle is a standing capsule.
    """
    if before(ball.hi, ball.lo, paddle.hi, paddle.lo):
        hi, lo = paddle.hi, paddle.lo
    else:
        hi, lo = ball.hi, ball.lo
    t = since(hi, lo, ball.hi, ball.lo)
    stop_hi, stop_lo = stop_instant(paddle, rail)
    horizon = min(ball.end_after - t, since(stop_hi, stop_lo, hi, lo))
    offset = rail_offset(paddle, hi, lo)
    after = capsule_time(
        moved(ball.x, ball.vx, gx, t) - (rail.x + offset * rail.ux),
        moved(ball.y, ball.vy, gy, t) - (rail.y + offset * rail.uy),
        sped(ball.vx, gx, t) - paddle.velocity * rail.ux,
        sped(ball.vy, gy, t) - paddle.velocity * rail.uy,
        gx, gy, rail.ux, rail.uy, rail.half_width, rail.reach,
        touch_tolerance(extent, ball.vx, ball.vy, gx, gy, t), horizon,
    )  # fmt: skip
    if after == math.inf:
        return math.inf, 0.0
    return later(hi, lo, after)


@function
def plan_paddles(
    ball: Record,
    rails: Table,
    paddles: Table,
    zones: Table,
    disabled: Table,
    w: int,
    k: int,
    scene: int,
    count: int,
    extent: float,
    gx: Feature,
    gy: Feature,
) -> None:
    """Search the paddles in whose zone the ball is, and set which one it hits first, and when."""
    ball.part_hi, ball.part_lo, ball.part_index = math.inf, 0.0, -1
    if rails is None or paddles is None or zones is None:
        return
    for m in range(count):
        if zones[w, k, m].inside and not is_off(disabled, w, rails[scene, m].element):
            hi, lo = meet_paddle(ball, paddles[w, m], rails[scene, m], extent, gx, gy)
            if before(hi, lo, ball.part_hi, ball.part_lo):
                ball.part_hi, ball.part_lo, ball.part_index = hi, lo, m
