"""What is fixed before a ball of pinball is shot: options, the table's elements, the rules' constants and memory."""

import math
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic.dataclasses import dataclass

from bounce_env.engine.compile.jit import function
from bounce_env.engine.memory.records import Array, record
from bounce_env.games.episode import FPS
from bounce_env.games.options import CONFIG, Balls, Flag, Options, TimeLimit, options_class
from bounce_env.games.timing import Pace
from bounce_env.scene import Element, Field, Flipper, Scene, Sensor, Wall
from bounce_env.scene.fields import one_of


@options_class
@dataclass(frozen=True, kw_only=True, config=CONFIG)
class PinballOptions(Options):
    """What a user may choose of the pinball game."""

    action: Annotated[Literal["discrete", "buttons"], one_of("discrete", "buttons")] = "discrete"
    reward: Annotated[Literal["dense", "score"], one_of("dense", "score")] = "dense"
    nudge: Flag = False
    balls: Balls = 3
    time_limit: TimeLimit = 120.0


# What an element is to the game.
NOTHING, BUMPER, SLINGSHOT, TARGET, ROLLOVER, FLIPPER, IN_PLAY = 0, 1, 2, 3, 4, 5, 6

WORDS = {
    "bumper": BUMPER,
    "slingshot": SLINGSHOT,
    "target": TARGET,
    "rollover": ROLLOVER,
    "flipper_left": FLIPPER,
    "flipper_right": FLIPPER,
    "in_play": IN_PLAY,
}

MOST_LAMPS = 62
"""Targets, and rollovers, of one table at most: each is a bit of one number."""

TABLE = record(
    x="f8", y="f8", x_scale="f8", y_scale="f8",  # [m, 1/m] from metres to what is observed as [-1, 1]
    plunger_x="f8", plunger_y="f8", up_x="f8", up_y="f8",  # [m] where a ball is shot from; unit vector, against gravity
    zone_left="f8", zone_right="f8", zone_top="f8",  # [m] where a flipper may hold the ball's centre
    targets="i8", rollovers="i8",  # how many there are
)  # fmt: skip


class Layout(NamedTuple):
    """The tables of a batch; first axis scenes."""

    tables: Array  # (scenes,) TABLE
    roles: Array  # (scenes, elements) int64
    lamps: Array  # (scenes, elements) int64: which target or rollover it is, from 0 on; otherwise -1
    sides: Array  # (scenes, parts) int64: the button that moves a part, 1 left or 2 right; 0 for none
    bumpers: Array  # (scenes, bumpers) int64: their elements, -1 where a scene has fewer
    cooldowns: Array  # (scenes, bumpers) float64: [1/s] from what is left of a cooldown to what is observed


HIDDEN = ("in_play", "plunger", "brace")
"""What the names begin with of elements that players do not see: sensors of the lane, and what fills a slingshot."""


def hidden_of(scene: Scene) -> tuple[int, ...]:
    """Return the elements, by index, that pictures do not show."""

    def is_hidden(name: str) -> bool:
        return any(name == word or name.startswith(f"{word}_") for word in HIDDEN)

    return tuple(i for i, e in enumerate(scene.elements) if is_hidden(e.name))


def word_of(name: str) -> str:
    """Return the word that a name begins with, or "" if it is none that the game knows."""
    return next((word for word in (*WORDS, "plunger") if name == word or name.startswith(f"{word}_")), "")


def role_of(element: Element) -> int:
    """Return what an element is to the game."""
    return WORDS.get(word_of(element.name), NOTHING)


