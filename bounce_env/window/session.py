"""A person's sitting at a game: what keys do and what comes next, without a window."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from bounce_env.window.film import Film
from bounce_env.window.keys import FILM, PAUSE, QUIT, RESTART, Controls, controls_for

Frame = npt.NDArray[np.uint8]


SHOWN_AGAIN = 2.0
"""Seconds for which the end of an agent's episode is shown before its next one begins."""


class Session:
    """Episodes of `env`, one frame a tick, steered by keys, or by an agent for a person who watches.

    env: with render mode rgb_array. seed: of its stream of episodes. film: begins a film. agent: from an observation to
    an action; None for a person. waits: for a key that starts the sitting.
    Raises ValueError where the action space cannot be played with keys.

    frame: the present picture, (height, width, 3). score: of this episode. end_reason: how it ended, None while it
    runs. waits: whether it still does. paused, quits: what the keys say. message: what became of the last film.
    status: what there is to know beside picture and score, in a few words each. episodes: how many have ended.
    """

    def __init__(
        self,
        env: gym.Env[Any, Any],
        seed: int,
        film: Callable[[], Film],
        agent: Callable[[Any], Any] | None = None,
        *,
        waits: bool = False,
    ) -> None:
        self._env = env
        self._agent = agent
        self._controls = Controls(lambda held: None, "") if agent else controls_for(env.action_space)
        self._new_film = film
        self.waits = waits
        self.episodes = 0
        self._rests = 0
        self._observation: Any = None
        self._film: Film | None = None
        self._held: set[str] = set()
        self.paused = self.quits = False
        self.message = ""
        self.end_reason: str | None = None
        self._begin(seed)

    @property
    def controls(self) -> str:
        """Which keys move what."""
        return self._controls.words

    @property
    def filming(self) -> bool:
        """Whether a film is being made."""
        return self._film is not None

    def press(self, key: str) -> None:
        """A key goes down; keys have pygame's names."""
        self._held.add(key)
        starts, self.waits = self.waits, self.waits and key in (*QUIT, FILM)
        if starts and not self.waits:
            return  # whatever it means later on: now it starts the game
        if key == PAUSE and self.end_reason is None:
            self.paused = not self.paused
        elif key == RESTART:
            self._begin(None)
        elif key == FILM:
            self._toggle_film()
        elif key in QUIT:
            self.quits = True

    def release(self, key: str) -> None:
        """A key goes up."""
        self._held.discard(key)

    def tick(self) -> None:
        """The next frame, unless the game is paused or over."""
        if self._agent is not None and self.end_reason is not None and not self.paused:
            self._rests -= 1
            if self._rests <= 0:
                self._begin(None)
            return
        if self.waits or self.paused or self.end_reason is not None:
            return
        action = self._controls.action(self._held) if self._agent is None else self._agent(self._observation)
        self._observation, _, terminated, truncated, info = self._env.step(action)
        self.score = float(info["score"])
        if terminated or truncated:
            self.end_reason = str(info["end_reason"])
            self.episodes += 1
            self._rests = round(SHOWN_AGAIN * float(self._env.metadata["render_fps"]))
        self._show()

    def close(self) -> None:
        """Finish the film, if there is one."""
        if self._film is not None:
            self._toggle_film()

    def _begin(self, seed: int | None) -> None:
        self._observation, info = self._env.reset(seed=seed)
        self.paused = False
        self.end_reason = None
        self.score = float(info["score"])
        self._show()

    def _show(self) -> None:
        self.frame: Frame = np.asarray(self._env.render())
        self.status: tuple[str, ...] = getattr(self._env.unwrapped, "status", ())
        if self._film is not None:
            self._try(lambda film: film.add(self.frame), self._film)

    def _toggle_film(self) -> None:
        film, self._film = self._film, None
        if film is not None:
            if self._try(Film.finish, film):
                self.message = f"saved {film.path}"
            return
        try:
            self._film = self._new_film()
        except OSError as error:
            self.message = f"no film: {error}"
        else:
            self.message = ""
            self._show()

    def _try(self, act: Callable[[Film], None], film: Film) -> bool:
        """Return whether it went well; a disk that is full ends the film, not the game."""
        try:
            act(film)
        except OSError as error:
            self._film = None
            self.message = f"no film: {error}"
            return False
        return True
