"""Images of a case whose outcome follows from it to the bit: upside down, and in other units of length and time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bounce_env.report.stability.case import Case, Point, Run, Step
from bounce_env.scene import Arc, Bumper, Element, Field, Flipper, Paddle, Scene, Sensor, Wall


@dataclass(frozen=True)
class Image:
    """Lengths times `length`, times times `time`, and upside down. Powers of two change no digit of a number.

    Only y is mirrored: an arc from a to b becomes one from -b to -a, and no angle is rounded.
    """

    length: float = 1.0
    time: float = 1.0
    upside_down: bool = False

    def point(self, p: Point, per: float = 1.0) -> Point:
        factor = self.length / per
        return p[0] * factor, p[1] * (-factor if self.upside_down else factor)

    def speed(self, value: float) -> float:
        return value * self.length / self.time

    def element(self, element: Element) -> Element:
        changes: dict[str, Any] = {}
        if isinstance(element, Wall | Sensor) and element.start is not None and element.end is not None:
            start, end = self.point(element.start), self.point(element.end)
            left = isinstance(element, Wall) and element.one_way and self.upside_down
            changes |= {"start": end, "end": start} if left else {"start": start, "end": end}
        if isinstance(element, Wall) and element.draggable:
            changes["min_length"] = element.shortest * self.length
            if element.reach is not None:
                corners = np.sort([self.point(corner) for corner in element.reach], 0)
                changes["reach"] = tuple(map(tuple, corners.tolist()))
        if isinstance(element, Bumper | Arc | Sensor) and element.center is not None:
            changes |= {"center": self.point(element.center), "radius": (element.radius or 0.0) * self.length}
        if isinstance(element, Arc) and self.upside_down:
            changes |= {"start_angle": -element.end_angle, "end_angle": -element.start_angle}
        if isinstance(element, Field):
            changes["points"] = tuple(self.point(p) for p in element.points)
            changes["acceleration"] = self.point(element.acceleration, self.time**2)
        if isinstance(element, Bumper) and element.rail_end is not None:
            changes |= {"rail_end": self.point(element.rail_end), "speed": self.speed(element.speed)}
        if isinstance(element, Paddle):
            changes |= {"rail_start": self.point(element.rail_start), "rail_end": self.point(element.rail_end)}
            changes |= {"half_width": element.half_width * self.length, "radius": element.radius * self.length}
            changes["max_speed"] = self.speed(element.max_speed)
        if isinstance(element, Flipper):
            changes |= {"pivot": self.point(element.pivot), "length": element.length * self.length}
            changes |= {"up_speed": element.up_speed / self.time, "down_speed": element.down_speed / self.time}
            changes["radius"] = element.radius * self.length
            if self.upside_down:
                changes |= {"rest_angle": -element.rest_angle, "active_angle": -element.active_angle}
        if isinstance(element, Wall | Bumper | Arc | Paddle | Flipper):
            changes |= {"kick": self.speed(element.kick), "kick_threshold": self.speed(element.kick_threshold)}
            changes["cooldown"] = element.cooldown * self.time
        return replace(element, **changes)

    def scene(self, scene: Scene) -> Scene:
        return replace(
            scene,
            gravity=self.point(scene.gravity, self.time**2),
            ball=replace(scene.ball, radius=scene.ball.radius * self.length),
            rest_speed=self.speed(scene.rest_speed),
            max_speed=None if scene.max_speed is None else self.speed(scene.max_speed),
            elements=tuple(self.element(element) for element in scene.elements),
        )

    def step(self, step: Step) -> Step:
        match step:
            case ("push", velocity):
                return ("push", self.point(velocity, self.time))
            case ("command", name, float(value)):
                return ("command", name, self.speed(value))
            case ("command", name, (start, end)):
                return ("command", name, (self.point(start, self.time), self.point(end, self.time)))
            case ("replace", scene):
                return ("replace", self.scene(scene))
            case tuple():
                return step
            case seconds:
                return seconds * self.time

    def case(self, case: Case) -> Case:
        return replace(
            case,
            scene=self.scene(case.scene),
            position=self.point(case.position),
            velocity=self.point(case.velocity, self.time),
            script=tuple(self.step(step) for step in case.script),
        )

    def back(self, run: Run) -> dict[str, np.ndarray]:
        """The run of an image in the units of the case itself: fields of the ledger, and the end."""
        found: dict[str, np.ndarray] = {}
        units: list[tuple[str, Callable[[Any], Any]]] = [
            (name, self._back(1.0 / self.length, name == "y")) for name in ("x", "y")
        ]
        units += [
            (name, self._back(self.time / self.length, name[1] == "y"))
            for name in ("vx0", "vy0", "vx1", "vy1", "ux", "uy")
        ]
        units += [("nx", self._back(1.0, False)), ("ny", self._back(1.0, True)), ("time", self._back(1 / self.time))]
        units += [(name, self._back(1.0)) for name in ("ball", "element", "kind")]
        if run.ledger is not None:
            found = {name: unit(run.ledger[name]) for name, unit in units}
        states = np.array([np.frombuffer(state).reshape(2, 2) for state in run.states])
        states *= [[[1.0 / self.length], [self.time / self.length]]]
        if self.upside_down:
            states[..., 1] *= -1.0
        return found | {"states": states}

    def back_run(self, run: Run) -> Run:
        """The same as a run of the case itself, to be judged by what it expects."""
        if run.refusal:
            return run
        fields = self.back(run)
        (x, y), (vx, vy) = fields["states"][-1].tolist()
        ledger = run.ledger
        if ledger is not None:
            ledger = ledger.copy()
            for name in ledger.dtype.names:
                ledger[name] = fields[name]
        return replace(run, ledger=ledger, position=(x, y), velocity=(vx, vy), time=run.time / self.time)

    def _back(self, factor: float, mirrored: bool = False) -> Callable[[Any], Any]:
        sign = -1.0 if mirrored and self.upside_down else 1.0
        return lambda values: values * (sign * factor)
