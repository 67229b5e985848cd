"""The keyword arguments of the environments: one definition for single and vector envs, signatures and errors."""

import enum
from collections.abc import Mapping
from copy import copy
from dataclasses import fields
from inspect import Parameter, Signature
from typing import Any, ClassVar

import numpy as np
from gymnasium.envs.registration import EnvSpec

from bounce_env.envs.observations import ViewOptions
from bounce_env.games.batch import Batch
from bounce_env.games.game import Game
from bounce_env.games.observed import Observed
from bounce_env.scene import SceneError, builtin_scenes, scene_to_dict
from bounce_env.wording import shown, unknown_name


class HasKeywords:
    """Base of all environments: what they take by keyword, and their `spec`.

    game_type: the game that is played. own_keywords: what the environment itself takes, with defaults.
    """

    game_type: ClassVar[type[Game]]
    own_keywords: ClassVar[Mapping[str, Any]]
    _batch: Batch
    _spec: EnvSpec | None = None

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        if hasattr(cls, "game_type"):
            keywords = [
                Parameter(name, Parameter.KEYWORD_ONLY, default=value) for name, value in cls.defaults().items()
            ]
            cls.__signature__ = Signature(keywords)  # type: ignore[attr-defined]

    @classmethod
    def defaults(cls) -> dict[str, Any]:
        """All keywords with their defaults: the game's, those of what is seen, and the environment's own."""
        chosen = [field for options in (cls.game_type.options_type, ViewOptions) for field in fields(options)]
        return {**{field.name: field.default for field in chosen}, **cls.own_keywords}

    @classmethod
    def sorted_out(cls, keywords: Mapping[str, Any]) -> tuple[Game, ViewOptions, dict[str, Any]]:
        """Return the game, what is seen of it, and the environment's own keywords, as a user chose them.

        Raises TypeError for an unknown keyword, ValueError for a value that is not allowed, SceneError for a scene.
        """
        known = cls.defaults()
        unknown = [
            f"{name} = {shown(value)}: {unknown_name(name, known, 'keyword')}"
            for name, value in keywords.items()
            if name not in known
        ]
        if unknown:
            raise TypeError("\n".join(unknown))
        own = {name: keywords.get(name, default) for name, default in cls.own_keywords.items()}
        view_names = {field.name for field in fields(ViewOptions)}
        view = ViewOptions(**{name: value for name, value in keywords.items() if name in view_names})
        rest = {name: value for name, value in keywords.items() if name not in {*own, *view_names}}
        options = cls.game_type.options_type(**rest)
        try:
            return cls.game_type(options), view, own
        except SceneError:
            raise
        except ValueError as error:  # a scene that cannot be played, which the game does not know by its name
            named = "" if options.scene is None else f" (scene = {shown(options.scene)})"
            raise ValueError(f"{error}{named}") from None

    @property
    def observed(self) -> tuple[Observed, ...]:
        """What each number of an observation is where `obs` is "state", by its index: its name, unit and bounds."""
        return self._batch.game.observed

    @property
    def spec(self) -> EnvSpec | None:
        """How the environment was made, with nothing in it that JSON has not: a scene of the user's own is in it whole.

        `max_episode_steps` is the number of steps that the time limit allows, or a smaller one that was asked for: who
        makes an environment of it with another `time_limit` or `frame_skip` gives `max_episode_steps=-1`, too.
        """
        return self._spec

    @spec.setter
    def spec(self, spec: EnvSpec | None) -> None:
        self._spec = spec if spec is None else self._in_json(spec)

    def _in_json(self, spec: EnvSpec) -> EnvSpec:
        spec = copy(spec)
        spec.kwargs = {name: self._as_json(name, value) for name, value in spec.kwargs.items()}
        if spec.max_episode_steps is None:
            asked = spec.kwargs.get("max_episode_steps")
            limits = [self._batch.game.most_steps, None if asked == -1 else asked]
            spec.max_episode_steps = min((limit for limit in limits if limit is not None), default=None)
        return spec

    def _as_json(self, name: str, value: Any) -> Any:
        if name == "scene" and value is not None and value not in builtin_scenes():
            return scene_to_dict(self._batch.game.scenes[0])
        if isinstance(value, enum.Enum):
            return value.name
        return value.item() if isinstance(value, np.generic) else value
