"""The rules of the pinball game: points, lamps, balls, and what keeps a player from doing nothing for points."""

from bounce_env.engine.compile.jit import function
from bounce_env.engine.events.commands import (
    command_flipper,
    goes_on_quietly,
    obey_quietly,
    obeys_quietly,
    pressed_velocity,
)
from bounce_env.engine.events.flights import disturb
from bounce_env.engine.events.loop import DONE, balls_are_calm, clear_hits, restart, resume, run
from bounce_env.engine.memory.ledger import is_recorded
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.motion.instant import since
from bounce_env.engine.motion.path import motion_after
from bounce_env.engine.motion.readout import ball_now
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
from bounce_env.games.pinball.observe import observe
from bounce_env.games.pinball.points import count_points
from bounce_env.games.pinball.serve import leave_lane, new_ball, shoot
from bounce_env.games.pinball.setup import (
    DUE,
    FLIPS,
    HOLD_FRAMES,
    HOLD_RELEASED,
    LEFT,
    NUDGE,
    NUDGE_COST,
    NUDGE_FRAMES,
    NUDGE_LEFT,
    NUDGE_RIGHT,
    NUDGES,
    REST_FRAMES,
    RIGHT,
    SAVES,
    STUCK_FRAMES,
    STUCK_FREED,
    TILT,
    TILT_PER_FRAME,
    TILTS,
    Rules,
    hold_timer,
    rest_left,
    save_left,
)
from bounce_env.games.timing import out_of_time

REWARD_PER_POINT = 1e-3


@function
def begin(rules: Rules, game: GameState, w: int) -> None:
    """Begin the next episode of world `w`."""
    begin_episode(game, w)
    memory = game.memory[w]
    restart(game.state, w)
    memory.passed, memory.pressed = 0, 0
    memory.left_ready, memory.right_ready = 0, 0
    table = rules.layout.tables[game.state.worlds[w].scene]
    memory.lit = (1 << table.targets) - 1
    new_ball(memory)
    shoot(rules, game, w)


@function
def press(rules: Rules, game: GameState, w: int, buttons: int) -> None:
    """Let each flipper go up or down as its button says."""
    scene = game.state.worlds[w].scene
    for m in range(rules.layout.sides.shape[1]):
        side = rules.layout.sides[scene, m]
        if side:
            command_flipper(game.state, w, m, buttons & side != 0)
    note_pressed(game, w, buttons)


@function
def note_pressed(game: GameState, w: int, buttons: int) -> None:
    """Count what is pressed, and note when what is let go acts again."""
    memory = game.memory[w]
    pressed_now, let_go = buttons & ~memory.pressed, memory.pressed & ~buttons
    game.counters[w, FLIPS] += (pressed_now & 1) + (pressed_now >> 1)
    ready = game.episodes[w].frames + REST_FRAMES
    if let_go & LEFT:
        memory.left_ready = ready
    if let_go & RIGHT:
        memory.right_ready = ready
    memory.pressed = buttons


@function
def in_force(rules: Rules, game: GameState, w: int, code: int) -> int:
    """Return the flippers' buttons in force: none while the ball has been held for too long, or the table is tilted.

    A nudge acts at once.
    """
    memory, frames = game.memory[w], game.episodes[w].frames
    if rules.nudge and code & (NUDGE_LEFT | NUDGE_RIGHT):
        nudge(game, w, code)
    if memory.tilted or hold_timer(memory, frames) >= HOLD_FRAMES:
        return 0
    buttons = 0
    for side in (LEFT, RIGHT):
        if code & side and (memory.pressed & side or rest_left(memory, frames, side) == 0):
            buttons |= side
    return buttons


@function
def play(rules: Rules, game: GameState, actions: Array, w: int) -> float:
    """One step of world `w`, frame by frame; returns the reward.

    The frames in which a ball is on its way out of the lane are none of the step's: no action matters in them.
    """
    state, episode, memory = game.state, game.episodes[w], game.memory[w]
    reward = 0.0
    frames = rules.pace.frame_skip
    episode.steps += 1
    clear_hits(state, w)
    while (frames > 0 or memory.serving) and episode.end == RUNNING:
        buttons = 0
        if memory.serving == DUE:
            shoot(rules, game, w)
        if not memory.serving:
            frames -= 1
            hold_action(game, actions, w, rules.pace.repeat)
            buttons = in_force(rules, game, w, int(game.held[w, 0]))
        press(rules, game, w, buttons)
        resume(state, w)
        episode.frames += 1
        # From the count of frames, not by adding up: the same instant whatever the frame skip.
        code = run(state, w, episode.frames / rules.pace.fps, 0.0, rules.pace.max_events)
        if code != DONE:
            episode.end = OUT_OF_BUDGET
        elif memory.serving:
            leave_lane(rules, game, w)
        else:
            points = count_points(rules, game, w)
            episode.score += points
            reward += REWARD_PER_POINT * points
            if state.balls[w, 0].status == OUT:
                reward += lose_ball(rules, game, w)
            else:
                update_timers(rules, game, w)
        if episode.end == RUNNING and episode.frames >= rules.pace.limit:
            episode.end = TIME_LIMIT
    if episode.end == RUNNING and out_of_time(episode, rules.pace):
        episode.end = TIME_LIMIT
    return reward


@function
def lose_ball(rules: Rules, game: GameState, w: int) -> float:
    """Return what follows when the ball has drained: it is given back, the next one follows, or the episode ends."""
    episode, memory = game.episodes[w], game.memory[w]
    if save_left(memory, episode.frames) > 0 and not memory.tilted:
        memory.saved = 1
        game.counters[w, SAVES] += 1
        memory.serving = DUE
        return 0.0
    if episode.ball + 1 < rules.balls:
        episode.ball += 1
        new_ball(memory)
        memory.serving = DUE
    else:
        episode.end = DRAINED
    return rules.loss


