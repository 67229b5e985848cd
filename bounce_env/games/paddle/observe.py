"""What an agent sees of the paddle game."""

from bounce_env.engine.compile.jit import function
from bounce_env.engine.memory.records import Array
from bounce_env.engine.motion.readout import ball_now, offset_now
from bounce_env.games.actions import clipped
from bounce_env.games.episode import GameState
from bounce_env.games.paddle.levels import observe_bumpers
from bounce_env.games.paddle.setup import OBSERVATION_SIZE, REFERENCE_SPEED, Rules
from bounce_env.games.playfield import place_seen


@function
def observe(rules: Rules, game: GameState, w: int, out: Array) -> None:
    """Ball, paddle and bumpers, each number scaled so that usual values spread over [-1, 1]."""
    state = game.state
    field = rules.fields[state.worlds[w].scene]
    x, y, vx, vy = ball_now(state, w, 0)
    out[w, 0], out[w, 1] = place_seen(field, x, y)
    out[w, 2] = vx * (1.0 / REFERENCE_SPEED)
    out[w, 3] = vy * (1.0 / REFERENCE_SPEED)
    # The product may exceed the ends of the range by its rounding.
    out[w, 4] = min(max(offset_now(state, w, field.part) * field.rail_scale - 1.0, -1.0), 1.0)
    observe_bumpers(rules.levels, state, field, w, out, OBSERVATION_SIZE)
    if rules.pace.repeat > 0.0:
        out[w, out.shape[1] - 1] = clipped(game.held[w, 0])
