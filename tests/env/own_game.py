"""A game of one's own, by public names alone: a paddle keeps a ball in play, and a target above gives a point."""

import math
from typing import NamedTuple

from pydantic.dataclasses import dataclass

from bounce_env import Ball, Paddle, Scene, Sensor, Wall
from bounce_env import games as g
from bounce_env.envs import BounceEnv, vector_env_of
from bounce_env.games import function

FIELD = Scene(
    gravity=(0.0, -1.0),
    ball=Ball(radius=0.03),
    max_speed=3.0,
    elements=(
        Wall((0.0, 0.0), (0.0, 1.0)),
        Wall((0.0, 1.0), (1.0, 1.0)),
        Wall((1.0, 1.0), (1.0, 0.0)),
        Sensor((0.0, 0.0), (1.0, 0.0), drain=True),
        Sensor(center=(0.5, 0.8), radius=0.1, name="target"),
        Paddle((0.2, 0.1), (0.8, 0.1), half_width=0.15, radius=0.03, max_speed=1.5, b=1.1, name="paddle"),
    ),
)
TARGET = 4
PADDLE = 0  # the first of the parts


class Rules(NamedTuple):
    """What the functions need to know beside the scene."""

    pace: g.Pace


@function
def begin(rules, game, w):
    """Launch the ball upwards: where to, the episode's seed says."""
    episode = g.begin_episode(game, w)
    g.restart(game.state, w)
    angle = math.pi * (0.25 + 0.5 * g.uniform(episode.seed, g.LAUNCHES, 0))
    g.place(game.state, w, 0, 0.5, 0.4, 1.2 * math.cos(angle), 1.2)


@function
def play(rules, game, actions, w):
    """Move the paddle as the action says for a step's frames; a point for each time the ball comes into the target."""
    state, episode = game.state, game.episodes[w]
    g.clear_hits(state, w)
    g.resume(state, w)
    episode.steps += 1
    for _ in range(rules.pace.frame_skip):
        g.hold_action(game, actions, w, rules.pace.repeat)
        g.command(state, w, PADDLE, g.clipped(game.held[w, 0]) * g.full_speed(state, w, PADDLE))
        episode.frames += 1
        code = g.run(state, w, episode.frames / rules.pace.fps, 0.0, rules.pace.max_events)
        if state.balls[w, 0].status == g.OUT:
            episode.end = g.DRAINED
        elif code != g.DONE:
            episode.end = g.OUT_OF_BUDGET
        elif g.out_of_time(episode, rules.pace):
            episode.end = g.TIME_LIMIT
        if episode.end != g.RUNNING:
            break
    points = float(state.hits[w, TARGET])
    game.counters[w, 0] += points
    episode.score += points
    return points


@function
def observe(rules, game, w, out):
    """See where the ball is and how fast, and where the paddle is."""
    x, y, vx, vy = g.ball_now(game.state, w, 0)
    out[w, 0], out[w, 1], out[w, 2], out[w, 3] = 2.0 * x - 1.0, 2.0 * y - 1.0, vx, vy
    out[w, 4] = min(max(2.0 * g.stroke_now(game.state, w, PADDLE) - 1.0, -1.0), 1.0)


g.define_game(Rules, begin=begin, play=play, observe=observe)


@g.options_class
@dataclass(frozen=True, kw_only=True, config=g.CONFIG)
class OwnOptions(g.Options):
    """What a user may choose."""

    time_limit: g.TimeLimit = 20.0


class OwnGame(g.Game):
    """The game for a batch of worlds."""

    options_type = OwnOptions
    counted = "targets"
    counters = ("targets",)
    default_scene = FIELD

    def __init__(self, options):
        super().__init__(options)
        if self.scenes[0].elements != FIELD.elements:  # TARGET and PADDLE are places in this scene
            raise ValueError("scene: must be left out, the game has one of its own")
        self.rules = Rules(g.pace_of(options))
        self.actions = g.Continuous(1)
        self.field = (0.0, 0.0, 1.0, 1.0)
        self.observed = (
            g.Observed("ball x", "left wall -1, right wall 1", -1.0, 1.0),
            g.Observed("ball y", "drain -1, top 1", -1.0, 1.0),
            g.Observed("ball velocity x", "m/s", -4.0, 4.0),
            g.Observed("ball velocity y", "m/s", -4.0, 4.0),
            g.Observed("paddle", "left stop -1, right stop 1", -1.0, 1.0),
        )


class OwnEnv(BounceEnv):
    """Keep the ball in play, and send it through the target."""

    game_type = OwnGame


OwnVectorEnv = vector_env_of(OwnEnv)
