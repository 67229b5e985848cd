"""The rules of the paddle game: keep the ball in play, send it into the bumpers."""

import math
from typing import Any, NamedTuple

import numpy as np

from bounce_env.engine.command import command, command_unwatched
from bounce_env.engine.disturb import place
from bounce_env.engine.jit import Table, borrow, function
from bounce_env.engine.layout import OUT, Array, State, Tables, record
from bounce_env.engine.loop import DONE, clear_hits, is_calm, restart, resume, run
from bounce_env.engine.pack import direction
from bounce_env.engine.parts import offset_at
from bounce_env.engine.trig import sin_cos
from bounce_env.engine.view import ball_now
from bounce_env.games.actions import Continuous, Discrete
from bounce_env.games.episode import (
    DRAINED,
    FPS,
    MAX_EVENTS,
    OUT_OF_BUDGET,
    RUNNING,
    TIME_LIMIT,
    Worlds,
    begin_episode,
    hold_action,
    open_books,
)
from bounce_env.games.game import Game, frame_limit
from bounce_env.games.options import PaddleOptions
from bounce_env.games.rules import is_game
from bounce_env.games.streams import LAUNCHES, uniform
from bounce_env.scene import Arc, Bumper, Paddle, Scene, Sensor, Wall

# The launch: place as shares of the field, so that it fits the scenes of users, too.
LAUNCH_X = (0.2, 0.8)
LAUNCH_Y = 0.4
LAUNCH_SPEED = 1.5  # m/s
LAUNCH_ANGLE = (math.radians(30.0), math.radians(150.0))

REFERENCE_SPEED = 2.0  # m/s; the speed that is observed as 1
POINTS = 1.0  # a bumper hit

OBSERVATION_SIZE = 5

FIELD = record(
    x="f8", width="f8", y="f8", height="f8",  # [m] lower left corner and size of what is observed as [-1, 1]
    x_scale="f8", y_scale="f8", rail_scale="f8",  # [1/m] from metres to the observation
    paddle="i8", part="i8",  # its element, and which of the parts it is
)  # fmt: skip


# What is counted, in the order of `PaddleGame.counters`.
BUMPER_POINTS, TOUCHES = 0, 1


class Rules(NamedTuple):
    """What the kernel needs to know of the game beside the scene."""

    fields: Array  # (scenes,) FIELD
    points: Array  # (scenes, elements) float64: for a hit of each element
    fps: float
    frame_skip: int
    limit: float  # frames after which an episode is truncated; inf for never
    repeat: float  # probability per frame that the last action is repeated
    max_events: int


@function
def borrow_rules(rules: Rules) -> Rules:
    """The same rules, borrowed; see `engine.jit.borrow`."""
    return Rules(
        borrow(rules.fields),
        borrow(rules.points),
        rules.fps,
        rules.frame_skip,
        rules.limit,
        rules.repeat,
        rules.max_events,
    )


def field_of(scene: Scene) -> tuple[float, float, float, float]:
    """Lower left corner and size (x, y, width, height) [m] of the field: walls to the sides and above, drain below.

    Raises ValueError where the scene cannot be played: it must have exactly one paddle, a drain, a bumper, a ball with
    a radius and a `max_speed`.
    """
    walls = [e for e in scene.elements if isinstance(e, Wall | Arc)]
    drains = [e for e in scene.elements if isinstance(e, Sensor) and e.drain]
    paddles = sum(isinstance(e, Paddle) for e in scene.elements)
    needs = {
        f"paddles = {paddles}: must be exactly 1": paddles == 1,
        "drains = 0: must be at least 1 (a sensor with drain = true)": drains,
        "bumpers = 0: must be at least 1": any(isinstance(e, Bumper) for e in scene.elements),
        "walls = 0: must be at least 1": any(isinstance(e, Wall) for e in walls),
        "ball.radius = 0.0: must be > 0": scene.ball.radius > 0.0,
        "max_speed = None: must be given": scene.max_speed is not None,
    }
    problems = [words for words, met in needs.items() if not met]
    if problems:
        raise ValueError("a scene for the paddle game: " + "; ".join(problems))
    left, right = min(w.bounds[0] for w in walls), max(w.bounds[2] for w in walls)
    below, above = min(d.bounds[1] for d in drains), max(w.bounds[3] for w in walls)
    return left, below, right - left, above - below


