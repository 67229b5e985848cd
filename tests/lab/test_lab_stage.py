"""The tutorial's second example: what a tab may do with a scene under a running ball, and what is refused."""

import json
import math

import numpy as np
import pytest

from bounce_env import Ball, Flipper, Scene, SceneError, Wall, load_scene
from bounce_env.engine.tutorial import run
from bounce_env.lab.movable import size_of
from bounce_env.lab.stage import Stage
from bounce_env.lab.table import MOST_ELEMENTS, Table
from bounce_env.scene import dump_scene
from tests.conftest import soak_count

pytestmark = pytest.mark.fast

PATHS = soak_count(40, 10_000)


class Tab:
    """A tab on a stage."""

    def __init__(self, folder, scene=None):
        self.stage = Stage(folder=folder, scene=scene)
        self.view = self.do("open")

    def do(self, what, **fields):
        answer = self.stage.answer(json.dumps({"do": what, **fields}))
        if "scene" in answer:
            self.scene, self.parts = answer["scene"], {}
        self.parts.update(answer["parts"])
        return answer

    def ends(self, index):
        """x, y, x, y of a wall's ends, as the tab knows them."""
        return self.parts[index]


def test_a_dragged_end_goes_to_the_pointer_at_a_capped_speed_and_strikes(tmp_path):
    scene = Scene(gravity=(0, 0), elements=(Wall((-1, 0), (1, 0), name="bat"), *box(3.0)), ball=Ball(0.1))
    (tmp_path / "bat.toml").write_text(dump_scene(scene))
    tab = Tab(tmp_path, str(tmp_path / "bat.toml"))
    tab.do("launch", position=[0.0, 0.5], velocity=[0.0, 0.0])
    far = tab.do("advance", seconds=0.05, drag=0, targets=[[-1.0, 100.0], [1.0, 100.0]])
    assert tab.ends(0) == pytest.approx([-1.0, 4.0 * 6.0 * 0.05, 1.0, 4.0 * 6.0 * 0.05])
    assert far["ball"][3] == pytest.approx(2 * 4.0 * 6.0)  # an elastic wall gives a ball at rest twice its speed
    tab.do("advance", seconds=0.05, drag=0, targets=[[-1.0, 1.3], None])
    assert tab.ends(0) == pytest.approx([-1.0, 1.3, 1.0, 1.2])
    there = tab.ends(0)
    assert tab.do("advance", seconds=0.05)["parts"] == []
    assert tab.ends(0) == there


