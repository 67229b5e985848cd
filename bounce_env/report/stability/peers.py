"""What other engines do on a hard case: where they have the ball at its end."""

import math
from collections.abc import Callable
from importlib import import_module

import numpy as np

from bounce_env.report.methods.tutorial import TutorialPoint
from bounce_env.report.stability.case import Case, Point
from bounce_env.scene import Field, SceneError, Sensor, Wall

PER_SECOND = 960
"""Steps a second of all of them, or a few more, so that a whole number of them makes the case's duration."""

RIGHT = 1e-9
"""A distance from the right place up to which it is called right, as a share of the scene's size."""

LOST = 10.0
"""A distance from the right place from which on the ball is called lost, in sizes of the scene."""


def outcome(peer: str, case: Case, right: Point | None, most_steps: int) -> str:
    """Return in words where a peer has the ball at the end of a case, or why it cannot play it.

    right: where the ball has to be; None where the case is refused. most_steps: a run of more is not made.
    """
    if right is None:
        return "not applicable: nothing to compare"
    reason = _why_not(peer, case)
    steps = 0.0 if reason else sum(step for step in case.script if isinstance(step, float | int)) * PER_SECOND
    if steps > most_steps:
        reason = f"not run: {steps:.1g} steps"
    if reason:
        return reason
    play: dict[str, Callable[[Case], Point]] = {"pymunk": _pymunk, "box2d": _box2d, "tutorial": _tutorial}
    try:
        place = play[peer](case)
    except ModuleNotFoundError as error:
        return f"not measured: {error.name} is not installed"
    except SceneError:
        return "not applicable: walls moved in by the ball's radius leave no room"
    except Exception as error:  # of the peer
        return f"failed: {type(error).__name__}"
    distance = math.dist(place, right) / _size(case)
    if math.isnan(distance) or distance > LOST:
        return "lost"
    return "right" if distance <= RIGHT else f"off by {100.0 * distance:.2g} %"


def _size(case: Case) -> float:
    """Return the longer side of what the scene occupies [m], of a ball where it is empty."""
    x0, y0, x1, y1 = case.scene.bounds
    return max(x1 - x0, y1 - y0, case.scene.ball.radius, 1e-300)


def _why_not(peer: str, case: Case) -> str:
    scene = case.scene
    solid = [e for e in scene.elements if not isinstance(e, Sensor | Field)]
    if len(solid) < len(scene.elements) and any(isinstance(e, Field) for e in scene.elements):
        return "not applicable: has no fields"
    if any(not isinstance(step, float | int) and step[0] != "push" for step in case.script):
        return "not applicable: commands"
    if any(e.f * scene.ball.f < 1.0 for e in solid) and peer != "tutorial":
        return "not applicable: its friction is Coulomb's"
    if scene.rest_speed > 0.0:
        return "not applicable: has no rest_speed"
    if peer == "tutorial":
        extras = any(not isinstance(e, Wall) or e.one_way or e.draggable or e.kick for e in scene.elements)
        if extras or scene.max_speed is not None or len(case.script) > 1:
            return "not applicable: has walls only"
        if any(wall.b * scene.ball.b > 1.0 for wall in solid):
            return "not applicable: has no cap"
    if peer == "box2d" and scene.ball.radius == 0.0:
        return "not applicable: has no points"
    return ""


def _steps(seconds: float) -> tuple[int, float]:
    """Return into how many steps a duration is cut, and how long each is: at most 1 / PER_SECOND [s]."""
    count = max(1, math.ceil(seconds * PER_SECOND))
    return count, seconds / count


def _pymunk(case: Case) -> Point:
    peer = import_module("bounce_env.report.methods.pymunk_space").PymunkScene(case.scene)
    peer.ball.position, peer.ball.velocity = case.position, case.velocity
    for step in case.script:
        if isinstance(step, tuple):
            peer.ball.velocity += step[1]
        else:
            count, dt = _steps(step)
            for _ in range(count):
                peer.step(dt)
    x, y = peer.ball.position
    return float(x), float(y)


def _box2d(case: Case) -> Point:
    (gx, gy), size = case.scene.gravity, _size(case)
    top_speed = math.hypot(*case.velocity) + math.sqrt(2.0 * math.hypot(gx, gy) * size) + 1e-3 * size
    module = import_module("bounce_env.report.methods.box2d_world")
    scale = module.best_scale(top_speed, PER_SECOND)
    peer = module.Box2DScene(case.scene, scale)
    peer.place(case.position, case.velocity)
    now = 0.0
    for step in case.script:
        if isinstance(step, tuple):
            vx, vy = peer.ball.linearVelocity
            peer.ball.linearVelocity = (vx + step[1][0] * scale, vy + step[1][1] * scale)
        else:
            count, dt = _steps(step)
            for _ in range(count):
                peer.step(dt, now)
                now += dt
    x, y, _, _ = peer.now()
    return x, y


def _tutorial(case: Case) -> Point:
    point = TutorialPoint(case.scene, case.position, case.velocity)
    (seconds,) = case.script
    assert not isinstance(seconds, tuple)
    count, dt = _steps(seconds)
    point.tick(dt, count, np.zeros(1))
    x, y, _, _ = point.ball.tolist()
    return x, y
