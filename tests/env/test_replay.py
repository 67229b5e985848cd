"""Environments that are recorded: the same bits, and replays that show where everything was."""

import json
from bisect import bisect_right

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import bounce_env  # noqa: F401 (registers the games)
from bounce_env.replay import read_document

pytestmark = pytest.mark.fast

GAMES = ("Paddle", "Pinball", "Walls")


def flight_at(document, time):
    """Where the ball is, by the document's paths that are flights; None on a curve."""
    paths, instants = document["balls"][0], document["instants"]
    path = paths[max(bisect_right([instants[p[0]] for p in paths], time) - 1, 0)]
    if len(path) == 4:
        return None
    begin, x, y, vx, vy, ax, ay = path
    t = time - instants[begin]
    return x + (vx + 0.5 * ax * t) * t, y + (vy + 0.5 * ay * t) * t


@pytest.mark.parametrize("game", GAMES)
def test_recording_changes_no_bit_and_the_replay_leads_through_every_step(game):
    recorded = gym.make(f"Bounce/{game}-v0", record_events=True, disable_env_checker=True)
    plain = gym.make(f"Bounce/{game}-v0", disable_env_checker=True)
    plain.action_space.seed(3)
    first = [env.reset(seed=4)[0].tobytes() for env in (recorded, plain)]
    assert first[0] == first[1]
    seen = []
    for _ in range(40):
        action = plain.action_space.sample()
        one, other = recorded.step(action), plain.step(action)
        assert one[0].tobytes() == other[0].tobytes()
        assert one[1:4] == other[1:4]
        batch = recorded.unwrapped._batch
        seen.append((float(batch.episodes["frames"][0]) / 60.0, *batch.view(0)[0][0, :2]))
        if one[2] or one[3]:
            break
    document = json.loads(recorded.unwrapped.replay().json)
    assert document["format"] == 1
    assert document["about"]["id"] == f"Bounce/{game}-v0"
    assert document["about"]["seed"] == 4
    assert document["end"] == pytest.approx(seen[-1][0], abs=1e-12)
    there = [(flight_at(document, time), (x, y)) for time, x, y in seen[:-1]]
    assert sum(place is not None for place, _ in there) > len(there) // 2
    for place, right in there:
        if place is not None:
            assert place == pytest.approx(right, abs=1e-10)


def test_a_replay_of_walls_leads_from_ball_to_ball_and_shows_no_serve_that_was_tried_out():
    env = gym.make("Bounce/Walls-v0", record_events=True, disable_env_checker=True, balls=3, frame_skip=6).unwrapped
    env.reset(seed=11)
    env.action_space.seed(0)
    seen, targets, over = [], [], False
    while not over:
        *_, terminated, truncated, _ = env.step(env.action_space.sample())
        over = terminated or truncated
        batch = env._batch
        seen.append((float(batch.episodes["frames"][0]) / 60.0, *batch.view(0)[0][0, :2]))
        targets.append(batch.target_places(np.array([0]))[0, 0].tolist())
    document = env.replay().document
    assert read_document(env.replay().json) == document
    assert [value for *_, value in document["changes"]] == [list(t) for t in dict.fromkeys(map(tuple, targets))][1:]
    begins = [path[0] for path in document["balls"][0]]
    assert begins == sorted(begins)
    assert document["lost"] == 0
    serves = {instant for instant, *_ in document["changes"]}
    assert len(serves) == 2
    there = [(flight_at(document, time), (x, y)) for time, x, y in seen[:-1]]
    for place, right in there:
        assert place == pytest.approx(right, abs=1e-9)
    times = [event[0] for event in document["events"]]
    assert times == sorted(times)
    last = env._batch.recorder.present
    assert sum(len(page.ledger) for stretch in last.stretches for page in stretch.pages) == len(times)


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_one_world_of_many_is_recorded_over_its_resets(mode):
    def played(world):
        envs = gym.make_vec(
            "Bounce/Paddle-v0", num_envs=3, vectorization_mode="vector_entry_point", autoreset_mode=mode, time_limit=0.5
        )
        envs.unwrapped.record(world)
        envs.reset(seed=7)
        out = []
        for _ in range(40):
            _, _, terminated, truncated, _ = envs.step(np.zeros(envs.action_space.shape, envs.action_space.dtype))
            out.append(envs.unwrapped._batch.results.observations.tobytes())
            if mode is AutoresetMode.DISABLED and (terminated | truncated).any():
                envs.reset(options={"reset_mask": terminated | truncated})
        return envs, out

    envs, out = played(1)
    assert out == played(None)[1]
    last, present = (envs.unwrapped.replay(last=last).document for last in (True, False))
    assert 0.4 < last["end"] <= 0.5 + 1e-9
    assert 0.0 <= present["end"] <= 0.5 + 1e-9
    for document in (last, present):
        begins = [path[0] for path in document["balls"][0]]
        assert begins == sorted(begins)
        assert document["instants"][begins[-1]] <= document["end"] + 1e-9