def box(h):
    corners = [(-h, -h), (h, -h), (h, h), (-h, h)]
    return [Wall(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]


def test_while_time_stands_an_end_jumps_and_the_ball_is_set_clear_on_its_own_side(tmp_path):
    scene = Scene(gravity=(0, -1), elements=(Wall((-1, 0), (1, 0), name="bat"), *box(3.0)), ball=Ball(0.1))
    table = Table(scene)
    table.launch((0.0, 0.5), (0.0, 0.0))
    table.place_end(0, 0, (-1.0, 0.6))
    assert table.world.position[0].tolist() == [0.0, 0.5]
    table.place_end(0, 1, (1.0, 0.3))  # the ball is above the wall's middle by 0.05
    normal = np.array([0.3, 2.0]) / math.hypot(0.3, 2.0)
    assert np.dot(table.world.position[0] - (0.0, 0.45), normal) == pytest.approx(0.1)
    table.place_end(0, 1, (1.0, 0.65))  # it is beneath the middle of where the wall was by now
    normal = np.array([-0.05, 2.0]) / math.hypot(0.05, 2.0)
    assert np.dot(table.world.position[0] - (0.0, 0.625), normal) == pytest.approx(0.1)
    with pytest.raises(ValueError, match="overlaps"):  # between the wall and the box there is no room
        cornered(scene)


def cornered(scene):
    table = Table(scene)
    table.launch((-2.85, 2.85), (0.0, 0.0))
    table.place_end(0, 0, (-2.9, -2.9))
    table.place_end(0, 1, (-2.8, 2.99))


def test_changes_are_undone_one_by_one_while_the_ball_goes_on(tmp_path):
    tab = Tab(tmp_path)
    first = tab.scene
    tab.do("advance", seconds=0.3)
    tab.do("set", element=4, field="b", value=0.5)
    tab.do("add", element={"type": "bumper", "center": [0.2, 0.9], "radius": 0.05, "b": 1.5})
    tab.do("remove", element=0)
    tab.do("remember")
    tab.do("advance", seconds=0.05, drag=6, targets=[[0.9, 0.5], None])
    assert len(tab.do("open")["scene"]["elements"]) == 13
    before = tab.do("advance", seconds=0.0)
    for _ in range(4):
        view = tab.do("undo")
    assert view["time"] == before["time"]
    assert view["ball"] == before["ball"]
    assert tab.scene == first
    with pytest.raises(ValueError, match="nothing to undo"):
        tab.do("undo")


def test_a_bounce_that_adds_speed_gets_a_limit_and_says_so(tmp_path):
    tab = Tab(tmp_path)
    view = tab.do("set", element=4, field="b", value=2.0)
    assert view["notice"] == "max_speed = 160 m/s: bounces may now add speed, and need a limit"
    assert tab.scene["max_speed"] == 160.0


def test_undo_leaves_parts_where_they_are(tmp_path):
    def flipper(x):
        return Flipper((x, 0), 0.2, radius=0.02, rest_angle=0, active_angle=1, up_speed=9, down_speed=9)

    scene = Scene(elements=(Wall((0, -1), (1, -1)), flipper(0.2), flipper(0.6), Wall((0, 1), (1, 1))), max_speed=50)
    (tmp_path / "two.toml").write_text(dump_scene(scene))
    tab = Tab(tmp_path, str(tmp_path / "two.toml"))
    tab.do("press", element=2, on=True)
    tab.do("advance", seconds=0.5)
    tab.do("remove", element=0)
    assert (tab.ends(0), tab.ends(1)) == ([0.0], [pytest.approx(1.0)])
    tab.do("undo")
    assert (tab.ends(1), tab.ends(2)) == ([0.0], [pytest.approx(1.0)])


def test_all_can_be_removed_and_anything_be_large(tmp_path):
    tab = Tab(tmp_path)
    tab.do("place_end", element=0, end=0, to=[-1e6, -1e6])
    for _ in range(13):
        view = tab.do("remove", element=0)
    assert tab.scene["elements"] == []
    tab.do("advance", seconds=0.1)
    assert "error" not in tab.do("add", element={"type": "wall", "start": [0, 0], "end": [1, 0]})
    with pytest.raises(ValueError, match=r"ball: b = 1000.*: must be"):
        tab.do("set", element=None, field="ball.b", value=10**400)
    assert view["undo"] == 13


def test_the_ghost_follows_every_change(tmp_path):
    tab = Tab(tmp_path)
    tab.do("ghost", on=True)
    assert "radius" in tab.do("set", element=None, field="ball.radius", value=0.02)["ghost"]["words"]
    assert tab.do("undo")["ghost"]["error"] == 0.0
    assert tab.do("ghost", on=False)["ghost"] is None


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (
            {"do": "set", "element": 4, "field": "b", "value": -1},
            r"elements\[4\] \(wall 'ramp_left'\): b = -1: must be",
        ),
        ({"do": "set", "element": 4, "field": "x", "value": 1}, r"elements\[4\] .*unknown field"),
        ({"do": "set", "element": 99, "field": "b", "value": 1}, r"elements\[99\]: there are 13"),
        ({"do": "set", "element": None, "field": "elements", "value": []}, "must be a field of the scene"),
        ({"do": "set", "element": None, "field": "ball.b.c", "value": 1}, "must be a field of the scene"),
        ({"do": "add", "element": {"type": "star"}}, r"elements\[13\].*type = 'star': must be one of"),
        ({"do": "add", "element": {"type": "bumper", "center": [0, 0], "radius": -1}}, r"radius = -1: must be"),
        ({"do": "place_end", "element": 4, "end": 2, "to": [0, 0]}, "place_end.end = 2"),
        ({"do": "place_end", "element": 4, "end": 0, "to": [0, 1e300]}, "place_end.to.1 = 1e[+]300"),
        ({"do": "advance", "seconds": -1}, "advance.seconds = -1"),
        ({"do": "advance", "seconds": 100}, "advance.seconds = 100"),
        ({"do": "load", "name": "../secret", "builtin": False}, "load.name = '../secret'"),
        ({"do": "load", "name": "none", "builtin": False}, "none.toml: cannot be read"),
        ({"do": "load", "name": "none", "builtin": True}, "must be one of"),
        ({"do": "save", "name": "a/b"}, "save.name = 'a/b'"),
        ({"do": "save", "name": ""}, "save.name = ''"),
        ({"do": "press", "element": 4, "on": True}, "must be a flipper or a paddle"),
        ({"do": "dance"}, "dance"),
    ],
)
def test_what_is_wrong_is_refused_with_its_place_and_changes_nothing(tmp_path, message, words):
    tab = Tab(tmp_path)
    before = tab.do("open")
    with pytest.raises(ValueError, match=words):
        tab.stage.answer(json.dumps(message))
    assert tab.do("open") == before
    assert list(tmp_path.iterdir()) == []


