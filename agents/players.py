"""Players by name: a run folder's trained agent, or a baseline."""

from pathlib import Path

from stable_baselines3 import PPO

from agents.baselines import BASELINES, Player
from agents.command import Refused
from agents.runs import open_run
from agents.task import Task


def trained(model: PPO, *, sampled: bool = False) -> Player:
    """A model that plays its best action (argmax), or samples one as it did in training."""
    return lambda observations: model.predict(observations, deterministic=not sampled)[0]
