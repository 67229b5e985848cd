"""World's ledger against the oracle at 50 digits, on seeded random scenes.

In a box without gravity 20 hits must agree to 1e-12. Elsewhere dispersing circles multiply an error at
every hit, so that is measured: the oracle also runs from starts moved by 1e-30, and the engine must stay
within a few ulps times the growth of that.
"""

from collections import Counter

import mpmath
import numpy as np
import pytest
from mpmath import mpf

from bounce_env.engine.world import World
from bounce_env.report.reference.flights import BOUNCE, PART_STOPS, SENSOR, Oracle
from bounce_env.scene import Ball, Scene
from tests.conftest import soak_count
from tests.reference.random_scenes import box, direction, free_point, table

pytestmark = pytest.mark.slow

OUT = 3
SECONDS = 4.0
TINY = mpf(2) ** -100  # a shift of the start, so small that its growth stays linear
ULP = 2.0**-52
FLOAT64_IS_LOST = 1e-6 / ULP
ULPS = 16  # of times, positions and velocities of order 1, each time round-off enters
COMPARED = {BOUNCE: 11, SENSOR: 5, PART_STOPS: 1}  # numbers of a ledger row, by kind of event
KINDS = {
    "straight point": {"gravity": False, "radius": 0.0},
    "straight disc": {"gravity": False, "radius": 0.02},
    "falling point": {"gravity": True, "radius": 0.0},
    "falling disc": {"gravity": True, "radius": 0.02},
    "straight disc, kick, cap": {"gravity": False, "radius": 0.02, "kick": True},
    "falling disc, kick, cap": {"gravity": True, "radius": 0.02, "kick": True},
    "straight disc, paddle": {"gravity": False, "radius": 0.02, "paddle": True},
    "falling point, paddle, kick, cap": {"gravity": True, "radius": 0.0, "paddle": True, "kick": True},
    "straight point, curves": {"gravity": False, "radius": 0.0, "curved": True},
    "straight disc, curves": {"gravity": False, "radius": 0.02, "curved": True},
    "falling point, curves": {"gravity": True, "radius": 0.0, "curved": True},
    "falling disc, curves": {"gravity": True, "radius": 0.02, "curved": True},
    "falling disc, drain": {"gravity": True, "radius": 0.02, "drain": True},
    "falling disc, paddle, kick, cap": {"gravity": True, "radius": 0.02, "paddle": True, "kick": True},
}


@pytest.fixture(autouse=True)
def _fifty_digits():
    with mpmath.workdps(50):
        yield


def exact(scene):
    return Oracle(scene, mpf, mpf(10) ** -35)


def engine_run(case, seconds):
    """The engine's events and final state, with the paddle's commands given at their times."""
    world = World(case.scene)
    world.reset(position=case.position, velocity=case.velocity)
    pages, now = [], 0.0
    for time, speed in case.commands:
        pages.append(world.advance(time - now, ledger=True))
        world.command("paddle", speed)
        now = time
    pages.append(world.advance(seconds - now, ledger=True))
    return np.concatenate(pages), world


def oracle_run(case, seconds, shift=(0, 0, 0, 0)):
    (x, y), (vx, vy) = case.position, case.velocity
    dx, dy, dvx, dvy = (d * TINY for d in shift)
    return exact(case.scene).run((x + dx, y + dy), (vx + dvx, vy + dvy), seconds, case.commands)


def numbers_of_row(row):
    """What is compared, all of order 1 here: of a bounce all that the ledger says."""
    names = ["time", "x", "y", "vx1", "vy1", "vx0", "vy0", "nx", "ny", "ux", "uy"]
    return [float(row[name]) for name in names[: COMPARED[int(row["kind"])]]]


def numbers_of_event(event):
    numbers = [event.time, event.x, event.y, event.vx, event.vy, *event.before, *event.normal, *event.surface]
    return numbers[: COMPARED[event.kind]]


def difference(a, b):
    return float(max(abs(mpf(x) - mpf(y)) for x, y in zip(a, b, strict=True)))


