"""The tutorial's second example: a ball among many walls, whose ends are dragged while it runs."""

from collections.abc import Mapping
from functools import singledispatchmethod
from pathlib import Path
from typing import Any, Literal

from pydantic import JsonValue

from bounce_env.lab.ghost import Ghost
from bounce_env.lab.messages import FileName, Index, Message, Point, Seconds, read, reader
from bounce_env.lab.needs import line_to_copy, needs_of
from bounce_env.lab.ready import Ready, at_once
from bounce_env.lab.shelf import Shelf
from bounce_env.lab.table import Table, event_of
from bounce_env.scene import builtin_scenes, load_scene, scene_to_dict

DEFAULT = "tutorial"
MOST_EVENTS_SHOWN = 50  # of one frame
NEXT_WITHIN = 10.0
"""How long `next` waits for a bounce [s]."""


class Open(Message):
    """Begin."""

    do: Literal["open"]


class Advance(Message):
    """Let time pass [s]; drag: the wall whose ends go towards places meanwhile, None for an end that stays."""

    do: Literal["advance"]
    seconds: Seconds
    drag: Index | None = None
    targets: tuple[Point | None, Point | None] = (None, None)


class Next(Message):
    """Go on to the next bounce."""

    do: Literal["next"]


class Launch(Message):
    """Put the ball somewhere with a velocity, at time 0."""

    do: Literal["launch"]
    position: Point
    velocity: Point


class Press(Message):
    """Press a flipper or paddle, or let it go."""

    do: Literal["press"]
    element: Index
    on: bool


class Remember(Message):
    """A drag begins: `undo` will lead back to here."""

    do: Literal["remember"]


class PlaceEnd(Message):
    """Put an end of a wall somewhere at once."""

    do: Literal["place_end"]
    element: Index
    end: Literal[0, 1]
    to: Point


class SetField(Message):
    """Change a field of an element; None: of the scene."""

    do: Literal["set"]
    element: Index | None
    field: str
    value: JsonValue


class Add(Message):
    """Add an element."""

    do: Literal["add"]
    element: dict[str, JsonValue]


class Remove(Message):
    """Remove an element."""

    do: Literal["remove"]
    element: Index


class Undo(Message):
    """Undo the last change."""

    do: Literal["undo"]


class UseGhost(Message):
    """Let the tutorial's stepper run beside, from where the ball is now; or no longer."""

    do: Literal["ghost"]
    on: bool


class Load(Message):
    """Play another scene, of the folder or a built-in one."""

    do: Literal["load"]
    name: FileName
    builtin: bool


class Save(Message):
    """Write the scene into the folder."""

    do: Literal["save"]
    name: FileName
    overwrite: bool = False


_MESSAGES = reader(
    Open | Advance | Next | Launch | Press | Remember | PlaceEnd | SetField | Add | Remove | Undo | UseGhost
    | Load | Save
)  # fmt: skip


