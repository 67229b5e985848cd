"""Random numbers as pure functions of (seed, stream, index): splitmix64 (Steele, Lea and Flood 2014).

Nothing is drawn in sequence, so that what one part of a game draws cannot shift what another sees: the launch of ball k
is the same whatever the player did before it.
"""

from typing import Any

import numpy as np

from bounce_env.engine.compile.jit import function

EPISODES = np.uint64(1)  # seed of the k-th episode of a world
LAUNCHES = np.uint64(2)  # index 16 k + j: the j-th number of the launch of ball k
STICKY_ACTIONS = np.uint64(3)  # index: the frame
LEVELS = np.uint64(4)  # index 0: which level an episode is played on
LAYOUTS = np.uint64(5)  # seed: the level's number
TARGETS = np.uint64(6)  # index 256 k + 2 j: the j-th place drawn for the target of ball k, x; and y after it

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_S30, _S27, _S31, _S11 = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(11)


@function
def _mix(z: Any) -> Any:
    z = (z ^ (z >> _S30)) * _MIX_1
    z = (z ^ (z >> _S27)) * _MIX_2
    return z ^ (z >> _S31)


@function
def bits(seed: Any, stream: Any, index: int) -> Any:
    """64 random bits."""
    return _mix(_mix(seed + stream * _GOLDEN) + np.uint64(index) * _GOLDEN)


@function
def uniform(seed: Any, stream: Any, index: int) -> float:
    """Return a float in [0, 1), a multiple of 2^-53: that of `index` in a `stream` of `seed`."""
    return np.float64(bits(seed, stream, index) >> _S11) * 2.0**-53
