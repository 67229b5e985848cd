"""Players that learn nothing: the opponents that a trained agent has to beat."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from agents import paddle_players, pinball_players, walls_players
from agents.look_ahead import LookAhead
from agents.task import Player, Task


def random(task: Task) -> Player:
    """Any action, each as likely; the same ones for each new player."""
    space = task.action_space
    generator = np.random.default_rng(0)

    def act(observations: npt.NDArray[np.float32]) -> npt.NDArray[Any]:
        match space:
            case gym.spaces.Discrete():
                return generator.integers(space.n, size=len(observations))
            case gym.spaces.MultiBinary():
                return generator.integers(2, size=(len(observations), *space.shape), dtype=np.int8)
        return generator.uniform(space.low, space.high, (len(observations), *space.shape)).astype(np.float32)

    return act


BASELINES: dict[str, dict[str, Callable[[Task], Player | LookAhead]]] = {
    "Bounce/Paddle-v0": {
        "random": random,
        "nothing": paddle_players.nothing,
        "follow": paddle_players.follow,
        "predictor": paddle_players.predictor,
        "look_ahead": paddle_players.look_ahead,
    },
    "Bounce/Pinball-v0": {
        "random": random,
        "nothing": pinball_players.nothing,
        "hold": pinball_players.hold,
        "flail": pinball_players.flail,
        "timed": pinball_players.timed,
        "look_ahead": pinball_players.look_ahead,
    },
    "Bounce/Walls-v0": {
        "random": random,
        "nothing": walls_players.nothing,
        "guide": walls_players.guide,
        "look_ahead": walls_players.look_ahead,
    },
}
"""By environment and name."""


def quick_baselines(env_id: str) -> dict[str, Callable[[Task], Player | LookAhead]]:
    """Those that play hundreds of episodes in seconds: all but the one that looks ahead."""
    return {name: baseline for name, baseline in BASELINES[env_id].items() if name != "look_ahead"}
