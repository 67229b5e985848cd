"""How kernels are compiled: cached on disk, keyed by all sources, one per set of features."""

import os
import pickle
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import bounce_env
from bounce_env import Ball, Bumper, Scene, Wall, World
from bounce_env.engine import world_kernels

pytestmark = pytest.mark.slow

PACKAGE = Path(bounce_env.__file__).parent
RUN = """
from bounce_env import Scene, Wall, World
from bounce_env.engine import world_kernels as m
w = World(Scene(gravity=(0.0, 0.0), elements=(Wall((0.0, 0.0), (1.0, 0.0)),)))
w.reset(position=(0.5, 1.0), velocity=(0.0, -1.0))
w.advance(1.5)
print(sum(m.world_advance.stats.cache_hits.values()), sum(m.world_advance.stats.cache_misses.values()))
print(w.velocity[0, 1])
"""


def run_in(folder: Path) -> list[str]:
    """Output of RUN with the copy of the package in `folder`."""
    environment = {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", RUN], env=environment, cwd=folder, capture_output=True, text=True, check=True
    )
    return done.stdout.split()


def test_second_process_compiles_nothing_and_an_edited_helper_is_noticed(tmp_path: Path) -> None:
    """Numba itself looks at the file of the kernel alone; here an edit three modules away, in a subfolder, counts."""
    shutil.copytree(PACKAGE, tmp_path / "bounce_env", ignore=shutil.ignore_patterns("__pycache__"))
    assert run_in(tmp_path) == ["0", "1", "1.0"]
    assert run_in(tmp_path) == ["1", "0", "1.0"]
    law = tmp_path / "bounce_env" / "engine" / "contact" / "restitution.py"
    source = law.read_text()
    assert source.count("uy + (rebound * ny") == 1
    law.write_text(source.replace("uy + (rebound * ny", "uy + (0.5 * rebound * ny"))
    indices = list(tmp_path.rglob("*.nbi"))
    assert indices
    for index in indices:
        with index.open("rb") as file:
            version = pickle.load(file)
        # What follows the version names a class that there is no longer, as after an upgrade in place.
        index.write_bytes(pickle.dumps(version) + b"cbounce_env.engine.compile.jit\nGone\n.")
    assert run_in(tmp_path) == ["0", "1", "0.5"]


def test_an_edit_elsewhere_compiles_nothing_anew(tmp_path: Path) -> None:
    """What no kernel is made of: of a game for the engine's kernels, of a card for any."""
    shutil.copytree(PACKAGE, tmp_path / "bounce_env", ignore=shutil.ignore_patterns("__pycache__"))
    assert run_in(tmp_path) == ["0", "1", "1.0"]
    for name in ("games/paddle/rules.py", "envs/paddle.py"):
        with (tmp_path / "bounce_env" / name).open("a") as file:
            file.write("# edited\n")
    assert run_in(tmp_path) == ["1", "0", "1.0"]


def test_scenes_of_one_feature_set_share_a_kernel() -> None:
    """However many walls and bumpers: one signature. Without walls: another one, that has none of their code.

    With drag, for no other test of this process may have had the same features.
    """
    walls = [Wall((0.0, 0.0), (1.0, 0.0)), Wall((0.0, 2.0), (1.0, 2.0)), Wall((-1.0, 0.0), (-1.0, 1.0))]
    bumpers = [Bumper((5.0, 5.0), 0.1), Bumper((6.0, 5.0), 0.2)]

    def signatures_after(elements: list[Wall | Bumper]) -> int:
        world = World(Scene(gravity=(0.0, -1.0), drag=0.5, ball=Ball(radius=0.1), elements=tuple(elements)))
        world.reset(position=(0.5, 1.0), velocity=(0.0, 0.0))
        world.advance(0.5)
        assert np.isfinite(world.position).all()
        return len(world_kernels.world_advance.signatures)  # type: ignore[attr-defined]

    first = signatures_after([*walls[:1], *bumpers[:1]])
    assert signatures_after([*walls, *bumpers]) == first
    assert signatures_after([*bumpers]) == first + 1


PLAY = """
import gymnasium as gym
import bounce_env
for game in ("Paddle", "Pinball", "Walls"):
    env = gym.make(f"Bounce/{game}-v0", disable_env_checker=True)
    env.reset(seed=3)
    for _ in range(3):
        print(env.step(env.action_space.sample() * 0)[0].tobytes().hex())
"""


def test_with_the_jit_off_games_play_the_same_bits_and_warn_of_nothing() -> None:
    """NumPy's scalars warn where compiled integers silently wrap around."""
    run = [sys.executable, "-W", "error", "-c", PLAY]
    off = subprocess.run(run, env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, capture_output=True, text=True, check=False)
    assert off.returncode == 0, off.stderr
    on = subprocess.run(run, capture_output=True, text=True, check=True)
    assert off.stdout == on.stdout
