"""Replays on disk: a stored one opens for ever, what is none is refused with the place, and data is never code."""

import base64
import copy
import hashlib
import html
import json
import re
from pathlib import Path

import pytest

from bounce_env import Ball, Scene, Wall, World, load_replay, replay_of
from bounce_env.commands import BAD_USAGE, main
from bounce_env.replay import read_document
from bounce_env.scene import load_scene

pytestmark = pytest.mark.fast

STORED = Path(__file__).parent / "stored"
V1 = json.loads((STORED / "v1.json").read_text())


def test_a_stored_replay_opens_as_document_and_as_page(tmp_path):
    alone, in_page = load_replay(STORED / "v1.json"), load_replay(STORED / "v1.html")
    assert alone.document == in_page.document == V1
    assert alone.document["about"] == {"id": "Bounce/Own-v0", "kwargs": {"time_limit": 2}, "seed": 7}
    (instant, *switched) = alone.document["changes"][0]
    assert (alone.document["instants"][instant], *switched) == (0.6, 1, "disabled", True)
    (tmp_path / "own.toml").write_text(alone.document["scene"])
    assert [element.name for element in load_scene(tmp_path / "own.toml").elements][1:] == ["ramp", "flipper"]


def test_the_command_makes_a_page(tmp_path, capsys):
    copied = tmp_path / "run.json"
    copied.write_text((STORED / "v1.json").read_text())
    assert main(["replay", str(copied)]) == 0
    assert capsys.readouterr().out.strip() == str(tmp_path / "run.html")
    assert load_replay(tmp_path / "run.html").document == V1
    assert main(["replay", str(copied), "-o", str(tmp_path / "page.txt")]) == BAD_USAGE
    assert "must end in .html" in capsys.readouterr().err
    assert main(["replay", str(tmp_path / "none.json")]) == BAD_USAGE
    assert "none.json: cannot be read: No such file" in capsys.readouterr().err


def changed(path, value):
    document = copy.deepcopy(V1)
    place = document
    for step in path[:-1]:
        place = place[step]
    if value is None:
        del place[path[-1]]
    else:
        place[path[-1]] = value
    return json.dumps(document)


