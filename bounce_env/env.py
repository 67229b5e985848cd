"""The Gymnasium environments: each a batch of one world, with its card as docstring."""

from os import PathLike
from typing import Any, Literal

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from bounce_env.engine.layout import OUT
from bounce_env.games.actions import Buttons, Continuous, Discrete
from bounce_env.games.batch import Batch
from bounce_env.games.clone import States
from bounce_env.games.episode import DISABLED, RUNNING
from bounce_env.games.game import Game
from bounce_env.games.options import PaddleOptions, PinballOptions
from bounce_env.games.paddle import PaddleGame
from bounce_env.games.pinball import PinballGame
from bounce_env.games.start import start_rows
from bounce_env.render import Picture, Renderer, Window
from bounce_env.render.projection import Projection
from bounce_env.scene import Scene

Observation = npt.NDArray[np.float32]


def observation_space(game: Game) -> spaces.Box:
    """What an agent sees; the bounds come from the physics, nothing is clipped to them."""
    return spaces.Box(game.observation_low, game.observation_high, dtype=np.float32)


def action_space(game: Game) -> spaces.Space[Any]:
    """What an agent does."""
    match game.actions:
        case Continuous(size):
            return spaces.Box(-1.0, 1.0, (size,), np.float32)
        case Discrete(codes):
            return spaces.Discrete(len(codes))
        case Buttons(count):
            return spaces.MultiBinary(count)


def world_seed(generator: np.random.Generator) -> np.uint64:
    """The seed of a world's stream of episodes, drawn from a Gymnasium generator."""
    return np.uint64(generator.integers(2**64, dtype=np.uint64))


def picture_of(batch: Batch, world: int) -> Picture:
    """What a frame of a world shows."""
    balls, cores = batch.view(world)
    elements = len(batch.game.scenes[0].elements)
    return Picture(
        balls=balls[:, :2],
        cores=cores,
        alive=batch.state.balls["status"][world] != OUT,
        hits=batch.state.hits[world, :elements],
        lit=None if batch.memory is None else batch.game.lamps(batch.memory[world]),
        score=float(batch.episodes[world].score),
    )


