"""Training, measuring and filming agents; run as `python -m agents.train` from a clone, never packaged."""

from importlib.util import find_spec

from bounce_env.extras import missing

for _module in ("tyro", "torch", "stable_baselines3", "matplotlib", "scipy", "yaml"):
    if find_spec(_module) is None:
        raise missing("train", _module, "training agents needs")
