"""Every bug found has left a scene in `cases/`; they are all replayed here.

A case is two files of one name. NAME.toml: the scene. NAME.json: what went wrong (`bug`), `position` [m] and `velocity`
[m/s] of the start, a `script` of seconds to advance and commands (["push", [dvx, dvy]], ["enable", name, bool]), if
need be `max_events`, and what is `expected` at its end: `status`, and where they matter `position` and `velocity` (both
within `within`), `last`, the time of the last row of the ledger (within `last_within`), and `ledger`, a regular
expression of its rows spelled "element kind" ("floor bounce, floor begin").

They are replayed in the kernel that has all features, so that no scene needs one compiled for itself.
"""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from stability_case import STATUS, Run, new_world

from bounce_env import load_scene

FOLDER = Path(__file__).parent / "cases"
NAMES = sorted(path.stem for path in FOLDER.glob("*.json"))


def replay(name: str) -> tuple[Run, dict[str, Any]]:
    """What came of a case, and what is expected of it."""
    case = json.loads((FOLDER / f"{name}.json").read_text())
    world = new_world(load_scene(FOLDER / f"{name}.toml"))
    world.reset(position=case["position"], velocity=case["velocity"])
    pages = []
    for step in case["script"]:
        if isinstance(step, list):
            getattr(world, step[0])(*step[1:])
        else:
            pages.append(world.advance(step, ledger=True, max_events=case.get("max_events", 20_000)))
    run = Run([element.name for element in world.scene.elements], np.concatenate(pages))
    run.position, run.velocity = tuple(world.position[0].tolist()), tuple(world.velocity[0].tolist())
    run.status = STATUS[int(world.status[0])]
    return run, case["expected"]


def test_every_case_is_complete() -> None:
    assert {path.stem for path in FOLDER.glob("*.toml")} == set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_bug_has_not_come_back(name: str) -> None:
    run, expected = replay(name)
    assert run.status == expected["status"]
    assert np.isfinite([*run.position, *run.velocity]).all()
    for what in {"position", "velocity"} & expected.keys():
        assert getattr(run, what) == pytest.approx(expected[what], rel=0, abs=expected["within"]), what
    if "ledger" in expected:
        assert re.fullmatch(expected["ledger"], run.text()), run.text()
    if "last" in expected:
        assert run.ledger["time"][-1] == pytest.approx(expected["last"], rel=0, abs=expected["last_within"])
