"""All specs: the ball and the elements of `bounce_env.scene.elements`, and the `Scene` that holds them."""

from typing import Annotated, Self

from pydantic import BeforeValidator, model_validator
from pydantic.dataclasses import dataclass

from bounce_env.scene.base import CONFIG, Box, Spec, union
from bounce_env.scene.checks import check_scene
from bounce_env.scene.elements import Ball, Element, Part, moves
from bounce_env.scene.errors import own_words_of_scenes
from bounce_env.scene.features import Feature, features_of
from bounce_env.scene.fields import (
    Allowed,
    PositiveOrNone,
    Share,
    Vector,
    ZeroOrPositive,
    instance_of,
    not_allowed,
)

_Ball = Annotated[Ball, Allowed("a Ball", instance_of(Ball))]
_Element = Annotated[Element, Allowed("a Wall, Bumper, Arc, Paddle, Flipper, Sensor or Field", instance_of(Element))]


def _tuple(value: object) -> tuple[object, ...]:
    if not isinstance(value, tuple | list):  # pydantic alone would take a set, which has no order
        raise not_allowed("a tuple or list of Wall, Bumper, Arc, Paddle, Flipper, Sensor and Field")
    return tuple(value)


@own_words_of_scenes
@dataclass(frozen=True, kw_only=True, config=CONFIG)
class Scene(Spec):
    """A table: gravity, the ball and the elements; docs/scenes.md has all of them with pictures.

    gravity: acceleration (x, y) in m/s^2. ball: what every ball in play is like. rest_speed: m/s, 0 or more;
    where gravity presses the ball on a surface, an approach slower than it is absorbed and the ball slides on
    without friction; at 0 friction stops it. max_speed: no bounce leaves the ball faster than this, m/s, > 0;
    None for no limit. It must be given if a bounce can add energy (a kick, or ball.b * element.b > 1), and
    exceed that of every part. drag: > 0 and at most 1; every ball's velocity is multiplied by it once at each
    instant at which a command is given.
    elements: their order counts, for it breaks the tie of bounces that are alike, and an element's index is
    its number in the ledger.

    Raises SceneError (a ValueError) that names field, value and what is allowed; what only
    the whole scene can show (names, sizes, speeds) is in `bounce_env.scene.checks`.
    """

    gravity: Vector = (0.0, -9.81)
    ball: _Ball = Ball()
    rest_speed: ZeroOrPositive = 0.0
    max_speed: PositiveOrNone = None
    drag: Share = 1.0
    elements: Annotated[tuple[_Element, ...], BeforeValidator(_tuple)] = ()

    @model_validator(mode="after")
    def _check(self) -> Self:
        check_scene(self.ball, dict(enumerate(self.elements)), self.max_speed)
        return self

    @property
    def parts(self) -> tuple[tuple[int, Part], ...]:
        """The elements that move, each with its index in `elements`, in their order."""
        return tuple((i, e) for i, e in enumerate(self.elements) if isinstance(e, Part) and moves(e))

    @property
    def features(self) -> frozenset[Feature]:
        """The features that a world of this scene is compiled with; all others are left out of its kernels."""
        return features_of(self.gravity, self.ball.radius, self.drag, self.elements)

    @property
    def bounds(self) -> Box:
        """x_min, y_min, x_max, y_max in metres of all that the elements occupy; zeros if there are none."""
        return union(element.bounds for element in self.elements)
