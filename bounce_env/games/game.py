"""What every game is to a batch of worlds."""

import math
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from bounce_env.engine.memory.records import Array
from bounce_env.engine.memory.state import State
from bounce_env.games.actions import Actions
from bounce_env.games.episode import FPS
from bounce_env.games.observed import Observed
from bounce_env.games.options import Options
from bounce_env.scene import Scene, as_scene


class Game:
    """A game with what its user chose: scenes and rules, and what an agent sees and does. See docs/own_game.md.

    Raises SceneError where the scene cannot be read; a game raises ValueError where it cannot be played.

    options: what its user chose. rules: of a type that is a game (`games.rules`), with a `pace`.
    observed: what each number of an observation is, in its order.
    field: x_min, y_min, x_max, y_max [m] of where a ball may be launched by the options of a reset.
    targets: the elements, circular sensors, that `begin` and `play` put where they want them.
    hidden: the elements that pictures do not show: what only the rules or the builder of the table look at.
    """

    options_type: ClassVar[type[Options]]  # what its user may choose
    counted: ClassVar[str]  # what the score counts, in words
    counters: ClassVar[tuple[str, ...]]  # what is told at an episode's end of what the game has counted
    memory: ClassVar[np.dtype[Any] | None] = None  # what its rules remember of a world
    has_levels: bool = False
    owns_scenes: bool = False  # whether the kernel writes a scene of its own for each world
    targets: tuple[int, ...] = ()
    hidden: tuple[int, ...] = ()

    actions: Actions
    rules: Any
    field: tuple[float, float, float, float]
    observed: tuple[Observed, ...]

    def __init__(self, options: Options) -> None:
        self.options = options
        self.scenes: tuple[Scene, ...] = (as_scene(self.default_scene if options.scene is None else options.scene),)
        self.step_seconds = options.frame_skip / FPS

    @property
    def default_scene(self) -> str | Scene:
        """The scene, or name of a built-in one, that is played where the user chose none."""
        raise NotImplementedError

    @property
    def observation_bounds(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Return the lower and the upper bounds of an observation, (numbers,) float32 each."""
        low, high = zip(*((number.low, number.high) for number in self.observed), strict=True)
        return np.array(low, np.float32), np.array(high, np.float32)

    def rules_for(self, worlds: int) -> Any:
        """Return the rules for a batch of so many worlds."""
        return self.rules

    def written(self, state: State, rules: Any) -> tuple[Array, ...]:
        """Return what `begin` writes of a batch's `state` and `rules`, of shape (worlds, ...); () where nothing is."""
        return ()

    def scene_on(self, level: int | None) -> Scene:
        """Return the scene of a level; None where the game has none."""
        return self.scenes[0]

    def lamps(self, memory: Any) -> npt.NDArray[np.bool_] | None:
        """Return which elements are lit where the rules remember this; None: the game has no lamps.

        memory: a record of `memory`, of one world; or an array of them (worlds, 1), which gives (worlds, elements).
        """
        return None

    def status(self, episode: Any, memory: Any) -> tuple[str, ...]:
        """Return what a player wants to know beside the picture and the score, in a few words each: the time, at least.

        episode: a record of `games.episode.EPISODE`; memory: what the rules remember of the world.
        """
        limit = self.rules.pace.limit
        of = "" if math.isinf(limit) else f" of {clock(limit / FPS)}"
        return (f"Time {clock(episode.frames / FPS)}{of}",)

    @property
    def most_steps(self) -> int | None:
        """How many steps an episode has at most; None where there is no time limit."""
        pace = self.rules.pace
        return None if math.isinf(pace.limit) else max(1, math.ceil(pace.limit / pace.frame_skip))


def clock(seconds: float) -> str:
    """Return a time as a clock shows it: 1:05."""
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"
