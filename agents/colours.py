"""One colour a player, the same in every picture of learning curves."""

COLOURS = {
    "ppo": "C0",
    "dqn": "C1",
    "sac": "C2",
    "nothing": "0.35",
    "random": "0.65",
    "follow": "C3",
    "predictor": "C4",
    "hold": "C5",
    "flail": "C6",
    "timed": "C8",
    "guide": "C9",
    "look_ahead": "k",
}
"""By the name of an algorithm or a baseline. A trained player has the colour of its algorithm."""


def colour_of(player: str, algo: str = "ppo") -> str:
    """Return the colour of a player: a baseline, an algorithm in any case, or `trained...` by `algo`."""
    return COLOURS[algo.lower() if player.startswith("trained") else player.lower()]
