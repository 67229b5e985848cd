"""Kernels are kept on disk where that is possible, and the engine works, with a word to its user, where it is not."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import bounce_env

pytestmark = pytest.mark.slow

PACKAGE = Path(bounce_env.__file__).parent
RUN = """
from bounce_env import Scene, Wall, World
from bounce_env.engine import world_kernels
world = World(Scene(gravity=(0.0, 0.0), elements=(Wall((0.0, 0.0), (1.0, 0.0)),)))
world.reset(position=(0.5, 1.0), velocity=(0.0, -1.0))
world.advance(1.5)
stats = world_kernels.world_advance.stats
print(world.velocity[0, 1], sum(stats.cache_hits.values()), sum(stats.cache_misses.values()))
"""


@pytest.fixture
def site(tmp_path):
    """A folder with a copy of the package alone."""
    shutil.copytree(PACKAGE, tmp_path / "site" / "bounce_env", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path / "site"


def run_in(site: Path, **variables: str) -> tuple[list[str], str]:
    """What RUN prints with the package in `site`, and what it says on stderr."""
    environment = {key: value for key, value in os.environ.items() if key != "NUMBA_CACHE_DIR"}
    environment |= {"PYTHONPATH": str(site), "PYTHONDONTWRITEBYTECODE": "1", **variables}
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", RUN],
        env=environment,
        cwd=site,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.split(), done.stderr


def without_pycache(site: Path) -> None:
    """Let nobody, not even root, put a cache beside the sources."""
    for folder in [path for path in (site / "bounce_env").rglob("*") if path.is_dir()]:
        shutil.rmtree(folder / "__pycache__", ignore_errors=True)
        (folder / "__pycache__").write_text("")


def test_it_says_once_before_it_compiles_and_nothing_when_it_need_not(site):
    printed, said = run_in(site)
    assert printed == ["1.0", "0", "1"]
    assert said.count("\n") == 1
    assert "compiling kernels, up to a minute" in said
    assert str(site / "bounce_env" / "engine" / "__pycache__") in said
    assert run_in(site) == (["1.0", "1", "0"], "")


def test_where_nothing_can_be_written_kernels_live_in_memory(site):
    without_pycache(site)
    nowhere = {"HOME": "/proc/none", "XDG_CACHE_HOME": "/proc/none"}
    printed, said = run_in(site, **nowhere)
    assert printed == ["1.0", "0", "1"]
    assert "NUMBA_CACHE_DIR" in said
    assert "in each process" in said


def test_a_folder_of_the_users_own_is_used_where_the_package_is_read_only(site, tmp_path):
    without_pycache(site)
    for variables in ({"NUMBA_CACHE_DIR": str(tmp_path / "given")}, {"XDG_CACHE_HOME": str(tmp_path / "home")}):
        assert run_in(site, **variables)[0] == ["1.0", "0", "1"]
        assert run_in(site, **variables) == (["1.0", "1", "0"], "")


DAMAGES = {
    "empty": lambda path: path.write_bytes(b""),
    "cut": lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
    "garbage": lambda path: path.write_bytes(b"\x80\x05garbage."),
}


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("kind", ["*.nbi", "*.nbc"])
def test_a_damaged_cache_is_begun_afresh(site, kind, damage):
    run_in(site)
    files = list((site / "bounce_env").rglob(kind))
    assert files
    for path in files:
        DAMAGES[damage](path)
    printed, said = run_in(site)
    assert printed[0] == "1.0"
    assert "NUMBA_CACHE_DIR" not in said
    assert run_in(site) == (["1.0", "1", "0"], "")


def test_an_index_that_can_be_neither_read_nor_replaced_is_said_and_done_without(site):
    """As of another user, in a shared folder: a folder in its place stops root, too."""
    run_in(site)
    for path in list((site / "bounce_env").rglob("*.nbi")):
        path.unlink()
        path.mkdir()
        (path / "full").write_text("")
    printed, said = run_in(site)
    assert printed[0] == "1.0"
    assert said.count("NUMBA_CACHE_DIR") == 1
