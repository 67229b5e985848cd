"""The rules of the paddle game: keep the ball in play, send it into the bumpers."""

import math
from collections.abc import Callable
from os import PathLike
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np
from pydantic import ConfigDict, Field, InstanceOf, StrictInt
from pydantic.dataclasses import dataclass

from bounce_env.engine.command import command, command_unwatched
from bounce_env.engine.disturb import place
from bounce_env.engine.jit import Table, borrow, function, kernel
from bounce_env.engine.layout import OUT, Array, State, Tables, borrow_state, borrow_tables, record
from bounce_env.engine.loop import DONE, clear_hits, is_calm, restart, resume, run
from bounce_env.engine.pack import direction, pack
from bounce_env.engine.parts import offset_at
from bounce_env.engine.trig import sin_cos
from bounce_env.engine.view import ball_now
from bounce_env.games.episode import (
    DRAINED,
    FPS,
    MAX_EVENTS,
    NEXT_STEP,
    OUT_OF_BUDGET,
    RUNNING,
    SAME_STEP,
    TIME_LIMIT,
    Results,
    all_finite,
    begin_episode,
    borrow_results,
    close_books,
    open_books,
)
from bounce_env.games.streams import LAUNCHES, STICKY_ACTIONS, uniform
from bounce_env.scene import Bumper, Paddle, Scene, Sensor, Wall, load_scene

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
    paddle="i8",  # its element
)  # fmt: skip


@dataclass(frozen=True, kw_only=True, config=ConfigDict(arbitrary_types_allowed=True))
class PaddleOptions:
    """What a user may choose; see the card of `bounce_env.env.PaddleEnv`. Raises ValueError for what is not allowed."""

    scene: str | PathLike[str] | InstanceOf[Scene] = "paddle"
    action: Literal["continuous", "discrete"] = "continuous"
    frame_skip: Annotated[StrictInt, Field(ge=1, le=FPS)] = 2
    repeat_action_probability: Annotated[float, Field(strict=True, ge=0.0, lt=1.0)] = 0.0
    time_limit: Annotated[float, Field(strict=True, gt=0.0, allow_inf_nan=False)] | None = 60.0


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
    walls = [e for e in scene.elements if isinstance(e, Wall)]
    drains = [e for e in scene.elements if isinstance(e, Sensor) and e.drain]
    paddles = sum(isinstance(e, Paddle) for e in scene.elements)
    needs = {
        f"paddles = {paddles}: must be exactly 1": paddles == 1,
        "drains = 0: must be at least 1 (a sensor with drain = true)": drains,
        "bumpers = 0: must be at least 1": any(isinstance(e, Bumper) for e in scene.elements),
        "walls = 0: must be at least 1": walls,
        "ball.radius = 0.0: must be > 0": scene.ball.radius > 0.0,
        "max_speed = None: must be given": scene.max_speed is not None,
    }
    problems = [words for words, met in needs.items() if not met]
    if problems:
        raise ValueError("a scene for the paddle game: " + "; ".join(problems))
    left, right = min(w.bounds[0] for w in walls), max(w.bounds[2] for w in walls)
    below, above = min(d.bounds[1] for d in drains), max(w.bounds[3] for w in walls)
    return left, below, right - left, above - below


def new_rules(scenes: tuple[Scene, ...], options: "PaddleOptions") -> Rules:
    """The rules for a batch whose worlds play `scenes`; see `field_of` for what a scene must have."""
    fields = np.zeros(len(scenes), FIELD)
    points = np.zeros((len(scenes), max(len(s.elements) for s in scenes)))
    for s, scene in enumerate(scenes):
        x, y, width, height = field_of(scene)
        paddle = next(i for i, e in enumerate(scene.elements) if isinstance(e, Paddle))
        rail = scene.elements[paddle]
        assert isinstance(rail, Paddle)
        span = direction(rail.rail_start, rail.rail_end)[2]
        fields[s] = (x, width, y, height, 2.0 / width, 2.0 / height, 2.0 / span, paddle)
        points[s, : len(scene.elements)] = [POINTS * isinstance(e, Bumper) for e in scene.elements]
    limit = math.inf if options.time_limit is None else float(round(options.time_limit * FPS))
    repeat = options.repeat_action_probability
    return Rules(fields, points, float(FPS), options.frame_skip, limit, repeat, MAX_EVENTS)


