"""Errors of the engine, made worse on purpose: `python -m tests.report.worsened HOW PROBLEM...`, with the JIT off.

It is patched before anything of it imports anything else, so that every user of what is patched sees the patch.
"""

import json
import sys
from collections.abc import Iterator

from bounce_env.engine import tolerances
from bounce_env.engine.motion import roots
from bounce_env.scene import features, spec


def touch_from_far() -> None:
    """Take what is micrometres away for touched."""
    tolerances.ULPS_OF_LENGTH *= 1e9


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


if __name__ == "__main__":
    globals()[sys.argv[1]]()
    sys.stdout.write(json.dumps(list(errors(sys.argv[2:]))))
