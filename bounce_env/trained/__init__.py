"""Trained agents that come with the package: `load_agent("Bounce/Pinball-v0")`.

Each is a .npz file of an SB3 policy's layers, made by `make results`: NumPy alone plays it, and nothing is unpickled.
"""

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np
import numpy.typing as npt

from bounce_env.files import replacing
from bounce_env.wording import nearest, numbers, shown

Floats = npt.NDArray[np.float32]

VERSION = 1
"""Of the format; a file of another one is refused."""

ACTIVATIONS: dict[str, Callable[[Floats], Floats]] = {"relu": lambda x: np.maximum(x, 0.0), "tanh": np.tanh}

_FOLDER = resources.files("bounce_env.trained")


@dataclass(frozen=True, eq=False)
class Agent:
    """A trained policy that takes its best action: `action = agent(observation)`.

    env_id, env_kwargs: what it plays. layers: (weights (out, in), biases (out,)) float32, the last gives the action.
    activation: between layers. actions: "discrete" (the greatest of the last layer's numbers), "box" (these, clipped to
    -1 to 1), or "buttons" (1 where they are > 0). facts: how it was trained and what it scored, as JSON has it.
    """

    env_id: str
    env_kwargs: Mapping[str, Any]
    layers: tuple[tuple[Floats, Floats], ...]
    activation: Literal["relu", "tanh"]
    actions: Literal["discrete", "box", "buttons"]
    facts: Mapping[str, Any] = field(default_factory=dict)

    @property
    def size(self) -> int:
        """How many numbers an observation has."""
        return int(self.layers[0][0].shape[1])

    def __call__(self, observations: npt.ArrayLike) -> Any:
        """Return the best action for an observation (size,), or actions for several (n, size).

        Raises ValueError for another shape, and for what is not finite.
        """
        given = numbers(observations)
        if given is None:
            raise ValueError(f"observations = {shown(observations)}: must be numbers")
        x = given.astype(np.float32)
        if x.ndim not in (1, 2) or x.shape[-1] != self.size:
            raise ValueError(f"observations of shape {x.shape}: must be ({self.size},) or (n, {self.size})")
        if not np.isfinite(x).all():
            raise ValueError(f"observations = {shown(observations)}: must be finite")
        for weights, biases in self.layers[:-1]:
            x = ACTIVATIONS[self.activation](x @ weights.T + biases)
        weights, biases = self.layers[-1]
        x = x @ weights.T + biases
        match self.actions:
            case "discrete":
                return x.argmax(axis=-1)
            case "buttons":
                return (x > 0.0).astype(np.int8)
            case _:
                return np.clip(x, -1.0, 1.0)

    def save(self, path: Path) -> None:
        """Write it to a .npz file, whole or not at all."""
        meta = {
            "version": VERSION,
            "env_id": self.env_id,
            "env_kwargs": dict(self.env_kwargs),
            "activation": self.activation,
            "actions": self.actions,
            "facts": dict(self.facts),
        }
        arrays = {f"{name}{i}": a for i, pair in enumerate(self.layers) for name, a in zip("wb", pair, strict=True)}
        with replacing(path) as unfinished:
            np.savez_compressed(unfinished, allow_pickle=False, meta=np.array(json.dumps(meta)), **arrays)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a .npz file that `save` has written; raises ValueError where it is none."""
        try:
            with np.load(path, allow_pickle=False) as file:
                meta = json.loads(str(file["meta"]))
                count = sum(name.startswith("w") for name in file.files)
                layers = tuple((file[f"w{i}"], file[f"b{i}"]) for i in range(count))
        except Exception as error:  # whatever zip, zlib, NumPy and JSON make of a file that is damaged or another's
            raise ValueError(f"{path}: is no agent of bounce_env: {error}") from error
        _check(layers, meta, path)
        return cls(meta["env_id"], meta["env_kwargs"], layers, meta["activation"], meta["actions"], meta["facts"])


FIELDS: dict[str, type] = {"env_id": str, "env_kwargs": dict, "activation": str, "actions": str, "facts": dict}
"""What a file's meta must have beside its version."""


def _check(layers: tuple[tuple[Floats, Floats], ...], meta: Any, path: object) -> None:
    if not isinstance(meta, dict) or meta.get("version") != VERSION:
        raise ValueError(f"{path}: must be an agent of version {VERSION}")
    for name, kind in FIELDS.items():
        if not isinstance(meta.get(name), kind):
            raise ValueError(f"{path}: {name} = {shown(meta.get(name))}: must be {kind.__name__}")
    if meta["activation"] not in ACTIVATIONS or meta["actions"] not in ("discrete", "box", "buttons"):
        raise ValueError(f"{path}: must have an activation and a kind of actions that are known")
    width = layers[0][0].shape[1] if layers and layers[0][0].ndim == 2 else 0
    for weights, biases in layers:
        fits = weights.ndim == 2 and weights.shape[1] == width > 0 and biases.shape == weights.shape[:1]
        if not (fits and weights.dtype == biases.dtype == np.float32):
            shapes = [weights.shape for weights, _ in layers]
            raise ValueError(f"{path}: layers of shapes {shapes}: must be float32 and fit together")
        width = len(biases)
    if width == 0:
        raise ValueError(f"{path}: must have layers")


def shipped_agents() -> tuple[str, ...]:
    """Return the ids of the environments for which the package has a trained agent, sorted."""
    return tuple(sorted(agent_id(item.name) for item in _FOLDER.iterdir() if item.name.endswith(".npz")))


def agent_id(file: str) -> str:
    """Return the environment that a file's agent plays: Bounce/Paddle-v0 for Bounce-Paddle-v0.npz."""
    return file.removesuffix(".npz").replace("-", "/", 1)


def agent_file(env_id: str) -> str:
    """Return the name of the file of an environment's agent."""
    return f"{env_id.replace('/', '-')}.npz"


def load_agent(env_id: str) -> Agent:
    """Return the trained agent that comes for `env_id`, such as "Bounce/Pinball-v0".

    How it was trained: docs/training.md. Raises ValueError where there is none.
    """
    if env_id not in shipped_agents():
        known = ", ".join(shipped_agents()) or "none"
        raise ValueError(f"env_id = {shown(env_id)}: must be one of {known}{nearest(env_id, shipped_agents())}")
    with resources.as_file(_FOLDER / agent_file(env_id)) as path:
        return Agent.load(path)
