"""A page shows balls and parts where the engine has them: its own code beside the engine, at a thousand instants."""

import json
import shutil
import subprocess
from importlib import resources

import numpy as np
import pytest

from bounce_env import Arc, Ball, Bumper, Scene, Status, World, load_scene, replay_of
from bounce_env.replay.document import text_of

pytestmark = [pytest.mark.fast, pytest.mark.skipif(shutil.which("node") is None, reason="needs Node.js")]

INSTANTS = 1000
WITHIN = 1e-9  # of the scene's size

BOWL = Scene(gravity=(0, -9.81), ball=Ball(0.05, b=0.0), elements=(Arc((0, 0), 1.0, -np.pi, np.pi, name="bowl"),))
HILL = Scene(gravity=(0, -9.81), ball=Ball(0.05, b=0.0), elements=(Bumper((0, 0), 1.0, name="hill"),))
LOOP = load_scene("loop")
PINBALL = load_scene("pinball")

# Around the whole circle at the speed of the separatrix: sqrt(5 g r) at the bottom, of r = 0.95 for the ball's centre.
SEPARATRIX = float(np.sqrt(5 * 9.81 * 0.95))

RUNS = {
    "pendulum in a bowl": (BOWL, (0.0, -0.95), (3.0, 0.0), 6.0, []),
    "just over the apex": (BOWL, (0.0, -0.95), (SEPARATRIX * (1 + 1e-9), 0.0), 6.0, []),
    "just released before the apex": (BOWL, (0.0, -0.95), (SEPARATRIX * (1 - 1e-3), 0.0), 6.0, []),
    "nearly at rest on top": (HILL, (0.0, 1.05), (1e-9, 0.0), 12.0, []),
    "loop": (LOOP, (0.0, -0.95), (5.0, 0.0), 4.0, []),
    "flippers": (PINBALL, (0.25, 0.4), (0.1, 0.0), 6.0, [("flipper_left", True), ("flipper_right", True)]),
}

PROGRAM = """
import { readFileSync } from "node:fs";
const [flight, document, instants] = process.argv.slice(1).map((name) => readFileSync(name, "utf8"));
const { ballAt, velocityAt, partAt, withTimes } = await import("data:text/javascript," + encodeURIComponent(flight));
const replay = withTimes(JSON.parse(document));
const rows = JSON.parse(instants).map((t) => [
  ...ballAt(replay.balls[0], t), ...velocityAt(replay.balls[0], t),
  ...replay.parts.flatMap((part) => partAt(part.paths, t)),
]);
console.log(JSON.stringify(rows));
"""


def evaluated(tmp_path, document, instants):
    """What the page's code says: x, y, vx, vy and the numbers of the parts, at each instant."""
    program, flight = tmp_path / "program.mjs", tmp_path / "flight.js"
    flight.write_text((resources.files("bounce_env.replay") / "flight.js").read_text())
    (tmp_path / "document.json").write_text(text_of(document))
    (tmp_path / "instants.json").write_text(json.dumps(instants))
    program.write_text(PROGRAM.replace("slice(1)", "slice(2)"))
    names = [str(program), str(flight), str(tmp_path / "document.json"), str(tmp_path / "instants.json")]
    done = subprocess.run(["node", *names], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return np.array(json.loads(done.stdout))


@pytest.mark.parametrize("name", RUNS)
def test_the_page_shows_balls_and_parts_where_they_are(name, tmp_path):
    scene, place, velocity, seconds, commands = RUNS[name]
    world = World(scene)
    world.record()
    world.reset(position=place, velocity=velocity)
    # At uneven instants, so that they are not those of events.
    steps = np.diff(np.sort(np.random.default_rng(0).uniform(0.0, seconds, INSTANTS)), prepend=0.0)
    instants, right, there = [], [], []
    for i, step in enumerate(steps.tolist()):
        if commands and i % 100 == 50:
            for part, pressed in commands:
                world.command(part, pressed if i % 200 == 50 else not pressed)
        world.advance(step)
        instants.append(world.time)
        there.append(world.status[0] != Status.OUT)
        angles = [np.arctan2(y1 - y0, x1 - x0) for x0, y0, x1, y1 in world.cores] if commands else []
        right.append([*world.position[0], *world.velocity[0], *angles])
    document = replay_of(world.recorded()).document
    shown = evaluated(tmp_path, document, instants)
    left, bottom, width, top = scene.bounds
    size = max(width - left, top - bottom)
    assert np.abs(shown[:, :2] - np.array(right)[:, :2]).max() < WITHIN * size
    speed = np.abs(np.array(right)[:, 2:4]).max()
    assert np.abs(shown[there, 2:4] - np.array(right)[there, 2:4]).max() < 1e-6 * speed
    turns = (shown[:, 4:] - np.array(right)[:, 4:]) / (2 * np.pi)
    assert np.abs(turns - np.round(turns)).max(initial=0.0) < WITHIN
    slides = sum(len(path) == 4 for path in document["balls"][0])
    assert slides > 0 or name == "flippers"
