"""What importing and drawing do to a process: run in one of their own."""

import os
import signal
import subprocess
import sys

import pytest

pytestmark = pytest.mark.fast

DISPLAY_VARIABLES = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER", "PYGAME_HIDE_SUPPORT_PROMPT", "XDG_RUNTIME_DIR")

SCENE = """
import sys
from bounce_env.render import Picture, Renderer, Window
from bounce_env.scene import Scene, Wall
scene = Scene(elements=(Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1))))
"""


def run(program: str, **variables: str) -> subprocess.CompletedProcess[str]:
    env = {name: value for name, value in os.environ.items() if name not in DISPLAY_VARIABLES} | variables
    return subprocess.run(
        [sys.executable, "-W", "error", "-c", SCENE + program], env=env, capture_output=True, text=True, check=False
    )


def test_drawing_needs_no_display_opens_none_and_says_nothing() -> None:
    done = run(
        """
import os
os.environ.pop("PYGAME_HIDE_SUPPORT_PROMPT", None)  # today's Gymnasium sets it, too
frame = Renderer(scene, 84, 84).frame(Picture([(0.5, 0.5)], score=3))
assert frame.max() > 200
import pygame
assert not pygame.display.get_init()
"""
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_pygame_is_imported_by_who_draws_and_not_before() -> None:
    done = run(
        """
assert "pygame" not in sys.modules
Renderer(scene)
assert "pygame" in sys.modules
"""
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


@pytest.mark.parametrize("call", ["Renderer(scene)", "Window((84, 84), 'title', 30)"])
def test_without_pygame_the_error_says_what_to_install(call: str) -> None:
    done = run(
        f"""
sys.modules["pygame"] = None
from gymnasium.error import DependencyNotInstalled
try:
    {call}
except DependencyNotInstalled as error:
    print(error)
"""
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "-m pip install" in done.stdout


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGTERM")
def test_an_open_window_does_not_swallow_the_signal_to_end() -> None:
    done = run(
        """
import os, signal
window = Window((84, 84), "title", 1000)
os.kill(os.getpid(), signal.SIGTERM)
for _ in range(100):
    window.show(Renderer(scene, 84, 84).frame(Picture([(0.5, 0.5)])))
""",
        SDL_VIDEODRIVER="dummy",
    )
    assert done.returncode == -signal.SIGTERM, done.stderr
