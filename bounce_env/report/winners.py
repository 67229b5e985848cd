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


def worse_errors(
    now: Iterable[ErrorRow], before: Iterable[ErrorRow], factor: float = 4.0
) -> list[tuple[ErrorRow, ErrorRow]]:
    """Return the rows of this engine that are worse than in an older report, with those of that.

    Worse: the median error is more than `factor` times the older one and more than 1e-15 m above it, or a larger share
    of starts has a wrong order or is lost.
    """
    older = {(row.problem, row.method, row.setting): row for row in before if row.method in OURS}
    found = []
    for row in now:
        old = older.get((row.problem, row.method, row.setting))
        if old is not None and row.error is not None and old.error is not None and _is_worse(row, old, factor):
            found.append((row, old))
    return found


def _is_worse(row: ErrorRow, old: ErrorRow, factor: float) -> bool:
    assert row.error is not None
    assert old.error is not None
    grown = row.error.median > factor * old.error.median and row.error.median > old.error.median + 1e-15
    return grown or (row.wrong_order or 0.0) > (old.wrong_order or 0.0) or (row.lost or 0.0) > (old.lost or 0.0)