REFUSED = {
    "not JSON": ("{", "run.json: cannot be read as JSON"),
    "a list": ("[]", "run.json: must be an object of JSON"),
    "later format": (changed(["format"], 2), "run.json: format = 2: this version of bounce_env reads 1"),
    "no format": (changed(["format"], None), "run.json: format = missing: this version of bounce_env reads 1"),
    "no balls": (changed(["balls"], None), "run.json: balls"),
    "too short a flight": (changed(["balls", 0, 0], [0, 1]), r"run.json: balls\[0\]\[0\]"),
    "a word for a number": (changed(["end"], "1"), "run.json: end = '1': Input should be a valid number"),
    "what is not known": (changed(["more"], 1), "run.json: more = 1"),
    "element that is not there": (changed(["parts", 0, "element"], 9), r"run.json: parts\[0\].element = 9: must be"),
    "instant that is not there": (
        changed(["balls", 0, 0, 0], 999),
        r"run.json: balls\[0\]\[0\]\[0\] = 999: must be below",
    ),
    "ball that is not there": (changed(["events", 1, 2], 9), r"run.json: events\[1\]\[2\] = 9: must be below 1"),
    "instants that go back": (changed(["instants", 3], 0.0), "run.json: instants: each must be greater"),
    "kind that is not there": (changed(["events", 0, 1], 99), r"run.json: events\[0\]\[1\] = 99: must be below"),
    "field that is not there": (changed(["changes", 0, 2], "x"), r"run.json: changes\[0\]\[2\] = 'x': must be a field"),
    "true for a format": (changed(["format"], True), "run.json: format = True"),
    "a number that JSON lacks": (changed(["about", "x"], float("inf")), "Infinity is no number of JSON"),
    "a scene that is none": (changed(["scene"], "x"), "run.json: scene: is not TOML"),
    "another scene": (changed(["scene"], ""), "run.json: elements: must be those of the scene, 0"),
    "an arc without a radius": (changed(["elements", 0, "radius"], None), r"elements\[0\]: lacks \['radius'\]"),
    "an end that is none": (changed(["elements", 1, "start"], "x"), r"elements\[1\].start = 'x': must be that of"),
    "a box without a size": (changed(["bounds"], [1.0, 0.0, 0.0, 0.0]), "run.json: bounds = "),
    "a box that is too large": (changed(["bounds"], [-1e308, 0, 1e308, 0]), r"run.json: bounds\[0\]"),
    "a part with too few numbers": (changed(["parts", 0, "paths", 0, 1], [0.0]), r"parts\[0\].paths: each must have 4"),
    "a switch that is none": (changed(["changes", 0, 3], 1), r"changes\[0\]\[3\] = 1: must be true or false"),
    "a change that is none": (changed(["changes", 0, 2], "start"), r"changes\[0\].*start"),
    "a series without a length": (changed(["balls", 0, -1, 1], 0), r"balls\[0\]\[\d+\]: must end after it begins"),
    "more than there can be": (changed(["lost"], 10**400), "run.json: lost"),
    "not a number": (changed(["end"], float("nan")), "run.json: "),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_replay_is_refused_with_the_place(name):
    text, words = REFUSED[name]
    with pytest.raises(ValueError, match=words):
        read_document(text, "run.json")


def test_names_are_data_and_nothing_is_loaded():
    page = load_replay(STORED / "v1.json").html
    assert V1["elements"][0]["name"] == "</script><script>alert(1)</script>"
    scripts = re.findall(r"<script([^>]*)>(.*?)</script>", page, re.DOTALL)
    assert [attributes for attributes, _ in scripts] == [' type="application/json" id="replay"', ' type="module"']
    assert "alert(1)" not in scripts[1][1]
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', page)[1]
    hashes = [
        base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() for text in (scripts[1][1], style(page))
    ]
    assert policy == f"default-src 'none'; script-src 'sha256-{hashes[0]}'; style-src 'sha256-{hashes[1]}'"
    assert not re.search(r"\b(src|href)=|https?://|url\(|@import|innerHTML|\beval\b", page)


def style(page):
    return re.search(r"<style>(.*?)</style>", page, re.DOTALL)[1]


def test_a_notebook_shows_the_page_in_a_frame_of_its_own():
    replay = load_replay(STORED / "v1.json")
    frame = replay._repr_html_()
    assert re.match(r'<iframe sandbox="allow-scripts" [^>]*srcdoc="[^"]*"></iframe>\Z', frame)
    assert html.unescape(re.search(r'srcdoc="([^"]*)"', frame)[1]) == replay.html


def test_a_world_has_a_replay_and_it_is_written_whole_or_not_at_all(tmp_path):
    world = World(Scene(ball=Ball(0.1), elements=(Wall((-1, 0), (1, 0), name="floor"),), gravity=(0, -1)))
    world.record()
    world.reset(position=(0, 1), velocity=(0, 0))
    world.advance(5.0)
    replay = replay_of(world.recorded())
    assert read_document(replay.json) == replay.document
    assert [event[3] for event in replay.document["events"]] == [0] * len(world.recorded().ledger)
    assert replay.save(tmp_path / "run.json").read_text() == replay.json
    with pytest.raises(OSError, match="none"):
        replay.save(tmp_path / "none" / "run.html")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.json"]


def test_a_run_that_has_only_begun_and_one_that_goes_on_elsewhere():
    world = World(Scene(ball=Ball(0.1), elements=(Wall((-1, 0), (1, 0), name="floor"),), gravity=(0, -1)))
    world.record()
    world.reset(position=(0, 1), velocity=(0, 0))
    assert replay_of(world.recorded()).document["balls"] == [[[0, 0, 1, 0, 0, 0, -1]]]
    world.advance(0.5)
    kept = world.snapshot()
    world.push((1.0, 0.0))
    world.enable("floor", False)
    run = world.recorded()
    assert run.balls[0][-1][3:5] == tuple(world.velocity[0])
    assert [change[1:] for change in run.changes] == [(0, "disabled", True)]
    world.restore(kept)
    with pytest.raises(RuntimeError, match="nothing is recorded"):
        world.recorded()
    nothing = World(Scene())
    nothing.record()
    nothing.reset(position=(0, 0), velocity=(1, 0))
    nothing.advance(1.0)
    document = replay_of(nothing.recorded()).document
    assert document["bounds"] == [-1.0, -1.0, 1.0, 1.0]
    assert read_document(replay_of(nothing.recorded()).json) == document
