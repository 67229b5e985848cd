"""A survey finds what is wrong with a table, and every ball that it names takes the same way in a World."""

from dataclasses import replace

import numpy as np
import pytest

from bounce_env import World
from bounce_env.scene import Scene, Wall, load_scene
from bounce_env.scenecheck import Finding, Survey, findings, survey
from bounce_env.scenecheck.follow import CRUSHES, ENDLESS, LEFT, PLAYING, RATTLES, RESTS, STUCK
from bounce_env.scenecheck.reach import reach_boxes
from bounce_env.scenecheck.run import ENDLESS_AT
from tests.scenecheck.tables import CUP, POCKET, SOUND, WALLED_IN

BALLS = 2000


def surveyed(scene: Scene, balls: int = BALLS, **options: int) -> Survey:
    return survey(scene, balls=balls, seed=0, seconds=20.0, **options)


def problems(result: Survey) -> list[Finding]:
    return [finding for finding in findings(result) if finding.kind == "problem"]


def test_nothing_is_wrong_with_a_sound_table():
    assert problems(surveyed(SOUND, limit=100)) == []


def test_a_cup_is_found_as_one_place_where_balls_rest():
    result = surveyed(CUP, limit=100)
    (trap,) = problems(result)
    assert trap.title.startswith("a ball comes to rest out of reach of every part that an agent moves: ")
    in_cup = result.fates[(result.fates["end"] == RESTS) & (result.fates["y"] < 0.65)]
    assert len(in_cup) > 10
    assert in_cup["y"] == pytest.approx(0.62)
    assert trap.lines[0].startswith("at x 0.3")
    assert f"y 0.62 m: {len(in_cup)} balls, from position" in trap.lines[0]


def test_two_bumpers_that_face_each_other_are_found_as_endless():
    result = surveyed(POCKET)
    endless = next(found for found in problems(result) if "scores more than 20 times" in found.title)
    assert (result.fates["end"] == ENDLESS).sum() > 10
    assert endless.lines[0].startswith("20")  # ENDLESS_AT * 20, and a few at that one instant
    assert "and no end" in endless.lines[0]
    assert len(endless.lines) == (result.fates["run"] > 20).sum()


def test_what_only_balls_in_a_closed_room_touch_is_out_of_reach():
    (shut,) = (found for found in problems(surveyed(POCKET)) if found.title.startswith("only balls"))
    assert [line.split(":")[0].split("'")[1] for line in shut.lines] == ["west", "east"]


def test_a_target_with_walls_around_it_is_found():
    (untouched,) = (found for found in problems(surveyed(WALLED_IN, limit=100)) if "touches" in found.title)
    assert untouched.lines == ("elements[9] (bumper 'target')",)


def test_scores_count_from_when_the_ball_was_last_within_reach():
    """Many scores in all, few in a row; and all of them are those of a World."""
    result = surveyed(SOUND, limit=1)
    start, fate = result.starts, result.fates
    often = np.flatnonzero((fate["scored"] >= 4) & (fate["run"] <= 2) & (fate["reached"] > 0))
    assert len(often)
    row = int(often[0])
    world = World(SOUND)
    world.reset(position=start[row, :2], velocity=start[row, 2:])
    ledger = world.advance(20.0, ledger=True)
    hits = ledger[(ledger["element"] == 3) & (ledger["kind"] == 0)]
    assert len(hits) == fate["scored"][row]


def test_a_world_takes_the_same_way_to_the_bit():
    result = surveyed(CUP, balls=40)
    for start, fate in zip(result.starts, result.fates, strict=True):
        world = World(CUP)
        world.reset(position=start[:2], velocity=start[2:])
        world.advance(20.0)
        if fate["end"] != ENDLESS:
            assert world.position[0].tolist() == [fate["x"], fate["y"]]


def test_a_seed_gives_the_same_survey_and_another_one_another():
    one, same, other = surveyed(SOUND), surveyed(SOUND), survey(SOUND, balls=BALLS, seed=1, seconds=20.0)
    assert one.fates.tobytes() == same.fates.tobytes()
    assert one.fates.tobytes() != other.fates.tobytes()


def test_progress_is_told_of_every_ball():
    told: list[int] = []
    survey(SOUND, balls=1234, seed=0, seconds=5.0, progress=told.append)
    assert sum(told) == 1234
    assert len(told) > 1


def ended(scene: Scene, end: int, **fields: float) -> Survey:
    """A survey of one ball that ended so."""
    result = surveyed(scene, balls=1)
    result.fates["end"] = end
    for name, value in fields.items():
        result.fates[name] = value
    result.touched[:] = 1
    result.freely[:] = 1
    return result


@pytest.mark.parametrize(
    ("end", "words"),
    [
        (STUCK, "goes on out of reach of every part that an agent moves for 10 s"),
        (LEFT, "leaves the scene and crosses no drain: 1 ball"),
        (CRUSHES, "is crushed (status CRUSHED)"),
        (RATTLES, "so many events that games would end (status BUDGET)"),
    ],
)
def test_other_ends_that_are_problems(end: int, words: str):
    result = ended(SOUND, end, x=0.5, y=0.7)
    (problem,) = problems(result)
    assert words in problem.title
    x, y, vx, vy = result.starts[0].tolist()
    assert f"position ({x!r}, {y!r}) velocity ({vx!r}, {vy!r})" in problem.lines[0]


def test_a_ball_that_rests_within_reach_is_no_problem():
    x_min, y_min, x_max, y_max = reach_boxes(SOUND)[0]
    result = ended(SOUND, RESTS, x=0.5 * (x_min + x_max), y=0.5 * (y_min + y_max))
    assert problems(result) == []
    assert any("rest within reach" in found.title for found in findings(result))
    assert len(problems(ended(SOUND, RESTS, x=0.5, y=y_max + 1e-9))) == 1


def test_a_ball_still_in_play_is_no_problem():
    assert problems(ended(SOUND, PLAYING)) == []


def test_in_a_box_from_which_nothing_leads_no_ball_is_stuck():
    closed = replace(SOUND, elements=SOUND.elements[:4])
    result = replace(ended(SOUND, STUCK), scene=closed)
    assert problems(result) == []
    assert "still in play after 20 s: 1 ball (100 %)" in [found.title for found in findings(result)]


def test_a_ball_that_scores_on_is_followed_no_longer():
    result = surveyed(POCKET, limit=5)
    runs = result.fates["run"][result.fates["end"] == ENDLESS]
    assert (runs > ENDLESS_AT * 5).all()
    assert (runs < ENDLESS_AT * 5 + 40).all()


def test_without_an_inside_a_ball_may_leave():
    open_table = replace(SOUND, elements=(*SOUND.elements[3:], Wall((0.0, 1.4), (1.0, 1.4))))
    result = surveyed(open_table, limit=100)
    assert not result.is_table
    assert (result.fates["end"] == LEFT).any()
    assert not any("leaves" in found.title for found in problems(result))


def test_a_bumper_that_stands_on_its_rail_is_a_bumper():
    """It never comes back to where it was, for it never leaves: no ball waits for it."""
    scene = load_scene("paddle_levels")
    still = tuple(replace(e, speed=0.0) if e.name == "bumper_top" else e for e in scene.elements)
    assert problems(surveyed(replace(scene, elements=still), balls=300)) == []
