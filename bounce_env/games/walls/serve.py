"""How the game of walls begins each ball: where it is launched, and where its target is."""

import math

from bounce_env.engine.compile.jit import function, routine, where
from bounce_env.engine.events.flights import place
from bounce_env.engine.events.loop import restart, resume, run
from bounce_env.engine.memory.state import State
from bounce_env.games.episode import GameState
from bounce_env.games.streams import LAUNCHES, TARGETS, uniform
from bounce_env.games.walls.setup import BALL_FRAMES, LAUNCH_SPEED, LAUNCH_X, LAUNCH_Y, TARGET_CLEAR, TRIES, Rules


@routine
def serve(rules: Rules, game: GameState, w: int) -> None:
    """Launch the next ball, the wall as it was at first, with its target where the ball does not get by itself.

    Whether it does is tried out: the ball is played to its end with the wall at rest.
    """
    state, episode = game.state, game.episodes[w]
    world = state.worlds[w]
    bounces, speed_capped = world.bounces, world.speed_capped
    for attempt in range(TRIES):
        x, y = launch(rules, game, w)
        if draw_target(rules, game, w, attempt, x, y):
            launch(rules, game, w)  # now its flight is planned with the target in its place
            resume(state, w)
            advance(state, w, BALL_FRAMES / rules.pace.fps, rules.pace.max_events)
            if state.hits[w, rules.courts[world.scene].target] == 0:
                break
    launch(rules, game, w)
    game.memory[w].born = episode.frames
    world.bounces, world.speed_capped = bounces, speed_capped


@routine
def advance(state: State, w: int, until: float, max_events: int) -> int:
    """Process the events of world `w` up to an instant [s] since its launch; see `engine.events.loop.run`."""
    return run(state, w, until, 0.0, max_events)


@function
def launch(rules: Rules, game: GameState, w: int) -> tuple[float, float]:
    """Begin anew with the ball in flight: as its seed says or, the first one, `game.start`; returns where [m]."""
    state, start, episode = game.state, game.start, game.episodes[w]
    restart(state, w)
    court = rules.courts[state.worlds[w].scene]
    number = 16 * episode.ball
    share = LAUNCH_X[0] + (LAUNCH_X[1] - LAUNCH_X[0]) * uniform(episode.seed, LAUNCHES, number)
    x, y = court.x + share * court.width, court.y + LAUNCH_Y * court.height
    vx, vy = LAUNCH_SPEED * (2.0 * uniform(episode.seed, LAUNCHES, number + 1) - 1.0), 0.0
    # Of later balls of the episode `start` says nothing: it is for one call of a reset only.
    if not math.isnan(start[w, 0]):
        x, y = start[w, 0], start[w, 1]
    if not math.isnan(start[w, 2]):
        vx, vy = start[w, 2], start[w, 3]
    place(state, w, 0, x, y, vx, vy)
    return x, y


@function
def draw_target(rules: Rules, game: GameState, w: int, attempt: int, x: float, y: float) -> bool:
    """Put the target anywhere on the field; False if that is too near to (x, y) [m], where the ball is launched."""
    state, episode, scene = game.state, game.episodes[w], game.state.worlds[w].scene
    court = rules.courts[scene]
    radius = target_of(state, w, court.ring)[2]
    number = 256 * episode.ball + 2 * attempt
    tx = court.x + radius + (court.width - 2.0 * radius) * uniform(episode.seed, TARGETS, number)
    ty = court.y + radius + (court.height - 2.0 * radius) * uniform(episode.seed, TARGETS, number + 1)
    move_target(state, w, court.ring, tx, ty)
    clear = TARGET_CLEAR * court.across
    return (tx - x) * (tx - x) + (ty - y) * (ty - y) > clear * clear


@where("circle_sensors", otherwise=(0.0, 0.0, 0.0))
def target_of(state: State, w: int, ring: int) -> tuple[float, float, float]:
    """Centre and radius of the target: x, y, radius [m]."""
    target = state.circle_sensors[state.worlds[w].scene, ring]
    return target.x, target.y, target.radius


@where("circle_sensors")
def move_target(state: State, w: int, ring: int, x: float, y: float) -> None:
    """Put the target somewhere else; a ball is to be placed after this."""
    target = state.circle_sensors[state.worlds[w].scene, ring]
    target.x, target.y = x, y
