"""The Gymnasium environments: each a batch of one world, with its card as docstring."""

import sys
from collections.abc import Mapping, Sequence
from types import FrameType
from typing import Any, ClassVar

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium import spaces

from bounce_env.engine.recorded import Recorded
from bounce_env.envs.keywords import HasKeywords
from bounce_env.envs.observations import Frames
from bounce_env.envs.one_world import plain
from bounce_env.envs.recording import episode_replay, recorded_episode
from bounce_env.games.actions import Buttons, Continuous, Discrete
from bounce_env.games.batch import Batch
from bounce_env.games.episode import DISABLED, RUNNING
from bounce_env.games.game import Game
from bounce_env.games.reset_options import checked_options, start_rows
from bounce_env.games.state_copy import States
from bounce_env.render import Picture, Window
from bounce_env.render.lazy_pygame import load_pygame
from bounce_env.render.window import display_problem
from bounce_env.replay import Replay
from bounce_env.scene import Scene
from bounce_env.wording import nearest, shown, whole

Observation = npt.NDArray[np.float32] | npt.NDArray[np.uint8]

_FIRST = np.zeros(1, np.intp)
"""The index of the one world that there is."""


def action_space(game: Game) -> spaces.Space[Any]:
    """Return what an agent does."""
    match game.actions:
        case Continuous(size):
            return spaces.Box(-1.0, 1.0, (size,), np.float32)
        case Discrete(codes):
            return spaces.Discrete(len(codes))
        case Buttons(count):
            return spaces.MultiBinary(count)


def checked_render_mode(mode: Any, known: Sequence[str]) -> str | None:
    """Return the render mode as it is; raises ValueError for one that there is not."""
    if mode is not None and (not isinstance(mode, str) or mode not in known):
        raise ValueError(f"render_mode = {shown(mode)}: must be one of {[None, *known]}{nearest(mode, known)}")
    return mode


def resetting_time_limits(env: gym.Env[Any, Any]) -> tuple[gym.Wrapper[Any, Any, Any, Any], ...]:
    """Return the TimeLimit wrappers around `env` that are resetting it right now.

    An environment does not know what wraps it, and a TimeLimit tells nobody that it cuts an episode: only from the
    stack of a reset, on which every wrapper stands, can it be learned whose step will be the last one, which has to say
    how the episode ended.
    """
    limits = []
    frame: FrameType | None = sys._getframe(1)
    while frame is not None:
        if frame.f_code.co_name == "reset":
            wrapper = frame.f_locals.get("self")
            if isinstance(wrapper, gym.wrappers.TimeLimit) and wrapper.unwrapped is env and wrapper not in limits:
                limits.append(wrapper)
        frame = frame.f_back
    return tuple(limits)


def cuts_now(limit: Any) -> bool:
    """Return whether the step that a TimeLimit is passing on is the last one that it lets an episode have."""
    return bool((limit._elapsed_steps or 0) + 1 >= limit._max_episode_steps)


def world_seed(generator: np.random.Generator) -> np.uint64:
    """Return the seed of a world's stream of episodes, drawn from a Gymnasium generator."""
    return np.uint64(generator.integers(2**64, dtype=np.uint64))


class SeedError(gym.error.Error, ValueError):
    """A seed that is none: both Gymnasium's error and a ValueError."""


def checked_seed(name: str, seed: Any) -> int | None:
    """Return a seed as int, or None; raises SeedError for what is neither."""
    if seed is None:
        return None
    try:
        return whole(name, seed, 0, allowed="None or an integer >= 0")
    except ValueError as error:
        raise SeedError(str(error)) from None


def taken_snapshot(seed: Any, options: Mapping[str, Any] | None) -> tuple[Any, dict[str, Any]]:
    """Return the option "snapshot" of a reset, None where there is none, and the other options.

    Raises ValueError where it comes with a seed or with others: it says all that they could say.
    """
    others = checked_options(options)
    snapshot = others.pop("snapshot", None)
    if snapshot is not None and (others or seed is not None):
        besides = ", ".join([*(f"options[{name!r}]" for name in others), *(["seed"] if seed is not None else [])])
        raise ValueError(f"options['snapshot']: must come without {besides}")
    return snapshot, others


