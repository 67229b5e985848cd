"""Where standing elements run through each other: against dense sampling, and shared corners are none."""

import math

import numpy as np
import pytest

from bounce_env import Arc, Bumper, Paddle, Scene, Sensor, Wall, builtin_scenes, load_scene
from bounce_env.scenecheck.crossings import crossings
from tests.conftest import soak_count

pytestmark = pytest.mark.fast


def pairs(*elements):
    return [(c.first, c.second) for c in crossings(Scene(elements=elements))]


HALF = Arc((0.0, 0.0), 1.0, 0.0, math.pi)
CROSSING = {
    "walls": (Wall((-1, 0), (1, 0)), Wall((0, -1), (0, 1))),
    "walls on each other": (Wall((0, 0), (2, 0)), Wall((1, 0), (3, 0))),
    "a wall twice": (Wall((0, 0), (2, 1)), Wall((2, 1), (0, 0))),
    "wall and arc": (HALF, Wall((-2, 0.5), (2, 0.5))),
    "wall through an end's side": (HALF, Wall((0.5, 0.1), (2, 0.1))),
    "arcs": (HALF, Arc((1.0, 0.0), 1.0, 0.0, math.pi)),
    "arcs of one circle": (HALF, Arc((0.0, 0.0), 1.0, 1.0, 4.0)),
    "arcs of one circle, a turn apart": (HALF, Arc((0.0, 0.0), 1.0, 2 * math.pi + 1.0, 2 * math.pi + 2.0)),
    "arcs of one circle, ten turns apart": (HALF, Arc((0.0, 0.0), 1.0, 20 * math.pi + 1.0, 20 * math.pi + 2.0)),
    "bumpers": (Bumper((0, 0), 1.0), Bumper((1.5, 0), 1.0)),
    "a bumper in a bumper": (Bumper((0, 0), 1.0), Bumper((0.1, 0), 0.2)),
    "wall and bumper": (Wall((-2, 0.5), (2, 0.5)), Bumper((0, 0), 1.0)),
    "a wall's end in a bumper": (Wall((0.5, 0), (2, 0)), Bumper((0, 0), 1.0)),
    "arc and bumper": (HALF, Bumper((0, 1), 0.1)),
    "one-way": (Wall((-1, 0), (1, 0), one_way=True), Wall((0, -1), (0, 1))),
}
SOUND = {
    "a corner": (Wall((0, 0), (1, 0)), Wall((1, 0), (1, 1))),
    "a corner with rounded digits": (Wall((0, 0), (1, 0)), Wall((0.9999999, -0.0000001), (1, 1))),
    "a T": (Wall((-1, 0), (1, 0)), Wall((0, 0), (0, 1))),
    "an end that is a hair too long": (Wall((-1, 0.001), (1.5, -0.0000001)), Wall((0, 0), (2, 0))),
    "a row": (Wall((0, 0), (1, 0)), Wall((1, 0), (2, 0))),
    "apart": (Wall((0, 0), (1, 0)), Wall((0, 1), (1, 1))),
    "a tangent": (HALF, Wall((-2, 1), (2, 1))),
    "a smooth joint": (HALF, Wall((1, 0), (1, -2)), Wall((-1, 0), (-1, -2))),
    "arcs that touch": (HALF, Arc((2.0, 0.0), 1.0, 0.0, 2 * math.pi)),
    "arcs end to end": (HALF, Arc((0.0, 0.0), 1.0, math.pi, 2 * math.pi)),
    "rings": (HALF, Arc((0.0, 0.0), 0.5, 0.0, math.pi)),
    "bumpers that touch": (Bumper((0, 0), 1.0), Bumper((2, 0), 1.0)),
    "a wall on a bumper": (Wall((-2, 1), (2, 1)), Bumper((0, 0), 1.0)),
    "a rounded end": (Wall((0, 0), (2, 0)), Bumper((0, 0), 0.1)),
    "a bumper on a rail": (Wall((-2, 0), (2, 0)), Bumper((0, 1), 0.1, rail_end=(0, -1), speed=1.0)),
    "a dragged wall": (Wall((-2, 0), (2, 0)), Wall((0, -1), (0, 1), draggable=True)),
    "a paddle": (Wall((-2, 0), (2, 0)), Paddle((0, -1), (0, 1), half_width=0.1, radius=0.1, max_speed=1.0)),
    "a sensor": (Wall((-2, 0), (2, 0)), Sensor((0, -1), (0, 1))),
}


