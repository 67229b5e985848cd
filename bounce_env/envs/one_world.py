"""One world of a vector environment, with the face of a single one: for `call`, `get_attr` and SB3's `env_method`."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.wording import nearest


class OneWorld:
    """World `index` of a vector environment. What it does and has is what the single environment does and has.

    Attributes of your own may be set. Worlds are stepped all at once: `step` raises NotImplementedError.
    """

    def __init__(self, envs: Any, index: int) -> None:
        self._envs: Any  # the BounceVectorEnv, which makes these
        self._index: int
        self.__dict__.update(_envs=envs, _index=index)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        known = [word for word in dir(self) if not word.startswith("_")]
        raise AttributeError(f"a world of {type(self._envs).__name__} has no {name!r}{nearest(name, known)}")

    def __setattr__(self, name: str, value: Any) -> None:
        if hasattr(type(self), name) or name in self._envs.defaults():
            raise NotImplementedError(f"{name} cannot be set: pass keyword arguments when making the environment")
        super().__setattr__(name, value)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin the next episode; see the single environment."""
        if "reset_mask" in (options or {}):
            raise ValueError("options['reset_mask']: must be left out where one world is reset")
        seeds = [seed if w == self._index else None for w in range(self._envs.num_envs)]
        observations, info = self._envs.reset(
            seed=None if seed is None else seeds, options={**(options or {}), "reset_mask": self._mask}
        )
        return observations[self._index].copy(), row_of(info, self._index)

    def step(self, action: Any) -> Any:
        """Worlds are stepped all at once: raises NotImplementedError."""
        raise NotImplementedError("step: one world cannot be stepped alone, step the vector environment")

    def render(self) -> npt.NDArray[np.uint8] | None:
        """One frame, see the single environment."""
        frame: npt.NDArray[np.uint8] | None = self._envs.render_world(self._index)
        return frame

    def picture(self) -> Any:
        """Return what a frame shows now."""
        return self._envs.picture(self._index)

    def clone_state(self) -> Any:
        """Return the state of this world, see the single environment."""
        return self._envs.clone_state(self._mask)

    def restore_state(self, state: Any) -> Any:
        """Go on from a state; returns the observation."""
        return self._envs.restore_state(state, self._mask)[self._index].copy()

    def close(self) -> None:
        """A world cannot be closed alone: does nothing."""

    def has_wrapper_attr(self, name: str) -> bool:
        """Return whether there is such an attribute."""
        return hasattr(self, name)

    def get_wrapper_attr(self, name: str) -> Any:
        """Return the attribute, as Gymnasium's environments find it through their wrappers."""
        return getattr(self, name)

    def set_wrapper_attr(self, name: str, value: Any, *, force: bool = True) -> bool:
        """Set an attribute of your own, unless `force` is False and there is none; returns whether it was set."""
        if force or hasattr(self, name):
            setattr(self, name, value)
            return True
        return False

    @property
    def scene(self) -> Any:
        """The scene of the present episode."""
        return self._envs.scene_of(self._index)

    @property
    def status(self) -> tuple[str, ...]:
        """What a player wants to know beside picture and score, in words."""
        words: tuple[str, ...] = self._envs.status_of(self._index)
        return words

    @property
    def num_envs(self) -> Any:
        """How many worlds there are."""
        return self._envs.num_envs

    @property
    def unwrapped(self) -> "OneWorld":
        """Itself."""
        return self

    @property
    def observation_space(self) -> Any:
        """Of one world."""
        return self._envs.single_observation_space

    @property
    def action_space(self) -> Any:
        """Of one world."""
        return self._envs.single_action_space

    @property
    def render_mode(self) -> Any:
        """Of all worlds."""
        return self._envs.render_mode

    @property
    def metadata(self) -> Any:
        """Of all worlds."""
        return self._envs.metadata

    @property
    def spec(self) -> Any:
        """Of the vector environment."""
        return self._envs.spec

    @property
    def _mask(self) -> npt.NDArray[np.bool_]:
        mask: npt.NDArray[np.bool_] = np.arange(self._envs.num_envs) == self._index
        return mask


def row_of(info: dict[str, Any], world: int) -> dict[str, Any]:
    """Return the info of one world, as a single environment gives it."""
    row = {}
    for key, values in info.items():
        if not key.startswith("_") and info[f"_{key}"][world]:
            row[key] = row_of(values, world) if isinstance(values, dict) else plain(values[world])
    return row


def plain(value: Any) -> Any:
    """Return a NumPy scalar as Python's, anything else as it is."""
    return value.item() if isinstance(value, np.generic) else value
