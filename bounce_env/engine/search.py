"""What a ball meets next, from its last event: standing elements, sensors, the reach of parts, moving parts.

Everything standing is searched once per flight and kept as a duration from the flight's start; the ball's search for a
moving part starts at the later of the ball's last event and the part's last command or stop. Neither depends on where
a step ends.
"""

import math

from bounce_env.engine.flight import dot, moved, pull, sped, swept, time_in_scene, touch_tolerance
from bounce_env.engine.impact import capsule_time, circle_time, face_time, facing_time, falling_time
from bounce_env.engine.instant import before, later, since
from bounce_env.engine.jit import Feature, Record, Table, function
from bounce_env.engine.layout import (
    NEXT_HIT,
    NEXT_PART,
    NEXT_SENSOR,
    NEXT_ZONE,
    ON_CIRCLE,
    ON_FACE,
    State,
    Tables,
)


@function
def side_on(sides: Table, w: int, k: int, i: int) -> int:
    """On which side, 1 or -1, of face `i` a touching ball of no radius is; 0 for a disc, whose centre tells."""
    if sides is None:
        return 0
    return sides[w, k, i]


@function
def first_face(
    ball: Record,
    faces: Table,
    count: int,
    sides: Table,
    w: int,
    k: int,
    scene: int,
    gx: Feature,
    gy: Feature,
    horizon: float,
) -> tuple[float, int]:
    """Earliest hit of a wall's straight part before `horizon`: (duration, face)."""
    best, index = horizon, -1
    if faces is None:
        return best, index
    for i in range(count):
        face = faces[scene, i]
        t = face_time(
            ball.x - face.x, ball.y - face.y, ball.vx, ball.vy, gx, gy,
            face.ux, face.uy, face.length, face.reach, side_on(sides, w, k, i), ball.slack, best,
        )  # fmt: skip
        if t < best:
            best, index = t, i
    return best, index


@function
def first_circle(
    ball: Record, circles: Table, count: int, scene: int, gx: Feature, gy: Feature, horizon: float
) -> tuple[float, int]:
    """Earliest hit of a bumper or a wall's end before `horizon`: (duration, circle).

    A circle that the box swept by the flight does not reach cannot be hit; most are rejected by that alone.
    """
    best, index = horizon, -1
    if circles is None:
        return best, index
    left, right = swept(ball.x, ball.vx, gx, horizon)
    below, above = swept(ball.y, ball.vy, gy, horizon)
    for i in range(count):
        circle = circles[scene, i]
        reach = circle.reach + ball.slack
        # Written so that a box with infinite or undefined borders (an unbounded flight) rejects nothing.
        if circle.x + reach < left or circle.x - reach > right or circle.y + reach < below or circle.y - reach > above:
            continue
        t = circle_time(ball.x - circle.x, ball.y - circle.y, ball.vx, ball.vy, gx, gy, circle.reach, ball.slack, best)
        if t < best:
            best, index = t, i
    return best, index


