"""The rules of the pinball game: points, lamps, balls, and what keeps a player from doing nothing for points."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import function, interpreted
from bounce_env.engine.events.commands import command_flipper
from bounce_env.engine.events.flights import disturb, place
from bounce_env.engine.events.loop import DONE, clear_hits, is_calm, restart, resume, run
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.readout import ball_now
from bounce_env.games.actions import Buttons, Discrete
from bounce_env.games.episode import (
    DRAINED,
    FPS,
    OUT_OF_BUDGET,
    RUNNING,
    TIME_LIMIT,
    Worlds,
    begin_episode,
    hold_action,
    open_books,
)
from bounce_env.games.field import speed_bound
from bounce_env.games.game import Game
from bounce_env.games.options import PinballOptions
from bounce_env.games.pace import out_of_time, pace_of
from bounce_env.games.pinball_points import count_points
from bounce_env.games.pinball_rules import (
    DUE,
    FLIPS,
    HOLD_FRAMES,
    HOLD_RELEASED,
    LAUNCH_FRAMES,
    LEFT,
    MEMORY,
    NO,
    NUDGE,
    NUDGE_COST,
    NUDGE_FRAMES,
    NUDGE_LEFT,
    NUDGE_RIGHT,
    NUDGES,
    REST_FRAMES,
    RIGHT,
    SAVES,
    SHOT,
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
from bounce_env.games.pinball_view import REFERENCE_SPEED, observe
from bounce_env.games.rules import is_game
from bounce_env.games.streams import LAUNCHES, uniform
from bounce_env.games.table import (
    IN_PLAY,
    ROLLOVER,
    TARGET,
    Layout,
    hidden_of,
    layout_of,
    outline,
)

REWARD_PER_POINT = 1e-3
REWARD_PER_BALL = -2.0  # for every ball that is lost, unless the reward is the score, which knows nothing of it

LAUNCH_SPEED = (1.45, 2.4)  # m/s


@function
def begin(rules: Rules, worlds: Worlds, w: int) -> None:
    """Begin the next episode of world `w`."""
    begin_episode(worlds, w)
    memory = worlds.memory[w]
    restart(worlds.state, w)
    memory.passed, memory.pressed = 0, 0
    memory.left_ready, memory.right_ready = 0, 0
    table = rules.layout.tables[worlds.state.worlds[w].scene]
    memory.lit = (1 << table.targets) - 1
    new_ball(memory)
    shoot(rules, worlds, w)


@function
def new_ball(memory: Any) -> None:
    """What begins anew with each ball: lamps stay as they are."""
    memory.multiplier, memory.farmed, memory.launches, memory.saved = 1, 0, 0, 0
    memory.tilt, memory.tilted, memory.nudged = 0.0, 0, -NUDGE_FRAMES


@function
def shoot(rules: Rules, worlds: Worlds, w: int) -> None:
    """Put the ball into the lane with the speed that its seed says, or into the game as `worlds.start` says."""
    episode, memory, start = worlds.episodes[w], worlds.memory[w], worlds.start
    table = rules.layout.tables[worlds.state.worlds[w].scene]
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
    clear_hits(worlds.state, w)
    place(worlds.state, w, 0, x, y, vx, vy)


@function
def mind_lane(rules: Rules, worlds: Worlds, w: int) -> None:
    """Let the ball count as played once it has left the lane, or if it takes too long to do so."""
    state, episode, memory = worlds.state, worlds.episodes[w], worlds.memory[w]
    late = episode.frames - memory.shot >= LAUNCH_FRAMES or state.balls[w, 0].status == OUT
    if late or crossed(state, rules.layout, w, state.worlds[w].scene):
        memory.serving = NO
        memory.born, memory.scored, memory.zone = episode.frames, episode.frames, -1


@function
def crossed(state: State, layout: Layout, w: int, scene: int) -> bool:
    """Whether the ball has come into play in this frame."""
    for element in range(state.hits.shape[1]):
        if layout.roles[scene, element] == IN_PLAY and state.hits[w, element] > 0:
            return True
    return False


@function
def press(rules: Rules, worlds: Worlds, w: int, buttons: int) -> None:
    """Let each flipper go up or down as its button says."""
    memory, scene = worlds.memory[w], worlds.state.worlds[w].scene
    for m in range(rules.layout.sides.shape[1]):
        side = rules.layout.sides[scene, m]
        if side:
            command_flipper(worlds.state, w, m, buttons & side != 0)
    pressed_now, let_go = buttons & ~memory.pressed, memory.pressed & ~buttons
    worlds.counters[w, FLIPS] += (pressed_now & 1) + (pressed_now >> 1)
    ready = worlds.episodes[w].frames + REST_FRAMES
    if let_go & LEFT:
        memory.left_ready = ready
    if let_go & RIGHT:
        memory.right_ready = ready
    memory.pressed = buttons


@function
def in_force(rules: Rules, worlds: Worlds, w: int, code: int) -> int:
    """The flippers' buttons in force: none while the ball has been held for too long, or the table is tilted.

    A nudge acts at once.
    """
    memory, frames = worlds.memory[w], worlds.episodes[w].frames
    if rules.nudge and code & (NUDGE_LEFT | NUDGE_RIGHT):
        nudge(worlds, w, code)
    if memory.tilted or hold_timer(memory, frames) >= HOLD_FRAMES:
        return 0
    buttons = 0
    for side in (LEFT, RIGHT):
        if code & side and (memory.pressed & side or rest_left(memory, frames, side) == 0):
            buttons |= side
    return buttons


@function
def play(rules: Rules, worlds: Worlds, actions: Array, w: int) -> float:
    """One step of world `w`, frame by frame; returns the reward.

    The frames in which a ball is on its way out of the lane are none of the step's: no action matters in them.
    """
    state, episode, memory = worlds.state, worlds.episodes[w], worlds.memory[w]
    reward = 0.0
    frames = rules.pace.frame_skip
    episode.steps += 1
    clear_hits(state, w)
    while (frames > 0 or memory.serving) and episode.end == RUNNING:
        buttons = 0
        if memory.serving == DUE:
            shoot(rules, worlds, w)
        if not memory.serving:
            frames -= 1
            hold_action(worlds, actions, w, rules.pace.repeat)
            buttons = in_force(rules, worlds, w, int(worlds.held[w, 0]))
        press(rules, worlds, w, buttons)
        resume(state, w)
        episode.frames += 1
        # From the count of frames, not by adding up: the same instant whatever the frame skip.
        code = run(state, w, episode.frames / rules.pace.fps, 0.0, rules.pace.max_events, None)
        if code != DONE:
            episode.end = OUT_OF_BUDGET
        elif memory.serving:
            mind_lane(rules, worlds, w)
        else:
            points = count_points(rules, worlds, w)
            episode.score += points
            reward += REWARD_PER_POINT * points
            if state.balls[w, 0].status == OUT:
                reward += lose_ball(rules, worlds, w)
            else:
                mind_time(rules, worlds, w)
        if episode.end == RUNNING and episode.frames >= rules.pace.limit:
            episode.end = TIME_LIMIT
    if episode.end == RUNNING and out_of_time(episode, rules.pace):
        episode.end = TIME_LIMIT
    return reward


@function
def lose_ball(rules: Rules, worlds: Worlds, w: int) -> float:
    """What follows when the ball has drained: it is given back, the next one follows, or the episode ends."""
    episode, memory = worlds.episodes[w], worlds.memory[w]
    if save_left(memory, episode.frames) > 0 and not memory.tilted:
        memory.saved = 1
        worlds.counters[w, SAVES] += 1
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
def mind_time(rules: Rules, worlds: Worlds, w: int) -> None:
    """What happens by the clock: the flippers' zone, a ball that is stuck, the tilt meter."""
    episode, memory = worlds.episodes[w], worlds.memory[w]
    if not in_zone(rules, worlds, w):
        memory.zone = -1
    elif memory.zone < 0:
        memory.zone = episode.frames
    elif episode.frames - memory.zone == HOLD_FRAMES:
        worlds.counters[w, HOLD_RELEASED] += 1
    memory.tilt = max(memory.tilt - TILT_PER_FRAME, 0.0)
    if episode.frames - memory.scored >= STUCK_FRAMES:
        worlds.counters[w, STUCK_FREED] += 1
        memory.serving = DUE


