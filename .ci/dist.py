"""Build wheel and sdist, check them, and try the wheel in a fresh environment of each Python on this machine.

What is tried: the package alone, then with the extras render, cli and lab; sb3 where the PyTorch of constraints.txt
can be installed, which on a machine without PyTorch's own index is Python 3.11. Exits with 1 where anything fails.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
OLDEST = (3, 11)
WITH_SB3 = (3, 11)

BASE = """
import gymnasium as gym
import bounce_env
env = gym.make("Bounce/Paddle-v0")
env.reset(seed=0)
observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
assert observation in env.observation_space
assert bounce_env.load_agent("Bounce/Paddle-v0")(observation).shape == env.action_space.shape
try:
    import bounce_env.sb3
except ImportError as error:
    assert '-m pip install "bounce_env[sb3]"' in str(error), error
else:
    raise AssertionError("bounce_env.sb3: its extra should not be here")
"""
RENDER = """
import gymnasium as gym
import bounce_env
env = gym.make("Bounce/Paddle-v0", render_mode="rgb_array")
env.reset(seed=0)
assert env.render().shape[2] == 3
"""
LAB = """
from bounce_env.lab.server import FILES
from bounce_env.replay.page import page_of
assert FILES and all(file.is_file() for file in FILES.values()), FILES
assert "<canvas" in page_of({})
"""
SB3 = """
import numpy as np
from bounce_env.sb3 import BounceVecEnv
envs = BounceVecEnv("Bounce/Paddle-v0", 4)
envs.reset()
envs.step(np.zeros((4, 1)))
"""


def main() -> int:
    """Build, check, and try on every Python; returns the exit code."""
    folder = ROOT / "dist"
    shutil.rmtree(folder, ignore_errors=True)
    run(sys.executable, "-m", "build", "--outdir", str(folder), str(ROOT))
    run(sys.executable, "-m", "twine", "check", "--strict", *map(str, sorted(folder.iterdir())))
    wheel = next(folder.glob("*.whl"))
    pythons = found_pythons()
    say(f"{wheel.name}: to be tried on {', '.join('.'.join(map(str, version)) for version in pythons)}")
    failed = [version for version, python in pythons.items() if not tried(wheel, python, version)]
    for version in failed:
        say(f"FAILED on Python {'.'.join(map(str, version))}")
    return 1 if failed else 0


def found_pythons() -> dict[tuple[int, int], str]:
    """An interpreter for each version from OLDEST on: on the path, and where version managers keep them."""
    places = [Path(folder) for folder in os.environ.get("PATH", "").split(os.pathsep) if folder]
    for manager in (".pyenv/versions", ".local/share/uv/python", ".asdf/installs/python"):
        places += sorted((Path.home() / manager).glob("*/bin"))
    found: dict[tuple[int, int], str] = {}
    for python in [sys.executable, *(str(p) for place in places for p in sorted(place.glob("python3*")))]:
        if not re.fullmatch(r"python3?(\.\d+)?(\.exe)?", Path(python).name):
            continue
        code = "import sys, venv, ensurepip; print(*sys.version_info[:2])"
        done = subprocess.run([python, "-c", code], capture_output=True, text=True, check=False)
        if done.returncode == 0:
            major, minor = map(int, done.stdout.split())
            if (major, minor) >= OLDEST:
                found.setdefault((major, minor), python)
    return dict(sorted(found.items()))


def tried(wheel: Path, python: str, version: tuple[int, int]) -> bool:
    """Whether the wheel works on one Python; each failure is printed."""
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        try:
            try_on(wheel, python, version, Path(folder))
        except subprocess.CalledProcessError as error:
            say(f"failed: {error.cmd}")
            return False
    say(f"Python {'.'.join(map(str, version))}: fine after {time.monotonic() - began:.0f} s")
    return True


def try_on(wheel: Path, python: str, version: tuple[int, int], folder: Path) -> None:
    """Install and use it, extra by extra, away from the clone."""
    say(f"Python {'.'.join(map(str, version))}: installing the wheel alone, its first step compiles for a minute ...")
    run(python, "-m", "venv", str(folder / "venv"))
    scripts = folder / "venv" / ("Scripts" if os.name == "nt" else "bin")
    own = str(scripts / "python")
    install(own, str(wheel))
    run(own, "-W", "error", "-c", BASE, cwd=folder)
    run(str(scripts / "bounce-env"), "--version", cwd=folder)
    run(str(scripts / "bounce-env"), "doctor", cwd=folder)
    install(own, f"{wheel}[render]")
    run(own, "-W", "error", "-c", RENDER, cwd=folder)
    install(own, f"{wheel}[cli]")
    run(str(scripts / "bounce-env"), "scenes", "list", cwd=folder)
    run(str(scripts / "bounce-env"), "scenes", "draw", "pinball", cwd=folder)
    install(own, f"{wheel}[lab]")
    run(own, "-W", "error", "-c", LAB, cwd=folder)
    if version == WITH_SB3:
        install(own, f"{wheel}[sb3]")
        run(own, "-W", "error", "-c", SB3, cwd=folder)


def install(python: str, what: str) -> None:
    """Install with the versions that were tested together."""
    constraints = str(ROOT / "constraints.txt")
    run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--constraint", constraints, what)


def run(*command: str, cwd: Path | None = None) -> None:
    """Run a command; raises CalledProcessError where it fails."""
    environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "NUMBA_CACHE_DIR")}
    subprocess.run(command, cwd=cwd, check=True, env=environment)


def say(text: str) -> None:
    """Tell whoever waits."""
    print(text, flush=True)  # noqa: T201


if __name__ == "__main__":
    sys.exit(main())