@function
def next_sensor(
    ball: Record,
    sensors: Table,
    count: int,
    sides: Table,
    w: int,
    k: int,
    scene: int,
    gx: Feature,
    gy: Feature,
    after: float,
    after_index: int,
) -> tuple[float, int]:
    """Earliest crossing of a sensor by the ball's centre later than the crossing (after, after_index), up to the hit.

    Crossings at one instant come in the order of the elements. Returns (duration, sensor).
    """
    best, index = math.inf, -1
    if sensors is None:
        return best, index
    for i in range(count):
        sensor = sensors[scene, i]
        x, y = ball.x - sensor.x, ball.y - sensor.y
        for facing in (1.0, -1.0):
            t = facing_time(
                x, y, ball.vx, ball.vy, gx, gy, sensor.ux, sensor.uy, sensor.length, 0.0,
                facing, sides[w, k, i], ball.slack, ball.end_after,
            )  # fmt: skip
            if t < best and (t > after or (t == after and i > after_index)):
                best, index = t, i
    return best, index


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
def plan_parts(state: State, tables: Tables, w: int, k: int) -> None:
    """Search the parts in whose zone a ball is, and set its next event."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = tables.scenes[scene]
    gx, gy = pull(tables.gravity, scene)
    _plan_paddles(ball, tables.rails, state.paddles, state.zones, w, k, scene, head.paddles, head.extent, gx, gy)
    schedule(ball)


@function
def _plan_paddles(
    ball: Record,
    rails: Table,
    paddles: Table,
    zones: Table,
    w: int,
    k: int,
    scene: int,
    count: int,
    extent: float,
    gx: Feature,
    gy: Feature,
) -> None:
    ball.part_hi, ball.part_lo, ball.part_index = math.inf, 0.0, -1
    if rails is None or paddles is None or zones is None:
        return
    for m in range(count):
        if zones[w, k, m].inside:
            hi, lo = meet_paddle(ball, paddles[w, m], rails[scene, m], extent, gx, gy)
            if before(hi, lo, ball.part_hi, ball.part_lo):
                ball.part_hi, ball.part_lo, ball.part_index = hi, lo, m


@function
def plan_sensor(state: State, tables: Tables, w: int, k: int, after: float, after_index: int) -> None:
    """Search the next crossing after (after, after_index) in the present flight, and set the ball's next event."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    gx, gy = pull(tables.gravity, scene)
    ball.sensor_after, ball.sensor_index = next_sensor(
        ball, tables.sensors, tables.scenes[scene].sensors, state.sensor_sides, w, k, scene, gx, gy,
        after, after_index,
    )  # fmt: skip
    schedule(ball)


@function
def plan_flight(state: State, tables: Tables, w: int, k: int) -> None:
    """Search everything for a flight that starts now: once per bounce."""
    ball, scene = state.balls[w, k], state.worlds[w].scene
    head = tables.scenes[scene]
    gx, gy = pull(tables.gravity, scene)
    horizon = time_in_scene(head.extent, ball.x, ball.y, ball.vx, ball.vy, gx, gy)
    after, face = first_face(ball, tables.faces, head.faces, state.face_sides, w, k, scene, gx, gy, horizon)
    ball.hit_kind, ball.hit_index = ON_FACE, face
    after, circle = first_circle(ball, tables.circles, head.circles, scene, gx, gy, after)
    if circle >= 0:
        ball.hit_kind, ball.hit_index = ON_CIRCLE, circle
    ball.end_after = after
    ball.hit_after = after if face >= 0 or circle >= 0 else math.inf
    ball.sensor_after, ball.sensor_index = next_sensor(
        ball, tables.sensors, head.sensors, state.sensor_sides, w, k, scene, gx, gy, -1.0, -1
    )
    plan_zones(ball, state.zones, tables.rails, head.paddles, w, k, scene, gx, gy, 0.0)
    plan_parts(state, tables, w, k)


@function
def schedule(ball: Record) -> None:
    """Set the ball's next event from what is kept. At one instant: zone, standing element, part, sensor."""
    hi, lo, kind = _instant_after(ball, ball.zone_after, NEXT_ZONE)
    hit_hi, hit_lo, _ = _instant_after(ball, ball.hit_after, NEXT_HIT)
    if before(hit_hi, hit_lo, hi, lo):
        hi, lo, kind = hit_hi, hit_lo, NEXT_HIT
    if before(ball.part_hi, ball.part_lo, hi, lo):
        hi, lo, kind = ball.part_hi, ball.part_lo, NEXT_PART
    sensor_hi, sensor_lo, _ = _instant_after(ball, ball.sensor_after, NEXT_SENSOR)
    if before(sensor_hi, sensor_lo, hi, lo):
        hi, lo, kind = sensor_hi, sensor_lo, NEXT_SENSOR
    ball.next_hi, ball.next_lo, ball.next_kind = hi, lo, kind


@function
def _instant_after(ball: Record, duration: float, kind: int) -> tuple[float, float, int]:
    if duration == math.inf:
        return math.inf, 0.0, kind
    hi, lo = later(ball.hi, ball.lo, duration)
    return hi, lo, kind
