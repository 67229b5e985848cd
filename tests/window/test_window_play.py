"""A person's sitting: keys, episodes, films, and the window around it."""

import gymnasium as gym
import imageio_ffmpeg
import numpy as np
import pytest

from bounce_env.window.film import Film
from bounce_env.window.play import play
from bounce_env.window.screen import Screen
from bounce_env.window.session import Session

HEIGHT = 160


@pytest.fixture
def session(tmp_path):
    env = gym.make("Bounce/Paddle-v0", render_mode="rgb_array", frame_skip=1, height=HEIGHT)
    return Session(env, 3, lambda: Film(tmp_path / "film.mp4", session_size(env), 60.0))


def session_size(env):
    height, width, _ = env.render().shape
    return width, height


@pytest.fixture
def dummy_display(monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")


def play_out(session):
    for _ in range(4000):
        if session.end_reason is not None:
            return
        session.tick()
    raise AssertionError("the episode did not end")


def test_keys_move_the_paddle_while_they_are_held(session):
    seen = []
    step = session._env.step
    session._env.step = lambda action: seen.append(float(action[0])) or step(action)
    for key in ("press", "release"):
        getattr(session, key)("right")
        session.tick()
    session.press("a")
    session.tick()
    assert seen == [1.0, 0.0, -1.0]


def test_a_pause_stops_the_game_and_nothing_else(session):
    session.tick()
    before = session.frame
    session.press("p")
    session.tick()
    assert session.paused
    assert session.frame is before
    session.press("p")
    session.tick()
    assert not session.paused
    assert (session.frame != before).any()


def test_a_game_that_is_over_says_why_and_begins_anew(session):
    first = session.frame
    play_out(session)
    assert session.end_reason == "drained"
    session.tick()  # nothing more happens
    session.press("p")
    assert not session.paused
    session.press("r")
    assert session.end_reason is None
    assert session.score == 0.0
    assert (session.frame != first).any()  # another launch


def test_a_seed_gives_the_same_launch(session, tmp_path):
    env = gym.make("Bounce/Paddle-v0", render_mode="rgb_array", frame_skip=1, height=HEIGHT)
    other = Session(env, 3, lambda: None)
    np.testing.assert_array_equal(other.frame, session.frame)


def test_a_film_appears_when_it_is_complete(session, tmp_path):
    film = tmp_path / "film.mp4"
    session.press("v")
    assert session.filming
    for _ in range(9):
        session.tick()
    assert not film.exists()
    session.press("v")
    assert session.message == f"saved {film}"
    assert [path.name for path in tmp_path.iterdir()] == ["film.mp4"]
    frames, seconds = imageio_ffmpeg.count_frames_and_secs(str(film))
    assert frames == 10
    assert seconds == pytest.approx(10 / 60, abs=0.02)


def test_closing_finishes_the_film(session, tmp_path):
    session.press("v")
    session.tick()
    session.close()
    assert (tmp_path / "film.mp4").stat().st_size > 0


def test_a_film_that_cannot_be_written_ends_alone(session, tmp_path):
    """The encoder is killed, as if it had crashed: no file is left, and the game goes on."""
    session.press("v")
    session._film._encoder.kill()
    session._film._encoder.wait()
    before = session.frame
    for _ in range(3):
        session.tick()
    assert not session.filming
    assert session.message.startswith("no film: ")
    assert "encoder ended with" in session.message
    assert list(tmp_path.iterdir()) == []
    assert (session.frame != before).any()


def test_a_film_that_breaks_at_its_end_leaves_no_file(session, tmp_path):
    session.press("v")
    session._film._encoder.kill()
    session.press("v")
    assert session.message.startswith("no film: ")
    assert list(tmp_path.iterdir()) == []


def test_a_film_needs_a_folder(session, tmp_path):
    session._new_film = lambda: Film(tmp_path / "none" / "film.mp4", (100, 100), 60.0)
    session.press("v")
    assert not session.filming
    assert "No such file or directory" in session.message


class Script(Session):
    """A session whose person presses keys at given frames, through the window's own queue of events."""

    keys: dict[int, list[tuple[bool, str]]]
    ticks = 0

    def tick(self):
        import pygame

        for down, name in self.keys.get(self.ticks, ()):
            kind = pygame.KEYDOWN if down else pygame.KEYUP
            pygame.event.post(pygame.event.Event(kind, key=pygame.key.key_code(name)))
        self.ticks += 1
        super().tick()


def scripted(session, **keys):
    script = Script(session._env, 3, session._new_film)
    script.keys = {int(frame[1:]): moves for frame, moves in keys.items()}
    return script


def test_a_window_is_played_for_some_frames(session, dummy_display):
    assert play(session, "test", 1000.0, frames=7) == 7


def test_keys_reach_the_game_through_the_window(session, dummy_display):
    script = scripted(session, _1=[(True, "left shift"), (True, "d")], _3=[(False, "d")], _5=[(True, "escape")])
    held = []
    act = script._controls.action
    object.__setattr__(script._controls, "action", lambda keys: held.append(sorted(keys)) or act(keys))
    assert play(script, "test", 1000.0, frames=50) == 7
    assert held == [[], [], *[["d", "left shift"]] * 2, *[["left shift"]] * 2, ["escape", "left shift"]]


def test_closing_the_window_ends_the_play(session, dummy_display):
    import pygame

    script = scripted(session, _0=[(True, "v")])
    tick = script.tick

    def tick_then_close():
        tick()
        if script.ticks == 4:
            pygame.event.post(pygame.event.Event(pygame.QUIT))

    script.tick = tick_then_close
    assert play(script, "test", 1000.0, frames=50) == 5
    assert script.message.startswith("saved ")


@pytest.mark.parametrize("size", [{"height": 720}, {"width": 120, "height": 160}, {"width": 900, "height": 300}])
def test_texts_are_within_the_picture(size):
    """Nothing is written up to the border of the window, where it would be cut off."""
    env = gym.make("Bounce/Paddle-v0", render_mode="rgb_array", frame_skip=1, **size)
    session = Session(env, 3, lambda: None)
    screen = Screen(session)
    height = len(session.frame)
    session.message = "saved /a/rather/long/name/of/a/folder/paddle-20250101-120000.mp4"
    calm = screen.draw(session)
    strip = calm[height:]
    assert (strip != strip[-1, -1]).any()
    for border in (strip[:, :2], strip[:, -2:], strip[-2:]):
        assert (border == strip[-1, -1]).all()
    np.testing.assert_array_equal(calm[:height], session.frame)
    session.press("p")
    paused = screen.draw(session)
    assert paused[:height, 2:-2].max() > 230  # bright letters on what is dimmed
    assert np.median(paused[:height]) < 0.5 * np.median(calm[:height])
    assert paused[:height, :2].max() < 120
    assert paused[:height, -2:].max() < 120


def test_what_is_filmed_and_how_it_ended_is_on_the_screen(session):
    screen = Screen(session)
    height = len(session.frame)
    before = screen.draw(session)
    session.press("v")
    filming = screen.draw(session)
    np.testing.assert_array_equal(filming[:height], before[:height])  # the game's own picture is what is filmed
    assert (filming[height:] != before[height:]).any()
    session.close()
    play_out(session)
    assert screen.draw(session)[:height].max() > 230
    assert (screen.draw(session)[:height] != session.frame).any()


def test_a_narrow_window_has_the_help_on_more_lines_and_smaller_letters():
    def screen_of(width):
        env = gym.make("Bounce/Paddle-v0", render_mode="rgb_array", frame_skip=1, width=width, height=160)
        return Screen(Session(env, 3, lambda: None))

    narrow, wide = screen_of(120), screen_of(900)
    assert narrow.size[1] > wide.size[1]
    one, other = (screen._rendered("Game over", (255, 255, 255), 60) for screen in (narrow, wide))
    assert one.get_height() < other.get_height()