def test_what_was_not_recorded_has_no_replay():
    env = gym.make("Bounce/Paddle-v0", disable_env_checker=True).unwrapped
    env.reset(seed=0)
    with pytest.raises(RuntimeError, match="record_events=True"):
        env.replay()
    env.record()
    with pytest.raises(RuntimeError, match="nothing is recorded of this episode"):
        env.replay()
    env.reset()
    env.step(env.action_space.sample())
    page = env.replay().html
    assert "<script" in page
    with pytest.raises(ValueError, match="record_events = 1: must be True or False"):
        gym.make("Bounce/Paddle-v0", record_events=1)


def times_of(document):
    return [document["instants"][path[0]] for path in document["balls"][0]]


def test_episodes_that_are_seeded_anew_are_told_apart():
    env = gym.make("Bounce/Walls-v0", record_events=True, disable_env_checker=True).unwrapped
    fresh = gym.make("Bounce/Walls-v0", record_events=True, disable_env_checker=True).unwrapped
    env.action_space.seed(1)
    actions = [env.action_space.sample() for _ in range(12)]
    for seed, steps in ((0, 12), (7, 5), (7, 5)):
        env.reset(seed=seed)
        for action in actions[:steps]:
            env.step(action)
    fresh.reset(seed=7)
    for action in actions[:5]:
        fresh.step(action)
    assert env.replay().document == fresh.replay().document
    assert env.replay(last=True).document == fresh.replay().document
    assert times_of(env.replay().document) == sorted(times_of(env.replay().document))


def test_a_replay_says_where_its_episode_comes_from():
    env = gym.make("Bounce/Paddle-v0", record_events=True, disable_env_checker=True).unwrapped
    env.reset(seed=5)
    other = env.clone_state()
    env.reset()
    about = [env.replay(last=last).document["about"] for last in (True, False)]
    assert [(each["seed"], each["episode"]) for each in about] == [(5, 1), (5, 2)]
    env.reset(seed=6)
    env.restore_state(other)
    with pytest.raises(RuntimeError, match="or a state was restored"):
        env.replay()
    assert env.replay(last=True).document["about"]["seed"] == 6  # what was left by restoring
    env.reset()
    assert env.replay().document["about"]["seed"] is None
    envs = gym.make_vec("Bounce/Paddle-v0", num_envs=3, vectorization_mode="vector_entry_point").unwrapped
    envs.record(2)
    envs.reset(seed=5)
    assert envs.replay().document["about"]["seed"] == 7


@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_recording_begins_with_an_episode_that_begins_in_a_step(mode):
    envs = gym.make_vec(
        "Bounce/Paddle-v0", num_envs=2, vectorization_mode="vector_entry_point", autoreset_mode=mode, time_limit=0.2
    ).unwrapped
    actions = np.zeros(envs.action_space.shape, envs.action_space.dtype)
    envs.reset(seed=0)
    envs.step(actions)
    envs.record(1)
    for _ in range(5):
        with pytest.raises(RuntimeError, match="nothing is recorded of this episode"):
            envs.replay()
        envs.step(actions)
    for _ in range(4):
        envs.step(actions)
    assert times_of(envs.replay().document)[0] == 0.0
    envs.record(1)  # once more changes nothing
    assert envs.replay().document["end"] > 0.0
    envs.restore_state(envs.clone_state())
    for _ in range(14):
        envs.step(actions)
    assert times_of(envs.replay().document)[0] == 0.0
    with pytest.raises(ValueError, match="on = 'no': must be True or False"):
        gym.make("Bounce/Paddle-v0", disable_env_checker=True).unwrapped.record("no")