class BounceEnv(gym.Env[Observation, Any]):
    """A game as a Gymnasium environment; the games are its subclasses."""

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 30}  # noqa: RUF012 (Gymnasium's)

    def __init__(self, game: Game, render_mode: str | None, width: int | None, height: int | None) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            allowed = [None, *self.metadata["render_modes"]]
            raise ValueError(f"render_mode = {render_mode!r}: must be one of {allowed}")
        Projection.fit(game.scenes[0].bounds, width, height)  # a bad size is told now, not at the first frame
        self.metadata = {**self.metadata, "render_fps": round(1.0 / game.step_seconds)}
        self.render_mode = render_mode
        self.observation_space: spaces.Space[Any] = observation_space(game)
        self.action_space = action_space(game)
        self._batch = Batch(game, 1, autoreset=DISABLED)
        self._size = (width, height)
        self._renderer: Renderer | None = None
        self._window: Window | None = None
        self._seeded = False
        self._running = False

    def __getstate__(self) -> dict[str, Any]:
        # What draws is made anew when it is needed; windows can be neither copied nor sent.
        return {**self.__dict__, "_renderer": None, "_window": None}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin the next episode.

        seed: begins the stream of episodes anew; without it the stream goes on. options: `position` (x, y) [m] and
        `velocity` (vx, vy) [m/s] of the launch in place of the seed's; anything else is a ValueError.
        """
        start = start_rows(self._batch.game, 1, options)
        super().reset(seed=seed)
        if seed is not None or not self._seeded:
            self._batch.seed(0, world_seed(self.np_random))
            self._seeded = True
        self._batch.reset(np.ones(1, np.bool_), start)
        self._running = True
        if self.render_mode == "human":
            self.render()
        return self._batch.results.observations[0].copy(), self._info()

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """One step; see the card. Raises ResetNeeded when no episode is running, ValueError for a bad action."""
        if not self._running:
            raise gym.error.ResetNeeded("the episode has ended or not begun: call reset() before step()")
        ended = self._batch.step(np.asarray(action))
        info = self._info()
        if ended:
            self._running = False
            info |= {key: _plain(value[0]) for key, value in self._batch.end_info().items()}
        if self.render_mode == "human":
            self.render()
        r = self._batch.results
        return r.observations[0].copy(), float(r.rewards[0]), bool(r.terminated[0]), bool(r.truncated[0]), info

    def render(self) -> npt.NDArray[np.uint8] | None:
        """The present frame (height, width, 3) in mode rgb_array; in mode human the same picture in a window."""
        if self.render_mode is None:
            gym.logger.warn('render() needs a render mode: gym.make(..., render_mode="rgb_array")')
            return None
        if not self._seeded:
            raise gym.error.ResetNeeded("call reset() before render()")
        if self._renderer is None:
            self._renderer = Renderer(self._batch.game.scenes[0], *self._size)
        frame = self._renderer.frame(picture_of(self._batch, 0))
        if self.render_mode == "rgb_array":
            return frame
        if self._window is None:
            title = self.spec.id if self.spec else type(self).__name__
            self._window = Window((frame.shape[1], frame.shape[0]), title, self.metadata["render_fps"])
        self._window.show(frame)
        return None

    def clone_state(self) -> States:
        """All that the present episode and those after it follow from; `restore_state` goes on from it, bit for bit.

        Raises ResetNeeded before the first reset.
        """
        if not self._seeded:
            raise gym.error.ResetNeeded("call reset() before clone_state()")
        return self._batch.clone(np.ones(1, np.bool_))

    def restore_state(self, state: States) -> Observation:
        """Go on from a state that an equal environment, single or vector, has cloned; returns its observation.

        Raises ValueError, and changes nothing, for a state of another game, scene or options.
        """
        self._batch.restore(state, np.ones(1, np.bool_))
        self._seeded = True
        self._running = int(self._batch.episodes[0].end) == RUNNING
        observation: Observation = self._batch.results.observations[0].copy()
        return observation

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()
            self._window = None

    def _info(self) -> dict[str, Any]:
        episode = self._batch.episodes[0]
        return {"score": float(episode.score), "ball": int(episode.ball)}


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


class PaddleEnv(BounceEnv):
    """Keep the ball in play with a paddle, and send it into the bumpers.

    A field of 1.0 x 1.4 m under a gravity of 1.5 m/s^2: walls to the sides and above, a drain below, four bumpers that
    speed the ball up (b > 1, at most 3 m/s), and a paddle with round ends above the drain. The paddle's f < 1: its
    motion drags the ball along, so that a player can aim. It kicks whatever hits it, so that no ball dies on it. The
    physics has no time step: every bounce happens at its exact instant.

    Actions, every `frame_skip` / 60 s:

    | `action` | space | meaning |
    | --- | --- | --- |
    | "continuous" | Box(-1, 1, (1,), float32) | speed of the paddle, in units of 1.5 m/s; clipped, NaN is an error |
    | "discrete" | Discrete(3) | 0 left, 1 stay, 2 right, at full speed |

    Observation, float32, nothing clipped:

    | index | what | range |
    | --- | --- | --- |
    | 0 | ball x: left wall -1, right wall 1 | [-1, 1] |
    | 1 | ball y: drain -1, top 1 | [-1, 1] |
    | 2, 3 | ball velocity x, y, in units of 2 m/s | +-sqrt(max_speed^2 + 2 g H) / 2, about 1.8 |
    | 4 | paddle: left stop -1, right stop 1 | [-1, 1] |
    | 5 | what the paddle does now, only where actions are sticky | [-1, 1] |

    Reward: 1 for each hit of a bumper. Nothing for survival.

    Start: the ball at 40 % of the field's height, x uniform over the middle 60 % of its width, 1.5 m/s at 30 to 150
    degrees, all from the episode's seed; the paddle in the middle. Options of `reset`: `position`, `velocity`.

    End: terminated when the ball drains; truncated after `time_limit` seconds of play (or, never seen in play, when
    more than 500 events fall into one step: `end_reason` "budget").

    Info: each step `score` (the sum of rewards) and `ball` (0). At an episode's end also `end_reason`,
    `points_bumpers`, `bounces`, `touches` (hits of the paddle), `speed_capped` (bounces at the speed limit) and
    `game_seconds`.

    Keyword arguments: `scene` (a built-in name, the path of a TOML file, or a Scene; "paddle"), `action`
    ("continuous"), `frame_skip` (2, in units of 1/60 s), `repeat_action_probability` (0.0, per 1/60 s), `time_limit`
    (60.0 s, None for none), `render_mode` (None, "rgb_array", "human"), `width`, `height` (of a frame in pixels). A
    vector env also takes `num_envs`, `num_threads` (1), `autoreset_mode` (NEXT_STEP), `copy` (True).

    Versions: v0, first release.
    """

    def __init__(
        self,
        *,
        scene: str | PathLike[str] | Scene = "paddle",
        action: Literal["continuous", "discrete"] = "continuous",
        frame_skip: int = 2,
        repeat_action_probability: float = 0.0,
        time_limit: float | None = 60.0,
        render_mode: str | None = None,
        width: int | None = None,
        height: int | None = None,
    ) -> None:
        options = PaddleOptions(
            scene=scene,
            action=action,
            frame_skip=frame_skip,
            repeat_action_probability=repeat_action_probability,
            time_limit=time_limit,
        )
        super().__init__(PaddleGame(options), render_mode, width, height)


class PinballEnv(BounceEnv):
    """Three balls on a pinball table with two flippers, three bumpers, two slingshots, a bank of targets, and lanes.

    A table of 0.514 x 1.067 m, as steep as a real one (1.11 m/s^2 along it), a ball of 13.5 mm radius, at most 4 m/s
    fast. Flippers turn by 52 degrees, up in 25 ms and down in 50. Outlanes of 32 mm at both sides and a gap of 45 mm
    between the flippers' tips lead to the drain. The plunger fires by itself, and no step is spent until the ball has
    left its lane. The physics has no time step: every bounce happens at its exact instant.

    Actions, every `frame_skip` / 60 s:

    | `action` | space | meaning |
    | --- | --- | --- |
    | "discrete" | Discrete(4) | buttons: 0 none, 1 left, 2 right, 3 both; with `nudge` (6): 4 left, 5 right |
    | "buttons" | MultiBinary(2) | left, right; with `nudge` MultiBinary(4): left, right, nudge left, nudge right |

    A button that is held holds its flipper up. One that is let go does not act for 0.3 s: who hammers the buttons is
    not ready when the ball comes. A nudge adds 0.25 m/s to its side and 0.15 m/s up the table to the velocity of the
    ball, at most every 0.25 s, and 1 to the tilt meter, which falls by 0.5 a second: at 3 the table is tilted, and
    until that ball is lost the flippers are dead, no points are given and no ball is given back.

    Points, times the multiplier (`score` is their sum):

    | what | points |
    | --- | --- |
    | bumper, slingshot | 50, 10 for a hit; none after 20 of these hits without a flipper's touch |
    | target | 250 if it is lit; it then goes out |
    | the last target of the bank | 1000 more; all are lit again, and the multiplier grows by 1, at most to 5 |
    | rollover lane | 100 if it is not lit; it then lights up |
    | the last lane | 500 more; all go out again |

    The multiplier falls back to 1 with each new ball; targets and lanes stay as they are.

    Observation, float32, nothing clipped; n numbers each for what the table has n of:

    | what | range |
    | --- | --- |
    | ball x, y: left and bottom of the table -1, right and top 1 | [-1, 1] |
    | ball velocity x, y, in m/s | +-sqrt(max_speed^2 + 2 g H), about 4.3 |
    | each flipper: 0 down, 1 up (left, right) | [0, 1] |
    | balls left, this one included, over `balls` | [0, 1] |
    | time for which a lost ball is still given back, over 5 s | [0, 1] |
    | time that the ball has been at the flippers, over 2 s; 1: they are released until it leaves | [0, 1] |
    | multiplier over 5 | [0, 1] |
    | hits of bumpers and slingshots since a flipper's touch, over 20 | [0, 1] |
    | time without points or a touch of a flipper, over 10 s | [0, 1] |
    | time until each button acts again, over 0.3 s (left, right) | [0, 1] |
    | each target (3): 1 if it is lit | {0, 1} |
    | each lane (3): 1 if it is lit | {0, 1} |
    | each bumper (3): what is left of its cooldown of 0.1 s | [0, 1] |
    | tilt meter over 3, 1: tilted; time until the next nudge over 0.25 s; only with `nudge` | [0, 1] |
    | each button that is in force, only where actions are sticky | {0, 1} |

    Reward: points / 1000, and -2 for every ball that is lost.

    Start: the ball in the lane, shot at 1.45 to 2.4 m/s as the episode's seed says for each one. A step in which a ball
    is in the lane lasts until it is in play, and `frame_skip` frames more where it was there from the start. Options of
    `reset`: `position` puts the first ball straight into play, `velocity` says how fast it is.

    End: terminated when the last ball drains; truncated after `time_limit` seconds of play (or, never seen in play,
    when more than 10 000 events fall into one frame: `end_reason` "budget"). A ball that drains within 5 s is given
    back, once. When one has been in the flippers' zone for 2 s, both are released until it has left it
    (`hold_released`). One that for 10 s has neither met a flipper nor earned points is stuck, and is shot again
    (`stuck_freed`).

    Info: each step `score` and `ball` (0 to `balls` - 1). At an episode's end also `end_reason`, `points_bumpers`,
    `points_slingshots`, `points_targets`, `points_rollovers`, `banks`, `touches` (hits of flippers), `flips`, `saves`,
    `stuck_freed`, `hold_released`, `nudges`, `tilts`, `bounces`, `speed_capped` (bounces at the speed limit) and
    `game_seconds`.

    Keyword arguments: `scene` (a built-in name, the path of a TOML file, or a Scene; "pinball", whose file says what a
    table must have), `action` ("discrete"), `nudge` (False), `balls` (3), `frame_skip` (2, in units of 1/60 s),
    `repeat_action_probability` (0.0, per 1/60 s), `time_limit` (120.0 s, None for none), `render_mode` (None,
    "rgb_array", "human"), `width`, `height` (of a frame in pixels). A vector env also takes `num_envs`, `num_threads`
    (1), `autoreset_mode` (NEXT_STEP), `copy` (True).

    Versions: v0, first release.
    """

    def __init__(
        self,
        *,
        scene: str | PathLike[str] | Scene = "pinball",
        action: Literal["discrete", "buttons"] = "discrete",
        nudge: bool = False,
        balls: int = 3,
        frame_skip: int = 2,
        repeat_action_probability: float = 0.0,
        time_limit: float | None = 120.0,
        render_mode: str | None = None,
        width: int | None = None,
        height: int | None = None,
    ) -> None:
        options = PinballOptions(
            scene=scene,
            action=action,
            nudge=nudge,
            balls=balls,
            frame_skip=frame_skip,
            repeat_action_probability=repeat_action_probability,
            time_limit=time_limit,
        )
        super().__init__(PinballGame(options), render_mode, width, height)
