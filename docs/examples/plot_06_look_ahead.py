"""
Look ahead on copies of the world
=================================

``clone_state`` is everything an episode follows from: physics, rules and random streams. A player
that tries plans on copies of its world, and does what pays most, needs no training, and is a bound
that trained ones are measured against.
"""

import gymnasium as gym
import matplotlib.pyplot as plt
import numpy as np

import bounce_env  # registers Bounce/*

PLANS, STEPS = 48, 50  # of 1/30 s each

env = gym.make("Bounce/Paddle-v0", time_limit=20.0)
copies = gym.make_vec(
    "Bounce/Paddle-v0", num_envs=PLANS, vectorization_mode="vector_entry_point", time_limit=20.0, info="none"
)
copies.reset(seed=0)

# %%
# A plan: go one way for a while, then the other. All plans begin with one of three actions, so what
# pays is what the first action leads to.

generator = np.random.default_rng(0)
turns = generator.integers(1, STEPS, size=PLANS)
first, second = generator.choice([-1.0, 0.0, 1.0], size=(2, PLANS))
plans = np.where(np.arange(STEPS) < turns[:, None], first[:, None], second[:, None]).astype(np.float32)


def best_action():
    """The first action of the plan with the highest sum of rewards; a plan that loses the ball is worth 10 less."""
    state = env.unwrapped.clone_state()
    copies.unwrapped.restore_state(state[np.zeros(PLANS, int)])
    worth, playing = np.zeros(PLANS), np.ones(PLANS, bool)
    for step in range(STEPS):
        _, rewards, terminated, truncated, _ = copies.step(plans[:, step : step + 1])
        worth += np.where(playing, rewards - 10.0 * terminated, 0.0)
        playing &= ~(terminated | truncated)
    return plans[worth.argmax(), :1]


def score_of(act):
    """The score of an episode, step by step."""
    observation, info = env.reset(seed=10_000)
    scores, over = [0.0], False
    while not over:
        observation, _, terminated, truncated, info = env.step(act(observation))
        scores.append(info["score"])
        over = terminated or truncated
    return scores


agent = bounce_env.load_agent("Bounce/Paddle-v0")
runs = {
    "looks ahead": score_of(lambda _: best_action()),
    "trained agent": score_of(agent),
    "does nothing": score_of(lambda _: [0.0]),
}
for name, scores in runs.items():
    print(f"{name}: {scores[-1]:.0f} bumpers in {len(scores) / 30:.1f} s")
assert runs["looks ahead"][-1] > runs["does nothing"][-1]

# %%

figure, axes = plt.subplots(figsize=(6, 3.2), layout="constrained")
for name, scores in runs.items():
    axes.plot(np.arange(len(scores)) / 30, scores, label=name)
axes.set_xlabel("seconds of play")
axes.set_ylabel("bumpers hit")
axes.legend()
plt.show()

# %%
# A restored state goes on to the same bits:

env.reset(seed=1)
state = env.unwrapped.clone_state()
once = [env.step([0.5])[0] for _ in range(30)]
env.unwrapped.restore_state(state)
again = [env.step([0.5])[0] for _ in range(30)]
assert np.array_equal(once, again)
