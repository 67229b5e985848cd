"""Agents as files: what is read is checked, nothing is unpickled, and NumPy plays what PyTorch has learned."""

import json
import sys
from itertools import pairwise

import gymnasium as gym
import numpy as np
import pytest

from bounce_env.commands import main
from bounce_env.registration import ENTRIES
from bounce_env.trained import _FOLDER, Agent, load_agent, shipped_agents

IDS = [entry.id for entry in ENTRIES]
LARGEST = 300_000  # bytes


def an_agent(**changes) -> Agent:
    generator = np.random.default_rng(0)
    sizes = (5, 4, 3)
    layers = tuple(
        (generator.normal(size=(b, a)).astype(np.float32), generator.normal(size=b).astype(np.float32))
        for a, b in pairwise(sizes)
    )
    values = {"env_id": "Bounce/Paddle-v0", "env_kwargs": {"action": "discrete"}, "layers": layers}
    return Agent(**(values | {"activation": "tanh", "actions": "discrete", "facts": {"algo": "ppo"}} | changes))


@pytest.mark.parametrize("actions", ["discrete", "box", "buttons"])
@pytest.mark.parametrize("activation", ["relu", "tanh"])
def test_an_action_is_that_of_the_network(actions, activation):
    agent = an_agent(actions=actions, activation=activation)
    x = np.random.default_rng(1).normal(size=(7, 5)).astype(np.float32)
    (w0, b0), (w1, b1) = ((w.astype(np.float64), b) for w, b in agent.layers)
    hidden = x @ w0.T + b0
    out = (np.tanh(hidden) if activation == "tanh" else np.where(hidden > 0, hidden, 0)) @ w1.T + b1
    expected = {"discrete": out.argmax(axis=1), "box": np.clip(out, -1, 1), "buttons": out > 0}[actions]
    np.testing.assert_allclose(agent(x), expected, atol=1e-5)
    np.testing.assert_allclose(agent(x[0]), expected[0], atol=1e-5)


def test_a_file_gives_the_agent_back(tmp_path):
    agent = an_agent()
    agent.save(tmp_path / "agent.npz")
    again = Agent.load(tmp_path / "agent.npz")
    assert (again.env_id, again.env_kwargs, again.facts) == (agent.env_id, agent.env_kwargs, agent.facts)
    for (w, b), (v, c) in zip(agent.layers, again.layers, strict=True):
        np.testing.assert_array_equal(w, v)
        np.testing.assert_array_equal(b, c)
    assert [path.name for path in tmp_path.iterdir()] == ["agent.npz"]


def test_bad_observations_are_refused():
    agent = an_agent()
    for bad, words in ((np.zeros(4), "must be"), (np.zeros((2, 2, 5)), "must be"), (np.full(5, np.nan), "finite")):
        with pytest.raises(ValueError, match=words):
            agent(bad)


class Evil:
    def __reduce__(self):
        return sys.exit, ("unpickled",)


def test_nothing_is_unpickled_and_what_is_no_agent_is_refused(tmp_path):
    path = tmp_path / "agent.npz"
    meta = {"version": 1, "env_id": "x", "env_kwargs": {}, "activation": "relu", "actions": "box", "facts": {}}
    good = {"w0": np.zeros((2, 3), np.float32), "b0": np.zeros(2, np.float32)}
    cases = [
        {"meta": np.array(json.dumps(meta)), **good, "w0": np.array([Evil()])},
        {"meta": np.array(json.dumps(meta | {"version": 2})), **good},
        {"meta": np.array(json.dumps(meta | {"activation": "exec"})), **good},
        {"meta": np.array(json.dumps(meta))},
        {"meta": np.array("{"), **good},
        {"meta": np.array(json.dumps(meta)), **good, "b0": np.zeros(3, np.float32)},
        {"meta": np.array(json.dumps(meta)), **good, "w0": np.zeros((2, 3))},
        good,
    ]
    for arrays in cases:
        np.savez(path, **arrays)
        with pytest.raises(ValueError, match=r"agent\.npz: "):
            Agent.load(path)
    path.write_bytes(b"no archive")
    with pytest.raises(ValueError, match="is no agent of bounce_env"):
        Agent.load(path)
    with pytest.raises(ValueError, match="is no agent of bounce_env"):
        Agent.load(tmp_path / "missing.npz")


def test_there_is_an_agent_for_every_game():
    assert shipped_agents() == tuple(sorted(IDS))
    with pytest.raises(ValueError, match=r"did you mean 'Bounce/Paddle-v0'\?"):
        load_agent("Bounce/Padle-v0")


@pytest.mark.parametrize("env_id", IDS)
def test_a_shipped_agent_is_small_and_scores_as_its_file_says(env_id):
    files = [item for item in _FOLDER.iterdir() if item.name.endswith(".npz")]
    assert all(len(item.read_bytes()) <= LARGEST for item in files)
    agent = load_agent(env_id)
    said = agent.facts["score"]
    envs = gym.make_vec(env_id, 40, vectorization_mode="vector_entry_point", **agent.env_kwargs)
    observations, _ = envs.reset(seed=10_000)
    scores, playing = np.zeros(40), np.ones(40, bool)
    while playing.any():
        observations, _, terminated, truncated, info = envs.step(agent(observations))
        ended = playing & (terminated | truncated)
        scores[ended] = info["score"][ended]
        playing &= ~ended
    # Of 40 episodes: four standard errors, and as much as the interval that the file gives.
    error = scores.std(ddof=1) / np.sqrt(40)
    assert said["low"] - 4 * error < scores.mean() < said["high"] + 4 * error


def test_watch_writes_a_film(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    an_agent(env_kwargs={"action": "discrete", "time_limit": 2.0}).save(tmp_path / "mine.npz")
    words = ["watch", "paddle", "--agent", "mine.npz", "--film", "mine.mp4", "--height", "100", "--episodes", "2"]
    assert main(words) == 0
    printed = capsys.readouterr().out
    assert "episode 2: score" in printed
    assert (tmp_path / "mine.mp4").stat().st_size > 1000
    assert main(["watch", "pinball", "--agent", "mine.npz", "--film", "x.mp4"]) == 2
    assert main(["watch", "paddle", "--film", "x.gif"]) == 2
    assert main(["watch", "paddle", "--film", "no/x.mp4"]) == 2
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.mp4", "mine.npz"]


def test_watch_shows_episodes_in_a_window(tmp_path, monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    an_agent(env_kwargs={"action": "discrete", "time_limit": 0.5}).save(tmp_path / "mine.npz")
    assert main(["watch", "paddle", "--agent", str(tmp_path / "mine.npz"), "--episodes", "1", "--height", "100"]) == 0