def test_scenes_are_saved_once_and_overwritten_only_when_asked(tmp_path):
    tab = Tab(tmp_path)
    view = tab.do("save", name="mine")
    path = tmp_path / "mine.toml"
    assert view["notice"] == f"saved {path}"
    assert view["line"] == f"World(load_scene({str(path)!r}))"
    assert view["files"] == ["mine"]
    assert load_scene(path) == load_scene("tutorial")
    tab.do("set", element=4, field="b", value=0.5)
    with pytest.raises(ValueError, match=r"mine\.toml is there already"):
        tab.do("save", name="mine")
    assert load_scene(path) == load_scene("tutorial")
    tab.do("save", name="mine", overwrite=True)
    assert load_scene(path).elements[4].b == 0.5
    for name in ("link.toml", ".mine-unfinished.toml", ".play-unfinished.toml"):
        (tmp_path / name).symlink_to(tmp_path.parent / "elsewhere.toml")
    (tmp_path / "not a name.toml").write_text("")
    assert tab.do("save", name="play")["files"] == ["mine", "play"]
    assert not (tmp_path.parent / "elsewhere.toml").exists()
    for name in ("load", "save"):
        with pytest.raises(ValueError, match=r"link\.toml: is a link"):
            tab.do(name, name="link", **({"builtin": False} if name == "load" else {"overwrite": True}))


@pytest.mark.parametrize(("name", "game"), [("paddle", "Paddle"), ("pinball", "Pinball"), ("walls", "Walls")])
def test_a_complete_scene_says_how_it_is_played(tmp_path, name, game):
    tab = Tab(tmp_path, name)
    needs = tab.view["needs"]
    assert [env_id for env_id, need in needs.items() if not need] == [f"Bounce/{game}-v0"]
    view = tab.do("save", name="mine")
    assert view["line"] == f'gym.make("Bounce/{game}-v0", scene={str(tmp_path / "mine.toml")!r})'
    assert load_scene(tmp_path / "mine.toml") == load_scene(name)


def test_too_many_elements_are_refused(tmp_path):
    elements = tuple(Wall((0.0, float(i)), (1.0, float(i))) for i in range(MOST_ELEMENTS + 1))
    (tmp_path / "many.toml").write_text(dump_scene(Scene(elements=elements)))
    with pytest.raises(ValueError, match=r"there are 2001, and must be at most 2000"):
        Tab(tmp_path).do("load", name="many", builtin=False)


def test_the_ghost_is_the_tutorials_stepper_and_says_where_it_cannot_run(tmp_path):
    tab = Tab(tmp_path)
    tab.do("launch", position=[0.7, 0.9], velocity=[0.3, 0.0])
    tab.do("ghost", on=True)
    for _ in range(60):
        view = tab.do("advance", seconds=1 / 60)
    right = run(load_scene("tutorial"), (0.7, 0.9), (0.3, 0.0), 1 / 60, 60)
    assert view["ghost"]["position"] == pytest.approx(right.position, abs=1e-12)
    assert view["ghost"]["error"] == pytest.approx(math.dist(right.position, view["ball"][:2]))
    view = tab.do("set", element=None, field="ball.radius", value=0.02)
    assert view["ghost"] is None or "radius" in tab.do("ghost", on=True)["ghost"]["words"]
    assert "the tutorial has only 0.0" in tab.do("ghost", on=True)["ghost"]["words"]


def test_whatever_the_mouse_does_no_ball_is_lost_and_none_is_inside_of_a_wall(tmp_path):
    """Random drags, running and paused, of the ends of all walls but the four around the stage."""
    closed, rng = 4, np.random.default_rng(0)
    tab = Tab(tmp_path)
    for radius in (0.0, 0.03):
        if radius:
            tab.do("set", element=None, field="ball.radius", value=radius)
        for _ in range(PATHS // 2):
            tab.do("remember")
            index, end = int(rng.integers(closed, 13)), int(rng.integers(2))
            place = np.array(tab.ends(index)[2 * end : 2 * end + 2])
            paused = rng.random() < 0.3
            for _ in range(int(rng.integers(1, 8))):
                place = np.clip(place + rng.normal(0.0, 0.2, 2), [0.05, 0.05], [1.55, 0.95])
                if paused:
                    placed(tab, index, end, place)
                    continue
                targets = [None, None]
                targets[end] = place.tolist()
                tab.do("advance", seconds=float(rng.uniform(0.0, 0.04)), drag=index, targets=targets)
                check(tab, radius)


def placed(tab, index, end, place):
    try:
        tab.do("place_end", element=index, end=end, to=place.tolist())
    except SceneError as error:  # too short a wall
        assert "must be at least" in str(error)  # noqa: PT017 (refused or not, both may be)
    except ValueError as error:
        assert "overlaps" in str(error)  # noqa: PT017


def check(tab, radius):
    table = tab.stage.table
    x, y = table.world.position[0].tolist()
    status = table.state()["status"]
    assert radius - 1e-9 <= x <= 1.6 - radius + 1e-9
    assert radius - 1e-9 <= y <= 1.0 - radius + 1e-9
    if status == "crushed":
        return
    for _, (x0, y0, x1, y1) in table.state()["parts"]:
        w = np.array([x1 - x0, y1 - y0])
        along = np.clip(np.dot((x - x0, y - y0), w) / np.dot(w, w), 0.0, 1.0)
        gap = math.hypot(x - x0 - along * w[0], y - y0 - along * w[1]) - radius
        assert gap > -1e-9 * size_of(table.scene), (status, gap)