@function
def in_zone(rules: Rules, worlds: Worlds, w: int) -> bool:
    """Whether the ball's centre is where a flipper may hold it."""
    table = rules.layout.tables[worlds.state.worlds[w].scene]
    x, y, _, _ = ball_now(worlds.state, w, 0)
    return table.zone_left <= x <= table.zone_right and y <= table.zone_top


@function
def nudge(worlds: Worlds, w: int, buttons: int) -> None:
    """Shove the table, if the last time is long enough ago; too often, and it tilts."""
    memory, episode = worlds.memory[w], worlds.episodes[w]
    if memory.tilted or episode.frames - memory.nudged < NUDGE_FRAMES:
        return
    memory.nudged = episode.frames
    worlds.counters[w, NUDGES] += 1
    memory.tilt += NUDGE_COST
    if memory.tilt >= TILT:
        memory.tilted = 1
        worlds.counters[w, TILTS] += 1
    side = (1 if buttons & NUDGE_RIGHT else 0) - (1 if buttons & NUDGE_LEFT else 0)
    disturb(worlds.state, w, 0, 1.0, NUDGE[0] * side, NUDGE[1])


@function
def glide(rules: Rules, worlds: Worlds, actions: Array, w: int) -> bool:
    """The step of a world in which nothing happens: the same buttons, no event, and the clock changes nothing.

    False, and nothing done, where something may. The rewards and ends of `results` are expected to say so already.
    """
    state, episode, memory = worlds.state, worlds.episodes[w], worlds.memory[w]
    world = state.worlds[w]
    frames = episode.frames + rules.pace.frame_skip
    if episode.end != RUNNING or frames >= rules.pace.limit or rules.pace.repeat > 0.0:
        return False
    if episode.steps + 1 >= rules.pace.steps:
        return False
    if actions[w, 0] != memory.pressed or memory.serving or memory.tilt > 0.0 or memory.tilted:
        return False
    if frames - memory.scored >= STUCK_FRAMES or not falls_from_high(rules, worlds, w):
        return False
    until = frames / rules.pace.fps
    if not is_calm(state, w, until, 0.0):
        return False
    hi, lo = world.time_hi, world.time_lo
    world.time_hi, world.time_lo = until, 0.0
    # A flight that bends downwards is, between two frames, no lower than at one of them.
    if not falls_from_high(rules, worlds, w):
        world.time_hi, world.time_lo = hi, lo
        return False
    clear_hits(state, w)
    # An episode that ended in the last step has been followed by a new one, of which this is the first step.
    if worlds.results.ended[w].end != RUNNING:
        open_books(worlds.results, w)
    worlds.held[w, 0], episode.frames = actions[w, 0], frames
    episode.steps += 1
    observe(rules, worlds, w, worlds.results.observations)
    return True


