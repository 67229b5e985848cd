"""Part 1: error against run time, every method on every problem, and what becomes of energy and order in long runs."""

import math
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from bounce_env.report.measure import cost_of, error_of, right_bounces, spread
from bounce_env.report.methods.base import Method, Setting, Trace
from bounce_env.report.model import ErrorRow, LongRow
from bounce_env.report.problems import Problem
from bounce_env.report.truths import Start, Truth
from bounce_env.scene import Scene

Floats = npt.NDArray[np.float64]
R = TypeVar("R", ErrorRow, LongRow)


@dataclass(frozen=True)
class Plan:
    """How much is measured.

    starts: of a chaotic problem. shortest: CPU seconds for which one start is timed at least. bounces: of long runs.
    longer: how many times as long as the problem lasts the order of bounces is compared.
    """

    seed: int
    starts: int
    shortest: float
    bounces: int
    longer: int
    quick: bool


REGULAR = 8
"""Starts of a problem that is not chaotic: one goes much like another."""


LONG = ("elastic_box", "gravity_box", "circle")
"""Problems in which energy is kept."""

ORDERED = ("box", "bumper_field")
"""Problems in which an error grows until the order of bounces is wrong."""

Measure = Callable[[Problem, Method, Setting, Plan], ErrorRow | LongRow]


@cache
def solved(which: Problem, count: int, seed: int) -> tuple[list[Start], list[Truth]]:
    """Return starts of a problem with their truths, but for those that end before anything can be compared."""
    pairs = [(start, which.solve(start)) for start in which.starts(count, seed)]
    kept = [(start, truth) for start, truth in pairs if len(truth.frames)]
    return [start for start, _ in kept], [truth for _, truth in kept]


def jobs(methods: Sequence[Method], problems: Sequence[Problem], plan: Plan) -> list[tuple[str, Measure, Any]]:
    """Return what has to be measured: a name, a function and its arguments."""
    found: list[tuple[str, Measure, Any]] = []
    for which in problems:
        for method in methods:
            settings = method.quick if plan.quick else method.settings
            for setting in settings if method.why_not(which) is None else settings[:1]:
                name = f"{which.name} {method.name} {setting.label}"
                found.append((f"error {name}", measure_errors, (which, method, setting, plan)))
            middle = settings[len(settings) // 2]
            for kind, measure, of in (("energy", measure_energy, LONG), ("order", measure_order, ORDERED)):
                if which.name in of:
                    found.append((f"{kind} {which.name} {method.name}", measure, (which, method, middle, plan)))
    return found


def measure_errors(which: Problem, method: Method, setting: Setting, plan: Plan) -> ErrorRow:
    """Measure one point of the diagrams."""
    return _row(ErrorRow, _errors, which, method, setting, plan)


def measure_energy(which: Problem, method: Method, setting: Setting, plan: Plan) -> LongRow:
    """Measure which share of its energy a ball has gained or lost after many bounces."""
    return _row(LongRow, _energy_kept, which, method, setting, plan)


def measure_order(which: Problem, method: Method, setting: Setting, plan: Plan) -> LongRow:
    """Measure how many bounces come in the right order before the first wrong one."""
    return _row(LongRow, _order_kept, which, method, setting, plan)


def _row(
    kind: type[R],
    measure: Callable[[Problem, Method, Setting, Plan], dict[str, Any]],
    which: Problem,
    method: Method,
    setting: Setting,
    plan: Plan,
) -> R:
    """Return what is measured as a row, or the reason why nothing is: one method that fails does not end the others."""
    where: dict[str, Any] = {"problem": which.name, "method": method.name, "setting": setting.label}
    reason = method.why_not(which)
    if reason is None and kind is LongRow and method.slower == 0:
        reason = "as another line, to the bit"
    if reason is not None:
        return kind(**where, reason=reason)
    try:
        return kind(**where, **measure(which, method, setting, plan))
    except Exception as error:
        return kind(**where, reason=f"failed: {type(error).__name__}: {error}")


def _errors(which: Problem, method: Method, setting: Setting, plan: Plan) -> dict[str, Any]:
    starts, truths = solved(which, plan.starts if which.chaotic else min(plan.starts, REGULAR), plan.seed)
    player = method.player(which, setting, max(truth.top_speed for truth in truths))
    runs = [(player.trace(start, truth.frames), truth) for start, truth in zip(starts, truths, strict=True)]
    compared = [(t.order, truth.order) for t, truth in runs if t.order is not None and truth.order is not None]
    return {
        "error": spread(error_of(t, truth, chaotic=which.chaotic) for t, truth in runs),
        "cost": cost_of(player, starts, truths, plan.shortest),
        "wrong_order": sum(seen != right for seen, right in compared) / len(compared) if compared else None,
        "missed": sum(max(0, len(right) - len(seen)) for seen, right in compared) if compared else None,
        "lost": sum(_is_lost(which.scene, t, truth) for t, truth in runs) / len(runs),
        "starts": len(starts),
    }


def _is_lost(scene: Scene, trace: Trace, truth: Truth) -> bool:
    """Return whether the ball has no place, or is where it can only be by having passed through something.

    That is: outside of the box around the scene, by more than its diameter, while it should be inside; or farther from
    the right place than that box is large.
    """
    if not np.isfinite(trace.places).all():
        return True
    left, bottom, right, top = scene.bounds
    margin = 2.0 * scene.ball.radius

    def outside(places: Floats, by: float) -> Any:
        x, y = places.T
        return (x < left - by) | (x > right + by) | (y < bottom - by) | (y > top + by)

    far = np.hypot(*(trace.places - truth.places).T) > np.hypot(right - left, top - bottom)
    return bool((far | (outside(trace.places, margin) & ~outside(truth.places, 0.0))).any())


def _energy_kept(which: Problem, method: Method, setting: Setting, plan: Plan) -> dict[str, Any]:
    (start, *_), (truth, *_) = solved(which, min(plan.starts, REGULAR), plan.seed)
    player = method.player(which, setting, truth.top_speed)
    assert truth.order is not None
    frames = math.ceil(max(100, plan.bounces // method.slower) / len(truth.order) * truth.frames[-1])
    trace = player.trace(start, np.array([frames]))
    before = _energy(which.scene, start.position, start.velocity)
    x, y = trace.places[-1].tolist()
    change = _energy(which.scene, (x, y), trace.velocity) - before
    at_rest = _energy(which.scene, (0.0, which.scene.bounds[1]), (0.0, 0.0))
    return {"energy": abs(change) / (before - at_rest), "bounces": None if trace.order is None else len(trace.order)}


def _energy(scene: Scene, position: tuple[float, float], velocity: tuple[float, float]) -> float:
    """Return the energy of a ball of 1 kg [J]."""
    (x, y), (vx, vy), (gx, gy) = position, velocity, scene.gravity
    return 0.5 * (vx * vx + vy * vy) - gx * x - gy * y


def _order_kept(which: Problem, method: Method, setting: Setting, plan: Plan) -> dict[str, Any]:
    longer = replace(which, frames=plan.longer * which.frames)
    starts, truths = solved(longer, min(plan.starts, 5), plan.seed)
    player = method.player(longer, setting, max(truth.top_speed for truth in truths))
    counts = [
        right_bounces(player.trace(start, truth.frames).order or (), truth.order or ())
        for start, truth in zip(starts, truths, strict=True)
    ]
    there_are = statistics.median(len(truth.order or ()) for truth in truths)
    return {"right_bounces": float(statistics.median(counts)), "of": int(there_are)}
