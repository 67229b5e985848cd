"""The built-in scenes: they ship with the package and are what games.md and numerics.md say."""

import subprocess
import sys
import zipfile
from itertools import combinations
from math import dist
from pathlib import Path

import pytest

import bounce_env
from bounce_env.scene import Bumper, Paddle, Scene, Sensor, Wall, builtin_scenes, load_scene


def elements(scene: Scene, spec: type) -> list:
    return [element for element in scene.elements if isinstance(element, spec)]


def test_there_are_three():
    assert builtin_scenes() == ("box", "paddle", "pegs")


def test_they_load_from_a_zip(tmp_path):
    """As a wheel may be imported: no file system path to the data."""
    package = Path(bounce_env.__file__).parent
    with zipfile.ZipFile(tmp_path / "bounce.zip", "w") as archive:
        for path in [*package.rglob("*.py"), *package.rglob("*.toml")]:
            archive.write(path, path.relative_to(package.parent))
    code = "import bounce_env.scene as s; print(s.__file__, *map(s.load_scene, s.builtin_scenes()), sep='\\n')"
    run = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env={"PYTHONPATH": "bounce.zip"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.stderr == ""
    file, *scenes = run.stdout.splitlines()
    assert "bounce.zip" in file
    assert scenes == [str(load_scene(name)) for name in builtin_scenes()]


def test_paddle_is_the_field_of_the_game():
    scene = load_scene("paddle")
    assert scene.gravity == (0.0, -1.5)
    assert scene.max_speed == 3.0
    assert (scene.ball.radius, scene.ball.b, scene.ball.f) == (0.02, 1.0, 1.0)
    named = {element.name: element for element in scene.elements}
    assert len(named) == len(scene.elements) == 9

    left, right, top = named["left"], named["right"], named["top"]
    assert {wall.b for wall in (left, right, top)} == {0.9}
    assert {left.start[0], left.end[0], top.start[0]} == {0.0}
    assert {right.start[0], right.end[0], top.end[0]} == {1.0}
    assert {left.end[1], right.end[1], top.start[1], top.end[1]} == {1.4}

    bumpers = elements(scene, Bumper)
    assert [bumper.center for bumper in bumpers] == [(0.25, 1.0), (0.75, 1.0), (0.5, 1.2), (0.5, 0.8)]
    assert {bumper.radius for bumper in bumpers} == {0.06}
    assert all(bumper.b > 1 for bumper in bumpers)


def test_the_paddle_can_crush_nothing():
    scene = load_scene("paddle")
    [paddle] = elements(scene, Paddle)
    x_min, _, x_max, _ = paddle.bounds
    assert x_min == pytest.approx(0.045)
    assert 1.0 - x_max == pytest.approx(0.045)
    assert min(x_min, 1.0 - x_max) > 2 * scene.ball.radius
    assert paddle.half_width + paddle.radius == pytest.approx(0.1)
    assert paddle.rail_start[1] == paddle.rail_end[1] == 0.08
    assert (paddle.name, paddle.max_speed, paddle.f, paddle.b) == ("paddle", 1.5, 0.5, 0.9)
    assert (paddle.kick, paddle.kick_threshold) == (1.0, 0.0)


def test_nothing_passes_beside_the_drain():
    scene = load_scene("paddle")
    [drain] = elements(scene, Sensor)
    assert drain.drain
    assert drain.start[1] == drain.end[1] == -0.03
    assert drain.start[0] < 0.0
    assert drain.end[0] > 1.0
    # a ball that is at the drain still has the wall, and not its end, beside it
    assert max(min(wall.start[1], wall.end[1]) for wall in scene.elements[:2]) < -0.03 - scene.ball.radius


@pytest.mark.parametrize(("name", "side", "circles"), [("box", (10.0, 10.0), 5), ("pegs", (1.0, 1.5), 13)])
def test_a_closed_box_of_circles_loses_nothing(name, side, circles):
    scene = load_scene(name)
    assert scene.bounds == (0.0, 0.0, *side)
    assert (scene.gravity == (0.0, 0.0)) == (name == "box")
    assert {(part.b, part.f, part.kick if part is not scene.ball else 0.0) for part in scene.elements} == {
        (1.0, 1.0, 0.0)
    }
    assert (scene.ball.b, scene.ball.f) == (1.0, 1.0)

    walls, bumpers = elements(scene, Wall), elements(scene, Bumper)
    assert len(walls) + len(bumpers) == len(scene.elements)
    assert len(bumpers) == circles
    for wall, after in zip(walls, [*walls[1:], walls[0]], strict=True):
        assert wall.end == after.start
    # no place is too narrow for the ball, in which it could be caught
    diameter = 2 * scene.ball.radius
    for one, other in combinations(bumpers, 2):
        assert dist(one.center, other.center) - one.radius - other.radius > diameter
    for bumper in bumpers:
        x_min, y_min, x_max, y_max = bumper.bounds
        assert min(x_min, y_min, side[0] - x_max, side[1] - y_max) > diameter
