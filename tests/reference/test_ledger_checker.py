"""The ledger checker accepts what the engine does, and rejects every ledger that has been tampered with."""

import itertools
import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from bounce_env.scene import Arc, Ball, Bumper, Field, Paddle, Scene, Sensor, Wall, builtin_scenes, load_scene
from tests.conftest import soak_count
from tests.reference.ledger_checker import End, Start, before_a_slide_on_a_curve, find_problems
from tests.reference.ledger_scenes import played, standing, with_all_kinds
from tests.reference.ledger_tampering import changes
from tests.reference.random_scenes import box, table


class Played(NamedTuple):
    scene: Scene
    start: Start
    ledger: np.ndarray
    end: End
    commands: tuple = ()

    def problems(self):
        return find_problems(self.scene, self.start, self.ledger, self.end, self.commands)


def play(scene, position, velocity, seconds, commands=()):
    start, ledger, end = played(scene, position, velocity, seconds, commands)
    return Played(scene, start, ledger, end, tuple(commands))


def play_table(seed, seconds, **kind):
    case = table(seed, **kind)
    commands = [(time, "paddle", speed) for time, speed in case.commands if time < seconds]
    return play(case.scene, case.position, case.velocity, seconds, commands)


# ---- scenes whose ledgers are tampered with: between them they have rows of every kind


def whole(*elements, ball=Ball(radius=0.02), **more):  # noqa: B008 - a Ball is frozen
    return Scene(ball=ball, drag=0.75, elements=with_all_kinds(elements, ball.radius), **more)


def gravity_box():
    """A lossy box with sensors of both shapes, for a point, before it comes to rest."""
    walls = box(1.0, 0.8, surfaces=[{"b": 0.8, "f": 0.9}] * 4)
    sensors = (Sensor((0.1, 0.3), (0.9, 0.35)), Sensor(center=(0.6, 0.4), radius=0.2))
    return play(whole(*walls, *sensors, ball=Ball(b=0.95, f=0.98)), (0.3, 0.5), (1.3, 0.4), 1.0)


def slide():
    """Bounces on a slope that end in contact, off its lower end, and down to a floor on which friction holds it."""
    slope = Wall((0.0, 1.0), (1.0, 0.6), b=0.05, name="slope")
    floor = Wall((-1.0, 0.0), (5.0, 0.0), b=0.02, f=0.5, name="floor")
    return play(whole(slope, floor, ball=Ball(radius=0.05)), (0.3, 1.2), (0.0, 0.0), 3.0)


def chain():
    """A slide over two joints, with a sensor on the way."""
    joints = [(k * 0.5, 1.0 - k * 0.25) for k in range(4)]
    walls = [Wall(a, b, b=0.0, name=f"w{k}") for k, (a, b) in enumerate(itertools.pairwise(joints))]
    sensor = Sensor((0.7, 0.2), (0.9, 1.2))
    return play(whole(*walls, sensor), (0.1, 1.1), (0.2, 0.0), 1.5)


def hollow():
    """Rest in a V, with a game's rest speed."""
    walls = (Wall((-1.0, 1.0), (0.0, 0.0), b=0.3, name="left"), Wall((0.0, 0.0), (1.0, 1.2), b=0.3, name="right"))
    return play(whole(*walls, ball=Ball(radius=0.1), rest_speed=0.1), (0.2, 0.8), (-0.1, 0.0), 4.0)