def problems_of(scene: Scene) -> list[str]:
    """Return why a scene cannot be played as pinball; empty if it can."""
    named = [(word_of(e.name), e) for e in scene.elements]
    plungers = [e for word, e in named if word == "plunger"]
    kinds = {
        "flipper_left": Flipper,
        "flipper_right": Flipper,
        "rollover": Sensor,
        "in_play": Sensor,
        "plunger": Sensor,
    }
    needs = {
        "flippers = 0: must be at least 1 (named flipper_left or flipper_right)": any(
            word.startswith("flipper") for word, _ in named
        ),
        f'"plunger": must name exactly 1 sensor, not {len(plungers)}': len(plungers) == 1,
        '"in_play": must name a sensor': any(word == "in_play" for word, _ in named),
        "drains = 0: must be at least 1 (a sensor with drain = true)": any(
            isinstance(e, Sensor) and e.drain for e in scene.elements
        ),
        "walls = 0: must be at least 1": any(isinstance(e, Wall) for e in scene.elements),
        f"ball.radius = {scene.ball.radius!r}: must be > 0": scene.ball.radius > 0.0,
        "max_speed = None: must be given": scene.max_speed is not None,
        f"gravity = {scene.gravity!r}: must not be zero": scene.gravity != (0.0, 0.0),
    }
    problems = [words for words, met in needs.items() if not met]
    for word, element in named:
        if word in kinds and not isinstance(element, kinds[word]):
            problems.append(f"{element.name!r}: must be a {kinds[word].__name__}, as its name begins with {word!r}")
        elif WORDS.get(word) in (BUMPER, SLINGSHOT, TARGET) and isinstance(element, Sensor | Field):
            problems.append(f"{element.name!r}: must bounce the ball, as its name begins with {word!r}")
        if word == "plunger" and isinstance(element, Sensor) and element.circle is None:
            problems.append(f"{element.name!r}: must be a circle; a ball is shot from its centre")
    for word in ("target", "rollover"):
        count = sum(known == word for known, _ in named)
        if count > MOST_LAMPS:
            problems.append(f"{word}s = {count}: must be at most {MOST_LAMPS}")
    return problems


def layout_of(scenes: tuple[Scene, ...]) -> Layout:
    """What the kernels need to know; raises ValueError, with all that is wrong, where a scene cannot be played."""
    for scene in scenes:
        problems = problems_of(scene)
        if problems:
            raise ValueError("a scene for the pinball game: " + "; ".join(problems))
    elements = max(len(scene.elements) for scene in scenes)
    bumpers = max(sum(role_of(e) == BUMPER for e in scene.elements) for scene in scenes)
    layout = Layout(
        np.zeros(len(scenes), TABLE),
        np.zeros((len(scenes), elements), np.int64),
        np.full((len(scenes), elements), -1),
        np.zeros((len(scenes), max(len(scene.parts) for scene in scenes)), np.int64),
        np.full((len(scenes), bumpers), -1),
        np.zeros((len(scenes), bumpers)),
    )
    for s, scene in enumerate(scenes):
        _fill(layout, s, scene)
    return layout


def _fill(layout: Layout, s: int, scene: Scene) -> None:
    roles = [role_of(e) for e in scene.elements]
    layout.roles[s, : len(roles)] = roles
    for role in (TARGET, ROLLOVER):
        lamps = [i for i, known in enumerate(roles) if known == role]
        layout.lamps[s, lamps] = range(len(lamps))
    for m, (_, part) in enumerate(scene.parts):
        layout.sides[s, m] = {"flipper_left": 1, "flipper_right": 2}.get(word_of(part.name), 0)
    for j, i in enumerate(i for i, role in enumerate(roles) if role == BUMPER):
        element = scene.elements[i]
        assert not isinstance(element, Sensor | Field)
        layout.bumpers[s, j] = i
        layout.cooldowns[s, j] = 1.0 / element.cooldown if element.cooldown > 0.0 else 0.0
    plunger = next(e for e in scene.elements if word_of(e.name) == "plunger")
    assert isinstance(plunger, Sensor)
    assert plunger.circle is not None
    (px, py), _ = plunger.circle
    left, below, right, above = outline(scene)
    zone = zone_of(scene)
    gx, gy = scene.gravity
    pull = math.sqrt(gx * gx + gy * gy)
    layout.tables[s] = (
        left, below, 2.0 / (right - left), 2.0 / (above - below), px, py, -gx / pull, -gy / pull, *zone,
        roles.count(TARGET), roles.count(ROLLOVER),
    )  # fmt: skip


