"""The rules of the game of walls: bring each ball to its target with a wall that is dragged by its ends."""

import math

from bounce_env.engine.compile.jit import function
from bounce_env.engine.events.commands import command_ends, reach_box
from bounce_env.engine.events.loop import DONE, clear_hits, resume
from bounce_env.engine.memory import records as layout
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.motion.readout import ball_now
from bounce_env.games.actions import clipped
from bounce_env.games.episode import (
    ALL_PLAYED,
    OUT_OF_BUDGET,
    RUNNING,
    TIME_LIMIT,
    GameState,
    begin_episode,
    hold_action,
)
from bounce_env.games.timing import out_of_time
from bounce_env.games.walls.observe import wall_now
from bounce_env.games.walls.serve import advance, serve, target_of
from bounce_env.games.walls.setup import (
    BALL_FRAMES,
    CRUSHED,
    DRAINED,
    SUCCESS,
    TARGETS,
    TIMED_OUT,
    TOUCHES,
    WALL_SPEED,
    Rules,
)


@function
def begin(rules: Rules, game: GameState, w: int) -> None:
    """Begin the next episode of world `w`."""
    begin_episode(game, w)
    serve(rules, game, w)
    world = game.state.worlds[w]
    world.bounces, world.speed_capped = 0, 0


@function
def potential(rules: Rules, game: GameState, w: int) -> float:
    """-1 to 0: the less, the further away the ball is from its target; 0 when the last ball has been played."""
    if game.episodes[w].end == ALL_PLAYED:
        return 0.0
    scene = game.state.worlds[w].scene
    court = rules.courts[scene]
    x, y, _, _ = ball_now(game.state, w, 0)
    tx, ty, _ = target_of(game.state, w, court.ring)
    return -math.sqrt((x - tx) * (x - tx) + (y - ty) * (y - ty)) / court.across


@function
def play(rules: Rules, game: GameState, actions: Array, w: int) -> float:
    """One step of world `w`: the wall's ends move as its action says. Returns the reward."""
    state, episode = game.state, game.episodes[w]
    before = potential(rules, game, w)
    clear_hits(state, w)
    resume(state, w)
    frames = 1 if rules.pace.repeat > 0.0 else rules.pace.frame_skip
    code = DONE
    last = episode.frames + rules.pace.frame_skip
    episode.steps += 1
    while episode.frames < last and code == DONE and state.balls[w, 0].status != layout.CRUSHED:
        hold_action(game, actions, w, rules.pace.repeat)
        drag(rules, game, w, frames / rules.pace.fps)
        episode.frames += frames
        # From the count of frames, not by adding up: the same instant whatever the frame skip.
        until = (episode.frames - game.memory[w].born) / rules.pace.fps
        code = advance(state, w, until, rules.pace.max_events)
    points = finish_ball(rules, game, w, code)
    if episode.end == RUNNING and out_of_time(episode, rules.pace):
        episode.end = TIME_LIMIT
    episode.score += points
    if rules.shaping == 0.0:
        return points
    return points + rules.gamma * potential(rules, game, w) - before


@function
def drag(rules: Rules, game: GameState, w: int, seconds: float) -> None:
    """Let the ends of the wall move as the action in force says, for so long, but not out of the box of its reach.

    Nor further apart than they may be: an end that is drawn away drags the other one along.
    """
    state, held, scene = game.state, game.held, game.state.worlds[w].scene
    court = rules.courts[scene]
    left, below, right, above = reach_box(state, w, court.part)
    x0, y0, x1, y1 = wall_now(state, w, court.part)
    vx0 = kept_inside(x0, WALL_SPEED * clipped(held[w, 0]), seconds, left, right)
    vy0 = kept_inside(y0, WALL_SPEED * clipped(held[w, 1]), seconds, below, above)
    vx1 = kept_inside(x1, WALL_SPEED * clipped(held[w, 2]), seconds, left, right)
    vy1 = kept_inside(y1, WALL_SPEED * clipped(held[w, 3]), seconds, below, above)
    # How far apart two ends in uniform motion are is a convex function of time: it is greatest at an end of the step.
    dx, dy = x1 - x0 + (vx1 - vx0) * seconds, y1 - y0 + (vy1 - vy0) * seconds
    length = math.sqrt(dx * dx + dy * dy)
    if length > court.longest:
        excess = 0.5 * (1.0 - court.longest / length) / seconds
        vx0, vy0 = vx0 + excess * dx, vy0 + excess * dy
        vx1, vy1 = vx1 - excess * dx, vy1 - excess * dy
    command_ends(state, w, court.part, (vx0, vy0), (vx1, vy1))


@function
def kept_inside(x: float, velocity: float, seconds: float, low: float, high: float) -> float:
    """Return the velocity [m/s] with which a coordinate comes no further than a border in so many seconds."""
    ahead = x + velocity * seconds
    if low <= ahead <= high:
        return velocity
    return (min(max(ahead, low), high) - x) / seconds


@function
def finish_ball(rules: Rules, game: GameState, w: int, code: int) -> float:
    """Count what the ball has come to, and launch the next one if it is over; returns the points."""
    state, episode, counters = game.state, game.episodes[w], game.counters
    court = rules.courts[state.worlds[w].scene]
    counters[w, TOUCHES] += state.hits[w, court.wall]
    status, points = state.balls[w, 0].status, 0.0
    if status == OUT and state.hits[w, court.target] > 0:
        points = 1.0
        counters[w, TARGETS] += 1
        counters[w, SUCCESS] = 1.0 if 2.0 * counters[w, TARGETS] > rules.balls else 0.0
    elif status == OUT:
        counters[w, DRAINED] += 1
    elif status == layout.CRUSHED:
        counters[w, CRUSHED] += 1
    elif code != DONE:
        episode.end = OUT_OF_BUDGET
        return points
    elif episode.frames - game.memory[w].born >= BALL_FRAMES:
        counters[w, TIMED_OUT] += 1
    else:
        return points
    if episode.ball + 1 < rules.balls:
        episode.ball += 1
        serve(rules, game, w)
    else:
        episode.end = ALL_PLAYED
    return points