def passages():
    """Both sides of arcs, one-way walls, a field, kicks that must cool down."""
    elements = (
        *box(2.0, 2.0),
        Arc((1.0, 1.0), 0.5, 0.5, 5.0, b=0.9, kick=0.3, kick_threshold=0.2, cooldown=0.4, name="bowl"),
        Wall((0.1, 0.6), (0.6, 0.3), one_way=True, name="gate"),
        Wall((1.9, 1.2), (1.3, 1.5), one_way=True, name="other gate"),
        Bumper((1.6, 0.4), 0.1, b=1.2, f=0.8, kick=0.5, cooldown=1.0, name="bumper"),
        Field(((0.2, 1.2), (0.9, 1.1), (1.2, 1.9), (0.3, 1.8)), (3.0, 1.0)),
        Sensor(center=(1.0, 1.0), radius=0.3),
        Sensor((0.2, 0.2), (1.8, 1.7)),
    )
    scene = whole(*elements, gravity=(0.0, -2.0), ball=Ball(radius=0.03), max_speed=6.0)
    return play(scene, (1.2, 1.0), (1.7, 1.1), 3.0)


def commanded():
    """A shelf that is switched off under a resting ball, pushes, a paddle, and drag."""
    elements = (
        *box(1.0, 1.0),
        Wall((0.1, 0.5), (0.6, 0.5), b=0.0, f=0.5, name="shelf"),
        Paddle((0.2, 0.2), (0.8, 0.2), half_width=0.1, radius=0.02, max_speed=1.0, b=0.9, f=0.7, name="paddle"),
    )
    scene = whole(*elements)
    script = ((0.5, "paddle", 0.3), (0.75, "", (1.0, 2.0)), (1.25, "paddle", -1.0), (1.5, "shelf", False))
    return play(scene, (0.3, 0.7), (0.1, 0.0), 2.25, script)


def on_a_paddle(f):
    """Bounces on a paddle that end in contact: with f < 1 it takes the ball along, with f = 1 it slides away."""
    paddle = Paddle((0.5, 0.2), (1.5, 0.2), half_width=0.4, radius=0.02, max_speed=1.0, b=0.3, f=f, name="paddle")
    script = ((1.0, "paddle", 0.3), (1.5, "paddle", -0.4), (2.25, "paddle", 0.1))
    return play(whole(*box(2.0, 1.0), paddle), (1.0, 0.5), (0.05, 0.0), 4.0, script)


RUNS = {
    "box": lambda: play(load_scene("box"), (0.5, 1.3), (0.3, 0.2), 20.0),
    "pegs": lambda: play(load_scene("pegs"), (0.5, 1.3), (0.3, 0.2), 2.0),
    "gravity box": gravity_box,
    "paddle, kick, cap": lambda: play_table(0, 3.0, gravity=True, radius=0.02, paddle=True, kick=True),
    "paddle, drain, point": lambda: play_table(1, 4.0, gravity=True, radius=0.0, paddle=True, drain=True),
    "slide": slide,
    "chain": chain,
    "hollow": hollow,
    "passages": passages,
    "commanded": commanded,
    "taken along by a paddle": lambda: on_a_paddle(0.7),
    "sliding on a paddle": lambda: on_a_paddle(1.0),
}


@pytest.mark.parametrize("name", RUNS)
def test_each_changed_or_missing_row_is_noticed(name):
    run = RUNS[name]()
    assert run.problems() == []
    unnoticed = [what for what, ledger in changes(run.scene, run.ledger) if not run._replace(ledger=ledger).problems()]
    assert unnoticed == []


@pytest.mark.parametrize("name", RUNS)
def test_a_changed_end_is_noticed(name):
    run = RUNS[name]()
    time, (x, y), (vx, vy), status, asked = run.end
    speed = 1e-6 * max(math.hypot(vx, vy), 1.0)
    ends = [
        End(time * (1 - 1e-6), (x, y), (vx, vy), status, asked),
        End(time, (x + 1e-6, y), (vx, vy), status, asked),
        End(time, (x, y - 1e-6), (vx, vy), status, asked),
        End(time, (x, y), (vx + speed, vy), status, asked),
        End(time, (x, y), (vx, vy - speed), status, asked),
        *(End(time, (x, y), (vx, vy), other, asked) for other in {0, 1, 2, 3} - {status}),
    ]
    assert all(run._replace(end=end).problems() for end in ends)


