"""Time of impact of a flying ball with a capsule: its two straight sides and its round ends."""

import math

from bounce_env.engine.compile.jit import Feature, routine
from bounce_env.engine.impact.circle import circle_time
from bounce_env.engine.impact.line import face_time


@routine
def capsule_time(
    x: float,
    y: float,
    vx: float,
    vy: float,
    gx: Feature,
    gy: Feature,
    ux: float,
    uy: float,
    back: float,
    front: float,
    reach: float,
    slack: float,
    horizon: float,
) -> float:
    """Hit of a capsule whose core runs from `back` to `front` [m] along the unit (ux, uy) through the origin."""
    bx, by, fx, fy = back * ux, back * uy, front * ux, front * uy
    t = face_time(x - bx, y - by, vx, vy, gx, gy, ux, uy, front - back, reach, 0, slack, horizon)
    t = min(t, circle_time(x - bx, y - by, vx, vy, gx, gy, reach, slack, min(t, horizon)))
    t = min(t, circle_time(x - fx, y - fy, vx, vy, gx, gy, reach, slack, min(t, horizon)))
    return t if t <= horizon else math.inf
