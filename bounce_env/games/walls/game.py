"""The game of walls for a batch of worlds."""

import math
from typing import Any

import numpy as np

from bounce_env.engine.memory.records import Array
from bounce_env.engine.memory.state import State
from bounce_env.games.actions import Continuous
from bounce_env.games.episode import FPS
from bounce_env.games.game import Game
from bounce_env.games.observed import held, place_of, share, velocity_of
from bounce_env.games.playfield import speed_bound
from bounce_env.games.rules import define_game
from bounce_env.games.walls.observe import observe
from bounce_env.games.walls.rules import begin, play
from bounce_env.games.walls.setup import (
    BALL_FRAMES,
    CONTROLS,
    MEMORY,
    REFERENCE_SPEED,
    Rules,
    WallsOptions,
    field_of,
    new_rules,
)

define_game(Rules, begin=begin, play=play, observe=observe)


class WallsGame(Game):
    """The game of walls for a batch: scene and rules, and what an agent sees and does.

    Raises ValueError where the scene cannot be played (`problems_of`), SceneError where it cannot be read.
    """

    owns_scenes = True
    options_type = WallsOptions
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
        ends = ("left wall", "right wall", "drain", "top")
        self.observed = (
            *place_of("ball", *ends),
            *velocity_of("ball", REFERENCE_SPEED, speed),
            *place_of("first end of the wall", *ends),
            *place_of("second end of the wall", *ends),
            *place_of("target", *ends),
            share("time that the ball has left", f"share of {BALL_FRAMES / FPS:g} s"),
            share("balls left, this one included", "share of `balls`"),
        )
        if options.repeat_action_probability > 0.0:
            self.observed += held(
                [f"velocity {axis} of the {end} end" for end in ("first", "second") for axis in "xy"], -1.0
            )
        self.targets = (int(self.rules.courts["target"][0]),)

    @property
    def default_scene(self) -> str:
        """The field of the card."""
        return "walls"

    def status(self, episode: Any, memory: Any) -> tuple[str, ...]:
        """Return which ball is played, and how long it still may be."""
        left = max(BALL_FRAMES - (episode.frames - memory.born), 0)
        words = (f"Ball {episode.ball + 1} of {self.rules.balls}", f"{math.ceil(left / FPS)} s left")
        return (*words, *super().status(episode, memory))

    def rules_for(self, worlds: int) -> Rules:
        """Each world has a field of its own, for its own target."""
        return self.rules._replace(courts=np.repeat(self.rules.courts, worlds, axis=0))

    def written(self, state: State, rules: Rules) -> tuple[Array, ...]:
        """Return where the target is."""
        assert state.circle_sensors is not None
        return (state.circle_sensors,)
