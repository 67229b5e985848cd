"""The games in a browser: with keys, mouse and fingers."""

from collections.abc import Mapping
from functools import singledispatchmethod
from pathlib import Path
from typing import Annotated, Any, Literal

import gymnasium as gym
import numpy as np
from pydantic import AfterValidator, Field

from bounce_env.games.episode import FPS
from bounce_env.lab.messages import FileName, Message, Point, read, reader
from bounce_env.lab.parts import parts_of
from bounce_env.lab.pointing import pointed
from bounce_env.lab.ready import Ready, Wanted, at_once
from bounce_env.lab.scores import HighScores, key_of
from bounce_env.lab.shelf import Shelf
from bounce_env.registration import games
from bounce_env.scene import Scene, scene_to_dict
from bounce_env.window.film import Film
from bounce_env.window.keys import controls_for

GAMES = games()
FILM_HEIGHT = 720  # pixels
MOST_FRAMES = 6  # of 1/60 s, that one message plays


def _known(game: str) -> str:
    if game not in GAMES:
        raise ValueError(f"must be one of {', '.join(GAMES)}")
    return game


class Begin(Message):
    """Begin a game, in a scene of the folder or its own."""

    do: Literal["begin"]
    game: Annotated[str, AfterValidator(_known)]
    scene: FileName | None = None


class Again(Message):
    """Begin the same game anew."""

    do: Literal["again"]


class Step(Message):
    """Play frames of 1/60 s. held: keys, by their names in `window.keys`. to, end: where a person points [m]."""

    do: Literal["step"]
    frames: Annotated[int, Field(ge=1, le=MOST_FRAMES)]
    held: Annotated[tuple[str, ...], Field(max_length=20)] = ()
    to: Point | None = None
    end: Literal[0, 1] = 0


class SaveReplay(Message):
    """Write the game so far as a page into the folder."""

    do: Literal["save"]
    name: FileName


class MakeFilm(Message):
    """Film the game from now on into a file of the folder; None: complete the film."""

    do: Literal["film"]
    name: FileName | None


_MESSAGES = reader(Begin | Again | Step | SaveReplay | MakeFilm)


class Play:
    """A game in a tab. scores: where high scores are kept; None: in the user's data folder."""

    def __init__(
        self,
        *,
        folder: Path,
        scene: str | None = None,
        ready: Ready = at_once,
        scores: HighScores | None = None,
    ) -> None:
        del scene  # of the stage
        self._shelf, self._ready = Shelf(folder), ready
        self._scores = scores or HighScores()
        self._env: Any = None
        self._film: Film | None = None
        self._end: str | None = None
        self._told: Scene | None = None

    def answer(self, text: str) -> Mapping[str, Any]:
        """Do what a message says; returns how the game stands. Raises ValueError for what cannot be done."""
        message = read(_MESSAGES, text)
        if self._env is None and not isinstance(message, Begin):
            raise ValueError("no game has begun")
        extra = self._do(message) or {}
        return {**self._view(), **extra}

    @singledispatchmethod
    def _do(self, message: Any) -> dict[str, Any] | None:
        raise TypeError(f"{message!r}: no such message")

    @_do.register
    def _(self, message: Begin) -> dict[str, Any]:
        env_id = GAMES[message.game]
        path = None if message.scene is None else self._shelf.path(message.scene)
        kwargs: dict[str, Any] = {} if path is None else {"scene": path}
        self._ready(Wanted(env_id, "" if path is None else str(path)))
        self.close()
        kwargs |= {"frame_skip": 1, "record_events": True, "render_mode": "rgb_array", "height": FILM_HEIGHT}
        try:
            self._env = gym.make(env_id, disable_env_checker=True, **kwargs).unwrapped
        except ValueError as error:
            raise ValueError(str(error).partition(" was raised from the environment creator")[0]) from error
        self._controls = controls_for(self._env.action_space)
        self._key = key_of(env_id, {}, self._env.scene)
        self._reset(int(np.random.SeedSequence().generate_state(1)[0]))
        return {"controls": self._controls.words, "best": self._best()}

    @_do.register
    def _(self, message: Again) -> dict[str, Any]:
        self._reset(None)
        return {"best": self._best()}

    @_do.register
    def _(self, message: Step) -> dict[str, Any]:
        extra: dict[str, Any] = {}
        for _ in range(message.frames):
            if self._end is not None:
                break
            _, _, terminated, truncated, info = self._env.step(self._action(message))
            self._hits |= self._env.picture().hits > 0
            if self._film is not None:
                self._film.add(self._env.render())
            if terminated or truncated:
                self._end = str(info["end_reason"])
                extra["best"] = self._noted(float(info["score"]))
        return extra

    @_do.register
    def _(self, message: SaveReplay) -> dict[str, Any]:
        path = self._shelf.folder / f"{message.name}.html"
        if path.exists():
            raise ValueError(f"{path.name} is there already: save it under another name")
        try:
            self._env.replay().save(path)
        except OSError as error:
            raise ValueError(f"{path.name}: cannot be written: {error.strerror}") from error
        return {"notice": f"saved {path}"}

    @_do.register
    def _(self, message: MakeFilm) -> dict[str, Any]:
        if message.name is None:
            path = self.close()
            return {} if path is None else {"notice": f"saved {path}"}
        path = self._shelf.folder / f"{message.name}.mp4"
        if path.exists():
            raise ValueError(f"{path.name} is there already: film under another name")
        height, width, _ = self._env.render().shape
        try:
            self._film = Film(path, (width, height), FPS)
        except OSError as error:
            raise ValueError(f"no film: {error}") from error
        return {}

    def close(self) -> Path | None:
        """Complete the film, if there is one; returns its path. Raises ValueError where it cannot be completed."""
        film, self._film = self._film, None
        if film is None:
            return None
        try:
            film.finish()
        except OSError as error:
            raise ValueError(f"no film: {error}") from error
        return film.path

    def _reset(self, seed: int | None) -> None:
        self._env.reset(seed=seed)
        self._end, self._told = None, None
        self._hits = np.zeros(len(self._env.scene.elements), np.bool_)

    def _action(self, message: Step) -> Any:
        if message.to is not None:
            cores = np.asarray(self._env.picture().cores)
            action = pointed(self._env.action_space, self._env.scene, cores, message.to, message.end)
            if action is not None:
                return action
        return self._controls.action({*message.held})

    def _noted(self, score: float) -> float | None:
        """Note a score; returns the best of all, or None where none can be kept."""
        try:
            return self._scores.add(self._key, score)[0].score
        except (OSError, ValueError):
            return None

    def _best(self) -> float | None:
        try:
            best = self._scores.of(self._key)
        except (OSError, ValueError):
            return None
        return best[0].score if best else None

    def _view(self) -> dict[str, Any]:
        env = self._env
        picture, scene = env.picture(), env.scene
        lit = np.zeros(0) if picture.lit is None else np.asarray(picture.lit)
        hits, self._hits = self._hits, np.zeros_like(self._hits)
        view = {
            "balls": np.asarray(picture.balls)[np.asarray(picture.alive)].tolist(),
            "parts": parts_of(scene, np.asarray(picture.cores)),
            "lit": np.flatnonzero(lit).tolist(),
            "hits": np.flatnonzero(hits).tolist(),
            "score": float(picture.score),
            "status": env.status,
            "end": self._end,
            "films": self._film is not None,
        }
        if self._told != scene:  # a new level, or a target that is put elsewhere
            self._told = scene
            view |= {"scene": scene_to_dict(scene), "bounds": scene.bounds}
        return view
