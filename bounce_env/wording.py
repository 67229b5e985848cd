"""How errors say what was given and what is allowed: the caller's own value, the nearest name, limits that pass."""

import difflib
import math
from collections.abc import Iterable
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from numbers import Real
from typing import Any

import numpy as np
import numpy.typing as npt

LONGEST_VALUE = 60
"""Characters of a value that a message shows."""


def shown(value: object) -> str:
    """Return a value as its owner would type it, cut where it is long."""
    try:
        text = repr(value.item() if isinstance(value, np.generic) else value)
    except (ValueError, RecursionError):  # thousands of digits, or of brackets
        return "a value too long to show"
    except Exception:  # of somebody's own class
        return f"a {type(value).__name__} that cannot be shown"
    return cut(text if isinstance(value, str) else " ".join(text.split()))


def cut(text: str) -> str:
    """Return the beginning of a text that is too long for a message."""
    return text if len(text) <= LONGEST_VALUE else f"{text[:LONGEST_VALUE]}..."


def at_least(limit: float, digits: int = 3, slack: float = 0.0) -> str:
    """Return a lower limit in a few digits, rounded so that what is typed from the message passes.

    slack: by how much a value may be below it.
    """
    near = f"{limit:.{digits}g}"
    return near if not float(near) < limit - slack else _rounded(limit, digits, ROUND_CEILING)


def at_most(limit: float, digits: int = 3, slack: float = 0.0) -> str:
    """Return an upper limit in a few digits, rounded so that what is typed from the message passes.

    slack: by how much a value may be above it.
    """
    near = f"{limit:.{digits}g}"
    return near if not float(near) > limit + slack else _rounded(limit, digits, ROUND_FLOOR)


def _rounded(limit: float, digits: int, rounding: str) -> str:
    return f"{float(Context(prec=digits, rounding=rounding).create_decimal(Decimal(limit))):.{digits}g}"


def unknown_name(name: object, known: Iterable[str], what: str = "name") -> str:
    """Return what to say of a name that is none of `known`: the nearest of them, if one is near, and all of them."""
    return f"unknown {what}{nearest(name, known)}: must be one of {', '.join(known) or 'none'}"


def nearest(name: object, known: Iterable[str]) -> str:
    """Return a question that names the nearest of the names that are known; "" where none is near."""
    near = difflib.get_close_matches(name, list(known), n=1) if isinstance(name, str) else []
    return f" (did you mean {near[0]!r}?)" if near else ""


def real(name: str, value: Any, low: float, high: float, allowed: str = "") -> float:
    """Return a number from `low` to `high` as float; anything else is a ValueError that names it and what is allowed.

    allowed: in other words than these.
    """
    if type(value) is float and low <= value <= high:  # nearly all are, and asking the others takes longer
        return value
    number = math.nan
    if isinstance(value, Real) and not isinstance(value, bool | np.timedelta64):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
    if not low <= number <= high:  # also false for NaN
        raise ValueError(f"{name} = {shown(value)}: must be {allowed or f'a number from {low:g} to {high:g}'}")
    return number


def whole(name: str, value: Any, low: int, high: int | None = None, allowed: str = "") -> int:
    """Return a whole number from `low` to `high`; anything else is a ValueError that names it and what is allowed.

    allowed: in other words than these.
    """
    is_whole = isinstance(value, int | np.integer) and not isinstance(value, bool | np.timedelta64)
    if not is_whole or value < low or (high is not None and value > high):
        allowed = allowed or f"a whole number {f'>= {low}' if high is None else f'from {low} to {high}'}"
        raise ValueError(f"{name} = {shown(value)}: must be {allowed}")
    return int(value)


def numbers(value: Any) -> npt.NDArray[np.float64] | None:
    """Return an array of float64; None for what is ragged or holds anything but numbers (text and bools are none)."""
    try:
        array = np.asarray(value)
        if array.dtype.kind == "O":
            if any(isinstance(item, bool) or not isinstance(item, Real) for item in array.ravel().tolist()):
                return None
        elif array.dtype.kind not in "iuf" or _holds_bools(value):
            return None
        return array.astype(np.float64)
    except OverflowError:  # a whole number of hundreds of digits
        return np.full(np.shape(value), np.inf)
    except (TypeError, ValueError):
        return None


def _holds_bools(value: Any) -> bool:
    """Return whether a nested list or tuple has a bool among its numbers, which NumPy takes for 0 and 1."""
    if isinstance(value, list | tuple):
        return any(map(_holds_bools, value))
    return isinstance(value, bool | np.bool_)


def counted(count: int, noun: str) -> str:
    """Return how many there are of what `noun` says."""
    return f"{count} {noun}{'' if count == 1 else 's'}"
