"""A player that tries out plans on copies of the worlds that it plays, and does what pays most."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from agents.task import Player, Task
from bounce_env.games.state_copy import States


class LookAhead:
    """Before every step each of `plans` (plans, steps, *action shape) is played to its end on a copy of each world.

    The first action of the plan with the highest sum of rewards is done; of plans that pay alike, the first.
    """

    def __init__(self, task: Task, plans: npt.NDArray[Any]) -> None:
        self.task = task
        self.plans = plans
        self._envs: Any = None
        self._worlds = 0

    def plan(self, states: States) -> npt.NDArray[Any]:
        """Return the next actions, (n, *action shape), for n worlds."""
        worlds, plans = len(states), len(self.plans)
        if worlds != self._worlds:
            self._envs, self._worlds = self.task.batch(worlds * plans).unwrapped, worlds
        self._envs.restore_state(states[np.repeat(np.arange(worlds), plans)])
        returns = np.zeros(worlds * plans)
        playing = np.ones(worlds * plans, np.bool_)
        for step in range(self.plans.shape[1]):
            actions = np.tile(self.plans[:, step], (worlds, *[1] * (self.plans.ndim - 2)))
            _, rewards, terminated, truncated, _ = self._envs.step(actions)
            returns += np.where(playing, rewards, 0.0)
            playing &= ~(terminated | truncated)
            if not playing.any():
                break
        best = returns.reshape(worlds, plans).argmax(axis=1)
        return self.plans[best, 0]


def act(
    player: Player | LookAhead, observations: npt.NDArray[np.float32], states: Callable[[], States]
) -> npt.NDArray[Any]:
    """Return the player's actions, (n, *action shape), for n worlds: what they show, and a way to get their states."""
    return player.plan(states()) if isinstance(player, LookAhead) else player(observations)
