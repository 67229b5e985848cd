"""Intervals of a mean score over several trainings and their episodes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy import stats

from agents.results import CONFIDENCE

Scores = npt.NDArray[Any]

RESAMPLES = 10_000


@dataclass(frozen=True)
class Interval:
    """Mean score and its 95 % interval, over `runs` trainings (1 for a player that learns nothing)."""

    mean: float
    lo: float
    hi: float
    runs: int
    episodes: int  # of all of them together


def bootstrap(scores: Sequence[Scores]) -> Interval:
    """Return the mean over runs and episodes, and the percentile interval of a bootstrap over both.

    scores: of each run, (episodes,), 2 or more. First runs are drawn with replacement, then of each its episodes: two
    trainings differ by more than two episodes of one do (Agarwal et al. 2021, "Deep RL at the edge of the statistical
    precipice", draw runs alone). The same scores give the same interval.
    """
    generator = np.random.default_rng(0)
    of_runs = [_resampled((one,), np.mean, generator) for one in scores]
    means = np.stack([one.bootstrap_distribution for one in of_runs])

    def mean_of_drawn(runs: Scores, axis: int) -> Scores:
        """Return the mean of runs that have been drawn, each with episodes drawn anew."""
        draws = generator.integers(RESAMPLES, size=runs.shape)
        return means[runs.astype(np.intp), draws].mean(axis=axis)

    over_all = _resampled((np.arange(len(scores)),), mean_of_drawn, generator) if len(scores) > 1 else of_runs[0]
    lo, hi = over_all.confidence_interval
    mean = float(np.mean([one.mean() for one in scores]))
    return Interval(mean, float(lo), float(hi), len(scores), sum(map(len, scores)))


def _resampled(data: tuple[Scores], statistic: Callable[..., Any], generator: np.random.Generator) -> Any:
    return stats.bootstrap(
        data, statistic, vectorized=True, n_resamples=RESAMPLES, batch=1000, confidence_level=CONFIDENCE,
        method="percentile", rng=generator,
    )  # fmt: skip
