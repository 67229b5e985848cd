"""What an agent sees of the game of walls."""

from bounce_env.engine.compile.jit import function
from bounce_env.engine.memory.records import Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.readout import ball_now, core_now
from bounce_env.games.actions import clipped
from bounce_env.games.episode import GameState
from bounce_env.games.playfield import place_seen
from bounce_env.games.walls.serve import target_of
from bounce_env.games.walls.setup import BALL_FRAMES, OBSERVATION_SIZE, REFERENCE_SPEED, Rules


@function
def observe(rules: Rules, game: GameState, w: int, out: Array) -> None:
    """Ball, the wall's ends, target, time and balls that are left: see the card of `bounce_env.WallsEnv`."""
    state, episode = game.state, game.episodes[w]
    court = rules.courts[state.worlds[w].scene]
    x, y, vx, vy = ball_now(state, w, 0)
    x0, y0, x1, y1 = wall_now(state, w, court.part)
    tx, ty, _ = target_of(state, w, court.ring)
    out[w, 0], out[w, 1] = place_seen(court, x, y)
    out[w, 2], out[w, 3] = vx * (1.0 / REFERENCE_SPEED), vy * (1.0 / REFERENCE_SPEED)
    out[w, 4], out[w, 5] = place_seen(court, x0, y0)
    out[w, 6], out[w, 7] = place_seen(court, x1, y1)
    out[w, 8], out[w, 9] = place_seen(court, tx, ty)
    out[w, 10] = max(BALL_FRAMES - (episode.frames - game.memory[w].born), 0) / BALL_FRAMES
    out[w, 11] = (rules.balls - episode.ball) / rules.balls
    for j in range(out.shape[1] - OBSERVATION_SIZE):
        out[w, OBSERVATION_SIZE + j] = clipped(game.held[w, j])


@function
def wall_now(state: State, w: int, part: int) -> tuple[float, float, float, float]:
    """Return where the ends of the player's wall are now: x, y, x, y [m]."""
    return core_now(state, w, part)
