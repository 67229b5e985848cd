"""All specs: the ball and the elements of `bounce_env.scene.elements`, and the `Scene` that holds them."""

from typing import Annotated, Self

from pydantic import BeforeValidator, model_validator
from pydantic.dataclasses import dataclass

from bounce_env.scene.checks import check_scene
from bounce_env.scene.elements import CONFIG, Ball, Box, Bumper, Element, Paddle, Sensor, Spec, Wall, union
from bounce_env.scene.fields import Allowed, PositiveOrNone, RestSpeed, Vector, instance_of, not_allowed

__all__ = ["Ball", "Box", "Bumper", "Element", "Paddle", "Scene", "Sensor", "Wall"]

_Ball = Annotated[Ball, Allowed("a Ball", instance_of(Ball))]
_Element = Annotated[Element, Allowed("a Wall, Bumper, Paddle or Sensor", instance_of(Element))]


def _tuple(value: object) -> tuple[object, ...]:
    if not isinstance(value, tuple | list):  # pydantic alone would take a set, which has no order
        raise not_allowed("a tuple or list of Wall, Bumper, Paddle and Sensor")
    return tuple(value)


@dataclass(frozen=True, kw_only=True, config=CONFIG)
class Scene(Spec):
    """A table: gravity, the ball and the elements.

    gravity: acceleration (x, y) in m/s^2. ball: what every ball in play is like. rest_speed: m/s, only 0 in
    this release. max_speed: no bounce leaves the ball faster than this, m/s, > 0; None for no limit. It must
    be given if a bounce can add energy (a kick, or ball.b * element.b > 1), and exceed every paddle's.
    elements: their order counts, for it breaks the tie of bounces that are alike, and an element's index is
    its number in the ledger.

    Raises `pydantic.ValidationError` (a ValueError) that names field, value and what is allowed; what only
    the whole scene can show (names, sizes, speeds) is in `bounce_env.scene.checks`.
    """

    gravity: Vector = (0.0, -9.81)
    ball: _Ball = Ball()
    rest_speed: RestSpeed = 0.0
    max_speed: PositiveOrNone = None
    elements: Annotated[tuple[_Element, ...], BeforeValidator(_tuple)] = ()

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_scene(self.ball, dict(enumerate(self.elements)), self.max_speed)
        return self

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres of all that the elements occupy; zeros if there are none."""
        return union(element.bounds for element in self.elements)
