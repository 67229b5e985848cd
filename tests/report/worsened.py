"""What the report says of an engine that was made worse on purpose, with the JIT off.

`python -m tests.report.worsened HOW errors PROBLEM...` prints an error for each problem,
`python -m tests.report.worsened HOW verdicts CASE...` a verdict for each case of the stability suite.

The engine is patched before anything of it imports anything else, so that every user of what is patched sees the patch.
"""

import json
import sys
from collections.abc import Iterator

from bounce_env.engine import tolerances
from bounce_env.engine.motion import roots
from bounce_env.scene import features, spec


def touch_from_far() -> None:
    """Take what is nanometres away for touched: a tolerance times 10^6."""
    tolerances.ULPS_OF_LENGTH *= 1e6


def find_hits_to_ten_digits() -> None:
    """Find the instant of a hit on a wall with a relative error of 1e-10."""
    exact = roots.falling_root
    roots.falling_root = lambda *arguments: exact(*arguments) * (1.0 + 1e-10)


def hop_on_curves() -> None:
    """Know no slides on curves: there a ball hops."""
    of_scene = features.features_of

    def without_contact(*scene: object) -> frozenset[features.Feature]:
        return of_scene(*scene) - {features.Feature.CURVED_CONTACT}

    spec.features_of = without_contact


def nothing() -> None:
    """Leave it as it is."""


def errors(names: list[str]) -> Iterator[float]:
    """Return the largest error of the engine at one call on each problem, of three starts."""
    from bounce_env.report.errors import solved
    from bounce_env.report.measure import error_of
    from bounce_env.report.methods.engine import engine_methods
    from bounce_env.report.problems import problem

    method = engine_methods()[0]
    for name in names:
        which = problem(name)
        player = method.player(which, method.settings[0], 1.0)
        starts = zip(*solved(which, 3, 0), strict=True)
        yield max(error_of(player.trace(start, t.frames), t, chaotic=which.chaotic) for start, t in starts)


def verdicts(names: list[str]) -> Iterator[str]:
    """Return what the report's row of each case says, as the case is given."""
    from bounce_env.report.stability.images import Image
    from bounce_env.report.stability.measure import measure_case
    from bounce_env.report.stability.mechanisms import MECHANISMS, tried_cases

    cases = {case.name: (which, case) for which in MECHANISMS for case, _, _ in tried_cases(which)}
    for name in names:
        mechanism, case = cases[name]
        yield measure_case(mechanism, case, Image(), name, most_steps=0).verdict


if __name__ == "__main__":
    how, what, *names = sys.argv[1:]
    globals()[how]()
    sys.stdout.write(json.dumps(list({"errors": errors, "verdicts": verdicts}[what](names))))
