"""The bounce engine: exact, event-driven, in two dimensions; see docs/physics.md and docs/architecture.md.

Its face is `World`, `WorldBatch`, `Recorded`, `Status`, `EventKind` and `LEDGER`; the rest are the rooms that these are
built of.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bounce_env.engine.memory.records import LEDGER, EventKind, Status
    from bounce_env.engine.recorded import Recorded
    from bounce_env.engine.world import World
    from bounce_env.engine.world_batch import WorldBatch

_HOME = {
    "LEDGER": "memory.records",
    "EventKind": "memory.records",
    "Recorded": "recorded",
    "Status": "memory.records",
    "World": "world",
    "WorldBatch": "world_batch",
}

__all__ = ["LEDGER", "EventKind", "Recorded", "Status", "World", "WorldBatch"]


def __getattr__(name: str) -> Any:
    """Import a name when it is first asked for: what compiles takes a second to import."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