@function
def update_timers(rules: Rules, game: GameState, w: int) -> None:
    """What happens by the clock: the flippers' zone, a ball that is stuck, the tilt meter."""
    episode, memory = game.episodes[w], game.memory[w]
    if not in_zone(rules, game, w):
        memory.zone = -1
    elif memory.zone < 0:
        memory.zone = episode.frames
    elif episode.frames - memory.zone == HOLD_FRAMES:
        game.counters[w, HOLD_RELEASED] += 1
    memory.tilt = max(memory.tilt - TILT_PER_FRAME, 0.0)
    if episode.frames - memory.scored >= STUCK_FRAMES:
        game.counters[w, STUCK_FREED] += 1
        memory.serving = DUE


@function
def in_zone(rules: Rules, game: GameState, w: int) -> bool:
    """Return whether the ball's centre is where a flipper may hold it."""
    table = rules.layout.tables[game.state.worlds[w].scene]
    x, y, _, _ = ball_now(game.state, w, 0)
    return table.zone_left <= x <= table.zone_right and y <= table.zone_top


@function
def nudge(game: GameState, w: int, buttons: int) -> None:
    """Shove the table, if the last time is long enough ago; too often, and it tilts."""
    memory, episode = game.memory[w], game.episodes[w]
    if memory.tilted or episode.frames - memory.nudged < NUDGE_FRAMES:
        return
    memory.nudged = episode.frames
    game.counters[w, NUDGES] += 1
    memory.tilt += NUDGE_COST
    if memory.tilt >= TILT:
        memory.tilted = 1
        game.counters[w, TILTS] += 1
    side = (1 if buttons & NUDGE_RIGHT else 0) - (1 if buttons & NUDGE_LEFT else 0)
    disturb(game.state, w, 0, 1.0, NUDGE[0] * side, NUDGE[1])


@function
def step_quietly(rules: Rules, game: GameState, actions: Array, w: int) -> bool:
    """Play the step of a world in which no ball has an event, none is near a flipper, and the clock changes nothing.

    False, and nothing done, where something may. The rewards and ends of `results` are expected to say so already.
    """
    state, episode, memory = game.state, game.episodes[w], game.memory[w]
    frames = episode.frames + rules.pace.frame_skip
    if episode.end != RUNNING or frames >= rules.pace.limit or rules.pace.repeat > 0.0:
        return False
    if episode.steps + 1 >= rules.pace.steps or memory.serving or memory.tilt > 0.0 or memory.tilted:
        return False
    if memory.zone >= 0 or frames - memory.scored >= STUCK_FRAMES or is_recorded(state, w):
        return False
    until = frames / rules.pace.fps
    buttons = buttons_in_step(rules, game, w, int(actions[w, 0]))
    if buttons < 0 or not balls_are_calm(state, w, until, 0.0) or not keeps_high(rules, game, w, until):
        return False
    if not press_quietly(rules, game, w, buttons, until):
        return False
    clear_hits(state, w)
    # An episode that ended in the last step has been followed by a new one, of which this is the first step.
    if game.results.ended[w].end != RUNNING:
        open_books(game.results, w)
    game.held[w, 0], episode.frames = actions[w, 0], frames
    episode.steps += 1
    observe(rules, game, w, game.results.observations)
    return True


@function
def buttons_in_step(rules: Rules, game: GameState, w: int, code: int) -> int:
    """Return the flippers' buttons in force in every frame of a step; -1 where they change in it, or with a nudge."""
    memory, frames, buttons = game.memory[w], game.episodes[w].frames, 0
    if rules.nudge and code & (NUDGE_LEFT | NUDGE_RIGHT):
        return -1
    for side in (LEFT, RIGHT):
        if code & side:
            rest = rest_left(memory, frames, side)
            if memory.pressed & side or rest == 0:
                buttons |= side
            elif rest < rules.pace.frame_skip:
                return -1
    return buttons


@function
def press_quietly(rules: Rules, game: GameState, w: int, buttons: int, until: float) -> bool:
    """Press buttons, and let all parts move up to an instant; return False, with nothing done, where a ball is near."""
    state, world, sides = game.state, game.state.worlds[w], rules.layout.sides
    for m in range(sides.shape[1]):
        side = sides[world.scene, m]
        if not side and not goes_on_quietly(state, w, m, until, 0.0):
            return False
        if side and not obeys_quietly(state, w, m, pressed_velocity(state, w, m, buttons & side != 0), until, 0.0):
            return False
    for m in range(sides.shape[1]):
        side = sides[world.scene, m]
        if side:
            obey_quietly(state, w, m, pressed_velocity(state, w, m, buttons & side != 0), until, 0.0)
    note_pressed(game, w, buttons)
    world.time_hi, world.time_lo = until, 0.0
    return True


@function
def keeps_high(rules: Rules, game: GameState, w: int, until: float) -> bool:
    """Return whether the ball is above the flippers' zone up to an instant, in a flight that does not bend upwards."""
    state, world = game.state, game.state.worlds[w]
    ball, top = state.balls[w, 0], rules.layout.tables[world.scene].zone_top
    now, then = since(world.time_hi, world.time_lo, ball.hi, ball.lo), since(until, 0.0, ball.hi, ball.lo)
    # A flight that bends downwards is, between two frames, no lower than at one of them.
    return ball.ay <= 0.0 and motion_after(state, w, 0, now)[1] > top and motion_after(state, w, 0, then)[1] > top
