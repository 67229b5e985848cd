"""A run in words and as a picture: `ledger_table` and `plot_trajectory`."""

import sys

import gymnasium as gym
import numpy as np
import pytest
from matplotlib.figure import Figure

from bounce_env import ALL_FEATURES, Arc, Ball, Bumper, Field, Flipper, Paddle, Scene, Sensor, Wall, World, load_scene
from bounce_env.extras import MissingExtraError
from bounce_env.trajectory import element_name, ledger_table, plot_trajectory

TWO_WALLS = Scene(ball=Ball(radius=0.1, b=0.5), elements=(Wall((-2, 0), (2, 0), name="floor"), Wall((1, 0), (1, 3))))


def recorded(scene, position, velocity, seconds, balls=1):
    world = World(scene, balls, features=ALL_FEATURES)
    world.record()
    world.reset(position=position, velocity=velocity)
    world.advance(seconds)
    return world, world.recorded()


def axes_of(run, **kwargs):
    return plot_trajectory(run, Figure().add_subplot(), **kwargs)


def path_of(axes, colour="#d1495b"):
    """The longest line of a ball's colour: its path."""
    lines = [line for line in axes.lines if line.get_color() == colour and line.get_linestyle() == "-"]
    return np.column_stack(max(lines, key=lambda line: len(line.get_xdata())).get_data())


def test_a_ledger_in_words():
    _, run = recorded(TWO_WALLS, (0.0, 1.0), (1.2, 0.0), 3.0)
    table = ledger_table(run.scene, run.ledger)
    assert [row["time"] for row in table] == run.ledger["time"].tolist()
    assert [row["vy1"] for row in table] == run.ledger["vy1"].tolist()
    assert {row["kind"] for row in table} == {"bounce", "contact begins"}
    assert {row["element"] for row in table} == {"floor", "wall 1"}
    assert table[0]["element"] == "floor"
    assert table[0]["y"] == pytest.approx(0.1)
    assert table[-1]["kind"] == "contact begins"


def test_balls_are_elements_after_the_last_one():
    scene = Scene(gravity=(0.0, 0.0), ball=Ball(radius=0.1), elements=TWO_WALLS.elements)
    _, run = recorded(scene, [(-1.0, 1.0), (0.0, 1.0)], [(1.0, 0.0), (0.0, 0.0)], 0.95, balls=2)
    assert {(row["ball"], row["element"]) for row in ledger_table(scene, run.ledger)} == {(0, "ball 1"), (1, "ball 0")}
    assert element_name(scene, 3) == "ball 1"
    with pytest.raises(IndexError, match="-1"):
        element_name(scene, -1)


@pytest.mark.parametrize("ledger", [None, [], np.zeros(3), np.zeros(2, [("time", "f8")])])
def test_what_is_no_ledger_is_refused(ledger):
    with pytest.raises(ValueError, match=r"World\.advance"):
        ledger_table(TWO_WALLS, ledger)


@pytest.mark.parametrize("name", ["bowl", "pegs", "circle"])
def test_the_path_goes_through_all_events_and_ends_where_the_ball_is(name):
    scene = load_scene(name)
    x0, y0, x1, y1 = scene.bounds
    world, run = recorded(scene, (0.5 * (x0 + x1) + 0.01, 0.3 * y0 + 0.7 * y1 - 0.1), (0.9, 0.5), 12.0)
    path = path_of(axes_of(run))
    assert path[-1] == pytest.approx(world.position[0], abs=1e-9)
    bounces = run.ledger[run.ledger["kind"] == 0]
    assert len(run.ledger) > 3
    for row in bounces:
        assert np.hypot(*(path - (row["x"], row["y"])).T).min() < 1e-9


