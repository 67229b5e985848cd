"""Stable-Baselines3's algorithms by name, and what a config may say of each: RL Zoo's keys with SB3's defaults."""

import ast
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

from pydantic import BeforeValidator, Field, field_serializer, model_validator
from stable_baselines3 import DQN, PPO, SAC
from stable_baselines3.common.utils import LinearSchedule
from torch import nn

from agents.config import Count, Flag, Layers, NotNegative, Number, Positive, Schedule, Share, Strict

Model: TypeAlias = PPO | DQN | SAC


class Hyperparameters(Strict):
    """What all algorithms have in common. `n_timesteps` must be given."""

    algorithm: ClassVar[type[Model]]
    schedules: ClassVar[tuple[str, ...]] = ("learning_rate",)

    n_timesteps: Count
    n_envs: Count = 1
    env_kwargs: dict[str, Any] = Field(default={})
    policy: Literal["MlpPolicy"] = "MlpPolicy"
    gamma: Share = 0.99

    def for_sb3(self) -> dict[str, Any]:
        """Keyword arguments of the algorithm, beside the environment."""
        kwargs = self.model_dump(exclude={"n_timesteps", "n_envs", "env_kwargs"})
        return kwargs | {key: as_schedule(kwargs[key]) for key in self.schedules}


def from_text(value: Any) -> Any:
    """Return the mapping that RL Zoo's text "dict(net_arch=[64], activation_fn=nn.ReLU)" means; another value as it is.

    Nothing is evaluated: values must be literals, or names such as nn.ReLU, which stay text.
    """
    try:
        call = ast.parse(value, mode="eval").body
        if not isinstance(call, ast.Call) or ast.unparse(call.func) != "dict" or call.args:
            return value
        names = {k.arg: ast.unparse(k.value) for k in call.keywords if isinstance(k.value, ast.Attribute)}
        return {k.arg: names.get(k.arg) or ast.literal_eval(k.value) for k in call.keywords}
    except (TypeError, SyntaxError, ValueError):
        return value


class PPOPolicyKwargs(Strict):
    """The network; what SB3's MlpPolicy takes. `net_arch`: units of the hidden layers."""

    activation_fn: Literal["nn.Tanh", "nn.ReLU"] = "nn.Tanh"
    net_arch: Layers = Field(default=[64, 64])
    log_std_init: Number = 0.0
    ortho_init: Flag = True


class PPOHyperparameters(Hyperparameters):
    """Proximal policy optimisation."""

    algorithm = PPO
    schedules = ("learning_rate", "clip_range", "clip_range_vf")

    policy_kwargs: Annotated[PPOPolicyKwargs, BeforeValidator(from_text)] = PPOPolicyKwargs()
    n_steps: Count = 2048
    batch_size: Count = 64
    n_epochs: Count = 10
    learning_rate: Schedule = 3e-4
    clip_range: Schedule = 0.2
    clip_range_vf: Schedule | None = None
    gae_lambda: Share = 0.95
    normalize_advantage: Flag = True
    ent_coef: NotNegative = 0.0
    vf_coef: NotNegative = 0.5
    max_grad_norm: Positive = 0.5
    use_sde: Flag = False
    target_kl: Positive | None = None

    @model_validator(mode="after")
    def _batches_are_whole(self) -> "PPOHyperparameters":
        if (self.n_envs * self.n_steps) % self.batch_size:
            raise ValueError(f"batch_size must divide n_envs * n_steps = {self.n_envs * self.n_steps}")
        return self

    @field_serializer("policy_kwargs")
    def _as_text(self, kwargs: PPOPolicyKwargs) -> str:
        """As RL Zoo reads it, which takes a class in no other way."""
        words = {name: value if name == "activation_fn" else repr(value) for name, value in kwargs}
        return f"dict({', '.join(f'{name}={word}' for name, word in words.items())})"

    def for_sb3(self) -> dict[str, Any]:
        """See `Hyperparameters`."""
        activation = getattr(nn, self.policy_kwargs.activation_fn.removeprefix("nn."))
        return super().for_sb3() | {"policy_kwargs": self.policy_kwargs.model_dump() | {"activation_fn": activation}}


class DQNPolicyKwargs(Strict):
    """The network. `net_arch`: units of the hidden layers."""

    net_arch: Layers = Field(default=[64, 64])


class OffPolicy(Hyperparameters):
    """What algorithms have in common that learn from a replay buffer."""

    buffer_size: Count = 1_000_000
    learning_starts: Count = 100
    gradient_steps: Count = 1
    n_steps: Count = 1


class DQNHyperparameters(OffPolicy):
    """Deep Q-network; for games with a discrete action."""

    algorithm = DQN

    policy_kwargs: DQNPolicyKwargs = DQNPolicyKwargs()
    learning_rate: Schedule = 1e-4
    batch_size: Count = 32
    tau: Share = 1.0
    train_freq: Count = 4
    target_update_interval: Count = 10_000
    exploration_fraction: Share = 0.1
    exploration_initial_eps: Share = 1.0
    exploration_final_eps: Share = 0.05
    max_grad_norm: Positive = 10.0


class SACPolicyKwargs(Strict):
    """The networks. `net_arch`: units of the hidden layers."""

    net_arch: Layers = Field(default=[256, 256])


class SACHyperparameters(OffPolicy):
    """Soft actor-critic; for games with a continuous action."""

    algorithm = SAC

    policy_kwargs: SACPolicyKwargs = SACPolicyKwargs()
    learning_rate: Schedule = 3e-4
    batch_size: Count = 256
    tau: Share = 0.005
    train_freq: Count = 1
    target_update_interval: Count = 1


def as_schedule(value: float | str | None) -> float | LinearSchedule | None:
    """Return what SB3 takes for a config's number or "lin_NUMBER"."""
    if isinstance(value, str):
        return LinearSchedule(float(value.removeprefix("lin_")), 0.0, 1.0)
    return value


ALGORITHMS: dict[str, type[Hyperparameters]] = {
    "ppo": PPOHyperparameters,
    "dqn": DQNHyperparameters,
    "sac": SACHyperparameters,
}
"""By the RL Zoo's names."""

Algorithm: TypeAlias = Literal["ppo", "dqn", "sac"]
