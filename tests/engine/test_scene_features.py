"""A scene runs on code that has what it needs and no more, and on code that has more with the same bits."""

import math
from collections.abc import Callable

import numba
import numpy as np
import pytest

from bounce_env import (
    ALL_FEATURES,
    Arc,
    Ball,
    Bumper,
    Feature,
    Field,
    Flipper,
    Paddle,
    Scene,
    Sensor,
    Wall,
    World,
    WorldBatch,
)
from bounce_env.engine.packing import pack

pytestmark = pytest.mark.fast

# Each set of features is a kernel of its own, half a minute to compile: `make check` interprets them.
interpreted = pytest.mark.skipif(not numba.config.DISABLE_JIT, reason="run without the compiler, by `make check`")

DISC = Ball(radius=0.05)
FLOOR = Wall((-1.0, 0.0), (1.0, 0.0), b=0.5, name="floor")
PADDLE = Paddle((-0.5, 0.5), (0.5, 0.5), half_width=0.1, radius=0.05, max_speed=1.0, name="paddle")
FLIPPER = Flipper(
    (0.0, 0.5), 0.3, radius=0.02, rest_angle=-0.3, active_angle=0.4, up_speed=9, down_speed=3, name="left"
)
DRAGGED = Wall((-0.5, 0.4), (0.5, 0.4), draggable=True, name="dragged")
TRIANGLE = ((-1.0, 0.0), (1.0, 0.0), (0.0, 1.0))


@pytest.mark.parametrize(
    ("scene", "expected"),
    [
        (Scene(gravity=(0, 0)), set()),
        (Scene(gravity=(0, 0), ball=DISC), {"ball_radius"}),
        (Scene(elements=(FLOOR,)), {"gravity", "walls"}),
        (Scene(ball=DISC, elements=(FLOOR,)), {"ball_radius", "gravity", "walls", "circles", "curved_contact"}),
        (Scene(gravity=(0, 0), ball=DISC, elements=(FLOOR,)), {"ball_radius", "walls", "circles"}),
        (
            Scene(gravity=(0, 0), ball=DISC, elements=(Wall((0, 0), (1, 0), one_way=True),)),
            {"ball_radius", "walls", "one_way_walls"},
        ),
        (Scene(gravity=(0, 0), elements=(Bumper((0, 0), 1),)), {"circles"}),
        (Scene(gravity=(0, 0), elements=(Arc((0, 0), 1, 0, 1),)), {"arcs", "curved_contact"}),
        (Scene(gravity=(0, 0), elements=(Sensor((0, 0), (1, 0)),)), {"line_sensors"}),
        (Scene(gravity=(0, 0), elements=(Sensor(center=(0, 0), radius=1),)), {"circle_sensors"}),
        (Scene(gravity=(0, 0), elements=(Field(TRIANGLE, (1, 0)),)), {"fields", "gravity"}),
        (Scene(elements=(PADDLE,)), {"gravity", "moving_parts", "curved_contact"}),
        (Scene(gravity=(0, 0), elements=(FLIPPER,)), {"moving_parts", "flippers"}),
        (Scene(elements=(DRAGGED,)), {"gravity", "moving_parts", "dragged_walls"}),
        (Scene(gravity=(0, 0), drag=0.5), {"drag"}),
        (
            Scene(gravity=(0, 0), max_speed=9, elements=(Bumper((0, 0), 1, kick=1, cooldown=1),)),
            {"circles", "cooldown"},
        ),
    ],
)
def test_features_follow_from_what_a_scene_has(scene: Scene, expected: set[str]):
    assert scene.features == expected
    state = pack([scene])
    tables = {"faces": "walls", "circles": "circles", "arcs": "arcs", "parts": "moving_parts", "gravity": "gravity"}
    tables |= {"sensors": "line_sensors", "circle_sensors": "circle_sensors", "field_edges": "fields", "drags": "drag"}
    tables |= {"turns": "flippers", "drag_limits": "dragged_walls", "one_way": "one_way_walls", "cooling": "cooldown"}
    there = {feature for name, feature in tables.items() if getattr(state, name) is not None}
    assert there == expected - {"ball_radius", "curved_contact"}
    assert (state.curve_slides is not None) == ("curved_contact" in expected)


def test_what_is_forced_brings_what_it_cannot_do_without():
    world = World(Scene(gravity=(0, 0)), features={"flippers", "fields"})
    assert world.features == {"flippers", "moving_parts", "fields", "gravity", "switches"}
    assert World(Scene(ball=DISC), 2).features == {"ball_radius", "gravity", "several_balls", "switches"}
    assert Feature.SEVERAL_BALLS not in World(Scene(), features=ALL_FEATURES).features