def test_chords_of_a_path_are_near_to_it_however_long_it_swings():
    _, run = recorded(load_scene("bowl"), (-0.6, 0.0), (0.0, 0.0), 40.0)
    path = path_of(axes_of(run))
    assert run.ledger["kind"].tolist()[-1] == 1  # it slides to the end
    radius = np.hypot(*path[-1])
    slide = path[int(np.argmax(path[:, 1] < -0.8)) :]
    middles = 0.5 * (slide[1:] + slide[:-1])
    assert np.abs(np.hypot(*middles[-2000:].T) - radius).max() < 0.002


def test_every_element_is_drawn_where_it_is():
    elements = (
        Wall((0, 0), (1, 0)),
        Wall((0, 3), (1, 3), draggable=True, name="drag"),
        Bumper((2, 2), 0.3),
        Bumper((3, 2), 0.2, rail_end=(4, 2), speed=0.1),
        Arc((5, 5), 1.0, 0.0, 3.0),
        Paddle((0, 5), (1, 5), half_width=0.2, radius=0.05, max_speed=1.0, name="paddle"),
        Flipper((7, 1), 0.5, radius=0.1, rest_angle=0.0, active_angle=1.0, up_speed=1.0, down_speed=1.0, name="flip"),
        Sensor((8, 0), (9, 0)),
        Sensor(center=(8, 3), radius=0.4),
        Field(((10, 0), (11, 0), (11, 1)), (1.0, 0.0)),
    )
    scene = Scene(ball=Ball(radius=0.05), elements=elements)
    _, run = recorded(scene, (2.0, 6.0), (0.0, 0.0), 0.1)
    axes = axes_of(run)
    drawn = np.concatenate([np.column_stack(line.get_data()) for line in axes.lines])
    patches = np.concatenate([patch.get_xy() for patch in axes.patches])
    for element in elements:
        x0, y0, x1, y1 = element.bounds
        points = patches if isinstance(element, Field) else drawn
        inside = points[(points >= (x0 - 1e-9, y0 - 1e-9)).all(1) & (points <= (x1 + 1e-9, y1 + 1e-9)).all(1)]
        assert len(inside) >= 2, element
        if isinstance(element, Wall | Arc | Sensor | Field):  # what moves is drawn where it begins
            assert inside.min(0) == pytest.approx((x0, y0), abs=0.01)
            assert inside.max(0) == pytest.approx((x1, y1), abs=0.01)
    assert axes.get_aspect() == 1.0


def test_names_are_written_once_at_a_place_and_not_where_nobody_wants_them():
    _, run = recorded(TWO_WALLS, (0.0, 1.0), (1.2, 0.0), 3.0)
    texts = [text.get_text() for text in axes_of(run).texts]
    assert {"floor", "wall 1"} == set(texts)
    assert len(texts) < len(run.ledger)
    assert not axes_of(run, names=False).texts


def test_an_episode_of_an_environment():
    env = gym.make("Bounce/Pinball-v0", record_events=True)
    env.reset(seed=1)
    for _ in range(60):
        env.step(3)
    run = env.unwrapped.recorded()
    assert run.end > 1.0
    assert any("flipper" in row["element"] or "arch" in row["element"] for row in ledger_table(run.scene, run.ledger))
    envs = gym.make_vec("Bounce/Pinball-v0", num_envs=3, vectorization_mode="vector_entry_point")
    envs.unwrapped.record(1)
    envs.reset(seed=0)
    for _ in range(60):
        envs.step(np.full(3, 3))
    assert (envs.unwrapped.recorded().ledger == run.ledger).all()
    with pytest.raises(RuntimeError, match="nothing is recorded"):
        gym.make("Bounce/Pinball-v0").unwrapped.recorded()


def test_what_is_no_run_is_refused_with_the_way_to_one():
    with pytest.raises(TypeError, match=r"World\.record\(\)"):
        plot_trajectory(World(TWO_WALLS))


def test_without_matplotlib_the_extra_is_named(monkeypatch):
    _, run = recorded(TWO_WALLS, (0.0, 1.0), (0.0, 0.0), 0.5)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(MissingExtraError, match=r"\[plot\]"):
        plot_trajectory(run)
