"""PPO by TorchRL on the native vector environment, which its GymWrapper takes in mode SAME_STEP or DISABLED."""

import time

import gymnasium as gym
import torch
from held_out import held_out_score
from tensordict.nn import NormalParamExtractor, TensorDictModule
from torch import nn
from torchrl.collectors import Collector
from torchrl.envs.libs.gym import GymWrapper
from torchrl.modules import MLP, ProbabilisticActor, TanhNormal, ValueOperator
from torchrl.objectives import ClipPPOLoss
from torchrl.objectives.value import GAE

WORLDS, STEPS, UPDATES, EPOCHS, MINIBATCH, RATE = 256, 128, 45, 4, 2048, 2e-3

torch.set_num_threads(1)
torch.manual_seed(0)
envs = gym.make_vec(
    "bounce_env:Bounce/Paddle-v0", num_envs=WORLDS, vectorization_mode="vector_entry_point",
    autoreset_mode="SAME_STEP", info="none",
)  # fmt: skip
envs.reset(seed=2**32)
env = GymWrapper(envs)

hidden = {"num_cells": [64, 64], "activation_class": nn.ReLU}
network = nn.Sequential(MLP(in_features=5, out_features=2, **hidden), NormalParamExtractor())
actor = ProbabilisticActor(
    TensorDictModule(network, in_keys=["observation"], out_keys=["loc", "scale"]),
    in_keys=["loc", "scale"],
    distribution_class=TanhNormal,
    return_log_prob=True,
)
critic = ValueOperator(MLP(in_features=5, out_features=1, **hidden), in_keys=["observation"])
advantage = GAE(gamma=0.99, lmbda=0.95, value_network=critic, average_gae=True)
loss_of = ClipPPOLoss(actor, critic, clip_epsilon=0.2, entropy_coeff=0.0, critic_coeff=0.5, normalize_advantage=True)
optimizer = torch.optim.Adam(loss_of.parameters(), lr=RATE, eps=1e-5)
collector = Collector(env, actor, frames_per_batch=WORLDS * STEPS, total_frames=WORLDS * STEPS * UPDATES)

began, learning = time.perf_counter(), 0.0
for update, batch in enumerate(collector):
    clock = time.perf_counter()
    optimizer.param_groups[0]["lr"] = RATE * (1.0 - update / UPDATES)
    with torch.no_grad():
        advantage(batch)
    rows = batch.reshape(-1)
    for _ in range(EPOCHS):
        for some in torch.randperm(len(rows)).split(MINIBATCH):
            losses = loss_of(rows[some])
            optimizer.zero_grad()
            (losses["loss_objective"] + losses["loss_critic"]).backward()
            nn.utils.clip_grad_norm_(loss_of.parameters(), 0.5)
            optimizer.step()
    learning += time.perf_counter() - clock
seconds = time.perf_counter() - began
collector.shutdown()
print(f"{WORLDS * STEPS * UPDATES:,} steps in {seconds:.0f} s, of which collecting {seconds - learning:.0f} s")


def act(observations):
    """The middle of the distribution."""
    with torch.no_grad():
        loc, _ = network(torch.as_tensor(observations))
    return torch.tanh(loc).numpy()


mean, half = held_out_score(act)
print(f"held-out score {mean:.1f} +- {half:.1f}")
assert mean - half > 23.6, "worse than the best scripted player"
