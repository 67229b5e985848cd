"""Part 1: error against run time, every method on every problem, and what becomes of energy and order in long runs."""

import math
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.report.measure import cost_of, error_of, right_bounces, spread
from bounce_env.report.methods.base import Method, Player, Setting, Trace
from bounce_env.report.model import ErrorRow, LongRow
from bounce_env.report.problems import Problem
from bounce_env.report.truths import Start, Truth
from bounce_env.scene import Scene

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Plan:
    """How much is measured.

    shortest: CPU seconds for which one start is timed at least. bounces: of long runs. longer: how many times as
    long as the problem lasts the order of bounces is compared.
    """

    seed: int
    starts: int
    shortest: float
    bounces: int
    longer: int
    quick: bool


REGULAR = 8
"""Starts of a problem that is not chaotic: one goes much like another."""


@cache
def solved(which: Problem, count: int, seed: int) -> tuple[list[Start], list[Truth]]:
    """Return starts of a problem with their truths, but for those that end before anything can be compared."""
    pairs = [(start, which.solve(start)) for start in which.starts(count, seed)]
    kept = [(start, truth) for start, truth in pairs if len(truth.frames)]
    return [start for start, _ in kept], [truth for _, truth in kept]


def measure_errors(which: Problem, method: Method, setting: Setting, plan: Plan) -> ErrorRow:
    """Measure one point of the diagrams."""
    where = (which.name, method.name, setting.label)
    reason = method.why_not(which)
    if reason is not None:
        return ErrorRow(*where, reason=reason)
    starts, truths = solved(which, plan.starts if which.chaotic else min(plan.starts, REGULAR), plan.seed)
    try:
        player = method.player(which, setting, max(truth.top_speed for truth in truths))
        return _measured(where, which, player, starts, truths, plan.shortest)
    except Exception as error:  # of one method: the others go on, and its row says so
        return ErrorRow(*where, reason=f"failed: {type(error).__name__}: {error}")


def _measured(
    where: tuple[str, str, str],
    which: Problem,
    player: Player,
    starts: Sequence[Start],
    truths: Sequence[Truth],
    shortest: float,
) -> ErrorRow:
    traces = [player.trace(start, truth.frames) for start, truth in zip(starts, truths, strict=True)]
    errors = [error_of(t, truth, chaotic=which.chaotic) for t, truth in zip(traces, truths, strict=True)]
    ordered = [(t.order, truth.order) for t, truth in zip(traces, truths, strict=True)]
    compared = [(seen, right) for seen, right in ordered if seen is not None and right is not None]
    return ErrorRow(
        *where,
        error=spread(errors),
        cost=cost_of(player, starts, truths, shortest),
        wrong_order=sum(seen != right for seen, right in compared) / len(compared) if compared else None,
        missed=sum(max(0, len(right) - len(seen)) for seen, right in compared) if compared else None,
        lost=sum(_is_lost(which.scene, t, truth) for t, truth in zip(traces, truths, strict=True)) / len(traces),
        starts=len(starts),
    )


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


# ---- long runs

LONG = ("elastic_box", "gravity_box", "circle")
"""Problems in which energy is kept."""

ORDERED = ("box", "bumper_field")
"""Problems in which an error grows until the order of bounces is wrong."""

SLOWER = {"engine": 1, "engine_frames": 1000, "tutorial_recheck": 10, "tutorial_once": 10, "moreau": 10, "scipy": 4000}
"""By how much fewer bounces a slow method makes in a long run, which would take hours; 1000 where it is not named."""


def measure_energy(which: Problem, method: Method, setting: Setting, plan: Plan) -> LongRow:
    """Measure which share of its energy a ball has gained or lost after many bounces."""
    where = (which.name, method.name, setting.label)
    reason = method.why_not(which)
    if reason is None and method.name == "engine_batch":
        reason = "the same bits as one world"
    if reason is not None:
        return LongRow(*where, reason=reason)
    (start, *_), (truth, *_) = solved(which, plan.starts, plan.seed)
    player = method.player(which, setting, truth.top_speed)
    wanted = max(100, plan.bounces // SLOWER.get(method.name, 1000))
    assert truth.order is not None
    frames = math.ceil(wanted / len(truth.order) * truth.frames[-1])
    trace = player.trace(start, np.array([frames]))
    before = _energy(which.scene, (*start.position, *start.velocity))
    lowest = which.scene.bounds[1] * which.scene.gravity[1]
    assert trace.velocity is not None
    after = _energy(which.scene, (*trace.places[-1].tolist(), *trace.velocity))
    bounces = None if trace.order is None else len(trace.order)
    return LongRow(*where, energy=abs(after - before) / (before + lowest), bounces=bounces)


def _energy(scene: Scene, ball: tuple[float, float, float, float]) -> float:
    x, y, vx, vy = ball
    return 0.5 * (vx * vx + vy * vy) - scene.gravity[0] * x - scene.gravity[1] * y


def measure_order(which: Problem, method: Method, setting: Setting, plan: Plan) -> LongRow:
    """Measure how many bounces come in the right order before the first wrong one."""
    where = (which.name, method.name, setting.label)
    reason = method.why_not(which)
    if reason is None and method.name == "engine_batch":
        reason = "the same bits as one world"
    if reason is not None:
        return LongRow(*where, reason=reason)
    longer = replace(which, frames=plan.longer * which.frames)
    starts, truths = solved(longer, min(plan.starts, 5), plan.seed)
    player = method.player(longer, setting, max(truth.top_speed for truth in truths))
    counts = [
        right_bounces(player.trace(start, truth.frames).order or (), truth.order or ())
        for start, truth in zip(starts, truths, strict=True)
    ]
    there_are = statistics.median(len(truth.order or ()) for truth in truths)
    return LongRow(*where, right_bounces=spread(counts).median, of=int(there_are))


Measure = Callable[[Problem, Method, Setting, Plan], ErrorRow | LongRow]


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
            if which.name in LONG:
                found.append((f"energy {which.name} {method.name}", measure_energy, (which, method, middle, plan)))
            if which.name in ORDERED:
                found.append((f"order {which.name} {method.name}", measure_order, (which, method, middle, plan)))
    return found
