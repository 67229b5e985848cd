"""How features are left out: `where` looks at the type of a named tuple, `borrow` goes through nested ones."""

import math
from typing import Any, NamedTuple

import numpy as np
import pytest

from bounce_env.engine.compile.jit import borrow, function, kernel, where

pytestmark = pytest.mark.fast


class Inner(NamedTuple):
    """A tuple in a tuple."""

    numbers: Any
    scale: float


class Outer(NamedTuple):
    """With a member that may not be there."""

    inner: Inner
    extra: Any


def _instead(outer, x):
    return 100.0 * x


@where("extra", otherwise=_instead)
def with_function(outer, x):
    return outer.extra[0] * x


@where("extra", otherwise=math.inf)
def with_constant(outer, x):
    return outer.extra[0] + x


@where("extra")
def write(outer, x):
    outer.extra[0] = x


@where("extra", otherwise=(-1, 0.5), inline=False)
def with_tuple(outer, x):
    return 7, outer.extra[0]


@function
def sum_of(outer):
    total = 0.0
    for i in range(outer.inner.numbers.shape[0]):
        total += outer.inner.numbers[i] * outer.inner.scale
    return total


@kernel
def everything(outer, x):
    outer = borrow(outer)
    write(outer, x)
    index, share = with_tuple(outer, x)
    return with_function(outer, x), with_constant(outer, x), index, share, sum_of(outer)


@kernel
def first_of(numbers):
    numbers = borrow(numbers)
    return numbers[0]


def test_what_is_there_is_used_and_what_is_not_is_replaced():
    numbers = np.arange(5.0)
    there, absent = Outer(Inner(numbers, 2.0), np.array([3.0])), Outer(Inner(numbers, 2.0), None)
    assert everything(there, 4.0) == (16.0, 8.0, 7, 4.0, 20.0)
    assert there.extra[0] == 4.0
    assert everything(absent, 4.0) == (400.0, math.inf, -1, 0.5, 20.0)
    assert with_function(absent, 4.0) == 400.0  # from Python, too
    assert with_function(there, 4.0) == 16.0


def test_a_borrowed_array_keeps_its_owner():
    numbers = np.arange(5.0)
    outer = Outer(Inner(numbers, 1.0), None)
    held = [outer]
    for _ in range(50):
        everything(outer, 1.0)
        assert first_of(numbers) == 0.0
    assert everything(held[0], 1.0)[4] == 10.0
    assert numbers.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