@pytest.mark.parametrize(
    ("names", "message"),
    [
        ({"graviti"}, "'graviti'.*did you mean 'gravity'.*must be one of arcs, "),
        ({"ball_radius"}, "'ball_radius'.*must be one of arcs, "),
        ("gravity", "must be a set of names"),
        ([None], "None.*must be one of"),
    ],
)
def test_features_that_cannot_be_forced_are_refused(names: object, message: str):
    with pytest.raises(ValueError, match=message):
        World(Scene(), features=names)


PLAYS: dict[str, tuple[Scene, tuple[float, float], tuple[float, float], Callable[[World], object]]] = {
    "point, walls": (Scene(elements=(FLOOR,)), (0.0, 0.5), (0.3, 0.0), lambda world: None),
    "no gravity": (
        Scene(gravity=(0, 0), ball=DISC, elements=(FLOOR, Wall((-1, 1), (1, 1)), Bumper((0.0, 0.5), 0.1))),
        (0.5, 0.5),
        (-1.0, 0.4),
        lambda world: world.push((0.1, 0.0)),
    ),
    "bowl": (
        Scene(ball=DISC, elements=(Arc((0, 1), 1, math.pi, 2 * math.pi, b=0.3),)),
        (0.5, 0.6),
        (0.0, 0.0),
        lambda world: None,
    ),
    "paddle": (Scene(ball=DISC, elements=(PADDLE, FLOOR)), (0.1, 0.9), (0.0, 0.0), lambda w: w.command("paddle", 0.5)),
    "flipper": (Scene(ball=DISC, elements=(FLIPPER,)), (0.2, 0.7), (0, 0), lambda w: w.command("left", True)),
    "dragged": (
        Scene(ball=DISC, elements=(DRAGGED, FLOOR)),
        (0.1, 0.6),
        (0.0, 0.0),
        lambda world: world.command("dragged", ((0.0, 0.2), (0.0, 0.1))),
    ),
}


def played(name: str, features: frozenset[str]) -> tuple[bytes, bytes, bytes]:
    scene, position, velocity, act = PLAYS[name]
    world = World(scene, features=features)
    world.reset(position=position, velocity=velocity)
    first = world.advance(0.5, ledger=True)
    act(world)
    second = world.advance(0.75, ledger=True)
    return first.tobytes() + second.tobytes(), world.position.tobytes(), world.velocity.tobytes()


@interpreted
@pytest.mark.parametrize("name", PLAYS)
def test_each_feature_forced_on_changes_no_bit(name: str):
    lean = played(name, frozenset())
    assert len(lean[0]) > 0
    for feature in sorted(ALL_FEATURES):
        assert played(name, frozenset({feature})) == lean, feature
    assert played(name, ALL_FEATURES) == lean


@interpreted
def test_a_snapshot_goes_on_in_a_world_with_the_same_features_only():
    scene = PLAYS["paddle"][0]
    general, lean = World(scene, features=ALL_FEATURES), World(scene)
    general.reset(position=(0.1, 0.9), velocity=(0.0, 0.0))
    with pytest.raises(ValueError, match="must be restored into a world of an equal one with the same features"):
        lean.restore(general.snapshot())
    World(scene, features=ALL_FEATURES).restore(general.snapshot())


# ---- batches


@interpreted
def test_worlds_of_a_batch_do_what_a_world_does():
    """Three balls, commands, a push, and scenes of which one has more than the other."""
    common = (FLIPPER, FLOOR, Wall((-0.3, 0.0), (-0.3, 2.0)), Wall((0.6, 0.0), (0.6, 2.0)))
    scenes = [
        Scene(ball=DISC, max_speed=20, elements=common),
        Scene(ball=DISC, max_speed=30, elements=(*common, Bumper((0.4, 0.9), 0.05, kick=1.0))),
    ]
    rng = np.random.default_rng(1)
    scene_of = [0, 1, 1, 0]
    at = np.stack([rng.uniform(-0.2, 0.5, (4, 3)), np.tile([0.8, 1.1, 1.4], (4, 1))], axis=2)
    speed = rng.uniform(-1.0, 1.0, (4, 3, 2))
    pressed, change = np.array([True, False, True, True]), rng.uniform(-1.0, 1.0, (4, 2))
    batch = WorldBatch(scenes, scene_of, balls=3)
    batch.reset(position=at, velocity=speed)
    batch.advance(0.25)
    batch.command("left", pressed)
    batch.push(change)
    batch.advance(0.5)
    told = batch.advance_until(4, 1.0)
    for w in range(4):
        world = World(scenes[scene_of[w]], 3)
        world.reset(position=at[w], velocity=speed[w])
        world.advance(0.25)
        world.command("left", bool(pressed[w]))
        world.push(change[w])
        world.advance(0.5)
        assert world.advance_until(4, 1.0) == told[w] > 0
        assert world.position.tobytes() == batch.position[w].tobytes()
        assert world.velocity.tobytes() == batch.velocity[w].tobytes()
        assert world.cores.tobytes() == batch.cores[w].tobytes()
        assert world.status.tolist() == batch.status[w].tolist()
        assert world.time == batch.time[w]
        assert world.counts == tuple(column[w] for column in batch.counts)


