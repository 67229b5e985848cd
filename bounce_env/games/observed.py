"""What each number of an observation is: its name, its unit and its bounds, in the order in which it is observed."""

from collections.abc import Sequence
from typing import NamedTuple


class Observed(NamedTuple):
    """One number of an observation; docs/own_game.md.

    what: in words. unit: what 1, or the range, stands for. low, high: bounds, which no observation leaves.
    """

    what: str
    unit: str
    low: float
    high: float


def share(what: str, unit: str) -> Observed:
    """Return a number from 0 to 1. unit: what it is a share of, or what 0 and 1 stand for."""
    return Observed(what, unit, 0.0, 1.0)


def place_of(what: str, left: str, right: str, below: str, above: str) -> tuple[Observed, Observed]:
    """Return x and y of a place as the field shows it, each from -1 to 1; in words what is at these four ends."""
    return (
        Observed(f"{what} x", f"{left} -1, {right} 1", -1.0, 1.0),
        Observed(f"{what} y", f"{below} -1, {above} 1", -1.0, 1.0),
    )


def velocity_of(what: str, reference: float, fastest: float) -> tuple[Observed, Observed]:
    """Return x and y of a velocity in units of `reference` [m/s], each at most `fastest` of these either way."""
    unit = "m/s" if reference == 1.0 else f"units of {reference:g} m/s"
    x, y = (Observed(f"{what} velocity {axis}", unit, -fastest, fastest) for axis in "xy")
    return x, y


def held(words: Sequence[str], low: float) -> tuple[Observed, ...]:
    """Return the action in force, which is observed where actions are sticky; a word for each number of it."""
    return tuple(Observed(f"{word}, in force", "as the action", low, 1.0) for word in words)
