"""Conservative advancement: how far a search may go on without stepping over a hit.

A gap f(t) of which f'' >= -A is known stays open at least until the first root of f + f' h - A h^2 / 2
(bounded-acceleration, or conservative, advancement). Each shape finds its own gap, rate and bound.
"""

import math

from bounce_env.engine.compile.jit import function


@function
def advancement_step(gap: float, rate: float, bound: float) -> float:
    """Return how long [s] a gap surely stays open: that root, for `bound` > 0, in the form in which nothing cancels."""
    root = math.sqrt(rate * rate + 2.0 * bound * gap)
    return 2.0 * gap / (root - rate) if rate < 0.0 else (rate + root) / bound


@function
def advancement_to_closing(gap: float, rate: float, bound: float) -> float:
    """Return how long [s] a gap that counts as a touch, and closes, takes to close; 0 where it is deeper than it began.

    Going back from there would end where nothing closes yet.
    """
    root = math.sqrt(max(rate * rate + 2.0 * bound * gap, 0.0))
    return 2.0 * max(gap, 0.0) / (root - rate)