def speed_bound(scene: Scene) -> float:
    """The fastest [m/s] that a ball is seen: the cap acts at bounces, and it may fall through the field after one."""
    _, _, width, height = field_of(scene)
    gx, gy = scene.gravity
    assert scene.max_speed is not None
    fastest = max(scene.max_speed, LAUNCH_SPEED)
    return math.sqrt(fastest**2 + 2.0 * (abs(gx) * width + abs(gy) * height))


@function
def observe(state: State, tables: Tables, rules: Rules, episodes: Array, w: int, out: Array) -> None:
    """Ball's place and velocity and the paddle's place, each scaled so that usual values spread over [-1, 1]."""
    scene = state.worlds[w].scene
    field = rules.fields[scene]
    x, y, vx, vy = ball_now(state, tables, w, 0)
    out[w, 0] = (x - field.x) * field.x_scale - 1.0
    out[w, 1] = (y - field.y) * field.y_scale - 1.0
    out[w, 2] = vx * (1.0 / REFERENCE_SPEED)
    out[w, 3] = vy * (1.0 / REFERENCE_SPEED)
    # The product may exceed the ends of the range by its rounding.
    out[w, 4] = min(max(paddle_offset(state, state.motions, w) * field.rail_scale - 1.0, -1.0), 1.0)
    if out.shape[1] > OBSERVATION_SIZE:
        out[w, OBSERVATION_SIZE] = episodes[w].last_action


@function
def paddle_offset(state: State, motions: Table, w: int) -> float:
    """Where the paddle is on its rail now [m]."""
    if motions is None:
        return 0.0
    return offset_at(motions[w, 0], state.worlds[w].time_hi, state.worlds[w].time_lo)


@function
def launch(state: State, tables: Tables, rules: Rules, seed: Any, w: int, start: Array) -> None:
    """Put the ball into flight: as `start` (x, y, vx, vy) says, where that is not NaN as the episode's seed does."""
    field = rules.fields[state.worlds[w].scene]
    x = field.x + (LAUNCH_X[0] + (LAUNCH_X[1] - LAUNCH_X[0]) * uniform(seed, LAUNCHES, 0)) * field.width
    y = field.y + LAUNCH_Y * field.height
    angle = LAUNCH_ANGLE[0] + (LAUNCH_ANGLE[1] - LAUNCH_ANGLE[0]) * uniform(seed, LAUNCHES, 1)
    s, c = sin_cos(angle)
    vx, vy = LAUNCH_SPEED * c, LAUNCH_SPEED * s
    if not math.isnan(start[w, 0]):
        x, y = start[w, 0], start[w, 1]
    if not math.isnan(start[w, 2]):
        vx, vy = start[w, 2], start[w, 3]
    place(state, tables, w, 0, x, y, vx, vy)


@function
def begin(state: State, tables: Tables, rules: Rules, episodes: Array, w: int, start: Array) -> None:
    """Begin the next episode of world `w`."""
    begin_episode(episodes[w])
    restart(state, tables, w)
    launch(state, tables, rules, episodes[w].seed, w, start)


