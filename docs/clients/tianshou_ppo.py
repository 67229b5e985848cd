"""PPO by Tianshou on the native vector environment, through an adapter of its BaseVectorEnv."""

import time
from typing import Any

import gymnasium as gym
import numpy as np
import torch
from held_out import held_out_score
from tianshou.algorithm import PPO
from tianshou.algorithm.modelfree.reinforce import ProbabilisticActorPolicy
from tianshou.algorithm.optim import AdamOptimizerFactory, LRSchedulerFactoryLinear
from tianshou.data import Collector, VectorReplayBuffer
from tianshou.env import BaseVectorEnv
from tianshou.trainer import OnPolicyTrainerParams
from tianshou.utils.net.common import Net
from tianshou.utils.net.continuous import ContinuousActorProbabilistic, ContinuousCritic
from torch.distributions import Independent, Normal


class BounceVenv(BaseVectorEnv):
    """Tianshou's face of a batch of worlds: no worker, and no Python object, for each of them.

    Tianshou resets worlds itself, so the batch is in mode DISABLED. All worlds are stepped at once: collect by steps
    (`n_step`), not by episodes.
    """

    def __init__(self, env_id: str, num_envs: int, **keywords: Any) -> None:
        self.envs = gym.make_vec(
            env_id, num_envs=num_envs, vectorization_mode="vector_entry_point", autoreset_mode="DISABLED",
            info="none", **keywords,
        )  # fmt: skip
        self.env_num, self.is_async, self.is_closed = num_envs, False, False
        self.waiting_id: list[int] = []
        self.infos = np.array([{"env_id": world} for world in range(num_envs)])
        self.first_seed: int | None = None
        self.seconds = 0.0  # in steps

    def reset(self, env_id: Any = None, **kwargs: Any) -> tuple[np.ndarray, np.ndarray]:
        """Reset some worlds, or all; returns their first observations."""
        ids = np.arange(self.env_num) if env_id is None else np.atleast_1d(env_id)
        mask = np.zeros(self.env_num, bool)
        mask[ids] = True
        seed, self.first_seed = self.first_seed, None
        observations, _ = self.envs.reset(seed=seed, options={"reset_mask": mask})
        return observations[ids], self.infos[ids]

    def step(self, action: Any, id: Any = None) -> tuple[np.ndarray, ...]:
        """One step of all worlds."""
        if id is not None and len(id) != self.env_num:
            raise ValueError(f"id: must be all {self.env_num} worlds, collect by n_step")
        began = time.perf_counter()
        observations, rewards, terminated, truncated, _ = self.envs.step(np.asarray(action))
        self.seconds += time.perf_counter() - began
        return observations, rewards, terminated, truncated, self.infos

    def seed(self, seed: Any = None) -> list[Any]:
        """Seed the next reset: world k by seed + k."""
        self.first_seed = seed
        return [seed] * self.env_num

    def get_env_attr(self, key: str, id: Any = None) -> list[Any]:
        """Return an attribute of each world; spaces and metadata are those of a single one."""
        value = getattr(self.envs, f"single_{key}" if key.endswith("_space") else key)
        return [value] * self.env_num

    def close(self) -> None:
        """End the batch."""
        self.envs.close()
        self.is_closed = True


if __name__ == "__main__":
    WORLDS, STEPS, UPDATES = 256, 128, 45
    torch.set_num_threads(1)
    torch.manual_seed(0)
    envs = BounceVenv("bounce_env:Bounce/Paddle-v0", WORLDS)
    envs.seed(2**32)
    space = envs.action_space[0]

    def body() -> Net:
        return Net(state_shape=5, hidden_sizes=(64, 64))

    actor = ContinuousActorProbabilistic(preprocess_net=body(), action_shape=1, unbounded=True)
    actor.sigma_param.data.zero_()
    policy = ProbabilisticActorPolicy(
        actor=actor,
        dist_fn=lambda of: Independent(Normal(*of), 1),
        action_space=space,
        action_scaling=False,
        action_bound_method="clip",
        deterministic_eval=True,
    )
    schedule = LRSchedulerFactoryLinear(UPDATES, WORLDS * STEPS, WORLDS * STEPS)
    algorithm = PPO(
        policy=policy,
        critic=ContinuousCritic(preprocess_net=body()),
        optim=AdamOptimizerFactory(lr=2e-3, eps=1e-5).with_lr_scheduler_factory(schedule),
        max_grad_norm=0.5,
        ent_coef=0.0,
        max_batchsize=8192,
    )
    collector = Collector(algorithm, envs, VectorReplayBuffer(WORLDS * STEPS, WORLDS))
    collector.reset()
    began = time.perf_counter()
    algorithm.run_training(
        OnPolicyTrainerParams(
            training_collector=collector,
            max_epochs=UPDATES,
            epoch_num_steps=WORLDS * STEPS,
            collection_step_num_env_steps=WORLDS * STEPS,
            update_step_num_repetitions=4,
            batch_size=2048,
            show_progress=False,
            verbose=False,
        )
    )
    seconds = time.perf_counter() - began
    print(f"{WORLDS * STEPS * UPDATES:,} steps in {seconds:.0f} s, {envs.seconds:.1f} s of it in the environment")

    def act(observations: Any) -> Any:
        """The middle of the distribution, as the batch clips it."""
        with torch.no_grad():
            (middle, _), _ = actor(torch.as_tensor(observations))
        return middle.numpy()

    mean, half = held_out_score(act)
    print(f"held-out score {mean:.1f} +- {half:.1f}")
    assert mean - half > 23.6, "worse than the best scripted player"
