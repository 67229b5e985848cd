"""Whatever moves in a closed scene, however it is commanded: no ball escapes, sinks in, or stops without a reason."""

from collections import Counter

import numpy as np
import pytest

from bounce_env import Scene, Wall
from bounce_env.engine.memory.records import BUDGET, CRUSHED, OK
from bounce_env.engine.placement import element_gaps
from bounce_env.engine.world import World
from bounce_env.report.stability.case import new_world
from tests.conftest import soak_count
from tests.engine.moving_scenes import MAX_SPEED, command_at_random, moving_scene, start

pytestmark = pytest.mark.slow

SECONDS = 20.0
EVENTS = 20_000  # in one call
# Time stood still there, or a ball sank into something.
ONCE_WRONG = (
    1955, 13221, 13591, 20615, 21160, 22133, 23275, 24531, 24771, 26953, 27255, 31157, 31402, 31509, 32394, 33229,
    39637, 48054, 51557, 62886, 66404, 67192, 68161, 78925,
    5485, 6170, 7375, 8036, 8367, 8964, 9080, 10041, 10137, 10737, 13314,
    5489, 6133, 10637, 11086, 11186, 11858, 12049, 12286, 13949, 14345, 15106, 16818, 17779, 18579,
)  # fmt: skip


def overlap(world: World) -> float:
    """How deep [m] a ball is inside of a wall, a part or another ball, or outside of the box; negative if none is."""
    radius, place = world.scene.ball.radius, world.position
    cores = {
        index: ((x0, y0), (x1, y1))
        for (index, _), (x0, y0, x1, y1) in zip(world.scene.parts, world.cores.tolist(), strict=True)
    }
    separate = np.hypot(*(place[:, None] - place[None, :]).T) + 10.0 * np.eye(len(place))
    beside = min(gap for x, y in place.tolist() for _, gap in element_gaps(world.scene, cores, x, y))
    return float(max((np.abs(place - 0.5) - (0.5 - radius)).max(), 2.0 * radius - separate.min(), -beside))


def test_moving_scenes() -> None:
    """Soak: 10^5 scenes with 1 to 5 balls, 20 s each; a command before every piece of them.

    What uses up its budget does so in due time: a thousand events take some nanoseconds at the least.
    """
    counts: Counter[str] = Counter()
    deepest, fastest, jams = -1.0, 0.0, list[int]()
    for n, seed in enumerate((*ONCE_WRONG, *range(soak_count(150, 100_000)))):
        if seed % 1000 == 0:
            print(seed, dict(counts), f"deepest {deepest:.2g} m, fastest {fastest:.5g} m/s", jams, flush=True)  # noqa: T201
        rng = np.random.default_rng(seed)
        scene = moving_scene(rng)
        world = new_world(scene, balls=int(rng.integers(1, 6)))
        if not start(rng, world, len(world._state.balls[0])):
            counts["no room"] += 1
            continue
        seen = set()
        while world.time < SECONDS:
            command_at_random(rng, world)
            world.advance(float(rng.choice([0.0078125, 0.125, 0.5, 2.0])), max_events=EVENTS)
            assert np.isfinite(world.velocity).all(), seed
            fastest = max(fastest, np.hypot(*world.velocity.T).max())
            deepest = max(deepest, overlap(world))
            assert deepest <= 1e-9, seed
            statuses = set(world.status.tolist())
            assert statuses <= {OK, BUDGET, CRUSHED}, seed
            seen |= statuses
            if BUDGET in statuses:
                before = world.time
                world.advance(1.0, max_events=EVENTS)
                jams += [seed] if world.time <= before + 1e-7 else []
                break
        came_to = "budget" if BUDGET in seen else "crushed" if CRUSHED in seen else "ok"
        counts["once wrong" if n < len(ONCE_WRONG) else came_to] += 1
    print(dict(counts), f"deepest {deepest:.2g} m, fastest {fastest:.5g} m/s, jams {jams}")  # noqa: T201
    assert fastest <= 1.01 * MAX_SPEED  # it may fall a little faster
    assert not jams
    # Piles of balls and slow rolling, all of it in small hops.
    assert counts["budget"] <= 0.1 * (counts.total() - counts["once wrong"])


def test_points_between_walls() -> None:
    """Soak: 10^4 points over a wall that reaches through both sides of a box, and is dragged up and down and tilted.

    However it moves, a ball that began above it is above it, and inside of the box; or it is crushed there.
    """
    crushed = 0
    for seed in range(soak_count(100, 10_000)):
        rng = np.random.default_rng([seed, 2])
        lid = Wall((-1.0, 1.0), (2.0, 1.0), b=float(rng.choice([0.0, 0.5, 0.9])))
        sides = [Wall((x, -9.0), (x, 2.0), b=0.9) for x in (0.0, 1.0)]
        piston = Wall((-1, 0.5), (2, 0.5), draggable=True, b=float(rng.choice([0.0, 0.5, 1.0])), name="piston")
        scene = Scene(
            gravity=(0.0, -float(rng.choice([0.0, 1.0, 10.0]))), rest_speed=float(rng.choice([0.0, 0.02])),
            elements=(lid, *sides, piston),
        )  # fmt: skip
        world = new_world(scene)
        angle = rng.uniform(0.0, 2.0 * np.pi)
        world.reset(position=rng.uniform((0.1, 0.6), (0.9, 0.9)), velocity=(np.cos(angle), np.sin(angle)))
        rises = rng.uniform(-1.0, 1.0, 20)
        tilts = rng.choice([0.0, 0.0, 0.3, 3.0], 20) * rng.uniform(-1.0, 1.0, 20)
        if seed % 4 == 0:  # straight up, and against the lid
            rises, tilts = np.full(20, 0.25), np.zeros(20)
        for rise, tilt in zip(rises, tilts, strict=True):
            world.command("piston", ((0.0, rise - tilt), (0.0, rise + tilt)))
            world.advance(0.125, max_events=EVENTS)
            ((x0, y0, x1, y1),), (x, y) = world.cores, world.position[0]
            if max(y0, y1) >= 1.0:  # an end has passed the lid: nothing holds the ball
                break
            assert -1e-9 <= x <= 1.0 + 1e-9, seed
            assert y <= 1.0 + 1e-9, seed
            assert (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0) >= -1e-9, seed
        crushed += world.status[0] == CRUSHED
    assert crushed > 0


def test_pieces_and_snapshots_change_no_bit() -> None:
    """The time between two commands in one piece, or in four, each in a new world from a snapshot."""
    for seed in range(soak_count(40, 2000)):
        rng = np.random.default_rng([seed, 1])
        scene, count = moving_scene(rng), int(rng.integers(1, 6))
        whole, pieces = new_world(scene, balls=count), new_world(scene, balls=count)
        if not start(rng, whole, count):
            continue
        pieces.restore(whole.snapshot())
        for _ in range(8):
            state = rng.bit_generator.state
            command_at_random(rng, whole)
            rng.bit_generator.state = state
            command_at_random(rng, pieces)
            seconds = float(rng.choice([0.0625, 0.5]))
            rows = [whole.advance(seconds, ledger=True, max_events=EVENTS)]
            if BUDGET in whole.status:
                break
            for _ in range(4):
                other = new_world(scene, balls=count)
                other.restore(pieces.snapshot())
                pieces = other
                rows.append(pieces.advance(seconds / 4, ledger=True, max_events=EVENTS))
            assert np.concatenate(rows[1:]).tobytes() == rows[0].tobytes(), seed
            assert pieces.position.tobytes() == whole.position.tobytes(), seed
            assert pieces.cores.tobytes() == whole.cores.tobytes(), seed
