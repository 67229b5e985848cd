"""The pinball game for a batch of worlds."""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import interpreted
from bounce_env.games.actions import Buttons, Discrete
from bounce_env.games.episode import FPS
from bounce_env.games.game import Game
from bounce_env.games.pinball.observe import REFERENCE_SPEED, observe
from bounce_env.games.pinball.rules import begin, play, step_quietly
from bounce_env.games.pinball.serve import LAUNCH_SPEED
from bounce_env.games.pinball.setup import (
    MEMORY,
    NUDGE,
    NUDGE_LEFT,
    NUDGE_RIGHT,
    ROLLOVER,
    TARGET,
    Layout,
    PinballOptions,
    Rules,
    hidden_of,
    layout_of,
    outline,
    save_left,
)
from bounce_env.games.playfield import speed_bound
from bounce_env.games.rules import define_game
from bounce_env.games.timing import pace_of

REWARD_PER_BALL = -2.0  # for every ball that is lost, unless the reward is the score, which knows nothing of it
define_game(Rules, begin=begin, play=play, observe=observe, step_quietly=step_quietly)


class PinballGame(Game):
    """The pinball game for a batch: scene and rules, and what an agent sees and does.

    Raises ValueError where the scene cannot be played (`games.pinball.setup`), SceneError where it cannot be read.
    """

    options_type = PinballOptions
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
        """Return of what is observed."""
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
