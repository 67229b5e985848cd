"""A missing extra is named, with a command that installs it; and what `doctor` and `--version` tell."""

import json
import os
import shlex
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest
from gymnasium.error import DependencyNotInstalled

import bounce_env
from bounce_env import extras
from bounce_env.commands import main
from bounce_env.extras import MissingExtraError, install_command, missing, source_folder, version
from tests.conftest import require

pytestmark = pytest.mark.fast

ROOT = Path(bounce_env.__file__).parent.parent


class Installed:
    """A distribution with a direct_url.json."""

    def __init__(self, origin):
        self._origin = origin

    def read_text(self, name):
        assert name == "direct_url.json"
        return self._origin if self._origin is None else json.dumps(self._origin)


def installed_from(monkeypatch, origin):
    monkeypatch.setattr(extras.metadata, "distribution", lambda name: Installed(origin))


def test_from_pypi_the_name_is_enough(monkeypatch):
    installed_from(monkeypatch, None)
    assert install_command("cli") == f'{shlex.quote(sys.executable)} -m pip install "bounce_env[cli]"'


@pytest.mark.parametrize(("editable", "option"), [(True, "-e "), (False, "")])
def test_from_a_clone_it_is_the_clones_folder(monkeypatch, tmp_path, editable, option):
    folder = tmp_path / "my clone"
    folder.mkdir()
    (folder / "pyproject.toml").write_text("")
    installed_from(monkeypatch, {"url": folder.as_uri(), "dir_info": {"editable": editable}})
    assert source_folder() == (folder, editable)
    python = shlex.quote(sys.executable)
    assert install_command("sb3") == f'cd {shlex.quote(str(folder))} && {python} -m pip install {option}".[sb3]"'


@pytest.mark.parametrize(
    "origin",
    [
        {"url": "https://example.org/bounce_env.git", "vcs_info": {"vcs": "git", "commit_id": "1"}},
        {"url": "file:///nowhere/bounce_env.whl", "archive_info": {}},
        {"url": "file:///nowhere/gone", "dir_info": {}},
    ],
)
def test_from_anywhere_else_the_name_must_do(monkeypatch, origin):
    installed_from(monkeypatch, origin)
    assert install_command("cli").endswith('-m pip install "bounce_env[cli]"')


def test_from_a_folder_on_the_path_alone_it_is_that_folder(monkeypatch):
    def none(name):
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(extras.metadata, "distribution", none)
    monkeypatch.setattr(extras.metadata, "version", none)
    assert source_folder() == (ROOT, True)
    assert "not installed" in version()


def test_the_command_in_the_error_does_what_it_says(tmp_path):
    """As far as pip resolves it: from the folder that the package was installed from."""
    command = install_command("render").replace(" install ", " install --dry-run --no-deps -q ")
    require("shell", os.name == "posix", "POSIX shell")
    done = subprocess.run(command, shell=True, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_the_error_is_gymnasiums_and_an_import_error():
    error = missing("render", "pygame", "drawing needs")
    assert isinstance(error, DependencyNotInstalled)
    assert isinstance(error, ImportError)
    assert str(error).startswith("drawing needs pygame, which is not installed. Install the extra 'render': ")


def test_without_sb3_importing_it_says_which_extra(tmp_path):
    code = """
import sys
sys.modules["stable_baselines3"] = None
try:
    import bounce_env.sb3
except ImportError as error:
    print(type(error).__name__, error)
"""
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.startswith(f"{MissingExtraError.__name__} BounceVecEnv needs stable_baselines3")
    assert install_command("sb3") in done.stdout


def test_version_and_doctor_need_no_extra(monkeypatch, capsys):
    for module in ("tyro", "tqdm", "imageio_ffmpeg", "pygame"):
        monkeypatch.setitem(sys.modules, module, None)
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"bounce_env {version()}\n"
    assert main(["doctor"]) == 0
    printed = capsys.readouterr().out
    for word in ("python", "processor", "numba", "kernel cache", "display", "ffmpeg"):
        assert any(line.startswith(word) for line in printed.splitlines())


def test_the_console_script_is_there():
    script = Path(sys.executable).parent / "bounce-env"
    if not script.exists():
        script = Path(shutil.which("bounce-env") or "")
    done = subprocess.run([str(script), "--version"], capture_output=True, text=True, check=True)
    assert done.stdout == f"bounce_env {version()}\n"


def test_what_ci_requires_is_not_skipped(monkeypatch):
    require("browser", True, "browser")
    monkeypatch.delenv("BOUNCE_REQUIRE", raising=False)
    with pytest.raises(pytest.skip.Exception, match=r"needs Chromium \(browser\)"):
        require("browser", False, "Chromium")
    monkeypatch.setenv("BOUNCE_REQUIRE", "clients,browser")
    with pytest.raises(pytest.fail.Exception, match="BOUNCE_REQUIRE names 'browser', but there is no Chromium"):
        require("browser", False, "Chromium")


@pytest.mark.parametrize("keywords", ["render_mode='rgb_array'", "obs='pixels'"])
@pytest.mark.parametrize("vector", [False, True])
def test_what_draws_names_its_extra_when_it_is_made(keywords, vector):
    """Not after an episode, when the first picture is asked for."""
    make = f"gym.make_vec('Bounce/Paddle-v0', 2, {keywords})" if vector else f"gym.make('Bounce/Paddle-v0', {keywords})"
    code = f"import sys; sys.modules['pygame'] = None\nimport gymnasium as gym, bounce_env\n{make}"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "MissingExtraError: drawing needs pygame" in done.stderr


def test_pytorch_for_the_cpu_is_named_where_it_is_needed():
    assert "https://download.pytorch.org/whl/cpu" in str(missing("sb3", "torch", "BounceVecEnv needs"))
    assert "torch" not in str(missing("render", "pygame", "drawing needs"))


def test_the_cards_are_there_without_an_import_of_their_own():
    code = "import bounce_env; print(bounce_env.PaddleEnv.__name__, bounce_env.cards.PaddleEnv is bounce_env.PaddleEnv)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "PaddleEnv True\n"


def test_a_window_that_nobody_can_see_is_said(monkeypatch):
    import gymnasium as gym

    from bounce_env.envs import base as module

    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setattr(module, "display_problem", lambda: "there is no display")
    env = gym.make("Bounce/Paddle-v0", render_mode="human", disable_env_checker=True)
    with pytest.warns(UserWarning, match='render_mode "human" shows nothing: there is no display'):
        env.reset(seed=0)
    env.close()