def shifted(element, far=20.0):
    """The same element elsewhere."""
    fields = ("start", "end", "center", "rail_start", "rail_end")
    places = {name: getattr(element, name) for name in fields if getattr(element, name, None) is not None}
    return replace(element, **{name: (x + far, y) for name, (x, y) in places.items()})


def other_scenes(run):
    """Scenes in which the ball would not do what it does in the run's, and what they differ in."""
    scene = run.scene
    for k in sorted(set(run.ledger["element"].tolist())):
        element = scene.elements[k]
        others = {"elsewhere": shifted(element)}
        if getattr(element, "b", 0.0) > 0.0 and not isinstance(element, Paddle):  # not every paddle is struck
            others["b"] = replace(element, b=element.b * (1.0 - 1e-6))
        for what, other in others.items():
            elements = (*scene.elements[:k], other, *scene.elements[k + 1 :])
            yield f"elements[{k}] {what}", replace(scene, elements=elements)
    if any(scene.gravity):
        yield "gravity", replace(scene, gravity=tuple(1.000001 * g for g in scene.gravity))


@pytest.mark.parametrize("name", ["pegs", "gravity box", "slide", "chain", "hollow", "passages"])
def test_a_lawful_run_of_another_scene_is_noticed(name):
    """Each of its flights and bounces is right, but for a wall that it passes through, a sensor it is silent of."""
    run = RUNS[name]()
    for what, scene in other_scenes(run):
        start, ledger, end = played(scene, *run.start, run.end.asked, run.commands)
        assert run._replace(start=start, ledger=ledger, end=end).problems(), what


def test_the_runs_have_rows_of_every_kind():
    assert {int(kind) for make in RUNS.values() for kind in make().ledger["kind"]} == {0, 1, 2, 3, 4}


# ---- what the engine does is accepted


def flights_of(run):
    """Return a run up to where a curve first holds the ball, and whether that is less than all of it."""
    ledger, end = before_a_slide_on_a_curve(run.scene, run.ledger, run.end)
    commands = tuple(c for c in run.commands if c[0] < end.time)
    return run._replace(ledger=ledger, end=end, commands=commands), len(ledger) < len(run.ledger)


@pytest.mark.parametrize("name", builtin_scenes())
def test_builtin_scenes_are_played_right(name):
    scene = load_scene(name)
    x0, y0, x1, y1 = scene.bounds
    y1 += y1 == y0  # above a floor alone
    rng = np.random.default_rng(1)
    tried = 0
    while tried < soak_count(2, 200):
        place = (float(rng.uniform(x0, x1)), float(rng.uniform(y0, y1)))
        speed, angle = rng.uniform(0, 3), rng.uniform(0, 2 * math.pi)
        try:
            run = play(scene, place, (float(speed * math.cos(angle)), float(speed * math.sin(angle))), 10.0)
        except ValueError:  # the ball would overlap an element
            continue
        run, cut = flights_of(run)
        assert run.problems() == []
        assert not cut or name in ("bowl", "loop", "pinball", "zeno_drop")  # off the floor round its end
        tried += 1


@pytest.mark.parametrize("gravity", [False, True])
@pytest.mark.parametrize("radius", [0.0, 0.02])
@pytest.mark.parametrize("more", [{}, {"paddle": True, "kick": True}])
def test_random_tables_are_played_right(gravity, radius, more):
    for seed in range(soak_count(5, 1000)):
        assert play_table(seed, 4.0, gravity=gravity, radius=radius, **more).problems() == [], seed


def test_random_standing_scenes_are_played_right():
    cut = 0
    for seed in range(soak_count(150, 20_000)):
        script = standing(seed)
        run, is_cut = flights_of(play(script.scene, script.position, script.velocity, 4.0, script.commands))
        cut += is_cut
        assert run.problems() == [], seed
    assert cut <= 0.2 * soak_count(150, 20_000)
