"""The vector environments under the name that older specs have."""

from bounce_env.envs import BounceVectorEnv, PaddleVectorEnv, PinballVectorEnv, WallsVectorEnv

__all__ = ["BounceVectorEnv", "PaddleVectorEnv", "PinballVectorEnv", "WallsVectorEnv"]
