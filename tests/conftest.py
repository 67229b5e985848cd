"""Shared by all tests: how many samples a property is tried on."""

import os


def soak_count(sample: int, full: int) -> int:
    """`sample` under `make test`, `full` under `make soak` (BOUNCE_SOAK=1)."""
    return full if os.environ.get("BOUNCE_SOAK") == "1" else sample
