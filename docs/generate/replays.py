"""Replays on pages: what a trained agent did, as it shows itself in a notebook."""

import gymnasium as gym

import bounce_env

_STEPS = 450  # of 1/30 s


def replay(env_id: str) -> str:
    """Return the replay of a trained agent's first 15 seconds, as raw HTML."""
    agent = bounce_env.load_agent(env_id)
    env = gym.make(env_id, record_events=True, **agent.env_kwargs)
    observation, _ = env.reset(seed=5)
    for _ in range(_STEPS):
        observation, _, terminated, truncated, _ = env.step(agent(observation))
        if terminated or truncated:
            break
    shown = env.unwrapped.replay()._repr_html_()  # the method by which notebooks, too, ask for it
    return f"```{{raw}} html\n{shown}\n```"
