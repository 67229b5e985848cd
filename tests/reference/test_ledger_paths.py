"""The checker's geometry against brute force: least distances, passages and borders of fields by dense sampling."""

import math

import numpy as np
import pytest

from bounce_env.scene import Field, Scene
from tests.conftest import soak_count
from tests.reference.ledger_crossings import Circular, Straight, passages
from tests.reference.ledger_paths import Piece, to_arc, to_point, to_segment, track_of
from tests.reference.ledger_walk import State, Walk

DENSE = np.linspace(0.0, 1.0, 20_001)


def random_piece(rng, *, straight):
    place, velocity = rng.uniform(-1, 1, 2), rng.uniform(-2, 2, 2)
    pull = (0.0, 0.0) if straight else rng.uniform(-3, 3, 2)
    return Piece(1.0, float(rng.uniform(0.1, 3)), *map(float, (*place, *velocity, *pull)), -1, 0)


def dense_path(piece):
    x, y, _, _ = piece.at(DENSE * piece.seconds)
    return x, y


def nearest(distances, piece):
    """Least of the dense samples, and how much less there may be between two of them."""
    fastest = math.hypot(piece.vx, piece.vy) + math.hypot(piece.ax, piece.ay) * piece.seconds
    return distances.min(), fastest * piece.seconds * (DENSE[1] - DENSE[0])


@pytest.mark.parametrize("straight", [True, False])
def test_least_distances_are_those_of_dense_samples(straight):
    rng = np.random.default_rng(5)
    for _ in range(soak_count(100, 5000)):
        piece = random_piece(rng, straight=straight)
        track, (x, y) = track_of([piece]), dense_path(piece)
        angle, length, radius = rng.uniform(0, 6), rng.uniform(0.1, 1), rng.uniform(0.1, 1)
        ex, ey = math.cos(angle), math.sin(angle)
        start, span = rng.uniform(-4, 4), rng.uniform(0.1, 2 * math.pi)
        share = np.clip(ex * x + ey * y, 0, length)
        inside = np.mod(np.arctan2(y, x) - start, 2 * math.pi) <= span
        tips = [np.hypot(x - radius * math.cos(a), y - radius * math.sin(a)) for a in (start, start + span)]
        on_arc = np.where(inside, np.abs(np.hypot(x, y) - radius), np.minimum(*tips))
        ones = np.ones(1)
        for found, samples in (
            (to_point(track), np.hypot(x, y)),
            (to_segment(track, ex * ones, ey * ones, length * ones), np.hypot(x - share * ex, y - share * ey)),
            (to_arc(track, radius, start, span), on_arc),
        ):
            least, between = nearest(samples, piece)
            assert least - between <= found[0] <= least + 1e-12


@pytest.mark.parametrize("kind", ["segment", "circle", "arc"])
def test_passages_are_the_changes_of_sign_of_dense_samples(kind):
    rng = np.random.default_rng(6)
    seen = 0
    for _ in range(soak_count(200, 5000)):
        pieces = [random_piece(rng, straight=False)]
        for _ in range(3):  # a path of several pieces, as after bounces
            x, y, _, _ = pieces[-1].at(pieces[-1].seconds)
            last = pieces[-1]
            pieces.append(random_piece(rng, straight=False)._replace(x=x, y=y, begin=last.begin + last.seconds))
        angle = rng.uniform(0, 6)
        curve = {
            "segment": Straight(0.1, -0.2, math.cos(angle), math.sin(angle), rng.uniform(0.2, 2)),
            "circle": Circular(0.1, -0.2, rng.uniform(0.2, 1)),
            "arc": Circular(0.1, -0.2, rng.uniform(0.2, 1), angle, rng.uniform(0.5, 6)),
        }[kind]
        track = track_of(pieces)
        usable = np.ones(len(pieces), bool)
        found = [p for p in passages(curve, pieces, track, track.box(), usable, 1e-9) if p.margin > 0.0]
        expected = []
        for piece in pieces:
            x, y = dense_path(piece)
            heights = np.array([curve.height(a, b) for a, b in zip(x[::20], y[::20], strict=True)])
            for k in np.flatnonzero(np.diff(heights > 0.0)):
                place = (x[20 * k], y[20 * k])
                expected.append(
                    (bool(heights[k] < 0.0), curve.margin(*place), piece.begin + DENSE[20 * k] * piece.seconds)
                )
        if any(abs(margin) < 0.05 for _, margin, _ in expected):
            continue  # so near an end that the sample beside it may lie beyond
        expected = [(upward, time) for upward, margin, time in expected if margin > 0.0]
        if [p.upward for p in found] != [upward for upward, _ in expected]:
            # samples miss two passages that follow each other at once
            assert len(found) > len(expected)
            assert any(p.depth < 0.01 for p in found)
            continue
        assert all(p.earliest <= t + 0.01 and t <= p.latest for p, (_, t) in zip(found, expected, strict=True))
        seen += len(found)
    assert seen > 30


def test_a_path_through_fields_is_that_of_small_steps():
    rng = np.random.default_rng(7)
    fields = (
        Field(((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)), (2.0, 3.0)),
        Field(((0.5, 0.5), (1.5, 0.4), (1.0, 1.5)), (-4.0, 1.0)),
    )
    scene = Scene(gravity=(0.0, -1.0), elements=fields)
    for _ in range(soak_count(5, 100)):
        start = State(0.0, *map(float, (*rng.uniform(-0.5, 1.5, 2), *rng.uniform(-1, 1, 2))))
        walk = Walk(scene, start, (), ())
        walk.carry(2.0, 0)
        p, v, step = np.array(start[1:3]), np.array(start[3:5]), 1e-4
        for _ in range(20_000):
            a = np.array(walk.pull.at(*p))
            p, v = p + (v + 0.5 * a * step) * step, v + a * step
        # Each border is found to a step, in which the velocity goes wrong by up to 5 m/s^2 for 1e-4 s.
        assert np.allclose([*walk.state[1:]], [*p, *v], atol=2e-3 * len(walk.pieces))
