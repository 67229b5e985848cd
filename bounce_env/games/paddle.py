"""The rules of the paddle game: keep the ball in play, send it into the bumpers."""

import math
from functools import partial
from typing import Any

import numpy as np

from bounce_env.engine.compile.jit import function
from bounce_env.engine.events.commands import command, command_unwatched, full_speed
from bounce_env.engine.events.flights import place
from bounce_env.engine.events.loop import DONE, clear_hits, is_calm, restart, resume, run
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.readout import ball_now, core_now, offset_now
from bounce_env.engine.motion.sincos import sin_cos
from bounce_env.games.actions import Continuous, Discrete, clipped
from bounce_env.games.episode import (
    DRAINED,
    OUT_OF_BUDGET,
    RUNNING,
    TIME_LIMIT,
    Worlds,
    begin_episode,
    hold_action,
    open_books,
)
from bounce_env.games.field import place_seen, speed_bound
from bounce_env.games.game import Game
from bounce_env.games.levels import (
    NONE,
    bumper_bounds,
    drawn_level,
    enter_level,
    level_scene,
    observe_bumpers,
)
from bounce_env.games.options import PaddleOptions
from bounce_env.games.pace import out_of_time
from bounce_env.games.paddle_rules import (
    BUMPER_POINTS,
    LAUNCH_ANGLE,
    LAUNCH_SPEED,
    LAUNCH_X,
    LAUNCH_Y,
    OBSERVATION_SIZE,
    REFERENCE_SPEED,
    TOUCHES,
    Rules,
    field_of,
    new_rules,
)
from bounce_env.games.rules import is_game
from bounce_env.games.streams import LAUNCHES, uniform
from bounce_env.scene import Scene


@function
def observe(rules: Rules, worlds: Worlds, w: int, out: Array) -> None:
    """Ball, paddle and bumpers, each number scaled so that usual values spread over [-1, 1]."""
    state = worlds.state
    field = rules.fields[state.worlds[w].scene]
    x, y, vx, vy = ball_now(state, w, 0)
    out[w, 0], out[w, 1] = place_seen(field, x, y)
    out[w, 2] = vx * (1.0 / REFERENCE_SPEED)
    out[w, 3] = vy * (1.0 / REFERENCE_SPEED)
    # The product may exceed the ends of the range by its rounding.
    out[w, 4] = min(max(offset_now(state, w, field.part) * field.rail_scale - 1.0, -1.0), 1.0)
    observe_bumpers(rules.levels, state, field, w, out, OBSERVATION_SIZE)
    if rules.pace.repeat > 0.0:
        out[w, out.shape[1] - 1] = clipped(worlds.held[w, 0])


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
    place(worlds.state, w, 0, x, y, vx, vy)


@function
def begin(rules: Rules, worlds: Worlds, w: int) -> None:
    """Begin the next episode of world `w`."""
    episode = begin_episode(worlds, w)
    if rules.levels.number != NONE:
        begin_level(rules, worlds, w)
    restart(worlds.state, w)
    launch(rules, worlds, episode.seed, w)


@function
def begin_level(rules: Rules, worlds: Worlds, w: int) -> None:
    """Arrange the bumpers of world `w`: of the level that `worlds.start` says, where that is NaN of the seed's."""
    episode, asked = worlds.episodes[w], worlds.start[w, 4]
    episode.level = drawn_level(rules.levels, episode.seed) if math.isnan(asked) else int(asked)
    enter_level(rules.levels, worlds.state, worlds.state.worlds[w].scene, episode.level)


@function
def potential(rules: Rules, worlds: Worlds, w: int) -> float:
    """-1 to 0: the less, the further the paddle's middle is along its rail from beneath the ball; 0 when it is lost."""
    if worlds.episodes[w].end == DRAINED:
        return 0.0
    state = worlds.state
    field = rules.fields[state.worlds[w].scene]
    x, y, _, _ = ball_now(state, w, 0)
    x0, y0, x1, y1 = core_now(state, w, field.part)
    away = (x - 0.5 * (x0 + x1)) * field.rail_ux + (y - 0.5 * (y0 + y1)) * field.rail_uy
    return -abs(away) / field.across


@function
def play(rules: Rules, worlds: Worlds, actions: Array, w: int) -> float:
    """One step of world `w`: the paddle moves at its action times its greatest speed. Returns the reward."""
    if rules.shaping == 0.0:
        return _play(rules, worlds, actions, w)
    before = potential(rules, worlds, w)
    points = _play(rules, worlds, actions, w)
    return points + rules.gamma * potential(rules, worlds, w) - before


