"""Part 3: what a scene needs, what was left out of its kernel, and what that saves."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Collection, Sequence
from functools import cache, partial

import numpy as np

from bounce_env.engine import WorldBatch
from bounce_env.engine.placement import part_cores_at_start, place_clear
from bounce_env.report.model import FeatureCostRow, FeatureRow
from bounce_env.scene import Ball, Feature, Scene, load_scene
from bounce_env.scene.features import ALL_FOR_ONE_BALL

BASE = "elastic_box"
"""The built-in scene with fewest features, on which each other one is forced."""

WORLDS = 256
CALM = 2.0**-40
"""A step so short that nothing happens in it [s]."""

CALM_STEPS = 400
"""So many make a piece of milliseconds."""


def measure_features(name: str, *, pieces: int, compiled: bool) -> FeatureRow:
    """Measure a built-in scene. pieces: how many are timed, of which the least counts. compiled: compiles it afresh."""
    scene = load_scene(name)
    lean, general = _costs(scene, [frozenset(), ALL_FOR_ONE_BALL], pieces)
    sizes: list[tuple[float | None, int | None]] = [(None, None), (None, None)]
    if compiled:
        sizes = [_compiling(scene.features), _compiling(scene.features | ALL_FOR_ONE_BALL)]
    return FeatureRow(
        scene=name,
        has=tuple(sorted(map(str, scene.features))),
        left_out=tuple(sorted(map(str, ALL_FOR_ONE_BALL - scene.features))),
        lean_step=lean[0],
        general_step=general[0],
        lean_bounce=lean[1],
        general_bounce=general[1],
        lean_compile=sizes[0][0],
        general_compile=sizes[1][0],
        lean_bytes=sizes[0][1],
        general_bytes=sizes[1][1],
    )


def measure_cost(feature: Feature, *, pieces: int) -> FeatureCostRow:
    """Measure what a feature costs a scene that does not need it, forced on."""
    scene = load_scene(BASE)
    (lean_step, lean_bounce), (step, bounce) = _costs(scene, [frozenset(), frozenset({feature})], pieces)
    assert lean_bounce is not None
    assert bounce is not None
    return FeatureCostRow(feature.value, BASE, step, lean_step, bounce, lean_bounce)


def _costs(scene: Scene, kernels: Sequence[frozenset[Feature]], pieces: int) -> list[tuple[float, float | None]]:
    """Return ns of CPU of a calm step, and of a bounce, of the scene on kernels with these features forced on.

    Of each the least of so many pieces, taken in turns: a processor that others use, too, is fast and slow by turns.
    """
    batches = [WorldBatch(scene, WORLDS, features=features) for features in kernels]
    places, speeds = _starts(scene)
    for batch in batches:
        batch.reset(position=places, velocity=speeds)
        batch.advance(CALM)
    steps = [min(found) for found in _in_turns([partial(_calm_step, batch) for batch in batches], pieces)]
    bounces = _in_turns([partial(_bounce, batch, places, speeds) for batch in batches], max(5, pieces // 5))
    few = int(batches[0].counts.bounces.sum()) < WORLDS // 4
    return [(step, None if few else min(found)) for step, found in zip(steps, bounces, strict=True)]


def _in_turns(measures: Sequence[Callable[[], float]], pieces: int) -> list[list[float]]:
    """Return what each has measured, so many times."""
    rounds = [[measure() for measure in measures] for _ in range(pieces)]
    return [list(found) for found in zip(*rounds, strict=True)]


def _calm_step(batch: WorldBatch) -> float:
    before = time.process_time_ns()
    for _ in range(CALM_STEPS):
        batch.advance(CALM)
    return (time.process_time_ns() - before) / CALM_STEPS / WORLDS


def _bounce(batch: WorldBatch, places: np.ndarray, speeds: np.ndarray) -> float:
    batch.reset(position=places, velocity=speeds)
    before = time.process_time_ns()
    batch.advance(1.0)
    spent = time.process_time_ns() - before
    return spent / max(1, int(batch.counts.bounces.sum()))


def _starts(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Draw starts that overlap nothing, where there is most room."""
    rng, cores = np.random.default_rng(0), part_cores_at_start(scene)
    left, bottom, right, top = scene.bounds
    places: list[tuple[float, float]] = []
    while len(places) < WORLDS:
        x, y = float(rng.uniform(left, right)), float(rng.uniform(bottom, top + 0.1 * (top == bottom)))
        try:
            places.append(place_clear(scene, cores, x, y))
        except ValueError:
            continue
    return np.array(places), rng.normal(size=(WORLDS, 2)) * 2.0


@cache
def _compiling(features: frozenset[Feature]) -> tuple[float, int]:
    """Compile the kernel in a process and a folder of its own; returns seconds of CPU and bytes of machine code."""
    with tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-m", "bounce_env.report.features", *features]
        environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
        run = subprocess.run(words, capture_output=True, text=True, check=True, env=environment)
    seconds, size = json.loads(run.stdout)
    return float(seconds), int(size)


def compile_alone(features: Collection[str]) -> tuple[float, int]:
    """Compile in this process what advances a batch with these features; returns seconds of CPU and bytes of code."""
    from bounce_env.engine.world_batch import batch_advance  # noqa: PLC0415 (its overloads are what is counted)

    ball = Ball(0.1 if Feature.BALL_RADIUS in features else 0.0)
    batch = WorldBatch(Scene(gravity=(0, 0), ball=ball), 1, features=set(features) - {Feature.BALL_RADIUS})
    batch.reset(position=[(0, 0)], velocity=[(0, 0)])
    before = time.process_time()
    batch.advance(CALM)
    seconds = time.process_time() - before
    (compiled,) = batch_advance.overloads.values()  # type: ignore[attr-defined]
    return seconds, len(compiled.library._get_compiled_object())


if __name__ == "__main__":
    sys.stdout.write(json.dumps(compile_alone(sys.argv[1:])))
