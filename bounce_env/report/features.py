"""Part 3: what a scene needs, what was left out of its kernel, and what that saves."""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache, partial
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from bounce_env.engine import WorldBatch
from bounce_env.engine.placement import part_cores_at_start, place_clear
from bounce_env.report.model import FeatureCostRow, FeatureRow
from bounce_env.scene import Ball, Feature, Scene, load_scene
from bounce_env.scene.features import ALL_FOR_ONE_BALL, checked_features

BASE = "elastic_box"
"""The built-in scene with fewest features, on which each other one is forced."""

WORLDS = 256
CALM = 2.0**-40
"""A step so short that nothing happens in it [s]."""

CALM_STEPS = 400
"""So many make a piece of milliseconds."""


KernelSets: TypeAlias = frozenset[frozenset[Feature]]
"""Each a set of features, for which there is a kernel."""


class Kernel(NamedTuple):
    """What a scene costs on a kernel: ns of a calm step and of a bounce, seconds of compiling, bytes of its code."""

    step: float
    bounce: float | None
    seconds: float | None
    size: int | None


def kernel_sets(names: Iterable[str], costs: Iterable[Feature]) -> KernelSets:
    """Return the sets of features for which the rows of these scenes, and of what these features cost, need kernels."""
    scenes = [(load_scene(name), forced) for name in names for forced in (frozenset(), ALL_FOR_ONE_BALL)]
    base = load_scene(BASE)
    return frozenset(_set_of(scene, forced) for scene, forced in [*scenes, *((base, {feature}) for feature in costs)])


def measure_features(name: str, *, pieces: int, compiled: KernelSets) -> FeatureRow:
    """Measure a built-in scene.

    pieces: how many are timed, of which the least counts. compiled: the kernels of the whole run, which are compiled
    afresh before the first of them is timed; none: this scene's are timed without.
    """
    lean, general = _kernels(name, [frozenset(), ALL_FOR_ONE_BALL], pieces, compiled)
    has = load_scene(name).features
    return FeatureRow(
        scene=name,
        has=tuple(sorted(map(str, has))),
        left_out=tuple(sorted(map(str, ALL_FOR_ONE_BALL - has))),
        lean_step=lean.step,
        general_step=general.step,
        lean_bounce=lean.bounce,
        general_bounce=general.bounce,
        lean_compile=lean.seconds,
        general_compile=general.seconds,
        lean_bytes=lean.size,
        general_bytes=general.size,
    )


def measure_cost(feature: Feature, *, pieces: int, compiled: KernelSets) -> FeatureCostRow:
    """Measure what a feature costs a scene that does not need it, forced on. compiled: as of `measure_features`."""
    lean, forced = _kernels(BASE, [frozenset(), frozenset({feature})], pieces, compiled)
    assert lean.bounce is not None
    assert forced.bounce is not None
    assert lean.seconds is not None
    assert forced.seconds is not None
    assert lean.size is not None
    assert forced.size is not None
    return FeatureCostRow(
        feature=feature.value,
        scene=BASE,
        step=forced.step,
        lean_step=lean.step,
        bounce=forced.bounce,
        lean_bounce=lean.bounce,
        compile=forced.seconds,
        lean_compile=lean.seconds,
        bytes=forced.size,
        lean_bytes=lean.size,
    )


def _kernels(name: str, forced: Sequence[frozenset[Feature]], pieces: int, compiled: KernelSets) -> list[Kernel]:
    """Measure a built-in scene with sets of features forced on, in turns; compiled: in processes of their own."""
    scene = load_scene(name)
    if not compiled:
        return [Kernel(step, bounce, None, None) for step, bounce in _costs(scene, forced, pieces)]
    known = _compiled(compiled)
    sizes = [known[_set_of(scene, features)] for features in forced]
    costs = _alone("costs", name, str(pieces), *(",".join(sorted(features)) for features in forced))
    return [Kernel(step, bounce, *size) for (step, bounce), size in zip(costs, sizes, strict=True)]


def _costs(scene: Scene, kernels: Sequence[frozenset[Feature]], pieces: int) -> list[tuple[float, float | None]]:
    """Return ns of CPU of a calm step, and of a bounce, of the scene on kernels with these features forced on.

    Of each the least of so many pieces, taken in turns: a processor that others use, too, is fast and slow by turns.
    """
    batches = [WorldBatch(scene, WORLDS, features=features) for features in kernels]
    places, speeds = _starts(scene)
    for batch in batches:
        batch.reset(position=places, velocity=speeds)
        batch.advance(CALM)
    steps = _least_in_turns([partial(_calm_step, batch) for batch in batches], pieces)
    bounces = _least_in_turns([partial(_bounce, batch, places, speeds) for batch in batches], max(5, pieces // 5))
    few = int(batches[0].counts.bounces.sum()) < WORLDS // 4
    return [(step, None if few else bounce) for step, bounce in zip(steps, bounces, strict=True)]


def _least_in_turns(measures: Sequence[Callable[[], float]], pieces: int) -> list[float]:
    """Return the least that each has measured, of so many times."""
    rounds = [[measure() for measure in measures] for _ in range(pieces)]
    return [min(found) for found in zip(*rounds, strict=True)]


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


def _set_of(scene: Scene, forced: Collection[Feature]) -> frozenset[Feature]:
    """Return the features of the scene's kernel with some forced on, and what these bring with them."""
    return scene.features | checked_features(forced)


@cache
def _compiled(sets: KernelSets) -> Mapping[frozenset[Feature], tuple[float, int]]:
    """Compile the kernels, two at a time: nothing else is timed meanwhile, and what counts is the time of the CPU."""
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(sets, pool.map(_compiling, sets), strict=True))


def _compiling(features: frozenset[Feature]) -> tuple[float, int]:
    """Compile the kernel in a process of its own; returns seconds of CPU and bytes of machine code."""
    seconds, size = _alone("compiling", *sorted(features))
    return float(seconds), int(size)


@cache
def _folder() -> "tempfile.TemporaryDirectory[str]":
    """Where kernels are compiled to: nowhere that there are any before, and gone when this process ends."""
    return tempfile.TemporaryDirectory(prefix="bounce_env_report_")


def _alone(*words: str) -> Any:
    """Run a part of this module in a process of its own, and return what it prints, read as JSON."""
    command = [sys.executable, "-m", "bounce_env.report.features", *words]
    environment = {**os.environ, "NUMBA_CACHE_DIR": _folder().name}
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True, env=environment).stdout)


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


def _main(what: str, *words: str) -> object:
    if what == "compiling":
        return compile_alone(words)
    name, pieces, *forced = words
    sets = [frozenset(Feature(feature) for feature in names.split(",") if feature) for names in forced]
    return _costs(load_scene(name), sets, int(pieces))


if __name__ == "__main__":
    sys.stdout.write(json.dumps(_main(*sys.argv[1:])))
