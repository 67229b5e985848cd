"""Measure one hard case: the worst of what it expects, what it costs, and what others do on it."""

import math
import time

from bounce_env.report.model import StabilityRow
from bounce_env.report.stability.case import Case, Outcome, Point, Run, judge, play, shortened
from bounce_env.report.stability.images import Image
from bounce_env.report.stability.mechanisms import Mechanism
from bounce_env.report.stability.peers import outcome

PEERS = ("pymunk", "box2d", "tutorial")


def measure_case(mechanism: Mechanism, case: Case, image: Image, words: str, most_steps: int) -> StabilityRow:
    """Play a case in an image of it, and judge it by what the case expects.

    most_steps: what other engines cannot play in so many is not run.
    """
    played = image.case(case)
    try:
        run = play(played)
        before = time.process_time()
        play(played)
        cost = time.process_time() - before
        worst = max(judge(case, image.back_run(run)), key=_badness)
        right = _right_place(played, run, as_it_is=image == Image())
    except Exception as error:  # of a broken engine: a red row, and the others go on
        worst, cost, right = Outcome(case.name, "run", "", f"{type(error).__name__}: {error}", 1.0, 0.0), math.nan, None
    peers = {peer: outcome(peer, played, right, most_steps) for peer in PEERS}
    return StabilityRow(
        mechanism=mechanism.name,
        kind=mechanism.kind,
        case=words,
        why=mechanism.why,
        source=case.why,
        what=worst.what,
        expected=shortened(worst.expected) if worst.what == "ledger" else worst.expected,
        seen=worst.seen,
        error=float(worst.error),
        bound=float(worst.within),
        verdict="right" if worst.right else "wrong",
        cost=1e6 * cost,
        **peers,
    )


def _badness(item: Outcome) -> tuple[bool, bool, float]:
    """Order outcomes: what is wrong first, then numbers by their share of the bound, then what is no number."""
    share = item.error / item.within if item.within > 0.0 else item.error
    return not item.right, item.within > 0.0, math.inf if math.isnan(share) else share


def _right_place(case: Case, run: Run, *, as_it_is: bool) -> Point | None:
    """Return where the ball has to be at the end: as the case says, or where it does not, as the engine has it."""
    if run.refusal:
        return None
    said = {item.what: item.expected for item in case.expect}
    if as_it_is and {"x", "y"} <= said.keys():
        return said["x"], said["y"]
    return run.position