@function
def play(state: State, tables: Tables, rules: Rules, episodes: Array, w: int, action: float) -> float:
    """One step of world `w`: the paddle moves at `action` times its greatest speed. Returns the reward."""
    episode = episodes[w]
    clear_hits(state, w)
    resume(state, w)
    frames = 1 if rules.repeat > 0.0 else rules.frame_skip
    code = DONE
    last = episode.frames + rules.frame_skip
    while episode.frames < last:
        if rules.repeat == 0.0 or uniform(episode.seed, STICKY_ACTIONS, episode.frames) >= rules.repeat:
            episode.last_action = action
        move(state, tables, state.motions, tables.parts, w, episode.last_action)
        episode.frames += frames
        # From the count of frames, not by adding up: the same instant whatever the frame skip.
        code = run(state, tables, w, episode.frames / rules.fps, 0.0, rules.max_events, None)
        if code != DONE or state.balls[w, 0].status == OUT:
            break
    reward = count_points(state, rules, episode, w)
    if state.balls[w, 0].status == OUT:
        episode.end = DRAINED
    elif code != DONE:
        episode.end = OUT_OF_BUDGET
    elif episode.frames >= rules.limit:
        episode.end = TIME_LIMIT
    episode.score += reward
    return reward


@function
def glide(state: State, tables: Tables, rules: Rules, episodes: Array, w: int, action: float, results: Results) -> bool:
    """The step of a world in which nothing happens; False, and nothing done that `play` would not do, where it may.

    The rewards and ends of `results` are expected to say already that nothing happened.

    Most steps are such. What it does is what `play` does, without the code for what does not happen: a small loop over
    these and another one over the rest run several times faster than one loop over both.
    """
    episode, world = episodes[w], state.worlds[w]
    frames = episode.frames + rules.frame_skip
    if episode.end != RUNNING or frames >= rules.limit:
        return False
    until = frames / rules.fps
    if rules.repeat > 0.0 or not steer(state, tables, tables.parts, w, action):
        return False
    if not is_calm(state.balls, state.pairs, state.motions, tables.parts, w, world.scene, until, 0.0):
        return False
    clear_hits(state, w)
    # An episode that ended in the last step has been followed by a new one, of which this is the first step.
    if episode.frames == 0:
        open_books(results, w)
    episode.last_action, episode.frames = action, frames
    world.time_hi, world.time_lo = until, 0.0
    observe(state, tables, rules, episodes, w, results.observations)
    return True


@function
def steer(state: State, tables: Tables, parts: Table, w: int, action: float) -> bool:
    """As `move`, where no ball is near the paddle; otherwise it does nothing and returns False."""
    if parts is None:
        return True
    world = state.worlds[w]
    velocity = action * parts[world.scene, 0].up_speed
    return command_unwatched(world, state.motions, parts, state.zones, tables.drags, w, 0, velocity)


@function
def move(state: State, tables: Tables, motions: Any, parts: Any, w: int, action: float) -> None:
    """Let the paddle move at `action` (-1 to 1) times its greatest speed."""
    if motions is None or parts is None:
        return
    command(state, tables, motions, parts, w, 0, action * parts[state.worlds[w].scene, 0].up_speed)


@function
def count_points(state: State, rules: Rules, episode: Any, w: int) -> float:
    """Points for what was struck in this step."""
    reward = 0.0
    if not state.worlds[w].dirty:
        return reward
    scene = state.worlds[w].scene
    for element in range(state.hits.shape[1]):
        reward += rules.points[scene, element] * state.hits[w, element]
    episode.touches += state.hits[w, rules.fields[scene].paddle]
    return reward


@kernel
def reset_worlds(handle: Any, mask: Array) -> None:
    """Begin an episode in every world that `mask` names, launched as `handle.start` says."""
    state, tables, episodes = borrow_state(handle.state), borrow_tables(handle.tables), borrow(handle.episodes)
    rules, results, start = borrow_rules(handle.rules), borrow_results(handle.results), borrow(handle.start)
    for w in range(mask.shape[0]):
        if mask[w]:
            begin(state, tables, rules, episodes, w, start)
            observe(state, tables, rules, episodes, w, results.observations)
            results.terminated[w] = False
            results.truncated[w] = False
            results.rewards[w] = 0.0