@pytest.mark.parametrize("radius", [0.0, 0.05])
@pytest.mark.parametrize("lossy", [False, True])
def test_twenty_hits_in_a_box_without_gravity_agree_to_1e_12(radius, lossy):
    worst = 0.0
    for seed in range(soak_count(15, 500)):
        rng = np.random.default_rng(seed)
        surfaces = [{"b": rng.uniform(0.7, 1.2), "f": rng.uniform(0.7, 1)} if lossy else {} for _ in range(4)]
        width, height, angle = rng.uniform(0.5, 2), rng.uniform(0.5, 2), rng.uniform(0, 6)
        ball = Ball(radius=radius, b=0.97, f=0.99) if lossy else Ball(radius=radius)
        upright = box(width, height)
        x, y = free_point(rng, (0, 0), (width, height), upright, radius + 0.01)
        start = (x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle))
        velocity = direction(rng, rng.uniform(0.5, 2))
        elements = box(width, height, angle, surfaces)
        scene = Scene(gravity=(0, 0), ball=ball, max_speed=1e6, elements=elements)
        truth = exact(scene).run(start, velocity, 1e4, max_events=20).events
        world = World(scene)
        world.reset(position=start, velocity=velocity)
        rows = world.advance(1e4, ledger=True, max_events=20)
        assert list(rows["element"]) == [e.element for e in truth]
        for row, e in zip(rows, truth, strict=True):
            speed = float(mpmath.hypot(e.vx, e.vy))
            size = max(width, height)
            worst = max(
                worst,
                abs(float(mpf(float(row["time"])) - e.time)) / float(e.time),
                float(mpmath.hypot(float(row["x"]) - e.x, float(row["y"]) - e.y)) / size,
                float(mpmath.hypot(float(row["vx1"]) - e.vx, float(row["vy1"]) - e.vy)) / speed,
            )
    assert worst <= 1e-12


def growths(truth, shifted):
    """By how much a small error of the start has grown at each event, and at the end."""
    ends = [[*run.position, *run.velocity] for run in (truth, *shifted)]
    found = []
    for k, event in enumerate(truth.events):
        a = numbers_of_event(event)
        found.append(max(difference(a, numbers_of_event(run.events[k])) for run in shifted) / float(TINY))
    found.append(max(difference(ends[0], end) for end in ends[1:]) / float(TINY))
    return np.maximum.accumulate([1.0, *found])[1:]


@pytest.mark.parametrize("kind", KINDS)
def test_whole_runs_agree_within_the_growth_of_round_off(kind):
    compared, seeds = Counter(), soak_count(4, 50)
    for seed in range(seeds):
        case = table(seed, **KINDS[kind])
        rows, world = engine_run(case, SECONDS)
        truth = oracle_run(case, SECONDS)
        growth = growths(truth, [oracle_run(case, SECONDS, shift) for shift in ((1, 0, 0, 1), (0, 1, -1, 0))])
        known = int(np.searchsorted(growth, FLOAT64_IS_LOST))  # events before an error of 1e-6
        events = truth.events[:known]
        assert [(r["element"], r["kind"]) for r in rows[:known]] == [(e.element, e.kind) for e in events], seed
        for k, (row, e) in enumerate(zip(rows, events, strict=False)):
            assert difference(numbers_of_row(row), numbers_of_event(e)) <= ULPS * ULP * growth[k], (seed, k)
            compared[e.kind] += 1
        if known == len(growth):
            found, end = (
                [*world.position[0].tolist(), *world.velocity[0].tolist()],
                (*truth.position, *truth.velocity),
            )
            assert difference(found, end) <= ULPS * ULP * growth[-1], seed
            assert (world.status[0] == OUT) == truth.out
            compared["end"] += 1
            compared["out"] += truth.out
    assert compared[BOUNCE] > 4 * seeds
    assert compared[SENSOR] > 2 * seeds
    assert compared["end"] > 0.7 * seeds
    assert compared[PART_STOPS] >= seeds or "paddle" not in kind
    assert compared["out"] >= 0.25 * seeds or "drain" not in kind
