"""Whatever standing elements a closed scene mixes: no ball escapes, sinks into anything, or stops without a reason."""

import math
from collections import Counter

import numpy as np
import pytest

from bounce_env import Field, Scene
from bounce_env.engine.memory.records import BUDGET, OK
from bounce_env.engine.placement import element_gaps
from bounce_env.engine.world_batch import WorldBatch
from tests.conftest import soak_count
from tests.engine.closed_scenes import rows_of
from tests.engine.mixed_scenes import mixed_scene, start_in

pytestmark = pytest.mark.slow

SECONDS = 20.0
EVENTS = 400_000
SCENES = soak_count(200, 500)


def is_at_an_edge(scene: Scene, x: float, y: float) -> bool:
    """Whether a place is on the border of one of the scene's fields."""
    for field in scene.elements:
        corners = field.points if isinstance(field, Field) else ()
        for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
            length = math.hypot(bx - ax, by - ay)
            along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length
            across = ((y - ay) * (bx - ax) - (x - ax) * (by - ay)) / length
            if -1e-9 <= along <= length + 1e-9 and abs(across) <= 1e-9:
                return True
    return False


@pytest.mark.parametrize("point", [False, True], ids=["discs", "points"])
def test_mixed_scenes(point: bool) -> None:
    """Soak: 100 groups of 500 scenes of each kind, 10^5 together, 20 s each."""
    counts: Counter[str] = Counter()
    for group in range(soak_count(1, 100)):
        rng = np.random.default_rng([group, point])
        scenes, places, speeds = [], [], []
        while len(scenes) < SCENES:
            scene = mixed_scene(rng, 0.0 if point else float(rng.uniform(0.005, 0.1)))
            start = start_in(rng, scene)
            if start is not None:
                scenes.append(scene)
                places.append(start[0])
                speeds.append(start[1])
        worlds = WorldBatch(scenes, np.arange(SCENES))
        worlds.reset(position=places, velocity=speeds)
        worlds.advance(SECONDS, max_events=EVENTS)
        balls, status = rows_of(worlds), worlds.status[:, 0]
        assert np.isfinite(balls).all()
        assert (np.abs(balls[:, :2] - 0.5) <= 0.5 + 1e-9).all()
        for scene, ball in zip(scenes, balls.tolist(), strict=True):
            assert min(gap for _, gap in element_gaps(scene, {}, ball[0], ball[1])) >= -1e-9, (scene, ball)
        assert set(status) <= {OK, BUDGET}
        before = worlds.time
        worlds.advance(SECONDS, max_events=1000)
        # A ball that meets more than its budget allows meets it in due time: a thousand events take more than no time,
        # but where it is driven to and fro over the edge of a field, ever shorter: of that the engine sees no end.
        stuck = np.flatnonzero(worlds.time - before <= 1e-7).tolist()
        for i in stuck:
            assert is_at_an_edge(scenes[i], *balls[i, :2].tolist()), (scenes[i], places[i], speeds[i])
        met = {"ok": int((status == OK).sum()), "budget": int((status == BUDGET).sum()), "edge of a field": len(stuck)}
        counts.update(met)
    print(f"{'points' if point else 'discs'}: {dict(counts)}")  # noqa: T201
    assert counts["budget"] <= 0.01 * counts["ok"]
    assert counts["edge of a field"] <= 0.001 * counts["ok"]
