"""A kernel contains nothing of a feature that no scene has: told by what is compiled, in a process of its own."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from bounce_env.scene import builtin_scenes, load_scene
from tests.conftest import SOAK

ROOT = Path(__file__).parents[2]

ONLY_FOR = {
    "arcs": {"impact.quartic"},
    "circles": {"impact.circle"},
    "curved_contact": {"motion.elliptic", "motion.curve_slide", "detect.along_curve", "impact.curve_path"},
    "moving_parts": {"motion.parts", "impact.capsule", "motion.carried", "events.part_stops", "events.crushing"},
    "flippers": {"impact.rotating_capsule", "motion.sincos"},
    "dragged_walls": {"impact.stretching_wall", "motion.dragged_wall"},
    "several_balls": {"detect.pairs", "contact.cluster", "contact.cluster_motion", "contact.collisions"},
}
"""Files of the engine in which there is code only for a feature."""


def compiled(folder: Path, *features: str) -> tuple[int, set[str]]:
    """Bytes of machine code of what advances a batch with these features, and the files that it comes from."""
    words = [sys.executable, "-m", "tests.report.compiled_functions", *features]
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder)}
    run = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    size, modules = json.loads(run.stdout)
    return int(size), set(modules)


@pytest.mark.slow
def test_what_a_scene_does_not_need_is_not_compiled(tmp_path: Path):
    size, modules = compiled(tmp_path, "ball_radius", "walls", "circles")
    for feature, files in ONLY_FOR.items():
        assert bool(modules & files) == (feature == "circles"), feature
    assert size < 100_000


@pytest.mark.slow
@pytest.mark.skipif(not SOAK, reason="compiles for half a minute")
def test_what_it_needs_is(tmp_path: Path):
    features = ["ball_radius", "gravity", "curved_contact", "circles", "moving_parts", "flippers"]
    size, modules = compiled(tmp_path, *features)
    for feature in features[2:]:
        assert modules & ONLY_FOR[feature], feature
    for feature in ("dragged_walls", "several_balls"):
        assert not modules & ONLY_FOR[feature], feature
    assert size > 150_000


@pytest.mark.fast
def test_the_files_are_those_of_the_engine():
    for files in ONLY_FOR.values():
        for name in files:
            assert (ROOT / "bounce_env" / "engine" / f"{name.replace('.', '/')}.py").is_file()


@pytest.mark.fast
def test_the_built_in_scenes_need_twelve_kernels_at_most():
    assert len({load_scene(name).features for name in builtin_scenes()}) <= 12
