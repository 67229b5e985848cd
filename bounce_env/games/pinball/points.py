"""What hits are worth in pinball: points, lamps, the multiplier."""

from bounce_env.engine.compile.jit import function
from bounce_env.games.episode import GameState
from bounce_env.games.pinball.setup import (
    BANKS,
    BUMPER,
    BY_BUMPERS,
    BY_ROLLOVERS,
    BY_SLINGSHOTS,
    BY_TARGETS,
    FLIPPER,
    IN_PLAY,
    NOTHING,
    SLINGSHOT,
    TARGET,
    TOUCHES,
    Rules,
)

# Points, times the multiplier, which grows by 1 whenever the bank is hit, on the same ball.
POINTS_BUMPER, POINTS_SLINGSHOT, POINTS_TARGET, POINTS_BANK = 50.0, 10.0, 250.0, 1000.0
POINTS_ROLLOVER, POINTS_LANES = 100.0, 500.0
HIGHEST_MULTIPLIER = 5
FARMED = 20  # hits of bumpers and slingshots that count without a touch of a flipper in between

# What `state.hits` holds of an element whose hits have been counted: it stays lit for the rest of the step.
COUNTED = 1 << 32


@function
def count_points(rules: Rules, game: GameState, w: int) -> float:
    """Points for what was hit in this frame, in the order of the elements; lamps and counters change with it."""
    state, memory, episode = game.state, game.memory[w], game.episodes[w]
    points = 0.0
    if not state.worlds[w].dirty:
        return points
    if memory.tilted:
        memory.scored = episode.frames
        return points
    scene = state.worlds[w].scene
    for element in range(state.hits.shape[1]):
        role, hits = rules.layout.roles[scene, element], state.hits[w, element] % COUNTED
        if hits == 0 or role in (NOTHING, IN_PLAY):
            continue
        state.hits[w, element] = COUNTED
        before = points
        if role == FLIPPER:
            memory.farmed = 0
            game.counters[w, TOUCHES] += hits
        elif role in (BUMPER, SLINGSHOT):
            points += score_kicks(game, w, role, hits)
        else:
            points += score_lamp(rules, game, w, scene, role, rules.layout.lamps[scene, element])
        # A ball that goes to and fro between two bumpers for nothing is as stuck as one that lies still.
        if role == FLIPPER or points > before:
            memory.scored = episode.frames
    return points


@function
def score_kicks(game: GameState, w: int, role: int, hits: int) -> float:
    """Points for hits of a bumper or slingshot, as long as a flipper has touched the ball in between."""
    memory = game.memory[w]
    counted = min(hits, max(FARMED - memory.farmed, 0))
    memory.farmed += hits
    each = POINTS_BUMPER if role == BUMPER else POINTS_SLINGSHOT
    points = each * memory.multiplier * counted
    game.counters[w, BY_BUMPERS if role == BUMPER else BY_SLINGSHOTS] += points
    return points


@function
def score_lamp(rules: Rules, game: GameState, w: int, scene: int, role: int, lamp: int) -> float:
    """Points for a target that is lit, or a rollover that was not passed yet; more for the last one of them."""
    memory, table = game.memory[w], rules.layout.tables[scene]
    bit = 1 << lamp
    if role == TARGET:
        if not memory.lit & bit:
            return 0.0
        memory.lit &= ~bit
        points = POINTS_TARGET * memory.multiplier
        if memory.lit == 0:
            points += POINTS_BANK * memory.multiplier
            memory.lit = (1 << table.targets) - 1
            memory.multiplier = min(memory.multiplier + 1, HIGHEST_MULTIPLIER)
            game.counters[w, BANKS] += 1
        game.counters[w, BY_TARGETS] += points
        return points
    if memory.passed & bit:
        return 0.0
    memory.passed |= bit
    points = POINTS_ROLLOVER * memory.multiplier
    if memory.passed == (1 << table.rollovers) - 1:
        points += POINTS_LANES * memory.multiplier
        memory.passed = 0
    game.counters[w, BY_ROLLOVERS] += points
    return points