class BounceEnv(HasKeywords, gym.Env[Observation, Any]):
    """A game as a Gymnasium environment; the games are its subclasses, whose docstrings name the keywords."""

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 30}  # noqa: RUF012 (Gymnasium's)
    own_keywords: ClassVar[Mapping[str, Any]] = {"render_mode": None, "record_events": False}
    _vector_env: ClassVar[Any]  # of the same game, once it was asked for

    def __init__(self, **keywords: Any) -> None:
        game, view, own = self.sorted_out(keywords)
        self.render_mode: str | None = checked_render_mode(own["render_mode"], self.metadata["render_modes"])
        self.metadata = {**self.metadata, "render_fps": round(1.0 / game.step_seconds)}
        if self.render_mode is not None or view.obs == "pixels":
            load_pygame()  # where it is missing, now and not after an episode
        self._batch = Batch(game, 1, autoreset=DISABLED)
        self._frames = Frames(self._batch, view)
        self.observation_space: spaces.Space[Any] = self._frames.space
        self.action_space = action_space(game)
        self._window: Window | None = None
        self._seeded = False
        self._running = False
        self._time_limits: tuple[gym.Wrapper[Any, Any, Any, Any], ...] = ()
        if not isinstance(own["record_events"], bool):
            raise ValueError(f"record_events = {shown(own['record_events'])}: must be True or False")
        if own["record_events"]:
            self.record()

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
        seed = checked_seed("seed", seed)
        snapshot, others = taken_snapshot(seed, options)
        self._time_limits = resetting_time_limits(self)
        if snapshot is not None:
            observation = self.restore_state(snapshot)
            if self.render_mode == "human":
                self.render()
            return observation, self._info()
        start = start_rows(self._batch.game, 1, others)
        super().reset(seed=seed)
        if seed is not None or not self._seeded:
            self._batch.seed(0, world_seed(self.np_random), self.np_random_seed)
            self._seeded = True
        self._batch.reset(np.ones(1, np.bool_), start)
        self._frames.update((0,))
        self._running = True
        if self.render_mode == "human":
            self.render()
        return self._observation(), self._info()

    def step(self, action: Any) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """One step: observation, reward (float), terminated, truncated, info; their shapes and units are on the card.

        Raises ResetNeeded when no episode is running, ValueError for a bad action.
        """
        if not self._running:
            raise gym.error.ResetNeeded("the episode has ended or not begun: call reset() before step()")
        ended = self._batch.step(action)
        self._frames.update((0,))
        info = self._info()
        cut = not ended and any(map(cuts_now, self._time_limits))
        if cut:
            self._batch.note_cut(0)
        if ended or cut:
            self._running = cut
            info |= {key: plain(value[0]) for key, value in self._batch.end_info(_FIRST).items()}
        if self.render_mode == "human":
            self.render()
        r = self._batch.results
        return self._observation(), r.rewards.item(0), r.terminated.item(0), r.truncated.item(0), info

    def render(self) -> npt.NDArray[np.uint8] | None:
        """Return the present frame, shape (height, width, 3), uint8, each number 0 to 255, in mode rgb_array.

        In mode human the same picture is shown in a window. Raises ResetNeeded before the first reset.
        """
        if self.render_mode is None:
            gym.logger.warn('render() needs a render mode: gym.make(..., render_mode="rgb_array")')
            return None
        if not self._seeded:
            raise gym.error.ResetNeeded("call reset() before render()")
        frame = self._frames.frame(0)
        if self.render_mode == "rgb_array":
            return frame
        if self._window is None:
            problem = display_problem()
            if problem is not None:
                gym.logger.warn(f'render_mode "human" shows nothing: {problem}')
            title = self.spec.id if self.spec else type(self).__name__
            self._window = Window(self._frames.size, title, self.metadata["render_fps"])
        self._window.show(frame)
        return None

    def record(self, on: bool = True) -> None:
        """Keep all events from the next episode on, for `replay`; with False: no longer. It changes no bit of play.

        Raises ValueError for anything but True and False.
        """
        if not isinstance(on, bool):
            raise ValueError(f"on = {shown(on)}: must be True or False")
        self._batch.record(0 if on else None)

    def replay(self, *, last: bool = False) -> Replay:
        """Return the present episode as a replay, as far as it has been played; last: the one before it.

        Raises RuntimeError where it was not recorded from its beginning on.
        """
        return episode_replay(self._batch, self.spec, last=last)

    def recorded(self, *, last: bool = False) -> Recorded:
        """Return the same as the engine's run, with its ledger: for `ledger_table` and `plot_trajectory`.

        last: the episode before it. Raises RuntimeError as `replay` does.
        """
        return recorded_episode(self._batch, last=last)[1]

    def picture(self) -> Picture:
        """Return what a frame shows now. Raises ResetNeeded before the first reset."""
        if not self._seeded:
            raise gym.error.ResetNeeded("call reset() before picture()")
        return self._frames.picture(0)

    def clone_state(self) -> States:
        """Return the complete state (physics, rules, random streams) of this and all later episodes, to the bit.

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

    @property
    def status(self) -> tuple[str, ...]:
        """What a player wants to know beside picture and score, in words: balls, multiplier, ball save, time."""
        return self._batch.status(0)

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()
            self._window = None

    def _observation(self) -> Observation:
        observation: Observation = self._frames.observations[0].copy()
        return observation

    def _info(self) -> dict[str, Any]:
        # By column: attributes of a record would cost more than the step.
        books = self._batch.episodes
        info = {"score": books["score"].item(0), "ball": books["ball"].item(0)}
        if self._batch.game.has_levels:
            info["level"] = books["level"].item(0)
        return info