def new_rules(scenes: tuple[Scene, ...], options: PaddleOptions) -> Rules:
    """The rules for a batch whose worlds play `scenes`; see `field_of` for what a scene must have."""
    fields = np.zeros(len(scenes), FIELD)
    points = np.zeros((len(scenes), max(len(s.elements) for s in scenes)))
    for s, scene in enumerate(scenes):
        x, y, width, height = field_of(scene)
        paddle = next(i for i, e in enumerate(scene.elements) if isinstance(e, Paddle))
        rail = scene.elements[paddle]
        assert isinstance(rail, Paddle)
        span = direction(rail.rail_start, rail.rail_end)[2]
        part = [i for i, _ in scene.parts].index(paddle)
        fields[s] = (x, width, y, height, 2.0 / width, 2.0 / height, 2.0 / span, paddle, part)
        points[s, : len(scene.elements)] = [POINTS * isinstance(e, Bumper) for e in scene.elements]
    repeat = options.repeat_action_probability
    return Rules(fields, points, float(FPS), options.frame_skip, frame_limit(options), repeat, MAX_EVENTS)


def speed_bound(scene: Scene) -> float:
    """The fastest [m/s] that a ball is seen: the cap acts at bounces, and it may fall through the field after one."""
    _, _, width, height = field_of(scene)
    gx, gy = scene.gravity
    assert scene.max_speed is not None
    fastest = max(scene.max_speed, LAUNCH_SPEED)
    return math.sqrt(fastest**2 + 2.0 * (abs(gx) * width + abs(gy) * height))


@function
def observe(rules: Rules, worlds: Worlds, w: int, out: Array) -> None:
    """Ball's place and velocity and the paddle's place, each scaled so that usual values spread over [-1, 1]."""
    state = worlds.state
    field = rules.fields[state.worlds[w].scene]
    x, y, vx, vy = ball_now(state, worlds.tables, w, 0)
    out[w, 0] = (x - field.x) * field.x_scale - 1.0
    out[w, 1] = (y - field.y) * field.y_scale - 1.0
    out[w, 2] = vx * (1.0 / REFERENCE_SPEED)
    out[w, 3] = vy * (1.0 / REFERENCE_SPEED)
    # The product may exceed the ends of the range by its rounding.
    out[w, 4] = min(max(paddle_offset(state, state.motions, field.part, w) * field.rail_scale - 1.0, -1.0), 1.0)
    if out.shape[1] > OBSERVATION_SIZE:
        out[w, OBSERVATION_SIZE] = clipped(worlds.held[w, 0])


@function
def clipped(action: float) -> float:
    """The action as a share of the paddle's greatest speed."""
    return min(max(action, -1.0), 1.0)


@function
def paddle_offset(state: State, motions: Table, m: int, w: int) -> float:
    """Where the paddle is on its rail now [m]."""
    if motions is None:
        return 0.0
    return offset_at(motions[w, m], state.worlds[w].time_hi, state.worlds[w].time_lo)


@function
def launch(rules: Rules, worlds: Worlds, seed: Any, w: int) -> None:
    """Put the ball into flight: as `worlds.start` says, where that is NaN as the episode's seed does."""
    field, start = rules.fields[worlds.state.worlds[w].scene], worlds.start
    x = field.x + (LAUNCH_X[0] + (LAUNCH_X[1] - LAUNCH_X[0]) * uniform(seed, LAUNCHES, 0)) * field.width
    y = field.y + LAUNCH_Y * field.height
    angle = LAUNCH_ANGLE[0] + (LAUNCH_ANGLE[1] - LAUNCH_ANGLE[0]) * uniform(seed, LAUNCHES, 1)
    s, c = sin_cos(angle)
    vx, vy = LAUNCH_SPEED * c, LAUNCH_SPEED * s
    if not math.isnan(start[w, 0]):
        x, y = start[w, 0], start[w, 1]
    if not math.isnan(start[w, 2]):
        vx, vy = start[w, 2], start[w, 3]
    place(worlds.state, worlds.tables, w, 0, x, y, vx, vy)


@function
def begin(rules: Rules, worlds: Worlds, w: int) -> None:
    """Begin the next episode of world `w`."""
    episode = begin_episode(worlds, w)
    restart(worlds.state, worlds.tables, w)
    launch(rules, worlds, episode.seed, w)