class Stage:
    """A table in a tab. ready: see `Table`."""

    def __init__(self, *, folder: Path, scene: str | None, ready: Ready = at_once) -> None:
        self._ready = ready
        self._shelf = Shelf(folder)
        self._first = scene
        self._table: Table | None = None
        self._ghost_on = False
        self._ghost: Ghost | None = None
        self._ghost_words = ""
        self._parts: dict[int, list[float]] = {}  # where the tab knows them to be
        self._told = -1  # revision of the scene that the tab has

    def answer(self, text: str) -> Mapping[str, Any]:
        """Do what a message says; returns how things stand. Raises ValueError for what cannot be done."""
        message = read(_MESSAGES, text)
        if self._table is None:
            self._table = Table(load_scene(DEFAULT if self._first is None else self._first), self._ready)
        extra = self._do(message) or {}
        return {**self._view(), **extra}

    def close(self) -> None:
        """Nothing outlives a message."""

    @property
    def table(self) -> Table:
        """The table; there is one from the first message on."""
        assert self._table is not None
        return self._table

    @singledispatchmethod
    def _do(self, message: Any) -> dict[str, Any] | None:
        raise TypeError(f"{message!r}: no such message")

    @_do.register
    def _(self, message: Open) -> dict[str, Any]:
        self._told = -1
        return self._lists()

    @_do.register
    def _(self, message: Advance) -> dict[str, Any]:
        if message.drag is not None:
            self.table.drag(message.drag, message.targets, message.seconds)
        else:
            self.table.let_go()
        ledger = self.table.advance(message.seconds)
        self._advance_ghost(message.seconds)
        return {"events": [event_of(row) for row in ledger[-MOST_EVENTS_SHOWN:]]}

    @_do.register
    def _(self, message: Next) -> dict[str, Any]:
        self.table.let_go()
        before = self.table.world.time
        self.table.world.advance_until(1, NEXT_WITHIN)
        self._advance_ghost(self.table.world.time - before)
        return {}

    @_do.register
    def _(self, message: Launch) -> None:
        self.table.launch(message.position, message.velocity)
        self._ghost_anew()

    @_do.register
    def _(self, message: Press) -> None:
        self.table.press(message.element, message.on)

    @_do.register
    def _(self, message: Remember) -> None:
        self.table.remember(self.table.kept())

    @_do.register
    def _(self, message: PlaceEnd) -> None:
        self.table.place_end(message.element, message.end, message.to)

    @_do.register
    def _(self, message: SetField) -> dict[str, Any]:
        return self._changed(lambda table: table.set_field(message.element, message.field, message.value))

    @_do.register
    def _(self, message: Add) -> dict[str, Any]:
        return self._changed(lambda table: table.add(message.element))

    @_do.register
    def _(self, message: Remove) -> dict[str, Any]:
        return self._changed(lambda table: table.remove(message.element))

    @_do.register
    def _(self, message: Undo) -> None:
        self.table.undo()
        self._ghost_anew()

    @_do.register
    def _(self, message: UseGhost) -> None:
        self._ghost_on = message.on
        self._ghost_anew()

    @_do.register
    def _(self, message: Load) -> dict[str, Any]:
        if message.builtin and message.name not in builtin_scenes():
            raise ValueError(f"name = {message.name!r}: must be one of {', '.join(builtin_scenes())}")
        scene = load_scene(message.name) if message.builtin else self._shelf.load(message.name)
        self._table = Table(scene, self._ready)
        self._told = -1
        self._ghost_anew()
        return self._lists()

    @_do.register
    def _(self, message: Save) -> dict[str, Any]:
        scene = self.table.scene
        path = self._shelf.save(message.name, scene, overwrite=message.overwrite)
        return {**self._lists(), "notice": f"saved {path}", "line": line_to_copy(str(path), scene)}

    def _changed(self, change: Any) -> dict[str, Any]:
        """Make a change that can be undone; returns what else had to change."""
        before = self.table.kept()
        notice = change(self.table)
        self.table.remember(before)
        self._ghost_anew()
        return {"notice": notice} if notice else {}

    def _view(self) -> dict[str, Any]:
        view = {**self.table.state(), "undo": len(self.table.undo_steps), "ghost": self._ghost_now()}
        parts: dict[int, list[float]] = dict(view["parts"])
        if self._told != self.table.revision:
            self._parts = {}
            self._told, scene = self.table.revision, self.table.scene
            view |= {"scene": scene_to_dict(scene), "bounds": scene.bounds, "needs": needs_of(scene)}
        # Of two hundred walls hardly one moves: the tab knows where the others are.
        view["parts"] = [[index, numbers] for index, numbers in parts.items() if self._parts.get(index) != numbers]
        self._parts = parts
        return view

    def _lists(self) -> dict[str, Any]:
        return {"builtin": builtin_scenes(), "files": self._shelf.names()}

    def _ghost_anew(self) -> None:
        """Let the stepper begin anew from where the ball is, if it is to run at all."""
        self._ghost, self._ghost_words = None, ""
        if not self._ghost_on:
            return
        (position,), (velocity,) = self.table.world.position.tolist(), self.table.world.velocity.tolist()
        try:
            self._ghost = Ghost(self.table.scene, tuple(position), tuple(velocity))
        except ValueError as error:
            self._ghost_words = str(error)

    def _advance_ghost(self, seconds: float) -> None:
        if self._ghost is None:
            return
        try:
            self._ghost.advance(self.table.scene, seconds)
        except (ValueError, RuntimeError) as error:
            self._ghost, self._ghost_words = None, str(error)

    def _ghost_now(self) -> dict[str, Any] | None:
        if self._ghost is None:
            return {"words": self._ghost_words} if self._ghost_words else None
        (position,) = self.table.world.position.tolist()
        return {"position": self._ghost.position, "error": self._ghost.error(tuple(position))}