def outline(scene: Scene) -> tuple[float, float, float, float]:
    """x_min, y_min, x_max, y_max [m] of what bounces the ball: where its centre may be."""
    boxes = [e.bounds for e in scene.elements if not isinstance(e, Sensor | Field)]
    x0, y0, x1, y1 = zip(*boxes, strict=True)
    return min(x0), min(y0), max(x1), max(y1)


def zone_of(scene: Scene) -> tuple[float, float, float]:
    """Left, right and top [m] of where a flipper may hold the ball's centre: what it sweeps, and a diameter more."""
    boxes = [e.bounds for e in scene.elements if isinstance(e, Flipper)]
    diameter = 2.0 * scene.ball.radius
    left, right = min(box[0] for box in boxes) - diameter, max(box[2] for box in boxes) + diameter
    return left, right, max(box[3] for box in boxes) + diameter


LAUNCH_FRAMES = 3 * FPS  # after which a ball counts as in play wherever it is
SAVE_FRAMES = 5 * FPS  # a ball that is lost so soon is given back, once
HOLD_FRAMES = 2 * FPS  # in the flippers' zone, after which both are released until the ball leaves it
REST_FRAMES = 18  # after a button is let go: until then it does not act again
STUCK_FRAMES = 10 * FPS  # without a hit of a flipper, or one that gives points: the ball is shot again

# Buttons, as bits of the action's code.
LEFT, RIGHT, NUDGE_LEFT, NUDGE_RIGHT = 1, 2, 4, 8
NUDGE = (0.25, 0.15)  # m/s to the side and up
NUDGE_FRAMES = FPS // 4  # after which the next one may follow
NUDGE_COST = 1.0  # of the tilt meter, which shows 3 at a tilt
TILT, TILT_PER_FRAME = 3.0, 0.5 / FPS

# What is counted, in the order of `PinballGame.counters`.
BY_BUMPERS, BY_SLINGSHOTS, BY_TARGETS, BY_ROLLOVERS = 0, 1, 2, 3
BANKS, TOUCHES, FLIPS, SAVES, STUCK_FREED, HOLD_RELEASED, NUDGES, TILTS = 4, 5, 6, 7, 8, 9, 10, 11

MEMORY = record(
    lit="i8", passed="i8",  # bits: targets that are lit, rollovers that are not any more
    multiplier="i8",
    farmed="i8",  # hits of bumpers and slingshots since a flipper touched the ball
    launches="i8",  # of the ball that is played
    saved="i8",  # whether this ball has been given back
    serving="i8",  # whether it is on its way out of the lane, or about to be
    shot="i8", born="i8",  # frames in which it was shot and came into play
    zone="i8",  # frame in which it came into the flippers' zone; -1 outside
    scored="i8",  # frame of the last hit that gave points, or of a flipper
    pressed="i8",  # buttons in force
    left_ready="i8", right_ready="i8",  # frames from which the buttons act again
    tilt="f8", tilted="i8",  # the tilt meter, and whether the flippers are dead for this ball
    nudged="i8",  # frame of the last nudge
)  # fmt: skip

# `serving`: the ball is played, is to be shot, is in the lane.
NO, DUE, SHOT = 0, 1, 2


class Rules(NamedTuple):
    """What the kernel needs to know of the game beside the scene."""

    layout: Layout
    pace: Pace
    balls: int
    nudge: int  # 1 where the table can be nudged
    loss: float  # reward for a ball that is lost, 0 or less


@function
def save_left(memory: Any, frame: int) -> int:
    """Frames for which a ball that is lost is given back."""
    return 0 if memory.saved else max(SAVE_FRAMES - (frame - memory.born), 0)


@function
def rest_left(memory: Any, frame: int, side: int) -> int:
    """Frames until the button LEFT or RIGHT acts again."""
    ready = memory.left_ready if side == LEFT else memory.right_ready
    return max(ready - frame, 0)


@function
def hold_timer(memory: Any, frame: int) -> int:
    """Frames that the ball has been in the flippers' zone, at most those after which they are released."""
    return 0 if memory.zone < 0 else min(frame - memory.zone, HOLD_FRAMES)
