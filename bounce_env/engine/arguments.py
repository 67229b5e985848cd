"""What worlds are handed, checked: times, and what a command says."""

from typing import Any

import numpy as np
import numpy.typing as npt

from bounce_env.scene import Flipper, Paddle, Part, Scene, Wall
from bounce_env.wording import nearest, numbers, shown

Floats = npt.NDArray[np.float64]

LARGEST = 1e15
"""No number that a world is handed is larger [m, m/s, s]: products of a few stay far from overflow in float64."""

MAX_BALLS = 64
MAX_EVENTS = 1_000_000
MOST_EVENTS = 2**62

SECONDS = f"finite and >= 0, at most {LARGEST:g}"
"""What a duration must be, in words."""


def pushed(change: Any, worlds: tuple[int, ...] = ()) -> Floats:
    """Return what is added to velocities [m/s], of shape `worlds` + (2,); one of shape (2,) is that of all worlds.

    Raises ValueError for NaN, infinity and more than 1e15 either way.
    """
    rows, shape = numbers(change), (*worlds, 2)
    if rows is None or rows.shape not in (shape, (2,)) or not (abs(rows) <= LARGEST).all():
        each = f", or one of them for each of {worlds[0]} worlds" if worlds else ""
        raise ValueError(f"push = {shown(change)}: must be (dvx, dvy), finite, at most {LARGEST:g} m/s{each}")
    return np.array(np.broadcast_to(rows, shape))


def commanded_part(scene: Scene, name: object) -> int:
    """Return the index of the part `name` among the scene's parts; ValueError for a name that no part has."""
    names = {part.name: m for m, (_, part) in enumerate(scene.parts) if part.name}
    if not isinstance(name, str) or name not in names:
        hint = nearest(name, names)
        raise ValueError(f"command: {shown(name)} must be one of the scene's parts: {sorted(names)}{hint}")
    return names[name]


def commanded_velocities(part: Part, value: Any, max_speed: float | None, worlds: tuple[int, ...] = ()) -> Floats:
    """Return the velocity that `value` stands for, of shape `worlds`; of a draggable wall `worlds` + (2, 2), its ends.

    One value is that of all worlds. [m/s]; of a flipper [rad/s]. Raises ValueError for what the part cannot do.
    """
    if isinstance(part, Flipper):
        return _flipper_velocities(part, value, worlds)
    rows = numbers(value)
    shape = (*worlds, 2, 2) if isinstance(part, Wall) else worlds
    fits = rows is not None and rows.shape in (shape, shape[len(worlds) :])
    each = f", or one of them for each of {worlds[0]} worlds" if worlds else ""
    if isinstance(part, Wall):
        limit = LARGEST if max_speed is None else max_speed
        if rows is None or not fits or not (np.hypot(rows[..., 0], rows[..., 1]) < limit).all():
            whose = "" if max_speed is None else "the scene's max_speed, "
            words = f"((vx, vy), (vx, vy)), finite, each slower than {whose}{limit!r} m/s"
            raise ValueError(f"command {part.name!r} = {shown(value)}: must be {words}{each}")
    else:
        fastest = part.max_speed if isinstance(part, Paddle) else part.speed
        if rows is None or not fits or not (abs(rows) <= fastest).all():  # also of NaN
            words = f"finite and at most {fastest!r} m/s either way{each}"
            raise ValueError(f"command {part.name!r} = {shown(value)}: must be {words}")
    return np.array(np.broadcast_to(rows, shape))


def _flipper_velocities(part: Flipper, value: Any, worlds: tuple[int, ...]) -> Floats:
    pressed = np.asarray(value)
    if pressed.dtype != np.bool_ or pressed.shape not in (worlds, ()):
        each = f", or one of them for each of {worlds[0]} worlds" if worlds else ""
        words = f"True (pressed) or False (released){each}"
        raise ValueError(f"command {part.name!r} = {shown(value)}: must be {words}")
    return np.broadcast_to(np.where(pressed, part.up_speed, -part.down_speed), worlds).astype(np.float64)
