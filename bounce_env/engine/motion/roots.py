"""When a parabola passes through zero."""

import math

from bounce_env.engine.compile.jit import NumberOrNone, function


@function
def falling_root(gap: float, behind: bool, rate: float, pull: NumberOrNone) -> float:
    """Return the first t >= 0 at which gap + rate t + pull t^2 / 2 falls through zero, which it does at most once.

    `behind` says that the ball is on the far side already, where the gap must rise above zero before it can fall.
    Written so that nothing cancels (Citardauq): each root is taken from the form that adds two terms of one sign.
    """
    if pull is None or pull == 0.0:
        if behind or rate >= 0.0:
            return math.inf
        return max(gap, 0.0) / -rate
    if rate < 0.0:
        if behind:
            return math.inf
        gap = max(gap, 0.0)
        square = rate * rate - 2.0 * pull * gap
        if square <= 0.0:
            return math.inf
        return 2.0 * gap / (math.sqrt(square) - rate)
    if pull > 0.0:
        return math.inf
    if not behind:
        gap = max(gap, 0.0)
    square = rate * rate - 2.0 * pull * gap
    if square <= 0.0 and behind:
        return math.inf
    return (rate + math.sqrt(square)) / -pull
