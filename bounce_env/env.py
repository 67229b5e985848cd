"""The Gymnasium environments: each a batch of one world, with its card as docstring."""

from collections.abc import Mapping
from typing import Any, Literal

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from bounce_env.frames import Frames
from bounce_env.games.actions import Buttons, Continuous, Discrete
from bounce_env.games.batch import Batch
from bounce_env.games.clone import States
from bounce_env.games.episode import DISABLED, RUNNING
from bounce_env.games.game import Game
from bounce_env.games.start import start_rows
from bounce_env.render import Picture, Window
from bounce_env.scene import Scene

Observation = npt.NDArray[np.float32] | npt.NDArray[np.uint8]


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


def taken_snapshot(seed: Any, options: Mapping[str, Any] | None) -> tuple[Any, dict[str, Any]]:
    """The option "snapshot" of a reset, None where there is none, and the other options.

    Raises ValueError where it comes with a seed or with others: it says all that they could say.
    """
    others = dict(options or {})
    snapshot = others.pop("snapshot", None)
    if snapshot is not None and (others or seed is not None):
        besides = ", ".join([*(f"options[{name!r}]" for name in others), *(["seed"] if seed is not None else [])])
        raise ValueError(f"options['snapshot']: must come without {besides}")
    return snapshot, others


class BounceEnv(gym.Env[Observation, Any]):
    """A game as a Gymnasium environment; the games are its subclasses."""

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 30}  # noqa: RUF012 (Gymnasium's)

    def __init__(
        self,
        game: Game,
        *,
        obs: Literal["state", "pixels"],
        render_mode: str | None,
        width: int | None,
        height: int | None,
        trail: float,
        show_bounces: bool,
    ) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            allowed = [None, *self.metadata["render_modes"]]
            raise ValueError(f"render_mode = {render_mode!r}: must be one of {allowed}")
        self.metadata = {**self.metadata, "render_fps": round(1.0 / game.step_seconds)}
        self.render_mode = render_mode
        self._batch = Batch(game, 1, autoreset=DISABLED)
        self._frames = Frames(self._batch, obs=obs, width=width, height=height, trail=trail, show_bounces=show_bounces)
        self.observation_space: spaces.Space[Any] = self._frames.space
        self.action_space = action_space(game)
        self._window: Window | None = None
        self._seeded = False
        self._running = False

    def __getstate__(self) -> dict[str, Any]:
        # Windows can be neither copied nor sent.
        return {**self.__dict__, "_window": None}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin the next episode.

        seed: begins the stream of episodes anew; without it the stream goes on. options: `position` (x, y) [m] and
        `velocity` (vx, vy) [m/s] of the launch and, where the game has levels, the `level` in place of the seed's; or
        alone, without a seed, `snapshot`: what `clone_state` returned, to go on from. Anything else is a ValueError.
        """
        snapshot, others = taken_snapshot(seed, options)
        if snapshot is not None:
            observation = self.restore_state(snapshot)
            if self.render_mode == "human":
                self.render()
            return observation, self._info()
        start = start_rows(self._batch.game, 1, others)
        super().reset(seed=seed)
        if seed is not None or not self._seeded:
            self._batch.seed(0, world_seed(self.np_random))
            self._seeded = True
        self._batch.reset(np.ones(1, np.bool_), start)
        self._frames.update((0,))
        self._running = True
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """One step; see the card. Raises ResetNeeded when no episode is running, ValueError for a bad action."""
        if not self._running:
            raise gym.error.ResetNeeded("the episode has ended or not begun: call reset() before step()")
        ended = self._batch.step(np.asarray(action))
        self._frames.update((0,))
        info = self._info()
        if ended:
            self._running = False
            info |= {key: _plain(value[0]) for key, value in self._batch.end_info().items()}
        if self.render_mode == "human":
            self.render()
        r = self._batch.results
        return self._observation(), float(r.rewards[0]), bool(r.terminated[0]), bool(r.truncated[0]), info

    def render(self) -> npt.NDArray[np.uint8] | None:
        """The present frame (height, width, 3) in mode rgb_array; in mode human the same picture in a window."""
        if self.render_mode is None:
            gym.logger.warn('render() needs a render mode: gym.make(..., render_mode="rgb_array")')
            return None
        if not self._seeded:
            raise gym.error.ResetNeeded("call reset() before render()")
        frame = self._frames.frame(0)
        if self.render_mode == "rgb_array":
            return frame
        if self._window is None:
            title = self.spec.id if self.spec else type(self).__name__
            self._window = Window(self._frames.size, title, self.metadata["render_fps"])
        self._window.show(frame)
        return None

    def picture(self) -> Picture:
        """What a frame shows now. Raises ResetNeeded before the first reset."""
        if not self._seeded:
            raise gym.error.ResetNeeded("call reset() before picture()")
        return self._frames.picture(0)

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
        self._frames.restart((0,))
        return self._observation()

    @property
    def scene(self) -> Scene:
        """The scene of the present episode."""
        return self._batch.scene(0)

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()
            self._window = None

    def _observation(self) -> Observation:
        observation: Observation = self._frames.observations[0].copy()
        return observation

    def _info(self) -> dict[str, Any]:
        episode, levels = self._batch.episodes[0], self._batch.levels
        info = {"score": float(episode.score), "ball": int(episode.ball)}
        return info if levels is None else info | {"level": int(levels[0])}


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value
