"""The checker's least gaps to parts that move, and between balls, against brute force by dense sampling."""

import math

import numpy as np
import pytest

from bounce_env.scene import Ball, Bumper, Flipper, Paddle, Scene, Wall
from tests.conftest import soak_count
from tests.reference.ledger_gaps import least_distances, least_gaps
from tests.reference.ledger_motion import run_of
from tests.reference.ledger_paths import Piece, track_of
from tests.reference.ledger_shapes import Shapes

DENSE = np.linspace(0.0, 1.0, 20_001)
ALLOWED = 1e-9
SECONDS = 0.5


def random_piece(rng):
    numbers = (*rng.uniform(-0.5, 0.5, 2), *rng.uniform(-2, 2, 2), *rng.choice([0.0, 3.0], 2))
    return Piece(1.0, SECONDS, *map(float, numbers), -1, 0)


def random_part(rng, kind):
    (x0, y0), (x1, y1) = rng.uniform(-0.3, 0.3, (2, 2)).tolist()
    match kind:
        case "flipper":
            turn = {"rest_angle": float(rng.uniform(0, 3)), "active_angle": 6.0, "up_speed": 4.0, "down_speed": 1.0}
            return Flipper((x0, y0), 0.3, radius=0.05, name="part", **turn), (float(rng.choice([-3.0, 3.0, 50.0])),)
        case "paddle":
            part = Paddle((x0, y0), (x1, y1), half_width=0.1, radius=0.05, max_speed=1.0)
            return part, (float(rng.uniform(-1, 1)),)
        case "shuttle":
            return Bumper((x0, y0), 0.1, rail_end=(x1, y1), speed=1.0), (float(rng.uniform(-1, 1)),)
    return Wall((x0, y0), (x1, y1), draggable=True), tuple(rng.uniform(-1, 1, 4).tolist())


@pytest.mark.parametrize("kind", ["flipper", "paddle", "shuttle", "dragged"])
def test_least_gaps_to_parts_are_those_of_dense_samples(kind):
    rng = np.random.default_rng(7)
    for _ in range(soak_count(60, 3000)):
        part, rates = random_part(rng, kind)
        scene = Scene(ball=Ball(radius=0.02), elements=(part,))
        motion = run_of(part, 1.0)
        motion.go(1.0, motion.legs[0].at, rates)
        piece = random_piece(rng)
        ((_, _, (gap,)),) = least_gaps(Shapes(scene, {0: motion}), scene, track_of([piece]), ALLOWED)
        x, y, _, _ = piece.at(DENSE * SECONDS)
        core = motion.core(1.0 + DENSE * SECONDS)
        dx, dy = core.x1 - core.x0, core.y1 - core.y0
        square = np.maximum(dx * dx + dy * dy, 1e-30)
        share = np.clip(((x - core.x0) * dx + (y - core.y0) * dy) / square, 0.0, 1.0)
        samples = np.hypot(x - core.x0 - share * dx, y - core.y0 - share * dy) - motion.radius - 0.02
        # Where there is room, how much is not looked for; where there is none, the gap is as deep as was seen first.
        if samples.min() >= 0.0:
            assert gap >= -2.0 * ALLOWED
        elif samples.min() < -1e-6:
            assert gap < -ALLOWED


def test_least_distances_of_balls_are_those_of_dense_samples():
    rng = np.random.default_rng(8)
    for _ in range(soak_count(60, 3000)):
        paths = []
        for cut in rng.uniform(0.1, 0.4, 2):
            first, second = (random_piece(rng) for _ in range(2))
            paths.append([first._replace(seconds=float(cut)), second._replace(begin=1.0 + cut, seconds=SECONDS - cut)])
        distances, _, _ = least_distances(*paths)
        t = DENSE * SECONDS
        places = []
        for first, second in paths:
            inside = t < first.seconds
            one, other = first.at(t), second.at(t - first.seconds)
            places.append([np.where(inside, a, b) for a, b in zip(one[:2], other[:2], strict=True)])
        samples = np.hypot(places[0][0] - places[1][0], places[0][1] - places[1][1])
        between = 2.0 * math.hypot(5.0, 5.0) * SECONDS * (DENSE[1] - DENSE[0])
        assert samples.min() - between <= distances.min() <= samples.min() + 1e-9