@function
def play(rules: Rules, worlds: Worlds, actions: Array, w: int) -> float:
    """One step of world `w`: the paddle moves at its action times its greatest speed. Returns the reward."""
    state, tables, episode = worlds.state, worlds.tables, worlds.episodes[w]
    clear_hits(state, w)
    resume(state, w)
    part = rules.fields[state.worlds[w].scene].part
    frames = 1 if rules.repeat > 0.0 else rules.frame_skip
    code = DONE
    last = episode.frames + rules.frame_skip
    while episode.frames < last:
        hold_action(worlds, actions, w, rules.repeat)
        move(state, tables, state.motions, tables.parts, part, w, clipped(worlds.held[w, 0]))
        episode.frames += frames
        # From the count of frames, not by adding up: the same instant whatever the frame skip.
        code = run(state, tables, w, episode.frames / rules.fps, 0.0, rules.max_events, None)
        if code != DONE or state.balls[w, 0].status == OUT:
            break
    reward = count_points(rules, worlds, w)
    if state.balls[w, 0].status == OUT:
        episode.end = DRAINED
    elif code != DONE:
        episode.end = OUT_OF_BUDGET
    elif episode.frames >= rules.limit:
        episode.end = TIME_LIMIT
    episode.score += reward
    return reward


@function
def glide(rules: Rules, worlds: Worlds, actions: Array, w: int) -> bool:
    """The step of a world in which nothing happens; False, and nothing done that `play` would not do, where it may.

    The rewards and ends of `results` are expected to say already that nothing happened.

    Most steps are such. What it does is what `play` does, without the code for what does not happen: a small loop over
    these and another one over the rest run several times faster than one loop over both.
    """
    state, tables, results = worlds.state, worlds.tables, worlds.results
    episode, world = worlds.episodes[w], state.worlds[w]
    frames = episode.frames + rules.frame_skip
    if episode.end != RUNNING or frames >= rules.limit:
        return False
    until = frames / rules.fps
    action = clipped(actions[w, 0])
    if rules.repeat > 0.0 or not steer(state, tables, tables.parts, rules.fields[world.scene].part, w, action):
        return False
    if not is_calm(state.balls, state.pairs, state.motions, tables.parts, w, world.scene, until, 0.0):
        return False
    clear_hits(state, w)
    # An episode that ended in the last step has been followed by a new one, of which this is the first step.
    if episode.frames == 0:
        open_books(results, w)
    worlds.held[w, 0], episode.frames = action, frames
    world.time_hi, world.time_lo = until, 0.0
    observe(rules, worlds, w, results.observations)
    return True


@function
def steer(state: State, tables: Tables, parts: Table, m: int, w: int, action: float) -> bool:
    """As `move`, where no ball is near the paddle; otherwise it does nothing and returns False."""
    if parts is None:
        return True
    world = state.worlds[w]
    velocity = action * parts[world.scene, m].up_speed
    return command_unwatched(world, state.motions, parts, state.zones, tables.drags, w, m, velocity)


@function
def move(state: State, tables: Tables, motions: Any, parts: Any, m: int, w: int, action: float) -> None:
    """Let the paddle move at `action` (-1 to 1) times its greatest speed."""
    if motions is None or parts is None:
        return
    command(state, tables, motions, parts, w, m, action * parts[state.worlds[w].scene, m].up_speed)


@function
def count_points(rules: Rules, worlds: Worlds, w: int) -> float:
    """Points for what was struck in this step."""
    state, reward = worlds.state, 0.0
    if not state.worlds[w].dirty:
        return reward
    scene = state.worlds[w].scene
    for element in range(state.hits.shape[1]):
        reward += rules.points[scene, element] * state.hits[w, element]
    worlds.counters[w, BUMPER_POINTS] += reward
    worlds.counters[w, TOUCHES] += state.hits[w, rules.fields[scene].paddle]
    return reward


is_game(Rules, begin=begin, play=play, glide=glide, observe=observe, borrow_rules=borrow_rules)


class PaddleGame(Game):
    """The paddle game for a batch: scene, tables and rules, and what an agent sees and does.

    Raises ValueError where the scene cannot be played (`field_of`), SceneError where it cannot be read.
    """

    counters = ("points_bumpers", "touches")

    def __init__(self, options: PaddleOptions) -> None:
        super().__init__(options)
        self.rules = new_rules(self.scenes, options)
        x, y, width, height = field_of(self.scenes[0])
        self.field = (x, y, x + width, y + height)
        self.actions = Discrete((-1.0, 0.0, 1.0)) if options.action == "discrete" else Continuous(1)
        speed = speed_bound(self.scenes[0]) / REFERENCE_SPEED
        bounds = [1.0, 1.0, speed, speed, 1.0]
        if options.repeat_action_probability > 0.0:
            bounds.append(1.0)
        self.observation_high = np.array(bounds, np.float32)
        self.observation_low = -self.observation_high
