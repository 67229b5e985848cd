"""Turn a trained policy into a file that NumPy plays: `python -m agents.export`."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro
from gymnasium import spaces
from torch import nn

from agents.algorithms import Model
from agents.command import Refused, check_range, run, say
from agents.evaluate import MOST_EPISODES, play
from agents.intervals import Interval, bootstrap
from agents.players import trained
from agents.runs import Run, open_run
from agents.task import Task
from bounce_env.trained import Agent, agent_file

LARGEST_FILE = 300_000  # bytes

KINDS = {spaces.Discrete: "discrete", spaces.Box: "box", spaces.MultiBinary: "buttons"}
ACTIVATIONS = {nn.ReLU: "relu", nn.Tanh: "tanh"}


def agent_of(run: Run, model: Model, steps: int, score: Interval | None) -> Agent:
    """Return the policy of a PPO run as an `Agent`. Raises Refused for another algorithm."""
    if run.algo != "ppo":
        raise Refused(f"{run.folder}: was trained with {run.algo}: must be a run of ppo")
    policy: Any = model.policy
    hidden = [layer for layer in policy.mlp_extractor.policy_net if isinstance(layer, nn.Linear)]
    activations = {type(layer) for layer in policy.mlp_extractor.policy_net if not isinstance(layer, nn.Linear)}
    layers = [(layer.weight.detach().numpy(), layer.bias.detach().numpy()) for layer in (*hidden, policy.action_net)]
    facts: dict[str, Any] = {"algo": run.algo, "seed": run.seed, "steps": steps, "versions": run.versions}
    if score is not None:
        facts["score"] = {"mean": score.mean, "low": score.lo, "high": score.hi, "episodes": score.episodes}
    return Agent(
        run.task.env_id,
        dict(run.task.env_kwargs),
        tuple((weights.astype(np.float32), biases.astype(np.float32)) for weights, biases in layers),
        ACTIVATIONS[activations.pop()] if activations else "relu",  # type: ignore[arg-type]
        KINDS[type(run.task.action_space)],  # type: ignore[arg-type]
        facts,
    )


def check_same(agent: Agent, model: Model, task: Task) -> None:
    """Raises Refused where NumPy's actions are not PyTorch's, on the observations of random play."""
    player = trained(model)
    envs = task.batch(64)
    observations, _ = envs.reset(seed=0)
    envs.action_space.seed(0)
    for _ in range(50):
        ours, theirs = agent(observations), player(observations)
        # Rounding may decide between two actions that are as good; of a continuous one it changes the last digits.
        if np.mean(np.isclose(ours, theirs, atol=1e-4)) < 0.999:
            raise Refused(f"{agent.env_id}: the exported agent acts otherwise than the trained one: {ours}, {theirs}")
        observations = envs.step(envs.action_space.sample())[0]
    envs.close()


def write_agent(folder: Path, output: Path, score: Interval | None = None) -> Path:
    """Write the agent of a run folder to a file in the folder `output`; returns its path."""
    finished = open_run(folder)
    model = finished.load_model()
    agent = agent_of(finished, model, model.num_timesteps, score)
    check_same(agent, model, finished.task)
    output.mkdir(parents=True, exist_ok=True)
    path = output / agent_file(agent.env_id)
    agent.save(path)
    size = path.stat().st_size
    if size > LARGEST_FILE:
        path.unlink()
        raise Refused(f"{path}: {size} bytes: must be at most {LARGEST_FILE}, use smaller layers")
    return path


@dataclass(frozen=True)
class ExportOptions:
    """See `export`."""

    run: Annotated[Path, tyro.conf.Positional]
    """A run folder (runs/...) of PPO."""
    output: Path = Path()
    """Folder for the file, which is named after the environment."""
    episodes: int = 500
    """Held-out episodes that it is measured on; what it scores is in the file."""


def export(options: ExportOptions) -> int:
    """Write a trained agent to a .npz file that NumPy alone plays: `bounce-env watch GAME --agent FILE`.

    A model file can run code when it is loaded: export only runs that you trust.
    """
    check_range("episodes", options.episodes, 2, MOST_EPISODES)
    finished = open_run(options.run)
    scores = play(finished.task, trained(finished.load_model()), options.episodes).scores
    say(str(write_agent(options.run, options.output, bootstrap([scores]))))
    return 0


if __name__ == "__main__":
    run(export, ExportOptions)
