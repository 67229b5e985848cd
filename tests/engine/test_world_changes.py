"""World: snapshots, drag, and what may be switched, pushed and replaced while a ball is in play."""

from dataclasses import replace

import numpy as np
import pytest

from bounce_env import Arc, Ball, Bumper, Paddle, Scene, Sensor, Wall, World
from bounce_env.engine.memory.records import CROSSING
from bounce_env.report.stability.case import new_world

pytestmark = pytest.mark.fast

ROOM = Scene(
    gravity=(0.0, -1.0),
    ball=Ball(radius=0.05, b=0.5),
    max_speed=9.0,
    elements=(
        Wall((0.0, 0.0), (2.0, 0.0), name="floor"),
        Wall((2.0, 0.0), (2.0, 2.0), name="right"),
        Arc((1.0, 2.0), 1.0, 0.0, 3.0, name="arch"),
        Bumper((1.5, 1.0), 0.2, b=1.5, name="bumper"),
        Sensor(center=(0.5, 1.0), radius=0.25, name="ring"),
        Paddle((0.5, 0.3), (1.0, 0.3), half_width=0.1, radius=0.02, max_speed=2.0, name="paddle"),
    ),
)
DRAGGED = Scene(gravity=(0.0, 0.0), ball=Ball(radius=0.05), drag=0.5, elements=ROOM.elements[:2] + ROOM.elements[-1:])


def started(scene: Scene, position: tuple[float, float], velocity: tuple[float, float]) -> World:
    world = new_world(scene)
    world.reset(position=position, velocity=velocity)
    return world


def crossings(rows) -> list[float]:  # type: ignore[no-untyped-def]
    return [float(row["time"]) for row in rows if row["kind"] == CROSSING]


def seen(world: World) -> tuple[object, ...]:
    return world.time, world.position.tobytes(), world.velocity.tobytes(), world.cores.tobytes()


def test_a_restored_world_goes_on_to_the_same_bits() -> None:
    world, other = started(ROOM, (0.3, 1.5), (0.7, 0.2)), started(ROOM, (1.0, 1.5), (-3.0, 0.0))
    world.command("paddle", 0.75)
    world.enable("bumper", False)
    world.advance(1.7)
    other.advance(2.3)
    other.restore(world.snapshot())
    assert seen(other) == seen(world)
    for act in (lambda w: w.enable("bumper", True), lambda w: w.push((0.1, 2.0)), lambda w: w.command("paddle", -1.0)):
        act(world)
        act(other)
        one, two = world.advance(2.0, ledger=True), other.advance(2.0, ledger=True)
        assert one is not None
        assert two is not None
        assert one.tobytes() == two.tobytes()
        assert len(one) > 0


def test_a_snapshot_knows_that_the_ball_is_inside_of_a_circular_sensor() -> None:
    """Taken at the very instant of the entry, where the ball's place does not tell; a push plans its flight anew."""
    scene = replace(ROOM, gravity=(0.0, 0.0), elements=ROOM.elements[4:5])
    world, other = started(scene, (0.0, 1.0), (0.5, 0.0)), started(scene, (0.0, 1.0), (0.0, 0.5))
    assert crossings(world.advance(0.5, ledger=True)) == [0.5]
    other.restore(world.snapshot())
    for each in (world, other):
        each.push((0.0, 0.125))
        assert crossings(each.advance(2.0, ledger=True)) == []


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda data: data[:-1], "is truncated or changed"),
        (lambda data: data[:100], "is truncated or changed"),
        (lambda data: data + b"\0", "is truncated or changed"),
        (lambda data: b"", "of 0 bytes: is not one"),
        (lambda data: b"x" + data[1:], "is not one of a bounce_env World"),
        (lambda data: data[:200] + bytes([data[200] ^ 1]) + data[201:], "is truncated or changed"),
        (lambda data: data[:16] + b"\xff" + data[17:], "of version 255: must be of version"),
        (lambda data: "text", "must be bytes"),
        (lambda data: None, "must be bytes"),
    ],
)
def test_a_spoilt_snapshot_is_refused_whole(spoil, words: str) -> None:  # type: ignore[no-untyped-def]
    world, other = started(ROOM, (0.3, 1.5), (0.7, 0.2)), started(ROOM, (1.0, 1.5), (-3.0, 0.0))
    world.advance(1.0)
    other.advance(0.5)
    before = other.snapshot()
    with pytest.raises(ValueError, match=words):
        other.restore(spoil(world.snapshot()))
    assert other.snapshot() == before


