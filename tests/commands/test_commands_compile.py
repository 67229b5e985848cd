"""`bounce-env compile`: what it names, and what it refuses before anything is compiled."""

import re

import pytest

from bounce_env.commands import BAD_USAGE, main
from bounce_env.scene import dump_scene, load_scene

pytestmark = pytest.mark.fast


def test_games_and_scenes_are_compiled_by_name(tmp_path, capsys):
    (tmp_path / "mine.toml").write_text(dump_scene(load_scene("box")))
    assert main(["compile", "paddle", "elastic_box", str(tmp_path / "mine.toml")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.partition(":")[0] for line in lines[:3]] == [
        "Bounce/Paddle-v0",
        "elastic_box",
        str(tmp_path / "mine.toml"),
    ]
    assert all(re.search(r": (was there|compiled) \([\d.]+ s\)$", line) for line in lines[:3])
    assert lines[3].startswith("kept in ")


def test_what_is_neither_is_refused_before_anything_is_compiled(capsys):
    assert main(["compile", "paddle", "padle"]) == BAD_USAGE
    out, err = capsys.readouterr()
    assert out == ""
    assert "scene 'padle': must be one of" in err
    assert "(did you mean 'paddle'?); or a game, or all" in err
