"""How errors and times are measured: one player, one start after the other."""

import math
import statistics
import time
from collections.abc import Iterable, Sequence

import numpy as np

from bounce_env.report.methods.base import Player, Trace
from bounce_env.report.model import Spread
from bounce_env.report.truths import FRAMES, Start, Truth

ENOUGH, LEAST_STARTS = 0.3, 3
"""CPU seconds after which no more starts are timed, and how many are at least."""


def spread(values: Iterable[float]) -> Spread:
    """Return median and quartiles. A quartile is one of the values, the outer one of two; what is NaN is infinite."""
    ordered = sorted(math.inf if math.isnan(v) else float(v) for v in values)
    at = (len(ordered) - 1) / 4.0
    return Spread(statistics.median(ordered), ordered[math.floor(at)], ordered[math.ceil(3 * at)])


def cost_of(player: Player, starts: Sequence[Start], truths: Sequence[Truth], shortest: float) -> Spread:
    """Return microseconds of CPU for a simulated second of one world, over starts, warm.

    shortest: CPU seconds for which each start is repeated at least. What is slow is timed on a few starts only.
    """
    player.begin(starts[0])
    player.go(int(truths[0].frames[-1]))
    costs, total = [], 0
    for start, truth in zip(starts, truths, strict=True):
        frames, spent, rounds = int(truth.frames[-1]), 0, 0
        while rounds == 0 or spent < shortest * 1e9:
            player.begin(start)
            before = time.process_time_ns()
            player.go(frames)
            spent += time.process_time_ns() - before
            rounds += 1
        total += spent
        costs.append(spent / 1e3 / rounds / (frames / FRAMES) / player.worlds)
        if total > ENOUGH * 1e9 and len(costs) >= LEAST_STARTS:
            break
    return spread(costs)


def error_of(trace: Trace, truth: Truth, *, chaotic: bool) -> float:
    """Return the greatest distance from the truth at the times that are compared [m], infinite where there is no place.

    chaotic: over the growth of a small error up to that time.
    """
    distance = np.hypot(*(trace.places - truth.places).T)
    worst = float(np.max(distance / truth.growth if chaotic else distance))
    return math.inf if math.isnan(worst) else worst


def right_bounces(order: Sequence[int], right: Sequence[int]) -> int:
    """Return how many bounces come in the right order before the first wrong or missing one."""
    for k, (seen, expected) in enumerate(zip(order, right, strict=False)):
        if seen != expected:
            return k
    return min(len(order), len(right))
