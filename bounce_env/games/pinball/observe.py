"""What a player of pinball sees: see the card of `bounce_env.PinballEnv`."""

from bounce_env.engine.compile.jit import function, where
from bounce_env.engine.memory.records import Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.readout import ball_now, stroke_now
from bounce_env.games.episode import GameState
from bounce_env.games.pinball.points import FARMED, HIGHEST_MULTIPLIER
from bounce_env.games.pinball.setup import (
    HOLD_FRAMES,
    LEFT,
    NUDGE_FRAMES,
    REST_FRAMES,
    RIGHT,
    SAVE_FRAMES,
    STUCK_FRAMES,
    TILT,
    Layout,
    Rules,
    hold_timer,
    rest_left,
    save_left,
)
from bounce_env.games.playfield import place_seen

REFERENCE_SPEED = 1.0  # m/s; the speed that is observed as 1


@function
def observe(rules: Rules, game: GameState, w: int, out: Array) -> None:
    """What the card of `bounce_env.PinballEnv` says, in its order."""
    state, layout = game.state, rules.layout
    memory, episode, world = game.memory[w], game.episodes[w], state.worlds[w]
    scene = world.scene
    table = layout.tables[scene]
    x, y, vx, vy = ball_now(state, w, 0)
    out[w, 0], out[w, 1] = place_seen(table, x, y)
    out[w, 2], out[w, 3] = vx * (1.0 / REFERENCE_SPEED), vy * (1.0 / REFERENCE_SPEED)
    i = observe_flippers(state, layout, w, out, 4)
    out[w, i] = (rules.balls - episode.ball) / rules.balls
    out[w, i + 1] = save_left(memory, episode.frames) / SAVE_FRAMES
    out[w, i + 2] = hold_timer(memory, episode.frames) / HOLD_FRAMES
    out[w, i + 3] = memory.multiplier / HIGHEST_MULTIPLIER
    out[w, i + 4] = min(memory.farmed, FARMED) / FARMED
    out[w, i + 5] = (episode.frames - memory.scored) / STUCK_FRAMES
    out[w, i + 6] = rest_left(memory, episode.frames, LEFT) / REST_FRAMES
    out[w, i + 7] = rest_left(memory, episode.frames, RIGHT) / REST_FRAMES
    i += 8
    for lamp in range(table.targets):
        out[w, i + lamp] = (memory.lit >> lamp) & 1
    i += table.targets
    for lamp in range(table.rollovers):
        out[w, i + lamp] = (memory.passed >> lamp) & 1
    i += table.rollovers
    for j in range(layout.bumpers.shape[1]):
        out[w, i + j] = cooldown_left(state, w, layout.bumpers[scene, j]) * layout.cooldowns[scene, j]
    i += layout.bumpers.shape[1]
    if rules.nudge:
        out[w, i] = 1.0 if memory.tilted else memory.tilt / TILT
        out[w, i + 1] = max(NUDGE_FRAMES - (episode.frames - memory.nudged), 0) / NUDGE_FRAMES
        i += 2
    if rules.pace.repeat > 0.0:
        code = int(game.held[w, 0])
        for bit in range(4 if rules.nudge else 2):
            out[w, i + bit] = (code >> bit) & 1


@function
def observe_flippers(state: State, layout: Layout, w: int, out: Array, i: int) -> int:
    """Write how far each flipper is up, 0 to 1, from `out[w, i]` on; return where the next number goes."""
    for m in range(layout.sides.shape[1]):
        if layout.sides[state.worlds[w].scene, m]:
            out[w, i] = min(max(stroke_now(state, w, m), 0.0), 1.0)
            i += 1
    return i


@where("cooling", otherwise=0.0)
def cooldown_left(state: State, w: int, element: int) -> float:
    """Seconds until a bumper kicks again."""
    if element < 0:
        return 0.0
    cool, world = state.cooling[w, element], state.worlds[w]
    return max(since(cool.hi, cool.lo, world.time_hi, world.time_lo), 0.0)
