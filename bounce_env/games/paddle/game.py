"""The paddle game for a batch of worlds."""

from functools import partial

import numpy as np

from bounce_env.engine.memory.records import Array
from bounce_env.engine.memory.state import State
from bounce_env.games.actions import Continuous, Discrete
from bounce_env.games.game import Game
from bounce_env.games.observed import Observed, held, place_of, velocity_of
from bounce_env.games.paddle.levels import FIELD_ENDS, level_scene, observed_bumpers
from bounce_env.games.paddle.observe import observe
from bounce_env.games.paddle.rules import begin, play, step_quietly
from bounce_env.games.paddle.setup import LAUNCH_SPEED, REFERENCE_SPEED, PaddleOptions, Rules, field_of, new_rules
from bounce_env.games.playfield import speed_bound
from bounce_env.games.rules import define_game
from bounce_env.scene import Scene

define_game(Rules, begin=begin, play=play, observe=observe, step_quietly=step_quietly)


class PaddleGame(Game):
    """The paddle game for a batch: scene and rules, and what an agent sees and does.

    Raises ValueError where the scene cannot be played (`field_of`), SceneError where it cannot be read.
    """

    options_type = PaddleOptions
    counted = "bumper hits"
    counters = ("points_bumpers", "touches")

    def __init__(self, options: PaddleOptions) -> None:
        self.has_levels = self.owns_scenes = options.num_levels is not None
        super().__init__(options)
        self.rules = new_rules(self.scenes[0], options)
        x, y, width, height = field_of(self.scenes[0])
        self.field = (x, y, x + width, y + height)
        self.actions = Discrete((-1.0, 0.0, 1.0)) if options.action == "discrete" else Continuous(1)
        scene = self.scenes[0]
        assert scene.max_speed is not None
        speed = speed_bound(max(scene.max_speed, LAUNCH_SPEED), scene.gravity, width, height) / REFERENCE_SPEED
        self.observed = (
            *place_of("ball", *FIELD_ENDS),
            *velocity_of("ball", REFERENCE_SPEED, speed),
            Observed("paddle", "left stop -1, right stop 1", -1.0, 1.0),
            *observed_bumpers(self.rules.levels),
        )
        if options.repeat_action_probability > 0.0:
            self.observed += held(["velocity of the paddle"], -1.0)

    @property
    def default_scene(self) -> str:
        """With levels that with a bumper on a rail."""
        return "paddle_levels" if self.has_levels else "paddle"

    def rules_for(self, worlds: int) -> Rules:
        """With levels each world has a field of its own, for its own bumpers."""
        if not self.has_levels:
            return self.rules
        rules, rows = self.rules, partial(np.repeat, repeats=worlds, axis=0)
        levels = rules.levels._replace(bumpers=rows(rules.levels.bumpers))
        return rules._replace(fields=rows(rules.fields), points=rows(rules.points), levels=levels)

    def written(self, state: State, rules: Rules) -> tuple[Array, ...]:
        """Return where the bumpers of a level are."""
        if not self.has_levels:
            return ()
        return tuple(a for a in (rules.levels.bumpers, state.circles, state.parts) if a is not None)

    def scene_on(self, level: int | None) -> Scene:
        """Return the scene with its bumpers where they are on the level."""
        return self.scenes[0] if level is None else level_scene(self.scenes[0], self.rules.levels, level)
