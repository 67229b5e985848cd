"""The ledger checker accepts what the engine does where parts move and balls meet, and rejects all else."""

import math
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from bounce_env.scene import Flipper, Paddle, Wall
from tests.conftest import SOAK, soak_count
from tests.reference.ledger_checker import End
from tests.reference.ledger_of_moving import BY_HAND, at_random, run
from tests.reference.ledger_row import CRUSH, PART_STOPS
from tests.reference.ledger_tampering import changes, pair_changes

SECONDS, EVENTS = 3.0, 250  # of random scenes, and events in one piece of them


@pytest.mark.parametrize("name", BY_HAND)
def test_each_changed_or_missing_row_is_noticed(name):
    played = BY_HAND[name]()
    assert played.problems() == []
    tampered = [
        *changes(played.scene, played.ledger, len(played.starts)),
        *pair_changes(played.scene, played.ledger),
    ]
    # The step has no factor in common with the number of changes to a row: in every few rows each of them has its turn.
    tampered = tampered[:: 1 if SOAK else 7]
    unnoticed = [what for what, ledger in tampered if not played._replace(ledger=ledger).problems()]
    assert unnoticed == []


@pytest.mark.parametrize("name", BY_HAND)
def test_a_changed_end_is_noticed(name):
    played = BY_HAND[name]()
    for k, (time, (x, y), (vx, vy), status, asked) in enumerate(played.ends):
        speed = 1e-6 * max(math.hypot(vx, vy), 1.0)
        for end in (
            End(time, (x + 1e-6, y), (vx, vy), status, asked),
            End(time, (x, y - 1e-6), (vx, vy), status, asked),
            End(time, (x, y), (vx + speed, vy), status, asked),
            End(time, (x, y), (vx, vy - speed), status, asked),
            *(End(time, (x, y), (vx, vy), other, asked) for other in {0, 1, 2, 3} - {status}),
        ):
            assert played._replace(ends=[*played.ends[:k], end, *played.ends[k + 1 :]]).problems(), (k, end)


def other_scenes(scene):
    """Scenes in which parts move otherwise, or are elsewhere, and what they differ in."""
    for k, part in scene.parts:
        others = {"b": replace(part, b=part.b * (1.0 - 1e-6) or 1e-6)}
        if isinstance(part, Flipper):
            others["speed"] = replace(part, up_speed=part.up_speed * (1.0 + 1e-6))
            others["length"] = replace(part, length=part.length * (1.0 + 1e-6))
        elif isinstance(part, Wall):
            others["start"] = replace(part, start=(part.start[0] + 1e-6, part.start[1]))
        elif isinstance(part, Paddle):
            others["radius"] = replace(part, radius=part.radius * (1.0 + 1e-6))
        for what, other in others.items():
            yield (
                f"elements[{k}] {what}",
                replace(scene, elements=(*scene.elements[:k], other, *scene.elements[k + 1 :])),
            )


@pytest.mark.parametrize("name", BY_HAND)
def test_a_lawful_run_of_another_scene_is_noticed(name):
    """Each row is right there: the checker must find out what the parts of this scene do."""
    played = BY_HAND[name]()
    struck = {int(element) for element in played.ledger["element"]}
    places, speeds = zip(*played.starts, strict=True)
    for what, scene in other_scenes(played.scene):
        k = int(what.split("]")[0].removeprefix("elements["))
        if k in struck:
            other = run(scene, places, speeds, played.ends[0].asked, played.commands)
            same = other.ledger.tobytes() == played.ledger.tobytes()
            assert same or other._replace(scene=played.scene).problems(), what


@pytest.mark.parametrize("name", ["flippers", "walls", "balls", "piston"])
def test_what_is_passed_through_is_noticed(name):
    """All hits of a part, or of two balls, left out: the run of a scene that does not have them."""
    played = BY_HAND[name]()
    places, speeds = zip(*played.starts, strict=True)
    for k, part in played.scene.parts:
        far = {"pivot": (9.0, 9.0)} if isinstance(part, Flipper) else {}
        if isinstance(part, Wall):
            far = {"start": (9.0, 9.0), "end": (9.5, 9.0), "reach": None}
        if far and (played.ledger["element"][played.ledger["kind"] < PART_STOPS] == k).any():
            elements = (*played.scene.elements[:k], replace(part, **far), *played.scene.elements[k + 1 :])
            other = run(replace(played.scene, elements=elements), places, speeds, played.ends[0].asked, played.commands)
            # What is left of the part are its stops, as they must be.
            rows = other.ledger[(other.ledger["element"] != k) | (other.ledger["kind"] != PART_STOPS)]
            stops = played.ledger[(played.ledger["element"] == k) & (played.ledger["kind"] == PART_STOPS)]
            ledger = np.concatenate([rows, stops])
            ledger = ledger[np.argsort(ledger["time"], kind="stable")]
            problems = other._replace(scene=played.scene, ledger=ledger).problems()
            assert any(f"elements[{k}]" in problem for problem in problems), (k, problems)


def test_balls_that_pass_through_each_other_are_noticed():
    played = BY_HAND["balls"]()
    alone = [
        run(played.scene, [s.position], [s.velocity], played.ends[0].asked, played.commands) for s in played.starts
    ]
    for ball, one in enumerate(alone):
        one.ledger["ball"][one.ledger["kind"] != PART_STOPS] = ball
    rows = np.concatenate([alone[0].ledger, *(one.ledger[one.ledger["ball"] >= 0] for one in alone[1:])])
    ledger = rows[np.argsort(rows["time"], kind="stable")]
    problems = played._replace(ledger=ledger, ends=[one.ends[0] for one in alone]).problems()
    assert problems
    assert all("deep in each other" in problem for problem in problems)


def test_the_runs_have_rows_of_every_kind():
    assert {int(kind) for make in BY_HAND.values() for kind in make().ledger["kind"]} == {0, 1, 2, PART_STOPS, CRUSH}


@pytest.mark.parametrize("point", [False, True])
def test_random_moving_scenes_are_played_right(point):
    seen: Counter[int] = Counter()
    judged = []
    for seed in range(soak_count(100 if point else 25, 3000)):
        played = at_random(seed, point=point, seconds=SECONDS, max_events=EVENTS)
        if played is not None:
            assert played.problems() == [], seed
            seen.update(played.ledger["kind"].tolist())
            judged.append(played.ends[0].time / SECONDS)
    assert min(seen[kind] for kind in (0, 1, PART_STOPS, CRUSH)) > 0, seen
    assert np.mean(judged) > 0.5


def test_the_sign_of_rounding_does_not_crush():
    """On the round end about a flipper's pivot: its surface moves along itself, but for the last bit."""
    assert at_random(487, point=False, seconds=SECONDS, max_events=EVENTS).problems() == []


def test_a_part_slides_past_a_crushed_ball():
    """A paddle along a ball that lies against its flat side: where that side ends it does not close on the ball."""
    assert at_random(187, point=False, seconds=SECONDS, max_events=EVENTS).problems() == []