@kernel
def step_worlds(handle: Any, actions: Array, autoreset: int, first: int, last: int) -> int:
    """One step of worlds `first` to `last` - 1, with the autoreset mode's resets; returns how many episodes ended.

    actions: (worlds,) float64, clipped to [-1, 1]; where any of them is NaN or infinite nothing is done and -1
    returned. A world whose episode has ended is reset in place of a step
    (NEXT_STEP), was reset at its end (SAME_STEP), or must have been reset by the caller (DISABLED).
    """
    state, tables, episodes = borrow_state(handle.state), borrow_tables(handle.tables), borrow(handle.episodes)
    rules, results, start = borrow_rules(handle.rules), borrow_results(handle.results), borrow(handle.start)
    if not all_finite(actions):
        return -1
    results.rewards[first:last] = 0.0
    results.terminated[first:last] = False
    results.truncated[first:last] = False
    busy = first
    # Of an unsigned index Numba does not ask whether it counts from the end.
    for w in range(np.uint64(first), np.uint64(last)):
        if not glide(state, tables, rules, episodes, w, min(max(actions[w], -1.0), 1.0), results):
            results.busy[busy] = w
            busy += 1
    ended = 0
    for i in range(first, busy):
        w = results.busy[i]
        if autoreset == NEXT_STEP and episodes[w].end != RUNNING:
            begin(state, tables, rules, episodes, w, start)
            observe(state, tables, rules, episodes, w, results.observations)
            open_books(results, w)
            continue
        results.rewards[w] = play(state, tables, rules, episodes, w, min(max(actions[w], -1.0), 1.0))
        if results.ended[w].end != RUNNING:
            open_books(results, w)
        end = episodes[w].end
        results.terminated[w] = end == DRAINED
        results.truncated[w] = end not in (DRAINED, RUNNING)
        observe(state, tables, rules, episodes, w, results.observations)
        if end != RUNNING:
            ended += 1
            close_books(results, episodes[w], state.worlds[w], w)
            if autoreset == SAME_STEP:
                for j in range(results.observations.shape[1]):
                    results.final_observations[w, j] = results.observations[w, j]
                begin(state, tables, rules, episodes, w, start)
                observe(state, tables, rules, episodes, w, results.observations)
    return ended


class PaddleGame:
    """The paddle game for a batch: scene, tables and rules, and what an agent sees and does.

    Raises ValueError where the scene cannot be played (`field_of`), SceneError where it cannot be read.
    """

    reset_worlds: ClassVar[Callable[..., None]] = staticmethod(reset_worlds)
    step_worlds: ClassVar[Callable[..., int]] = staticmethod(step_worlds)

    def __init__(self, options: PaddleOptions) -> None:
        scene = options.scene if isinstance(options.scene, Scene) else load_scene(options.scene)
        self.scenes: tuple[Scene, ...] = (scene,)
        self.rules = new_rules(self.scenes, options)
        self.tables = pack(self.scenes)
        x, y, width, height = field_of(scene)
        self.field = (x, y, x + width, y + height)
        self.step_seconds = options.frame_skip / FPS
        self.discrete_actions = 3 if options.action == "discrete" else None
        speed = speed_bound(scene) / REFERENCE_SPEED
        bounds = [1.0, 1.0, speed, speed, 1.0]
        if options.repeat_action_probability > 0.0:
            bounds.append(1.0)
        self.observation_high = np.array(bounds, np.float32)

    def with_step_limit(self, steps: int | None) -> "PaddleGame":
        """The same game, truncated after `steps` steps if that comes before the time limit."""
        if steps is not None:
            limit = min(self.rules.limit, float(steps * self.rules.frame_skip))
            self.rules = self.rules._replace(limit=limit)
        return self

    @staticmethod
    def speeds(actions: Array) -> Array:
        """Speeds of the paddle, as a share of its greatest, for discrete actions: left, stay, right."""
        return actions.astype(np.float64) - 1.0
