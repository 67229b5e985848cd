"""The cards of the games, which are the docstrings of their classes, under the name that older specs have."""

from bounce_env.envs import PaddleEnv, PinballEnv, WallsEnv

__all__ = ["PaddleEnv", "PinballEnv", "WallsEnv"]
