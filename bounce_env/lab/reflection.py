"""The tutorial's first example: a movement vector and a wall, and the movement after the bounce, number by number."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from pydantic import TypeAdapter

from bounce_env.engine.tutorial import Pair, Vector, meeting, reflect
from bounce_env.lab.messages import Message, Point, Share, ZeroOrMore, read
from bounce_env.lab.ready import Ready


class Reflect(Message):
    """Two ends of each, metres; b and f of both, and the ball's radius [m]."""

    do: Literal["reflect"]
    movement: tuple[Point, Point]
    wall: tuple[Point, Point]
    movement_b: ZeroOrMore
    movement_f: Share
    wall_b: ZeroOrMore
    wall_f: Share
    radius: ZeroOrMore


_MESSAGES: TypeAdapter[Reflect] = TypeAdapter(Reflect)


class Reflection:
    """Answers with every number of the tutorial's formulas, as `engine.tutorial` computes them."""

    def __init__(self, *, folder: Path, scene: str | None, ready: Ready) -> None:
        del folder, scene, ready  # of other rooms

    def answer(self, text: str) -> Mapping[str, Any]:
        """Return the bounce that a message asks for; raises ValueError for a vector without a length."""
        return explained(read(_MESSAGES, text))

    def close(self) -> None:
        """Nothing has begun."""


def explained(asked: Reflect) -> dict[str, Any]:
    """Return the bounce: vectors as [x, y], the rest as numbers; `ip` and `share` are None where nothing is hit."""
    v1 = _vector("movement", asked.movement, asked.movement_b, asked.movement_f)
    v2 = _vector("wall", asked.wall, asked.wall_b, asked.wall_f)
    found, share = reflect(v1, v2), meeting(v1, v2, asked.radius)
    ip = None if share is None else (v1.p0[0] + share * v1.vx, v1.p0[1] + share * v1.vy)
    rest = None if share is None else 1.0 - share
    return {
        "v1": _numbers(v1),
        "v2": {**_numbers(v2), "lx": v2.lx, "ly": v2.ly},
        "dp1": found.dp1,
        "proj1": found.proj1,
        "dp2": found.dp2,
        "proj2": found.proj2,
        "new": found.movement,
        "new_len": math.hypot(*found.movement),
        "new_angle": _angle(found.movement),
        "printed": _as_printed(v1, v2),
        "ip": ip,
        "share": share,
        "rest": rest,
        "end": None
        if ip is None or rest is None
        else (ip[0] + rest * found.movement[0], ip[1] + rest * found.movement[1]),
    }


def _vector(name: str, ends: tuple[Point, Point], b: float, f: float) -> Vector:
    (x0, y0), (x1, y1) = ends
    vector = Vector((x0, y0), x1 - x0, y1 - y0, b, f)
    if vector.len == 0.0:
        raise ValueError(f"{name} = {ends}: its ends must be apart, for it has no direction")
    return vector


def _numbers(v: Vector) -> dict[str, Any]:
    return {"vx": v.vx, "vy": v.vy, "len": v.len, "dx": v.dx, "dy": v.dy, "angle": _angle((v.vx, v.vy))}


def _angle(vector: Pair) -> float:
    """Return the direction of a vector in degrees from the x axis, counter-clockwise."""
    return math.degrees(math.atan2(vector[1], vector[0]))


def _as_printed(v1: Vector, v2: Vector) -> Pair:
    """Return the movement after the bounce as the formulas stand in print, without b and f.

    They divide by the wall's length once where they must do so twice: the result is `v2.len` times too long.
    """
    dp1, dp2 = v1.vx * v2.vx + v1.vy * v2.vy, v1.vx * v2.lx + v1.vy * v2.ly
    proj1 = dp1 * v2.dx, dp1 * v2.dy
    proj2 = dp2 * (v2.lx / v2.len), dp2 * (v2.ly / v2.len)
    return proj1[0] - proj2[0], proj1[1] - proj2[1]
