"""The page of numerical stability: what makes simulators fail, and how often each is tried."""

from bounce_env.report.stability.mechanisms import MECHANISMS, tried_cases


def mechanisms(kind: str) -> str:
    """Return a table of the mechanisms of a kind: stiff, extreme or degenerate."""
    rows = ["| mechanism | why it is hard | cases |", "| --- | --- | ---: |"]
    for mechanism in MECHANISMS:
        if mechanism.kind == kind:
            count = sum(1 for _ in tried_cases(mechanism))
            rows.append(f"| {mechanism.name} | {mechanism.why} | {count} |")
    return "\n".join(rows)
