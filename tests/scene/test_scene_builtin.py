"""The built-in scenes: they ship with the package and are what their descriptions say."""

import math
import re
import subprocess
import sys
import zipfile
from fractions import Fraction
from importlib import resources
from inspect import signature
from itertools import combinations, pairwise
from math import dist
from pathlib import Path
from typing import get_args

import pytest

import bounce_env
from bounce_env.report.problems import PROBLEMS
from bounce_env.scene import Ball, Bumper, Element, Paddle, Scene, Sensor, Wall, builtin_scenes, load_scene

pytestmark = pytest.mark.fast


def elements(scene: Scene, spec: type) -> list:
    return [element for element in scene.elements if isinstance(element, spec)]


def test_which_there_are():
    of_games = {"paddle", "paddle_levels", "pinball", "walls"}
    of_report = {problem.name for problem in PROBLEMS}
    assert set(builtin_scenes()) == {"guides", "pegs", "tutorial"} | of_games | of_report


@pytest.mark.parametrize("spec", [Scene, Ball, *get_args(Element)], ids=lambda spec: spec.__name__)
def test_paddle_describes_every_field_of_the_format(spec):
    text = (resources.files("bounce_env.scene") / "builtin" / "paddle.toml").read_text()
    if spec in get_args(Element):
        assert f'# type = "{spec.__name__.lower()}": ' in text
    missing = [field for field in signature(spec).parameters if not re.search(rf"(?<!\w){field}(?!\w)", text)]
    assert missing == []


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


@pytest.mark.parametrize("name", ["paddle", "paddle_levels"])
def test_the_paddle_can_crush_nothing(name):
    scene = load_scene(name)
    [paddle] = elements(scene, Paddle)
    x_min, _, x_max, _ = paddle.bounds
    assert x_min == pytest.approx(0.045)
    assert 1.0 - x_max == pytest.approx(0.045)
    assert min(x_min, 1.0 - x_max) > 2 * scene.ball.radius
    assert paddle.half_width + paddle.radius == pytest.approx(0.075)
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


@pytest.fixture(scope="module")
def guides() -> dict:
    """The elements of the built-in table by name."""
    return {element.name: element for element in load_scene("guides").elements}


def test_guides_is_a_small_pinball_table(guides):
    scene = load_scene("guides")
    assert (scene.gravity, scene.rest_speed, scene.max_speed, scene.drag) == ((0.0, -1.11), 0.02, 4.0, 1.0)
    assert (scene.ball.radius, scene.ball.b) == (0.0135, 0.6)
    assert len(guides) == len(scene.elements) == 16
    assert all(wall.start[1] != wall.end[1] for wall in elements(scene, Wall))  # on no wall a ball could stay
    bumpers = elements(scene, Bumper)
    assert len(bumpers) == 2
    assert min(min(bumper.kick, bumper.kick_threshold, bumper.cooldown) for bumper in bumpers) > 0
    assert guides["rollover"].circle is not None
    assert [sensor.name for sensor in elements(scene, Sensor) if sensor.drain] == ["drain"]


def test_the_arch_goes_on_from_wall_to_wall(guides):
    arch, left, right = guides["arch"], guides["left"], guides["right"]
    x, y = arch.center
    assert (arch.start_angle, arch.end_angle) == (0.0, math.pi)
    assert right.end == (x + arch.radius, y)
    assert left.end == (x - arch.radius, y)
    assert right.start[0] == right.end[0]  # upright, as the arch is there
    assert left.start[0] == left.end[0]
    assert load_scene("guides").bounds[2:] == pytest.approx((0.55, 1.0))


def test_the_lane_opens_upwards_only(guides):
    lane, gate, right = guides["lane"], guides["gate"], guides["right"]
    radius = load_scene("guides").ball.radius
    assert [wall.name for wall in elements(load_scene("guides"), Wall) if wall.one_way] == ["gate"]
    assert gate.start == lane.end
    assert gate.end[0] == right.end[0]
    assert gate.start[0] < gate.end[0]  # above is to the left of it
    assert gate.start[1] < gate.end[1]  # and what lies on it rolls off to the left
    assert right.end[0] - lane.end[0] > 3 * radius
    for bumper in elements(load_scene("guides"), Bumper):
        assert lane.end[0] - bumper.center[0] - bumper.radius > 3 * radius


def test_the_guides_lead_down_without_a_step(guides):
    left = [guides[f"guide_{i}"] for i in (1, 2, 3, 4)]
    right = [guides["slope_1"], guides["slope_2"]]
    for guide, wall in ((left, guides["left"]), (right, guides["lane"])):
        assert guide[0].start[0] == wall.start[0]  # begins at the wall: no ball falls behind it
        for one, other in pairwise(guide):
            assert one.end == other.start
        for part in guide:
            assert part.end[1] < part.start[1]
    turns = [_turn(one, other) for one, other in pairwise(left)]
    assert turns[:2] == [0, 0]
    assert turns[2] > 0  # less steep, a bend that the ball runs into
    assert _turn(*right) > 0  # down to the left, turning left: steeper, a bend that it may leave
    radius = load_scene("guides").ball.radius
    assert right[-1].end[0] - left[-1].end[0] > 4 * radius


def _turn(one: Wall, other: Wall) -> Fraction:
    """The cross product of two walls' directions, exact."""
    (ax, ay), (bx, by) = (
        [Fraction(end) - Fraction(start) for start, end in zip(wall.start, wall.end, strict=True)]
        for wall in (one, other)
    )
    return ax * by - ay * bx


def test_nothing_passes_beside_the_drain_of_the_guides(guides):
    drain, radius = guides["drain"], load_scene("guides").ball.radius
    assert drain.start[1] == drain.end[1]
    assert drain.start[0] < 0.0
    assert drain.end[0] > 0.5
    for name in ("left", "right", "lane"):
        assert guides[name].start[1] < drain.start[1] - radius