@pytest.mark.parametrize("case", CROSSING)
def test_what_crosses_is_found(case):
    assert pairs(*CROSSING[case]) == [(0, 1)]
    assert pairs(*reversed(CROSSING[case])) == [(0, 1)]


@pytest.mark.parametrize("case", SOUND)
def test_corners_and_touches_and_what_moves_are_none(case):
    assert pairs(*SOUND[case]) == []
    assert pairs(*reversed(SOUND[case])) == []


@pytest.mark.parametrize("name", builtin_scenes())
def test_the_built_in_scenes_have_none(name):
    assert crossings(load_scene(name)) == []


def points_of(element, count=4000):
    """Points of its interior: of a line along it, of a disc all over it."""
    share = (np.arange(count) + 0.5) / count
    if isinstance(element, Wall):
        return np.array(element.start) + share[:, None] * (np.array(element.end) - element.start)
    if isinstance(element, Arc):
        angle = element.start_angle + share * (element.end_angle - element.start_angle)
        return np.array(element.center) + element.radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    radius, angle = element.radius * np.sqrt(share), 2.399963 * np.arange(count)
    return np.array(element.center) + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def side_of(element, points):
    """A number that changes its sign across a line, and is negative inside of a disc."""
    if isinstance(element, Wall):
        along = np.array(element.end) - element.start
        away = points - np.array(element.start)
        return (along[0] * away[:, 1] - along[1] * away[:, 0]) / math.hypot(*along)
    return np.hypot(*(points - np.array(element.center)).T) - element.radius


def sampled_to_cross(one, other):
    """Whether two elements cross, by dense sampling; None where that cannot tell."""
    if isinstance(one, Bumper) or isinstance(other, Bumper):
        disc, line = (one, other) if isinstance(one, Bumper) else (other, one)
        gap = side_of(disc, points_of(line)).min()
        return None if abs(gap) < 0.01 else gap < 0.0
    points, side = points_of(one), side_of(other, points_of(one))
    changes = np.flatnonzero(np.diff(np.sign(side)))
    if np.abs(side).min() > 0.01:
        return False
    for place in points[changes]:
        nearest = np.hypot(*(points_of(other) - place).T)
        ends = np.hypot(*(np.concatenate([points_of(line)[[0, -1]] for line in (one, other)]) - place).T)
        if ends.min() < 0.02:
            return None
        if nearest.min() < 0.01:
            return True
        if nearest.min() < 0.03:
            return None
    return None if len(changes) == 0 else False


def random_element(generator):
    x, y, u, v = generator.uniform(-1.0, 1.0, 4).tolist()
    match generator.integers(3):
        case 0:
            return Wall((x, y), (u, v))
        case 1:
            start = generator.uniform(-3.0, 3.0)
            return Arc((x, y), generator.uniform(0.2, 1.0), start, start + generator.uniform(0.3, 6.0))
        case _:
            return Bumper((x, y), generator.uniform(0.05, 0.4))


def test_random_pairs_against_sampling():
    generator = np.random.default_rng(0)
    told = {True: 0, False: 0}
    for _ in range(soak_count(400, 20_000)):
        one, other = random_element(generator), random_element(generator)
        expected = sampled_to_cross(one, other)
        if expected is not None:
            assert bool(pairs(one, other)) == expected, (one, other)
            told[expected] += 1
    assert min(told.values()) > 50
