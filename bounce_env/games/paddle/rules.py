"""The rules of the paddle game: keep the ball in play, send it into the bumpers."""

import math
from typing import Any

from bounce_env.engine.compile.jit import function
from bounce_env.engine.events.commands import command, command_unwatched, full_speed
from bounce_env.engine.events.flights import place
from bounce_env.engine.events.loop import DONE, clear_hits, is_calm, restart, resume, run
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.readout import ball_now, core_now
from bounce_env.engine.motion.sincos import sin_cos
from bounce_env.games.actions import clipped
from bounce_env.games.episode import (
    DRAINED,
    OUT_OF_BUDGET,
    RUNNING,
    TIME_LIMIT,
    GameState,
    begin_episode,
    hold_action,
    open_books,
)
from bounce_env.games.paddle.levels import NONE, drawn_level, enter_level
from bounce_env.games.paddle.observe import observe
from bounce_env.games.paddle.setup import BUMPER_POINTS, LAUNCH_ANGLE, LAUNCH_SPEED, LAUNCH_X, LAUNCH_Y, TOUCHES, Rules
from bounce_env.games.streams import LAUNCHES, uniform
from bounce_env.games.timing import out_of_time


@function
def launch(rules: Rules, game: GameState, seed: Any, w: int) -> None:
    """Put the ball into flight: as `game.start` says, where that is NaN as the episode's seed does."""
    field, start = rules.fields[game.state.worlds[w].scene], game.start
    x = field.x + (LAUNCH_X[0] + (LAUNCH_X[1] - LAUNCH_X[0]) * uniform(seed, LAUNCHES, 0)) * field.width
    y = field.y + LAUNCH_Y * field.height
    angle = LAUNCH_ANGLE[0] + (LAUNCH_ANGLE[1] - LAUNCH_ANGLE[0]) * uniform(seed, LAUNCHES, 1)
    s, c = sin_cos(angle)
    vx, vy = LAUNCH_SPEED * c, LAUNCH_SPEED * s
    if not math.isnan(start[w, 0]):
        x, y = start[w, 0], start[w, 1]
    if not math.isnan(start[w, 2]):
        vx, vy = start[w, 2], start[w, 3]
    place(game.state, w, 0, x, y, vx, vy)


@function
def begin(rules: Rules, game: GameState, w: int) -> None:
    """Begin the next episode of world `w`."""
    episode = begin_episode(game, w)
    if rules.levels.number != NONE:
        begin_level(rules, game, w)
    restart(game.state, w)
    launch(rules, game, episode.seed, w)


@function
def begin_level(rules: Rules, game: GameState, w: int) -> None:
    """Arrange the bumpers of world `w`: of the level that `game.start` says, where that is NaN of the seed's."""
    episode, asked = game.episodes[w], game.start[w, 4]
    episode.level = drawn_level(rules.levels, episode.seed) if math.isnan(asked) else int(asked)
    enter_level(rules.levels, game.state, game.state.worlds[w].scene, episode.level)


@function
def potential(rules: Rules, game: GameState, w: int) -> float:
    """-1 to 0: the less, the further the paddle's middle is along its rail from beneath the ball; 0 when it is lost."""
    if game.episodes[w].end == DRAINED:
        return 0.0
    state = game.state
    field = rules.fields[state.worlds[w].scene]
    x, y, _, _ = ball_now(state, w, 0)
    x0, y0, x1, y1 = core_now(state, w, field.part)
    away = (x - 0.5 * (x0 + x1)) * field.rail_ux + (y - 0.5 * (y0 + y1)) * field.rail_uy
    return -abs(away) / field.across


@function
def play(rules: Rules, game: GameState, actions: Array, w: int) -> float:
    """One step of world `w`: the paddle moves at its action times its greatest speed. Returns the reward."""
    if rules.shaping == 0.0:
        return _play(rules, game, actions, w)
    before = potential(rules, game, w)
    points = _play(rules, game, actions, w)
    return points + rules.gamma * potential(rules, game, w) - before


@function
def _play(rules: Rules, game: GameState, actions: Array, w: int) -> float:
    """Play the same step without shaping; return the points."""
    state, episode = game.state, game.episodes[w]
    clear_hits(state, w)
    resume(state, w)
    part = rules.fields[state.worlds[w].scene].part
    frames = 1 if rules.pace.repeat > 0.0 else rules.pace.frame_skip
    code = DONE
    last = episode.frames + rules.pace.frame_skip
    episode.steps += 1
    while episode.frames < last:
        hold_action(game, actions, w, rules.pace.repeat)
        move(state, w, part, clipped(game.held[w, 0]))
        episode.frames += frames
        # From the count of frames, not by adding up: the same instant whatever the frame skip.
        code = run(state, w, episode.frames / rules.pace.fps, 0.0, rules.pace.max_events)
        if code != DONE or state.balls[w, 0].status == OUT:
            break
    points = count_points(rules, game, w)
    if state.balls[w, 0].status == OUT:
        episode.end = DRAINED
    elif code != DONE:
        episode.end = OUT_OF_BUDGET
    elif out_of_time(episode, rules.pace):
        episode.end = TIME_LIMIT
    episode.score += points
    return points


@function
def step_quietly(rules: Rules, game: GameState, actions: Array, w: int) -> bool:
    """Play the step of a world in which nothing happens; return False, with nothing changed, where something may.

    The rewards and ends of `results` are expected to say already that nothing happened.

    Most steps are such. What it does is what `play` does, without the code for what does not happen: a small loop over
    these and another one over the rest run several times faster than one loop over both.
    """
    if rules.shaping > 0.0:
        return False
    state, results = game.state, game.results
    episode, world = game.episodes[w], state.worlds[w]
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
    game.held[w, 0], episode.frames = action, frames
    episode.steps += 1
    world.time_hi, world.time_lo = until, 0.0
    observe(rules, game, w, results.observations)
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
def count_points(rules: Rules, game: GameState, w: int) -> float:
    """Points for what was struck in this step."""
    state, reward = game.state, 0.0
    if not state.worlds[w].dirty:
        return reward
    scene = state.worlds[w].scene
    for element in range(state.hits.shape[1]):
        reward += rules.points[scene, element] * state.hits[w, element]
    game.counters[w, BUMPER_POINTS] += reward
    game.counters[w, TOUCHES] += state.hits[w, rules.fields[scene].paddle]
    return reward
