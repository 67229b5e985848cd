"""`python -m bounce_env play`: what it refuses, and a play in a window that nobody sees."""

from dataclasses import fields

import pytest

from bounce_env.commands import main, play
from bounce_env.commands.cli import Refused
from bounce_env.commands.games import game_id
from bounce_env.commands.options import Play
from bounce_env.envs.paddle import PaddleEnv
from bounce_env.envs.pinball import PinballEnv
from bounce_env.envs.walls import WallsEnv


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


def test_any_key_starts_a_play(monkeypatch):
    """Without --frames it waits for one."""
    seen = []
    monkeypatch.setattr(play, "play", lambda session, *rest: seen.append(session.waits))
    assert main(["play", "paddle", "--height", "100"]) == 0
    assert main(["play", "paddle", "--height", "100", "--frames", "1"]) == 0
    assert seen == [True, False]


@pytest.mark.parametrize("env_type", [PaddleEnv, PinballEnv, WallsEnv])
def test_every_keyword_of_a_game_is_an_option(env_type):
    assert set(env_type.defaults()) - {"render_mode", "record_events"} <= {field.name for field in fields(Play)}


def test_keywords_reach_the_game(monkeypatch):
    seen = {}
    monkeypatch.setattr(play, "play", lambda session, *rest: seen.update(env=session._env.unwrapped))
    words = "play pinball --nudge --balls 5 --time-limit 0 --obs pixels --obs-width 40 --trail 0.5 --frames 1"
    assert main([*words.split(), "--width", "100"]) == 0
    game = seen["env"]._batch.game
    assert (game.options.balls, game.options.nudge, game.options.time_limit) == (5, True, None)
    assert (game.options.action, game.options.frame_skip) == ("buttons", 1)
    assert seen["env"].observation_space.shape[1] == 40
    assert seen["env"]._frames.size[0] == 100


def test_without_a_display_it_says_so_before_anything_is_compiled(monkeypatch, capsys):
    for name in ("SDL_VIDEODRIVER", "DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.setattr(play.games, "made", None)
    for words, instead in (("play paddle", "watch paddle --film FILE.mp4"), ("watch paddle", "--film FILE.mp4 writes")):
        assert main(words.split()) == 2
        assert f"there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set; {instead}".split(";")[0] in (
            error := capsys.readouterr().err
        )
        assert instead in error


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
        ("padle", "game 'padle': must be one of"),
        ("paddle --balls 3", "balls = 3: unknown keyword: must be one of scene"),
        ("paddle --scene attik.toml", "scene 'attik.toml': there is no such file"),
    ],
)
def test_bad_usage_is_told_in_a_line(words, error, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["play", *words.split(), *([] if "--frames" in words else ["--frames", "1"])]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith(f"error: {error}")
