"""The rules of the game of walls: bring each ball to its target with a wall that is dragged by its ends."""

import math
from typing import Any

import numpy as np

from bounce_env.engine.compile.jit import function
from bounce_env.engine.events.commands import command_ends, reach_box
from bounce_env.engine.events.loop import DONE, clear_hits, resume
from bounce_env.engine.memory import records as layout
from bounce_env.engine.memory.records import OUT, Array
from bounce_env.engine.memory.state import State
from bounce_env.engine.motion.readout import ball_now, core_now
from bounce_env.games.actions import Continuous, clipped
from bounce_env.games.episode import (
    ALL_PLAYED,
    FPS,
    OUT_OF_BUDGET,
    RUNNING,
    TIME_LIMIT,
    Worlds,
    begin_episode,
    hold_action,
)
from bounce_env.games.field import place_seen, speed_bound
from bounce_env.games.game import Game
from bounce_env.games.options import WallsOptions
from bounce_env.games.pace import out_of_time
from bounce_env.games.rules import is_game
from bounce_env.games.walls_rules import (
    BALL_FRAMES,
    CONTROLS,
    CRUSHED,
    DRAINED,
    MEMORY,
    OBSERVATION_SIZE,
    REFERENCE_SPEED,
    SUCCESS,
    TARGETS,
    TIMED_OUT,
    TOUCHES,
    WALL_SPEED,
    Rules,
    field_of,
    new_rules,
)
from bounce_env.games.walls_serve import advance, serve, target_of


@function
def observe(rules: Rules, worlds: Worlds, w: int, out: Array) -> None:
    """Ball, the wall's ends, target, time and balls that are left: see the card of `bounce_env.cards.WallsEnv`."""
    state, episode = worlds.state, worlds.episodes[w]
    court = rules.courts[state.worlds[w].scene]
    x, y, vx, vy = ball_now(state, w, 0)
    x0, y0, x1, y1 = wall_now(state, w, court.part)
    tx, ty, _ = target_of(state, w, court.ring)
    out[w, 0], out[w, 1] = place_seen(court, x, y)
    out[w, 2], out[w, 3] = vx * (1.0 / REFERENCE_SPEED), vy * (1.0 / REFERENCE_SPEED)
    out[w, 4], out[w, 5] = place_seen(court, x0, y0)
    out[w, 6], out[w, 7] = place_seen(court, x1, y1)
    out[w, 8], out[w, 9] = place_seen(court, tx, ty)
    out[w, 10] = max(BALL_FRAMES - (episode.frames - worlds.memory[w].born), 0) / BALL_FRAMES
    out[w, 11] = (rules.balls - episode.ball) / rules.balls
    for j in range(out.shape[1] - OBSERVATION_SIZE):
        out[w, OBSERVATION_SIZE + j] = clipped(worlds.held[w, j])


@function
def wall_now(state: State, w: int, part: int) -> tuple[float, float, float, float]:
    """Where the ends of the player's wall are now: x, y, x, y [m]."""
    return core_now(state, w, part)


@function
def begin(rules: Rules, worlds: Worlds, w: int) -> None:
    """Begin the next episode of world `w`."""
    begin_episode(worlds, w)
    serve(rules, worlds, w)
    world = worlds.state.worlds[w]
    world.bounces, world.speed_capped = 0, 0


@function
def potential(rules: Rules, worlds: Worlds, w: int) -> float:
    """-1 to 0: the less, the further away the ball is from its target; 0 when the last ball has been played."""
    if worlds.episodes[w].end == ALL_PLAYED:
        return 0.0
    scene = worlds.state.worlds[w].scene
    court = rules.courts[scene]
    x, y, _, _ = ball_now(worlds.state, w, 0)
    tx, ty, _ = target_of(worlds.state, w, court.ring)
    return -math.sqrt((x - tx) * (x - tx) + (y - ty) * (y - ty)) / court.across


