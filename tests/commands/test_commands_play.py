"""`python -m bounce_env play`: what it refuses, and a play in a window that nobody sees."""

import time

import pytest

from bounce_env.commands import main, play
from bounce_env.commands.play import game_id
from bounce_env.commands.words import Refused


@pytest.fixture(autouse=True)
def dummy_display(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


def test_a_game_has_an_id_and_a_short_name():
    assert game_id("paddle") == game_id("Bounce/Paddle-v0") == "Bounce/Paddle-v0"
    with pytest.raises(Refused, match=r"game 'chess': must be one of .*paddle, .*Bounce/Paddle-v0"):
        game_id("chess")


def test_a_play_of_some_frames_ends_with_its_score(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["play", "paddle", "--frames", "5", "--seed", "1", "--height", "200"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "launches of seed 1" in lines[0]
    assert lines[-1] == "score 0"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("slow", [True, False])
def test_compiling_is_spoken_of_only_where_it_takes_long(slow, monkeypatch, capsys):
    monkeypatch.setattr(play, "PATIENCE", 0.0 if slow else 600.0)
    monkeypatch.setattr(play, "prepare", lambda env: time.sleep(0.5 * slow))
    assert main(["play", "paddle", "--frames", "1", "--height", "100"]) == 0
    assert ("compiling" in capsys.readouterr().out) == slow


@pytest.mark.parametrize(
    ("words", "error"),
    [
        ("chess", "game 'chess': must be one of pinball, paddle"),
        ("paddle --scene nowhere", "scene 'nowhere': must be one of"),
        ("paddle --scene no/such.toml", "scene 'no/such.toml': there is no such file"),
        ("paddle --scene box", "a scene for the paddle game: paddles = 0: must be exactly 1"),
        ("paddle --seed -1", "--seed -1: must be from 0 to 4294967295"),
        ("paddle --frames 0", "--frames 0: must be >= 1"),
        ("paddle --films nowhere", "--films nowhere: must be a folder that is there"),
        ("paddle --width 0", "width = 0: must be None or an integer from 1 to 8192 (pixels)"),
    ],
)
def test_bad_usage_is_told_in_a_line(words, error, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["play", *words.split(), *([] if "--frames" in words else ["--frames", "1"])]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith(f"error: {error}")