@function
def falls_from_high(rules: Rules, worlds: Worlds, w: int) -> bool:
    """Whether the ball is above the flippers' zone, to whichever side, in a flight that does not bend upwards."""
    table = rules.layout.tables[worlds.state.worlds[w].scene]
    return worlds.state.balls[w, 0].ay <= 0.0 and ball_now(worlds.state, w, 0)[1] > table.zone_top


is_game(Rules, begin=begin, play=play, glide=glide, observe=observe)


class PinballGame(Game):
    """The pinball game for a batch: scene and rules, and what an agent sees and does.

    Raises ValueError where the scene cannot be played (`games.table`), SceneError where it cannot be read.
    """

    counted = "points"
    counters = (
        "points_bumpers",
        "points_slingshots",
        "points_targets",
        "points_rollovers",
        "banks",
        "touches",
        "flips",
        "saves",
        "stuck_freed",
        "hold_released",
        "nudges",
        "tilts",
    )
    memory = MEMORY

    def __init__(self, options: PinballOptions) -> None:
        super().__init__(options)
        layout = layout_of(self.scenes)
        self.rules = Rules(
            layout,
            pace_of(options),
            options.balls,
            int(options.nudge),
            REWARD_PER_BALL if options.reward == "dense" else 0.0,
        )
        codes: tuple[float, ...] = (0.0, 1.0, 2.0, 3.0)
        if options.nudge:
            codes += (float(NUDGE_LEFT), float(NUDGE_RIGHT))
        self.actions = Buttons(4 if options.nudge else 2) if options.action == "buttons" else Discrete(codes)
        self.field = outline(self.scenes[0])
        self.hidden = hidden_of(self.scenes[0])
        self.observation_low, self.observation_high = self._bounds(layout, options)

    @property
    def default_scene(self) -> str:
        """The table of the card."""
        return "pinball"

    def lamps(self, memory: Any) -> npt.NDArray[np.bool_]:
        """Targets that are lit, and rollovers that are."""
        layout = self.rules.layout
        lamps = np.maximum(layout.lamps[0], 0)
        targets = (layout.roles[0] == TARGET) & ((memory["lit"] >> lamps) & 1 == 1)
        rollovers = (layout.roles[0] == ROLLOVER) & ((memory["passed"] >> lamps) & 1 == 1)
        lit: npt.NDArray[np.bool_] = targets | rollovers
        return lit

    def status(self, episode: Any, memory: Any) -> tuple[str, ...]:
        """Which ball is played, the multiplier, and what is left of the ball save; or that the table is tilted."""
        words = [f"Ball {episode.ball + 1} of {self.rules.balls}", f"x{memory.multiplier}"]
        save = interpreted(save_left)(memory, episode.frames)
        if memory.tilted:
            words.append("Tilt")
        elif save > 0:
            words.append(f"Ball save {math.ceil(save / FPS)} s")
        return (*words, *super().status(episode, memory))

    def _bounds(
        self, layout: Layout, options: PinballOptions
    ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Of what is observed."""
        scene = self.scenes[0]
        x0, y0, x1, y1 = self.field
        assert scene.max_speed is not None
        fastest = max(scene.max_speed, LAUNCH_SPEED[1]) + (math.hypot(*NUDGE) if options.nudge else 0.0)
        speed = speed_bound(fastest, scene.gravity, x1 - x0, y1 - y0) / REFERENCE_SPEED
        flippers = int(np.count_nonzero(layout.sides[0]))
        table = layout.tables[0]
        shares = flippers + 8 + int(table["targets"]) + int(table["rollovers"]) + layout.bumpers.shape[1]
        buttons = 4 if options.nudge else 2
        shares += 2 * options.nudge + (buttons if options.repeat_action_probability > 0.0 else 0)
        high = np.array([1.0, 1.0, speed, speed] + [1.0] * shares, np.float32)
        low = np.array([-1.0, -1.0, -speed, -speed] + [0.0] * shares, np.float32)
        return low, high
