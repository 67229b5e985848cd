"""What errors print: the caller's value, the nearest name, and limits that pass when they are typed."""

import decimal
import fractions
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bounce_env.wording import at_least, at_most, nearest, numbers, real, shown, unknown_name, whole

pytestmark = pytest.mark.fast

NO_NUMBERS = ["1", b"1", None, True, np.True_, 1j, [1], np.array([1.0]), decimal.Decimal(1), np.timedelta64(1, "s"), {}]


@given(st.floats(1e-300, 1e300), st.integers(1, 8))
def test_a_limit_that_is_printed_passes(limit, digits):
    for value in (limit, -limit):
        assert float(at_least(value, digits)) >= value
        assert float(at_most(value, digits)) <= value
    # and it is near: no more than one unit of the last digit away
    unit = 10.0 ** (math.floor(math.log10(limit)) + 1 - digits)
    assert abs(float(at_least(limit, digits)) - limit) <= 1.01 * unit
    assert abs(float(at_most(limit, digits)) - limit) <= 1.01 * unit


def test_round_limits_are_printed_round():
    assert (at_least(0.001), at_most(0.1), at_least(2.0)) == ("0.001", "0.1", "2")
    assert (at_least(1.2345678e-6), at_most(2 / 3)) == ("1.24e-06", "0.666")


@pytest.mark.parametrize("value", NO_NUMBERS, ids=repr)
def test_what_is_no_number_is_refused(value):
    for check in (lambda: real("x", value, 0.0, 9.0), lambda: whole("x", value, 0, 9)):
        with pytest.raises(ValueError, match=r"x = .*: must be a (whole )?number from 0 to 9"):
            check()


@pytest.mark.parametrize(
    "value",
    [-1, 10, 10**400, 10**5000, -(10**400), math.inf, math.nan, fractions.Fraction(10**400)],
    ids=lambda value: shown(value)[:8],
)
def test_what_is_out_of_range_is_refused(value):
    with pytest.raises(ValueError, match=r"x = .{1,63}: must be a number from 0 to 9"):
        real("x", value, 0.0, 9.0)


def test_numbers_of_every_kind_are_taken():
    for value in (3, 3.0, np.int8(3), np.float32(3), fractions.Fraction(3)):
        assert (type(real("x", value, 0.0, 9.0)), real("x", value, 0.0, 9.0)) == (float, 3.0)
    assert (type(whole("x", np.int8(3), 0)), whole("x", 3, 0)) == (int, 3)


@pytest.mark.parametrize(
    "value", [[[1, 2], [3]], "1x", ["1", "2"], [1, True], [1j, 2], [None, 1], [np.True_, 1], [{}, 1]]
)
def test_an_array_of_anything_else_is_none(value):
    assert numbers(value) is None


def test_an_array_of_numbers_is_float64():
    for value in ([1, 2], (1.0, 2), np.array([1, 2], np.int8), [fractions.Fraction(1), 2], [10**30, 2]):
        assert numbers(value).dtype == np.float64
    assert np.isinf(numbers((10**400, 0))).all()  # to be refused as out of range


def test_values_are_shown_as_they_were_typed():
    assert shown(np.float64(0.5)) == "0.5"
    assert shown((0, 1)) == "(0, 1)"
    assert shown(10**5000) == "a value too long to show"
    assert len(shown("a" * 1000)) == 63


def test_the_nearest_name():
    assert nearest("fram_skip", ["frame_skip", "scene"]) == " (did you mean 'frame_skip'?)"
    assert nearest(3, ["a"]) == nearest("zzz", ["a"]) == ""
    assert unknown_name("zzz", ["a", "b"], "field") == "unknown field: must be one of a, b"