@function
def _play(rules: Rules, worlds: Worlds, actions: Array, w: int) -> float:
    """The same, without shaping: returns the points."""
    state, episode = worlds.state, worlds.episodes[w]
    clear_hits(state, w)
    resume(state, w)
    part = rules.fields[state.worlds[w].scene].part
    frames = 1 if rules.pace.repeat > 0.0 else rules.pace.frame_skip
    code = DONE
    last = episode.frames + rules.pace.frame_skip
    episode.steps += 1
    while episode.frames < last:
        hold_action(worlds, actions, w, rules.pace.repeat)
        move(state, w, part, clipped(worlds.held[w, 0]))
        episode.frames += frames
        # From the count of frames, not by adding up: the same instant whatever the frame skip.
        code = run(state, w, episode.frames / rules.pace.fps, 0.0, rules.pace.max_events, None)
        if code != DONE or state.balls[w, 0].status == OUT:
            break
    points = count_points(rules, worlds, w)
    if state.balls[w, 0].status == OUT:
        episode.end = DRAINED
    elif code != DONE:
        episode.end = OUT_OF_BUDGET
    elif out_of_time(episode, rules.pace):
        episode.end = TIME_LIMIT
    episode.score += points
    return points


@function
def glide(rules: Rules, worlds: Worlds, actions: Array, w: int) -> bool:
    """The step of a world in which nothing happens; False, and nothing done that `play` would not do, where it may.

    The rewards and ends of `results` are expected to say already that nothing happened.

    Most steps are such. What it does is what `play` does, without the code for what does not happen: a small loop over
    these and another one over the rest run several times faster than one loop over both.
    """
    if rules.shaping > 0.0:
        return False
    state, results = worlds.state, worlds.results
    episode, world = worlds.episodes[w], state.worlds[w]
    frames = episode.frames + rules.pace.frame_skip
    if episode.end != RUNNING or frames >= rules.pace.limit or episode.steps + 1 >= rules.pace.steps:
        return False
    until = frames / rules.pace.fps
    action = clipped(actions[w, 0])
    if rules.pace.repeat > 0.0 or not steer(state, w, rules.fields[world.scene].part, action):
        return False
    if not is_calm(state, w, until, 0.0):
        return False
    clear_hits(state, w)
    # An episode that ended in the last step has been followed by a new one, of which this is the first step.
    if episode.frames == 0:
        open_books(results, w)
    worlds.held[w, 0], episode.frames = action, frames
    episode.steps += 1
    world.time_hi, world.time_lo = until, 0.0
    observe(rules, worlds, w, results.observations)
    return True


@function
def steer(state: State, w: int, m: int, action: float) -> bool:
    """As `move`, where no ball is near the paddle; otherwise it does nothing and returns False."""
    return command_unwatched(state, w, m, action * full_speed(state, w, m))


@function
def move(state: State, w: int, m: int, action: float) -> None:
    """Let the paddle move at `action` (-1 to 1) times its greatest speed."""
    command(state, w, m, action * full_speed(state, w, m))


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


is_game(Rules, begin=begin, play=play, glide=glide, observe=observe)


class PaddleGame(Game):
    """The paddle game for a batch: scene and rules, and what an agent sees and does.

    Raises ValueError where the scene cannot be played (`field_of`), SceneError where it cannot be read.
    """

    counted = "bumper hits"
    counters = ("points_bumpers", "touches")

    def __init__(self, options: PaddleOptions) -> None:
        self.has_levels = self.owns_scenes = options.num_levels is not None
        super().__init__(options)
        self.rules = new_rules(self.scenes[0], options)
        x, y, width, height = field_of(self.scenes[0])
        self.field = (x, y, x + width, y + height)
        self.actions = Discrete((-1.0, 0.0, 1.0)) if options.action == "discrete" else Continuous(1)
        scene = self.scenes[0]
        assert scene.max_speed is not None
        speed = speed_bound(max(scene.max_speed, LAUNCH_SPEED), scene.gravity, width, height) / REFERENCE_SPEED
        bounds = [1.0, 1.0, speed, speed, 1.0, *bumper_bounds(self.rules.levels)]
        if options.repeat_action_probability > 0.0:
            bounds.append(1.0)
        self.observation_high = np.array(bounds, np.float32)
        self.observation_low = -self.observation_high

    @property
    def default_scene(self) -> str:
        """With levels that with a bumper on a rail."""
        return "paddle_levels" if self.has_levels else "paddle"

    def rules_for(self, worlds: int) -> Rules:
        """With levels each world has a field of its own, for its own bumpers."""
        if not self.has_levels:
            return self.rules
        rules, rows = self.rules, partial(np.repeat, repeats=worlds, axis=0)
        levels = rules.levels._replace(bumpers=rows(rules.levels.bumpers))
        return rules._replace(fields=rows(rules.fields), points=rows(rules.points), levels=levels)

    def written(self, state: State, rules: Rules) -> tuple[Array, ...]:
        """Where the bumpers of a level are."""
        if not self.has_levels:
            return ()
        return tuple(a for a in (rules.levels.bumpers, state.circles, state.parts) if a is not None)

    def scene_on(self, level: int | None) -> Scene:
        """The scene with its bumpers where they are on the level."""
        return self.scenes[0] if level is None else level_scene(self.scenes[0], self.rules.levels, level)
