"""Players by name: a run folder's trained agent, or a baseline."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch

from agents.algorithms import Model
from agents.baselines import BASELINES
from agents.command import Refused
from agents.look_ahead import LookAhead
from agents.runs import open_run
from agents.task import Player, Task
from bounce_env.wording import nearest

DEFAULT_ENV_ID = "Bounce/Paddle-v0"


def trained(model: Model, *, sampled: bool = False) -> Player:
    """Return a model that plays its best action (argmax), or samples one as it did in training.

    What it samples is the same after each call of this function (which seeds PyTorch's one generator).
    """
    if sampled:
        torch.manual_seed(0)
    return lambda observations: model.predict(observations, deterministic=not sampled)[0]


def named(
    name: str, env_id: str | None, env_kwargs: Mapping[str, Any] | None
) -> tuple[Task, dict[str, Player | LookAhead]]:
    """Return what is played, and who plays it: `name` is a baseline or a run folder, which gives two players.

    env_id, env_kwargs: None for what the run was trained on. Raises Refused for a name that is neither, and where the
    trained agent cannot play what is asked.
    """
    if not Path(name).is_dir():
        task = Task(env_id or DEFAULT_ENV_ID, env_kwargs or {})
        known = BASELINES[task.env_id]
        if name not in known:
            allowed = f"a run folder, or, for {task.env_id}, one of {', '.join(known)}"
            raise Refused(f"{name!r}: must be {allowed}{nearest(name, known)}")
        if task.env_kwargs.get("obs") == "pixels":
            raise Refused(f"{task.env_id}: env_kwargs: obs = 'pixels': must be 'state' for the baseline {name!r}")
        return task, {name: known[name](task)}
    run = open_run(Path(name))
    task = Task(
        run.task.env_id if env_id is None else env_id, run.task.env_kwargs if env_kwargs is None else env_kwargs
    )
    model = run.load_model()
    if (model.observation_space, model.action_space) != (task.observation_space, task.action_space):
        raise Refused(
            f"{name}: was trained on {model.observation_space} and {model.action_space}, "
            f"but this environment has {task.observation_space} and {task.action_space}"
        )
    return task, {"trained": trained(model), "trained_sampled": trained(model, sampled=True)}
