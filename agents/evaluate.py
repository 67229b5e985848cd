"""Play held-out episodes: `python -m agents.evaluate`."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated

import numpy as np
import tyro

from agents.command import JsonObject, Refused, check_range, run, say
from agents.files import write_text
from agents.look_ahead import LookAhead, act
from agents.players import named
from agents.results import Episodes, report, statistics, table
from agents.runs import versions
from agents.task import HELD_OUT, Player, Task

MOST_EPISODES = 1_000_000
"""They are played side by side, each in a world of its own."""


def check_ends(task: Task) -> None:
    """Raises Refused where an episode might never end."""
    if task.resolved_kwargs["time_limit"] is None:
        raise Refused("env_kwargs: time_limit = null: must be a number of seconds, for evaluation needs an end")


def play(task: Task, player: Player | LookAhead, episodes: int) -> Episodes:
    """Return the held-out episodes, each to its end: episode k is the first one of the seed HELD_OUT + k.

    So every player meets the same launches, and no episode counts because it ended early. Raises Refused where there is
    no time limit.
    """
    check_ends(task)
    envs = task.batch(episodes)
    observations, _ = envs.reset(seed=HELD_OUT)
    actions = np.zeros(envs.action_space.shape, envs.action_space.dtype)
    played = Episodes(
        scores=np.zeros(episodes),
        seconds=np.zeros(episodes),
        touches=np.zeros(episodes, np.int64),
        at_limit=np.zeros(episodes, np.bool_),
    )
    playing = np.ones(episodes, np.bool_)
    while playing.any():
        actions[playing] = act(player, observations[playing], partial(envs.unwrapped.clone_state, playing))
        observations, _, terminated, truncated, info = envs.step(actions)
        ended = playing & (terminated | truncated)
        if ended.any():
            played.scores[ended] = info["score"][ended]
            played.seconds[ended] = info["game_seconds"][ended]
            played.touches[ended] = info["touches"][ended]
            played.at_limit[ended] = truncated[ended]
            playing &= ~ended
    envs.close()
    return played


def in_words(task: Task, played: Mapping[str, Episodes]) -> str:
    """Return a table with its title."""
    kwargs = f" {json.dumps(dict(task.env_kwargs))}" if task.env_kwargs else ""
    return f"{task.env_id}{kwargs}, whole held-out episodes, seeds from {HELD_OUT} on\n{table(played)}"


@dataclass(frozen=True)
class EvaluateOptions:
    """See `evaluate`."""

    player: Annotated[str, tyro.conf.Positional]
    """A run folder (runs/...) or the name of a baseline of the environment, such as random or nothing."""
    episodes: int = 500
    """Number of whole episodes, from the seed 10000 on."""
    env_id: str | None = None
    """What to play. Default: what the run was trained on; Bounce/Paddle-v0 for a baseline."""
    env_kwargs: JsonObject = None
    """Keyword arguments of the environment. Default: those of the run; none for a baseline."""
    json: Path | None = None
    """Also write the result to this file."""


def evaluate(options: EvaluateOptions) -> int:
    """Measure a player on held-out episodes: the mean score with its 95 % interval.

    A trained agent is measured twice: with its best action (trained) and with sampled ones (trained_sampled).
    A model file can run code when it is loaded: evaluate only runs that you trust.
    """
    check_range("episodes", options.episodes, 2, MOST_EPISODES)
    if options.json is not None and (options.json.is_dir() or not options.json.parent.is_dir()):
        raise Refused(f"--json {options.json}: must be a file in a folder that is there")
    task, players = named(options.player, options.env_id, options.env_kwargs)
    played = {name: play(task, player, options.episodes) for name, player in players.items()}
    say(in_words(task, played))
    if options.json is not None:
        content = {
            "env_id": task.env_id,
            "kwargs": dict(task.env_kwargs),
            "versions": versions(),
            "results": report(played),
            "statistics": {name: statistics(episodes) for name, episodes in played.items()},
        }
        write_text(options.json, json.dumps(content, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    run(evaluate, EvaluateOptions)
