"""What came out of the episodes that a player played: means, intervals, a table."""

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass

import numpy as np
import numpy.typing as npt
from scipy import stats

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Episodes:
    """Whole episodes, one row each."""

    scores: npt.NDArray[np.float64]
    seconds: npt.NDArray[np.float64]  # of play
    touches: npt.NDArray[np.int64]  # hits of the part that the player moves
    at_limit: npt.NDArray[np.bool_]  # truncated by the time limit


@dataclass(frozen=True)
class Estimate:
    """Mean score, its 95 % interval, and the number of episodes."""

    mean: float
    lo: float
    hi: float
    n: int


def estimate(scores: npt.NDArray[np.float64]) -> Estimate:
    """Student's t-interval of the mean; scores are skewed, but with hundreds of them their mean is not.

    scores: at least 2.
    """
    n, mean = len(scores), float(scores.mean())
    half = float(stats.t.ppf((1.0 + CONFIDENCE) / 2.0, n - 1)) * float(scores.std(ddof=1)) / math.sqrt(n)
    return Estimate(mean, mean - half, mean + half, n)


def statistics(episodes: Episodes) -> dict[str, float]:
    """What else tells how a player plays: JSON-able. `score_per_touch` is NaN-free: 0 where nothing was touched."""
    touches = int(episodes.touches.sum())
    return {
        "median_score": float(np.median(episodes.scores)),
        "mean_seconds": float(episodes.seconds.mean()),
        "share_at_time_limit": float(episodes.at_limit.mean()),
        "score_per_touch": float(episodes.scores.sum()) / touches if touches else 0.0,
    }


def report(played: Mapping[str, Episodes]) -> dict[str, dict[str, float]]:
    """By name: mean, lo, hi, n."""
    return {name: asdict(estimate(episodes.scores)) for name, episodes in played.items()}


def table(played: Mapping[str, Episodes]) -> str:
    """Return the same as text, with the statistics; one row a player."""
    lines = [
        f"{'player':<16}{'mean score':>11}{'95 % interval':>22}{'episodes':>10}"
        f"{'median':>8}{'seconds':>9}{'at limit':>10}{'score/touch':>13}"
    ]
    for name, episodes in played.items():
        e, s = estimate(episodes.scores), statistics(episodes)
        interval = f"{e.lo:.2f} to {e.hi:.2f}"
        lines.append(
            f"{name:<16}{e.mean:>11.2f}{interval:>22}{e.n:>10}{s['median_score']:>8.1f}{s['mean_seconds']:>9.1f}"
            f"{s['share_at_time_limit']:>10.1%}{s['score_per_touch']:>13.2f}"
        )
    return "\n".join(lines)
