"""From the keys that a person holds to an action: one table and one function, without a window.

Keys have pygame's names (`pygame.key.name`).
"""

from collections.abc import Callable, Set
from dataclasses import dataclass
from typing import Any

import numpy as np
from gymnasium import spaces

# Two hands; what has one joystick only takes both for one.
LEFT_HAND = {"a": (-1, 0), "d": (1, 0), "s": (0, -1), "w": (0, 1), "left shift": (-1, 0), "right shift": (1, 0)}
RIGHT_HAND = {"left": (-1, 0), "right": (1, 0), "down": (0, -1), "up": (0, 1)}

NUDGES = {"z": 0, "x": 1}
"""Keys that shove the table: to the left and to the right."""

PAUSE, RESTART, FILM = "p", "r", "v"
QUIT = ("escape", "q")

MOVES, FLIPS, DRAGS = "Arrows, A D: move", "Arrows, A D, Shift: flippers", "A D W S, arrows: the two ends"
NUDGING = f"{FLIPS}    Z X: nudge"


@dataclass(frozen=True)
class Controls:
    """How a game is played with keys: `action` of the keys that are held, and `words` on which keys do what."""

    action: Callable[[Set[str]], Any]
    words: str


def controls_for(space: spaces.Space[Any]) -> Controls:
    """Return the controls for an action space; actions are of that space.

    Discrete(3): left, stay, right. Discrete(4): nothing, left, right, both flippers; Discrete(6): and nudges to the
    left and right, in place of these. MultiBinary(2): left and right flipper; MultiBinary(4): and nudges. Box of 1 or 2
    numbers: along x, or x and y, at full speed; of 4: the first end by A, D, W, S, the second by the arrow keys. Keys
    of opposite ways cancel, but press both flippers. Raises ValueError for any other space.
    """
    match space:
        case spaces.Discrete(n=3, start=0):
            return Controls(lambda held: 1 + _way(held)[0], MOVES)
        case spaces.Discrete(n=4, start=0):
            return Controls(lambda held: int(_pressed(held) @ (1, 2)), FLIPS)
        case spaces.Discrete(n=6, start=0):
            return Controls(lambda held: _nudged(held) or int(_pressed(held) @ (1, 2)), NUDGING)
        case spaces.MultiBinary(shape=(4,)):
            return Controls(
                lambda held: np.array([*_pressed(held), *(key in held for key in NUDGES)], np.int8), NUDGING
            )
        case spaces.MultiBinary(shape=(2,)):
            return Controls(lambda held: _pressed(held).astype(np.int8), FLIPS)
        case spaces.Box(shape=(1,) | (2,) as shape):
            return Controls(lambda held: _full_speed(space, _way(held)[: shape[0]]), MOVES)
        case spaces.Box(shape=(4,)):
            return Controls(lambda held: _full_speed(space, _sum(LEFT_HAND, held) + _sum(RIGHT_HAND, held)), DRAGS)
    raise ValueError(
        f"action_space = {space}: must be Discrete(3), Discrete(4), MultiBinary(2) or a Box of 1, 2 or 4 numbers, or "
        "with nudges Discrete(6) or MultiBinary(4), to be played with keys"
    )


def _sum(hand: dict[str, tuple[int, int]], held: Set[str]) -> tuple[int, int]:
    """Return which way the keys of a hand point: -1, 0 or 1 along x and y."""
    ways = [(0, 0), *(way for key, way in hand.items() if key in held)]
    return _sign(sum(x for x, _ in ways)), _sign(sum(y for _, y in ways))


def _way(held: Set[str]) -> tuple[int, int]:
    return _sum(LEFT_HAND | RIGHT_HAND, held)


def _pressed(held: Set[str]) -> Any:
    """Return whether the left and the right flipper are pressed, 0 or 1 each."""
    ways = {way for key, (way, _) in (LEFT_HAND | RIGHT_HAND).items() if key in held}
    return np.array([-1 in ways, 1 in ways], np.int64)


def _nudged(held: Set[str]) -> int:
    """Return the action of a nudge, 4 or 5; 0 for none."""
    return next((4 + side for key, side in NUDGES.items() if key in held), 0)


def _full_speed(space: spaces.Box, ways: tuple[int, ...]) -> Any:
    signs = np.array(ways)
    return np.where(signs > 0, space.high, np.where(signs < 0, space.low, 0.0)).astype(space.dtype)


def _sign(number: int) -> int:
    return (number > 0) - (number < 0)