@function
def play(rules: Rules, worlds: Worlds, actions: Array, w: int) -> float:
    """One step of world `w`: the wall's ends move as its action says. Returns the reward."""
    state, episode = worlds.state, worlds.episodes[w]
    before = potential(rules, worlds, w)
    clear_hits(state, w)
    resume(state, w)
    frames = 1 if rules.pace.repeat > 0.0 else rules.pace.frame_skip
    code = DONE
    last = episode.frames + rules.pace.frame_skip
    episode.steps += 1
    while episode.frames < last and code == DONE and state.balls[w, 0].status != layout.CRUSHED:
        hold_action(worlds, actions, w, rules.pace.repeat)
        drag(rules, worlds, w, frames / rules.pace.fps)
        episode.frames += frames
        # From the count of frames, not by adding up: the same instant whatever the frame skip.
        until = (episode.frames - worlds.memory[w].born) / rules.pace.fps
        code = advance(state, w, until, rules.pace.max_events)
    points = mind_ball(rules, worlds, w, code)
    if episode.end == RUNNING and out_of_time(episode, rules.pace):
        episode.end = TIME_LIMIT
    episode.score += points
    if rules.shaping == 0.0:
        return points
    return points + rules.gamma * potential(rules, worlds, w) - before


@function
def drag(rules: Rules, worlds: Worlds, w: int, seconds: float) -> None:
    """Let the ends of the wall move as the action in force says, for so long, but not out of the box of its reach.

    Nor further apart than they may be: an end that is drawn away drags the other one along.
    """
    state, held, scene = worlds.state, worlds.held, worlds.state.worlds[w].scene
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
    """The velocity [m/s] with which a coordinate comes no further than a border in so many seconds."""
    ahead = x + velocity * seconds
    if low <= ahead <= high:
        return velocity
    return (min(max(ahead, low), high) - x) / seconds


@function
def mind_ball(rules: Rules, worlds: Worlds, w: int, code: int) -> float:
    """Count what the ball has come to, and launch the next one if it is over; returns the points."""
    state, episode, counters = worlds.state, worlds.episodes[w], worlds.counters
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
    elif episode.frames - worlds.memory[w].born >= BALL_FRAMES:
        counters[w, TIMED_OUT] += 1
    else:
        return points
    if episode.ball + 1 < rules.balls:
        episode.ball += 1
        serve(rules, worlds, w)
    else:
        episode.end = ALL_PLAYED
    return points


@function
def glide(rules: Rules, worlds: Worlds, actions: Array, w: int) -> bool:
    """The wall moves in every step: there is none in which nothing happens."""
    return False


is_game(Rules, begin=begin, play=play, glide=glide, observe=observe)


class WallsGame(Game):
    """The game of walls for a batch: scene and rules, and what an agent sees and does.

    Raises ValueError where the scene cannot be played (`problems_of`), SceneError where it cannot be read.
    """

    owns_scenes = True
    counted = "targets reached"
    counters = ("points_targets", "drained", "timed_out", "crushed", "touches", "is_success")
    memory = MEMORY

    def __init__(self, options: WallsOptions) -> None:
        super().__init__(options)
        self.rules = new_rules(self.scenes[0], options)
        x, y, width, height = field_of(self.scenes[0])
        self.field = (x, y, x + width, y + height)
        self.actions = Continuous(CONTROLS)
        scene = self.scenes[0]
        assert scene.max_speed is not None
        speed = speed_bound(scene.max_speed, scene.gravity, width, height) / REFERENCE_SPEED
        held = [1.0] * CONTROLS if options.repeat_action_probability > 0.0 else []
        self.observation_high = np.array([1.0, 1.0, speed, speed, *[1.0] * 8, *held], np.float32)
        self.observation_low = -self.observation_high
        self.observation_low[10:12] = 0.0
        self.targets = (int(self.rules.courts["target"][0]),)

    @property
    def default_scene(self) -> str:
        """The field of the card."""
        return "walls"

    def status(self, episode: Any, memory: Any) -> tuple[str, ...]:
        """Which ball is played, and how long it still may be."""
        left = max(BALL_FRAMES - (episode.frames - memory.born), 0)
        words = (f"Ball {episode.ball + 1} of {self.rules.balls}", f"{math.ceil(left / FPS)} s left")
        return (*words, *super().status(episode, memory))

    def rules_for(self, worlds: int) -> Rules:
        """Each world has a field of its own, for its own target."""
        return self.rules._replace(courts=np.repeat(self.rules.courts, worlds, axis=0))

    def written(self, state: State, rules: Rules) -> tuple[Array, ...]:
        """Where the target is."""
        assert state.rings is not None
        return (state.rings,)
