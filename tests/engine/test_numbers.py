"""Instants, sine and cosine, random streams: the small things that everything exact rests on."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bounce_env.engine.compile.jit import from_python
from bounce_env.engine.motion import instant
from bounce_env.engine.motion import sincos as trig
from bounce_env.games import streams
from bounce_env.games.streams import EPISODES, LAUNCHES
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

before, later, since = map(from_python, (instant.before, instant.later, instant.since))
sin_cos, bits, uniform = map(from_python, (trig.sin_cos, streams.bits, streams.uniform))

MASK = 2**64 - 1


@settings(max_examples=soak_count(300, 100_000), deadline=None)
@given(st.lists(st.floats(0.0, 1e6), min_size=1, max_size=50))
def test_instants_keep_106_bits(durations: list[float]) -> None:
    """A sum of many durations is right to 2^-100 of its size, and normalised."""
    hi, lo, exact = 0.0, 0.0, Fraction(0)
    for duration in durations:
        hi, lo = later(hi, lo, duration)
        exact += Fraction(duration)
        assert hi + lo == hi
    assert abs(Fraction(hi) + Fraction(lo) - exact) <= exact * Fraction(len(durations), 2**100)
    assert since(hi, lo, hi, lo) == 0.0
    assert not before(hi, lo, hi, lo)


def test_a_nanosecond_after_thirty_years() -> None:
    hi, lo = later(1e9, 0.0, 1e-9)
    assert since(hi, lo, 1e9, 0.0) == 1e-9
    assert before(1e9, 0.0, hi, lo)


@settings(max_examples=soak_count(1000, 1_000_000), deadline=None)
@given(st.floats(-1e4, 1e4))
def test_sine_and_cosine_within_one_and_a_half_ulps(angle: float) -> None:
    s, c = sin_cos(angle)
    with mpmath.workdps(60):
        for value, exact in ((s, mpmath.sin(mpmath.mpf(angle))), (c, mpmath.cos(mpmath.mpf(angle)))):
            assert abs(mpmath.mpf(value) - exact) <= 1.5 * np.spacing(abs(float(exact)))


def test_random_bits_are_splitmix64() -> None:
    """Against the published algorithm in plain integers."""

    def mix(z: int) -> int:
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 & MASK
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB & MASK
        return z ^ (z >> 31)

    golden = 0x9E3779B97F4A7C15
    for seed in (0, 1, 2**63 + 11):
        for index in (0, 1, 12345):
            expected = mix((mix((seed + 2 * golden) & MASK) + index * golden) & MASK)
            assert int(bits(np.uint64(seed), LAUNCHES, index)) == expected
            assert uniform(np.uint64(seed), LAUNCHES, index) == (expected >> 11) * 2.0**-53


def test_streams_are_uniform_and_apart() -> None:
    draws = np.array([uniform(np.uint64(7), LAUNCHES, i) for i in range(20_000)])
    others = np.array([uniform(np.uint64(7), EPISODES, i) for i in range(20_000)])
    assert abs(draws.mean() - 0.5) < 4.0 / np.sqrt(12 * 20_000)
    assert np.histogram(draws, 20, (0.0, 1.0))[0].std() < 3.0 * np.sqrt(1000)
    assert abs(np.corrcoef(draws, others)[0, 1]) < 4.0 / np.sqrt(20_000)
