"""The methods: this engine and its opponents. What a missing extra leaves out is named, not skipped."""

from collections.abc import Collection
from importlib import import_module

from bounce_env.report.methods.base import Method, Player, Setting
from bounce_env.report.methods.engine import engine_methods
from bounce_env.report.methods.moreau import Moreau
from bounce_env.report.methods.tutorial import Tutorial
from bounce_env.report.problems import Problem

_PEERS = (
    ("pymunk_space", "Pymunk", "pymunk", "pymunk"),
    ("box2d_world", "Box2DMethod", "box2d", "Box2D"),
    ("scipy_ode", "Scipy", "scipy", "scipy with events"),
    ("scipy_ode", "ByHand", "by_hand", "scipy, told the contact"),
    ("billiards_sim", "Billiards", "billiards", "billiards"),
)


class NotInstalled(Method):
    """An opponent that is not there."""

    def __init__(self, name: str, label: str, module: str) -> None:
        self.name, self.label = name, label
        self.settings = self.quick = (Setting("-"),)
        self.note = f"not measured: {module} is not installed"

    def why_not(self, problem: Problem) -> str | None:
        """Return that it is not there."""
        return self.note

    def player(self, problem: Problem, setting: Setting, top_speed: float) -> Player:
        """Raise NotImplementedError: nobody calls it."""
        raise NotImplementedError


def all_methods(features: Collection[str] = ()) -> tuple[Method, ...]:
    """Return all methods. features: forced on this engine's kernels, so that all problems share one."""
    found = [*engine_methods(features), Tutorial(recheck=True), Tutorial(recheck=False), Moreau()]
    for file, kind, name, label in _PEERS:
        try:
            found.append(getattr(import_module(f"bounce_env.report.methods.{file}"), kind)())
        except ModuleNotFoundError as error:
            found.append(NotInstalled(name, label, str(error.name)))
    return tuple(found)
