"""A table that is built while a ball runs on it: a scene, the world that plays it, and the ways to change both."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from bounce_env.engine import EventKind, Status, World
from bounce_env.lab.messages import LARGEST
from bounce_env.lab.movable import drag_speed, is_draggable, movable, size_of, with_walls_at, without_revision
from bounce_env.lab.parts import parts_of
from bounce_env.lab.ready import Ready, at_once, wanted_for
from bounce_env.scene import ALL_FEATURES, Flipper, Paddle, Scene, Wall, scene_from_dict, scene_to_dict

Point = tuple[float, float]

MOST_ELEMENTS = 2000
MOST_UNDONE = 100
LIMIT_OF_SPEED = 100.0
"""What max_speed becomes, in scene sizes a second, where a change needs one and there is none."""

_CLEAR = 1.0 + 1e-9


class Kept(NamedTuple):
    """A scene, and the names of its elements in the world, by which parts keep their places."""

    scene: Scene
    names: list[str]


class Table:
    """A scene under a ball that runs. What cannot be changed raises ValueError, and the table is then as before.

    The kernels are the general ones, so that no change waits for a compiler. ready: returns when they are there.
    """

    def __init__(self, scene: Scene, ready: Ready = at_once) -> None:
        self._ready = ready
        self.undo_steps: list[Kept] = []
        self.revision = 0
        self._dragged: int | None = None
        self._begin(scene)

    def _begin(self, scene: Scene, position: Point | None = None, velocity: Point = (0.0, 0.0)) -> None:
        """Play a scene from time 0, with the ball at a place, or anywhere where it fits."""
        if len(scene.elements) > MOST_ELEMENTS:
            raise ValueError(f"elements: there are {len(scene.elements)}, and must be at most {MOST_ELEMENTS}")
        self._ready(wanted_for(scene))
        names = [f"#{i}" for i in range(len(scene.elements))]
        world = World(movable(scene, names), features=ALL_FEATURES)
        if position is None:
            position = free_place(world, scene)
        try:
            world.reset(position=position, velocity=velocity)
        except ValueError as error:
            raise ValueError(without_revision(str(error))) from error
        self._scene, self.world, self._names, self._next = scene, world, names, len(names)
        self.revision += 1

    @property
    def scene(self) -> Scene:
        """The scene, with its walls where they have been dragged to."""
        cores = self.world.cores.tolist()
        ends = {
            index: tuple(core)
            for (index, part), core in zip(self.world.scene.parts, cores, strict=True)
            if isinstance(part, Wall)
        }
        return with_walls_at(self._scene, ends)

    def launch(self, position: Point, velocity: Point) -> None:
        """Put the ball somewhere [m], with a velocity [m/s], at time 0."""
        self._begin(self.scene, position, velocity)

    def advance(self, seconds: float) -> np.ndarray:
        """Let time pass; returns the ledger."""
        ledger = self.world.advance(seconds, ledger=True)
        assert ledger is not None
        return ledger

    def drag(self, index: int, targets: tuple[Point | None, Point | None], seconds: float) -> None:
        """Let the ends of a wall move towards places, no faster than they may, for so long."""
        self.let_go()
        if not self._is_draggable(index):
            raise ValueError(f"elements[{index}]: only the ends of walls that are not one-way can be dragged")
        core = self._core(index)
        limit = drag_speed(self._scene)
        velocities = [_towards(core[2 * k : 2 * k + 2], targets[k], seconds, limit) for k in range(2)]
        self.world.command(self._name(index), velocities)
        self._dragged = index

    def let_go(self) -> None:
        """Let the wall that is dragged stand."""
        if self._dragged is not None:
            self.world.command(self._name(self._dragged), ((0.0, 0.0), (0.0, 0.0)))
            self._dragged = None

    def press(self, index: int, on: bool) -> None:
        """Press a flipper, or let it go; a paddle goes to the end of its rail while it is pressed, and back."""
        element = self._element(index)
        if isinstance(element, Flipper):
            self.world.command(self._name(index), on)
        elif isinstance(element, Paddle):
            self.world.command(self._name(index), element.max_speed if on else -element.max_speed)
        else:
            raise ValueError(f"elements[{index}]: must be a flipper or a paddle to be pressed")

    def kept(self) -> Kept:
        """Return the scene as it is now, for `remember`."""
        return Kept(self.scene, self._names)

    def remember(self, kept: Kept) -> None:
        """Let `undo` lead back to a scene that there was."""
        self.undo_steps = [*self.undo_steps[-MOST_UNDONE + 1 :], kept]

    def undo(self) -> None:
        """Go back to the scene before the last change; the ball goes on."""
        if not self.undo_steps:
            raise ValueError("nothing to undo")
        self._go_on(*self.undo_steps[-1])
        self.undo_steps.pop()

    def set_field(self, index: int | None, field: str, value: Any) -> str:
        """Change a field of an element, or, with None, of the scene: "gravity", "ball.b"; returns a notice or ""."""

        def change(data: dict[str, Any]) -> None:
            place: dict[str, Any] = data if index is None else data["elements"][index]
            *path, last = field.split(".")
            if (index is None and last in {"elements", "ball"}) or len(path) > 1 or (path and path != ["ball"]):
                raise ValueError(f"{field}: must be a field of the scene, or ball.FIELD")
            for step in path:
                place = place[step]
            if value is None:
                place.pop(last, None)
            else:
                place[last] = value

        if index is not None:
            self._element(index)
        return self._change(change)

    def add(self, element: Mapping[str, Any]) -> str:
        """Add an element, by its fields as in a TOML file; returns a notice or ""."""
        return self._change(lambda data: data["elements"].append(dict(element)), [*self._names, f"#{self._next}"])

    def remove(self, index: int) -> str:
        """Remove an element; returns a notice or ""."""
        self._element(index)
        names = [name for i, name in enumerate(self._names) if i != index]
        return self._change(lambda data: data["elements"].pop(index), names)

    def place_end(self, index: int, end: int, to: Point) -> None:
        """Put an end of a wall somewhere at once, as while time stands; a ball that it then overlaps is set clear.

        The ball stays on its side of the wall. Refused with ValueError where it has no room there.
        """
        self._element(index)
        scene = self.scene
        before = scene.elements[index]
        if not isinstance(before, Wall):
            raise ValueError(f"elements[{index}]: must be a wall to have ends")
        moved = replace(before, start=to) if end == 0 else replace(before, end=to)
        new = replace(scene, elements=(*scene.elements[:index], moved, *scene.elements[index + 1 :]))
        self._go_on(new, self._names, lambda place: _set_clear(place, before, moved, scene.ball.radius))

    def _change(self, change: Callable[[dict[str, Any]], object], names: list[str] | None = None) -> str:
        """Go on in a scene whose contents were changed; returns what else had to be changed, in words."""
        data, notice = scene_to_dict(self.scene), ""
        change(data)
        if "max_speed" not in data and _needs_limit(data):
            data["max_speed"] = LIMIT_OF_SPEED * size_of(self._scene)
            notice = f"max_speed = {data['max_speed']:g} m/s: bounces may now add speed, and need a limit"
        self._go_on(scene_from_dict(data), self._names if names is None else names)
        return notice

    def _go_on(self, scene: Scene, names: list[str], placed: Callable[[Point], Point] | None = None) -> None:
        """Let the ball go on in another scene. placed: from where it is to where it is put."""
        if len(scene.elements) > MOST_ELEMENTS:
            raise ValueError(f"elements: there may be at most {MOST_ELEMENTS}")
        x, y = self.world.position[0].tolist()
        if scene.ball.radius != self._scene.ball.radius:
            self._resize(scene, (x, y))
            return
        position = None if placed is None else [placed((x, y))]
        try:
            self.world.replace(movable(scene, names, self.revision + 1), position=position)
        except ValueError as error:
            raise ValueError(without_revision(str(error))) from error
        self._scene, self._names, self._dragged = scene, names, None
        self._next += 1
        self.revision += 1

    def _resize(self, scene: Scene, position: Point) -> None:
        """Go on with a ball of another size: where it is, or where it fits; time begins anew."""
        velocity = tuple(self.world.velocity[0].tolist())
        try:
            self._begin(scene, position, velocity)
        except ValueError:
            self._begin(scene)

    def _element(self, index: int) -> Any:
        if index >= len(self._scene.elements):
            raise ValueError(f"elements[{index}]: there are {len(self._scene.elements)}, numbered from 0")
        return self._scene.elements[index]

    def _is_draggable(self, index: int) -> bool:
        return is_draggable(self._element(index))

    def _name(self, index: int) -> str:
        """Return the name of an element in the world."""
        return self.world.scene.elements[index].name

    def _core(self, index: int) -> list[float]:
        numbers = [i for i, _ in self.world.scene.parts]
        core: list[float] = self.world.cores[numbers.index(index)].tolist()
        return core

    def state(self) -> dict[str, Any]:
        """Return where everything is now, as JSON has it."""
        (x, y), (vx, vy) = self.world.position[0].tolist(), self.world.velocity[0].tolist()
        gx, gy = self._scene.gravity
        counts = self.world.counts
        return {
            "time": self.world.time,
            "ball": [x, y, vx, vy],
            "status": Status(int(self.world.status[0])).name.lower(),
            "bounces": counts.bounces,
            "energy": 0.5 * (vx * vx + vy * vy) - gx * x - gy * y,
            "parts": parts_of(self.world.scene, self.world.cores),
            "revision": self.revision,
        }


def event_of(row: Any) -> list[Any]:
    """Return a row of the ledger as [time, kind, element, x, y, speed before, speed after]."""
    before, after = math.hypot(row["vx0"], row["vy0"]), math.hypot(row["vx1"], row["vy1"])
    return [
        float(row["time"]),
        EventKind(int(row["kind"])).words,
        int(row["element"]),
        float(row["x"]),
        float(row["y"]),
        before,
        after,
    ]


def _needs_limit(data: Mapping[str, Any]) -> bool:
    """Return whether bounces in a scene may add energy; what is not a number is refused elsewhere."""

    def number(value: object, otherwise: float) -> float:
        return value if isinstance(value, int | float) and abs(value) <= LARGEST else otherwise

    ball = number(data.get("ball", {}).get("b"), 1.0)
    return any(
        number(e.get("kick"), 0.0) > 0.0 or ball * number(e.get("b"), 1.0) > 1.0 for e in data.get("elements", ())
    )


def _towards(end: list[float], target: Point | None, seconds: float, limit: float) -> Point:
    """Return the velocity with which an end comes to a target in so many seconds, or as fast as it may."""
    if target is None or seconds <= 0.0:
        return 0.0, 0.0
    dx, dy = target[0] - end[0], target[1] - end[1]
    distance = math.hypot(dx, dy)
    speed = min(distance / seconds, limit)
    return (dx / distance * speed, dy / distance * speed) if distance > 0.0 else (0.0, 0.0)


def _set_clear(place: Point, before: Wall, after: Wall, radius: float) -> Point:
    """Return a ball's place, moved off a wall that overlaps it, to the side of the wall where it was before."""
    (x0, y0), (x1, y1) = after.start, after.end
    wx, wy = x1 - x0, y1 - y0
    length = math.hypot(wx, wy)
    if length == 0.0:
        return place
    along = ((place[0] - x0) * wx + (place[1] - y0) * wy) / length
    distance = (wx * (place[1] - y0) - wy * (place[0] - x0)) / length
    if abs(distance) >= radius or not -radius < along < length + radius:
        return place
    (bx0, by0), (bx1, by1) = before.start, before.end
    side = 1.0 if (bx1 - bx0) * (place[1] - by0) - (by1 - by0) * (place[0] - bx0) >= 0.0 else -1.0
    off = side * radius * _CLEAR - distance
    return place[0] - wy / length * off, place[1] + wx / length * off


def free_place(world: World, scene: Scene) -> Point:
    """Return where a ball fits: the first of a net of places, from above."""
    left, bottom, right, top = scene.bounds
    for y in np.linspace(top, bottom, 23)[1:-1].tolist():
        for x in (0.5 * (left + right) + np.array([0.013, -0.21, 0.23, -0.37, 0.41]) * (right - left)).tolist():
            try:
                world.reset(position=(x, y), velocity=(0.0, 0.0))
            except ValueError:
                continue
            return x, y
    return 0.5 * (left + right) + 0.013 * (right - left), top + 2.0 * scene.ball.radius
