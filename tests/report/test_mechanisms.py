"""Every pattern of a mechanism finds cases: a renamed case must not vanish from the report."""

import re

import pytest

from bounce_env.report.stability.cases import CASES
from bounce_env.report.stability.mechanisms import MECHANISMS, Mechanism, tried_cases

pytestmark = pytest.mark.fast


def alternatives(pattern: str) -> list[str]:
    """What a pattern offers at its top level."""
    parts, depth = [""], 0
    for sign in pattern:
        depth += (sign in "([") - (sign in ")]")
        if sign == "|" and depth == 0:
            parts.append("")
        else:
            parts[-1] += sign
    return parts


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
def test_every_alternative_finds_a_case(mechanism: Mechanism):
    for pattern in alternatives(mechanism.cases):
        assert any(re.fullmatch(pattern, case.name) for case in CASES), pattern
    assert len(list(tried_cases(mechanism))) >= 2
