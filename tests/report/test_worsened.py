"""A report of an engine that has been made worse shows it."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.fast

ROOT = Path(__file__).parents[2]


def errors_of(how: str, *problems: str) -> list[float]:
    """Errors of a patched engine: in a process of its own, without the compiler."""
    words = [sys.executable, "-m", "tests.report.worsened", how, *problems]
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1"}
    run = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    return [float(error) for error in json.loads(run.stdout)]


def test_an_engine_that_is_as_it_should_be_is_exact():
    assert max(errors_of("nothing", "zeno_drop", "bowl", "loop", "pinball")) < 1e-13


@pytest.mark.parametrize(
    ("how", "problem", "least"),
    [
        ("find_hits_to_ten_digits", "zeno_drop", 1e-11),
        ("hop_on_curves", "bowl", 1e-3),
        ("hop_on_curves", "loop", 1e-3),
        ("touch_from_far", "pinball", 1e-13),
    ],
)
def test_one_that_is_worse_shows(how: str, problem: str, least: float):
    (error,) = errors_of(how, problem)
    assert error > least
