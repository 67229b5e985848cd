"""The games in a tab: steered by keys and by pointing, told as the window tells them, scores kept, replays saved."""

import json

import gymnasium as gym
import numpy as np
import pytest

from bounce_env import load_replay, load_scene
from bounce_env.lab.play import GAMES, Play
from bounce_env.lab.pointing import pointed
from bounce_env.lab.scores import MOST, HighScores, key_of
from bounce_env.scene import dump_scene

pytestmark = pytest.mark.fast


class Tab:
    """A tab in which a game is played."""

    def __init__(self, folder, game, **fields):
        self.room = Play(folder=folder, scores=HighScores(folder / "data"))
        self.view = self.do("begin", game=game, **fields)

    def do(self, what, **fields):
        self.view = self.room.answer(json.dumps({"do": what, **fields}))
        return self.view


@pytest.mark.parametrize("game", GAMES)
def test_keys_play_a_game_as_its_window_does(tmp_path, game):
    tab = Tab(tmp_path, game)
    assert tab.view["bounds"]
    assert [element["type"] for element in tab.view["scene"]["elements"]]
    env = gym.make(GAMES[game], frame_skip=1, disable_env_checker=True).unwrapped
    env.reset(seed=tab.room._env.np_random_seed)
    held = ["left"]
    for _ in range(3):
        view = tab.do("step", frames=2, held=held)
        for _ in range(2):
            env.step(tab.room._controls.action(set(held)))
        assert view["balls"][0] == env.picture().balls[0].tolist()
        assert view["score"] == env.picture().score
        assert view["status"] == env.status
    assert "scene" not in view


def test_a_paddle_follows_and_an_end_of_a_wall_is_drawn(tmp_path):
    tab = Tab(tmp_path, "paddle")
    for _ in range(20):
        view = tab.do("step", frames=2, to=[0.8, 0.1])
    assert view["parts"][0][1][0] == pytest.approx(0.8, abs=1e-6)
    tab = Tab(tmp_path, "walls")
    before = tab.view["parts"][0][1]
    target = [before[2] + 0.05, before[3] + 0.02]
    for _ in range(5):
        view = tab.do("step", frames=2, to=target, end=1)
    assert view["parts"][0][1] == pytest.approx([*before[:2], *target], abs=1e-6)
    tab = Tab(tmp_path, "pinball")
    tab.do("step", frames=1, to=[0.1, 0.1])  # where pointing is no action, keys are


def test_pointing_suits_discrete_actions_too():
    env = gym.make("Bounce/Paddle-v0", action="discrete", disable_env_checker=True).unwrapped
    env.reset(seed=0)
    cores = np.asarray(env.picture().cores)
    middle = 0.5 * (cores[0, 0] + cores[0, 2])
    for away, action in ((-0.2, 0), (0.0, 1), (0.2, 2)):
        assert pointed(env.action_space, env.scene, cores, (middle + away, 0.1), 0) == action


def test_a_game_ends_is_noted_begun_anew_and_saved(tmp_path):
    tab = Tab(tmp_path, "paddle")
    while tab.view["end"] is None:
        tab.do("step", frames=6, to=[0.0, 0.0])
    assert tab.view["end"] == "drained"
    score = tab.view["score"]
    assert tab.view["best"] == score
    assert tab.do("step", frames=1)["score"] == score
    view = tab.do("save", name="mine")
    assert view["notice"] == f"saved {tmp_path / 'mine.html'}"
    document = load_replay(tmp_path / "mine.html").document
    assert document["about"]["id"] == "Bounce/Paddle-v0"
    with pytest.raises(ValueError, match=r"mine\.html is there already"):
        tab.do("save", name="mine")
    view = tab.do("again")
    assert (view["end"], view["best"], view["score"]) == (None, score, 0.0)


def test_a_film_is_made_whole_and_ends_with_the_tab(tmp_path):
    tab = Tab(tmp_path, "walls")
    assert tab.do("film", name="mine")["films"]
    tab.do("step", frames=6)
    view = tab.do("film", name=None)
    assert (view["films"], view["notice"]) == (False, f"saved {tmp_path / 'mine.mp4'}")
    assert (tmp_path / "mine.mp4").stat().st_size > 1000
    with pytest.raises(ValueError, match=r"mine\.mp4 is there already"):
        tab.do("film", name="mine")
    tab.do("film", name="other")
    tab.do("step", frames=6)
    tab.room.close()
    assert (tmp_path / "other.mp4").stat().st_size > 1000


def test_a_scene_of_the_folder_is_played_and_a_wrong_one_refused(tmp_path):
    (tmp_path / "mine.toml").write_text(dump_scene(load_scene("paddle")))
    (tmp_path / "box.toml").write_text(dump_scene(load_scene("box")))
    assert Tab(tmp_path, "paddle", scene="mine").view["score"] == 0.0
    with pytest.raises(ValueError, match=r"paddles = 0: must be exactly 1"):
        Tab(tmp_path, "paddle", scene="box")
    with pytest.raises(ValueError, match=r"begin\.scene"):
        Tab(tmp_path, "paddle", scene="../mine")
    with pytest.raises(ValueError, match="no game has begun"):
        Play(folder=tmp_path).answer('{"do": "again"}')
    with pytest.raises(ValueError, match=r"begin\.game"):
        Tab(tmp_path, "chess")
    with pytest.raises(ValueError, match=r"step\.frames = 1000"):
        Tab(tmp_path, "paddle").do("step", frames=1000)


def test_the_best_scores_are_kept_per_game_and_scene_and_never_half_written(tmp_path):
    scores = HighScores(tmp_path / "new")
    one, other = (key_of("Bounce/Paddle-v0", {}, load_scene(name)) for name in ("paddle", "box"))
    assert one != other != key_of("Bounce/Paddle-v0", {"balls": 3}, load_scene("box"))
    assert scores.of(one) == []
    for k in range(MOST + 5):
        best = scores.add(one, float(k))
    assert [entry.score for entry in best] == [float(k) for k in range(MOST + 4, 4, -1)]
    assert scores.of(one) == best
    assert scores.of(other) == []
    (path,) = (tmp_path / "new").iterdir()
    path.write_text('{"format": 2, "scores": {}}')
    with pytest.raises(ValueError, match=r"high_scores\.json: format: .*: mend or remove it"):
        scores.add(one, 1.0)
    assert path.read_text() == '{"format": 2, "scores": {}}'
    tab = Tab(tmp_path, "paddle")
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "high_scores.json").write_text("{")
    assert tab.do("again")["best"] is None  # the game goes on
