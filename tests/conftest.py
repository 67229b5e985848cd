"""Shared by all tests: how many samples a property is tried on."""

import os

import pytest
from hypothesis import settings

SOAK = os.environ.get("BOUNCE_SOAK") == "1"

# The sample is the same on every machine and day; a soak looks for examples that nobody has seen yet.
settings.register_profile("sample", derandomize=True)
settings.register_profile("soak", print_blob=True)
settings.load_profile("soak" if SOAK else "sample")


def soak_count(sample: int, full: int) -> int:
    """`sample` under `make test`, `full` under `make soak` (BOUNCE_SOAK=1)."""
    return full if SOAK else sample


def require(name: str, there: bool, what: str) -> None:
    """Skip a test that needs more than Python, make and pip; where BOUNCE_REQUIRE names it (CI), fail instead."""
    if there:
        return
    if name in os.environ.get("BOUNCE_REQUIRE", "").split(","):
        pytest.fail(f"BOUNCE_REQUIRE names {name!r}, but there is no {what}")
    pytest.skip(f"needs {what} ({name})")
