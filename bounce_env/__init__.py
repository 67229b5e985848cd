"""Gymnasium environments on an exact bounce engine.

`import bounce_env` registers `Bounce/*`. What compiles (numba), draws (pygame) or validates (pydantic) is imported only
when it is used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from bounce_env.registration import register, register_all

if TYPE_CHECKING:
    from bounce_env.engine import EventKind, Recorded, Status, World, WorldBatch
    from bounce_env.envs import PaddleEnv, PinballEnv, WallsEnv
    from bounce_env.replay import Replay, load_replay, replay_of
    from bounce_env.scene import (
        ALL_FEATURES,
        Arc,
        Ball,
        Bumper,
        Feature,
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
    from bounce_env.trajectory import ledger_table, plot_scene, plot_trajectory

_SCENE = (
    "ALL_FEATURES",
    "Arc",
    "Ball",
    "Bumper",
    "Feature",
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
    **dict.fromkeys(_SCENE, "bounce_env.scene"),
    **dict.fromkeys(("EventKind", "Recorded", "Status", "World", "WorldBatch"), "bounce_env.engine"),
    **dict.fromkeys(("PaddleEnv", "PinballEnv", "WallsEnv"), "bounce_env.envs"),
    **dict.fromkeys(("Replay", "load_replay", "replay_of"), "bounce_env.replay"),
    "load_agent": "bounce_env.trained",
    **dict.fromkeys(("ledger_table", "plot_scene", "plot_trajectory"), "bounce_env.trajectory"),
}

__all__ = [
    "ALL_FEATURES",
    "Arc",
    "Ball",
    "Bumper",
    "EventKind",
    "Feature",
    "Field",
    "Flipper",
    "Paddle",
    "PaddleEnv",
    "PinballEnv",
    "Recorded",
    "Replay",
    "Scene",
    "SceneError",
    "Sensor",
    "Status",
    "Wall",
    "WallsEnv",
    "World",
    "WorldBatch",
    "__version__",
    "builtin_scenes",
    "ledger_table",
    "load_agent",
    "load_replay",
    "load_scene",
    "plot_scene",
    "plot_trajectory",
    "register",
    "replay_of",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from bounce_env.extras import version  # noqa: PLC0415

        return version()
    if name in ("cards", "vector"):
        return import_module(f"bounce_env.{name}")
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)


register_all()
