"""`python -m bounce_env scenes`: what it prints, and its exit codes."""

import subprocess
import sys
from pathlib import Path

import gymnasium as gym
import pytest

import bounce_env.commands
from bounce_env.commands import main
from bounce_env.extras import install_command
from bounce_env.scene import builtin_scenes, load_scene
from tests.conftest import SOAK

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "configs" / "scenes").glob("*.toml"))
QUICK = ["--balls", "3000", "--seconds", "15", "--scores", "100"]

BROKEN = """
gravity = [0, "down"]
[[elements]]
type = "bumper"
center = [0, 0]
radius = -1
"""


def test_the_module_explains_itself_without_a_warning():
    command = [sys.executable, "-W", "error", "-m", "bounce_env", "scenes", "check", "--help"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("usage: python -m bounce_env scenes check")
    for option in ("--balls", "--seed", "--seconds", "--scores", "--show"):
        assert option in done.stdout


def test_list_names_every_scene_with_its_contents(capsys):
    assert main(["scenes", "list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(builtin_scenes())
    assert lines[list(builtin_scenes()).index("paddle")].split("  ")[-1].strip() == (
        "1.1 x 1.5 m: 3 walls, 4 bumpers, 1 paddle, 1 sensor"
    )


def test_check_passes_a_sound_scene(capsys):
    assert main(["scenes", "check", "paddle", *QUICK]) == 0
    printed = capsys.readouterr()
    assert printed.out.splitlines()[-1] == "paddle: nothing wrong"
    assert "drained: " in printed.out
    assert printed.err == ""  # no bar without a terminal


@pytest.mark.parametrize("path", EXAMPLES if SOAK else EXAMPLES[-1:], ids=lambda path: path.stem)
def test_check_passes_the_example_scenes(path: Path, capsys):
    balls = "100000" if SOAK else "20000"
    assert main(["scenes", "check", str(path), "--balls", balls]) == 0, capsys.readouterr().out


def test_check_passes_the_pinball_table(capsys):
    balls = "100000" if SOAK else "3000"
    assert main(["scenes", "check", "pinball", "--balls", balls]) == 0, capsys.readouterr().out


def test_check_prints_problems_with_the_balls_that_show_them(capsys):
    assert main(["scenes", "check", "paddle", "--balls", "500", "--scores", "1", "--show", "2"]) == 1
    lines = capsys.readouterr().out.splitlines()
    first = next(i for i, line in enumerate(lines) if "problem: a ball scores more than 1 times" in line)
    assert "from position (" in lines[first + 1]
    assert "from position (" in lines[first + 2]
    assert lines[first + 3].endswith("more: --show 0 prints all")


def test_check_prints_every_error_of_every_file(tmp_path, capsys):
    broken = tmp_path / "broken.toml"
    broken.write_text(BROKEN)
    assert main(["scenes", "check", str(broken), "paddle", *QUICK]) == 1
    printed = capsys.readouterr().out
    assert "gravity" in printed
    assert "radius = -1" in printed
    assert "paddle: nothing wrong" in printed  # the second is checked nevertheless


@pytest.mark.parametrize(
    ("words", "error"),
    [
        ("check", "files: must be at least one"),
        ("check nowhere", "scene 'nowhere': must be one of bowl, box"),
        ("check paddle no/such.toml", "scene 'no/such.toml': there is no such file"),
        ("check paddle --balls 0", "--balls 0: must be from 1 to"),
        ("check paddle --seed -1", "--seed -1: must be >= 0"),
        ("check paddle --seconds nan", "--seconds nan: must be from 10.0 to 3600.0"),
        ("check paddle --scores 0", "--scores 0: must be from 1 to"),
        ("check paddle --show -1", "--show -1: must be >= 0"),
        ("draw nowhere -o x.png", "scene 'nowhere': must be one of"),
        ("draw paddle -o x.jpg", "--output x.jpg: must end in .png"),
        ("draw paddle -o no/x.png", "--output no/x.png: there is no folder no"),
        ("draw paddle -o x.png --width 0", "--width = 0: must be None or an integer from 1 to 8192 (pixels)"),
    ],
)
def test_bad_usage_is_told_in_a_line_and_does_nothing(words, error, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["scenes", *words.split()]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert printed.err.startswith(f"error: {error}")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("words", ["", "scene", "scenes", "scenes check paddle --balls many", "scenes draw"])
def test_words_that_are_no_command_end_with_2(words, capsys):
    with pytest.raises(SystemExit) as ended:
        main(words.split())
    assert ended.value.code == 2
    capsys.readouterr()


def test_draw_writes_a_picture_and_nothing_else(tmp_path, capsys):
    import pygame

    picture = tmp_path / "paddle.png"
    assert main(["scenes", "draw", "paddle", "-o", str(picture), "--height", "300"]) == 0
    assert list(tmp_path.iterdir()) == [picture]
    image = pygame.image.load(picture)
    assert image.get_height() == 300
    x, y = image.get_width() // 2, round(300 * (1.43 - 0.08) / 1.56)
    assert image.get_at((x, y))[1] > 150  # the paddle, in the middle of its rail
    assert capsys.readouterr().out == f"{picture}: {image.get_width()} x 300 pixels\n"


def test_draw_keeps_the_old_picture_when_it_fails(tmp_path, monkeypatch, capsys):
    import pygame

    def half(surface, path):
        Path(path).write_bytes(b"half")
        raise OSError("no space left")

    picture = tmp_path / "paddle.png"
    picture.write_bytes(b"old")
    monkeypatch.setattr(pygame.image, "save", half)
    assert main(["scenes", "draw", "paddle", "-o", str(picture)]) == 2
    assert "no space left" in capsys.readouterr().err
    assert picture.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [picture]


@pytest.mark.parametrize("missing", ["tyro", "tqdm"])
def test_what_is_not_installed_is_named(missing, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, missing, None)
    for module in [name for name in sys.modules if name.startswith("bounce_env.commands.")]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setattr(sys.modules["bounce_env.commands"], "__path__", bounce_env.commands.__path__)
    assert main(["scenes", "check", "paddle"]) == 2
    error = f"error: the commands need {missing}, which is not installed. Install the extra 'cli': "
    assert capsys.readouterr().err == f"{error}{install_command('cli')}\n"


def test_draw_writes_beside_the_scene(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "attic.toml").write_bytes(EXAMPLES[0].read_bytes())
    assert main(["scenes", "draw", "tables/attic.toml"]) == 0
    assert main(["scenes", "draw", "pegs"]) == 0
    assert (tmp_path / "tables" / "attic.png").is_file()
    assert (tmp_path / "pegs.png").is_file()
    assert main(["scenes", "draw", "tables"]) == 2
    assert "must be one of bowl, box" in capsys.readouterr().err


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example_scenes_can_be_played(path: Path):
    """Each loads, and an episode ends in it as in any other: with the ball in the drain."""
    assert load_scene(path).elements
    env = gym.make("Bounce/Paddle-v0", scene=str(path), action="discrete")
    low, high = env.observation_space.low, env.observation_space.high
    score = 0.0
    for seed in range(5):
        env.reset(seed=seed)
        ended = False
        while not ended:
            observation, reward, terminated, truncated, info = env.step(1)
            assert (low <= observation).all()
            assert (observation <= high).all()
            score += reward
            ended = terminated or truncated
        assert info["end_reason"] == "drained"
    assert score > 0
