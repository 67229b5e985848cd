"""What is recorded of a world says where everything was at every instant, and recording changes no bit."""

from bisect import bisect_right

import numpy as np
import pytest

from bounce_env import Ball, Bumper, Paddle, Scene, Wall, World, load_scene
from bounce_env.scene import Flipper

pytestmark = pytest.mark.fast

RAMP = Wall((0.2, 0.3), (0.8, 0.2), draggable=True, name="ramp")
RAIL = Paddle((0.3, 0.1), (0.7, 0.1), half_width=0.1, radius=0.02, max_speed=2.0, name="paddle")
ROOM = [Wall(p, q) for p, q in (((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 1)), ((0, 1), (0, 0)))]
DRAGGED = Scene(gravity=(0, -1), ball=Ball(0.02, b=0.8), max_speed=9.0, elements=(*ROOM, RAMP))
SLIDING = Scene(gravity=(0, -1), ball=Ball(0.02, b=0.8), max_speed=9.0, elements=(*ROOM, RAIL))
STANDING = Scene(gravity=(0, -1), ball=Ball(0.02, b=0.5), elements=(*ROOM, Bumper((0.5, 0.5), 0.2)))
LOOP = load_scene("loop")
PINBALL = load_scene("pinball")

RUNS = {
    "walls": (
        DRAGGED,
        [(0.5, 0.6)],
        [(0.7, 0.1)],
        [("ramp", ((0.1, 0.0), (0.0, 0.2))), ("ramp", ((0.0, -0.1), (0.1, 0.0)))],
    ),
    "paddle": (SLIDING, [(0.5, 0.6)], [(0.7, 0.1)], [("paddle", 1.0), ("paddle", -2.0)]),
    "loop": (LOOP, [(0.0, -0.95)], [(5.0, 0.0)], []),
    "flippers": (PINBALL, [(0.25, 0.4)], [(0.1, 0.0)], [("flipper_left", True), ("flipper_left", False)]),
    "balls": (STANDING, [(0.3, 0.8), (0.5, 0.9), (0.52, 0.8)], [(0.1, 0.0), (0.0, 0.0), (0.3, 0.0)], []),
}


@pytest.mark.parametrize("name", RUNS)
def test_paths_lead_through_where_everything_was(name):
    scene, places, speeds, commands = RUNS[name]
    recorded_world, other = World(scene, balls=len(places)), World(scene, balls=len(places))
    recorded_world.record()
    seen = []
    for world in (recorded_world, other):
        world.reset(position=places, velocity=speeds)
        for step in range(256):
            if step % 64 == 32 and commands:
                world.command(*commands[(step // 64) % len(commands)])
            world.advance(1 / 128)
            if world is recorded_world:
                seen.append((world.time, world.position, world.cores))
    assert recorded_world.position.tobytes() == other.position.tobytes()
    run = recorded_world.recorded()
    assert run.end == recorded_world.time
    for time, position, cores in seen:
        for k, paths in enumerate(run.balls):
            assert path_at(paths, time).at(time) == pytest.approx(position[k], abs=1e-13)
        for m, paths in enumerate(run.parts):
            place, part = path_at(paths, time).at(time), scene.parts[m][1]
            if isinstance(part, Wall):
                assert place == pytest.approx(cores[m], abs=1e-13)
            elif isinstance(part, Flipper):
                dx, dy = cores[m][2:] - cores[m][:2]
                assert np.hypot(np.cos(place[0]) * dy - np.sin(place[0]) * dx, 0.0) < 1e-12
            else:
                assert place == pytest.approx(0.5 * (cores[m][:2] + cores[m][2:]), abs=1e-13)
    assert len(run.ledger) > 3
    assert (np.diff(run.ledger["time"]) >= 0).all()


def path_at(paths, time):
    return paths[bisect_right([path.begin for path in paths], time) - 1]
