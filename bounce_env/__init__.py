"""Gymnasium environments on an exact bounce engine.

`import bounce_env` registers `Bounce/*`. What compiles (numba), draws (pygame) or validates (pydantic) is imported only
when it is used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from bounce_env.registration import register_all

if TYPE_CHECKING:
    from bounce_env.engine.world import World
    from bounce_env.scene import (
        Arc,
        Ball,
        Bumper,
        Field,
        Flipper,
        Paddle,
        Scene,
        SceneError,
        Sensor,
        Wall,
        builtin_scenes,
        load_scene,
    )
    from bounce_env.trained import load_agent

_SCENE = (
    "Arc",
    "Ball",
    "Bumper",
    "Field",
    "Flipper",
    "Paddle",
    "Scene",
    "SceneError",
    "Sensor",
    "Wall",
    "builtin_scenes",
    "load_scene",
)
_HOME = {
    "World": "bounce_env.engine.world",
    "load_agent": "bounce_env.trained",
    **dict.fromkeys(_SCENE, "bounce_env.scene"),
}

__all__ = [
    "Arc",
    "Ball",
    "Bumper",
    "Field",
    "Flipper",
    "Paddle",
    "Scene",
    "SceneError",
    "Sensor",
    "Wall",
    "World",
    "__version__",
    "builtin_scenes",
    "load_agent",
    "load_scene",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from bounce_env.extras import version  # noqa: PLC0415

        return version()
    if name == "cards":
        return import_module("bounce_env.cards")
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)


register_all()
