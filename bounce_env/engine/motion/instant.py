"""Instants of time as the sum of two floats [s].

A world may run for 1e9 s and still hit a wall at the right nanosecond, since an instant keeps 106 bits. Durations are
single floats: they are differences of instants that lie close together.
"""

from bounce_env.engine.compile.jit import function


@function
def later(hi: float, lo: float, duration: float) -> tuple[float, float]:
    """Return the instant (hi, lo) plus a duration [s], normalised so that instants compare part by part (Knuth)."""
    total = hi + duration
    back = total - hi
    rest = (hi - (total - back)) + (duration - back) + lo
    top = total + rest
    return top, rest - (top - total)


@function
def since(hi: float, lo: float, hi0: float, lo0: float) -> float:
    """Return the duration [s] from the instant (hi0, lo0) to the instant (hi, lo)."""
    return (hi - hi0) + (lo - lo0)


@function
def before(hi: float, lo: float, hi0: float, lo0: float) -> bool:
    """Return whether (hi, lo) is earlier than (hi0, lo0)."""
    return hi < hi0 or (hi == hi0 and lo < lo0)
