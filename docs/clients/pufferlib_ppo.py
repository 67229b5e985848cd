"""PPO with pufferlib-core's environments, policies and sampling; its own trainer, PuffeRL, needs CUDA."""

import time
from typing import Any

import gymnasium as gym
import numpy as np
import pufferlib
import pufferlib.vector
import torch
from held_out import held_out_score
from pufferlib.models import Default
from pufferlib.pytorch import layer_init, sample_logits


class BouncePuffer(pufferlib.PufferEnv):
    """A batch of worlds as a native PufferEnv: it resets within the step, as SAME_STEP does."""

    def __init__(self, env_id: str, num_envs: int, buf: Any = None, **keywords: Any) -> None:
        self.envs = gym.make_vec(
            env_id, num_envs=num_envs, vectorization_mode="vector_entry_point", autoreset_mode="SAME_STEP",
            info="none", copy=False, **keywords,
        )  # fmt: skip
        self.single_observation_space = self.envs.single_observation_space
        self.single_action_space = self.envs.single_action_space
        self.num_agents = num_envs
        super().__init__(buf)
        self.seconds = 0.0

    def reset(self, seed: int | None = None) -> tuple[np.ndarray, list[Any]]:
        """Begin an episode in each world."""
        self.observations[:], _ = self.envs.reset(seed=seed)
        return self.observations, []

    def step(self, actions: np.ndarray) -> tuple[Any, ...]:
        """One step of every world."""
        began = time.perf_counter()
        self.observations[:], self.rewards[:], self.terminals[:], self.truncations[:], _ = self.envs.step(actions)
        self.seconds += time.perf_counter() - began
        return self.observations, self.rewards, self.terminals, self.truncations, []

    def close(self) -> None:
        """End the batch."""
        self.envs.close()


class Policy(Default):
    """Pufferlib's default policy with two hidden layers; its one does not get beyond a score of 16 here."""

    def __init__(self, env: Any, hidden_size: int = 64) -> None:
        super().__init__(env, hidden_size)
        layers = (layer_init(torch.nn.Linear(n, hidden_size)) for n in (5, hidden_size))
        self.encoder = torch.nn.Sequential(next(layers), torch.nn.ReLU(), next(layers), torch.nn.ReLU())


if __name__ == "__main__":
    WORLDS, STEPS, UPDATES, EPOCHS, MINIBATCH, RATE = 256, 128, 45, 4, 2048, 2e-3
    GAMMA, LAMBDA = 0.99, 0.95
    torch.set_num_threads(1)
    torch.manual_seed(0)
    envs = pufferlib.vector.make(
        BouncePuffer, env_args=["bounce_env:Bounce/Paddle-v0", WORLDS], backend=pufferlib.vector.PufferEnv
    )
    policy = Policy(envs)
    optimizer = torch.optim.Adam(policy.parameters(), lr=RATE, eps=1e-5)
    seen, did = torch.zeros(STEPS, WORLDS, 5), torch.zeros(STEPS, WORLDS, 1)
    log_probs, values, rewards, ends = (torch.zeros(STEPS + 1, WORLDS) for _ in range(4))

    envs.async_reset(2**31)
    began = time.perf_counter()
    for update in range(UPDATES):
        optimizer.param_groups[0]["lr"] = RATE * (1.0 - update / UPDATES)
        for t in range(STEPS + 1):
            observation, reward, terminal, truncation, *_ = envs.recv()
            rewards[t], ends[t] = torch.as_tensor(reward), torch.as_tensor(terminal | truncation)
            with torch.no_grad():
                distribution, value = policy.forward_eval(torch.as_tensor(observation))
                action, log_prob, _ = sample_logits(distribution)
            values[t], log_probs[t] = value[:, 0], log_prob
            if t < STEPS:  # the last one is looked at, and handed over again at the next update
                seen[t], did[t] = torch.as_tensor(observation), action
                envs.send(action.numpy())
        advantages, sum_so_far = torch.zeros(STEPS, WORLDS), torch.zeros(WORLDS)
        for t in reversed(range(STEPS)):  # rewards[t + 1] and ends[t + 1] are of the step that follows seen[t]
            goes_on = 1.0 - ends[t + 1]
            error = rewards[t + 1] + GAMMA * values[t + 1] * goes_on - values[t]
            advantages[t] = sum_so_far = error + GAMMA * LAMBDA * goes_on * sum_so_far
        returns = advantages + values[:STEPS]
        flat = [x.flatten(0, 1) for x in (seen, did, log_probs[:STEPS], advantages, returns)]
        for _ in range(EPOCHS):
            for some in torch.randperm(STEPS * WORLDS).split(MINIBATCH):
                o, a, old, advantage, target = (x[some] for x in flat)
                advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
                distribution, value = policy(o)
                _, log_prob, _ = sample_logits(distribution, action=a)
                ratio = (log_prob - old).exp()
                gain = torch.min(ratio * advantage, ratio.clamp(0.8, 1.2) * advantage).mean()
                loss = 0.5 * (value[:, 0] - target).square().mean() - gain
                optimizer.zero_grad()
                loss.backward()
                torch.nn.utils.clip_grad_norm_(policy.parameters(), 0.5)
                optimizer.step()
    seconds = time.perf_counter() - began
    print(f"{WORLDS * STEPS * UPDATES:,} steps in {seconds:.0f} s, {envs.seconds:.1f} s of it in the environment")

    def act(observations: Any) -> Any:
        """The middle of the distribution, as the batch clips it."""
        with torch.no_grad():
            distribution, _ = policy.forward_eval(torch.as_tensor(observations))
        return distribution.mean.numpy()

    mean, half = held_out_score(act)
    print(f"held-out score {mean:.1f} +- {half:.1f}")
    assert mean - half > 23.6, "worse than the best scripted player"
