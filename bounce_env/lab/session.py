"""A person's sitting at a game: what keys do and what comes next, without a window."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from bounce_env.lab.film import Film
from bounce_env.lab.keys import FILM, PAUSE, QUIT, RESTART, controls_for

Frame = npt.NDArray[np.uint8]


class Session:
    """Episodes of `env`, one frame a tick, steered by keys.

    env: with render mode rgb_array. seed: of its stream of episodes. film: begins a film.
    Raises ValueError where the action space cannot be played with keys.

    frame: the present picture, (height, width, 3). score: of this episode. end_reason: how it ended, None while it
    runs. paused, quits: what the keys say. message: what became of the last film.
    """

    def __init__(self, env: gym.Env[Any, Any], seed: int, film: Callable[[], Film]) -> None:
        self._env = env
        self._controls = controls_for(env.action_space)
        self._new_film = film
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
        if self.paused or self.end_reason is not None:
            return
        _, _, terminated, truncated, info = self._env.step(self._controls.action(self._held))
        self.score = float(info["score"])
        if terminated or truncated:
            self.end_reason = str(info["end_reason"])
        self._show()

    def close(self) -> None:
        """Finish the film, if there is one."""
        if self._film is not None:
            self._toggle_film()

    def _begin(self, seed: int | None) -> None:
        _, info = self._env.reset(seed=seed)
        self.paused = False
        self.end_reason = None
        self.score = float(info["score"])
        self._show()

    def _show(self) -> None:
        self.frame: Frame = np.asarray(self._env.render())
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
        """Whether it went well; a disk that is full ends the film, not the game."""
        try:
            act(film)
        except OSError as error:
            self._film = None
            self.message = f"no film: {error}"
            return False
        return True
