"""How features are left out: `where` looks at the type of a named tuple, `bind` goes through nested ones."""

import copy
import gc
import math
import pickle
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest

from bounce_env.engine.compile.binding import bind
from bounce_env.engine.compile.jit import function, kernel, where

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
    write(outer, x)
    index, share = with_tuple(outer, x)
    return with_function(outer, x), with_constant(outer, x), index, share, sum_of(outer)


class Numbers(NamedTuple):
    """Of every kind that can be bound."""

    table: Any
    column: Any
    flags: Any
    whole: int
    no: bool
    yes: bool
    pair: tuple[int, float]
    nothing: None
    inner: Inner


@kernel
def member_by_member(n):
    sums = 0.0
    for i in range(n.table.shape[0]):
        for j in range(n.table.shape[1]):
            sums += n.table[i, j].value
    for i in range(len(n.column)):
        sums += n.column[i] * 1000.0
    n.flags[1, 0, 1] = True
    return sums, n.table.size, n.whole, n.no, n.yes, n.pair, n.nothing is None, n.inner.scale, n.flags.sum()


def test_what_is_there_is_used_and_what_is_not_is_replaced():
    numbers = np.arange(5.0)
    there, absent = Outer(Inner(numbers, 2.0), np.array([3.0])), Outer(Inner(numbers, 2.0), None)
    assert everything(bind(there), 4.0) == (16.0, 8.0, 7, 4.0, 20.0)
    assert there.extra[0] == 4.0
    assert everything(bind(absent), 4.0) == (400.0, math.inf, -1, 0.5, 20.0)
    assert with_function(absent, 4.0) == 400.0  # from Python, too
    assert with_function(there, 4.0) == 16.0


def numbers_of_all_kinds():
    table = np.zeros((2, 3), np.dtype((np.record, [("index", "i8"), ("value", "f8")])))
    table["value"] = np.arange(6.0).reshape(2, 3)
    flags = np.zeros((2, 2, 2), np.bool_)
    return Numbers(table, np.arange(10.0)[1::4], flags, -(2**60), False, True, (7, 0.25), None, Inner(flags, -0.5))


def test_all_that_can_be_bound_is_read_as_it_is():
    numbers = numbers_of_all_kinds()
    told = 15.0 + 1000.0 * (1.0 + 5.0 + 9.0), 6, -(2**60), False, True, (7, 0.25), True, -0.5, 1
    assert member_by_member(bind(numbers)) == told
    assert numbers.flags.nonzero() == ([1], [0], [1])


@pytest.mark.parametrize("again", [copy.deepcopy, lambda bound: pickle.loads(pickle.dumps(bound))])
def test_what_is_bound_can_be_copied_and_then_has_arrays_of_its_own(again):
    numbers = numbers_of_all_kinds()
    member_by_member(again(bind(numbers)))
    assert not numbers.flags.any()


def test_bound_arrays_live_as_long_as_what_they_are_bound_to():
    bound = bind(Outer(Inner(np.arange(5.0), 2.0), np.array([3.0])))
    gc.collect()
    rubbish = [np.full(5, math.nan) for _ in range(100)]
    assert everything(bound, 4.0) == (16.0, 8.0, 7, 4.0, 20.0)
    assert len(rubbish) == 100


@pytest.mark.skipif(numba.config.DISABLE_JIT, reason="nothing is bound")
@pytest.mark.parametrize("value", ["words", np.float32(1.0), [1.0]])
def test_what_cannot_be_bound_is_refused(value):
    with pytest.raises(TypeError, match="cannot be bound: must be"):
        bind(Inner(np.zeros(1), value))
