"""What the page says of opponents that win, and of a report that has become worse, on made-up rows."""

import math
from dataclasses import replace

import pytest

from bounce_env.report.measure import right_bounces, spread
from bounce_env.report.model import ErrorRow, Spread
from bounce_env.report.winners import pairs_compared, wins_of_peers, worse_errors

pytestmark = pytest.mark.fast

OWN = ErrorRow(
    "box", "engine", "exact", error=Spread(1e-15, 5e-16, 2e-15), cost=Spread(10.0, 9.0, 11.0), wrong_order=0.0, lost=0.0
)


def peer(error: float, cost: float, **fields: object) -> ErrorRow:
    row = ErrorRow("box", "pymunk", "1/60 s", error=Spread(error, error, error), cost=Spread(cost, cost, cost))
    return replace(row, **fields)


def test_an_opponent_wins_where_it_is_faster_and_more_accurate_beyond_the_spread():
    wins = wins_of_peers([OWN, peer(1e-16, 5.0)])
    assert [(win.problem, win.peer.method, win.ours.method) for win in wins] == [("box", "pymunk", "engine")]


@pytest.mark.parametrize(
    "other",
    [
        peer(6e-16, 5.0),  # not beyond the spread of the error
        peer(1e-16, 9.5),  # not beyond the spread of the cost
        peer(1e-14, 5.0),
        peer(1e-16, 50.0),
        peer(math.inf, 1.0),
        peer(1e-16, 5.0, problem="circle"),
        ErrorRow("box", "pymunk", "-", reason="not measured"),
    ],
)
def test_it_does_not_win_otherwise(other: ErrorRow):
    assert wins_of_peers([OWN, other]) == []


def test_worse_errors_are_found():
    worse = replace(OWN, error=Spread(1e-13, 1e-13, 1e-13))
    disordered, lost = replace(OWN, wrong_order=0.1), replace(OWN, lost=0.05)
    failed = replace(OWN, error=None, cost=None, reason="failed: ValueError")
    for row in (worse, disordered, lost, failed):
        assert worse_errors([row], [OWN]) == (1, [(row, OWN)])
    for row in (worse, disordered, lost):
        assert worse_errors([OWN], [row]) == (1, [])
    assert worse_errors([OWN], [OWN]) == (1, [])
    assert worse_errors([replace(OWN, error=Spread(1.5e-15, 0.0, 0.0))], [OWN]) == (1, [])
    assert worse_errors([peer(1.0, 1.0)], [peer(0.1, 1.0)]) == (0, [])  # an opponent's own affair
    assert worse_errors([OWN], [failed]) == (0, [])


def test_pairs_are_counted():
    assert (
        pairs_compared([OWN, replace(OWN, method="engine_batch"), peer(1.0, 1.0), peer(1.0, 1.0, problem="bowl")]) == 2
    )
    assert pairs_compared([OWN]) == pairs_compared([peer(1.0, 1.0)]) == 0


def test_a_spread_has_quartiles_and_counts_runs_without_end():
    assert spread([3.0, 1.0, 2.0, 5.0, 4.0]) == Spread(3.0, 2.0, 4.0)
    assert spread([1.0, 2.0, 3.0, 4.0]) == Spread(2.5, 1.0, 4.0)
    assert spread([1.0, math.nan, math.inf]) == Spread(math.inf, 1.0, math.inf)


def test_right_bounces_end_at_the_first_wrong_or_missing_one():
    assert right_bounces([1, 2, 3], [1, 2, 3]) == 3
    assert right_bounces([1, 3], [1, 2, 3]) == 1
    assert right_bounces([1, 2], [1, 2, 3]) == 2
    assert right_bounces([1, 2, 3, 4], [1, 2, 3]) == 3
