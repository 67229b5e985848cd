"""What of a scene an agent can reach, and what of it scores."""

from dataclasses import replace

from bounce_env.scene import Box, Bumper, Element, Field, Flipper, Paddle, Scene, Sensor, Wall

SCORING_NAMES = ("target", "rollover", "slingshot")
"""What an element's name begins with that a game pays points for, whatever it is."""


def is_agents(element: Element) -> bool:
    """Return whether an agent moves it; a bumper on a rail moves by itself."""
    return isinstance(element, Paddle | Flipper) or (isinstance(element, Wall) and element.draggable)


def scores(element: Element) -> bool:
    """Whether a game may pay points for it: bumpers, what kicks, sensors but for drains, and what is named so."""
    if is_agents(element) or isinstance(element, Field):
        return False
    if isinstance(element, Sensor):
        return not element.drain
    return isinstance(element, Bumper) or element.kick > 0.0 or element.name.startswith(SCORING_NAMES)


def reach_boxes(scene: Scene) -> tuple[Box, ...]:
    """Return where an agent can meet a ball's centre: x_min, y_min, x_max, y_max [m] for each part that it moves.

    The box around all that the part can sweep, wider by the ball's diameter, as far as it lies in the scene's bounds.
    """
    return tuple(_box_of(element, scene) for element in scene.elements if is_agents(element))


def _box_of(part: Element, scene: Scene) -> Box:
    left, bottom, right, top = scene.bounds
    if isinstance(part, Wall) and part.reach is None:
        return scene.bounds  # its ends may be dragged all over the scene
    margin = 2.0 * scene.ball.radius
    x0, y0, x1, y1 = part.bounds
    # Inside of the bounds: they set the scale of round-off, and with it the last bits of the motion.
    return max(x0 - margin, left), max(y0 - margin, bottom), min(x1 + margin, right), min(y1 + margin, top)


def with_borders(scene: Scene) -> Scene:
    """Return the scene with a sensor along each side of each of `reach_boxes`, after its own elements.

    No bit of the motion changes; that a ball comes within reach becomes an event.
    """
    return replace(scene, elements=(*scene.elements, *(side for box in reach_boxes(scene) for side in _sides(box))))


def _sides(box: Box) -> tuple[Sensor, ...]:
    x0, y0, x1, y1 = box
    corners = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    return tuple(Sensor(corners[i], corners[(i + 1) % 4]) for i in range(4))
