"""World's ledger against the moving oracle at 50 digits: flippers, paddles, dragged walls, shuttles, and balls.

Errors grow from hit to hit; by how much is measured with starts that are moved by 1e-30, as in
`test_against_oracle`.
"""

import math
from collections import Counter

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from bounce_env.engine.placement import part_cores_at_start, place_clear, separate_placed_balls
from bounce_env.report.reference.moving import MovingOracle
from bounce_env.report.stability.case import new_world
from bounce_env.scene import Ball, Bumper, Flipper, Paddle, Scene, Wall
from tests.conftest import soak_count

pytestmark = pytest.mark.slow

SECONDS = 2.0
TINY = mpf(2) ** -100
ULP = 2.0**-52
LOST = 1e-6 / ULP
ULPS = 64  # of times, places and speeds of order 10, each time round-off enters
PART_STOPS = 4


@pytest.fixture(autouse=True)
def _fifty_digits():
    with mpmath.workdps(50):
        yield


def scene_of(rng):
    """Two flippers, a paddle, a dragged wall, a bumper on a rail and one that stands, in a box."""

    def material():
        return {"b": float(rng.uniform(0.9, 1.0)), "f": float(rng.uniform(0.95, 1.0))}

    corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
    walls = [Wall(p, q, **material()) for p, q in zip(corners, corners[1:] + corners[:1], strict=True)]
    flippers = [
        Flipper(
            (x, 0.25), 0.15, radius=0.015, rest_angle=rest, active_angle=rest + stroke, up_speed=rng.uniform(2, 20),
            down_speed=rng.uniform(2, 10), name=name, **material(),
        )
        for name, x, rest, stroke in (("left", 0.25, -0.5, 0.9), ("right", 0.75, math.pi + 0.5, -0.9))
    ]  # fmt: skip
    x, y = rng.uniform(0.35, 0.65, 2)
    start, end = (x - 0.1, y), (x + 0.1, y + rng.uniform(-0.1, 0.1))
    box = ((0.2, 0.2), (0.8, 0.8))
    dragged = Wall(start, end, draggable=True, min_length=0.1, reach=box, name="dragged", **material())
    paddle = Paddle((0.2, 0.08), (0.8, 0.08), half_width=0.08, radius=0.02, max_speed=2.0, name="paddle", **material())
    shuttle = Bumper((0.2, 0.9), 0.04, rail_end=(0.8, 0.88), speed=float(rng.uniform(0.2, 1.0)), **material())
    return Scene(
        gravity=(float(rng.uniform(-0.3, 0.3)), -float(rng.choice([0.0, 1.0, 3.0]))),
        ball=Ball(radius=0.02, b=0.98, f=0.99),
        elements=(*walls, *flippers, dragged, paddle, shuttle, Bumper((0.1, 0.6), 0.05, **material())),
    )


def commands_of(rng):
    instants = np.sort(rng.choice(np.arange(1, 128), size=16, replace=False)) / 64
    found = []
    for t in instants.tolist():
        name = str(rng.choice(["left", "right", "paddle", "dragged", "dragged"]))
        values = {"paddle": float(rng.uniform(-2, 2)), "dragged": rng.uniform(-0.7, 0.7, (2, 2)).tolist()}
        found.append((t, name, values.get(name, bool(rng.random() < 0.6))))
    return found


def starts_of(rng, scene, count):
    places = []
    while len(places) < count:
        try:
            place = place_clear(scene, part_cores_at_start(scene), *rng.uniform(0.03, 0.97, 2).tolist())
            separate_placed_balls(scene, np.array([*places, place]))
        except ValueError:
            continue
        places.append(place)
    angles = rng.uniform(0, 2 * math.pi, count)
    return places, (np.stack([np.cos(angles), np.sin(angles)], 1) * rng.uniform(0.5, 2.0, (count, 1))).tolist()


def engine_rows(scene, places, speeds, commands):
    world = new_world(scene, balls=len(places))
    world.reset(position=places, velocity=speeds)
    pages, now = [], 0.0
    for time, name, value in commands:
        pages.append(world.advance(time - now, ledger=True))
        world.command(name, value)
        now = time
    pages.append(world.advance(SECONDS - now, ledger=True))
    return np.concatenate(pages)


def numbers_of_row(row):
    if row["kind"] == PART_STOPS:
        return [float(row["time"])]
    names = ["time", "x", "y", "vx1", "vy1", "vx0", "vy0", "nx", "ny", "ux", "uy"]
    return [float(row[name]) for name in names]


def numbers_of_hit(hit):
    return [hit.time, *hit.numbers]


def difference(a, b):
    return float(max(abs(mpf(x) - mpf(y)) for x, y in zip(a, b, strict=True)))


def moved(rows, by):
    pairs = zip(rows, by, strict=True)
    return [tuple(mpf(c) + d * TINY for c, d in zip(row, shift, strict=True)) for row, shift in pairs]


def kind_of(scene, hit):
    if hit.ball < 0:
        return "stop"
    return type(scene.elements[hit.element]).__name__ if hit.element < len(scene.elements) else "ball"


def test_moving_parts_and_balls_agree_within_the_growth_of_round_off():
    compared, seeds = Counter(), soak_count(6, 500)
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        scene, count = scene_of(rng), int(rng.integers(2, 4))
        commands = commands_of(rng)
        places, speeds = starts_of(rng, scene, count)
        rows = engine_rows(scene, places, speeds, commands)
        truth = MovingOracle(scene).run(places, speeds, SECONDS, commands)
        signs = rng.choice([-1, 1], (2, count, 2)).tolist()
        shifted = MovingOracle(scene).run(moved(places, signs[0]), moved(speeds, signs[1]), SECONDS, commands)
        growth = 1.0
        for k, (row, hit) in enumerate(zip(rows, truth, strict=False)):
            alike = k < len(shifted) and shifted[k][1:3] == hit[1:3]
            if hit.soft or not alike:
                break
            growth = max(growth, difference(numbers_of_hit(hit), numbers_of_hit(shifted[k])) / float(TINY))
            if growth > LOST:
                break
            assert (row["ball"], row["element"]) == (hit.ball, hit.element), (seed, k)
            assert difference(numbers_of_row(row), numbers_of_hit(hit)) <= ULPS * ULP * growth, (seed, k)
            compared[kind_of(scene, hit)] += 1
    print(dict(compared))  # noqa: T201
    assert min(compared[name] for name in ("Wall", "Flipper", "Paddle", "Bumper", "ball", "stop")) >= seeds // 4
