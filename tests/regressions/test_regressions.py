"""Every bug found has left a scene in `cases/`; they are all replayed here.

A case is two files of one name. NAME.toml: the scene. NAME.json: what went wrong (`bug`), `position` [m] and `velocity`
[m/s] of the start, a `script` of seconds to advance and commands (["push", [dvx, dvy]], ["enable", name, bool],
["command", part, value]), if need be `max_events`, and what is `expected` at its end: `status`, and where they matter
`position` and `velocity` (both within `within`), `last`, the time of the last row of the ledger (within `last_within`),
and `ledger`, a regular expression of its rows spelled "element kind" ("floor bounce, floor begin").

Of several balls `position`, `velocity` and `status` have one row each, and another ball is the element "ball K".

They are replayed in the kernel that has all features, so that no scene needs one compiled for itself.
"""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bounce_env import World, load_scene
from bounce_env.report.stability.case import STATUS, Run, new_world

FOLDER = Path(__file__).parent / "cases"
NAMES = sorted(path.stem for path in FOLDER.glob("*.json"))


def replay(name: str) -> tuple[World, Run, dict[str, Any]]:
    """The world at the end of a case, its ledger, and what is expected of them."""
    case = json.loads((FOLDER / f"{name}.json").read_text())
    scene, balls = load_scene(FOLDER / f"{name}.toml"), len(np.atleast_2d(case["position"]))
    world = new_world(scene, balls=balls)
    world.reset(position=case["position"], velocity=case["velocity"])
    pages = []
    for step in case["script"]:
        if isinstance(step, list):
            getattr(world, step[0])(*step[1:])
        else:
            pages.append(world.advance(step, ledger=True, max_events=case.get("max_events", 20_000)))
    names = [element.name for element in scene.elements] + [f"ball {k}" for k in range(balls)]
    return world, Run(names, np.concatenate(pages)), case["expected"]


def test_every_case_is_complete() -> None:
    assert {path.stem for path in FOLDER.glob("*.toml")} == set(NAMES)


# Thousands of small hops, or of events up to the budget: too many for `make check`, where the JIT is off.
MANY_EVENTS = {
    "arc_hop_as_small_as_its_gap", "budget_with_a_ledger", "cup_smaller_than_the_ball", "elastic_in_a_bowl",
    "hops_off_what_it_is_leaving", "presses_on_a_bumper_after_no_time", "slides_into_a_part_that_it_does_not_close_on",
    "three_balls_in_a_row_across_gravity",
    "told_of_the_end_of_a_hop_shorter_than_the_clock_can_tell", "two_balls_wedged_by_a_dragged_wall",
    "upright_wall_and_bowl",
}  # fmt: skip


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in MANY_EVENTS else pytest.mark.fast) for name in NAMES]
)
def test_bug_has_not_come_back(name: str) -> None:
    world, run, expected = replay(name)
    assert [STATUS[status] for status in world.status.tolist()] == np.atleast_1d(expected["status"]).tolist()
    assert np.isfinite([world.position, world.velocity]).all()
    for what in {"position", "velocity"} & expected.keys():
        right = np.atleast_2d(expected[what])
        assert getattr(world, what) == pytest.approx(right, rel=0, abs=expected["within"]), what
    if "ledger" in expected:
        assert re.fullmatch(expected["ledger"], run.text()), run.text()
    if "last" in expected:
        assert run.ledger["time"][-1] == pytest.approx(expected["last"], rel=0, abs=expected["last_within"])
