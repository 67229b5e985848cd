"""The pinball game for a batch of worlds."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.engine.compile.jit import interpreted
from bounce_env.games.actions import Buttons, Discrete
from bounce_env.games.episode import FPS
from bounce_env.games.game import Game
from bounce_env.games.observed import Observed, held, place_of, share, velocity_of
from bounce_env.games.pinball.observe import REFERENCE_SPEED, observe
from bounce_env.games.pinball.points import FARMED, HIGHEST_MULTIPLIER
from bounce_env.games.pinball.rules import begin, play, step_quietly
from bounce_env.games.pinball.serve import LAUNCH_SPEED
from bounce_env.games.pinball.setup import (
    HOLD_FRAMES,
    MEMORY,
    NUDGE,
    NUDGE_FRAMES,
    NUDGE_LEFT,
    NUDGE_RIGHT,
    REST_FRAMES,
    ROLLOVER,
    SAVE_FRAMES,
    STUCK_FRAMES,
    TARGET,
    TILT,
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
from bounce_env.scene import Field, Sensor

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
        self.observed = tuple(self._observed(layout, options))

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

    def _observed(self, layout: Layout, options: PinballOptions) -> Iterator[Observed]:
        """Return what `observe` writes, number by number."""
        scene = self.scenes[0]
        x0, y0, x1, y1 = self.field
        assert scene.max_speed is not None
        fastest = max(scene.max_speed, LAUNCH_SPEED[1]) + (math.hypot(*NUDGE) if options.nudge else 0.0)
        speed = speed_bound(fastest, scene.gravity, x1 - x0, y1 - y0) / REFERENCE_SPEED
        yield from place_of("ball", "left of the table", "right", "bottom of the table", "top")
        yield from velocity_of("ball", REFERENCE_SPEED, speed)
        flippers = [part.name for m, (_, part) in enumerate(scene.parts) if layout.sides[0, m]]
        yield from (share(in_words(name), "0 down, 1 up") for name in flippers)
        yield share("balls left, this one included", "share of `balls`")
        yield share("time for which a lost ball is still given back", f"share of {SAVE_FRAMES / FPS:g} s")
        held_time = "time that the ball has been at the flippers; at 1 they are released until it leaves"
        yield share(held_time, f"share of {HOLD_FRAMES / FPS:g} s")
        yield share("multiplier", f"share of {HIGHEST_MULTIPLIER}")
        yield share("hits of bumpers and slingshots since a flipper's touch", f"share of {FARMED}")
        yield share("time without points or a touch of a flipper", f"share of {STUCK_FRAMES / FPS:g} s")
        for side in ("left", "right"):
            yield share(f"time until the {side} button acts again", f"share of {REST_FRAMES / FPS:g} s")
        for role in (TARGET, ROLLOVER):
            lamps = [e.name for e, known in zip(scene.elements, layout.roles[0], strict=True) if known == role]
            yield from (share(in_words(name), "1: it is lit") for name in lamps)
        for i in layout.bumpers[0].tolist():
            bumper = scene.elements[i]
            assert not isinstance(bumper, Sensor | Field)
            yield share(f"{in_words(bumper.name)}: what is left of its cooldown", f"share of {bumper.cooldown:g} s")
        if options.nudge:
            yield share("tilt meter", f"share of {TILT:g}; 1: tilted")
            yield share("time until the next nudge", f"share of {NUDGE_FRAMES / FPS:g} s")
        if options.repeat_action_probability > 0.0:
            yield from held(
                ("left button", "right button", "nudge left", "nudge right")[: 4 if options.nudge else 2], 0.0
            )


def in_words(name: str) -> str:
    """Return how one speaks of an element: left flipper, for flipper_left."""
    words = {"flipper_left": "left flipper", "flipper_right": "right flipper"}
    return words.get(name, name.replace("_", " ").replace("rollover", "rollover lane"))
