"""A report of an engine that has been made worse shows it."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.fast

ROOT = Path(__file__).parents[2]


CASES = ("drop e=0.5 r=0.125", "drop e=0.9 r=0.0")


def said_of(how: str, what: str, *names: str) -> list[Any]:
    """What the report says of a patched engine: in a process of its own, without the compiler."""
    words = [sys.executable, "-m", "tests.report.worsened", how, what, *names]
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    run = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    said: list[Any] = json.loads(run.stdout)
    return said


def test_an_engine_that_is_as_it_should_be_is_exact_and_right():
    assert max(said_of("nothing", "errors", "zeno_drop", "bowl", "loop")) < 1e-13
    assert said_of("nothing", "verdicts", *CASES) == ["right", "right"]


@pytest.mark.parametrize(
    ("how", "problem", "least"),
    [
        ("find_hits_to_ten_digits", "zeno_drop", 1e-11),
        ("hop_on_curves", "bowl", 1e-3),
        ("hop_on_curves", "loop", 1e-3),
    ],
)
def test_one_that_is_worse_has_an_error(how: str, problem: str, least: float):
    (error,) = said_of(how, "errors", problem)
    assert error > least


def test_a_tolerance_that_is_too_wide_turns_rows_red():
    """Places stay right to the last digits, whatever a tolerance is; what happens when does not."""
    assert said_of("touch_from_far", "verdicts", *CASES) == ["wrong", "wrong"]
