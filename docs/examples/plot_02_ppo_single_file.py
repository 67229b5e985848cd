"""
PPO in a single file
====================

Proximal policy optimisation on Gymnasium's vector environment, with nothing but PyTorch: the place
to begin for an algorithm of your own. It learns ``Bounce/Paddle-v0`` beyond the best scripted
player.
"""

import time

import gymnasium as gym
import matplotlib.pyplot as plt
import numpy as np
import torch
from torch import nn

torch.set_num_threads(1)
torch.manual_seed(1)

WORLDS, STEPS, UPDATES = 256, 128, 40
EPOCHS, MINIBATCH, RATE = 4, 2048, 2e-3
GAMMA, LAMBDA, CLIP, VALUE_SHARE = 0.99, 0.95, 0.2, 0.5

# %%
# Actor and critic. The action is the paddle's speed, a Gaussian whose spread is learned; what lies
# beyond -1 to 1 is clipped by the environment.


def network(outputs, gain):
    """Two hidden layers of 64."""
    layers = [nn.Linear(5, 64), nn.ReLU(), nn.Linear(64, 64), nn.ReLU(), nn.Linear(64, outputs)]
    for layer in layers[::2]:
        nn.init.orthogonal_(layer.weight, np.sqrt(2) if layer is not layers[-1] else gain)
        nn.init.zeros_(layer.bias)
    return nn.Sequential(*layers)


actor, critic = network(1, 0.01), network(1, 1.0)
spread = nn.Parameter(torch.zeros(1))
parameters = [*actor.parameters(), *critic.parameters(), spread]
optimizer = torch.optim.Adam(parameters, lr=RATE, eps=1e-5)


def policy(observations):
    """The distribution of actions."""
    return torch.distributions.Normal(actor(observations), spread.exp())


# %%
# In Gymnasium's mode NEXT_STEP, the default of vector environments, the step *after* an episode's
# end ignores its action and returns the next episode's first observation, with reward 0. That step
# is not experience: ``valid`` leaves it out of advantages and losses. Values are not bootstrapped
# over the end of an episode that terminated; where one was truncated, the value of its last
# observation is.

envs = gym.make_vec("Bounce/Paddle-v0", num_envs=WORLDS, vectorization_mode="vector_entry_point", info="ends")
observation = torch.as_tensor(envs.reset(seed=2**32)[0])
before_was_end = np.zeros(WORLDS, bool)
seen = torch.zeros((STEPS, WORLDS, 5))
did, rewards = torch.zeros((STEPS, WORLDS, 1)), torch.zeros((STEPS, WORLDS))
log_probs, values = torch.zeros((STEPS, WORLDS)), torch.zeros((STEPS + 1, WORLDS))
terminated_at, ended_at = torch.zeros((STEPS, WORLDS)), torch.zeros((STEPS, WORLDS))
valid = torch.zeros((STEPS, WORLDS), dtype=torch.bool)

curve, in_envs, began = [], 0.0, time.perf_counter()
for update in range(UPDATES):
    optimizer.param_groups[0]["lr"] = RATE * (1.0 - update / UPDATES)
    ended_scores = []
    for t in range(STEPS):
        with torch.no_grad():
            distribution = policy(observation)
            action = distribution.sample()
            values[t] = critic(observation)[:, 0]
            log_probs[t] = distribution.log_prob(action)[:, 0]
        seen[t], did[t], valid[t] = observation, action, torch.as_tensor(~before_was_end)
        clock = time.perf_counter()
        following, reward, terminated, truncated, info = envs.step(action.numpy())
        in_envs += time.perf_counter() - clock
        ended = terminated | truncated
        rewards[t] = torch.as_tensor(reward, dtype=torch.float32)
        terminated_at[t], ended_at[t] = torch.as_tensor(terminated).float(), torch.as_tensor(ended).float()
        if "score" in info:
            ended_scores.extend(info["score"][info["_score"] & ended])
        before_was_end, observation = ended, torch.as_tensor(following)
    with torch.no_grad():
        values[STEPS] = critic(observation)[:, 0]

    # Generalised advantage estimation. values[t + 1] belongs to the observation after step t, at an end its last one.
    advantages, sum_so_far = torch.zeros((STEPS, WORLDS)), torch.zeros(WORLDS)
    for t in reversed(range(STEPS)):
        error = rewards[t] + GAMMA * values[t + 1] * (1.0 - terminated_at[t]) - values[t]
        sum_so_far = error + GAMMA * LAMBDA * (1.0 - ended_at[t]) * sum_so_far
        sum_so_far = torch.where(valid[t], sum_so_far, 0.0)
        advantages[t] = sum_so_far
    returns = advantages + values[:STEPS]

    rows = valid.flatten().nonzero()[:, 0]  # the mask
    flat = [x.flatten(0, 1)[rows] for x in (seen, did, log_probs, advantages, returns)]
    for _ in range(EPOCHS):
        for some in torch.randperm(len(rows)).split(MINIBATCH):
            o, a, old, advantage, target = (x[some] for x in flat)
            advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
            ratio = (policy(o).log_prob(a)[:, 0] - old).exp()
            gain = torch.min(ratio * advantage, ratio.clamp(1.0 - CLIP, 1.0 + CLIP) * advantage).mean()
            loss = VALUE_SHARE * (critic(o)[:, 0] - target).square().mean() - gain
            optimizer.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(parameters, 0.5)
            optimizer.step()
    curve.append(np.mean(ended_scores) if ended_scores else np.nan)
envs.close()
seconds = time.perf_counter() - began
steps = UPDATES * STEPS * WORLDS
print(f"{steps:,} steps in {seconds:.0f} s; {in_envs / seconds:.1%} of that in the environment")

# %%
# Held-out episodes: the first ones of the seeds 10 000, 10 001 ..., each played to its end with the
# best action.

EPISODES = 200
test = gym.make_vec("Bounce/Paddle-v0", num_envs=EPISODES, vectorization_mode="vector_entry_point", info="ends")
observations, _ = test.reset(seed=10_000)
scores, playing = np.zeros(EPISODES), np.ones(EPISODES, bool)
while playing.any():
    with torch.no_grad():
        actions = actor(torch.as_tensor(observations)).numpy()
    observations, _, terminated, truncated, info = test.step(actions)
    over = playing & (terminated | truncated)
    if over.any():
        scores[over] = info["score"][over]
        playing &= ~over
half = 1.96 * scores.std(ddof=1) / np.sqrt(EPISODES)
print(f"mean score {scores.mean():.1f} +- {half:.1f}; the best scripted player has 23.6")
assert scores.mean() - half > 23.6

# %%

figure, axes = plt.subplots(figsize=(6, 3.2), layout="constrained")
axes.plot((np.arange(UPDATES) + 1) * STEPS * WORLDS, curve)
axes.axhline(23.6, linestyle="--", color="gray", label="best scripted player")
axes.set_xlabel("steps")
axes.set_ylabel("bumpers hit in an episode")
axes.legend()
plt.show()
