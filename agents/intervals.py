"""Intervals of a mean score over several trainings and their episodes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from agents.results import CONFIDENCE

RESAMPLES = 10_000


@dataclass(frozen=True)
class Interval:
    """Mean score and its 95 % interval, over `runs` trainings (1 for a player that learns nothing)."""

    mean: float
    lo: float
    hi: float
    runs: int
    episodes: int  # of all of them together


def bootstrap(scores: Sequence[npt.NDArray[np.float64]]) -> Interval:
    """The mean over runs and episodes, and the percentile interval of a bootstrap over both.

    scores: of each run, (episodes,). First runs are drawn with replacement, then of each its episodes: two trainings
    differ by more than two episodes of one do (Agarwal et al. 2021, "Deep RL at the edge of the statistical
    precipice", draw runs alone). The same scores give the same interval.
    """
    generator = np.random.default_rng(0)
    # Of each run many means over resampled episodes; a resampled run takes the next of them.
    means = np.stack([
        generator.choice(one, (RESAMPLES, len(one))).mean(axis=1) for one in scores
    ])  # fmt: skip
    drawn = generator.integers(len(scores), size=(len(scores), RESAMPLES))
    resampled = np.zeros(RESAMPLES)
    for row in drawn:
        resampled += means[row, generator.permutation(RESAMPLES)]
    tail = 100.0 * (1.0 - CONFIDENCE) / 2.0
    lo, hi = np.percentile(resampled / len(scores), [tail, 100.0 - tail]).tolist()
    mean = float(np.mean([one.mean() for one in scores]))
    return Interval(mean, lo, hi, len(scores), sum(map(len, scores)))
