"""Where an opponent is both faster and more accurate than this engine."""

from collections.abc import Iterable
from dataclasses import dataclass

from bounce_env.report.model import ErrorRow

OURS = ("engine", "engine_frames", "engine_batch")


@dataclass(frozen=True)
class Win:
    """An opponent at a setting that beats one of our lines on a problem."""

    problem: str
    peer: ErrorRow
    ours: ErrorRow


def wins_of_peers(rows: Iterable[ErrorRow]) -> list[Win]:
    """Return all pairs in which an opponent is faster and more accurate, each beyond the spread of both.

    That is: the upper quartile of its cost is below our lower one, and so is that of its error. A run that came to no
    end is infinitely wrong.
    """
    measured = [row for row in rows if row.error is not None and row.cost is not None]
    ours = [row for row in measured if row.method in OURS]
    return [
        Win(own.problem, peer, own)
        for own in ours
        for peer in measured
        if peer.method not in OURS and peer.problem == own.problem and _beats(peer, own)
    ]


def _beats(peer: ErrorRow, own: ErrorRow) -> bool:
    assert peer.error is not None
    assert peer.cost is not None
    assert own.error is not None
    assert own.cost is not None
    return peer.cost.high < own.cost.low and peer.error.high < own.error.low


def pairs_compared(rows: Iterable[ErrorRow]) -> int:
    """Return in how many pairs of an opponent and one of our lines a win would have been seen."""
    measured = [row for row in rows if row.error is not None]
    ours = [row.problem for row in measured if row.method in OURS]
    return sum(ours.count(row.problem) for row in measured if row.method not in OURS)


def worse_errors(
    now: Iterable[ErrorRow], before: Iterable[ErrorRow], factor: float = 4.0
) -> tuple[int, list[tuple[ErrorRow, ErrorRow]]]:
    """Return how many rows of this engine are in both reports, and those that are worse, with the older ones.

    Worse: the median error is more than `factor` times the older one and more than 1e-15 m above it, a larger share of
    starts has a wrong order or is lost, or there is no number any more.
    """
    older = {(row.problem, row.method, row.setting): row for row in before if row.method in OURS and row.error}
    pairs = [(row, older[key]) for row in now if (key := (row.problem, row.method, row.setting)) in older]
    return len(pairs), [(row, old) for row, old in pairs if row.error is None or _is_worse(row, old, factor)]


def _is_worse(row: ErrorRow, old: ErrorRow, factor: float) -> bool:
    assert row.error is not None
    assert old.error is not None
    grown = row.error.median > factor * old.error.median and row.error.median > old.error.median + 1e-15
    return grown or (row.wrong_order or 0.0) > (old.wrong_order or 0.0) or (row.lost or 0.0) > (old.lost or 0.0)
