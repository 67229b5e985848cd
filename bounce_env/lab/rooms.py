"""What there is in the lab: a room for each tab, which answers its messages."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

from bounce_env.lab.play import Play
from bounce_env.lab.ready import Ready
from bounce_env.lab.reflection import Reflection
from bounce_env.lab.stage import Stage


class Room(Protocol):
    """What a tab talks to.

    folder: where it may read and write. scene: that was asked for at the start. ready: see `Kernels.wait`.
    """

    def __init__(self, *, folder: Path, scene: str | None, ready: Ready) -> None: ...

    def answer(self, text: str) -> Mapping[str, Any]:
        """Return the answer to a message, JSON; raises ValueError for what is wrong with it."""

    def close(self) -> object:
        """End what has begun: the tab is gone."""


ROOMS: Mapping[str, type[Room]] = {"reflection": Reflection, "stage": Stage, "play": Play}
