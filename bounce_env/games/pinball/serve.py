"""How a ball gets into play in pinball: out of the plunger, and through its lane."""

import math
from typing import Any

from bounce_env.engine.compile.jit import function
from bounce_env.engine.events.flights import place
from bounce_env.engine.events.loop import clear_hits
from bounce_env.engine.memory.records import OUT
from bounce_env.engine.memory.state import State
from bounce_env.games.episode import GameState
from bounce_env.games.pinball.setup import IN_PLAY, LAUNCH_FRAMES, NO, NUDGE_FRAMES, SHOT, Layout, Rules
from bounce_env.games.streams import LAUNCHES, uniform

LAUNCH_SPEED = (1.45, 2.4)  # m/s


@function
def new_ball(memory: Any) -> None:
    """What begins anew with each ball: lamps stay as they are."""
    memory.multiplier, memory.farmed, memory.launches, memory.saved = 1, 0, 0, 0
    memory.tilt, memory.tilted, memory.nudged = 0.0, 0, -NUDGE_FRAMES


@function
def shoot(rules: Rules, game: GameState, w: int) -> None:
    """Put the ball into the lane with the speed that its seed says, or into the game as `game.start` says."""
    episode, memory, start = game.episodes[w], game.memory[w], game.start
    table = rules.layout.tables[game.state.worlds[w].scene]
    share = uniform(episode.seed, LAUNCHES, 16 * episode.ball + min(memory.launches, 15))
    speed = LAUNCH_SPEED[0] + (LAUNCH_SPEED[1] - LAUNCH_SPEED[0]) * share
    x, y, vx, vy = table.plunger_x, table.plunger_y, speed * table.up_x, speed * table.up_y
    memory.serving = SHOT
    if not math.isnan(start[w, 0]):
        x, y, vx, vy = start[w, 0], start[w, 1], 0.0, 0.0
        memory.serving = NO
    if not math.isnan(start[w, 2]):
        vx, vy = start[w, 2], start[w, 3]
    memory.launches += 1
    memory.shot, memory.born, memory.scored, memory.zone = episode.frames, episode.frames, episode.frames, -1
    clear_hits(game.state, w)
    place(game.state, w, 0, x, y, vx, vy)


@function
def leave_lane(rules: Rules, game: GameState, w: int) -> None:
    """Let the ball count as played once it has left the lane, or if it takes too long to do so."""
    state, episode, memory = game.state, game.episodes[w], game.memory[w]
    late = episode.frames - memory.shot >= LAUNCH_FRAMES or state.balls[w, 0].status == OUT
    if late or crossed(state, rules.layout, w, state.worlds[w].scene):
        memory.serving = NO
        memory.born, memory.scored, memory.zone = episode.frames, episode.frames, -1


@function
def crossed(state: State, layout: Layout, w: int, scene: int) -> bool:
    """Return whether the ball has come into play in this frame."""
    for element in range(state.hits.shape[1]):
        if layout.roles[scene, element] == IN_PLAY and state.hits[w, element] > 0:
            return True
    return False
