"""What a kernel looks up, where a scene may have none of it."""

from bounce_env.engine.compile.jit import Feature, Record, Table, function, function_of_feature
from bounce_env.engine.memory.records import RIDING


@function
def is_off(disabled: Table, w: int, element: int) -> bool:
    """Whether an element of world `w` is switched off."""
    if disabled is None:
        return False
    return disabled[w, element] != 0


@function
def turn_of(turns: Table, scene: int, m: int) -> int:
    """Which way part `m` turns, 1 or -1; 0 where it slides or is dragged."""
    if turns is None:
        return 0
    return turns[scene, m]


@function
def side_of_part(sides: Table, w: int, k: int, m: int) -> int:
    """On which side, 1 or -1, of dragged wall `m` a touching ball of no radius is; 0 for a disc and other parts."""
    if sides is None:
        return 0
    return sides[w, k, m]


@function
def side_on(sides: Table, w: int, k: int, i: int) -> int:
    """On which side, 1 or -1, of surface `i` a touching ball of no radius is; 0 for a disc, whose centre tells."""
    if sides is None:
        return 0
    return sides[w, k, i]


@function
def is_gate(gates: Table, scene: int, i: int) -> bool:
    """Whether face `i` is that of a one-way wall, which is struck from the left only."""
    if gates is None:
        return False
    return gates[scene, i] != 0


@function
def is_sliding(ball: Record) -> bool:
    """Whether a ball slides on a wall or on the straight side of a part."""
    return ball.contact >= 0 or ball.contact == RIDING


def _no_pull(gravity: Table, ball: Record) -> tuple[None, None]:
    return None, None


@function_of_feature(absent=_no_pull)
def pull(gravity: Table, ball: Record) -> tuple[Feature, Feature]:
    """The acceleration [m/s^2] of the ball's present flight; (None, None) where no scene of the batch has any."""
    return ball.ax, ball.ay


def _no_ends(ends: Table, w: int, m: int) -> None:
    return None


@function_of_feature(absent=_no_ends)
def ends_of(ends: Table, w: int, m: int) -> Record:
    """The record of the ends of part `m`; None where nothing is dragged in any scene."""
    return ends[w, m]


@function
def is_dragged(ends: Record, part: Record) -> bool:
    """Whether a part is a wall that is dragged by its ends."""
    if ends is None:
        return False
    return part.span == 0.0
