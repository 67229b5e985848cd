"""The same motion in one call, and in many pieces, each from a snapshot of the one before."""

from collections.abc import Callable

from bounce_env import World


def assert_same_in_pieces(new: Callable[[], World], seconds: float, pieces: int = 256) -> None:
    """Fail if a world played in one call differs by a bit from one that is played in pieces and restored after each."""
    whole, cut = new(), new()
    whole.advance(seconds)
    for _ in range(pieces):
        cut.advance(seconds / pieces)
        cut.restore(cut.snapshot())
    assert cut.position.tobytes() == whole.position.tobytes()
    assert cut.velocity.tobytes() == whole.velocity.tobytes()