@interpreted
def test_a_batch_drags_walls_each_its_own_way():
    batch = WorldBatch(Scene(gravity=(0, 0), ball=DISC, elements=(DRAGGED,)), 2)
    batch.reset(position=[(0.0, 1.0), (0.0, 1.0)], velocity=np.zeros((2, 2)))
    batch.command("dragged", [((0, 0.1), (0, 0.2)), ((0, 0.3), (0, 0.4))])
    batch.advance(1.0)
    assert batch.cores[:, 0] == pytest.approx(np.array([(-0.5, 0.5, 0.5, 0.6), (-0.5, 0.7, 0.5, 0.8)]))


@pytest.mark.parametrize(
    ("act", "error", "message"),
    [
        (lambda: WorldBatch([], 1), TypeError, "must be a Scene, or some of them"),
        (lambda: WorldBatch(Scene(), 0), ValueError, "scene_of = 0: must be"),
        (lambda: WorldBatch(Scene(), [0.0]), ValueError, "one index from 0 to 0"),
        (lambda: WorldBatch([Scene()], [0, 1]), ValueError, "one index from 0 to 0"),
        (lambda: WorldBatch([Scene(), Scene(ball=DISC)], [0, 1]), ValueError, "all have a ball of radius 0"),
        (lambda: WorldBatch(Scene(), 2, balls=0), ValueError, "balls = 0"),
        (lambda: WorldBatch(Scene(), 2).advance(1.0), RuntimeError, "reset the worlds"),
        (lambda: WorldBatch(Scene(), 2).reset(position=(0, 0), velocity=(0, 0)), ValueError, r"of shape \(2, 1, 2\)"),
    ],
)
def test_what_a_batch_cannot_do_is_refused(act: Callable[[], object], error: type[Exception], message: str):
    with pytest.raises(error, match=message):
        act()


@interpreted
@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("lefd", True, "did you mean 'left'"),
        ("left", 1.0, "'left' = 1.0: must be True .* or one of them for each of 2 worlds"),
        ("left", [True, False, True], "for each of 2 worlds"),
        ("paddle", [0.5, 1.5], "'paddle' = .*finite and at most 1.0 m/s either way, or one of them"),
        ("dragged", ((0, 0), (0, 9.0)), "each slower than the scene's max_speed, 9.0 m/s, or one of them"),
    ],
)
def test_commands_that_a_batch_cannot_obey_are_refused(name: str, value: object, message: str):
    batch = WorldBatch(Scene(ball=DISC, max_speed=9.0, elements=(FLIPPER, PADDLE, DRAGGED)), 2)
    batch.reset(position=np.full((2, 2), 3.0), velocity=np.zeros((2, 2)))
    with pytest.raises(ValueError, match=message):
        batch.command(name, value)


# ---- counts


@interpreted
def test_counts_and_advance_until():
    world = World(Scene(max_speed=10.0, elements=(Wall((-1, 0), (1, 0), b=4.0),)))
    world.reset(position=(0.0, 0.5), velocity=(0.0, 0.0))
    assert world.advance_until(1, 10.0) == 1
    assert world.time == pytest.approx(math.sqrt(1.0 / 9.81), rel=1e-15)
    assert world.velocity[0, 1] > 0.0
    assert world.counts == (1, 1, 1)
    assert world.advance_until(1, 0.25) == 0
    assert world.time == pytest.approx(math.sqrt(1.0 / 9.81) + 0.25, rel=1e-15)
    world.advance(100.0)
    assert world.counts.bounces == world.counts.events == world.counts.speed_capped > 10
    world.reset(position=(0.0, 0.5), velocity=(0.0, 0.0))
    assert world.counts == (0, 0, 0)
    for bad in (0, 1.5, True):
        with pytest.raises(ValueError, match=r"bounces = .*must be >= 1"):
            world.advance_until(bad, 1.0)
