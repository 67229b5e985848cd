"""Tables with one flaw each, all with the features of the built-in paddle scene: one kernel follows balls in all."""

from bounce_env.scene import Ball, Bumper, Element, Paddle, Scene, Sensor, Wall

DEAD = {"b": 0.5, "f": 0.5}  # a ball soon rests on it


def table(*flaw: Element) -> Scene:
    """A field of 1 x 1.4 m with a paddle, a drain and a bumper, and what is wrong with it."""
    sides = (Wall((0.0, -0.1), (0.0, 1.4)), Wall((1.0, -0.1), (1.0, 1.4)), Wall((0.0, 1.4), (1.0, 1.4)))
    paddle = Paddle((0.2, 0.08), (0.8, 0.08), half_width=0.08, radius=0.012, max_speed=1.5, b=0.9, kick=1.0)
    drain = Sensor((-0.05, -0.03), (1.05, -0.03), drain=True, name="drain")
    elements = (*sides, Bumper((0.5, 1.1), 0.06, name="bumper"), paddle, *flaw, drain)
    return Scene(gravity=(0.0, -1.5), max_speed=3.0, elements=elements, ball=Ball(radius=0.02))


def box(left: float, bottom: float, right: float, top: float) -> tuple[Wall, ...]:
    """Four walls around a room."""
    corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
    return tuple(Wall(corners[i], corners[(i + 1) % 4]) for i in range(4))


SOUND = table()
CUP = table(
    *(Wall(a, b, **DEAD) for a, b in (((0.3, 0.75), (0.3, 0.6)), ((0.3, 0.6), (0.4, 0.6)), ((0.4, 0.6), (0.4, 0.75))))
)
"""A cup in which a ball comes to rest."""

POCKET = table(
    *box(0.3, 0.5, 0.7, 0.7),
    Bumper((0.36, 0.6), 0.06, b=1.5, name="west"),
    Bumper((0.64, 0.6), 0.06, b=1.5, name="east"),
)
"""Two bumpers that face each other in a room that no ball leaves."""

WALLED_IN = table(*box(0.4, 0.5, 0.6, 0.7), Bumper((0.5, 0.6), 0.09, name="target"))
"""A target with walls around it, nearer to it than a ball is wide."""
