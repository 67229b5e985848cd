"""The stability suite: every case is right, and nothing about it depends on what must not matter.

A case fails by name; `python -m bounce_env report stability` shows outcomes, with their errors. The
cases share two kernels, one for discs and one for points: those that have every feature of standing scenes.
"""

import numpy as np
import pytest

from bounce_env.report.stability.case import Case, Run, judge, new_world, play
from bounce_env.report.stability.cases import CASES
from bounce_env.report.stability.images import Image
from tests.conftest import SOAK
from tests.stability.clearance import deepest

pytestmark = pytest.mark.slow

SMALL, LARGE, SLOW = Image(length=2.0**-10), Image(length=2.0**19), Image(time=2.0**4)

PLAYED = [case for case in CASES if not case.refused]
# In the kernels of their own scenes, which take long to compile; tests/engine/test_scene_features.py interprets them.
LEAN = PLAYED if SOAK else []


def each(cases: list[Case]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("case", cases, ids=lambda case: case.name)


@each(CASES)
def test_right_answer(case: Case) -> None:
    outcomes = list(judge(case, play(case)))
    wrong = [f"{o.what}: expected {o.expected}, seen {o.seen} (error {o.error:.3g})" for o in outcomes if not o.right]
    assert not wrong, "\n".join([case.why, *wrong])


@each(PLAYED)
def test_time_in_pieces_and_snapshots_change_no_bit(case: Case) -> None:
    whole = play(case)
    assert_same_bits(play(case, pieces=7), whole)
    assert_same_bits(play(case, pieces=5, restored=True), whole)


@each([case for case in PLAYED if len(case.script) == 1])
def test_one_event_at_a_time_gives_the_same_rows(case: Case) -> None:
    """With a budget of one event a call, again and again; at most the first 100 rows."""
    world = new_world(case.scene)
    world.reset(position=case.position, velocity=case.velocity)
    rows = b""
    whole = play(case).ledger
    expected = b"" if whole is None else whole[:100].tobytes()
    for _ in range(200):
        page = world.advance(case.script[0], ledger=True, max_events=1)
        rows += page.tobytes()
        if len(rows) >= len(expected):
            break
    assert rows[: len(expected)] == expected


@each(LEAN)
def test_lean_kernel_gives_the_same_bits(case: Case) -> None:
    assert_same_bits(play(case, lean=True), play(case))


@each(PLAYED)
def test_mirror_image_is_the_same_to_the_bit(case: Case) -> None:
    assert_same_in(case, Image(upside_down=True))


@each([case for case in PLAYED if case.exact_scaling])
@pytest.mark.parametrize("image", [SMALL, LARGE, SLOW], ids=["small", "large", "slow"])
def test_no_length_or_time_is_special(case: Case, image: Image) -> None:
    """A thousand times smaller, half a million times larger, sixteen times slower: the same digits, other exponents."""
    assert_same_in(case, image)


@each(PLAYED)
def test_ball_is_never_inside_of_anything(case: Case) -> None:
    assert deepest(case) <= 1e-9


def assert_same_bits(one: Run, other: Run) -> None:
    assert one.text() == other.text()
    assert one.states == other.states
    assert (one.ledger is None) == (other.ledger is None)
    assert one.ledger is None or one.ledger.tobytes() == other.ledger.tobytes()


def assert_same_in(case: Case, image: Image) -> None:
    here, there = Image().back(play(case)), image.back(play(image.case(case)))
    assert here.keys() == there.keys()
    for name, values in here.items():
        assert np.array_equal(values, there[name]), name