def test_a_snapshot_of_another_scene_is_refused() -> None:
    world = started(ROOM, (0.3, 1.5), (0.7, 0.2))
    other = started(replace(ROOM, gravity=(0.0, -1.5)), (0.3, 1.5), (0.7, 0.2))
    with pytest.raises(ValueError, match="snapshot of another scene"):
        other.restore(world.snapshot())


@pytest.mark.parametrize(
    ("act", "error", "words"),
    [
        (lambda w: w.enable("ring", False), ValueError, r"'ring' must be one of .*'arch', 'bumper'"),
        (lambda w: w.enable("", False), ValueError, "'' must be one of"),
        (lambda w: w.enable("bumper", 0), ValueError, "enable 'bumper' = 0: must be True or False"),
        (lambda w: w.push((0.0, np.nan)), ValueError, "push = .*: must be .*finite"),
        (lambda w: w.push((0.0,)), ValueError, r"push = .*: must be \(dvx, dvy\)"),
        (lambda w: w.replace("room"), TypeError, "must be a Scene"),
        (lambda w: w.replace(replace(ROOM, ball=Ball(radius=0.06))), ValueError, "ball.radius = 0.06: must be 0.05"),
        (
            lambda w: w.replace(replace(ROOM, elements=(Bumper((0.3, 1.5), 0.5, name="new"),))),
            ValueError,
            "overlaps .*new",
        ),
    ],
)
def test_what_may_not_be_changed_changes_nothing(act, error: type[Exception], words: str) -> None:  # type: ignore[no-untyped-def]
    world = started(ROOM, (0.3, 1.5), (0.0, 0.0))
    world.advance(0.25)
    before = world.snapshot()
    with pytest.raises(error, match=words):
        act(world)
    assert world.snapshot() == before


def test_what_overlaps_the_ball_is_not_switched_on() -> None:
    world = started(ROOM, (0.3, 1.5), (0.0, 0.0))
    world.enable("floor", False)
    world.advance(1.75)  # it has fallen to where the floor was
    before = world.snapshot()
    with pytest.raises(ValueError, match=r"overlaps .*floor"):
        world.enable("floor", True)
    assert world.snapshot() == before
    world.advance(0.5)
    world.enable("floor", True)
    assert world.position[0, 1] < -0.05


def test_a_ball_falls_from_what_is_switched_off_and_reset_switches_it_on() -> None:
    world = started(ROOM, (1.8, 0.05), (0.0, 0.0))
    world.advance(1.0)
    assert world.position[0] == pytest.approx([1.8, 0.05], abs=1e-15)
    world.enable("floor", False)
    world.advance(1.0)
    assert world.position[0, 1] == pytest.approx(0.05 - 0.5, abs=1e-14)
    world.reset(position=(1.8, 0.05), velocity=(0.0, 0.0))
    world.advance(1.0)
    assert world.position[0] == pytest.approx([1.8, 0.05], abs=1e-15)


def test_replace_keeps_time_ball_and_the_paddle_of_the_same_name() -> None:
    world = started(ROOM, (0.3, 1.5), (0.25, 0.0))
    world.command("paddle", 0.125)
    world.advance(0.5)
    ball, paddle = world.position, world.cores
    moved = replace(ROOM, gravity=(0.0, 0.0), elements=(*ROOM.elements[:3], ROOM.elements[5]))
    world.replace(moved)
    assert (world.time, world.position.tolist(), world.cores.tolist()) == (0.5, ball.tolist(), paddle.tolist())
    world.advance(0.5)
    assert world.position[0] == pytest.approx([0.3 + 0.25, ball[0, 1] - 0.5 * 0.5], abs=1e-14)
    assert world.cores[0] == pytest.approx(paddle[0] + [0.0625, 0.0, 0.0625, 0.0], abs=1e-14)


def test_drag_acts_once_at_each_instant_of_a_command() -> None:
    """However many commands an instant has, and not between them: so that it depends on no frame or step."""
    world = started(DRAGGED, (0.25, 1.0), (0.5, 0.0))
    world.advance(0.25)
    assert world.velocity[0].tolist() == [0.5, 0.0]
    world.command("paddle", 0.5)
    world.command("paddle", -0.5)
    world.advance(0.25)
    assert world.velocity[0].tolist() == [0.25, 0.0]
    world.command("paddle", -0.5)  # the command that it has is one, too
    world.advance(0.5)
    assert world.velocity[0].tolist() == [0.125, 0.0]
    assert world.position[0] == pytest.approx([0.25 + 0.125 + 0.0625 + 0.0625, 1.0], abs=1e-15)
